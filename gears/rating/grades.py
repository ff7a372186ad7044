"""Tolerances of an accuracy grade of ISO 1328-1:1995."""

from __future__ import annotations

import math
from bisect import bisect_left

from base import Faults, Limit, quantity, record
from base.results import EXACT
from gears.pair.gear_pair import GearPair
from gears.tooth.errors import GeometryError

GRADES = (0, 12)
"""First and last accuracy grade of the standard."""

_DIAMETERS = (5.0, 20.0, 50.0, 125.0, 280.0, 560.0, 1000.0, 1600.0, 2500.0, 4000.0, 6000.0, 8000.0, 10000.0)
_MODULES = (0.5, 2.0, 3.5, 6.0, 10.0, 16.0, 25.0, 40.0, 70.0)
_WIDTHS = (4.0, 10.0, 20.0, 40.0, 80.0, 160.0, 250.0, 400.0, 650.0, 1000.0)


@record
class Tolerances:
    """Tolerances of both gears of a pair by ISO 1328-1:1995, rounded as its tables are."""

    grade: int = quantity("1", "accuracy grade")
    f_pt: tuple[float, float] = quantity("m", "single pitch deviation", "gear", shown="um")
    f_pb: tuple[float, float] = quantity(
        "m", "base pitch deviation in the transverse section, f_pt cos(alpha_t)", "gear", shown="um"
    )
    F_p: tuple[float, float] = quantity("m", "total cumulative pitch deviation", "gear", shown="um")
    F_alpha: tuple[float, float] = quantity("m", "total profile deviation", "gear", shown="um")
    f_falpha: tuple[float, float] = quantity("m", "profile form deviation", "gear", shown="um")
    f_Halpha: tuple[float, float] = quantity("m", "profile slope deviation", "gear", shown="um")
    F_beta: tuple[float, float] = quantity("m", "total helix deviation", "gear", shown="um")
    f_Hbeta: tuple[float, float] = quantity(
        "m", "helix slope deviation, as large as the helix form deviation", "gear", shown="um"
    )

    no_error = EXACT
    headline = ("grade", "f_pt", "f_falpha", "f_Hbeta")


def tolerances(pair: GearPair, grade: int) -> Tolerances:
    """Tolerances of a pair whose gears have one accuracy grade.

    In um, of grade 5, with d, m_n and b in mm, each the geometric mean of the range in which it lies:

        f_pt = 0.3 (m_n + 0.4 sqrt(d)) + 4,            F_p = 0.3 m_n + 1.25 sqrt(d) + 7
        F_alpha = 3.2 sqrt(m_n) + 0.22 sqrt(d) + 0.7,  f_falpha = 2.5 sqrt(m_n) + 0.17 sqrt(d) + 0.5
        f_Halpha = 2 sqrt(m_n) + 0.14 sqrt(d) + 0.5
        F_beta = 0.1 sqrt(d) + 0.63 sqrt(b) + 4.2,     f_Hbeta = 0.07 sqrt(d) + 0.45 sqrt(b) + 3

    Each grade is sqrt(2) of the one before. Values are rounded to 1 um from 10 um on, to 0.5 um from 5 um on, and to
    0.1 um below.

    Parameters
    ----------
    pair : GearPair
        Its reference diameters from 5 mm to 10 m, normal module from 0.5 to 70 mm, faces from 4 mm to 1 m.
    grade : int
        0, the finest, to 12.

    Returns
    -------
    Tolerances

    Raises
    ------
    GeometryError
        For a grade that the standard does not have, and gears outside of its ranges, with all faults.

    Notes
    -----
    Formulas, ranges and rounding agree in two open programs (python-gearbox by E. F. Vida, Drivetrain by G. F. S.
    Reboucas), and give f_pt 17 um and f_falpha 22 um of the wheel that a published listing needs
    (docs/validation/ratings.md). The edition of 2013 is left out: no print confirms its formulas.

    References
    ----------
    ISO 1328-1:1995, Cylindrical gears - ISO system of accuracy - Part 1: Definitions and allowable values of deviations
    relevant to corresponding flanks of gear teeth, clause 6 and annex B.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> [round(1e6 * deviation, 1) for deviation in tolerances(pair, 6).f_pt]
    [7.5, 7.5]
    """
    low, high = GRADES
    diameters = [2e3 * radius for radius in pair.reference_radii]
    widths = [1e3 * width for width in pair.face_widths]
    with Faults(GeometryError) as faults:
        number = faults.whole(
            "grade", grade, low, high, "ISO 1328-1 has grades 0 to 12; 6 is usual for ground gears"
        )
        faults.number("module", 1e3 * pair.module, _range(_MODULES))
        for name, diameter, width in zip(("pinion", "wheel"), diameters, widths, strict=True):
            faults.number(f"{name}.reference_diameter", diameter, _range(_DIAMETERS))
            faults.number(f"{name}.face_width", width, _range(_WIDTHS))
    m, step = _mean(1e3 * pair.module, _MODULES), math.sqrt(2.0) ** (number - 5)
    columns = []
    for diameter, width in zip(diameters, widths, strict=True):
        root_m, root_d, root_b = (
            math.sqrt(m),
            math.sqrt(_mean(diameter, _DIAMETERS)),
            math.sqrt(_mean(width, _WIDTHS)),
        )
        fifth = (
            0.3 * (m + 0.4 * root_d) + 4.0,
            0.3 * m + 1.25 * root_d + 7.0,
            3.2 * root_m + 0.22 * root_d + 0.7,
            2.5 * root_m + 0.17 * root_d + 0.5,
            2.0 * root_m + 0.14 * root_d + 0.5,
            0.1 * root_d + 0.63 * root_b + 4.2,
            0.07 * root_d + 0.45 * root_b + 3.0,
        )
        columns.append([1e-6 * _rounded(step * value) for value in fifth])
    f_pt, *others = (tuple(values) for values in zip(*columns, strict=True))
    f_pb = tuple(value * pair.helix.transverse_cosine for value in f_pt)
    return Tolerances(number, f_pt, f_pb, *others)


def _range(bounds: tuple[float, ...]) -> Limit:
    return Limit(
        bounds[0], bounds[-1], "mm", "ISO 1328-1 has no tolerances beyond: give deviations themselves"
    )


def _mean(value: float, bounds: tuple[float, ...]) -> float:
    """Geometric mean of the range that contains a value; its upper bound belongs to it."""
    place = max(bisect_left(bounds, value), 1)
    return math.sqrt(bounds[place - 1] * bounds[place])


def _rounded(micrometres: float) -> float:
    step = 1.0 if micrometres >= 10.0 else 0.5 if micrometres >= 5.0 else 0.1
    return step * math.floor(micrometres / step + 0.5)
