"""Steady line contacts solved to a tolerance."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from base import Cost
from ehl.discrete.contact import LineContact
from ehl.discrete.method import METHOD
from ehl.discrete.regressions import moes_central
from ehl.discrete.supply import OilLayer, Supply
from ehl.films.film import Film
from ehl.films.refined import refined
from ehl.films.result import GridSolution
from ehl.films.supplied import supplied
from ehl.solving.grid_search import GridSearch
from ehl.solving.levels import Level, State
from ehl.solving.options import Options, warn_of_range
from ehl.solving.plan import Plan

_MOST_FIRST_NODES = 257


def solve(
    contact: LineContact,
    tolerance: float = 0.005,
    nodes: int | None = None,
    domain: tuple[float, float] | None = None,
    start: Film | None = None,
    grid: str = "graded",
    supply: Supply | None = None,
    spike: float | None = None,
) -> Film:
    """Solve the steady, isothermal line contact, flooded or starved.

    Reynolds' equation ``d/dx[rho h^3/(12 eta) dp/dx] = u d(rho h)/dx`` with ``p >= 0``, the gap
    ``h = h0 + x^2/2R - (4/pi E') int p ln|x - x'| dx'`` and ``int p dx = w`` are solved together by Newton's
    method.

    Parameters
    ----------
    contact : LineContact
        What to solve.
    tolerance : float
        Wanted relative error of central and minimum film. Grids of 65, 129, 257, ... nodes are solved until
        the estimate meets it; below 1e-3 they are laid around the pressure spike.
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.
    domain : tuple of float, optional
        (inlet, outlet) in half-widths of the dry contact; there the pressure is zero. Not given, the domain
        follows the film and is long enough for a fully flooded inlet within the tolerance.
    start : Film, optional
        A film of a similar contact to start from. Its grading is kept while the film parameter h R/b^2 stays
        within a factor 1.5, so that small changes of load show no change of grid.
    grid : str
        ``"graded"`` towards inlet and pressure spike, ``"uniform"``, or ``"article"``: 130 equal nodes on
        [-4, 1.2] half-widths, which redraws a published study; it cuts off the inlet of light contacts.
    supply : Meniscus or OilLayer, optional
        How oil is supplied to the contact, and thereby what the load does not change: the place where
        the gap fills, or the layer on the surfaces. Not given, the inlet is flooded.
    spike : float, optional
        Wanted relative error of the spike's pressure. Grids are laid around the spike and doubled until two
        of them agree to this.

    Returns
    -------
    Film
        With ``converged=False``, NaN figures and a remedy in ``message`` if no solution was found. A film whose error
        is above the tolerance on the finest grid (2049 nodes) keeps its figures; ``error`` and ``message`` say so.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Warns
    -----
    RangeWarning
        Above the range of the viscosity law (1 GPa of Hertz pressure for Roelands), at films thicker than a
        thousandth of the radius, and where the film reaches the outlet of a given domain.

    Notes
    -----
    Method, error estimate and limits: docs/theory/ehl.md.

    Examples
    --------
    >>> film = solve(LineContact.from_moes(M=20.0, L=10.0), tolerance=0.005)
    >>> film.converged, film.error < 0.005
    (True, True)
    >>> f"{film.central_moes:.2f} {film.minimum_moes:.2f}"
    '4.35 3.79'
    """
    options = Options(tolerance, nodes, domain, grid, supply, spike).checked(contact)
    warn_of_range(contact)
    return solve_checked(contact, options, None if start is None else start.state).film()


def solve_path(
    contacts: Iterable[LineContact], tolerance: float = 0.005, start: Film | None = None, **options: Any
) -> tuple[Film, ...]:
    """Solve a sequence of contacts, each started from the one before it: quasi-steady along a path.

    Parameters
    ----------
    contacts : iterable of LineContact
        In the order of the path; the load may jump.
    tolerance : float
        As for :func:`solve`.
    start : Film, optional
        For the first contact.
    **options
        Further arguments of :func:`solve`.

    Returns
    -------
    tuple of Film
        One for each contact. A contact that fails does not stop the path; its film says so.

    Examples
    --------
    >>> films = solve_path([LineContact.from_moes(M, 10.0) for M in (10.0, 12.0, 14.0)])
    >>> [f"{film.central_moes:.2f}" for film in films]
    ['4.82', '4.69', '4.59']
    """
    films: list[Film] = []
    for contact in contacts:
        films.append(solve(contact, tolerance, start=start, **options))
        start = films[-1] if films[-1].converged else start
    return tuple(films)


def solve_checked(
    contact: LineContact, options: Options, start: State | None, spent: Cost | None = None
) -> GridSolution:
    """Find the grids of a film, with arguments that were checked."""
    if options.supply is not None:
        return _starved(contact, options, options.supply, start)
    reach = max(METHOD.inlet_reach, (10.0 / options.tolerance) ** (1.0 / 3.0))
    flooded = Plan.of(contact, options.grid, options.domain, reach)
    run = GridSearch(contact, flooded, None, whole_spike=options.spike is not None, spent=spent)
    return _solve(run, options, start)


class _Films:
    """Isothermal films of a contact, flooded or starved."""

    def __init__(self, contact: LineContact, options: Options, supply: Supply) -> None:
        self.contact, self.options, self.supply = contact, options, supply
        self.spent: Cost | None = None
        self.last: GridSolution

    def flooded(self, near: State | None) -> GridSolution | None:
        """Film that takes what oil it wants."""
        alone = replace(self.options, supply=None, spike=None)
        self.last = solve_checked(self.contact, alone, near)
        self.spent = self.last.run.cost()
        return self.last if self.last.converged else None

    def starved(self, near: State | None, full: State | None, flow: float | None) -> GridSolution | None:
        """Film that the supply holds."""
        contact, options = self.contact, self.options
        plan = Plan.fed(contact, options.grid, self.supply, moes_flow(contact) if flow is None else flow)
        flooded = None if full is None else full.bare()
        whole = options.spike is not None
        run = GridSearch(contact, plan, self.supply, whole_spike=whole, flooded=flooded, spent=self.spent)
        self.last = _solve(run, options, near)
        return self.last if self.last.converged else None

    def expected(self, full: State) -> float:
        """Flow of the flooded film [m], by that of a similar contact."""
        return full.fine.flow * moes_flow(self.contact) / moes_flow(full.fine.contact)


def _starved(contact: LineContact, options: Options, supply: Supply, start: State | None) -> GridSolution:
    """Solve with a supply; a layer that is thicker than what the contact takes leaves it flooded."""
    films = _Films(contact, options, supply)
    solution = supplied(films, supply, start) or films.last
    if solution.failure or solution.run.supply is not None:
        return solution
    if options.spike is not None:
        solution = solve_checked(contact, replace(options, supply=None), solution.state, films.spent)
    note = "converged; the layer is thicker than what the inlet takes: flooded"
    return replace(solution, supply=supply, note=note)


def moes_flow(contact: LineContact) -> float:
    """Flow of a flooded contact by Moes' formula, at the density that the oil has under Hertz's pressure [m]."""
    density = contact.lubricant.density_ratio(np.array([contact.peak_pressure]))[0]
    return moes_central(contact) * float(density[0])


def _solve(run: GridSearch, options: Options, old: State | None) -> GridSolution:
    """Solve a first pair of grids, then refine.

    A start gives films on the first pair alone: on finer ones a film of another load is often too far off.
    """
    if old is not None and old.plan.serves(run.plan, run.supply):
        run.plan = old.plan
    fed = isinstance(run.supply, OilLayer)
    n = 2 * METHOD.first_nodes - 1
    if options.nodes is not None:
        n = int(options.nodes)
    half = (n + 1) // 2
    if old is None:
        coarse, fine = run.pair(half, n)
    else:
        same = old.plan is run.plan
        coarse_same = same and (old.coarse.plan == old.plan or (fed and old.coarse.plan.alike(old.plan)))
        coarse = run.warm(old.coarse if coarse_same else old.fine, _same(old.coarse, half, coarse_same), half)
        before = old.fine if same and old.fine.grid.nodes.size == n else coarse
        fine = run.warm(before, _same(old.fine, n, same), n)
    while (
        options.nodes is None
        and n < _MOST_FIRST_NODES
        and not (coarse.solution.converged and fine.solution.converged)
        and not run.exhausted
    ):
        half, n = n, 2 * n - 1
        coarse, fine = run.pair(half, n)
    return refined(run, coarse, fine, options)


def _same(level: Level, n: int, same: bool) -> Level | None:
    """Return the level if its grid can be used again."""
    return level if same and level.grid.nodes.size == n else None
