"""The period map and its exact derivatives with respect to state and parameters."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Array, Faults, quantity, record
from dynamics.branches.corrector import OrbitProblem
from dynamics.flow.protocol import lost_motion
from dynamics.model.limits import PERIODS
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import exact_only
from dynamics.model.states import checked_state


@record
class MapDerivatives:
    """Image of a state under n periods, with derivatives."""

    parameters: tuple[str, ...] = quantity("", "the parameters, in the order of the columns", "parameter")
    state: Array = quantity("1", "image of X and V", "coordinate")
    jacobian: Array = quantity("1", "its derivative with respect to the state", "row column")
    slope: Array = quantity(
        "1",
        "its derivative with respect to the parameters; of the same state, at the changed period",
        "row parameter",
    )
    second: Array = quantity(
        "1",
        "derivatives of the Jacobian by X, V and the parameters; infinite at a grazing",
        "by row column",
    )
    counts: tuple[int, int] = quantity("1", "exits from X > D and entries into X < -D", "side")


@exact_only
def map_derivatives(
    oscillator: GearOscillator,
    state: npt.ArrayLike,
    parameters: tuple[str, ...] | None = None,
    periods: int = 1,
) -> MapDerivatives:
    r"""Follow a state over whole periods with first and second derivatives, all exact.

    Within a region the variational equations are linear with tabulated solutions. At an impact f is continuous, so
    that first derivatives pass unchanged; f' jumps, so that the derivative of the Jacobian M in a direction jumps by
    :math:`\Delta K\, (M_{1\cdot})\, \delta X / V` in its second row.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    state : array_like, shape (2,)
        X and V at tau = 0.
    parameters : tuple of str, optional
        As in `GearOscillator.with_parameter`. Left out: all of them.
    periods : int
        Excitation periods.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion grows beyond all bounds.
    """
    with Faults() as faults:
        n = faults.whole("periods", periods, *PERIODS)
    at = checked_state(state)
    names = oscillator.parameters if parameters is None else tuple(parameters)
    low = np.array([oscillator.get(name) for name in names])
    problem = OrbitProblem(
        oscillator, names, n, low, low + 1.0, 1.0
    )  # the unknowns are X, V and changes of these
    point = problem.evaluate(problem.unknowns(at, low))
    if point is None:
        raise lost_motion(at, "the motion grows without bound")
    return MapDerivatives(
        names, point.image, point.jacobian, point.derivative[:, 2:], point.second, point.counts
    )
