"""From the last two grids to the film in SI, or to the reason why there is none."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from base import Array, RangeWarning
from ehl.discrete.method import METHOD
from ehl.discrete.supply import OilLayer, Supply
from ehl.films.film import Film, FilmErrors, Spike
from ehl.solving.grid_search import GridSearch
from ehl.solving.levels import Level, State, figures, spike_of
from ehl.solving.plan import Plan
from ehl.solving.response import Slopes, slopes

_SEPARATION_LOSS = 20.0  # times the film's own error by the finite inlet


def film_error(coarse: Level, fine: Level) -> float:
    """Estimated relative error of central and minimum film on the finer of two grids.

    The changes of central film, of minimum film and of the film between them (root mean square over the dry
    contact's width) are added: any one may be small by accident, and three of first order are not. The largest is all
    that is left where films converge with the first order, and films do with no less.
    """
    before, after = figures(coarse), figures(fine)
    at = coarse.grid.nodes
    weights = np.where(np.abs(at) <= 1.0, coarse.grid.weights, 0.0)
    change = coarse.solution.H / np.interp(at, fine.grid.nodes, fine.solution.H) - 1.0
    profile = math.sqrt(float(weights @ change**2 / weights.sum()))
    central = abs(before.central_thickness / after.central_thickness - 1.0)
    lowest = abs(before.minimum_thickness / after.minimum_thickness - 1.0)
    return min(METHOD.grid_factor * (profile + central + lowest), max(profile, central, lowest))


def central_error(film: Film) -> float:
    """Estimated relative error of the central film alone, which changes less between grids than the rest does."""
    assert film.state is not None
    coarse, fine = film.state.coarse, film.state.fine
    change = figures(coarse).central_thickness / figures(fine).central_thickness - 1.0
    return film.error - film_error(coarse, fine) + METHOD.grid_factor * abs(change)


def pressure_error(coarse: Level, fine: Level) -> float:
    """Mean change of the pressure between two grids over its mean, and the teeth before the spike on the finer."""
    at, weights = coarse.grid.nodes, coarse.grid.weights
    change = np.abs(coarse.solution.P - np.interp(at, fine.grid.nodes, fine.solution.P))
    return float(weights @ change / (weights @ coarse.solution.P)) + teeth(fine.solution.P) / float(
        fine.solution.P.max()
    )


def teeth(P: Array) -> float:
    """All that a pressure rises between its first maximum and its climb to the last one: 0 if both are clean."""
    tops = np.flatnonzero((P[1:-1] >= P[:-2]) & (P[1:-1] > P[2:])) + 1
    if tops.size < 2:
        return 0.0
    falls = np.flatnonzero(np.diff(P[: tops[-1] + 1]) <= 0.0)
    climb = int(falls[-1]) + 1
    return float(np.maximum(np.diff(P[tops[0] : climb + 1]), 0.0).sum())


def spike_error(coarse: Level, fine: Level) -> float:
    """Relative change of the spike's pressure between two grids laid around it; 0 without a spike."""
    before, after = spike_of(coarse), spike_of(fine)
    if after is None:
        return 0.0 if before is None else math.inf
    if before is None or fine.plan.spike is None:
        return math.inf
    return abs(before.height / after.height - 1.0)


@dataclass(frozen=True)
class GridSolution:
    """Two grids with what they differ by, or the reason why there are none."""

    run: GridSearch
    coarse: Level
    fine: Level
    error: float  # estimated, of central and minimum film
    inlet: float  # share of it that is the finite inlet's
    failure: str = ""
    note: str = ""  # said of a solution
    supply: Supply | None = None  # where it is not what holds the inlet

    @property
    def converged(self) -> bool:
        """Whether there is a film; its error may be above the tolerance, which the note then says."""
        return not self.failure

    @property
    def state(self) -> State:
        """What a next solution starts from."""
        return State(self.coarse, self.fine, self.run.flooded)

    def film(self) -> Film:
        """Return the film in SI, or one without figures."""
        if self.failure:
            return failed_film(self.run, self.fine, self.failure, self.error)
        film = film_of(self.run, self.coarse, self.fine, self.error, self.inlet)
        return replace(film, supply=self.supply, message=self.note) if self.note else film


def above(error: float, tolerance: float, nodes: int) -> str:
    """Message of a film whose error is above the tolerance on the finest grid."""
    return (
        f"converged; the error of {error:.2g} is above the tolerance of {tolerance:.2g}, "
        f"and {nodes} nodes are the most"
    )


def film_of(run: GridSearch, coarse: Level, fine: Level, error: float, inlet: float) -> Film:
    """Return the film in SI."""
    contact, solution, supply = run.contact, fine.solution, run.supply
    shown, before = figures(fine), figures(coarse)
    slope, slope_before = slopes(fine, supply), slopes(coarse, supply)
    change = before.separation / shown.separation - 1.0
    off = METHOD.grid_factor * abs(change) + _SEPARATION_LOSS * inlet
    errors = FilmErrors(
        film=error,
        separation=off,
        inlet=inlet,
        separation_shift=math.copysign(off, change),
        pressure=pressure_error(coarse, fine),
        **slope_errors(slope_before, slope, inlet),
    )
    groups = fine.groups
    message = "converged"
    if solution.P[-2] > 0.0:
        message = "converged; the film reaches the outlet of the domain, which cuts it off there"
        warnings.warn(message, RangeWarning, stacklevel=5)
    return Film(
        **_frame(run, fine),
        **vars(shown),
        pressure=solution.P * groups.pressure,
        thickness=solution.H * groups.gap,
        separation_slope=slope.separation / contact.load,
        central_slope=slope.central / contact.load,
        flow=fine.flow,
        flux_error=solution.flux_error,
        load_error=solution.load_error,
        errors=errors,
        converged=True,
        message=message,
        spike=_spike(coarse, fine),
        state=State(coarse, fine, run.flooded).bare(),
    )


def slope_errors(coarse: Slopes, fine: Slopes, inlet: float, rest: float = 0.0) -> dict[str, float]:
    """Errors of the derivatives by the load, from two grids; ``rest`` is what corrections would still change."""
    lost = _SEPARATION_LOSS * inlet + rest
    steeper = coarse.separation / fine.separation - 1.0
    return {
        "approach_stiffness": abs(steeper) + fine.ripple + lost,
        "tangent_stiffness": abs(coarse.central / fine.central - 1.0) + lost,
        "slope_shift": METHOD.grid_factor * steeper,
    }


def _spike(coarse: Level, fine: Level) -> Spike | None:
    """Return the spike in SI; its error is known only where both grids were laid around it."""
    tip, contact = spike_of(fine), fine.contact
    if tip is None:
        return None
    off = math.inf if coarse.plan.spike is None else spike_error(coarse, fine)
    return Spike(
        position=tip.position * contact.half_width,
        pressure=tip.height * contact.peak_pressure,
        width=tip.width * contact.half_width,
        error=off if off < math.inf else math.nan,
    )


def failed_film(run: GridSearch, fine: Level, reason: str, error: float = math.nan) -> Film:
    """Return a film without figures."""
    blank = np.full(fine.grid.nodes.size, math.nan)
    return Film(
        **_frame(run, fine),
        pressure=blank,
        thickness=blank,
        errors=FilmErrors(error),
        converged=False,
        message=f"{reason}: {remedy(run, fine.plan)}",
    )


def _frame(run: GridSearch, fine: Level) -> dict[str, Any]:
    """What a film has whether it was solved or not."""
    x = fine.grid.nodes * fine.groups.length
    return {
        "contact": run.contact,
        "x": x,
        "inlet": float(x[0]),
        "supply": run.supply,
        "cost": run.cost(),
    }


def remedy(run: GridSearch, plan: Plan) -> str:
    """Say what to do about a contact that was not solved."""
    layer = isinstance(run.supply, OilLayer)
    if plan.fixed and not layer and plan.domain[0] > -1.05:
        return "the inlet lies at the edge of the dry contact and starves it; move it farther out"
    if plan.H_c < METHOD.dry:
        held = "the layer holds the inlet at the edge of the dry contact, and " if layer else ""
        return (
            f"{held}the film is too thin beside the flattening to be resolved (h R/b^2 = {plan.H_c:.2g}, below "
            f"{METHOD.dry:g}); take the contact as dry (separation 0)"
        )
    if run.whole_spike:
        return (
            "with this oil and load the spike is narrower than grids resolve; leave out spike, the film stays"
        )
    if plan.kind == "uniform":
        return "use the graded grid, or give more nodes"
    return "allow a larger tolerance, give more nodes, or start from a similar contact"
