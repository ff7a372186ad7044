"""What the oil film damps of the mesh: every film's answer to an oscillating load, in series with its teeth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import ehl
import fem
import gears
from base import (
    Array,
    Cost,
    Faults,
    Limit,
    Stopwatch,
    described,
    quantity,
    record,
)
from base.results import EXACT
from flankfilm.coupling.films.film_responses import FilmResponses, film_responses
from flankfilm.coupling.films.films import FilmModel, contacts_of, films_along, supply_of, touching
from flankfilm.coupling.films.lubricated import SOLVED
from flankfilm.coupling.films.lubricated_record import LubricatedCycle
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.warn_once import warned_once
from flankfilm.coupling.vibration.oscillator import pair_scales

POSITIONS = 40
"""Positions of a base pitch at which films answer, at most."""

NOT_COUNTED = (
    "what else damps is not known and not counted: the gears' material and fits, bearings, shafts and couplings, oil "
    "that splashes, flanks that slide"
)
"""What stands beside a damping ratio that is the film's."""

_FREQUENCY = Limit.above(0.0, 1e12, "rad/s", "leave it out for the natural frequency of the pair")
_SPEED = Limit.above(0.0, 1e6, "rad/s", "give the pinion's speed in rad/s")


@record
class FilmDamping:
    """Damping and stiffness that films add to the mesh at one frequency, in the mean over a base pitch."""

    headline = ("damping_ratio", "damping", "natural_frequency")

    damping_ratio: float = quantity(
        "1", "damping of the films over the critical one of the pair", error="error"
    )
    damping: float = quantity("N s/m", "mean damping of the mesh by its films", error="error")
    stiffness_change: float = quantity(
        "1",
        "what films change the mean tangent stiffness by at the frequency, relative",
        shown="%",
        no_error="not estimated: the difference of two means",
        called="tangent_stiffness_change",
    )
    frequency: float = quantity("rad/s", "angular frequency of the oscillation", no_error=EXACT)
    natural_frequency: float = quantity(
        "rad/s",
        "natural frequency of the pair with its mean stiffness",
        no_error="not estimated; the mean stiffness has one",
    )
    equivalent_mass: float = quantity("kg", "equivalent mass along the line of action", no_error=EXACT)
    position: Array = quantity("1", "position, base pitches from A", "position", no_error=EXACT)
    damping_curve: Array = quantity(
        "N s/m", "damping of the mesh by its films", "position", no_error="not estimated in single positions"
    )
    error: float
    cost: Cost
    converged: bool = True
    message: str = NOT_COUNTED

    @described("N/m", "position", no_error="not estimated in single positions")
    def loss_stiffness(self) -> Array:
        """Force a quarter of a period ahead of the deflection, per deflection."""
        return self.frequency * self.damping_curve


def film_damping(
    cycle: MeshCycle,
    pair: gears.GearPair,
    torque: float,
    speed: float,
    lubricant: ehl.Lubricant,
    *,
    film: FilmModel = SOLVED,
    frequency: float | None = None,
    extra_inertia: tuple[float, float] = (0.0, 0.0),
    reference: str = "body",
    tolerance: float = 0.005,
) -> FilmDamping:
    """Damping of the mesh by its oil films, in series with the teeth.

    At every position the deflection oscillates as one for all loaded pairs: each answers with its own slope g and its
    film's complex compliance C, ``K = sum 1/(1/g + C(omega)/b)``, ``c = Im K/omega``. The damping ratio is that of the
    mean of c over a base pitch, ``c/(2 m_e omega_n)``.

    Cells of lines of contact each have the slope of their force and their film, and the pair is their sum: what films
    change the mesh by is exact in the first order, whatever the bodies couple. Their films are solved once over places
    and line loads.

    Damping decides a motion where it oscillates near its natural frequency, whatever excites it; so that is the
    frequency unless another is given. A film damps less the faster it oscillates.

    Parameters
    ----------
    cycle : MeshCycle
        Of the pair under the torque; the slopes of its teeth are taken without film where it has both.
    pair : gears.GearPair
    torque, speed : float
        Of the pinion [N m], [rad/s].
    lubricant : ehl.Lubricant
    film : FilmModel
        Solved; asperities share the oscillating load, the meniscus of a layer moves with it.
    frequency : float, optional
        [rad/s].
    extra_inertia : (float, float)
        What turns with pinion and wheel, on their bores [kg m2].
    reference : {"body", "bore", "teeth"}
        What deflections are measured against, as of `pair_oscillator`.
    tolerance : float
        Relative, of the films.

    Raises
    ------
    InputError
        With every fault of the arguments: formulas have no answer.
    SolverError
        Where a film has no solution.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    >>> cycle = mesh_cycle(pair, 6.0, model="ishikawa")
    >>> damped = film_damping(cycle, pair, 6.0, 209.44, oil, tolerance=0.02)
    >>> f"{damped.damping_ratio:.2f}"
    '0.11'
    """
    _check(film, speed, frequency, tolerance)
    watch = Stopwatch()
    teeth = _Teeth.of(cycle, reference, extra_inertia)
    scales = pair_scales(pair, torque, teeth.mean, extra_inertia)
    omega = scales.omega_n if frequency is None else float(frequency)
    asked = _Asked(cycle, pair, speed, lubricant, film, omega, tolerance)
    with warned_once():
        summed = _of_pairs(asked, teeth) if teeth.lines is None else _of_cells(asked, teeth.lines)
    damping = float(np.mean(summed.damping))
    critical = 2.0 * scales.equivalent_mass * scales.omega_n
    return FilmDamping(
        damping_ratio=damping / critical,
        damping=damping,
        stiffness_change=float(np.mean(summed.stiffer) / np.mean(summed.stiffness)),
        frequency=omega,
        natural_frequency=scales.omega_n,
        equivalent_mass=scales.equivalent_mass,
        position=summed.position,
        damping_curve=summed.damping,
        error=summed.error,
        cost=Cost(watch.seconds, counts={"films": summed.films}),
    )


@dataclass(frozen=True)
class _Asked:
    """What films are asked for."""

    cycle: MeshCycle
    pair: gears.GearPair
    speed: float
    lubricant: ehl.Lubricant
    film: FilmModel
    omega: float
    tolerance: float


@dataclass(frozen=True)
class _Summed:
    """Over some positions: damping [N s/m], by how much films make the mesh stiffer, and its stiffness [N/m]."""

    position: Array
    damping: Array
    stiffer: Array
    stiffness: Array
    error: float
    films: int


def _of_pairs(asked: _Asked, teeth: _Teeth) -> _Summed:
    """Films of whole pairs, each with its slope."""
    cycle, pair, omega = asked.cycle, asked.pair, asked.omega
    stride = max(1, round(cycle.position.size / POSITIONS))
    kept = np.arange(cycle.position.size) % stride == stride // 2
    loaded, number = touching(cycle)
    places, contacts = contacts_of(pair, cycle, asked.speed, asked.lubricant)
    chosen = np.flatnonzero(kept[loaded])
    few = tuple(contacts[i] for i in chosen)
    supplies = tuple(supply_of(asked.film.supply, contact) for contact in few)
    films = films_along(asked.film, places[chosen], few, supplies, (), asked.tolerance)
    answers = [
        ehl.film_response(solved, omega) for solved in films if not isinstance(solved, ehl.FormulaFilm)
    ]
    slope = teeth.slopes[loaded[chosen], number[chosen]]
    yielding = np.array([answer.compliance for answer in answers]) / pair.face_width
    errors = np.array([answer.error for answer in answers]) + np.array(
        [answer.film.error for answer in answers]
    )
    series = np.divide(1.0, 1.0 / np.maximum(slope, 1e-300) + yielding)
    curve = np.zeros(cycle.position.size)
    np.add.at(curve, loaded[chosen], series.imag / omega)
    stiff = np.zeros(cycle.position.size)
    np.add.at(stiff, loaded[chosen], series.real - slope)
    off = float(np.sum(np.abs(series) ** 2 * np.abs(yielding) * errors) / np.abs(np.sum(series.imag)))
    return _Summed(
        cycle.position[kept], curve[kept], stiff[kept], teeth.slopes.sum(axis=1)[kept], off, len(answers)
    )


def _of_cells(asked: _Asked, lines: fem.LineLoads) -> _Summed:
    """Films of all cells of lines of contact, each with the slope of its force."""
    dry = asked.cycle.dry if isinstance(asked.cycle, LubricatedCycle) else asked.cycle
    responses = film_responses(
        asked.pair, dry, asked.speed, asked.lubricant, asked.film, asked.omega, asked.tolerance
    )
    cosine, load = asked.pair.helix.base_cosine, np.nan_to_num(lines.line_load)
    at = np.nonzero((load > 0.0) & (lines.slopes > 0.0))
    rho1, pressed, slope = lines.rho[0][at], load[at], lines.slopes[at] / cosine
    length = np.broadcast_to(lines.length[..., None], load.shape)[at]
    wet = lines.on_path[at]  # tip edges are dry

    def series(by: FilmResponses) -> tuple[Array, Array]:
        """Stiffness of cells with their films along the transverse line of action, and what films yield."""
        yielding = wet * by.compliance(rho1, pressed) / length
        return cosine**2 / (1.0 / slope + yielding), yielding

    def over_cycle(values: Array) -> Array:
        total = np.zeros(len(load))
        np.add.at(total, at[0], values)
        return total

    whole, yielding = series(responses)
    total = float(np.sum(whole.imag))
    by_films = np.abs(whole / cosine) ** 2 * np.abs(yielding) * responses.relative_error(rho1, pressed)
    by_grid = sum(
        part * abs(float(np.sum(series(other)[0].imag)) - total) for other, part in responses.varied()
    )
    alone = over_cycle(cosine**2 * slope)
    return _Summed(
        lines.position,
        over_cycle(whole.imag / asked.omega),
        over_cycle(whole.real) - alone,
        alone,
        (float(np.sum(by_films)) + by_grid) / abs(total),
        responses.in_phase.size,
    )


@dataclass(frozen=True)
class _Teeth:
    """Slopes of the pairs' forces without film (positions, pairs), and the mean secant with it [N/m].

    Of lines of contact also these, whose cells have their slopes.
    """

    slopes: Array
    mean: float
    lines: fem.LineLoads | None = None

    @classmethod
    def of(cls, cycle: MeshCycle, reference: str, extra_inertia: tuple[float, float]) -> _Teeth:
        """Take them from a cycle; closed forms share the slope as they share the force."""
        dry = cycle.dry if isinstance(cycle, LubricatedCycle) else cycle
        if dry.contact is None:
            return cls(dry.stiffness[:, None] * np.nan_to_num(dry.load_share), cycle.mean_secant_stiffness)
        against, slopes = dry.against(reference, extra_inertia), np.nan_to_num(dry.contact.pair_stiffness)
        scale = against.stiffness / slopes.sum(axis=1)
        mean = cycle.against(reference, extra_inertia).mean_secant_stiffness
        assert against.contact is not None
        return cls(slopes * scale[:, None], mean, against.contact.lines)


def _check(film: FilmModel, speed: Any, frequency: Any, tolerance: Any) -> None:
    """Raise every fault of the arguments."""
    with Faults() as faults:
        faults.number("speed", speed, _SPEED)
        faults.number("tolerance", tolerance, Limit.above(0.0, 0.2, remedy="0.005 is 0.5 %"))
        if frequency is not None:
            faults.number("frequency", frequency, _FREQUENCY)
        if film.name != "ehl":
            allowed = "must be solved films for their damping: a formula has none"
            faults.add("film.name", repr(film.name), allowed, 'take film.model = "ehl"')
