"""Numbers as readable text."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flankfilm.output.uncertainty import Uncertainty

SMALLEST = 1e-6
"""Relative value below which only this bound is shown."""


def number(value: float, digits: int = 4) -> str:
    """Value with significant digits, without exponent where it is readable."""
    if not math.isfinite(value):
        return "-"
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text else text


def plain(value: float, digits: int = 2) -> str:
    """Value with significant digits and without an exponent, such as an error beside its figure.

    Examples
    --------
    >>> plain(1.43e-5), plain(0.0), plain(12.3)
    ('0.000014', '0', '12')
    """
    return np.format_float_positional(value, digits, unique=False, fractional=False, trim="-")


def alike(values: Sequence[float], digits: int = 2) -> list[str]:
    """Numbers below each other with the same decimals, those that the largest needs.

    Examples
    --------
    >>> alike((3.31e-6, 9.9e-7))
    ['0.0000033', '0.0000010']
    """
    largest = max(map(abs, values), default=0.0)
    decimals = max(0, digits - 1 - math.floor(math.log10(largest))) if largest > 0 else 0
    return [f"{value:.{decimals}f}" for value in values]


def percent(value: float | None, digits: int = 2) -> str:
    """Relative value in per cent; "unknown" for None."""
    if value is None or not math.isfinite(value):
        return "unknown"
    if 0 < abs(value) < SMALLEST:
        return f"< {100 * SMALLEST:.4f} %"
    return f"{float(f'{100 * value:.{digits}g}'):.12f}".rstrip("0").rstrip(".") + " %"


def plus_minus(value: float | None) -> str:
    """Relative error after a figure; "error unknown" for None.

    Examples
    --------
    >>> plus_minus(7.2e-5), plus_minus(None)
    ('± 0.0072 %', 'error unknown')
    """
    return "error unknown" if (text := percent(value)) == "unknown" else f"± {text}"


def off(uncertainty: Uncertainty, tolerance: float | None = None) -> str:
    """Total uncertainty of a figure with its parts, and a mark where it does not meet the tolerance.

    Examples
    --------
    >>> off(Uncertainty(0.0012, 0.37))
    '± 37 % (numerical 0.12 %, model 37 %)'
    >>> off(Uncertainty(0.018), 0.01)
    '± 1.8 % (numerical; model not estimated); ! above the tolerance of 1 %'
    >>> off(Uncertainty(5e-4, size=378.0, unit="K"))
    '± 0.19 K (numerical; model not estimated)'
    """
    if uncertainty.total is None:
        return total(uncertainty)
    return "; ".join(
        filter(None, (f"{total(uncertainty)} ({parts(uncertainty)})", missed(uncertainty, tolerance)))
    )


def total(uncertainty: Uncertainty) -> str:
    """Total uncertainty of a figure.

    Examples
    --------
    >>> total(Uncertainty(0.0012, 0.37)), total(Uncertainty(5e-4, size=378.0, unit="K")), total(Uncertainty(None))
    ('± 37 %', '± 0.19 K', 'error unknown')
    """
    return "error unknown" if uncertainty.total is None else f"± {_sized(uncertainty, uncertainty.total)}"


def parts(uncertainty: Uncertainty) -> str:
    """Numerical and model part of an uncertainty; empty where it is unknown.

    Examples
    --------
    >>> parts(Uncertainty(0.0012, 0.37)), parts(Uncertainty(0.0012)), parts(Uncertainty(None))
    ('numerical 0.12 %, model 37 %', 'numerical; model not estimated', '')
    """
    if uncertainty.total is None:
        return ""
    if uncertainty.model is None:
        return "numerical; model not estimated"
    return f"numerical {_sized(uncertainty, uncertainty.numerical)}, model {_sized(uncertainty, uncertainty.model)}"


def missed(uncertainty: Uncertainty, tolerance: float | None) -> str:
    """Mark of a figure that does not meet the tolerance; empty of one that does, or whose error is unknown.

    Examples
    --------
    >>> missed(Uncertainty(0.018), 0.01), missed(Uncertainty(0.001, 0.37), 0.01)
    ('! above the tolerance of 1 %', '')
    """
    if tolerance is None or uncertainty.total is None or uncertainty.met(tolerance):
        return ""
    return f"{MARK} above the tolerance of {percent(tolerance)}"


def _sized(uncertainty: Uncertainty, error: float | None) -> str:
    """Error in per cent, or in the unit of the figure."""
    return (
        f"{plain(uncertainty.size * (error or 0.0))} {uncertainty.unit}".strip()
        if uncertainty.size
        else percent(error)
    )


MARK = "!"
"""Mark before a figure that does not meet the tolerance."""


def counted(count: int, noun: str, plural: str = "") -> str:
    """Number of things with their name, in the plural where there is not one.

    Examples
    --------
    >>> counted(1, "round"), counted(2, "round"), counted(0, "branch", "branches")
    ('1 round', '2 rounds', '0 branches')
    """
    return f"{count:,} {noun if count == 1 else plural or f'{noun}s'}"


def seconds(value: float) -> str:
    """Time in ms or s."""
    return f"{1e3 * value:.0f} ms" if value < 1 else f"{value:.2g} s" if value < 10 else f"{value:.0f} s"


def of_both(stresses: Sequence[float]) -> str:
    """Stress of pinion and wheel [MPa], once where it is the same."""
    return " and ".join(dict.fromkeys(f"{1e-6 * stress:.4g}" for stress in stresses))
