"""Oils by ISO viscosity grade and temperature: viscosity, density and pressure-viscosity coefficient."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np

from base import Faults, InputError, Limit, RangeWarning, quantity, record

GRADES = (2, 3, 5, 7, 10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000, 1500, 2200, 3200)
"""Grades of ISO 3448: mid-point kinematic viscosity at 40 degC [mm^2/s]."""

_ZERO = 273.15  # K at 0 degC
LIMITS = {
    "vg": Limit(7.0, 1e4, "mm2/s", "give the grade's number, 7 to 3200 mm2/s at 40 degC"),
    "temperature": Limit.above(
        _ZERO - 20.0, _ZERO + 150.0, "K", "give the oil's temperature in kelvin, degC + 273.15"
    ),
    "viscosity_index": Limit(0.0, 250.0, remedy="mineral oils have about 95, synthetic oils 140 to 250"),
    "density_15": Limit.above(500.0, 2000.0, "kg/m3", "of the oil at 15 degC"),
}
"""What the numbers of a graded oil may be."""

_T40, _T100, _T15 = 313.15, 373.15, 288.15  # K


@dataclass(frozen=True)
class BaseOil:
    """What oils of a base have in common.

    Parameters
    ----------
    s, t : float
        Of Gold's formula [1/GPa at 1 mm^2/s], [-].
    density_15, falling : float
        Density at 15 degC [kg/m^3], and its decrease [kg/m^3 K].
    conductivity, heat_capacity : float
        [W/(m K)], [J/(kg K)].
    limiting_shear_ratio : float, optional
        Maximum mean shear stress over the pressure [-]; unknown for esters.
    """

    s: float
    t: float
    density_15: float
    falling: float
    conductivity: float
    heat_capacity: float
    limiting_shear_ratio: float | None


_BASES = {
    "mineral": BaseOil(9.904, 0.1390, 885.0, 0.64, 0.14, 2000.0, 0.047),
    "pao": BaseOil(7.382, 0.1335, 850.0, 0.60, 0.16, 2050.0, 0.035),
    "ester": BaseOil(6.605, 0.1360, 950.0, 0.70, 0.15, 1950.0, None),
    "pag": BaseOil(5.489, 0.1485, 1050.0, 0.75, 0.15, 2000.0, 0.044),
}
BASES = tuple(_BASES)
"""Base oils by name."""

# ISO 2909: viscosity at 40 degC [mm^2/s] of the oils of index 0 (L) and 100 (H) against that at 100 degC (Y)
_INDEX_TABLE = np.array(
    [
        (2.0, 7.994, 6.394), (2.5, 11.45, 9.063), (3.0, 15.49, 12.15), (3.5, 20.09, 15.66),
        (4.0, 25.32, 19.56), (4.5, 31.96, 23.81), (5.0, 40.23, 28.49), (5.1, 41.99, 29.46),
        (5.5, 49.09, 33.34), (6.0, 57.97, 38.19), (6.5, 67.12, 43.18), (7.0, 78.00, 48.57),
        (7.5, 88.85, 53.98), (7.8, 95.43, 57.31), (8.0, 100.0, 59.60), (8.5, 111.5, 65.32),
        (8.8, 118.5, 68.79), (8.9, 120.9, 69.94), (9.0, 123.3, 71.10), (9.5, 135.3, 76.91),
        (10.0, 147.7, 82.87), (11.0, 173.9, 95.19), (12.0, 201.9, 108.0), (13.0, 231.9, 121.5),
        (14.0, 263.3, 135.4), (15.0, 296.5, 149.7), (16.0, 331.9, 164.6), (17.0, 369.4, 180.2),
        (18.0, 408.6, 196.2), (20.0, 493.2, 229.5), (22.0, 585.2, 264.9), (25.0, 736.5, 320.9),
        (28.0, 904.1, 380.6), (30.0, 1023.0, 421.7), (35.0, 1356.0, 532.5), (40.0, 1730.0, 651.8),
        (45.0, 2152.0, 780.9), (50.0, 2618.0, 919.6), (55.0, 3126.0, 1066.0), (60.0, 3676.0, 1222.0),
        (65.0, 4268.0, 1386.0), (70.0, 4905.0, 1558.0),
    ]
)  # fmt: skip


@record
class GradedOil:
    """What a grade gives at one temperature."""

    no_error = "not estimated: values of a grade, whose oils differ"

    viscosity: float = quantity("Pa s", "viscosity eta0 at ambient pressure")
    pressure_viscosity: float = quantity("1/Pa", "pressure-viscosity coefficient alpha", shown="1/GPa")
    density: float = quantity("kg/m3", "density rho0 at ambient pressure")
    kinematic_viscosity: float = quantity("mm2/s", "kinematic viscosity")
    kinematic_viscosity_100: float = quantity("mm2/s", "kinematic viscosity at 100 degC")
    viscosity_slope: float = quantity("1/K", "fall of the viscosity's logarithm with the temperature")
    conductivity: float = quantity("W/(m K)", "thermal conductivity, typical of the base")
    heat_capacity: float = quantity("J/(kg K)", "heat capacity, typical of the base")
    expansion: float = quantity("1/K", "thermal expansion by volume")
    limiting_shear_ratio: float | None = quantity(
        "1", "limiting shear stress over the pressure, typical of the base; None for esters"
    )


def walther(temperature: float, nu_40: float, nu_100: float) -> float:
    """Kinematic viscosity [mm^2/s] by Walther's equation, ``log log(nu + 0.7) = A - B log T``.

    A and B follow from the viscosities at 40 and 100 degC. This is ASTM D341 above 2 mm^2/s, where its further
    terms vanish.

    Parameters
    ----------
    temperature : float
        [K].
    nu_40, nu_100 : float
        At 40 and 100 degC [mm^2/s].
    """
    at_40, slope = _line(nu_40, nu_100)
    viscosity: float = 10.0 ** (10.0 ** (at_40 - slope * (math.log10(temperature) - math.log10(_T40)))) - 0.7
    return viscosity


def walther_slope(temperature: float, nu_40: float, nu_100: float) -> float:
    """Fall of the kinematic viscosity's logarithm with the temperature, ``-d ln(nu)/dT`` [1/K], by :func:`walther`.

    ``(B/T) [(nu + 0.7)/nu] ln(nu + 0.7)``.

    Parameters
    ----------
    temperature, nu_40, nu_100 : float
        As of :func:`walther`.
    """
    nu = walther(temperature, nu_40, nu_100)
    return _line(nu_40, nu_100)[1] / temperature * (nu + 0.7) / nu * math.log(nu + 0.7)


def _line(nu_40: float, nu_100: float) -> tuple[float, float]:
    """Walther's double logarithm at 40 degC, and its fall B with the logarithm of the temperature."""
    at_40, at_100 = (math.log10(math.log10(nu + 0.7)) for nu in (nu_40, nu_100))
    return at_40, (at_40 - at_100) / (math.log10(_T100) - math.log10(_T40))


def _reference_oils(nu_100: float) -> tuple[float, float]:
    """Viscosities at 40 degC of the oils of index 0 and 100 that share a viscosity at 100 degC."""
    if nu_100 > 70.0:
        return (
            0.8353 * nu_100**2 + 14.67 * nu_100 - 216.0,
            0.1684 * nu_100**2 + 11.85 * nu_100 - 97.0,
        )
    Y, L, H = np.log(_INDEX_TABLE.T)
    at = math.log(nu_100)
    return math.exp(np.interp(at, Y, L)), math.exp(np.interp(at, Y, H))


def viscosity_index(nu_40: float, nu_100: float) -> float:
    """Viscosity index of ISO 2909 [-], without its rounding to a whole number.

    Parameters
    ----------
    nu_40, nu_100 : float
        Kinematic viscosity at 40 and 100 degC [mm^2/s], the latter at least 2. Below 70 mm^2/s at 100 degC a
        tenth of the standard's table is interpolated in its logarithms, within 1.2 points of the whole.

    References
    ----------
    ISO 2909, Petroleum products - Calculation of viscosity index from kinematic viscosity (the same as
    ASTM D2270).
    """
    L, H = _reference_oils(nu_100)
    if nu_40 >= H:
        return 100.0 * (L - nu_40) / (L - H)
    N = math.log(H / nu_40) / math.log(nu_100)
    index: float = (10.0**N - 1.0) / 0.00715 + 100.0
    return index


def _nu_100(nu_40: float, index: float) -> float:
    """Viscosity at 100 degC of the oil of a given viscosity at 40 degC and index, by bisection."""
    low, high = 2.0, max(2.0, 0.9 * nu_40)
    if viscosity_index(nu_40, low) > index:
        return math.nan
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if viscosity_index(nu_40, middle) < index else (low, middle)
    return math.sqrt(low * high)


def gold_coefficient(kinematic_viscosity: float, base: str = "mineral") -> float:
    """Pressure-viscosity coefficient [1/Pa] by Gold's formula ``alpha = s nu^t``, nu in mm^2/s.

    A fit to measured gear oils: mineral 9.904 and 0.1390, polyalphaolefin 7.382 and 0.1335, ester 6.605 and
    0.1360, polyglycol 5.489 and 0.1485 (s in 1/GPa). Single oils scatter by 10 to 20 % about it.

    References
    ----------
    P. W. Gold, A. Schmidt, H. Dicke, J. Loos, C. Assmann, Viscosity-pressure-temperature behaviour of mineral
    and synthetic oils, Journal of Synthetic Lubrication 18 (2001) 51-79. The constants were taken from gear
    software that cites it.
    """
    oil = _BASES[base]
    coefficient: float = 1e-9 * oil.s * kinematic_viscosity**oil.t
    return coefficient


def graded_oil(
    vg: float,
    temperature: float,
    index: float = 95.0,
    base: str = "mineral",
    density_15: float | None = None,
) -> GradedOil:
    """Viscosity, density and pressure-viscosity coefficient of a graded oil at a temperature.

    The viscosity at 100 degC follows from the grade and the viscosity index (ISO 2909), that at the
    temperature from both (:func:`walther`); the density falls by 0.6 to 0.75 kg/m^3 per K (typical values of
    each base); alpha follows from the kinematic viscosity (:func:`gold_coefficient`). The slope of the viscosity is
    that of its line over the temperature (:func:`walther_slope`) with the density's; expansion is the density's fall
    over the density. Conductivity and heat capacity are typical of the base as commonly quoted, off by some 10 % for
    single oils, limiting stresses over the pressure .047 (mineral), .035 (polyalphaolefin) and .044 (polyglycol).

    Parameters
    ----------
    vg : float
        Kinematic viscosity at 40 degC [mm^2/s], at least 7.
    temperature : float
        [K], -20 to 150 degC.
    index : float
        Viscosity index [-], 0 to 250.
    base : str
        ``"mineral"``, ``"pao"``, ``"ester"`` or ``"pag"``.
    density_15 : float, optional
        Density at 15 degC [kg/m^3].

    Raises
    ------
    InputError
        With every fault at once.

    Warns
    -----
    RangeWarning
        Where ``vg`` is no grade of ISO 3448.
    """
    with Faults() as faults:
        faults.numbers(LIMITS, (vg, temperature, index))
        faults.choice("base", base, BASES, "choose the nearest")
        if density_15 is not None:
            faults.number("density_15", density_15, LIMITS["density_15"])
    nu_100 = _nu_100(vg, index)
    if math.isnan(nu_100):
        allowed = f"must be at least {viscosity_index(vg, 2.0):.0f} for VG {vg:g}"
        remedy = "below that the viscosity at 100 degC leaves the standard's range; give a higher index"
        raise InputError.at("viscosity_index", index, allowed, remedy)
    if vg not in GRADES:
        warnings.warn(f"VG {vg:g} is no grade of ISO 3448", RangeWarning, stacklevel=3)
    nu, oil = walther(temperature, vg, nu_100), _BASES[base]
    density = (oil.density_15 if density_15 is None else density_15) - oil.falling * (temperature - _T15)
    expansion = oil.falling / density
    return GradedOil(
        viscosity=1e-6 * nu * density,
        pressure_viscosity=gold_coefficient(nu, base),
        density=density,
        kinematic_viscosity=nu,
        kinematic_viscosity_100=nu_100,
        viscosity_slope=walther_slope(temperature, vg, nu_100) + expansion,
        conductivity=oil.conductivity,
        heat_capacity=oil.heat_capacity,
        expansion=expansion,
        limiting_shear_ratio=oil.limiting_shear_ratio,
    )
