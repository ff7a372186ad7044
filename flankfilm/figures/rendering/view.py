"""What pictures of the loaded teeth show, and how: shared by those of the plane and of three dimensions."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

__all__ = [
    "INK",
    "PAPER",
    "View",
    "bar_of",
    "colour_steps",
    "nearest",
    "note_scale",
    "round_number",
    "steps",
    "titled",
]

INK, PAPER = "#1c2126", "#ffffff"

SHOWN_UNITS = {"_N_per_m": (" [N/mm]", 1e-3), "_Pa": (" [MPa]", 1e-6), "_m": (" [um]", 1e6)}
"""Ending of a field's name to the unit that people read, and its factor."""


@dataclass(frozen=True)
class View:
    """What is drawn, and how.

    Attributes
    ----------
    folder : str
        Of the run.
    size : tuple of int
        Width and height [pixels].
    scale : float
        Factor of the displacements.
    greatest, ticks : float, int
        End of the scale of colours [Pa], and its parts.
    centre : tuple of float
        Middle of the picture [m].
    reach : float
        Half its width [m].
    base_radius : float
        Of the pinion [m].
    position, error : tuple of float
        Positions of the mesh cycle [base pitches], and the loaded transmission error there [m].
    only : float
        Position of the one picture [base pitches].
    field : str
        Name of the field that is drawn.
    face_width : float
        Of teeth in three dimensions [m]; 0 for the plane.
    target : str
        Picture or animation; its suffix is the format.
    seconds : float
        Length of the animation; 0 for one picture.
    window : bool
        Whether a window is opened instead of a file written.
    """

    folder: str
    size: tuple[int, int]
    scale: float
    greatest: float
    ticks: int
    centre: tuple[float, float]
    reach: float
    base_radius: float
    position: tuple[float, ...]
    error: tuple[float, ...]
    only: float
    field: str
    face_width: float = 0.0
    target: str = ""
    seconds: float = 0.0
    window: bool = False


def steps(folder: Path) -> dict[float, dict[str, Path]]:
    """Files of each position in ``mesh_cycle.pvd``, by the position [base pitches] and the start of their name."""
    files: dict[float, dict[str, Path]] = {}
    for entry in ElementTree.parse(folder / "mesh_cycle.pvd").iter("DataSet"):
        file = folder / str(entry.get("file"))
        files.setdefault(float(str(entry.get("timestep"))), {})[file.stem.rpartition("_")[0]] = file
    return dict(sorted(files.items()))


def nearest(places: Iterable[float], at: float) -> float:
    """Position that lies nearest to `at`."""
    return min(places, key=lambda place: abs(place - at))


def round_number(value: float) -> float:
    """Largest of ..., 1, 2, 5, 10, ... that is not above a value."""
    ten = 10.0 ** math.floor(math.log10(value))
    return max(ten * n for n in (1, 2, 5) if ten * n <= value)


def colour_steps(top: float) -> tuple[float, int]:
    """Step between the ticks of a scale of colours that ends at `top` or a little above, and their number."""
    step = round_number(top / 3)
    return step, math.ceil(top / step)


def titled(field: str) -> tuple[str, str, float]:
    """Words of a field's name, the unit that people read it in, and the factor to it."""
    for ending, (unit, factor) in SHOWN_UNITS.items():
        if field.endswith(ending):
            words = field.removesuffix(ending)
            return ("von Mises stress" if words == "von_mises" else words.replace("_", " ")), unit, factor
    return field.replace("_", " "), "", 1.0


def bar_of(view: View, title: str, colour: str) -> dict[str, Any]:
    """Scale of colours below the picture."""
    return {
        "title": f"{title}\n ", "color": colour, "vertical": False, "n_labels": view.ticks + 1,
        "fmt": "%.0f", "position_x": 0.3, "position_y": 0.03, "width": 0.4, "height": 0.13,
        "title_font_size": view.size[1] // 32, "label_font_size": view.size[1] // 36,
    }  # fmt: skip


def note_scale(plotter: Any, view: View, colour: str) -> None:
    """Note the factor of the displacements."""
    text, corner = f"displacements x {view.scale:g}", (view.size[1] // 40, view.size[1] - view.size[1] // 15)
    plotter.add_text(text, position=corner, font_size=view.size[1] // 56, color=colour, name="scale")
