"""For every variable whether its solver believes it, and what it says where not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

STAGES: Mapping[str, str] = {
    "single_pair": "closed forms",
    "dry": "dry cycle",
    "reference": "references",
    "torque": "torques",
    "revolution": "revolution",
    "other": "other cycles",
    **dict.fromkeys(("lubricated", "film", "held"), "film"),
    **dict.fromkeys(("root", "fillet", "iso6336_3", "iso6336_face"), "root stress"),
    "iso6336_2": "closed forms",
    "oscillator": "scaling",
    "fourier": "fourier",
    "excitation": "excitation",
    "spectrum": "spectrum",
    "run_up": "run-up",
    "dynamic_map": "dynamic-map",
    **dict.fromkeys(("sweep", "portrait"), "sweep"),
    **dict.fromkeys(("diagram", "return", "special", "jump", "missed", "stable", "force"), "diagram"),
    "field": "fields",
}
"""Stage that the variables of each prefix are of; those of the geometry alone are of none."""


def with_convergence(data: xr.Dataset, values: Mapping[str, Any]) -> xr.Dataset:
    """Give every variable ``converged`` where a solver found it, and its ``message`` where it did not converge.

    Parameters
    ----------
    data : xarray.Dataset
        All variables of a run.
    values : mapping
        Stage name to result.
    """
    for name in map(str, data.variables):
        data.variables[name].attrs |= _converged(name, values)
    return data


def _converged(name: str, values: Mapping[str, Any]) -> dict[str, int | str]:
    """Whether the solver believes a variable, and what it says where not."""
    prefix = next((start for start in STAGES if f"{name}_".startswith(f"{start}_")), None)
    solved = None if prefix is None else values.get(STAGES[prefix])
    solutions = solved if isinstance(solved, tuple) else (solved,)
    if any(getattr(solution, "converged", None) is None for solution in solutions):
        return {}
    message = "; ".join(solution.message for solution in solutions if not solution.converged)
    return {"converged": int(not message), **({"message": message} if message else {})}
