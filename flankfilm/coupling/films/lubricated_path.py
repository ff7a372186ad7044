"""Films in series with the teeth, solved along the path of a plane pair in rounds with the load share.

Each film stands for its neighbourhood by a law around the load under which it was solved, which is that of the load
share that all of them bring about. The law knows the loads of the front flanks alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import ehl
import gears
from base import Array, Stopwatch
from fem.laws.local_law import film_yielding
from flankfilm.coupling.films import films
from flankfilm.coupling.films.agreement import MOST_ROUNDS, in_agreement
from flankfilm.coupling.films.along_path import gathered
from flankfilm.coupling.films.films import (
    FilmModel,
    PathFilms,
    contacts_of,
    films_of,
    held_the_other_way,
    law_of,
    off_by_errors,
)
from flankfilm.coupling.films.lubricated_record import LubricatedCycle
from flankfilm.coupling.mesh.loaded_teeth import SOFTER
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

if TYPE_CHECKING:
    from flankfilm.coupling.films.film_law import FilmLaw
    from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
    from flankfilm.coupling.mesh.resolution import Resolution

__all__ = ["FilmRun", "lubricate_path"]

LIGHT_SHARE = 5e-3
"""Part of the force at which films are solved beside the loaded places, where pairs come and go."""

BETWEEN = 0.5**0.5
"""Part of what either half of the films alone changes that the films left out between those solved would.

Changes are added as squares, so this is their mean. A smooth law is off by a third of it, at ends of the path by one
and a half (`FilmLaw.halves`); extremes lie where pairs come and go, where halving the step halves the error.
"""


def lubricate_path(run: FilmRun, *, profiles: bool) -> LubricatedCycle:
    """Bring films and load share into agreement where the load is even along the face; see `lubricate`."""
    dry = run.dry
    positions = min(films.FILM_POSITIONS, dry.position.size)
    agreed, rounds = run.agree(positions)
    path, law = agreed.path, agreed.law
    cycle = run.with_film(path, f"{dry.label} with film")
    least = np.array([film.minimum_thickness for film in path.films])
    return LubricatedCycle(
        **MeshCycle.fields_of(cycle),
        least_film=law.carried(least, cycle.rho1, cycle.forces),
        rounds=rounds,
        mismatch=agreed.mismatch,
        dry=dry,
        film=gathered(
            run.model,
            path.loaded,
            run.teeth.pair,
            dry,
            agreed.seconds,
            positions if profiles else None,
        ),
        otherwise=run.otherwise(path),
    )


@dataclass(frozen=True)
class _FilmRound:
    """Films with their law, the cycle of the load share that they bring about, how far that moved, and the seconds."""

    path: PathFilms
    law: FilmLaw
    cycle: MeshCycle
    mismatch: float
    seconds: float


@dataclass(frozen=True)
class FilmRun:
    """What films and load share are computed from, as of `lubricate`."""

    teeth: LoadedTeeth
    dry: MeshCycle
    speed: float
    lubricant: ehl.Lubricant
    resolution: Resolution
    model: FilmModel

    def law(self, path: PathFilms) -> FilmLaw:
        """Law of films, with the model's definition of stiffness."""
        return law_of(path, self.teeth.pair.face_width, self.model.stiffness)

    def agree(self, positions: int) -> tuple[_FilmRound, int]:
        """Films whose loads are those of the load share that they bring about, and the rounds that these took."""
        return in_agreement(
            self._round(positions, self.teeth.cycle(positions)),
            lambda last: self._round(positions, last.cycle, last.path, last.seconds),
            lambda last: last.mismatch <= self.resolution.agreement,
            lambda last: (
                f"films and load share did not agree within {MOST_ROUNDS} rounds (forces still change by "
                f"{last.mismatch:.1e} of the whole): {SOFTER}"
            ),
        )

    def _round(
        self, positions: int, cycle: MeshCycle, near: PathFilms | None = None, seconds: float = 0.0
    ) -> _FilmRound:
        """Films under the loads of a cycle, solved from others near them, and the load share with them."""
        watch = Stopwatch()
        rho1, contacts, beside = self.contacts(cycle, positions)
        path = films_of(self.model, rho1, contacts, near, self.resolution.films, beside)
        law = self.law(path)
        seconds += watch.seconds
        shared = self.teeth.with_films(positions, law)
        mismatch = float(np.max(np.abs(shared.load_share - cycle.load_share)))
        return _FilmRound(path, law, shared, mismatch, seconds)

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
        cycle = self.teeth.with_films(self.dry.position.size, law, tolerance, varied)
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


def with_light_ends(
    pair: gears.GearPair,
    rho1: Array,
    contacts: tuple[ehl.LineContact, ...],
    speed: float,
    step: float,
    load: float,
) -> tuple[Array, tuple[ehl.LineContact, ...], tuple[int, ...]]:
    """Add a lightly loaded contact a step before the first and after the last, where these are on the path.

    Where a pair comes or goes its film carries some load long before the flanks would touch, and falls nearly with the
    inverse of that load, which heavier films do not know: a law of theirs alone has the pair let go at once, so that no
    film is ever asked for there.

    Parameters
    ----------
    pair : gears.GearPair
    rho1, contacts : ndarray, tuple
        Of the loaded pairs, in the order of the path.
    speed : float
        Of the pinion [rad/s].
    step : float
        Between contacts of one pair [m].
    load : float
        Of the light contacts [N/m].

    Returns
    -------
    ndarray, tuple, tuple of int
        Places [m], contacts, and which of them were added.
    """
    ends = {0: float(rho1[0]) - step, -1: float(rho1[-1]) + step}
    ends = {end: place for end, place in ends.items() if pair.points.A < place < pair.points.E}
    extended, places = list(contacts), list(rho1)
    for end, place in ends.items():
        path = pair.path_at(np.array([place]))
        light = replace(
            contacts[end],
            load=min(load, contacts[end].load),
            entrainment=float(path.entrainment(speed)[0]),
            radius=float(path.radius[0]),
        )
        at = 0 if end == 0 else len(extended)
        extended.insert(at, light)
        places.insert(at, place)
    return np.array(places), tuple(extended), tuple(0 if end == 0 else len(extended) - 1 for end in ends)
