"""The oil film at every point of the mesh cycle, in series with the teeth before load sharing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np

import ehl
import gears
from base import Array, SolverError, Stopwatch, unclocked
from ehl.solving.options import warn_of_pressure
from fem.laws.local_law import film_yielding
from flankfilm.coupling.along_path import FilmAlongPath, gathered
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.film_law import FilmLaw
from flankfilm.coupling.films import (
    FilmModel,
    PathFilms,
    contacts_of,
    films_of,
    held_the_other_way,
    law_of,
    off_by_errors,
    with_light_ends,
)
from flankfilm.coupling.loaded_teeth import LoadedTeeth, TeethOptions
from flankfilm.coupling.lubricated_face import lubricate_face
from flankfilm.coupling.lubricated_record import LubricatedCycle
from flankfilm.coupling.mesh_cycles import resolved
from flankfilm.coupling.resolution import Resolution
from flankfilm.coupling.warned import pressures_unsaid, warned_once

FILM_POSITIONS = 40
"""Positions of a base pitch at which films are solved and brought into agreement with the load share."""

MOST_ROUNDS = 12

LIGHT_SHARE = 5e-3
"""Part of the force at which films are solved beside the loaded places, where pairs come and go."""

SOFTER = (
    "films softer than the teeth draw the load to the pair that has most of it; raise the torque, or lower speed and "
    "viscosity"
)
"""Why films and load share do not agree, and what to do."""

BETWEEN = 0.5**0.5
"""Part of what either half of the films alone changes that the films left out between those solved would.

Changes are added as squares, so this is their mean. A smooth law is off by a third of it, at ends of the path by one
and a half (`FilmLaw.halves`); extremes lie where pairs come and go, where halving the step halves the error.
"""

SOLVED = FilmModel()
"""Flooded films between smooth flanks, solved."""


def lubricated_cycle(
    pair: gears.GearPair,
    torque: float,
    speed: float,
    lubricant: ehl.Lubricant,
    *,
    tolerance: float = 0.005,
    film: FilmModel = SOLVED,
    profiles: bool = False,
    **teeth: Unpack[TeethOptions],
) -> LubricatedCycle:
    """Mesh stiffness, load share, transmission error and film of a lubricated pair over one base pitch.

    Parameters
    ----------
    pair : gears.GearPair
    torque, speed : float
        Of the pinion [N m], [rad/s].
    lubricant : ehl.Lubricant
    tolerance : float
        Relative, of the mean stiffness and of the films; it is split among meshes, positions and films.
    film : FilmModel
        Supply, roughness and model of the film.
    profiles : bool
        Whether whole films at points of the path are solved as well, their pressure spikes resolved.
    **teeth
        As of `mesh_cycle`.

    Returns
    -------
    LubricatedCycle
        At the midpoints of equal intervals of one base pitch; with `over_face` where the load varies along the face, by
        leads or by ``flanks=Flanks(alignment=..., cells=...)``.

    Raises
    ------
    InputError
        With every fault of the arguments.
    SolverError
        Where no result within the tolerance was found.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    >>> cycle = lubricated_cycle(
    ...     pair, 600.0, 209.44, oil, model="potential-energy", film=FilmModel("dowson")
    ... )
    >>> cycle.secant_stiffness_change < 0.0 < cycle.thinnest_film < 1e-6
    True
    """
    with warned_once():
        loaded, asked = resolved(LoadedTeeth(pair, torque, **teeth), tolerance, film.name, speed=speed)
        dry = loaded.sampled(asked.sampling, asked.transmission_error)
        return lubricate(loaded, dry, speed, lubricant, asked, film, profiles=profiles)


def film_along_path(
    pair: gears.GearPair, torque: float, speed: float, lubricant: ehl.Lubricant, **options: Any
) -> FilmAlongPath:
    """Film along the path of contact, in agreement with the load share.

    Parameters
    ----------
    pair, torque, speed, lubricant, **options
        As of `lubricated_cycle`.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    >>> film = film_along_path(pair, 600.0, 209.44, oil, model="ishikawa", film=FilmModel("dowson"))
    >>> film.rho1.size == film.central_thickness.size > 40
    True
    """
    return lubricated_cycle(pair, torque, speed, lubricant, **options).film


def lubricate(
    teeth: LoadedTeeth,
    dry: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    resolution: Resolution,
    model: FilmModel = SOLVED,
    *,
    profiles: bool = True,
) -> LubricatedCycle:
    """Bring films and load share into agreement at some positions, then the mesh cycle with their law at all of them.

    Films change slowly along the path, and the mesh stiffness by a small part: they need fewer positions than
    the cycle itself, whose steps and cusps decide.

    Parameters
    ----------
    teeth : LoadedTeeth
    dry : MeshCycle
        Of the same teeth; its positions are those of the result.
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
    resolution : Resolution
    model : FilmModel
    profiles : bool
        As of `lubricated_cycle`.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> from flankfilm.coupling import LoadedTeeth, resolution_of
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    >>> teeth = LoadedTeeth(pair, 600.0, "potential-energy")
    >>> asked = resolution_of(0.01, teeth.model, teeth.pairs, "dowson")
    >>> cycle = lubricate(teeth, teeth.cycle(120), 209.44, oil, asked, FilmModel("dowson"))
    >>> cycle.least_film.shape, cycle.mismatch < 1e-3
    ((120, 2), True)
    """
    with unclocked():
        ehl.solve  # noqa: B018 - loads the solver
    with pressures_unsaid():
        if dry.face is None:
            lubricated = _even(teeth, dry, speed, lubricant, resolution, model, profiles=profiles)
        else:
            lubricated = lubricate_face(teeth, dry, speed, lubricant, resolution, model, profiles=profiles)
    if model.name == "ehl":
        warn_of_pressure(lubricant, lubricated.film.greatest_pressure)
    return lubricated


def _even(
    teeth: LoadedTeeth,
    dry: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    resolution: Resolution,
    model: FilmModel,
    *,
    profiles: bool,
) -> LubricatedCycle:
    """Bring films and load share into agreement where the load is even along the face."""
    run = _Run(teeth, dry, speed, lubricant, resolution, model)
    agreed = run.agree(min(FILM_POSITIONS, dry.position.size))
    path, law = agreed.path, agreed.law
    cycle = run.with_film(path, f"{dry.label} with film")
    least = np.array([film.minimum_thickness for film in path.films])
    return LubricatedCycle(
        **MeshCycle.fields_of(cycle),
        least_film=law.carried(least, cycle.rho1, cycle.forces),
        rounds=agreed.rounds,
        mismatch=agreed.mismatch,
        dry=dry,
        film=gathered(
            model, path.loaded, teeth.pair, dry, agreed.seconds, agreed.positions if profiles else None
        ),
        otherwise=run.otherwise(path),
    )


@dataclass(frozen=True)
class _Agreement:
    """Films whose loads are those of the load share that they bring about, and the seconds that these took."""

    path: PathFilms
    law: FilmLaw
    positions: int
    rounds: int
    mismatch: float
    seconds: float


@dataclass(frozen=True)
class _Run:
    """What films and load share are computed from."""

    teeth: LoadedTeeth
    dry: MeshCycle
    speed: float
    lubricant: ehl.Lubricant
    resolution: Resolution
    model: FilmModel

    def law(self, path: PathFilms) -> FilmLaw:
        """Law of films, with the model's definition of stiffness."""
        return law_of(path, self.teeth.pair.face_width, self.model.stiffness)

    def agree(self, positions: int) -> _Agreement:
        """Iterate films and load share until both agree."""
        seconds, mismatch, rounds = 0.0, np.inf, 0
        cycle = self.teeth.cycle(positions)
        path: PathFilms | None = None
        while mismatch > self.resolution.agreement:
            if rounds == MOST_ROUNDS:
                raise SolverError(
                    f"films and load share did not agree within {MOST_ROUNDS} rounds (forces still change by "
                    f"{mismatch:.1e} of the whole): {SOFTER}"
                )
            rounds += 1
            watch = Stopwatch()
            rho1, contacts, beside = self.contacts(cycle, positions)
            path = films_of(self.model, rho1, contacts, path, self.resolution.films, beside)
            law = self.law(path)
            seconds += watch.seconds
            try:
                before, cycle = cycle, self.teeth.cycle(positions, law)
            except (gears.LoadSharingError, SolverError) as fault:  # without films there was one
                raise SolverError(f"no load share with these films was found: {SOFTER}") from fault
            mismatch = float(np.max(np.abs(cycle.load_share - before.load_share)))
        assert path is not None
        return _Agreement(path, law, positions, rounds, mismatch, seconds)

    def contacts(
        self, cycle: MeshCycle, positions: int
    ) -> tuple[Array, tuple[ehl.LineContact, ...], tuple[int, ...]]:
        """Give the contacts of a cycle that have films, and which of them are for the law alone."""
        pair = self.teeth.pair
        rho1, contacts = contacts_of(pair, cycle, self.speed, self.lubricant)
        if self.model.name != "ehl" or self.model.supply is not None:
            return rho1, contacts, ()
        light = LIGHT_SHARE * self.teeth.force / pair.face_width
        return with_light_ends(pair, rho1, contacts, self.speed, pair.base_pitch / positions, light)

    def with_film(self, path: PathFilms, label: str) -> MeshCycle:
        """Give the mesh cycle with films, at the positions of the dry one."""
        law = self.law(path)
        tolerance = min(self.resolution.sampling, self.resolution.transmission_error)
        own = ((other, 1.0) for other in off_by_errors(law, path))
        varied = (*own, *((half, BETWEEN) for half in law.halves()))
        cycle = self.teeth.cycle(self.dry.position.size, law, tolerance, varied)
        if self.teeth.pairs == "coupled":
            yields = film_yielding(law, cycle.rho1, cycle.forces, cycle.load_share)
            force = self.teeth.force
            cycle = replace(cycle, secant_stiffness=force / (force / cycle.secant_stiffness + yields))
        return replace(cycle, label=label)

    def otherwise(self, path: PathFilms) -> dict[str, MeshCycle]:
        """Give the mesh with the films that a starved one has to be compared with."""
        if self.model.supply is None:
            return {}
        held = "meniscus" if self.model.held == "oil-layer" else "oil layer"
        others = {
            "smooth and flooded": PathFilms(path.rho1, path.flooded),
            f"same film, {held} held": held_the_other_way(self.model, path, self.resolution.films),
        }
        return {label: self.with_film(other, label) for label, other in others.items()}
