"""Numbers as a person reads them."""

from __future__ import annotations

import math


def number(value: float, digits: int = 4) -> str:
    """Value with significant digits, without exponent where it is readable."""
    if not math.isfinite(value):
        return "-"
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text else text


def percent(value: float | None, digits: int = 2) -> str:
    """Relative value in per cent; "unknown" for None."""
    if value is None or not math.isfinite(value):
        return "unknown"
    text = f"{100 * value:.{digits}g}"
    return f"{float(text):g} %" if abs(value) >= 1e-6 or value == 0 else f"{100 * value:.0e} %"


def plus_minus(value: float | None) -> str:
    """Relative error behind a figure; that it is unknown, where it is.

    Examples
    --------
    >>> plus_minus(7.2e-5), plus_minus(None)
    ('± 0.0072 %', 'error unknown')
    """
    return "error unknown" if (text := percent(value)) == "unknown" else f"± {text}"


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
