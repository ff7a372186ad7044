"""Line contacts with heat and shear thinning: friction, losses and temperatures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from base import Array, Cost, Faults, Limit, Stopwatch, part, quantity, record, unclocked
from ehl.bodies import STEEL, Solid
from ehl.contact import LineContact
from ehl.discrete import Groups
from ehl.film import Film, FilmErrors, unsolved
from ehl.heated import Heated
from ehl.levels import Level, State, figures, transfer
from ehl.newton import newton
from ehl.outcome import GRID_FACTOR, film_error
from ehl.solver import solve

_DONE = 2e-4  # last step of the pressure, of which the rest of a shrinking row is no more than as much again
_MOST_STEPS = 60
_MOST_NODES = 513
_SHARES = (0.25, 0.5, 0.75, 1.0)  # of the sliding, where all of it at once fails
_TEMPERATURE = Limit(200.0, 600.0, "K", "353.15 is 80 degC")
_TOLERANCE = Limit.above(0.0, 0.2, remedy="0.01 is 1 %")


@record
class Losses:
    """Where the power that both surfaces put into one metre of face goes."""

    no_error = "not estimated one by one; the closure says by how much they miss each other"

    dissipation: float = quantity("W/m", "heat that the oil's shear makes")
    sliding: float = quantity("W/m", "part of it by the mean shear stress and the sliding velocity")
    rolling: float = quantity("W/m", "the rest, by the oil's flow under its pressure")
    compression: float = quantity("W/m", "heat of compression less cold of expansion")
    first_body: float = quantity("W/m", "heat into the first body")
    second_body: float = quantity("W/m", "heat into the second body")
    oil: float = quantity("W/m", "heat that leaves with the oil")
    closure: float = quantity("1", "heat that arrives over heat that is made, less 1")


@record
class ThermalFilm(Film):
    """A steady line-contact film with heat and shear thinning; everything is per metre of face width.

    The slopes by the load, and so the stiffnesses that need them, are NaN.
    """

    headline = ("minimum_thickness", "traction_coefficient", "oil_temperature_rise")

    solids: tuple[Solid, Solid] | None = part("the bodies; None where temperatures were held", default=None)
    traction_coefficient: float = unsolved(
        "1", "mean shear stress over the load, positive where u1 > u2", error="traction_error"
    )
    oil_temperature_rise: float = unsolved(
        "K", "greatest oil temperature above the mean of the bulk's", error="temperature_error"
    )
    surface_temperature_rise: float = unsolved(
        "K", "greatest surface temperature above that body's bulk", error="temperature_error"
    )
    rolling_friction: float = unsolved("N/m", "int h p'/2 dx, by which rolling resists on either surface")
    losses: Losses | None = part("where the power goes", default=None)
    temperature: Array | None = quantity("K", "across the film", "node across", default=None)
    shear_stress: Array | None = quantity(
        "Pa", "on the oil at the first and the second surface", "node surface", shown="MPa", default=None
    )
    traction_error: float = unsolved("1", "change of the traction between two grids")
    temperature_error: float = unsolved("1", "change of the greatest oil temperature rise between two grids")
    oils: tuple[Heated, Heated] | None = part("what a next solution starts from", default=None)

    @property
    def dissipation(self) -> float:
        """Heat that the oil's shear makes [W per m of face]."""
        return math.nan if self.losses is None else self.losses.dissipation


def solve_thermal(
    contact: LineContact,
    solids: tuple[Solid, Solid] | None = (STEEL, STEEL),
    bulk_temperatures: tuple[float, float] | None = None,
    tolerance: float = 0.01,
    nodes: int | None = None,
    start: ThermalFilm | None = None,
) -> ThermalFilm:
    """Solve the steady flooded line contact with shear thinning, and heat in oil and bodies.

    Generalised Reynolds' equation with a viscosity that varies across the film, Eyring's shear in closed form, the
    energy equation across and along the film, and both surfaces as half-spaces under a moving source are solved
    together: Newton's method on pressures and separation, the oil's state following every step.

    Parameters
    ----------
    contact : LineContact
        What to solve, with its sliding speed; its lubricant says how it shears and warms.
    solids : tuple of Solid, or None
        The first and the second body; None holds all temperatures at those of the bulk (shear thinning alone).
    bulk_temperatures : tuple of float, optional
        Of the first and the second body [K], which the oil arrives with; those of the lubricant's data if not given.
    tolerance : float
        Wanted relative error of the film (central, minimum and between), of the traction, and of the viscosity by
        the error of the greatest oil temperature. That temperature has an error of its own, `temperature_error`:
        where little slides it stands at the pressure spike, which grids resolve last.
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.
    start : ThermalFilm, optional
        A film of a similar contact to start from.

    Returns
    -------
    ThermalFilm
        With ``converged=False``, NaN figures and a remedy in ``message`` if no solution was found or its
        estimated error exceeds the tolerance on 513 nodes.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Notes
    -----
    Equations and limits: docs/theory/ehl.md.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    >>> film = solve_thermal(LineContact(2e5, 2.5, 6e-3, 2.26e11, oil, sliding=1.0))
    >>> film.converged, f"{film.traction_coefficient:.3f}"
    (True, '0.030')
    """
    bulk = _checked(contact, solids, bulk_temperatures, tolerance)
    with unclocked():
        import ehl.shear_kernels  # noqa: F401  numba
    watch = Stopwatch()
    cold = solve(
        _at_bulk(contact, bulk),
        tolerance=max(tolerance, 0.01),
        nodes=nodes,
        start=None if start is None else start,
    )
    if not cold.converged or cold.state is None:
        return _failed(contact, solids, cold, f"without heat and shear: {cold.message}", watch)
    search = _Search(contact, solids, bulk, cold, start)
    n = cold.state.fine.grid.nodes.size
    before, found = search.on(cold.state.coarse, None), None
    last = search.on(cold.state.fine, before)
    while True:
        worst = math.inf
        if before is not None and last is not None:
            found = _Compared(*before, *last)
            worst = found.error + cold.errors.inlet
        if last is not None and (worst <= tolerance or (nodes is not None and before is not None)):
            assert found is not None
            return _film(search, found, worst, cold, watch)
        n = 2 * n - 1
        if nodes is not None or n > _MOST_NODES:
            left = (
                "Newton's method did not converge"
                if last is None
                else f"error {worst:.2g} left on {n // 2 + 1} nodes"
            )
            return _failed(
                contact,
                solids,
                cold,
                f"{left}: allow a larger tolerance, or start from a similar contact",
                watch,
            )
        base = cold.state.fine if last is None else last[0]
        grid = base.plan.grid(n)
        groups = Groups.on(contact, grid)
        P, H0 = transfer(base, contact, base.plan, grid)
        if last is None:
            isothermal = newton(grid, groups, P, H0)
            P, H0 = isothermal.P, isothermal.H0
        empty = replace(base.found, P=P, H0=H0)
        before, last = last, search.on(Level(contact, base.plan, grid, empty), last or before)


def _checked(
    contact: LineContact, solids: object, bulk: tuple[float, float] | None, tolerance: float
) -> tuple[float, float]:
    """Raise every fault of the arguments; return the bulk temperatures."""
    given = bulk
    with Faults() as found:
        if not isinstance(contact, LineContact):
            found.add("contact", contact, "must be a LineContact", "build one with ehl.LineContact")
            return (0.0, 0.0)
        two = isinstance(solids, tuple) and len(solids) == 2 and all(isinstance(s, Solid) for s in solids)
        if not two and solids is not None:
            found.add("solids", solids, "must be two of ehl.Solid, or None", "(STEEL, STEEL) is the default")
        if given is None:
            given = (contact.lubricant.temperature, contact.lubricant.temperature)
        if len(given) != 2:
            found.add("bulk_temperatures", given, "must be two temperatures", "give both bodies' in K")
        for value in given:
            found.number("bulk_temperatures", value, _TEMPERATURE)
        found.number("tolerance", tolerance, _TOLERANCE)
    return (float(given[0]), float(given[1]))


def _at_bulk(contact: LineContact, bulk: tuple[float, float]) -> LineContact:
    """Return the contact with the oil as it is at the mean bulk temperature, isothermal and Newtonian."""
    oil, mean = contact.lubricant, 0.5 * (bulk[0] + bulk[1])
    ratio, slope = (float(v) for v in oil.hot_log_viscosity(0.0, mean))
    warm = replace(oil, viscosity=oil.viscosity * math.exp(ratio), pressure_viscosity=slope, temperature=mean)
    unchanged = oil.viscosity_law is not None or mean == oil.temperature
    return contact if unchanged else replace(contact, lubricant=warm)


class _Search:
    """Solves levels with heat; counts what it does."""

    def __init__(
        self,
        contact: LineContact,
        solids: tuple[Solid, Solid] | None,
        bulk: tuple[float, float],
        cold: Film,
        start: ThermalFilm | None,
    ) -> None:
        self.contact, self.solids, self.bulk = contact, solids, np.array(bulk)
        self.start = start if start is not None and start.oils is not None else None
        self.iterations, self.restarts, self.nodes = cold.cost.iterations, 0, 0

    def on(self, level: Level, other: tuple[Level, Heated] | None) -> tuple[Level, Heated] | None:
        """Solve on a level's grid from its pressures and from another solution's temperatures."""
        groups = Groups.on(self.contact, level.grid)
        oil = Heated(self.contact, level.grid, groups, self.solids, self.bulk)
        if other is not None:
            oil.start_from(other[1])
        elif self.start is not None and self.start.oils is not None:
            oil.start_from(self.start.oils[0])
        self.nodes = max(self.nodes, level.grid.nodes.size)
        solved = self._newton(level, oil)
        if solved is not None:
            return solved
        self.restarts += 1
        partly: tuple[Level, Heated] | None = None
        for share in _SHARES:
            oil = Heated(self.contact, level.grid, groups, self.solids, self.bulk).softer(share)
            if partly is not None:
                oil.start_from(partly[1])
            partly = self._newton(level if partly is None else partly[0], oil)
            if partly is None:
                return None
        return partly

    def _newton(self, level: Level, oil: Heated) -> tuple[Level, Heated] | None:
        found = level.found
        try:
            with np.errstate(all="ignore"):
                solved = newton(
                    level.grid, oil.groups, found.P, found.H0, oil=oil, done=_DONE, max_iterations=_MOST_STEPS
                )
        except np.linalg.LinAlgError:  # temperatures of a trial that diverged
            return None
        self.iterations += solved.iterations
        if not solved.converged or not np.isfinite(oil.temperature).all():
            return None
        return replace(level, contact=self.contact, found=solved), oil


class _Compared:
    """Two levels with heat: the figures of the finer and their changes."""

    def __init__(self, coarse: Level, before: Heated, fine: Level, oil: Heated) -> None:
        self.coarse, self.fine, self.before, self.oil = coarse, fine, before, oil
        pairs = ((o.traction, o.rises()[0]) for o in (before, oil))
        (mu_0, rise_0), (mu, rise) = pairs
        self.traction_error = abs(mu_0 - mu) / max(abs(mu), 1e-4)
        self.temperature_error = abs(rise_0 - rise) / max(rise, 1.0)
        warmer = oil.contact.lubricant.viscosity_slope * abs(rise_0 - rise)
        self.error = max(film_error(coarse, fine), GRID_FACTOR * self.traction_error, GRID_FACTOR * warmer)


def _film(search: _Search, found: _Compared, error: float, cold: Film, watch: Stopwatch) -> ThermalFilm:
    """Return the film in SI."""
    level, oil, contact = found.fine, found.oil, search.contact
    shown, rises = figures(level), oil.rises()
    return ThermalFilm(
        contact=contact,
        x=oil.x,
        inlet=float(oil.x[0]),
        **vars(shown),
        pressure=level.found.P * oil.groups.pressure,
        thickness=level.found.H * oil.groups.gap,
        flow=level.flow,
        flux_error=level.found.flux_error,
        load_error=level.found.load_error,
        errors=FilmErrors(film=error, inlet=cold.errors.inlet),
        cost=_cost(search, watch),
        converged=True,
        message="converged",
        state=State(found.coarse.bare(), level.bare()),
        solids=search.solids,
        traction_coefficient=oil.traction,
        oil_temperature_rise=rises[0],
        surface_temperature_rise=rises[1],
        rolling_friction=oil.rolling(level.found.P),
        losses=Losses(**oil.losses()),
        temperature=oil.temperature,
        shear_stress=oil.stresses(),
        traction_error=found.traction_error,
        temperature_error=found.temperature_error,
        oils=(found.before, oil),
    )


def _cost(search: _Search, watch: Stopwatch) -> Cost:
    counts = {"restarts": search.restarts}
    return Cost(watch.seconds, unknowns=search.nodes - 1, iterations=search.iterations, counts=counts)


def _failed(
    contact: LineContact, solids: tuple[Solid, Solid] | None, cold: Film, reason: str, watch: Stopwatch
) -> ThermalFilm:
    """Return a film without figures."""
    blank = np.full(cold.x.size, math.nan)
    return ThermalFilm(
        contact=contact,
        x=cold.x,
        inlet=cold.inlet,
        pressure=blank,
        thickness=blank,
        errors=FilmErrors(math.nan),
        cost=replace(cold.cost, seconds=watch.seconds),
        converged=False,
        message=reason,
        solids=solids,
    )
