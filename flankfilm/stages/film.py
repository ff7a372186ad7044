"""The oil film at every point of the mesh cycle, in series with the teeth before load sharing."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.build import lubricant, pinion_speed
from flankfilm.faults import SolverError
from flankfilm.film_law import FilmLaw
from flankfilm.mesh_stiffness import MeshStiffness
from flankfilm.stages.engine import Engine
from flankfilm.stages.teeth import cycle_at
from flankfilm.tolerance import ToleranceSplit

if TYPE_CHECKING:
    from ehl import Film, LineContact

Array = NDArray[np.float64]

LEAST_SHARE = 1e-3
"""Pairs with less than this part of the force get no film: they hardly touch, and what their film
props them apart by moves the load share by less than their own part."""

FILM_POSITIONS = 40
"""Positions of a base pitch at which films are solved and brought into agreement with the load share."""

MOST_ROUNDS = 12

PROFILE_NODES = 513
"""Nodes of the films that are drawn: they resolve the pressure spike."""


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
        Film thickness [m].
    hertz_pressure : ndarray, shape (n,)
        [Pa]
    stiffness : mapping
        Definition to film stiffness, shape (n,) [N/m at the whole face].
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
    """

    cycle: MeshStiffness
    rho1: Array
    load: Array
    central: Array
    minimum: Array
    hertz_pressure: Array
    stiffness: Mapping[str, Array]
    profiles: Mapping[str, Film]
    change_secant: float
    change_tangent: float
    error: float | None
    seconds: float
    unknowns: int
    rounds: int
    mismatch: float
    model: str


@dataclass(frozen=True)
class _Contacts:
    """The loaded contacts of a cycle in the order of the path."""

    rho1: Array
    contacts: tuple[LineContact, ...]


def film(engine: Engine) -> FilmStage:
    """Films and load share in agreement at some positions, then the mesh cycle with their law at all of the dry one.

    Films change slowly along the path, and the mesh stiffness by a small part: they need fewer positions than
    the cycle itself, whose steps and cusps decide.
    """
    split = ToleranceSplit.of(engine.scene.tolerance)
    dry: MeshStiffness = engine["dry cycle"]
    start = time.perf_counter()
    agreed = _agree(engine, min(FILM_POSITIONS, dry.phase.size), split)
    seconds = time.perf_counter() - start - agreed.in_contact_solver
    cycle = cycle_at(engine, dry.phase.size, agreed.law)
    if engine.scene.stiffness.pairs == "coupled":
        cycle = replace(cycle, secant=_secant(cycle, agreed.law))
    return _gather(engine, dry, cycle, agreed, seconds)


@dataclass(frozen=True)
class _Agreement:
    """Films whose loads are those of the load share that they bring about."""

    contacts: _Contacts
    films: tuple[Film, ...]
    law: FilmLaw
    positions: int
    rounds: int
    mismatch: float
    in_contact_solver: float


def _agree(engine: Engine, positions: int, split: ToleranceSplit) -> _Agreement:
    """Iterate films and load share until both agree."""
    solve = _solved if engine["film model"].model == "ehl" else _regressed
    in_contact_solver, mismatch, rounds = 0.0, np.inf, 0
    cycle = cycle_at(engine, positions)
    films: tuple[Film, ...] | None = None
    while mismatch > split.coupling:
        if rounds == MOST_ROUNDS:
            raise SolverError(
                f"films and load share did not agree within {MOST_ROUNDS} rounds (forces still change by "
                f"{mismatch:.1e} of the whole); raise the tolerance, or take the film by Dowson's formula"
            )
        rounds += 1
        contacts = _contacts(engine, cycle)
        films = solve(contacts, films, split.film)
        law = _law(engine, contacts, films)
        before, shared = cycle, time.perf_counter()
        cycle = cycle_at(engine, positions, law)
        in_contact_solver += time.perf_counter() - shared
        mismatch = float(np.max(np.abs(cycle.load_share - before.load_share)))
    assert films is not None
    return _Agreement(contacts, films, law, positions, rounds, mismatch, in_contact_solver)


def _secant(cycle: MeshStiffness, law: FilmLaw) -> Array:
    r"""Force over deflection, the film's yielding counted along its tangent from zero force.

    A film props the flanks apart most where the force is least, so that the approach D itself is less
    than without film and F/D would call a film stiffer than no film. What yields is the bodies'
    deflection :math:`D + s_i` and the film's :math:`F_i/k_i`: with these in series in each pair, and
    the mean over the pairs weighted by their shares, a stiff film gives the dry secant back.
    """
    prop, slope = law(cycle.rho1, cycle.forces)
    yielding = prop - cycle.forces * slope
    added = np.sum(cycle.load_share * yielding, axis=1)
    return np.asarray(cycle.secant * cycle.transmission_error / (cycle.transmission_error + added))


def _contacts(engine: Engine, cycle: MeshStiffness) -> _Contacts:
    """Give the line contacts that the loaded pairs of a cycle make, in the order of the path."""
    from ehl import LineContact

    pair, oil, speed = engine["pair"], lubricant(engine.scene), pinion_speed(engine.scene)
    touching = np.isfinite(cycle.rho1) & (cycle.load_share > LEAST_SHARE)
    position, number = np.nonzero(touching)
    order = np.argsort(cycle.rho1[position, number], kind="stable")
    position, number = position[order], number[order]
    rho1 = cycle.rho1[position, number]
    path = pair.path_at(rho1)
    contacts = tuple(
        LineContact(load=w, entrainment=u, radius=r, reduced_modulus=pair.reduced_modulus, lubricant=oil)
        for w, u, r in zip(
            (cycle.forces[position, number] / pair.face_width).tolist(),
            path.entrainment(speed).tolist(),
            path.radius.tolist(),
            strict=True,
        )
    )
    return _Contacts(rho1, contacts)


def _solved(contacts: _Contacts, before: tuple[Film, ...] | None, tolerance: float) -> tuple[Film, ...]:
    """Solve all films, each from its neighbour, or from itself of the round before."""
    from ehl import solve, solve_path

    if before is None or len(before) != len(contacts.contacts):
        films = solve_path(contacts.contacts, tolerance=tolerance)
    else:
        films = tuple(
            solve(contact, tolerance=tolerance, start=old)
            for contact, old in zip(contacts.contacts, before, strict=True)
        )
    for film, rho1 in zip(films, contacts.rho1.tolist(), strict=True):
        if not film.converged:
            raise SolverError(f"no film at rho1 = {1e3 * rho1:.3f} mm: {film.message}")
    return films


def _regressed(contacts: _Contacts, before: object, tolerance: float) -> tuple[Film, ...]:
    from ehl import dowson

    return tuple(dowson(contact) for contact in contacts.contacts)  # type: ignore[misc]


def _law(engine: Engine, contacts: _Contacts, films: tuple[Film, ...]) -> FilmLaw:
    """Gather the films along the path into a law."""
    width = engine["pair"].face_width
    definition = engine.scene.film.definition(engine["film model"].model)
    solved = np.array([width * film.contact.load for film in films])
    props = np.array([film.prop for film in films])
    stiffness = np.array([width * film.stiffness(definition) for film in films])
    # at light loads of thin, soft contacts a film's slope can vanish or turn within its error: then a constant
    return FilmLaw(contacts.rho1, solved, props, np.maximum(solved / (stiffness * props), 0.0))


def _gather(
    engine: Engine, dry: MeshStiffness, cycle: MeshStiffness, agreed: _Agreement, seconds: float
) -> FilmStage:
    model = engine["film model"].model
    definitions = _definitions(model)
    width = engine["pair"].face_width
    films, contacts = agreed.films, agreed.contacts
    return FilmStage(
        cycle=replace(cycle, label=f"{dry.label} with film"),
        rho1=contacts.rho1,
        load=np.array([film.contact.load for film in films]),
        central=np.array([film.central_thickness for film in films]),
        minimum=np.array([film.minimum_thickness for film in films]),
        hertz_pressure=np.array([film.contact.peak_pressure for film in films]),
        stiffness={name: np.array([width * film.stiffness(name) for film in films]) for name in definitions},
        profiles=_profiles(engine, agreed) if model == "ehl" else {},
        change_secant=float(cycle.secant.mean() / dry.secant.mean() - 1),
        change_tangent=float(cycle.tangent.mean() / dry.tangent.mean() - 1),
        error=max(film.error for film in films) if model == "ehl" else None,
        seconds=seconds,
        unknowns=max(film.cost.unknowns for film in films) if model == "ehl" else 0,
        rounds=agreed.rounds,
        mismatch=agreed.mismatch,
        model=model,
    )


def _definitions(model: str) -> tuple[str, ...]:
    from ehl import DEFINITIONS

    return DEFINITIONS if model == "ehl" else ("dowson-central", "dowson-minimum")


def _profiles(engine: Engine, agreed: _Agreement) -> dict[str, Film]:
    """Films nearest to A, C and E, and to B and D on their single-pair side, fine enough for pictures.

    The tolerance asks for thicknesses, which a grid too coarse for the pressure spike meets.
    """
    from ehl import solve

    points, contacts, films = engine["pair"].points, agreed.contacts, agreed.films
    step = engine["pair"].base_pitch / agreed.positions
    wanted = {
        "near A": points.A,
        "after B": points.B + step,
        "C": points.C,
        "before D": points.D - step,
        "near E": points.E,
    }
    nearest = {name: int(np.argmin(np.abs(contacts.rho1 - rho))) for name, rho in wanted.items()}
    fine = {name: solve(films[i].contact, nodes=PROFILE_NODES) for name, i in nearest.items()}
    return {name: replace(film, state=None) for name, film in fine.items() if film.converged}
