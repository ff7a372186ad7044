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
    from collections.abc import Sequence

    from fem.cycle.result import MeshCycle
    from fem.fields.stress_fields import GearField
    from gears import GearPair

__all__ = ["STATE", "fillet_stress", "write_paraview_state"]

STATE = "paraview_state.py"
"""Name of the file, beside ``mesh_cycle.pvd``."""

FILLET = 1
"""Number of the cells between the root and the form circle in `fem.fields.stress_fields.GearField.region`."""

HALF_HEIGHT = 4.0
"""Of the view, in modules: a tooth of either gear above and below the pitch point, and the body under it."""

ARROW = 2.0
"""Length of the arrow of the whole force, in modules."""


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
    middle = rows[len(rows) // 2]
    known = {
        "colours_to": f"{_up(1e-6 * float(np.median(stresses))):g}",
        "centre": f"(0.0, {pair.pitch_radii[0]:.9g})",
        "half_height": f"{HALF_HEIGHT * length:.6g}",
        "arrow": f"{ARROW * length / abs(cycle.force):.6g}",
        "time": f"{float(cycle.position[middle]):.9g}",
    }
    text = resources.files("fem.fields").joinpath(f"{STATE}.in").read_text(encoding="utf-8")
    path = Path(folder) / STATE
    with replacing(path) as beside:
        beside.write_text(Template(text).substitute(known), encoding="utf-8")
    return path


def _up(value: float) -> float:
    """Value with two digits, rounded up."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / step) * step
