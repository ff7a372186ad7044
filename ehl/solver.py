"""Steady line contacts solved to a tolerance, one by one or along a path."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ehl.contact import LineContact
from ehl.discrete import Groups
from ehl.errors import EhlInputError, EhlWarning, Fault, number_fault
from ehl.film import Cost, Film, FilmErrors
from ehl.levels import Level, Plan, State, cold, figures, slopes, warm
from ehl.regressions import moes_central

__all__ = ["solve", "solve_path"]

_FIRST_NODES = 65
_MOST_FIRST_NODES = 257
_MOST_NODES = 1025
_REACH = 40.0  # inlet length in sqrt(h R) that keeps the error of the propping below 1e-3
_PROP_LOSS = 20.0  # times the film's own error by the finite inlet
_STARTS = (2.0, 8.0)  # films to start from, over the expected one
_DRY = 1e-5  # h R/b^2 below which refusals are laid to a contact that is as good as dry
_GRID_FACTOR = (
    0.4  # error of N nodes over its difference from (N+1)/2 nodes: 1/3 at second order, with a margin
)


def _check(
    contact: LineContact, tolerance: float, nodes: int | None, domain: tuple[float, float] | None, grid: str
) -> None:
    """Raise every fault of the arguments at once."""
    faults: list[Fault] = []
    if not isinstance(contact, LineContact):
        faults.append(Fault("contact", repr(contact), "a LineContact", "build one with ehl.LineContact"))
    faults += number_fault("tolerance", tolerance, low=0.0, high=0.2, remedy="0.005 is half a per cent")
    if nodes is not None and (isinstance(nodes, bool) or not isinstance(nodes, int | np.integer)):
        faults.append(Fault("nodes", repr(nodes), "a whole number", "give none to let the tolerance decide"))
    elif nodes is not None:
        faults += number_fault("nodes", nodes, low=32, high=4097, remedy="129 is usual", open_low=False)
    if grid not in ("graded", "uniform"):
        faults.append(Fault("grid", repr(grid), "'graded' or 'uniform'", "'graded' resolves inlet and spike"))
    if domain is not None:
        try:
            left, right = (float(v) for v in domain)
        except (TypeError, ValueError):
            left = right = math.nan
        if not (-1e9 <= left <= -1.0 and 0.0 < right <= 1e9):
            faults.append(
                Fault(
                    "domain", repr(domain), "(inlet <= -1, outlet > 0) in half-widths", "(-15, 2.5) is usual"
                )
            )
    if faults:
        raise EhlInputError(faults)


def _warn(contact: LineContact) -> None:
    """Warn where the model leaves its range."""
    oil = contact.lubricant
    if oil.pressure_viscosity > 0 and contact.peak_pressure > 1e9:
        warnings.warn(
            f"Hertz pressure {contact.peak_pressure / 1e9:.2f} GPa: above about 1 GPa the viscosity law is "
            "an extrapolation; film thickness, decided in the inlet, suffers little",
            EhlWarning,
            stacklevel=4,
        )
    if moes_central(contact) > 1e-3 * contact.radius:
        warnings.warn(
            f"film of about {moes_central(contact):.2g} m at a radius of {contact.radius:.2g} m: the "
            "parabola that stands for the cylinders no longer holds over the whole inlet",
            EhlWarning,
            stacklevel=4,
        )


def _film_error(coarse: Level, fine: Level) -> float:
    """Estimated relative error of central and minimum film on the finer of two grids.

    The changes of central film, of minimum film and of the film between them (root mean square over the dry
    contact's width) are added, since any one of them may be small by accident.
    """
    before, after = figures(coarse), figures(fine)
    at = coarse.grid.nodes
    weights = np.where(np.abs(at) <= 1.0, coarse.grid.weights, 0.0)
    change = coarse.found.H / np.interp(at, fine.grid.nodes, fine.found.H) - 1.0
    profile = math.sqrt(float(weights @ change**2 / weights.sum()))
    central, minimum = before.central / after.central - 1.0, before.minimum / after.minimum - 1.0
    return _GRID_FACTOR * (abs(central) + abs(minimum) + profile)


class _Run:
    """One call of ``solve``: counts what it does and keeps the levels solved."""

    def __init__(self, contact: LineContact, plan: Plan) -> None:
        self.contact = contact
        self.plan = plan
        self.began = time.perf_counter()
        self.iterations = 0
        self.grids: list[int] = []
        self.attempts = 1

    def count(self, level: Level) -> Level:
        self.iterations += level.found.iterations
        self.grids.append(level.grid.nodes.size)
        return level

    def cold(self, n: int) -> Level:
        """Solve from nothing; where that fails, from a thicker film, then by continuation in the load."""
        grid = self.plan.grid(n)
        for thickness in _STARTS:
            level = self.count(cold(self.contact, grid, thickness * self.plan.H_c))
            if level.found.converged:
                return level
            self.attempts += 1
        return self.descend(level)

    def pair(self, half: int, n: int) -> tuple[Level, Level]:
        """Solve a coarse and a fine grid from nothing, the one that gives in first before the other."""
        coarse = self.cold(half)
        if coarse.found.converged:
            return coarse, self.warm(coarse, None, n)
        fine = self.cold(n)
        return (self.warm(fine, None, half) if fine.found.converged else coarse), fine

    def descend(self, failed: Level) -> Level:
        """Continue in the load, from a contact soft enough to be solved from cold, on the failed grid."""
        for factor in (0.5, 0.2, 0.05):
            load = factor * self.contact.load
            easier = replace(self.contact, load=load)
            level = self.count(cold(easier, failed.grid, _STARTS[-1] * self.plan.H_c / factor))
            step = 1.5
            while level.found.converged and load < self.contact.load and step > 1.01:
                target = min(self.contact.load, step * load)
                trial = self.count(warm(level, replace(self.contact, load=target), failed.grid))
                if trial.found.converged:
                    level, load = trial, target
                else:
                    step = math.sqrt(step)
            if level.found.converged and load == self.contact.load:
                return replace(level, contact=self.contact)
            self.attempts += 1
        return failed

    def warm(self, old: Level, grid_of: Level | None, n: int) -> Level:
        """Solve from another level, on its grid if one is given; from cold where that fails."""
        grid = self.plan.grid(n) if grid_of is None else grid_of.grid
        level = self.count(warm(old, self.contact, grid))
        if level.found.converged:
            return level
        self.attempts += 1
        return self.cold(n)

    def cost(self) -> Cost:
        return Cost(
            seconds=time.perf_counter() - self.began,
            unknowns=max(self.grids) - 1,
            iterations=self.iterations,
            grids=tuple(self.grids),
            attempts=self.attempts,
        )


def solve(
    contact: LineContact,
    tolerance: float = 0.005,
    nodes: int | None = None,
    domain: tuple[float, float] | None = None,
    start: Film | None = None,
    grid: str = "graded",
) -> Film:
    """Solve the steady, fully flooded, isothermal line contact.

    Reynolds' equation ``d/dx[rho h^3/(12 eta) dp/dx] = u d(rho h)/dx`` with ``p >= 0``, the gap
    ``h = h0 + x^2/2R - (4/pi E') int p ln|x - x'| dx'`` and ``int p dx = w`` are solved together by Newton's
    method.

    Parameters
    ----------
    contact : LineContact
        What to solve.
    tolerance : float
        Wanted relative error of central and minimum film. Grids of 65, 129, 257, ... nodes are solved until
        the estimate meets it.
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.
    domain : tuple of float, optional
        (inlet, outlet) in half-widths of the dry contact; there the pressure is zero. Not given, the domain
        follows the film and is long enough for a fully flooded inlet within the tolerance.
    start : Film, optional
        A film of a similar contact to start from. Its grid is kept while the film parameter h R/b^2 stays
        within a factor 1.5, so that small changes of load show no change of grid.
    grid : str
        ``"graded"`` towards inlet and pressure spike, or ``"uniform"``.

    Returns
    -------
    Film
        With ``converged=False``, NaN figures and a remedy in ``message`` if no solution was found or its
        estimated error exceeds the tolerance on the finest grid (1025 nodes).

    Raises
    ------
    EhlInputError
        With every fault of the arguments.

    Warns
    -----
    EhlWarning
        Above 1 GPa of Hertz pressure, at films thicker than a thousandth of the radius, and where the film
        reaches the outlet of a given domain.

    Notes
    -----
    Method, error estimate and limits: docs/theory/ehl.md.
    """
    _check(contact, tolerance, nodes, domain, grid)
    _warn(contact)
    reach = max(_REACH, (10.0 / tolerance) ** (1.0 / 3.0))
    plan = Plan.of(contact, grid, domain, reach)
    old = start.state if start is not None else None
    if old is not None and old.plan.serves(plan):
        plan = old.plan
    run = _Run(contact, plan)
    n = 2 * _FIRST_NODES - 1
    if nodes is not None:
        n = int(nodes)
    elif old is not None and old.plan is plan:
        n = old.fine.grid.nodes.size
    half = (n + 1) // 2
    if old is None:
        coarse, fine = run.pair(half, n)
    else:
        same = old.plan is plan
        coarse = run.warm(old.coarse if same else old.fine, _same(old.coarse, half, same), half)
        before = old.fine if same and old.fine.grid.nodes.size == n else coarse
        fine = run.warm(before, _same(old.fine, n, same), n)
    while nodes is None and n < _MOST_FIRST_NODES and not (coarse.found.converged and fine.found.converged):
        half, n = n, 2 * n - 1
        coarse, fine = run.pair(half, n)
    inlet = 0.0 if plan.fixed else (math.sqrt(plan.H_c) / (-1.0 - plan.domain[0])) ** 3
    return _refine(run, coarse, fine, tolerance if nodes is None else None, inlet)


def _same(level: Level, n: int, same: bool) -> Level | None:
    """Return the level if its grid can be used again."""
    return level if same and level.grid.nodes.size == n else None


def _refine(run: _Run, coarse: Level, fine: Level, tolerance: float | None, inlet: float) -> Film:
    """Double the grid until the estimate meets the tolerance, then report.

    A grid that fails is passed over: the next one is compared with the last that gave in.
    """
    while True:
        n = 2 * fine.grid.nodes.size - 1
        if not (coarse.found.converged and fine.found.converged):
            if coarse.found.converged and tolerance is not None and n <= _MOST_NODES:
                fine = run.warm(coarse, None, n)
                continue
            failed = fine if coarse.found.converged else coarse
            return _failed(run, fine, f"{failed.found.message}: {_remedy(run.plan)}")
        worst = _film_error(coarse, fine) + inlet
        if tolerance is None or worst <= tolerance:
            return _film(run, coarse, fine, worst, inlet)
        if n > _MOST_NODES:
            message = f"error {worst:.2g} left on {fine.grid.nodes.size} nodes: {_remedy(run.plan)}"
            return _failed(run, fine, message, worst)
        coarse, fine = fine, run.warm(fine, None, n)


def _remedy(plan: Plan) -> str:
    """Say what to do about a contact that was not solved."""
    if plan.H_c < _DRY:
        return "the film is too thin beside the flattening to be resolved; take the contact as dry (prop 0)"
    if plan.fixed and plan.domain[0] > -1.05:
        return "the inlet lies at the edge of the dry contact and starves it; move it farther out"
    if plan.kind == "uniform":
        return "use the graded grid, or give more nodes"
    return "allow a larger tolerance, give more nodes, or start from a similar contact"


def _film(run: _Run, coarse: Level, fine: Level, error: float, inlet: float) -> Film:
    """Return the film in SI."""
    contact, found = run.contact, fine.found
    shown, before = figures(fine), figures(coarse)
    slope, slope_before = slopes(fine, run.plan), slopes(coarse, run.plan)
    errors = FilmErrors(
        film=error,
        prop=_GRID_FACTOR * abs(before.prop / shown.prop - 1.0) + _PROP_LOSS * inlet,
        approach_stiffness=abs(slope_before.prop / slope.prop - 1.0) + slope.ripple + _PROP_LOSS * inlet,
        tangent_stiffness=abs(slope_before.central / slope.central - 1.0) + _PROP_LOSS * inlet,
        inlet=inlet,
    )
    groups = Groups.on(contact, fine.grid)
    x = fine.grid.nodes * groups.length
    message = "converged"
    if found.P[-2] > 0.0:
        message = "converged; the film reaches the outlet of the domain, which cuts it off there"
        warnings.warn(message, EhlWarning, stacklevel=4)
    return Film(
        contact=contact,
        x=x,
        pressure=found.P * groups.pressure,
        thickness=found.H * groups.gap,
        central_thickness=shown.central,
        minimum_thickness=shown.minimum,
        minimum_position=shown.position,
        inlet=float(x[0]),
        outlet=shown.outlet,
        prop=shown.prop,
        prop_slope=slope.prop / contact.load,
        central_slope=slope.central / contact.load,
        flow=-found.flux * groups.gap,
        flux_error=found.flux_error,
        load_error=found.load_error,
        error=error,
        errors=errors,
        cost=run.cost(),
        converged=True,
        message=message,
        state=State(run.plan, coarse.bare(), fine.bare()),
    )


def _failed(run: _Run, fine: Level, message: str, error: float = math.nan) -> Film:
    """Return a film without figures."""
    nan = math.nan
    blank = np.full(fine.grid.nodes.size, nan)
    length = run.contact.half_width * fine.grid.ratio
    return Film(
        contact=run.contact,
        x=fine.grid.nodes * length,
        pressure=blank,
        thickness=blank,
        central_thickness=nan,
        minimum_thickness=nan,
        minimum_position=nan,
        inlet=float(fine.grid.nodes[0] * length),
        outlet=nan,
        prop=nan,
        prop_slope=nan,
        central_slope=nan,
        flow=nan,
        flux_error=nan,
        load_error=nan,
        error=error,
        errors=FilmErrors(error, nan, nan, nan, nan),
        cost=run.cost(),
        converged=False,
        message=message,
    )


def solve_path(
    contacts: Iterable[LineContact],
    tolerance: float = 0.005,
    nodes: int | None = None,
    domain: tuple[float, float] | None = None,
    start: Film | None = None,
    grid: str = "graded",
) -> tuple[Film, ...]:
    """Solve a sequence of contacts, each started from the one before it: quasi-steady along a path.

    Parameters
    ----------
    contacts : iterable of LineContact
        In the order of the path; the load may jump.
    tolerance, nodes, domain, start, grid
        As for :func:`solve`; ``start`` serves the first contact.

    Returns
    -------
    tuple of Film
        One for each contact. A contact that fails does not stop the path; its film says so.
    """
    films: list[Film] = []
    last = start
    for contact in contacts:
        film = solve(contact, tolerance, nodes, domain, last, grid)
        films.append(film)
        if film.converged:
            last = film
    return tuple(films)
