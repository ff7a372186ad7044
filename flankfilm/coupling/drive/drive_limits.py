"""Arguments of a drive train: what they may be."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Faults, Limit
from flankfilm.coupling.drive.train import SIDES
from gears import Shaft

INERTIA = Limit(0.0, 1e9, "kg m2", "0 where nothing is coupled")
COUPLING = Limit.above(0.0, 1e15, "N m/rad", "None for a rigid coupling")
DAMPING = Limit(0.0, 1.0, "", "0.005 to 0.02 for shafts")
BAND = Limit.above(0.0, 100.0, "", "0.5 and 2: half and twice the damping")
TOLERANCE = Limit.above(0.0, 1.0, "", "0.05: forces of the linear response within 5 %")
TILT = Limit(0.0, 1e12, "N m/rad", "0 for a mesh that gives way to tilt")
CENTRE = Limit(-100.0, 100.0, "m", "0 for a force at mid-face")
DAMPING_BAND = (0.5, 2.0)
"""Damping of shafts and bearings over the given one that is likely where nobody has measured it."""

RAYLEIGH = (
    Limit(0.0, 1e9, "1/s", "10 to 100 damps the lowest modes"),
    Limit(0.0, 10.0, "s", "1e-6 to 1e-5 damps the highest modes"),
)


def held_along_axis(shafts: Sequence[Shaft | None]) -> None:
    """Refuse shafts of a helical pair that nothing holds against its axial force; every fault is listed."""
    with Faults() as faults:
        for side, shaft in zip(SIDES, shafts, strict=True):
            if shaft is not None and not any(bearing.axial_stiffness for bearing in shaft.bearings):
                allowed = "must hold the shaft along its axis: helical gears push along it"
                faults.add(
                    f"shafts.{side}.bearings", "", allowed, "give axial_stiffness of one of the bearings"
                )


def checked_arguments(
    end_inertias: Sequence[float],
    couplings: Sequence[float | None],
    ratio: float | Sequence[float],
    rayleigh: Sequence[float] | None,
    tolerance: float,
    band: Sequence[float],
    tilt_stiffness: float,
    load_centre: float,
) -> list[float]:
    """Check numbers, every fault is listed; gives the ratios of damping."""
    with Faults() as faults:
        for side, inertia in zip(SIDES, end_inertias, strict=True):
            faults.number(f"end_inertias.{side}", inertia, INERTIA)
        for side, spring, inertia in zip(SIDES, couplings, end_inertias, strict=True):
            if spring is not None:
                faults.number(f"couplings.{side}", spring, COUPLING)
                if not inertia > 0.0:
                    allowed = "must be more than 0 kg m2 behind a coupling"
                    faults.add(f"end_inertias.{side}", inertia, allowed, "give that of motor or load")
        for i, (factor, limit) in enumerate(zip(rayleigh or (), RAYLEIGH, strict=False)):
            faults.number(f"rayleigh[{i}]", factor, limit)
        faults.number("reduction_tolerance", tolerance, TOLERANCE)
        for i, factor in enumerate(band):
            faults.number(f"damping_band[{i}]", factor, BAND)
        faults.number("tilt_stiffness", tilt_stiffness, TILT)
        faults.number("load_centre", load_centre, CENTRE)
        ratios = np.atleast_1d(np.asarray(ratio, dtype=np.float64)).tolist()
        if not ratios:
            faults.add("shaft_damping_ratio", "none", "must be at least one number", "0.01 for all modes")
        return [faults.number(f"shaft_damping_ratio[{i}]", zeta, DAMPING) for i, zeta in enumerate(ratios)]
