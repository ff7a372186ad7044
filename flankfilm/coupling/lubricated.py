"""The oil film at every point of the mesh cycle, in series with the teeth before load sharing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Cost, SolverError, Stopwatch, described, part, quantity, record, unclocked
from flankfilm.coupling import film_points
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.film_law import FilmLaw
from flankfilm.coupling.films import (
    FilmModel,
    PathFilms,
    contacts_of,
    film_inside,
    films_of,
    held_the_other_way,
    law_of,
)
from flankfilm.coupling.loaded_teeth import PLAIN_FLANKS, Flanks, LoadedTeeth
from flankfilm.coupling.mesh_cycles import checked, loaded_teeth
from flankfilm.coupling.resolution import Resolution, resolution_of
from flankfilm.coupling.warned import warned_once

if TYPE_CHECKING:
    import fem
    from ehl import Film, Lubricant, StiffnessRow
    from gears import GearPair

FILM_POSITIONS = 40
"""Positions of a base pitch at which films are solved and brought into agreement with the load share."""

MOST_ROUNDS = 12

SOLVED = FilmModel()
"""Flooded films between smooth flanks, solved."""


@record
class FilmAlongPath:
    """Film at the loaded contacts of a mesh cycle, in the order of the path, at the loads that they carry with it.

    What only solved, starved or mixed films have is None for others. ``error`` is the largest of the films'
    thicknesses, None by formula.
    """

    headline = ("model", "supply", "least_film", "greatest_pressure")

    model: str = quantity("", "model of the film")
    supply: str = quantity("", "what is held at the inlet")
    rho1: Array = quantity("m", "curvature radius of the pinion's flank at the film", "point", shown="mm")
    load: Array = quantity("N/m", "force per length of face", "point", shown="N/mm")
    central_thickness: Array = quantity(
        "m", "central film, on the line of centres", "point", shown="um", error="error"
    )
    minimum_thickness: Array = quantity("m", "minimum film", "point", shown="um", error="error")
    hertz_pressure: Array = quantity(
        "Pa", "Hertz pressure, the largest of the dry contact", "point", shown="GPa"
    )
    stiffness: Mapping[str, Array] = quantity("N/m", "film stiffness of the whole face", "point")
    inlet: Array | None = quantity(
        "1", "where oil fills the gap, in half-widths ahead of the middle", "point"
    )
    oil_layer: Array | None = quantity(
        "m", "layer of oil at ambient pressure that passes the contact", "point", shown="um"
    )
    starvation: Array | None = quantity("1", "central film over that of the smooth flooded contact", "point")
    film_ratio: Array | None = quantity(
        "1", "film ratio Lambda, least distance of the mean planes over sigma", "point"
    )
    asperity_share: Array | None = quantity("1", "asperities' share of the load", "point")
    at_pitch: tuple[StiffnessRow, ...] = part(
        "film stiffness by every definition at the contact nearest to C, in series with the stiffness of its teeth"
    )
    profiles: Mapping[str, Film] = part("whole films at points of the path by label, for pictures")
    error: float | None
    cost: Cost
    converged: bool = True
    message: str = ""

    @described("m", shown="um", error="error")
    def least_film(self) -> float:
        """Least film along the path."""
        return float(self.minimum_thickness.min())

    @described("Pa", shown="GPa")
    def greatest_pressure(self) -> float:
        """Largest Hertz pressure along the path."""
        return float(self.hertz_pressure.max())


@record
class LubricatedCycle(MeshCycle):
    """Mesh cycle with the film in series in each pair, in agreement with the load share.

    For starved films ``otherwise`` holds the mesh with the flooded film, and with the same starved films where what is
    held at the inlet is the other of meniscus and layer, each at the forces of the films found.
    """

    headline = ("mean_secant_stiffness", "mean_stiffness", "thinnest_film")

    _: KW_ONLY
    least_film: Array = quantity(
        "m", "least film of each pair; nan where unloaded", "position pair", shown="um"
    )
    rounds: int = quantity("1", "times that films and load share were brought into agreement")
    mismatch: float = quantity("1", "last change of a pair's force over the whole force")
    dry: MeshCycle = part("the cycle without film")
    film: FilmAlongPath = part("film along the path, with the error of its own")
    otherwise: Mapping[str, MeshCycle] = part(
        "the mesh with other films, by name; empty unless films are starved"
    )

    @described("m", shown="um")
    def thinnest_film(self) -> float:
        """Least film of all pairs and positions."""
        return float(np.nanmin(self.least_film))

    @described("1", shown="%")
    def secant_stiffness_change(self) -> float:
        """What the film changes the mean secant stiffness by, relative."""
        return float(self.secant_stiffness.mean() / self.dry.secant_stiffness.mean() - 1)

    @described("1", shown="%")
    def stiffness_change(self) -> float:
        """What the film changes the mean tangent stiffness by, relative."""
        return float(self.stiffness.mean() / self.dry.stiffness.mean() - 1)


def lubricated_cycle(
    pair: GearPair,
    torque: float,
    speed: float,
    lubricant: Lubricant,
    *,
    tolerance: float = 0.005,
    model: str = "fem",
    pairs: str = "coupled",
    film: FilmModel = SOLVED,
    compliance: fem.Compliance | None = None,
    flanks: Flanks = PLAIN_FLANKS,
    profiles: bool = False,
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
    model, pairs : str
        Of the teeth, as of `LoadedTeeth`.
    film : FilmModel
        Supply, roughness and model of the film.
    compliance : fem.Compliance, optional
        For finite elements; computed unless given.
    flanks : Flanks
        Deviations, edges and friction, for finite elements.
    profiles : bool
        Whether whole films at points of the path are solved as well, their pressure spikes resolved.

    Returns
    -------
    LubricatedCycle
        At the midpoints of equal intervals of one base pitch.

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
    asked = resolution_of(checked(tolerance, torque=torque, speed=speed), model, pairs, film.name)
    with warned_once():
        teeth = loaded_teeth(pair, torque, asked, model, pairs, compliance, flanks)
        dry = teeth.sampled(asked.sampling, asked.transmission_error)
        return lubricate(teeth, dry, speed, lubricant, asked, film, profiles=profiles)


def film_along_path(
    pair: GearPair, torque: float, speed: float, lubricant: Lubricant, **options: Any
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
    lubricant: Lubricant,
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
        import ehl

        ehl.solve  # noqa: B018 - loads the solver
    run = _Run(teeth, dry, speed, lubricant, resolution, model)
    watch = Stopwatch()
    agreed = run.agree(min(FILM_POSITIONS, dry.position.size))
    seconds = watch.seconds - agreed.in_contact_solver
    cycle = run.with_film(agreed.law, f"{dry.label} with film")
    return LubricatedCycle(
        **_values(cycle),
        least_film=agreed.law.carried(
            np.array([film.minimum_thickness for film in agreed.path.films]), cycle.rho1, cycle.forces
        ),
        rounds=agreed.rounds,
        mismatch=agreed.mismatch,
        dry=dry,
        film=run.film(agreed, seconds, profiles),
        otherwise=run.otherwise(agreed),
    )


def _values(cycle: MeshCycle) -> dict[str, Any]:
    return {field.name: getattr(cycle, field.name) for field in fields(cycle)}


@dataclass(frozen=True)
class _Agreement:
    """Films whose loads are those of the load share that they bring about."""

    path: PathFilms
    law: FilmLaw
    positions: int
    rounds: int
    mismatch: float
    in_contact_solver: float


@dataclass(frozen=True)
class _Run:
    """What films and load share are computed from."""

    teeth: LoadedTeeth
    dry: MeshCycle
    speed: float
    lubricant: Lubricant
    resolution: Resolution
    model: FilmModel

    def agree(self, positions: int) -> _Agreement:
        """Iterate films and load share until both agree."""
        in_contact_solver, mismatch, rounds = 0.0, np.inf, 0
        cycle, pair = self.teeth.cycle(positions), self.teeth.pair
        path: PathFilms | None = None
        while mismatch > self.resolution.agreement:
            if rounds == MOST_ROUNDS:
                raise SolverError(
                    f"films and load share did not agree within {MOST_ROUNDS} rounds (forces still change by "
                    f"{mismatch:.1e} of the whole); raise the tolerance, or take the film by Dowson's formula"
                )
            rounds += 1
            contacts = contacts_of(pair, cycle, self.speed, self.lubricant)
            path = films_of(self.model, *contacts, path, self.resolution.films)
            law = law_of(path, pair.face_width, self.model.stiffness)
            before, watch = cycle, Stopwatch()
            cycle = self.teeth.cycle(positions, law)
            in_contact_solver += watch.seconds
            mismatch = float(np.max(np.abs(cycle.load_share - before.load_share)))
        assert path is not None
        return _Agreement(path, law, positions, rounds, mismatch, in_contact_solver)

    def with_film(self, law: FilmLaw, label: str) -> MeshCycle:
        """Give the mesh cycle with a film law, at the positions of the dry one."""
        cycle = self.teeth.cycle(self.dry.position.size, law)
        if self.teeth.pairs == "coupled":
            cycle = replace(cycle, secant_stiffness=_secant(cycle, law))
        return replace(cycle, label=label)

    def otherwise(self, agreed: _Agreement) -> dict[str, MeshCycle]:
        """Give the mesh with the films that a starved one has to be compared with."""
        if self.model.supply is None:
            return {}
        path, width = agreed.path, self.teeth.pair.face_width
        flooded = PathFilms(path.rho1, path.flooded)
        other = held_the_other_way(self.model, path, self.resolution.films)
        held = "meniscus" if self.model.held == "oil-layer" else "oil layer"
        laws = {"smooth and flooded": flooded, f"same film, {held} held": other}
        return {
            label: self.with_film(law_of(p, width, self.model.stiffness), label) for label, p in laws.items()
        }

    def film(self, agreed: _Agreement, seconds: float, profiles: bool) -> FilmAlongPath:
        """Gather the films along the path."""
        path, films, pair = agreed.path, agreed.path.films, self.teeth.pair
        solved, rough = self.model.name == "ehl", self.model.roughness is not None
        inside = [film_inside(film) for film in films] if solved else []
        central = np.array([film.central_thickness for film in films])
        flooded = np.array([film.central_thickness for film in path.flooded])
        return FilmAlongPath(
            model=self.model.name,
            supply=self.model.held,
            rho1=path.rho1,
            load=np.array([film.contact.load for film in films]),
            central_thickness=central,
            minimum_thickness=np.array([film.minimum_thickness for film in films]),
            hertz_pressure=np.array([film.contact.peak_pressure for film in films]),
            stiffness={
                name: np.array([pair.face_width * film.stiffness(name) for film in films])
                for name in film_points.definitions(self.model.name)
            },
            inlet=np.array([film.inlet / film.contact.half_width for film in inside]) if solved else None,
            oil_layer=np.array([film.flow for film in inside]) if solved else None,
            starvation=central / flooded if path.flooded else None,
            film_ratio=_of_mixed(path, "film_ratio") if rough else None,
            asperity_share=_of_mixed(path, "asperity_share") if rough else None,
            at_pitch=film_points.stiffness_rows(pair, self.dry, path) if solved else (),
            profiles=film_points.profiles(pair, path, agreed.positions, self.model.grid)
            if solved and profiles
            else {},
            error=max(film.error for film in films) if solved else None,
            cost=Cost(seconds, max((film.cost.unknowns for film in inside), default=0)),
        )


def _secant(cycle: MeshCycle, law: FilmLaw) -> Array:
    r"""Force over deflection, the film's yielding counted along its tangent from zero force.

    A film separates the flanks most where the force is least, so that the approach D itself is less
    than without film and F/D would call a film stiffer than no film. What yields is the bodies'
    deflection :math:`D + s_i` and the film's :math:`F_i/k_i`: with these in series in each pair, and
    the mean over the pairs weighted by their shares, a stiff film gives the dry secant back.
    """
    separation, slope = law(cycle.rho1, cycle.forces)
    yielding = separation - cycle.forces * slope
    added = np.sum(cycle.load_share * yielding, axis=1)
    deflection = cycle.transmission_error
    return np.asarray(cycle.secant_stiffness * deflection / (deflection + added))


def _of_mixed(path: PathFilms, name: str) -> Array:
    return np.array([getattr(film, name) for film in path.films])
