"""Periodic orbits by Newton shooting on the period map of any flow."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Stopwatch, part, quantity, record
from dynamics.flow.flows import flow_of
from dynamics.flow.protocol import Flow, MapResult
from dynamics.model.limits import NEWTON_STEPS, ORBIT_PERIODS, TRANSIENT
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import EPS, Oscillator
from dynamics.model.reasons import FLOW
from dynamics.model.states import checked_state
from dynamics.orbits.multiple_shooting import shoot_in_stretches

LONG = 200  # cells of an orbit that many shots are tried for, too, where one shot fails


@record
class Orbit:
    """A periodic motion."""

    no_error = FLOW

    headline = ("label", "periods", "stable", "residual")

    oscillator: Any = part("what moves: a `GearOscillator`, a `SmoothOscillator` or a `DriveOscillator`")
    state: Array = quantity(
        "1", "X and V at tau = 0, or displacements and speeds; nan if not converged", "coordinate"
    )
    periods: int = quantity(
        "1", "smallest period n, in excitation periods; it may be a divisor of the number asked for"
    )
    multipliers: npt.NDArray[np.complex128] | Array = quantity(
        "1",
        "Floquet multipliers over n periods, the larger modulus first; complex if they are a pair",
        "multiplier",
    )
    stable: bool = quantity("1", "all multipliers within the unit circle (or a pair on it, without damping)")
    label: str = quantity(
        "", "n-p-q: periods, exits from X > D, entries into X < -D; U before it if unstable"
    )
    counts: tuple[int, int] = quantity("1", "p and q", "side")
    jacobian: Array = quantity("1", "derivative of the n-period map", "row column")
    determinant: float = quantity(
        "1", "determinant of the Jacobian, from all damping along the motion; free rotations left out"
    )
    residual: float = quantity("1", "largest component of map minus state")
    error: float = quantity(
        "1", "estimated relative error of the state: the Newton step that a finer flow would still take"
    )
    cost: Cost
    converged: bool = quantity("1", "whether the residual is down to what the flow leaves")
    message: str = quantity("", "what happened, with a remedy if it did not converge")
    history: tuple[float, ...] = quantity(
        "1", "residual of every iteration; empty after many shots", "iteration"
    )
    nodes: Array = quantity(
        "1", "after multiple shooting: states at equal parts of the period; a motion from the state alone leaves so "
        "unstable an orbit within one period", "node coordinate",
    )  # fmt: skip
    tolerance: float | None = quantity("1", "of the flow, as asked for; None for its own", default=None)

    @cached_property
    def points(self) -> Array:
        """States after each excitation period, shape (periods, dimension)."""
        flow = flow_of(self.oscillator, self.tolerance)
        return flow.follow(self.state, self.periods, derivatives=False).states


def floquet_multipliers(trace: float, determinant: float) -> npt.NDArray[np.complex128] | Array:
    """Eigenvalues of a 2 x 2 map, the larger modulus first.

    The smaller one is taken as the determinant over the larger, which keeps its digits when they differ by
    many orders of magnitude.

    Parameters
    ----------
    trace, determinant : float
        Of the map.
    """
    half = 0.5 * trace
    square = half * half - determinant
    if square < 0.0:
        return np.array([complex(half, math.sqrt(-square)), complex(half, -math.sqrt(-square))])
    large = half + math.copysign(math.sqrt(square), half)
    return np.array([large, determinant / large if large != 0.0 else 0.0])


def multipliers_of(jacobian: Array, determinant: float) -> npt.NDArray[np.complex128] | Array:
    """Eigenvalues of a map, the larger modulus first; `determinant` is its own, which the plane makes use of."""
    if len(jacobian) == 2:
        return floquet_multipliers(float(np.trace(jacobian)), determinant)
    values = np.linalg.eigvals(jacobian) if np.all(np.isfinite(jacobian)) else np.full(len(jacobian), np.nan)
    return np.asarray(values[np.argsort(-np.abs(values), kind="stable")])


def is_stable(multipliers: npt.NDArray[np.complex128] | Array) -> bool:
    """Whether all multipliers lie within the unit circle, or are a pair on it up to rounding."""
    limit = 1.0 + 4.0 * EPS if np.iscomplexobj(multipliers) else 1.0
    return all(abs(multiplier) < limit for multiplier in multipliers.tolist())


def motion_label(periods: int, counts: tuple[int, int], stable: bool = True) -> str:
    """Label n-p-q of a motion, with "U" before it if unstable."""
    return f"{'' if stable else 'U'}{periods}-{counts[0]}-{counts[1]}"


def find_orbit(
    oscillator: Oscillator,
    guess: npt.ArrayLike,
    periods: int = 1,
    *,
    max_iterations: int = 60,
    transient: int = 0,
    tolerance: float | None = None,
) -> Orbit:
    """Find a periodic orbit, stable or not, by Newton's method on the period map.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    guess : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Period of the orbit sought, in excitation periods.
    max_iterations : int
        Newton iterations.
    transient : int
        Periods to follow the motion before Newton starts, to come close to an attractor.
    tolerance : float, optional
        Of the flow, as of `period_map`; 1e-12 for steps, rounding for the exact flow.

    Returns
    -------
    Orbit
        With converged = False and nan for its figures if Newton's method did not arrive.

    Raises
    ------
    InputError
        If an argument is out of range.

    Notes
    -----
    One shot over an orbit with a multiplier of size m loses the digits of m. Where the exact map stretches by more than
    1e6, or the shot is lost altogether, the states at the starts of many stretches are the unknowns (multiple
    shooting); `Orbit.nodes` holds them.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> orbit = find_orbit(oscillator, guess=(0.5, 0.2))
    >>> orbit.label, orbit.stable, orbit.converged
    ('U1-1-0', False, True)
    """
    watch = Stopwatch()
    with Faults() as faults:
        n = faults.whole("periods", periods, *ORBIT_PERIODS)
        limit = faults.whole("max_iterations", max_iterations, *NEWTON_STEPS)
        wait = faults.whole("transient", transient, *TRANSIENT)
    flow = flow_of(oscillator, tolerance)
    state = checked_state(guess, "guess", flow.dimension)
    size = max(float(np.max(np.abs(state))), oscillator.natural_size)
    used = wait
    if wait:
        state = flow.follow(state, 1, wait - 1, derivatives=False).state
    x, image, history, spent = newton(flow, state, n, limit)
    used += spent
    scale = max(float(np.max(np.abs(x))), oscillator.floor)
    stretch = float(np.max(np.abs(image.jacobian)))
    residual = history[-1]
    good = bool(residual <= flow.noise * scale * max(1.0, stretch) and residual <= 1e-6 * scale)
    lost = bool(image.message) or not stretch < OPTIONS.shot_stretch
    if lost or not good:
        start = x if np.all(np.isfinite(x)) else state
        orbit = _in_stretches(oscillator, flow, start, n, limit, size, lost, watch, used)
        if orbit is not None:
            return orbit
    error, message = math.nan, image.message or _remedy(residual, image, scale, flow)
    if good:
        n, image = least_period(flow, x, n, image)
        residual = float(np.max(np.abs(image.state - x)))
        finer = flow.finer().follow(x, n, derivatives=False)
        error = float(np.max(np.abs(newton_step(image.jacobian, finer.state - x)))) / scale
        good = error < OPTIONS.orbit_error and scale < 1e9 * size
        if good:
            message = f"converged in {len(history) - 1} iterations"
            if n != periods:
                message += f"; the orbit has period {n}, a divisor of the {periods} asked for"
        elif scale < 1e6 * size:
            message = f"the orbit moves by {error:.0e} of its size on a finer flow: lower the tolerance"
    cost = Cost(watch.seconds, len(x), len(history) - 1, used + 2 * n)
    return make_orbit(
        oscillator, x, n, image, residual, error if good else math.nan, cost, good, message, tuple(history),
        tolerance=tolerance,
    )  # fmt: skip


def _in_stretches(
    oscillator: Any, flow: Flow, guess: Array, n: int, limit: int, size: float, lost: bool, watch: Stopwatch,
    used: int,
) -> Orbit | None:  # fmt: skip
    """Orbit by multiple shooting, from which even an orbit of a multiplier of 1e18 keeps its digits.

    Of flows alone that can be followed by parts of a period; tried where one shot is lost, or is not enough for a long
    orbit.
    """
    parts = flow.parted()
    if parts is None or (not lost and parts.cells * n <= LONG):
        return None
    chain = shoot_in_stretches(oscillator, parts, guess, n, limit)
    if chain is None:
        return None
    nodes = chain.nodes
    scale = max(float(np.max(np.abs(nodes))), 1e-300)
    if not (chain.error < OPTIONS.orbit_error and scale < 1e9 * size):
        return None
    starts = nodes[:: len(nodes) // n]
    least = next(
        d for d in range(1, n + 1) if n % d == 0 and np.max(np.abs(starts[d % n] - starts[0])) <= 1e-9 * scale
    )
    if least < n:
        return _in_stretches(oscillator, flow, nodes[0], least, limit, size, True, watch, used)
    message = f"converged in {chain.iterations} iterations on {len(nodes)} stretches"
    cost = Cost(watch.seconds, nodes.size, chain.iterations, used + n * chain.iterations)
    decay = -parts.damped(chain.contact, n)
    image = MapResult(np.roll(starts, -1, axis=0), chain.jacobian, decay, np.array([chain.counts]), "", cost)
    return make_orbit(
        oscillator, nodes[0].copy(), n, image, chain.residual, chain.error, cost, True, message, nodes=nodes
    )


def make_orbit(
    oscillator: Oscillator, x: Array, n: int, image: MapResult, residual: float, error: float, cost: Cost,
    converged: bool, message: str, history: tuple[float, ...] = (), nodes: Array | None = None,
    tolerance: float | None = None,
) -> Orbit:  # fmt: skip
    """Assemble an orbit from its state and the image of the state, of nan if it has not converged."""
    none = np.empty((0, len(x)))
    if not converged:
        lost = np.full(len(x), np.nan)
        return Orbit(
            oscillator, lost, n, lost.copy(), False, "", (0, 0), np.full((len(x), len(x)), np.nan), math.nan,
            residual, error, cost, False, message, history, none, tolerance,
        )  # fmt: skip
    determinant = math.exp(image.log_determinant)
    multipliers = multipliers_of(image.jacobian, determinant)
    stable, counts = is_stable(multipliers), image.impacts
    return Orbit(
        oscillator, x, n, multipliers, stable, motion_label(n, counts, stable), counts, image.jacobian, determinant,
        residual, error, cost, True, message, history, none if nodes is None else nodes, tolerance,
    )  # fmt: skip


def newton_step(jacobian: Array, image_minus_state: Array) -> Array:
    """Correction of the state; the one of smallest norm where a multiplier is exactly one."""
    matrix = np.eye(len(jacobian)) - jacobian
    if not np.all(np.isfinite(matrix)):
        return np.full(len(jacobian), np.nan)
    return np.asarray(np.linalg.lstsq(matrix, image_minus_state, rcond=4.0 * EPS)[0], dtype=np.float64)


def newton(flow: Flow, start: Array, n: int, limit: int) -> tuple[Array, MapResult, list[float], int]:
    """Newton's method with step halving; returns state, its image, residuals and periods used.

    It goes on until the residual no longer falls, so that the result is as good as the flow, not as a tolerance.
    """
    x = start
    image = flow.follow(x, n)
    history = [_gap(image, x)]
    used = n
    close = max(1e-10, 1e3 * flow.tolerance)  # so short a step that does not help is noise
    while len(history) <= limit and math.isfinite(history[-1]) and history[-1] > 0.0:
        step = newton_step(image.jacobian, image.state - x)
        factor = 1.0
        best: tuple[float, Array, MapResult] | None = None
        while factor >= 1.0 / 64.0:
            trial = x + factor * step
            there = flow.follow(trial, n) if np.all(np.isfinite(trial)) else None
            used += n
            if there is not None:
                size = _gap(there, trial)
                if best is None or size < best[0]:
                    best = (size, trial, there)
                if size < history[-1]:
                    break
            if float(np.max(np.abs(step))) <= close * max(float(np.max(np.abs(x))), 1e-300):
                break
            factor *= 0.5
        if best is None or not best[0] < history[-1]:
            break
        x, image = best[1], best[2]
        history.append(best[0])
    return x, image, history, used


def least_period(flow: Flow, x: Array, n: int, image: MapResult) -> tuple[int, MapResult]:
    """Smallest divisor of n after which the orbit closes."""
    stretch = max(1.0, float(np.max(np.abs(image.jacobian))))
    close = max(1e-9, flow.noise * stretch) * max(float(np.max(np.abs(image.states))), 1e-300)
    for divisor in range(1, n // 2 + 1):
        if n % divisor == 0 and float(np.max(np.abs(image.states[divisor - 1] - x))) <= close:
            return divisor, flow.follow(x, divisor)
    return n, image


def _gap(image: MapResult, x: Array) -> float:
    return float(np.max(np.abs(image.state - x)))


def _remedy(residual: float, image: MapResult, scale: float, flow: Flow) -> str:
    """Why Newton's method stopped, and what to try."""
    resonant = abs(np.linalg.det(np.eye(len(image.jacobian)) - image.jacobian)) < 1e-6
    if resonant and scale > 1e6:
        return "resonance: a multiplier is one and the motion grows without end; change frequency or damping"
    stretch = float(np.max(np.abs(image.jacobian)))
    if stretch * flow.noise > 1e-6:
        remedy = "" if flow.tolerance <= EPS else "; lower the tolerance"
        return (
            f"the map stretches by {stretch:.1e}: one shot over so long or unstable a period loses all digits"
            f"{remedy}"
        )
    return (
        f"stopped at a residual of {residual:.1e} (motion of size {scale:.1e}): start nearer, "
        "for an attractor with transient=300, or try another number of periods"
    )
