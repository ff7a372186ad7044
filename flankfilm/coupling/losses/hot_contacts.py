"""Films with heat at single contacts: what heat changes where most power slides, and the hottest for pictures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import ehl
import gears
from base import Array, SolverError, part, quantity, record
from flankfilm.coupling.films.along_path import FilmAlongPath
from flankfilm.coupling.films.films import Held, supply_of
from flankfilm.coupling.losses.losses_record import MeshLosses

COARSEST = 0.02
"""Tolerance of the screen, and the change that it sees at least."""


@record
class HeatScreen:
    """A contact's film with heat and shear thinning beside the isothermal, Newtonian one."""

    no_error = "not estimated; both films have an error"

    rho1: float = quantity("m", "curvature radius of the pinion's flank at the contact", shown="mm")
    isothermal_thickness: float = quantity("m", "minimum film without heat", shown="um")
    thickness: float = quantity("m", "minimum film with heat", shown="um")
    film: ehl.ThermalFilm = part("film with heat")

    @property
    def change(self) -> float:
        """What heat and shear change the minimum film by, relative."""
        return self.thickness / self.isothermal_thickness - 1.0


def heat_screen(
    pair: gears.GearPair,
    path: FilmAlongPath,
    speed: float,
    lubricant: ehl.Lubricant,
    *,
    solids: tuple[ehl.Solid, ehl.Solid],
    bulk_temperatures: tuple[float, float] | None = None,
    tolerance: float = COARSEST,
    supply: Held = None,
) -> HeatScreen:
    """Solve the contact of a path where load times sliding speed is largest, with heat and without.

    Heat takes most of the film there: at the ends of the path, or where a single pair begins to carry. Formulas for
    the part that it takes are of the inlet's shear alone and four times too pessimistic.

    Parameters
    ----------
    pair : gears.GearPair
    path : FilmAlongPath
        Its loads are taken, of smooth flanks.
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
        With Eyring's stress and what heat does with it.
    solids : (ehl.Solid, ehl.Solid)
        Pinion and wheel.
    bulk_temperatures : (float, float), optional
        Of pinion and wheel [K]; those of the lubricant's data unless given.
    tolerance : float
        Of both films, relative.
    supply : ehl.Meniscus, ehl.OilLayer or PlacedMeniscus, optional
        What is held at the inlets of both; flooded without.

    Raises
    ------
    SolverError
        Where a film has no solution.

    Examples
    --------
    >>> from ehl import STEEL, Lubricant
    >>> from flankfilm.coupling import FilmModel, film_along_path
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    >>> path = film_along_path(pair, 600.0, 209.44, oil, model="ishikawa", film=FilmModel("dowson"))
    >>> screen = heat_screen(pair, path, 209.44, oil, solids=(STEEL, STEEL))
    >>> -0.3 < screen.change < -0.1
    True
    """
    slid = path.load * np.abs(pair.path_at(path.rho1).sliding(speed))
    rho1, load = _at(path.rho1, path.load, int(np.argmax(slid)))
    contact = _contact(pair, rho1, load, speed, lubricant)
    fed = supply_of(supply, contact)
    hot = ehl.solve_thermal(contact, solids, bulk_temperatures, tolerance, supply=fed)
    bulk = bulk_temperatures or (lubricant.temperature, lubricant.temperature)
    warm = replace(contact, lubricant=lubricant.at_temperature(0.5 * sum(bulk)))
    cold = ehl.solve(warm, tolerance, supply=fed)
    for film in (hot, cold):
        if not film.converged:
            raise SolverError(f"no film at rho1 = {1e3 * rho1:.3f} mm: {film.message}")
    return HeatScreen(
        rho1=rho1,
        isothermal_thickness=cold.minimum_thickness,
        thickness=hot.minimum_thickness,
        film=hot,
    )


def hottest_film(
    pair: gears.GearPair,
    losses: MeshLosses,
    lubricant: ehl.Lubricant,
    solids: tuple[ehl.Solid, ehl.Solid],
    tolerance: float = COARSEST,
    supply: Held = None,
) -> ehl.ThermalFilm:
    """Solve the whole film of the contact whose oil is hottest, at the loads and flanks' temperatures of losses.

    Parameters
    ----------
    pair, lubricant, solids, supply
        Of the losses.
    losses : MeshLosses
    tolerance : float
        Of the film, relative.

    Examples
    --------
    >>> from ehl import STEEL, Lubricant
    >>> from flankfilm import mesh_losses
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    >>> losses = mesh_losses(pair, 300.0, 209.44, oil, model="potential-energy", positions=4)
    >>> film = hottest_film(pair, losses, oil, (STEEL, STEEL))
    >>> abs(film.oil_temperature_rise / losses.path.oil_temperature_rise.max() - 1.0) < 0.05
    True
    """
    path = losses.path
    rho1, load = _at(path.rho1, path.load, int(np.argmax(path.oil_temperature_rise)))
    first, second = losses.bulk_temperatures.tolist()
    contact = _contact(pair, rho1, load, losses.speed, lubricant)
    fed = supply_of(supply, contact)
    film = ehl.solve_thermal(contact, solids, (first, second), tolerance, supply=fed)
    return replace(film, state=None)


def _at(rho1: Array, load: Array, at: int) -> tuple[float, float]:
    return float(rho1[at]), float(load[at])


def _contact(
    pair: gears.GearPair, rho1: float, load: float, speed: float, lubricant: ehl.Lubricant
) -> ehl.LineContact:
    """Line contact at a place of the path [m] under a load [N/m]."""
    along = pair.path_at(np.array([rho1]))
    return ehl.LineContact(
        load=load,
        entrainment=float(along.entrainment(speed)[0]),
        sliding=float(along.sliding(speed)[0]),
        radius=float(along.radius[0]) / pair.helix.base_cosine,
        reduced_modulus=pair.reduced_modulus,
        lubricant=lubricant,
    )
