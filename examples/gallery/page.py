"""What the scripts of the gallery share: the house's look, and the file that a picture goes to."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from flankfilm.figures.style import MARK, from_zero, legend_over, looks, sheet, styled

__all__ = ["MARK", "from_zero", "legend_over", "looks", "picture", "sheet"]

IMAGES = Path(__file__).parents[2] / "docs" / "images"
COLOURS = 256  # of a png: a fifth of the bytes, and no difference to be seen


def picture(draw: Callable[[], Figure], script: str, arguments: Sequence[str] | None = None) -> Path:
    """Draw as the command line asks, ``NAME.py [--out FILE]``; without a file, the picture of the page."""
    own = IMAGES / f"gallery_{Path(script).stem}.png"
    parser = argparse.ArgumentParser(description=draw.__doc__)
    parser.add_argument("--out", type=Path, default=own, help="png, svg or pdf; %(default)s")
    out: Path = parser.parse_args(arguments).out
    drawn = draw()
    with styled():
        drawn.savefig(out, dpi=140)
    if out.suffix == ".png":
        with Image.open(out) as image:
            few = image.convert("RGB").quantize(COLOURS)
        few.save(out, optimize=True)
    return out
