"""The oil film at every point of the mesh cycle, in series with the teeth before load sharing."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import SolverError
from flankfilm.film_law import FilmLaw
from flankfilm.mesh_stiffness import MeshStiffness
from flankfilm.stages import film_pitch
from flankfilm.stages.engine import Engine
from flankfilm.stages.film_path import (
    PathFilms,
    contacts_of,
    film_inside,
    films_of,
    held_the_other_way,
    law_of,
)
from flankfilm.stages.teeth import cycle_at

if TYPE_CHECKING:
    from ehl import Film, StiffnessRow
    from flankfilm.stages.decide import Plan

Array = NDArray[np.float64]

FILM_POSITIONS = 40
"""Positions of a base pitch at which films are solved and brought into agreement with the load share."""

MOST_ROUNDS = 12


@dataclass(frozen=True)
class FilmStage:
    """Film along the path of contact, and the mesh with it.

    Attributes
    ----------
    cycle : MeshStiffness
        Stiffness and load share with the film in series.
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank at the contacts that have a film, rising [m].
    load : ndarray, shape (n,)
        Force per length of face [N/m].
    central, minimum : ndarray, shape (n,)
        Film thickness; between rough flanks the distance of their mean planes [m].
    hertz_pressure : ndarray, shape (n,)
        [Pa]
    stiffness : mapping
        Definition to film stiffness, shape (n,) [N/m at the whole face].
    at_pitch : tuple of StiffnessRow
        Every definition at the contact nearest to C, in series with the tangent stiffness of its teeth.
    profiles : mapping
        Label of a point of the path to its whole film, for pictures.
    change_secant, change_tangent : float
        What the film changes the mean stiffness by, relative.
    error : float
        Largest estimated relative error of the films' thicknesses.
    seconds : float
        Cost of the films [s].
    unknowns : int
        Of the largest film.
    rounds : int
        Times that films and load share were brought into agreement.
    mismatch : float
        Last change of a pair's force over the whole force.
    model : str
        ``"ehl"`` or ``"dowson"``.
    supply : str
        ``"flooded"``, ``"meniscus"`` or ``"oil-layer"``.
    starvation : ndarray or None, shape (n,)
        Central film over that of the smooth, flooded contact [-]; None with a flooded inlet.
    inlet, flow : ndarray or None, shape (n,)
        Place where the gap fills, in half-widths of the contact, negative, and the layer of oil that passes
        the contact [m]; None by formula.
    film_ratio, asperity_share : ndarray or None, shape (n,)
        Lambda = h_min/sigma and the asperities' share of the load [-]; None between smooth flanks.
    otherwise : mapping
        Starved films: label to the mesh with the flooded film, and with the same starved films where what is
        held at the inlet is the other of meniscus and layer, each at the forces of the films found.
    """

    cycle: MeshStiffness
    rho1: Array
    load: Array
    central: Array
    minimum: Array
    hertz_pressure: Array
    stiffness: Mapping[str, Array]
    at_pitch: tuple[StiffnessRow, ...]
    profiles: Mapping[str, Film]
    change_secant: float
    change_tangent: float
    error: float | None
    seconds: float
    unknowns: int
    rounds: int
    mismatch: float
    model: str
    supply: str = "flooded"
    starvation: Array | None = None
    inlet: Array | None = None
    flow: Array | None = None
    film_ratio: Array | None = None
    asperity_share: Array | None = None
    otherwise: Mapping[str, MeshStiffness] = field(default_factory=dict)


def film(engine: Engine) -> FilmStage:
    """Films and load share in agreement at some positions, then the mesh cycle with their law at all of the dry one.

    Films change slowly along the path, and the mesh stiffness by a small part: they need fewer positions than
    the cycle itself, whose steps and cusps decide.
    """
    dry: MeshStiffness = engine["dry cycle"]
    start = time.perf_counter()
    agreed = _agree(engine, min(FILM_POSITIONS, dry.phase.size))
    seconds = time.perf_counter() - start - agreed.in_contact_solver
    cycle = _with_film(engine, agreed.law, f"{dry.label} with film")
    return _gather(engine, cycle, agreed, seconds, _otherwise(engine, agreed))


@dataclass(frozen=True)
class _Agreement:
    """Films whose loads are those of the load share that they bring about."""

    path: PathFilms
    law: FilmLaw
    positions: int
    rounds: int
    mismatch: float
    in_contact_solver: float


def _agree(engine: Engine, positions: int) -> _Agreement:
    """Iterate films and load share until both agree."""
    plan: Plan = engine["plan"]
    definition = engine.scene.film.definition(plan.film.choice)
    in_contact_solver, mismatch, rounds = 0.0, np.inf, 0
    cycle = cycle_at(engine, positions)
    path: PathFilms | None = None
    while mismatch > plan.coupling:
        if rounds == MOST_ROUNDS:
            raise SolverError(
                f"films and load share did not agree within {MOST_ROUNDS} rounds (forces still change by "
                f"{mismatch:.1e} of the whole); raise the tolerance, or take the film by Dowson's formula"
            )
        rounds += 1
        path = films_of(engine, *contacts_of(engine, cycle), path, plan.film_tolerance)
        law = law_of(path, engine["pair"].face_width, definition)
        before, shared = cycle, time.perf_counter()
        cycle = cycle_at(engine, positions, law)
        in_contact_solver += time.perf_counter() - shared
        mismatch = float(np.max(np.abs(cycle.load_share - before.load_share)))
    assert path is not None
    return _Agreement(path, law, positions, rounds, mismatch, in_contact_solver)


def _with_film(engine: Engine, law: FilmLaw, label: str) -> MeshStiffness:
    """Give the mesh cycle with a film law, at the positions of the dry one."""
    cycle = cycle_at(engine, engine["dry cycle"].phase.size, law)
    if engine.scene.stiffness.pairs == "coupled":
        cycle = replace(cycle, secant=_secant(cycle, law))
    return replace(cycle, label=label)


def _secant(cycle: MeshStiffness, law: FilmLaw) -> Array:
    r"""Force over deflection, the film's yielding counted along its tangent from zero force.

    A film separates the flanks most where the force is least, so that the approach D itself is less
    than without film and F/D would call a film stiffer than no film. What yields is the bodies'
    deflection :math:`D + s_i` and the film's :math:`F_i/k_i`: with these in series in each pair, and
    the mean over the pairs weighted by their shares, a stiff film gives the dry secant back.
    """
    separation, slope = law(cycle.rho1, cycle.forces)
    yielding = separation - cycle.forces * slope
    added = np.sum(cycle.load_share * yielding, axis=1)
    return np.asarray(cycle.secant * cycle.transmission_error / (cycle.transmission_error + added))


def _otherwise(engine: Engine, agreed: _Agreement) -> dict[str, MeshStiffness]:
    """Give the mesh with the films that a starved one has to be compared with."""
    scene = engine.scene
    if not scene.film.starved:
        return {}
    width, definition = engine["pair"].face_width, scene.film.definition("ehl")
    path = agreed.path
    flooded = PathFilms(path.rho1, path.flooded)
    other = held_the_other_way(engine, path, engine["plan"].film_tolerance)
    held = "meniscus" if scene.film.supply == "oil-layer" else "oil layer"
    laws = {"smooth and flooded": flooded, f"same film, {held} held": other}
    return {label: _with_film(engine, law_of(p, width, definition), label) for label, p in laws.items()}


def _gather(
    engine: Engine,
    cycle: MeshStiffness,
    agreed: _Agreement,
    seconds: float,
    otherwise: Mapping[str, MeshStiffness],
) -> FilmStage:
    model, dry = engine["plan"].film.choice, engine["dry cycle"]
    width, solved = engine["pair"].face_width, model == "ehl"
    path, films = agreed.path, agreed.path.films
    inside = [film_inside(film) for film in films] if solved else []
    starved, rough = bool(path.flooded), engine.scene.roughness is not None
    central = np.array([film.central_thickness for film in films])
    return FilmStage(
        cycle=cycle,
        rho1=path.rho1,
        load=np.array([film.contact.load for film in films]),
        central=central,
        minimum=np.array([film.minimum_thickness for film in films]),
        hertz_pressure=np.array([film.contact.peak_pressure for film in films]),
        stiffness={
            name: np.array([width * film.stiffness(name) for film in films])
            for name in film_pitch.definitions(model)
        },
        at_pitch=film_pitch.stiffness_rows(engine, path) if solved else (),
        profiles=film_pitch.profiles(engine, path, agreed.positions) if solved else {},
        change_secant=float(cycle.secant.mean() / dry.secant.mean() - 1),
        change_tangent=float(cycle.tangent.mean() / dry.tangent.mean() - 1),
        error=max(film.error for film in films) if solved else None,
        seconds=seconds,
        unknowns=max(film.cost.unknowns for film in inside) if solved else 0,
        rounds=agreed.rounds,
        mismatch=agreed.mismatch,
        model=model,
        supply=engine.scene.film.supply,
        starvation=central / [film.central_thickness for film in path.flooded] if starved else None,
        inlet=np.array([film.inlet / film.contact.half_width for film in inside]) if solved else None,
        flow=np.array([film.flow for film in inside]) if solved else None,
        film_ratio=_of_mixed(path, "film_ratio") if rough else None,
        asperity_share=_of_mixed(path, "asperity_share") if rough else None,
        otherwise=otherwise,
    )


def _of_mixed(path: PathFilms, name: str) -> Array:
    return np.array([getattr(film, name) for film in path.films])
