"""Periodic orbits whose map stretches beyond what one shot can aim over: Newton's method on many states at once."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from base import Array, Integers
from dynamics.flow.protocol import PartedFlow
from dynamics.model.protocol import PeriodicOscillator

# four radians at most of every time scale: a stretch multiplies errors by less than 1e4
CELLS_PER_STRETCH = 8
MOST = 250  # stretches


@dataclass(frozen=True, eq=False)
class Chain:
    """States at the ends of stretches of a periodic orbit.

    Parameters
    ----------
    nodes : ndarray, shape (m, size)
        States at the starts of the stretches, the first at tau = 0.
    factors : ndarray, shape (m, size, size)
        Jacobian of every stretch.
    counts : tuple of int
        Exits from X > D and entries into X < -D.
    contact : float
        Time in contact, where damping asks for it.
    residual : float
        Largest gap between a stretch's end and the next node.
    iterations : int
        Newton iterations.
    error : float
        Largest Newton step that tables with half the cell would still take, over the size of the motion.
    """

    nodes: Array
    factors: Array
    counts: tuple[int, int]
    contact: float
    residual: float
    iterations: int
    error: float = math.nan

    @property
    def jacobian(self) -> Array:
        """Derivative of the map over the whole orbit: the product of the factors."""
        product = np.eye(self.nodes.shape[1])
        for factor in self.factors:
            product = factor @ product
        return product


def shoot_in_stretches(
    oscillator: PeriodicOscillator, table: PartedFlow, guess: Array, periods: int, limit: int
) -> Chain | None:
    """Newton's method with step halving on the states at the starts of all stretches; None if it does not arrive.

    Tried from the motion that starts at the guess, cut off where it leaves the size of what drives it, and from
    the slow balance x = D + F/K.

    Parameters
    ----------
    oscillator : PeriodicOscillator
        The oscillator.
    table : PartedFlow
        Its tables.
    guess : ndarray, shape (size,)
        State at tau = 0.
    periods : int
        Period of the orbit, in excitation periods.
    limit : int
        Newton iterations.
    """
    firsts = stretch_starts(table, periods)
    tau = np.asarray(firsts[:-1] * (oscillator.period / table.cells), dtype=np.float64)
    slow = oscillator.balanced(tau)
    for nodes in (_followed(table, guess, firsts, slow, oscillator.half_backlash), slow):
        chain = _newton(table, nodes, firsts, limit, oscillator.floor)
        if chain is not None:
            return replace(chain, error=_error(table, chain, periods))
    return None


def stretch_starts(table: PartedFlow, periods: int) -> Integers:
    """First cells of the stretches, and the cell after the last; every period begins with a stretch."""
    each = max(1, min(table.cells // CELLS_PER_STRETCH, MOST // periods))
    return np.round(np.linspace(0, table.cells * periods, each * periods + 1)).astype(np.int64)


def _error(table: PartedFlow, chain: Chain, periods: int) -> float:
    """Largest Newton step that tables with half the cell would still take, over the size of the motion."""
    ends, factors, _, _ = stretches(table.finer(), chain.nodes, 2 * stretch_starts(table, periods))
    step = newton_step(factors, ends - np.roll(chain.nodes, -1, axis=0))
    return float(np.max(np.abs(step))) / max(float(np.max(np.abs(chain.nodes))), 1e-300)


def stretches(
    table: PartedFlow, nodes: Array, firsts: Integers
) -> tuple[Array, Array, tuple[int, int], float]:
    """Ends and Jacobians of all stretches, impacts and time in contact; nan where the motion is lost."""
    size = nodes.shape[1]
    ends, factors = np.empty_like(nodes), np.empty((len(nodes), size, size))
    counts, contact = np.zeros(2, dtype=np.int64), 0.0
    lengths = np.diff(firsts)
    for i, node in enumerate(nodes):
        ends[i], factors[i], pressed = table.part(int(firsts[i]), int(lengths[i]), node, counts)
        contact += pressed
    return ends, factors, (int(counts[0]), int(counts[1])), contact


def newton_step(factors: Array, gap: Array) -> Array:
    """Correction of all nodes: d[i + 1] - factor[i] d[i] = gap[i], cyclic.

    Two blocks a row: elimination in the order of the nodes fills the last column alone, so that the cost grows with
    their number, not with its cube. nan where a stretch has lost the motion.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the equations are singular.
    """
    from scipy.sparse import bsr_array
    from scipy.sparse.linalg import splu

    m, size = gap.shape
    if not np.all(np.isfinite(factors)):
        return np.full(gap.shape, np.nan)
    if m == 1:
        return np.linalg.solve(np.eye(size) - factors[0], gap[0])[None]
    blocks = np.stack([-factors, np.broadcast_to(np.eye(size), factors.shape)], axis=1)
    columns = np.column_stack([np.arange(m), (np.arange(m) + 1) % m])
    shape = (m * size, m * size)
    matrix = bsr_array((blocks.reshape(-1, size, size), columns.ravel(), 2 * np.arange(m + 1)), shape=shape)
    try:
        solved = splu(matrix.tocsc(), permc_spec="NATURAL").solve(gap.ravel())
    except RuntimeError as fault:  # as scipy calls a singular matrix
        raise np.linalg.LinAlgError(str(fault)) from fault
    return np.asarray(solved.reshape(m, size))


def _newton(table: PartedFlow, nodes: Array, firsts: Integers, limit: int, floor: float) -> Chain | None:
    scale = max(float(np.max(np.abs(nodes))), floor)
    best, kept, step, factor = math.inf, None, np.zeros_like(nodes), 1.0
    trial = nodes
    for iteration in range(4 * limit):
        ends, factors, counts, contact = stretches(table, trial, firsts)
        gap = ends - np.roll(trial, -1, axis=0)
        size = float(np.max(np.abs(gap)))
        if size < best:
            best, nodes, factor = size, trial, 1.0
            kept = Chain(nodes, factors, counts, contact, size, iteration)
            try:
                step = newton_step(factors, gap)
            except np.linalg.LinAlgError:
                return None
            if not np.all(np.isfinite(step)):
                return None
        elif best <= 1e-11 * scale or factor < 1e-4:
            break
        else:
            factor *= 0.5
        trial = nodes + factor * step
    if kept is None:
        return None
    stretch = max(1.0, float(np.max(np.abs(kept.factors))))
    scale = max(float(np.max(np.abs(kept.nodes))), 1e-300)
    return kept if best <= 1e-14 * 64.0 * stretch * scale else None


def _followed(table: PartedFlow, guess: Array, firsts: Integers, slow: Array, half_backlash: float) -> Array:
    """Nodes on the motion from the guess; where it grows far beyond what drives it, those of the slow balance."""
    nodes = slow.copy()
    bound = 20.0 * max(float(np.max(np.abs(guess))), float(np.max(np.abs(nodes))), half_backlash)
    state, counts = guess.copy(), np.zeros(2, dtype=np.int64)
    for i, length in enumerate(np.diff(firsts)):
        if not float(np.max(np.abs(state))) < bound:
            state = nodes[i].copy()
        nodes[i] = state
        state = np.nan_to_num(table.part(int(firsts[i]), int(length), state, counts)[0], nan=np.inf)
    return nodes
