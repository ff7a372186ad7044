"""Units at the edges: what a number in a file or on a page is in SI.

Inside, everything is SI and carries no unit. A scene's key ends in its unit (``module_mm``), so does a column of a
CSV file (``transmission_error_um``); both are spelt by `suffix`.
"""

from __future__ import annotations

import math
from functools import cache

_SI = (
    "1|m|s|1/s|K|kg|kg/m|kg m2|kg/m3|N|N m|N/m|N m/rad|N s/m|Pa|1/Pa|1/K|Pa s|m2/s|m/s|Hz|rad|rad/s|W|W/m|W/K|Pa m/s|"
    "W/(m K)|J/(kg K)"
)

FACTORS = dict.fromkeys(_SI.split("|"), 1.0) | {
    "%": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "N/mm": 1e3,
    "N/(mm um)": 1e9,
    "kW": 1e3,
    "MPa": 1e6,
    "MPa m/s": 1e6,
    "Pa^0.5": 1.0,
    "MPa^0.5": 1e3,
    "GPa": 1e9,
    "1/GPa": 1e-9,
    "mm2/s": 1e-6,
    "1/mm2": 1e6,
    "deg": math.pi / 180.0,
    "rpm": math.pi / 30.0,
    "h": 3600.0,
}
"""SI value of one of each unit; ``N/(mm um)`` is of a stiffness per face width."""


def factor(unit: str) -> float:
    """SI value of one `unit`.

    Raises
    ------
    KeyError
        For a unit that is not in the table.

    Examples
    --------
    >>> factor("um")
    1e-06
    """
    return FACTORS[unit]


@cache
def suffix(unit: str) -> str:
    """Spelling of a unit as the end of a name; empty for pure numbers.

    Examples
    --------
    >>> [suffix(unit) for unit in ("N/(mm um)", "1/GPa", "N m/rad", "%", "1")]
    ['N_per_mm_um', 'per_GPa', 'Nm_per_rad', 'percent', '']
    """
    if unit == "1":
        return ""
    text = unit.replace("%", "percent").replace("N m", "Nm").replace("(", "").replace(")", "")
    return text.removeprefix("1").replace("/", "_per_").strip("_").replace(" ", "_")


@cache
def unit_of(name: str) -> str:
    """Unit in which a name ends, ``1`` for none: the reverse of `suffix`.

    Examples
    --------
    >>> [unit_of(name) for name in ("module_mm", "density_per_mm2", "conductivity_W_per_m_K", "teeth")]
    ['mm', '1/mm2', 'W/(m K)', '1']
    """
    fitting = [unit for unit in FACTORS if (end := suffix(unit)) and name.endswith(f"_{end}")]
    return max(fitting, key=lambda unit: len(suffix(unit)), default="1")
