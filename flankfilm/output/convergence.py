"""For every variable whether its solver believes it, and what it says where not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr


def with_convergence(data: xr.Dataset, solved: Mapping[str, Any]) -> xr.Dataset:
    """Give every variable ``converged`` where a solver found it, and its ``message`` where it did not converge.

    Parameters
    ----------
    data : xarray.Dataset
        All variables of a run.
    solved : mapping
        Prefix of variables to the result of their solver, or results; the first prefix that fits a variable counts.
    """
    for name in map(str, data.variables):
        data.variables[name].attrs |= _converged(name, solved)
    return data


def _converged(name: str, solved: Mapping[str, Any]) -> dict[str, int | str]:
    """Whether the solver believes a variable, and what it says where not."""
    solution = next((result for start, result in solved.items() if f"{name}_".startswith(f"{start}_")), None)
    solutions = solution if isinstance(solution, tuple) else (solution,)
    if any(getattr(each, "converged", None) is None for each in solutions):
        return {}
    message = "; ".join(each.message for each in solutions if not each.converged)
    return {"converged": int(not message), **({"message": message} if message else {})}
