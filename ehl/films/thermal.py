"""Line contacts with heat and shear thinning: friction, losses and temperatures."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np

from base import Array, Faults, Limit, RangeWarning, Stopwatch, part, quantity, record, unclocked
from ehl.discrete.contact import LineContact
from ehl.discrete.method import METHOD
from ehl.discrete.solids import STEEL, Solid
from ehl.discrete.supply import Supply
from ehl.discrete.thermal_oil import ThermalOil
from ehl.films.film import Film, FilmErrors, unsolved
from ehl.films.result import above
from ehl.films.supplied import supplied
from ehl.films.thermal_errors import Compared
from ehl.films.thermal_search import Search
from ehl.films.thermal_supply import ThermalFilms
from ehl.solving.heat_balance import losses, rises, rolling, stresses, traction
from ehl.solving.levels import WarmLevel, figures
from ehl.solving.options import Options, warn_of_range

_TEMPERATURE = Limit(200.0, 600.0, "K", "353.15 is 80 degC")
_DECOMPOSING = 620.0  # [K]
_STRONGEST = 0.06  # mean shear stress over the maximum pressure
_YIELDING = "give eyring_stress (5e6 to 1e7 Pa) or limiting_shear_ratio"
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
    oil: float = quantity("W/m", "heat that leaves with the oil, at the outlet or turning back in the inlet")
    closure: float = quantity("1", "heat that arrives over heat that is made, less 1")


@record
class ThermalFilm(Film):
    """A steady line-contact film with heat and shear thinning; everything is per metre of face width.

    The slopes by the load, and so the stiffnesses that need them, are NaN until :func:`with_load_slopes` adds them.
    """

    headline = ("minimum_thickness", "traction_coefficient", "oil_temperature_rise")

    solids: tuple[Solid, Solid] | None = part("the bodies; None where temperatures were held", default=None)
    traction_coefficient: float = unsolved(
        "1", "mean shear stress over the load, positive where u1 > u2", error="traction_error"
    )
    oil_temperature_rise: float = unsolved(
        "K", "highest oil temperature above the mean of the bulk's", error="temperature_error"
    )
    surface_temperature_rise: float = unsolved(
        "K", "maximum surface temperature above that body's bulk", error="temperature_error"
    )
    rolling_friction: float = unsolved("N/m", "int h p'/2 dx, by which rolling resists on either surface")
    losses: Losses | None = part("where the power goes", default=None)
    temperature: Array | None = quantity("K", "across the film", "node across", default=None)
    shear_stress: Array | None = quantity(
        "Pa", "on the oil at the first and the second surface", "node surface", shown="MPa", default=None
    )
    traction_error: float = unsolved("1", "change of the traction between two grids")
    temperature_error: float = unsolved(
        "1",
        "change of the maximum temperature rises between two grids, what an unresolved spike leaves, and heat that is "
        "missing or ahead of the inlet",
    )

    @property
    def levels(self) -> tuple[WarmLevel, WarmLevel] | None:
        """Film and oil on the coarser and the finer grid, None where the film was not solved."""
        return None if self.state is None else self.state.warm

    @property
    def oils(self) -> tuple[ThermalOil, ThermalOil] | None:
        """Oil on both grids, likewise."""
        return None if self.levels is None else (self.levels[0].oil, self.levels[1].oil)

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
    supply: Supply | None = None,
) -> ThermalFilm:
    """Solve the steady line contact with shear thinning, and heat in oil and bodies.

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
        Wanted relative error of the film (central, minimum and between) and of the traction. The maximum
        temperatures have a separate error, `temperature_error`: where little slides they stand at the pressure
        spike, which grids resolve last.
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.
    start : ThermalFilm, optional
        A film of a similar contact to start from, supplied in the same way.
    supply : Meniscus or OilLayer, optional
        How oil is supplied, as for :func:`ehl.solve`; flooded if not given. A layer keeps its thickness: the
        meniscus moves until the warm film carries away what it brings.

    Returns
    -------
    ThermalFilm
        With ``converged=False``, NaN figures and a remedy in ``message`` if no solution was found. A film whose error
        is above the tolerance on 513 nodes keeps its figures; ``error`` and ``message`` say so.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Warns
    -----
    RangeWarning
        As :func:`solve`; where the mean shear stress exceeds what oils bear (a Newtonian oil at gear pressures), and
        where the oil is hotter than 620 K. Above 1000 K there is no solution.

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
    Options(tolerance, nodes, supply=supply).checked(contact)
    with unclocked():
        import ehl.kernels.heat_kernels
        import ehl.kernels.shear_kernels  # noqa: F401  numba
    warn_of_range(contact)
    watch = Stopwatch()
    search = Search(contact, solids, np.array(bulk), tolerance)
    films = ThermalFilms(search, supply, nodes)
    compared = supplied(films, supply, None if start is None else start.state)
    if compared is not None and compared.oil.temperature.max() > METHOD.hottest:
        hottest = compared.oil.temperature.max()
        search.reason, compared = f"the oil would reach {hottest:.0f} K, which no liquid does", None
    if compared is None:
        return _failed(search, watch)
    _warn_of_range(compared)
    return replace(_film(search, compared, watch, prescribed=nodes is not None), supply=supply)


def _warn_of_range(compared: Compared) -> None:
    """Warn where oils no longer are what the model takes them for."""
    oil, hottest = compared.oil, float(compared.oil.temperature.max())
    pressure = oil.groups.pressure * float(compared.fine.solution.P.max())
    stress = float(np.abs(oil.shear.flow[: oil.last + 1, 0]).max())
    if stress > _STRONGEST * pressure:
        message = (
            f"mean shear stress of {stress / 1e6:.3g} MPa, {stress / pressure:.2g} of the maximum pressure: "
            f"oils yield at 0.03 to 0.06 of the pressure; {_YIELDING}"
        )
        warnings.warn(message, RangeWarning, stacklevel=3)
    table = oil.contact.lubricant.table
    if table is not None and (hottest > table.temperature[-1] or pressure > table.pressure[-1]):
        message = (
            f"oil at {hottest:.0f} K and up to {pressure / 1e9:.3g} GPa leaves its table, which ends at "
            f"{table.temperature[-1]:g} K and {table.pressure[-1] / 1e9:g} GPa: its last slopes go on there"
        )
        warnings.warn(message, RangeWarning, stacklevel=3)
    if hottest > _DECOMPOSING:
        message = (
            f"oil at {hottest:.0f} K: above some {_DECOMPOSING:g} K mineral oils decompose within hours; "
            "friction and film are as if it stayed what it is"
        )
        warnings.warn(message, RangeWarning, stacklevel=3)


def _checked(
    contact: LineContact, solids: object, bulk: tuple[float, float] | None, tolerance: float
) -> tuple[float, float]:
    """Raise every fault of the arguments; return the bulk temperatures."""
    temperatures = bulk
    with Faults() as faults:
        if not isinstance(contact, LineContact):
            faults.add("contact", contact, "must be a LineContact", "build one with ehl.LineContact")
            return (0.0, 0.0)
        two = isinstance(solids, tuple) and len(solids) == 2 and all(isinstance(s, Solid) for s in solids)
        if not two and solids is not None:
            faults.add("solids", solids, "must be two of ehl.Solid, or None", "(STEEL, STEEL) is the default")
        if temperatures is None:
            temperatures = (contact.lubricant.temperature, contact.lubricant.temperature)
        if len(temperatures) != 2:
            faults.add(
                "bulk_temperatures", temperatures, "must be two temperatures", "give both bodies' in K"
            )
        for value in temperatures:
            faults.number("bulk_temperatures", value, _TEMPERATURE)
            table = contact.lubricant.table
            if table is not None and not table.knows(value):
                allowed = (
                    f"must lie in the oil's table, {table.temperature[0]:g} to {table.temperature[-1]:g} K"
                )
                faults.add("bulk_temperatures", value, allowed, "measure the oil there, or take a law")
        faults.number("tolerance", tolerance, _TOLERANCE)
    return (float(temperatures[0]), float(temperatures[1]))


def _film(search: Search, compared: Compared, watch: Stopwatch, *, prescribed: bool) -> ThermalFilm:
    """Return the film in SI; `prescribed` grids have no tolerance to meet."""
    level, oil, contact = compared.fine, compared.oil, search.contact
    shown, warmer = figures(level), rises(oil)
    nodes, message = level.grid.nodes.size, "converged"
    if not prescribed and compared.error > search.tolerance:
        message = above(compared.error, search.tolerance, nodes)
    return ThermalFilm(
        contact=contact,
        x=oil.x,
        inlet=float(oil.x[0]),
        **vars(shown),
        pressure=level.solution.P * oil.groups.pressure,
        thickness=level.solution.H * oil.groups.gap,
        flow=level.flow,
        flux_error=level.solution.flux_error,
        load_error=level.solution.load_error,
        errors=FilmErrors(film=compared.error, inlet=compared.inlet),
        cost=search.cost(watch.seconds),
        converged=True,
        message=message,
        state=compared.state,
        solids=search.solids,
        traction_coefficient=traction(oil),
        oil_temperature_rise=warmer[0],
        surface_temperature_rise=warmer[1],
        rolling_friction=rolling(oil, level.solution.P),
        losses=Losses(**losses(oil)),
        temperature=oil.at_nodes(oil.temperature),
        shear_stress=stresses(oil, level.solution.P),
        traction_error=compared.traction_error,
        temperature_error=compared.temperature_error,
    )


def _failed(search: Search, watch: Stopwatch) -> ThermalFilm:
    """Return a film without figures."""
    x, oil = search.places(), search.contact.lubricant
    remedy = "allow a larger tolerance, or start from a similar contact"
    if oil.eyring_stress is None and oil.limiting_shear_ratio is None and search.contact.sliding != 0.0:
        remedy = f"a Newtonian oil stands for any stress, however large: {_YIELDING}"
    blank = np.full(x.size, math.nan)
    return ThermalFilm(
        contact=search.contact,
        x=x,
        inlet=math.nan,
        pressure=blank,
        thickness=blank,
        errors=FilmErrors(math.nan),
        cost=search.cost(watch.seconds),
        converged=False,
        message=f"{search.reason}: {remedy}",
        solids=search.solids,
    )
