"""The face-load factor over a tolerance of the alignment: what crowning is there for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import gears
from base import Array, Cost, Faults, Limit, Stopwatch, described, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from gears.tooth.face import ALIGNED, ALIGNMENT_LIMITS

__all__ = ["FaceTolerance", "face_load_tolerance"]

TOLERANCE = Limit(0.0, ALIGNMENT_LIMITS["in_plane"].high, "m", remedy="give the deviation in metres")
"""What a tolerance may be."""

POSITIONS = 40
"""Positions of a base pitch at which the factor is looked at."""


@record
class FaceTolerance:
    """Face-load factors of one pair with its nominal axes, and out of parallel by a tolerance either way."""

    headline = ("robust_face_load_factor",)

    in_plane: Array = quantity(
        "m", "axes out of parallel in the plane of action, over the face", "case", shown="um", no_error=EXACT
    )
    face_load_factor: Array = quantity(
        "1", "face-load factor, maximum over the mesh cycle", "case", error="face_load_factor_error"
    )
    face_load_factor_error: Array = quantity(
        "1", "estimated relative error of the face-load factor", "case", no_error=ITSELF
    )
    cost: Cost

    @described("1", error="error")
    def robust_face_load_factor(self) -> float:
        """Maximum face-load factor over the tolerance of the alignment."""
        return float(np.max(self.face_load_factor))

    @property
    def error(self) -> float:
        """Estimated relative error of the maximum factor."""
        return float(self.face_load_factor_error[int(np.argmax(self.face_load_factor))])


def face_load_tolerance(teeth: LoadedTeeth, tolerance: float, positions: int = POSITIONS) -> FaceTolerance:
    """Share the load over the face with the nominal axes, and out of parallel by a tolerance either way.

    Between these the factor is less: it grows to either side with what the axes are out of parallel by beyond that
    which the leads take back.

    Parameters
    ----------
    teeth : LoadedTeeth
        With finite elements of coupled pairs; its flanks hold the alignment that is meant, cells and model.
    tolerance : float
        Deviation in the plane of action over the face, more or less than meant [m].
    positions : int
        Equal intervals of one base pitch.

    Raises
    ------
    base.InputError
        A tolerance below 0 or above 5 mm.
    base.SolverError
        Where the loaded contact did not converge.

    Examples
    --------
    >>> import fem, gears
    >>> from flankfilm.coupling import Flanks, LoadedTeeth, face_load_tolerance
    >>> pair = gears.GearPair(gears.Gear(20), gears.Gear(30), module=2e-3, face_width=20e-3)
    >>> flanks = Flanks(cells=8, face_model="walls")
    >>> teeth = LoadedTeeth(pair, 50.0, compliance=fem.compliance(pair, tolerance=0.05), flanks=flanks)
    >>> found = face_load_tolerance(teeth, 20e-6, positions=8)
    >>> found.in_plane, bool(found.face_load_factor[1] < found.robust_face_load_factor)
    (array([-2.e-05,  0.e+00,  2.e-05]), True)
    """
    with Faults() as faults:
        faults.number("tolerance", tolerance, TOLERANCE)
    watch, meant = Stopwatch(), teeth.flanks.alignment or ALIGNED
    cases = meant.in_plane + tolerance * np.array([-1.0, 0.0, 1.0])
    rows = [_factor(teeth, replace(meant, in_plane=float(slope)), positions) for slope in cases]
    factors, errors = np.array(rows).T
    return FaceTolerance(cases, factors, errors, Cost(watch.seconds))


def _factor(teeth: LoadedTeeth, alignment: gears.Alignment, positions: int) -> tuple[float, float]:
    """Maximum face-load factor with an alignment, and its error."""
    cycle = replace(teeth, flanks=replace(teeth.flanks, alignment=alignment)).cycle(positions)
    face = cycle.face
    assert face is not None  # alignment makes cells
    return face.greatest_face_load_factor, face.error
