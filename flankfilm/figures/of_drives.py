"""Pictures of single records of drive trains, for `result.plot()`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.drives import FORCE, PARTS, Row, carried, modes
from flankfilm.figures.reading import read_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.coupling import DriveSweep, PairDrive


def pair_drive(drive: PairDrive) -> Figure:
    """Draw the modes of a drive train."""
    return modes(drive.natural_frequencies, drive.mode_shapes, drive.mesh_share, drive.freedoms)


def drive_sweep(sweep: DriveSweep) -> Figure:
    """Draw what mesh, bearings, shafts and couplings carry at most over the speed."""
    rows = [Row(FORCE, ("mesh",), {way: factor[:, None] for way, factor in sweep.force_factor.items()})]
    for part, (figure, label) in PARTS.items():
        names = getattr(sweep, f"{part}s")
        unit = "N" if part == "bearing" else "N m"
        if names:
            rows.append(Row(f"{label} [{unit}]", names, getattr(sweep, figure)))
    speed = read_figure(sweep, "speed")
    return carried(dict.fromkeys(sweep.force_factor, speed.values), speed.label, rows, np.zeros(0))
