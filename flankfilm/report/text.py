"""Numbers as a person reads them."""

from __future__ import annotations

import math


def number(value: float, digits: int = 4) -> str:
    """Value with significant digits, without exponent where it is readable."""
    if not math.isfinite(value):
        return "-"
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{digits}g}"


def percent(value: float | None, digits: int = 2) -> str:
    """Relative value in per cent; "unknown" for None."""
    if value is None or not math.isfinite(value):
        return "unknown"
    text = f"{100 * value:.{digits}g}"
    return f"{float(text):g} %" if abs(value) >= 1e-6 or value == 0 else f"{100 * value:.0e} %"


def seconds(value: float) -> str:
    """Time in ms or s."""
    return f"{1e3 * value:.0f} ms" if value < 1 else f"{value:.2g} s" if value < 10 else f"{value:.0f} s"
