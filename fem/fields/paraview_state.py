"""A state of ParaView beside the time series of the fields: what it opens with."""

from __future__ import annotations

import math
from importlib import resources
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

import numpy as np

from base import replacing

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fem.cycle.result import MeshCycle
    from fem.fields.stress_fields import GearField
    from gears import GearPair

__all__ = ["STATE", "fillet_stress", "write_lines_state", "write_paraview_state"]

STATE = "paraview_state.py"
"""Name of the file, beside ``mesh_cycle.pvd``."""

LINES = "paraview_lines.py"
"""Template of that of a helical pair."""

FILLET = 1
"""Number of the cells between the root and the form circle in `fem.fields.stress_fields.GearField.region`."""

HALF_HEIGHT = 4.0
"""Of the view, in modules: a tooth of either gear above and below the pitch point, and the body under it."""

ARROW = 2.0
"""Length of the arrow of the whole force, of a helical pair that of the largest force on a cell, in modules."""

TUBE = 0.03
"""Radius of drawn lines of contact, in modules."""

BEHIND = 0.02
"""How far behind its flanks a gear is drawn, in modules."""


def fillet_stress(field: GearField) -> float:
    """Maximum von Mises stress [Pa] between root and form circle, without cells whose stress is only indicative."""
    cells = field.cells[(field.region == FILLET) & (field.indicative == 0)]
    return float(field.von_mises_Pa[np.unique(cells)].max())


def write_paraview_state(
    folder: Path, pair: GearPair, cycle: MeshCycle, rows: Sequence[int], stresses: Sequence[float]
) -> Path:
    """Write a state of ParaView, a Python script, that shows ``mesh_cycle.pvd`` of a folder.

    Parameters
    ----------
    folder : Path
    pair : gears.GearPair
    cycle : MeshCycle
    rows : sequence of int
        Rows of the cycle that the series has.
    stresses : sequence of float
        Of `fillet_stress` [Pa], of each row and gear. Colours end at their median: at some rows a contact near A or
        E presses on the flank just above a fillet.

    Returns
    -------
    Path
        The file written.
    """
    length = pair.module
    known = {
        "colours_to": f"{_up(1e-6 * float(np.median(stresses))):g}",
        "half_height": f"{HALF_HEIGHT * length:.6g}",
        "arrow": f"{ARROW * length / abs(cycle.force):.6g}",
    }
    return _written(folder, f"{STATE}.in", known | _place(pair, cycle, rows))


def write_lines_state(
    folder: Path, pair: GearPair, cycle: MeshCycle, rows: Sequence[int], pressures: Sequence[float]
) -> Path:
    """Write a state of ParaView that shows the contact pressure of a helical pair; arguments as of spur pairs.

    Parameters
    ----------
    folder, pair, cycle, rows
        As of `write_paraview_state`.
    pressures : sequence of float
        Maximum Hertz pressure of each row [Pa]. Colours end at the largest.

    Returns
    -------
    Path
        The file written.
    """
    assert cycle.lines is not None  # of a helical pair
    length = pair.module
    known = {
        "colours_to": f"{_up(1e-6 * max(pressures)):g}",
        "half_height": f"{0.5 * pair.face_width + HALF_HEIGHT * length:.6g}",
        "tube": f"{TUBE * length:.6g}",
        "behind": f"{BEHIND * length:.6g}",
        "arrow": f"{ARROW * length / float(cycle.lines.force[list(rows)].max()):.6g}",
    }
    return _written(folder, f"{LINES}.in", known | _place(pair, cycle, rows))


def _place(pair: GearPair, cycle: MeshCycle, rows: Sequence[int]) -> dict[str, str]:
    """What a view looks at: the pitch point, in the middle of the series."""
    time = float(cycle.position[rows[len(rows) // 2]])
    return {"centre": f"(0.0, {pair.pitch_radii[0]:.9g})", "time": f"{time:.9g}"}


def _written(folder: Path, template: str, known: Mapping[str, str]) -> Path:
    """State by a template of this folder."""
    text = resources.files("fem.fields").joinpath(template).read_text(encoding="utf-8")
    path = Path(folder) / STATE
    with replacing(path) as beside:
        beside.write_text(Template(text).substitute(known), encoding="utf-8")
    return path


def _up(value: float) -> float:
    """Value with two digits, rounded up."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / step) * step
