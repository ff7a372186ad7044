"""One contact on one grid, by Newton's method on all pressures and the rigid separation together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv, dgetrs

from base import Array, Integers
from ehl.discrete.equations import Grid, Groups, Oil, film_gap, fluxes, inlet_pressure, load_inside
from ehl.discrete.grid import face_weights
from ehl.discrete.method import METHOD
from ehl.discrete.squeeze import Squeeze

_PRESSURE_STEP = 0.3  # largest change of P in one step
_GAP_LEFT = 0.2  # share of the film that one step must leave
_OIL_DONE = 2e-3  # what an oil's own state may still change by, of itself
_CALM_AFTER = 20  # steps after which an oil that keeps going round is followed more slowly,
_CALM = 0.5  # by this share
_GAP_SHARE = 0.1  # a relative change of the gap counts as this much change of pressure


@dataclass(frozen=True)
class Factors:
    """The factorised Newton matrix of the last step."""

    lu: Array
    pivots: NDArray[np.int32]
    scale: Array  # factor of each flux row
    free: Integers  # nodes inside the film

    def solve(self, net_flux: Array, load: float, n: int) -> tuple[Array, float]:
        """Change of P (n,) and H0 that makes given changes of the residual (n-2,) and of the load row."""
        right = np.append(self.scale * net_flux[self.free - 1], load)
        answer, _ = dgetrs(self.lu, self.pivots, right)
        change = np.zeros(n)
        change[self.free] = answer[:-1]
        return change, float(answer[-1])


@dataclass(frozen=True)
class Iteration:
    """Where Newton's method stopped."""

    P: Array  # pressure (n,)
    H: Array  # gap (n,)
    H0: float  # rigid separation
    flux: float  # eps P' - rho H in the film
    flux_error: float  # largest net flux into a node's cell inside the film, relative to the flux
    load_error: float  # of the integral of P, relative
    iterations: int
    converged: bool
    message: str
    factors: Factors | None  # None where the last step could not be computed


def _flux_error(flux: Array, imbalance: Array, free: Integers) -> tuple[float, float]:
    """Mean flux through the faces of the film and the largest net flux into a node over it."""
    inside = flux[free[0] - 1 : free[-1] + 1]
    mean = float(np.mean(inside[inside.size // 2 :]))
    with np.errstate(invalid="ignore"):  # steps that diverged leave infinite fluxes
        return mean, float(np.max(np.abs(imbalance[free - 1])) / abs(mean))


def newton(
    grid: Grid,
    groups: Groups,
    P: Array,
    H0: float,
    *,
    upwind: bool = False,
    loose: bool = False,
    spent: int = 0,
    max_iterations: int = 60,
    oil: Oil | None = None,
    done: float = METHOD.newton_done,
    squeeze: Squeeze | None = None,
) -> Iteration:
    """Solve Reynolds' equation, the gap and the load balance together.

    The unknowns are the pressures of the nodes inside the film and H0. A node whose pressure turns negative
    leaves the film; a node outside joins it when the flux into it exceeds the flux out of it. Steps are cut
    so that no pressure changes by more than 0.3 p_a and no gap loses more than four fifths.

    Parameters
    ----------
    grid, groups : Grid, Groups
        The discrete problem.
    P, H0 : ndarray, float
        Start; P >= 0, zero at the last node, gap > 0. The first node takes the pressure of the inlet.
    upwind : bool
        First-order wedge term instead of the third-order one.
    loose : bool
        Stop once steps are below 0.01: good enough to start the next stage from.
    spent : int
        Steps already taken by an earlier stage, counted into ``iterations``.
    max_iterations : int
        Limit on the Newton steps of this stage.
    oil : Oil, optional
        Oil whose state depends on more than the pressure; it follows every step, and its own changes are not
        part of the matrix, so that the last steps shrink by a factor each.
    done : float
        Step after which the stage ends.
    squeeze : Squeeze, optional
        What the film's change in time adds to the net fluxes; steady unless given.
    """
    from ehl.kernels.film_kernels import newton_matrix

    faces = face_weights(grid.nodes, upwind=True) if upwind else grid.quick
    step_done = 1e-2 if loose else done
    influence = -groups.compliance * grid.potential
    load = load_inside(grid, groups)
    P = P.copy()
    P[0] = inlet_pressure(grid, groups)
    H = film_gap(grid, groups, P, H0)
    inside = np.zeros(P.size, dtype=bool)
    inside[1 : int(np.flatnonzero(P > 0)[-1]) + 1] = True
    message, converged, factors = f"no convergence in {max_iterations} Newton steps", False, None
    iterations = 0
    while iterations < max_iterations and not converged:
        iterations += 1
        if not H.min() > 0.0:
            message, factors = "the film falls below rounding", None
            break
        fluid = None if oil is None else oil.at(P, H)
        flux, slopes = fluxes(grid, groups, P, H, faces, fluid)
        imbalance = np.diff(flux)
        if squeeze is not None:
            swept, by = squeeze.swept(P, H)
            slopes = slopes + by
            imbalance += np.diff(swept) - squeeze.stored(P, H)[1:-1]
        joins = ~inside[1:-1] & (imbalance > 0.0)
        inside[1:-1] |= joins
        free = np.flatnonzero(inside)
        swelling = None if fluid is None else fluid.swelling
        by_pressure = influence if swelling is None else influence + swelling
        system = newton_matrix(slopes, by_pressure, grid.weights, free)
        scale = system[:-1, -1].copy()
        if squeeze is not None:
            system[:-1, :-1] -= scale[:, None] * squeeze.rows(P, H, influence, free)
        right = np.append(-scale * imbalance[free - 1], load - grid.weights @ P)
        lu, pivots, step, info = dgesv(system[:, :-1], right, overwrite_a=True, overwrite_b=True)
        if info != 0 or not np.isfinite(step).all():
            message, factors = "singular Newton matrix", None
            break
        factors = Factors(lu, pivots, scale, free)
        dP = np.zeros(P.size)
        dP[free] = step[:-1]
        dH0 = float(step[-1])
        dH = dH0 + influence @ dP
        largest = float(np.max(np.abs(dP)))
        shrink = float(np.max(-dH / H))
        t = min(1.0, _PRESSURE_STEP / max(largest, 1e-300), (1.0 - _GAP_LEFT) / max(shrink, 1e-300))
        if oil is not None and iterations > _CALM_AFTER:
            t *= _CALM
        P = P + t * dP
        leaves = inside & (P < 0.0)
        P[leaves] = 0.0
        inside &= ~leaves
        H0 += t * dH0
        settled = t >= _CALM and not joins.any() and not leaves.any()
        converged = settled and max(largest, _GAP_SHARE * float(np.max(np.abs(dH) / H))) < step_done
        converged = converged and (oil is None or oil.unsettled < _OIL_DONE)
        # clipping negative pressures presses on the bodies, which may close a gap that the step left open
        before, H = H, film_gap(grid, groups, P, H0)
        closed = float(np.max(_GAP_LEFT * before - H))
        if closed > 0.0 and leaves.any():
            H0 += closed
            H = H + closed
    flux, _ = fluxes(grid, groups, P, H, faces, None if oil is None else oil.at(P, H))
    imbalance = np.diff(flux)
    if squeeze is not None:
        imbalance += np.diff(squeeze.swept(P, H)[0]) - squeeze.stored(P, H)[1:-1]
    mean, flux_error = _flux_error(flux, imbalance, np.flatnonzero(inside))
    return Iteration(
        P=P,
        H=H,
        H0=H0,
        flux=mean,
        flux_error=flux_error,
        load_error=float(abs(grid.weights @ P / load - 1.0)),
        iterations=spent + iterations,
        converged=converged,
        message="converged" if converged else message,
        factors=factors,
    )
