"""Steady line contacts solved to a tolerance."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ehl.contact import LineContact
from ehl.film import Film
from ehl.levels import Level, State
from ehl.options import Options, warn_of_range
from ehl.outcome import failed_film, film_error, film_of, spike_error
from ehl.plan import Plan
from ehl.run import Run
from ehl.supply import OilLayer, Supply

_FIRST_NODES = 65
_MOST_FIRST_NODES = 257
_SHARP_NODES = 257
_MOST_NODES = 2049
REACH = 40.0  # inlet length in sqrt(h R) that keeps the error of the separation below 1e-3
_SETTLING = 0.7  # the spike's error has to fall by this factor from grid to grid


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
        How oil comes to the contact, and thereby what stays as it is when the load changes: the place where
        the gap fills, or the layer on the surfaces. Not given, the inlet is flooded.
    spike : float, optional
        Wanted relative error of the spike's pressure. Grids are laid around the spike and doubled until two
        of them agree to this.

    Returns
    -------
    Film
        With ``converged=False``, NaN figures and a remedy in ``message`` if no solution was found or its
        estimated error exceeds the tolerance on the finest grid (2049 nodes).

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
    return solve_checked(contact, options, None if start is None else start.state)


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


def solve_checked(contact: LineContact, options: Options, start: State | None) -> Film:
    """Solve with arguments that were checked."""
    if options.supply is not None:
        return _starved(contact, options, options.supply, start)
    reach = max(REACH, (10.0 / options.tolerance) ** (1.0 / 3.0))
    flooded = Plan.of(contact, options.grid, options.domain, reach)
    return _solve(Run(contact, flooded, None, whole_spike=options.spike is not None), options, start)


def _starved(contact: LineContact, options: Options, supply: Supply, start: State | None) -> Film:
    """Solve with a supply: flooded first, since that decides how much of it the contact takes."""
    held = start if start is not None and start.plan.fixed else None
    full = solve_checked(contact, replace(options, supply=None, spike=None), start if held is None else None)
    if not full.converged:
        return full
    enough = full.flow * (1.0 - full.error)
    if isinstance(supply, OilLayer) and supply.thickness >= enough:
        if options.spike is not None:
            sharp = solve_checked(contact, replace(options, supply=None), full.state)
            full = replace(sharp, cost=full.cost + sharp.cost)
        message = "converged; the layer is thicker than what the inlet takes: flooded"
        return replace(full, supply=supply, message=message) if full.converged else full
    plan = Plan.fed(contact, options.grid, supply, full.flow)
    if held is not None and isinstance(supply, OilLayer):
        plan = plan.with_inlet(held.plan.domain[0])
    film = _solve(Run(contact, plan, supply, whole_spike=options.spike is not None), options, held)
    return replace(film, cost=full.cost + film.cost)


def _solve(run: Run, options: Options, old: State | None) -> Film:
    """Solve a first pair of grids, then refine.

    A start gives films on the first pair alone: on finer ones a film of another load is often too far off.
    """
    if old is not None and old.plan.serves(run.plan):
        run.plan = old.plan
    n = 2 * _FIRST_NODES - 1
    if options.nodes is not None:
        n = int(options.nodes)
    half = (n + 1) // 2
    if old is None:
        coarse, fine = run.pair(half, n)
    else:
        same = old.plan is run.plan and old.coarse.plan is old.plan
        coarse = run.warm(old.coarse if same else old.fine, _same(old.coarse, half, same), half)
        before = old.fine if same and old.fine.grid.nodes.size == n else coarse
        fine = run.warm(before, _same(old.fine, n, same), n)
    while (
        options.nodes is None
        and n < _MOST_FIRST_NODES
        and not (coarse.found.converged and fine.found.converged)
        and not run.exhausted
    ):
        half, n = n, 2 * n - 1
        coarse, fine = run.pair(half, n)
    return _refine(run, coarse, fine, options)


def _same(level: Level, n: int, same: bool) -> Level | None:
    """Return the level if its grid can be used again."""
    return level if same and level.grid.nodes.size == n else None


def _refine(run: Run, coarse: Level, fine: Level, options: Options) -> Film:
    """Double the grid until the estimates meet what is asked, then report.

    A grid that fails is passed over: the next one is compared with the last that gave in.
    """
    given = options.nodes is not None
    inlet = run.plan.inlet_error
    if options.sharp and coarse.found.converged and fine.found.converged:
        if not given and film_error(coarse, fine) + inlet <= options.tolerance and options.spike is None:
            return film_of(run, coarse, fine, film_error(coarse, fine) + inlet, inlet)
        n = fine.grid.nodes.size if given else _SHARP_NODES
        coarse = run.sharpened(fine, (n + 1) // 2)
        fine = run.sharpened(coarse, n)
    off = math.inf
    while True:
        n = 2 * fine.grid.nodes.size - 1
        if not (coarse.found.converged and fine.found.converged):
            if coarse.found.converged and not given and n <= run.most_cold and not run.exhausted:
                fine = run.warm(coarse, None, n)
                continue
            failed = fine if coarse.found.converged else coarse
            return failed_film(run, fine, failed.found.message)
        worst = film_error(coarse, fine) + inlet
        before, off = off, spike_error(coarse, fine)
        if given or (worst <= options.tolerance and (options.spike is None or off <= options.spike)):
            return film_of(run, coarse, fine, worst, inlet)
        if options.spike is not None and max(before, off) < math.inf and off > _SETTLING * before:
            return failed_film(run, fine, f"error {off:.2g} of the spike, which does not settle", worst)
        if n > _MOST_NODES:
            left = f"error {worst:.2g}" if worst > options.tolerance else f"error {off:.2g} of the spike"
            return failed_film(run, fine, f"{left} left on {fine.grid.nodes.size} nodes", worst)
        coarse, fine = fine, run.sharpened(fine, n) if options.sharp else run.warm(fine, None, n)
