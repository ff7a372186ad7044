"""Special points carried from one periodic stiffness to another, without their branches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from base import Array
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.sensitivity import special_problem
from dynamics.branches.special_orbits import special_orbit
from dynamics.branches.special_point_derivatives import Mark, marked
from dynamics.model.protocol import EPS, PeriodicOscillator, periodic_only
from dynamics.model.states import scale_of
from dynamics.model.stiffness import FourierStiffness
from dynamics.orbits.shooting import motion_label

FIRST, LEAST = 0.25, 1.0 / 256.0
"""First step of the way from one stiffness to the other, and the smallest."""

NEAR = 0.05
"""How far a point may lie from where its derivatives foretold it, over the size of the motion and the parameter."""


@periodic_only
def carried_point(
    oscillator: PeriodicOscillator, parameter: str, point: SpecialPoint, stiffness: FourierStiffness
) -> SpecialPoint | None:
    r"""Follow a special point while the stiffness changes into another one.

    On the way the stiffness is :math:`(1-s) K + s K'`, each harmonic as a complex amplitude. At every step Newton's
    method finds the orbit and its condition together, from where the exact derivatives foretell the point; steps
    shrink until it lies near there, so that it is not taken for another one.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        Of the point; its value of the parameter is not used.
    parameter : str
        In which the point was found.
    point : SpecialPoint
        A saddle node or a period doubling.
    stiffness : FourierStiffness
        The other one, of any order.

    Returns
    -------
    SpecialPoint or None
        The point with the other stiffness; None where it vanishes on the way, as a saddle node does that meets
        another one, or cannot be followed.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, carried_point, continue_branch, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.62, 0.67))
    >>> (fold,) = branch.special("saddle-node")
    >>> there = FourierStiffness(1.0, (0.18, 0.05), (0.0, 1.0))
    >>> round(fold.parameter, 4), round(carried_point(osc, "frequency", fold, there).parameter, 4)
    (0.6556, 0.6577)
    """
    way = _Way(oscillator.contact_stiffness, stiffness)
    mark = replace(
        marked(oscillator, parameter, point), oscillator=oscillator.with_contact_stiffness(way.at(0.0))
    )
    done, step = 0.0, FIRST
    while done < 1.0:
        end = min(done + step, 1.0)
        next_mark = _stepped(mark, way, done, end)
        if next_mark is None:
            step = 0.5 * (end - done)
            if step < LEAST:
                return None
            continue
        mark, done, step = next_mark, end, 2.0 * step
    return _special(mark, point)


class _Way:
    """The way from one stiffness to another."""

    def __init__(self, here: FourierStiffness, there: FourierStiffness) -> None:
        order = max(here.order, there.order)
        self.mean = np.array([here.mean, there.mean])
        self.harmonics = np.zeros((2, order), dtype=complex)
        for row, stiffness in zip(self.harmonics, (here, there), strict=True):
            row[: stiffness.order] = np.array(stiffness.amplitudes) * np.exp(1j * np.array(stiffness.phases))

    def at(self, s: float) -> FourierStiffness:
        """Stiffness a part s of the way on; harmonics of no size yet in the phase that they will have."""
        harmonics = (1.0 - s) * self.harmonics[0] + s * self.harmonics[1]
        ahead = np.where(harmonics == 0.0, self.harmonics[1] - self.harmonics[0], harmonics)
        mean = float((1.0 - s) * self.mean[0] + s * self.mean[1])
        return FourierStiffness(mean, tuple(np.abs(harmonics).tolist()), tuple(np.angle(ahead).tolist()))

    def slopes(self, s: float) -> dict[str, float]:
        """Derivatives of mean, amplitudes and phases by s, by the names of the parameters."""
        now, change = self.at(s), self.harmonics[1] - self.harmonics[0]
        turned = change * np.exp(-1j * np.array(now.phases))
        slopes_by_name = {"stiffness.mean": float(self.mean[1] - self.mean[0])}
        for j, size in enumerate(now.amplitudes):
            slopes_by_name[f"stiffness.amplitudes[{j}]"] = float(turned[j].real)
            slopes_by_name[f"stiffness.phases[{j}]"] = float(turned[j].imag) / size if size else 0.0
        return {name: slope for name, slope in slopes_by_name.items() if slope}


def _stepped(mark: Mark, way: _Way, done: float, end: float) -> Mark | None:
    """The point at the end of a step; None where it is not found near where it was foretold."""
    slopes = way.slopes(done)
    foretold = np.zeros(len(mark.place))
    if slopes:
        before = mark.oscillator.stiffness_name.removesuffix("stiffness")
        names = [f"{before}{name}" for name in slopes]
        foretold = (end - done) * (mark.slopes(names) @ np.array(list(slopes.values())))
    moved = mark.moved(mark.oscillator.with_contact_stiffness(way.at(end)), foretold)
    if moved is None:
        return None
    size = np.full(len(mark.place), scale_of(mark.oscillator, mark.place[:-1]))
    size[-1] = max(abs(mark.value), 1e-300)
    off: Array = np.abs(moved.place - mark.place - foretold) / size
    return moved if float(np.max(off)) <= NEAR else None


def _special(mark: Mark, like: SpecialPoint) -> SpecialPoint | None:
    """Record of the point that a mark stands at."""
    here = mark.oscillator.with_parameter(mark.parameter, mark.value)
    low, state = np.zeros(1), mark.place[:-1]
    problem = special_problem(
        here, (mark.parameter,), mark.periods, low, np.array([mark.value]), scale_of(here, state)
    )
    place = problem.unknowns(state, mark.place[-1:])
    at, finer = problem.evaluate(place), special_orbit(problem, mark.condition, place, refinement=2, limit=4)
    if at is None or finer is None:
        return None
    return replace(
        like,
        parameter=mark.value,
        state=state.copy(),
        multipliers=at.multipliers,
        label=motion_label(mark.periods, at.counts),
        error=max(abs(finer.value / mark.value - 1.0), EPS),
    )
