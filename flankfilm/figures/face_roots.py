"""Root stress over the face: maximum tension of a passing tooth over its way and the face, and over a whole cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.face import FlankMap
from flankfilm.figures.reading import GEARS, Reading, need, read
from flankfilm.figures.style import Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NEEDED = 'run a scene that wants "root-stress" and whose pair has a lead or an alignment'

FEW = 0.2
"""Part of the maximum tension below which an instant of a tooth is left out at both ends of its way."""

SHOWN = ("travel", "face_position", "tension", "cycle_tension")


def root_face_map(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the maximum tension at the roots over the way of a tooth and the face, and that of a cycle over the face.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``root-stress`` and whose pair has a lead or an alignment, or of one gear's record.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    gears = {gear: f"root_face_{gear}" for gear in GEARS}
    if "root_face_tension" in results:
        gears = {"root": "root_face"}
    names = {gear: [f"{prefix}_{name}" for name in SHOWN] for gear, prefix in gears.items()}
    need(results, NEEDED, *(name for of_gear in names.values() for name in of_gear))
    rows = 1 + len(gears)
    with sheet(style, rows, height=2.27 * rows, legend=0, sharex=False) as (drawn, panels):
        for axes, gear, colour in zip(panels, gears, colours(2), strict=False):
            travel, face, tension, most = (read(results, name) for name in names[gear])
            _paint(axes, gear, travel, face, tension)
            panels[-1].plot(face.values, most.values, color=colour, label=gear)
        panels[-1].set(xlabel="place on the face [mm]", ylabel=f"maximum of a\ncycle [{most.unit}]")
        from_zero(panels[-1])
        legend_over(panels[-1], 2)
    return drawn


def _paint(axes: Axes, what: str, travel: Reading, face: Reading, tension: Reading) -> None:
    """Paint a map with its scale of colours, as long as the tooth is stressed."""
    bears = tension.values.max(axis=-1, keepdims=True) > FEW * tension.values.max()
    shown = Reading(np.where(bears, tension.values, 0.0), f"tension, {what}", tension.unit)
    FlankMap.of(travel, face, shown).paint(axes)
    axes.set_xlabel("base pitches since the tooth's pair passed A [-]")
