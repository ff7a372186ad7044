"""Below all packages, on numpy alone: faults and limits, cost, what every result has, whole files, units."""

from base.arrays import Array, Booleans, Integers
from base.compiled import hide_compilation
from base.cost import Cost, Stopwatch, unclocked
from base.faults import (
    Fault,
    FlankfilmError,
    FlankfilmWarning,
    InputError,
    RangeWarning,
    SolverError,
    shorten,
)
from base.files import replacing, sweep_temporaries
from base.limits import Faults, Limit
from base.results import (
    Figure,
    Quantity,
    Result,
    described,
    part,
    quantities,
    quantity,
    record,
    show_with,
    view,
)

__all__ = [
    "Array",
    "Booleans",
    "Cost",
    "Fault",
    "Faults",
    "Figure",
    "FlankfilmError",
    "FlankfilmWarning",
    "InputError",
    "Integers",
    "Limit",
    "Quantity",
    "RangeWarning",
    "Result",
    "SolverError",
    "Stopwatch",
    "described",
    "hide_compilation",
    "part",
    "quantities",
    "quantity",
    "record",
    "replacing",
    "shorten",
    "show_with",
    "sweep_temporaries",
    "unclocked",
    "view",
]


def __dir__() -> list[str]:
    """Public names."""
    return list(__all__)
