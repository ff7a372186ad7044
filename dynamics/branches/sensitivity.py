"""The period map and its derivatives with respect to state and parameters."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Array, Faults, quantity, record
from dynamics.branches.continuation import problem_of
from dynamics.flow.protocol import lost_motion
from dynamics.model.limits import PERIODS
from dynamics.model.protocol import PeriodicOscillator, periodic_only
from dynamics.model.reasons import FLOW
from dynamics.model.states import checked_state


@record
class MapDerivatives:
    """Image of a state under n periods, with derivatives."""

    no_error = FLOW

    parameters: tuple[str, ...] = quantity("", "the parameters, in the order of the columns", "parameter")
    state: Array = quantity("1", "image of X and V, or of displacements and speeds", "coordinate")
    jacobian: Array = quantity("1", "its derivative with respect to the state", "row column")
    slope: Array = quantity(
        "1",
        "its derivative with respect to the parameters; of the same state, at the changed period",
        "row parameter",
    )
    second: Array = quantity(
        "1",
        "derivatives of the Jacobian by the state and the parameters; infinite at a grazing",
        "by row column",
    )
    counts: tuple[int, int] = quantity("1", "exits from X > D and entries into X < -D", "side")


@periodic_only
def map_derivatives(
    oscillator: PeriodicOscillator,
    state: npt.ArrayLike,
    parameters: tuple[str, ...] | None = None,
    periods: int = 1,
) -> MapDerivatives:
    r"""Follow a state over whole periods with first and second derivatives, those of a pair all exact.

    Within a region the variational equations are linear with tabulated solutions. At an impact f is continuous, so
    that first derivatives pass unchanged; f' jumps, so that the derivative of the Jacobian M in a direction jumps by
    :math:`\Delta K\, (M_{1\cdot})\, \delta X / V` in its second row.

    Of a drive train the derivative by the state is exact; those by parameters and all second ones are differences, good
    to about 1e-9 of the stretch of the map. Next to a grazing they are those of the side with fewer impacts.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator.
    state : array_like, shape (dimension,)
        State at tau = 0.
    parameters : tuple of str, optional
        Of its `parameters`. Left out: all of them.
    periods : int
        Excitation periods.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion grows beyond all bounds.
    """
    with Faults() as faults:
        n = faults.whole("periods", periods, *PERIODS)
    at = checked_state(state, size=oscillator.dimension)
    names = oscillator.parameters if parameters is None else tuple(parameters)
    low = np.array([oscillator.get(name) for name in names])
    # the unknowns are the state and changes of these
    problem = problem_of(oscillator, names, n, low, low + 1.0, 1.0)
    point = problem.evaluate(problem.unknowns(at, low))
    if point is None:
        raise lost_motion(at, "the motion grows without bound")
    bend = problem.bend(point)
    return MapDerivatives(
        names,
        point.image,
        point.jacobian,
        bend.first[:, point.size :],
        bend.second,
        point.counts,
    )
