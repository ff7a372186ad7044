"""How a special point moves with every parameter, and how large the force of a motion gets."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from base import Faults, quantity, record
from dynamics.motions import trajectory
from dynamics.oscillator import GearOscillator
from dynamics.protocol import exact_only
from dynamics.special import SpecialPoint
from dynamics.tracking import marked

__all__ = ["ForceRange", "force_range", "special_sensitivities"]


@exact_only
def special_sensitivities(
    oscillator: GearOscillator, parameter: str, point: SpecialPoint, names: Sequence[str] | None = None
) -> dict[str, float]:
    r"""Derivatives of a special point's parameter value with respect to the other parameters.

    The point solves G = 0: the orbit closes (two equations) and its condition holds. With the columns for X, V and
    the parameter in A and that for another parameter p in b, the change with p is the last component of
    :math:`-A^{-1} b`. All entries are exact.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator; its value of the parameter is not used. A harmonic of amplitude zero may be among its series:
        the derivative is then what that harmonic would do.
    parameter : str
        The parameter in which the point was found.
    point : SpecialPoint
        A saddle node, period doubling or grazing.
    names : sequence of str, optional
        As in `GearOscillator.with_parameter`. Left out: all others.

    Returns
    -------
    dict
        Name to derivative; nan where the system is singular (a point of codimension two).

    Raises
    ------
    InputError
        If there is no such parameter.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit, special_sensitivities
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.62, 0.67))
    >>> (fold,) = branch.special("saddle-node")
    >>> round(special_sensitivities(osc, "frequency", fold, ["mean_force"])["mean_force"], 4)
    1.6776
    """
    mark = marked(oscillator, parameter, point)
    wanted = [n for n in (oscillator.parameters if names is None else names) if n != parameter]
    return dict(zip(wanted, mark.slopes(wanted)[2].tolist(), strict=True))


@record
class ForceRange:
    """Least and greatest force of a motion, over the mean force."""

    headline = ("least", "greatest")

    least: float = quantity("1", "least of K(tau) f(X) / F_m; negative where the back flanks touch")
    greatest: float = quantity("1", "greatest of K(tau) f(X) / F_m")
    error: float = quantity("1", "change of the two with half as many samples, the larger one")


def force_range(
    oscillator: GearOscillator, state: npt.ArrayLike, periods: int = 1, samples: int = 400
) -> ForceRange:
    """Least and greatest force of a motion.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator; its mean force must not be zero.
    state : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Excitation periods.
    samples : int
        Samples per period, even; the force is taken there, on the exact motion.

    Raises
    ------
    InputError
        If there is no mean force, or an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> found = force_range(osc, find_orbit(osc, (0.35, 0.0)).state)
    >>> round(found.least, 3), round(found.greatest, 3)
    (0.182, 2.277)
    """
    faults = Faults()
    number = faults.whole("samples", samples, 4, 10**6, "400 is ample")
    if oscillator.mean_force == 0.0:
        faults.add("mean_force", oscillator.mean_force, "must not be zero", "give a load")
    faults.raise_if_any()
    motion = trajectory(oscillator, state, periods, number)
    stiffness = oscillator.stiffness(oscillator.frequency * motion.tau)
    force = stiffness * oscillator.deflection(motion.x) / oscillator.mean_force
    low, high, coarse = float(np.min(force)), float(np.max(force)), force[::2]
    error = max(abs(float(np.min(coarse)) - low), abs(float(np.max(coarse)) - high))
    return ForceRange(low, high, error)
