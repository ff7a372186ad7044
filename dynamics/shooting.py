"""Periodic orbits by Newton shooting on the exact period map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from base import Cost, Faults, Stopwatch
from dynamics.flow import MapResult, Tables, checked_state, period_map, tables
from dynamics.multiple_shooting import chain_error, shoot_in_stretches, stretch_starts
from dynamics.oscillator import GearOscillator

__all__ = ["Orbit", "find_orbit", "floquet_multipliers", "motion_label"]

FloatArray = npt.NDArray[np.float64]
EPS = float(np.finfo(np.float64).eps)
LONG = 200  # cells of an orbit that multiple shooting is tried for, too, where one shot fails
FAR = 1e6  # stretch of the map beyond which one shot loses too many digits


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic motion.

    Parameters
    ----------
    oscillator : GearOscillator
        What moves.
    state : ndarray, shape (2,)
        X and V at tau = 0; nan if not converged.
    periods : int
        Its least period n, in excitation periods; it may be a divisor of the number asked for.
    multipliers : ndarray, shape (2,)
        Floquet multipliers over n periods, the larger modulus first; complex if they are a pair.
    stable : bool
        Both multipliers within the unit circle (or a pair on it, without damping).
    label : str
        n-p-q: periods, exits from X > D, entries into X < -D; "U" before it if unstable.
    counts : tuple of int
        p and q.
    jacobian : ndarray, shape (2, 2)
        Derivative of the n-period map.
    residual : float
        Largest component of map minus state.
    error : float
        Estimated relative error of the state: the Newton step that tables with half the cell would still
        take.
    cost : Cost
        Effort.
    converged : bool
        Whether the residual is down to rounding.
    message : str
        What happened, with a remedy if it did not converge.
    history : tuple of float
        Residual of every iteration; empty after multiple shooting.
    nodes : ndarray, shape (m, 2)
        After multiple shooting: X and V at m equal parts of the period, from tau = 0. A motion that starts from
        `state` alone leaves so unstable an orbit within one period. Else empty.
    """

    oscillator: GearOscillator
    state: FloatArray
    periods: int
    multipliers: npt.NDArray[np.complex128] | FloatArray
    stable: bool
    label: str
    counts: tuple[int, int]
    jacobian: FloatArray
    residual: float
    error: float
    cost: Cost
    converged: bool
    message: str
    history: tuple[float, ...]
    nodes: FloatArray

    @cached_property
    def points(self) -> FloatArray:
        """X and V after each excitation period, shape (periods, 2)."""
        return period_map(self.oscillator, self.state, self.periods).states

    @property
    def determinant(self) -> float:
        r"""Exact determinant of the Jacobian, :math:`e^{-4 \pi \zeta n / \omega}`."""
        return exact_determinant(self.oscillator, self.periods)


def exact_determinant(oscillator: GearOscillator, periods: int) -> float:
    r"""Return :math:`\det DP^n = e^{-4 \pi \zeta n / \omega}`; the damping is the same in every region."""
    return math.exp(-2.0 * oscillator.damping_ratio * oscillator.period * periods)


def floquet_multipliers(trace: float, determinant: float) -> npt.NDArray[np.complex128] | FloatArray:
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


def is_stable(multipliers: npt.NDArray[np.complex128] | FloatArray) -> bool:
    """Tell whether both multipliers lie within the unit circle, or are a pair on it up to rounding."""
    largest = float(np.max(np.abs(multipliers)))
    return largest < 1.0 or (np.iscomplexobj(multipliers) and largest < 1.0 + 4.0 * EPS)


def motion_label(periods: int, counts: tuple[int, int], stable: bool = True) -> str:
    """Label n-p-q of a motion, with "U" before it if unstable."""
    return f"{'' if stable else 'U'}{periods}-{counts[0]}-{counts[1]}"


def find_orbit(
    oscillator: GearOscillator,
    guess: npt.ArrayLike,
    periods: int = 1,
    *,
    max_iterations: int = 60,
    transient: int = 0,
) -> Orbit:
    """Find a periodic orbit, stable or not, by Newton's method on the period map.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    guess : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Period of the orbit sought, in excitation periods.
    max_iterations : int
        Newton iterations.
    transient : int
        Periods to follow the motion before Newton starts, to come close to an attractor.

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
    One shot over an orbit with a multiplier of size m loses the digits of m. Where the map stretches by more than
    1e6, or the shot is lost altogether, the states at the starts of many stretches are the unknowns (multiple
    shooting); `Orbit.nodes` holds them.
    """
    watch = Stopwatch()
    faults = Faults()
    n = faults.whole("periods", periods, 1, 100_000, "give the number of excitation periods")
    limit = faults.whole("max_iterations", max_iterations, 1, 100_000, "60 is ample")
    wait = faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    table = tables(oscillator)
    state = checked_state(guess, "guess")
    used = wait
    if wait:
        state = period_map(table, state, 1, skip=wait - 1).state
    x, image, history, spent = newton(table, state, n, limit)
    used += spent
    scale = max(float(np.max(np.abs(x))), oscillator.half_backlash, 1e-300)
    rounding = 64.0 * EPS * scale * max(1.0, float(np.max(np.abs(image.jacobian))))
    residual = history[-1]
    good = bool(residual <= rounding and residual <= 1e-6 * scale)
    lost = image.message or not float(np.max(np.abs(image.jacobian))) < FAR
    if lost or (not good and table.cells * n > LONG):
        orbit = _in_stretches(
            oscillator, table, x if np.all(np.isfinite(x)) else state, n, limit, watch, used
        )
        if orbit is not None:
            return orbit
    if good:
        n, image = least_period(table, x, n, image)
        residual = float(np.max(np.abs(image.state - x)))
    finer = period_map(tables(oscillator, refinement=2), x, n) if good else image
    used += 2 * n
    if good:
        step = newton_step(image.jacobian, finer.state - x)
        error = float(np.max(np.abs(step))) / scale
        good = error < 1e-3 and scale < 1e9 * _natural_size(oscillator, guess)
    if good:
        message = f"converged in {len(history) - 1} iterations"
        if n != periods:
            message += f"; the orbit has period {n}, a divisor of the {periods} asked for"
    else:
        error = math.nan
        message = image.message or _remedy(residual, image, scale, oscillator)
    cost = Cost(watch.seconds, 2, len(history) - 1, used)
    return make_orbit(oscillator, x, n, image, residual, error, cost, good, message, tuple(history))


def _in_stretches(
    oscillator: GearOscillator,
    table: Tables,
    guess: FloatArray,
    n: int,
    limit: int,
    watch: Stopwatch,
    used: int,
) -> Orbit | None:
    """Orbit by multiple shooting, from which even an orbit of a multiplier of 1e18 keeps its digits."""
    chain = shoot_in_stretches(oscillator, table, guess, n, limit)
    if chain is None:
        return None
    error = chain_error(tables(oscillator, refinement=2), chain, stretch_starts(table, n))
    scale = max(float(np.max(np.abs(chain.nodes))), 1e-300)
    if not (error < 1e-3 and scale < 1e9 * _natural_size(oscillator, guess)):
        return None
    each = len(chain.nodes) // n
    starts = chain.nodes[::each]
    least = next(
        d for d in range(1, n + 1) if n % d == 0 and np.max(np.abs(starts[d % n] - starts[0])) <= 1e-9 * scale
    )
    if least < n:
        return _in_stretches(oscillator, table, chain.nodes[0], least, limit, watch, used)
    image = MapResult(np.roll(starts, -1, axis=0), chain.jacobian, np.array([chain.counts]), "")
    message = f"converged in {chain.iterations} iterations on {len(chain.nodes)} stretches"
    cost = Cost(watch.seconds, chain.nodes.size, chain.iterations, used + n * chain.iterations)
    return make_orbit(
        oscillator,
        chain.nodes[0].copy(),
        n,
        image,
        chain.residual,
        error,
        cost,
        True,
        message,
        nodes=chain.nodes,
    )


def make_orbit(
    oscillator: GearOscillator, x: FloatArray, n: int, image: MapResult, residual: float, error: float, cost:
    Cost, converged: bool, message: str, history: tuple[float, ...] = (), nodes: FloatArray | None = None,
) -> Orbit:  # fmt: skip
    """Assemble an orbit from its state and the image of the state."""
    if not converged:
        lost = np.full(2, np.nan)
        return Orbit(
            oscillator, lost, n, lost.copy(), False, "", (0, 0), np.full((2, 2), np.nan), residual, math.nan,
            cost, False, message, history, np.empty((0, 2)),
        )  # fmt: skip
    multipliers = floquet_multipliers(float(np.trace(image.jacobian)), exact_determinant(oscillator, n))
    counts = (int(image.counts[:, 0].sum()), int(image.counts[:, 1].sum()))
    stable = is_stable(multipliers)
    return Orbit(
        oscillator, x, n, multipliers, stable, motion_label(n, counts, stable), counts, image.jacobian,
        residual, error, cost, True, message, history, np.empty((0, 2)) if nodes is None else nodes,
    )  # fmt: skip


def newton_step(jacobian: FloatArray, image_minus_state: FloatArray) -> FloatArray:
    """Correction of the state; the one of least norm where a multiplier is exactly one."""
    matrix = np.eye(2) - jacobian
    if not np.all(np.isfinite(matrix)):
        return np.full(2, np.nan)
    return np.asarray(np.linalg.lstsq(matrix, image_minus_state, rcond=4.0 * EPS)[0], dtype=np.float64)


def newton(
    table: Tables, start: FloatArray, n: int, limit: int
) -> tuple[FloatArray, MapResult, list[float], int]:
    """Newton's method with step halving; returns state, its image, residuals and periods used.

    It goes on until the residual no longer falls, so that the result is good to rounding, not to a tolerance.
    """
    x = start
    image = period_map(table, x, n)
    history = [_size(image, x)]
    used = n
    while len(history) <= limit and math.isfinite(history[-1]) and history[-1] > 0.0:
        step = newton_step(image.jacobian, image.state - x)
        factor = 1.0
        best: tuple[float, FloatArray, MapResult] | None = None
        while factor >= 1.0 / 64.0:
            trial = x + factor * step
            there = period_map(table, trial, n) if np.all(np.isfinite(trial)) else None
            used += n
            if there is not None:
                size = _size(there, trial)
                if best is None or size < best[0]:
                    best = (size, trial, there)
                if size < history[-1]:
                    break
            if float(np.max(np.abs(step))) <= 1e-10 * max(float(np.max(np.abs(x))), 1e-300):
                break  # this close a step that does not help is rounding
            factor *= 0.5
        if best is None or not best[0] < history[-1]:
            break
        x, image = best[1], best[2]
        history.append(best[0])
    return x, image, history, used


def least_period(table: Tables, x: FloatArray, n: int, image: MapResult) -> tuple[int, MapResult]:
    """Smallest divisor of n after which the orbit closes."""
    scale = max(float(np.max(np.abs(image.states))), 1e-300)
    for divisor in range(1, n // 2 + 1):
        if n % divisor == 0 and float(np.max(np.abs(image.states[divisor - 1] - x))) <= 1e-9 * scale:
            return divisor, period_map(table, x, divisor)
    return n, image


def _size(image: MapResult, x: FloatArray) -> float:
    return float(np.max(np.abs(image.state - x)))


def _natural_size(oscillator: GearOscillator, guess: npt.ArrayLike) -> float:
    """Size of the displacements that go in."""
    o = oscillator
    return max(
        float(np.max(np.abs(guess))), o.half_backlash, abs(o.mean_force), abs(o.error_amplitude), 1e-300
    )


def _remedy(residual: float, image: MapResult, scale: float, oscillator: GearOscillator) -> str:
    """Why Newton's method stopped, and what to try."""
    resonant = abs(1.0 - np.trace(image.jacobian) + exact_determinant(oscillator, 1)) < 1e-6
    if resonant and scale > 1e6:
        return "resonance: a multiplier is one and the motion grows without end; change frequency or damping"
    stretch = float(np.max(np.abs(image.jacobian)))
    if stretch * EPS * 64.0 > 1e-6:
        return (
            f"the map stretches by {stretch:.1e}: one shot over so long or unstable a period loses all digits"
        )
    return (
        f"stopped at a residual of {residual:.1e} (motion of size {scale:.1e}): start nearer, "
        "for an attractor with transient=300, or try another number of periods"
    )
