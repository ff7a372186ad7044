"""Draws the pictures of the README from examples/article.toml: python docs/pictures.py."""

from __future__ import annotations

from pathlib import Path

from flankfilm.cache import Cache, keep_compiled_code, user_cache
from flankfilm.figures import gear, stiffness
from flankfilm.figures.style import styled
from flankfilm.scene import read_scene
from flankfilm.stages.catalogue import STAGES
from flankfilm.stages.engine import Engine

HERE = Path(__file__).parent


def main() -> None:
    """Write docs/images/teeth.png and docs/images/stiffness.png."""
    keep_compiled_code()
    scene = read_scene(HERE.parent / "examples" / "article.toml")
    engine = Engine(scene, STAGES, Cache(user_cache() / "results"))
    cycles = [engine["mesh"], *engine["other cycles"]]
    drawn = {
        "teeth": gear.von_mises(engine["fields"]),
        "stiffness": stiffness.mesh_cycles(cycles, engine["pair"].face_width),
    }
    (HERE / "images").mkdir(exist_ok=True)
    with styled():
        for name, figure in drawn.items():
            figure.savefig(HERE / "images" / f"{name}.png", dpi=110)


if __name__ == "__main__":
    main()
