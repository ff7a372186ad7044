"""Losses and temperatures of the mesh: films with heat, load share and bulk temperatures in agreement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Unpack

import numpy as np

import ehl
import gears
from base import Array, Cost, Faults, SolverError, Stopwatch, unclocked
from flankfilm.coupling.bulk_balance import BulkBalance
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.films import Held
from flankfilm.coupling.heated_films import HeatedFilms, HeatedOil, heated_films, sliding_contacts, thinned
from flankfilm.coupling.heated_table import FEW as FEW_GRID
from flankfilm.coupling.heated_table import GRID, HeatedTable, heated_table
from flankfilm.coupling.loaded_teeth import LoadedTeeth, TeethOptions
from flankfilm.coupling.losses_along_path import losses_along
from flankfilm.coupling.losses_faults import TEMPERATURE, check_bodies, check_numbers, check_temperatures
from flankfilm.coupling.losses_over_face import face_losses, of_all_cells
from flankfilm.coupling.losses_record import LossBand, MeshLosses
from flankfilm.coupling.mean_losses import Carried, Means, means_of
from flankfilm.coupling.mesh_cycles import resolved
from flankfilm.coupling.warned import warned_once

POSITIONS = 40
"""Positions of a base pitch at which films are solved."""

FINER = 8
"""Times as many positions that means are taken over, friction and rolling being carried between the films."""

FINER_FACE = 3
"""The same where the load varies along the face, whose cells take their time; that of films is told as an error."""

HALVED = 0.5
"""Part of what films at half as many places or loads change that those left out may: a quarter where these resolve."""

FEW = 9
"""Films that first values are found from, and the losses at either end of the band."""

BAND = (5e6, 10e6)
"""Eyring's stress of most oils [Pa]."""

FIRST_FRICTION = 0.03

MOST_ROUNDS = 12

MORE = "more positions, or a smaller tolerance of the films, lower it"

WARMER = 0.2
"""Change of bulk temperatures that is left where they are balanced [K]."""


def mesh_losses(
    pair: gears.GearPair,
    torque: float,
    speed: float,
    lubricant: ehl.Lubricant,
    *,
    solids: tuple[ehl.Solid, ehl.Solid] = (ehl.STEEL, ehl.STEEL),
    bulk_temperatures: tuple[float, float] | None = None,
    heat_transfer: tuple[float, float] | None = None,
    ambient_temperature: float | None = None,
    tolerance: float = 0.01,
    roughness: ehl.Roughness | None = None,
    boundary_friction: float = 0.1,
    supply: Held = None,
    positions: int = POSITIONS,
    **teeth: Unpack[TeethOptions],
) -> MeshLosses:
    """Friction, losses and temperatures of a lubricated mesh over one base pitch.

    Films with heat and shear thinning are solved at every loaded contact, each from its neighbour. Their mean friction
    tilts the forces by which the load is shared, and that is done again until the forces stay.

    Parameters
    ----------
    pair : gears.GearPair
    torque, speed : float
        Of the pinion [N m], [rad/s].
    lubricant : ehl.Lubricant
        With Eyring's stress and what heat does with it.
    solids : (ehl.Solid, ehl.Solid)
        What pinion and wheel do with heat.
    bulk_temperatures : (float, float), optional
        Of pinion and wheel [K]; those of the lubricant's data unless given or balanced.
    heat_transfer : (float, float), optional
        From pinion and wheel to their surroundings, heat transfer coefficient times area [W/K]: the bulk temperatures
        are then those at which this takes away the mesh's losses.
    ambient_temperature : float, optional
        Of these surroundings, beside `heat_transfer` [K].
    tolerance : float
        Relative, of films and friction.
    roughness : ehl.Roughness, optional
        Of both flanks together; smooth without.
    boundary_friction : float
        Coefficient of friction of what asperities carry.
    supply : ehl.Meniscus, ehl.OilLayer or PlacedMeniscus, optional
        What is held at the inlets; flooded without.
    positions : int
        Equal intervals of the base pitch.
    **teeth
        As of `lubricated_cycle`.

    Returns
    -------
    MeshLosses

    Raises
    ------
    InputError
        With every fault of the arguments.
    SolverError
        Where a film has no solution, or temperatures do not settle.

    Notes
    -----
    Where the load varies along the face (leads, ``Flanks(alignment=, cells=)``) cells add up, and `over_face` has them.

    The films change the load share by friction alone. What asperities carry makes heat that no film feels. Equations
    and limits: docs/theory/losses.md.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    >>> found = mesh_losses(pair, 300.0, 209.44, oil, model="potential-energy", positions=4)
    >>> 0.99 < found.efficiency < 1.0
    True
    """
    loaded = LoadedTeeth(pair, torque, **teeth)
    with Faults() as found:
        check_bodies(found, loaded, lubricant, solids)
        check_temperatures(found, bulk_temperatures, heat_transfer, ambient_temperature)
        check_numbers(found, boundary_friction, positions, roughness, supply)
    with warned_once():
        loaded, _ = resolved(loaded, tolerance, speed=speed)
        with unclocked():
            ehl.solve_thermal  # noqa: B018 - loads the solver
        at_rest = lubricant.temperature
        run = _Run(
            loaded,
            speed,
            lubricant,
            HeatedOil(solids, roughness, boundary_friction, tolerance, supply),
            positions,
            0.5 * tolerance,
            None if heat_transfer is None else np.array(heat_transfer),
            at_rest if ambient_temperature is None else ambient_temperature,
        )
        return run.solved(bulk_temperatures or (at_rest, at_rest))


@dataclass(frozen=True)
class _Agreed:
    """Films, forces and temperatures that agree."""

    films: HeatedFilms | HeatedTable
    cycle: MeshCycle
    bulk: tuple[float, float]
    means: Means
    rounds: int
    shares: float
    warmer: float


@dataclass(frozen=True)
class _Run:
    """What films, load share and temperatures are computed from."""

    teeth: LoadedTeeth
    speed: float
    lubricant: ehl.Lubricant
    oil: HeatedOil
    positions: int
    agreement: float
    transfer: Array | None
    ambient: float

    def solved(self, bulk: tuple[float, float]) -> MeshLosses:
        """Solve everything."""
        watch = Stopwatch()
        first = self._agree(FEW, FIRST_FRICTION, bulk)
        agreed = self._agree(None, first.means.friction, first.bulk, first.films)
        means, every = agreed.means, self._cycle(agreed.means.friction, self.positions)
        along = self._along(agreed, every)
        band, path = self._band(agreed, along), losses_along(self.teeth.pair, along, agreed.bulk)
        over, carried = None, 0.0
        if isinstance(agreed.films, HeatedTable):
            halves = (self._means(agreed.cycle, agreed.films.every_second(axis)) for axis in (0, 1))
            carried = sum(HALVED * _off(half, means) for half in halves)
            over = face_losses(self.teeth.pair, every, self.speed, agreed.films, carried)
            path = of_all_cells(path, over, every)
        lost = path.sliding_loss
        by_films = np.average(path.friction_error, weights=lost) if lost.any() else 0.0
        error = float(by_films) + _off(self._means(every, agreed.films), means) + agreed.shares + carried
        return MeshLosses(
            cycle=agreed.cycle,
            path=path,
            speed=self.speed,
            input_power=self._power,
            mean_friction=means.friction,
            sliding_loss=means.sliding_loss,
            rolling_loss=means.rolling_loss,
            edge_loss=means.edge_loss,
            loss_factor=means.loss_factor,
            ohlendorf_loss_factor=_ohlendorf(self.teeth.pair),
            bulk_temperatures=np.array(agreed.bulk),
            heat=means.heat,
            heat_transfer=self.transfer,
            band=band,
            rounds=first.rounds + agreed.rounds,
            share_mismatch=agreed.shares,
            temperature_mismatch=agreed.warmer,
            error=error,
            message=_message(error, carried) if error > self.oil.tolerance else "",
            cost=Cost(watch.seconds, max(film.cost.unknowns for film in agreed.films.films)),
            over_face=over,
        )

    @property
    def _power(self) -> float:
        return abs(self.teeth.torque) * self.speed

    def _cycle(self, friction: float, positions: int) -> MeshCycle:
        flanks = replace(self.teeth.flanks, friction=friction)
        return replace(self.teeth, flanks=flanks).cycle(positions)

    def _means(
        self, cycle: MeshCycle, films: HeatedFilms | HeatedTable, ratios: Carried | None = None
    ) -> Means:
        known = replace(films, ratios=ratios) if isinstance(films, HeatedTable) else Carried.of(films, ratios)
        return means_of(self.teeth.pair, cycle, self.speed, self._power, known)

    def _along(self, agreed: _Agreed, cycle: MeshCycle) -> HeatedFilms:
        """Films along the path; those of the most loaded cells where the load varies along the face."""
        if isinstance(agreed.films, HeatedFilms):
            return agreed.films
        assert cycle.contact is not None
        assert cycle.contact.face is not None
        greatest = cycle.contact.face.line_load.max(axis=-1)
        rho1, contacts = sliding_contacts(self.teeth.pair, cycle, self.speed, self.lubricant, greatest)
        return heated_films(rho1, contacts, self.oil, agreed.bulk)

    def _agree(
        self,
        most: int | None,
        friction: float,
        bulk: tuple[float, float],
        films: HeatedFilms | HeatedTable | None = None,
    ) -> _Agreed:
        """Iterate films, load share and temperatures, with so many films at most, from some where they are as many."""
        balance, rounds = BulkBalance(), 0
        cycle = self._cycle(friction, self.positions)
        while True:
            rounds += 1
            films = self._films(cycle, most, bulk, films)
            means = self._means(cycle, films)
            before, cycle = cycle, self._cycle(means.friction, self.positions)
            shares = float(np.nanmax(np.abs(cycle.load_share - before.load_share)))
            by = FINER if isinstance(films, HeatedFilms) else FINER_FACE
            finer = self._cycle(means.friction, by * self.positions)
            means = self._means(finer, films)
            asked = bulk if self.transfer is None else self._balanced(means)
            warmer = float(np.max(np.abs(np.subtract(asked, bulk))))
            if shares <= self.agreement and warmer <= WARMER:
                return _Agreed(films, finer, bulk, means, rounds, shares, warmer)
            if rounds == MOST_ROUNDS:
                raise SolverError(
                    f"losses and bulk temperatures did not agree within {MOST_ROUNDS} rounds (temperatures still "
                    f"change by {warmer:.2g} K, forces by {shares:.1e} of the whole): give bulk_temperatures"
                )
            bulk = bulk if self.transfer is None else balance.next(bulk, asked)

    def _films(
        self,
        cycle: MeshCycle,
        most: int | None,
        bulk: tuple[float, float],
        before: HeatedFilms | HeatedTable | None,
    ) -> HeatedFilms | HeatedTable:
        if cycle.contact is not None and cycle.contact.face is not None:
            return self._table(cycle, GRID if most is None else FEW_GRID, bulk, before)
        assert not isinstance(before, HeatedTable)
        rho1, contacts = sliding_contacts(self.teeth.pair, cycle, self.speed, self.lubricant)
        kept = thinned(len(contacts), most or len(contacts))
        same = before is not None and before.rho1.size == kept.size
        return heated_films(
            rho1[kept], [contacts[k] for k in kept.tolist()], self.oil, bulk, before if same else None
        )

    def _table(
        self,
        cycle: MeshCycle,
        grid: tuple[int, int],
        bulk: tuple[float, float],
        before: HeatedFilms | HeatedTable | None,
    ) -> HeatedTable:
        """Films over place and line load: those of the round before where these are the same."""
        assert cycle.contact is not None
        assert cycle.contact.face is not None
        table = before if isinstance(before, HeatedTable) and len(before.rows) == grid[0] else None
        greatest = cycle.contact.face.greatest_line_load
        if table is not None and table.bulk == bulk and greatest <= table.load[0]:
            return table
        return heated_table(self.teeth.pair, cycle, self.speed, self.lubricant, self.oil, bulk, grid, table)

    def _balanced(self, means: Means) -> tuple[float, float]:
        """Temperatures at which the losses are taken away."""
        assert self.transfer is not None
        first, second = (self.ambient + means.heat / self.transfer).tolist()
        if max(first, second) > TEMPERATURE.high:
            raise SolverError(
                f"bulk temperatures of {first:.4g} and {second:.4g} K would take away the mesh's losses of "
                f"{means.heat.sum():.4g} W: give more heat_transfer"
            )
        return first, second

    def _band(self, agreed: _Agreed, path: HeatedFilms) -> LossBand:
        """Losses at the ends of the band of Eyring's stress, by the ratios of some films along the path."""
        some = path.some(FEW)
        found, along, off = [], [], [0.0]
        for stress in BAND:
            ratios = self._ratios(some, stress, agreed.bulk)
            means, coarser = (
                self._means(agreed.cycle, agreed.films, one) for one in (ratios, ratios.some((FEW + 1) // 2))
            )
            found.append(means)
            along.append(Carried.of(path, ratios).friction)
            off.append(_off(coarser, means))
        return _band(found, np.array(along), max(off), self._power)

    def _ratios(self, some: HeatedFilms, stress: float, bulk: tuple[float, float]) -> Carried:
        """Friction and rolling of some films at another stress, over those at the given one."""
        if stress == self.lubricant.eyring_stress:
            return Carried.ones(some.rho1)
        oil = replace(self.lubricant, eyring_stress=stress)
        contacts = [replace(one, lubricant=oil) for one in some.contacts]
        return Carried.of(heated_films(some.rho1, contacts, self.oil, bulk, some)).over(Carried.of(some))


def _message(error: float, carried: float) -> str:
    """What a user should know of an error above the tolerance."""
    if carried > 0.5 * error:
        return f"errs by {error:.1e}, most of it what is interpolated between films of the face's cells"
    return f"errs by {error:.1e}: {MORE}"


def _off(one: Means, other: Means) -> float:
    """Relative difference of mean losses."""
    return abs(one.mesh_loss / other.mesh_loss - 1.0) if other.mesh_loss else 0.0


def _band(found: Sequence[Means], along: Array, error: float, power: float) -> LossBand:
    def each(name: str) -> Array:
        return np.array([getattr(one, name) for one in found])

    loss = each("mesh_loss")
    return LossBand(
        eyring_stress=np.array(BAND),
        mean_friction=each("friction"),
        sliding_loss=each("sliding_loss"),
        rolling_loss=each("rolling_loss"),
        mesh_loss=loss,
        efficiency=1.0 - loss / power,
        friction_coefficient=along,
        error=error,
    )


def _ohlendorf(pair: gears.GearPair) -> float | None:
    try:
        return gears.closed_form.ohlendorf_loss_factor(pair)
    except gears.GeometryError:
        return None
