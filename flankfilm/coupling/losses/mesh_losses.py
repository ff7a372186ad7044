"""Losses and temperatures of the mesh: films with heat, load share and bulk temperatures in agreement."""

from __future__ import annotations

from typing import Unpack

import numpy as np

import ehl
import gears
from base import Cost, Faults, Stopwatch, unclocked
from ehl.discrete.regimes import BOUNDARY_FRICTION
from ehl.solving.options import warn_of_pressure
from flankfilm.coupling.films.films import Held
from flankfilm.coupling.losses.heated_films import HeatedOil
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.coupling.losses.loss_band import boundary_band_of, loss_band
from flankfilm.coupling.losses.losses_along_path import losses_along
from flankfilm.coupling.losses.losses_faults import check_bodies, check_numbers, check_temperatures
from flankfilm.coupling.losses.losses_on_lines import line_losses, of_all_lines
from flankfilm.coupling.losses.losses_over_face import face_losses, of_all_cells
from flankfilm.coupling.losses.losses_record import MeshLosses
from flankfilm.coupling.losses.losses_rounds import LossRounds
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth, TeethOptions
from flankfilm.coupling.mesh.mesh_cycles import resolved
from flankfilm.coupling.mesh.warn_once import pressures_unsaid, warned_once

POSITIONS = 40
"""Positions of a base pitch at which films are solved."""

HALVED = 0.5
"""Part of what films at half as many places or loads change that those left out may: a quarter where these resolve."""

FEW = 9
"""Films that first values are found from, and the losses at either end of the band."""

FIRST_FRICTION = 0.03

BELOW, ABOVE = 0.8, 1.2
"""Ends of the band of the asperities' friction over it, unless they are given."""

MORE = "more positions, or a smaller tolerance of the films, lower it"


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
    boundary_friction: float = BOUNDARY_FRICTION,
    boundary_band: tuple[float, float] | None = None,
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
    boundary_band : (float, float), optional
        Lowest and highest that it may be: decides the model error of friction and losses. A fifth below and above
        unless given.
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
    Where the load varies along the face (leads, ``Flanks(alignment=, cells=)``) cells add up, and `over_face` has them;
    those on lines of contact of helical pairs are in `over_lines`. Forces on these do not tilt by the friction, and
    what that would change of them is part of the error.

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
    with Faults() as faults:
        check_bodies(faults, loaded, lubricant, solids)
        check_temperatures(faults, bulk_temperatures, heat_transfer, ambient_temperature)
        check_numbers(faults, boundary_friction, boundary_band, positions, roughness, supply)
    with warned_once():
        loaded, _ = resolved(loaded, tolerance, speed=speed)
        with unclocked():
            ehl.solve_thermal  # noqa: B018 - loads the solver
        at_rest = lubricant.temperature
        rounds = LossRounds(
            loaded,
            speed,
            lubricant,
            HeatedOil(solids, roughness, boundary_friction, tolerance, supply),
            positions,
            0.5 * tolerance,
            None if heat_transfer is None else np.array(heat_transfer),
            at_rest if ambient_temperature is None else ambient_temperature,
        )
        band = boundary_band or (BELOW * boundary_friction, ABOVE * boundary_friction)
        with pressures_unsaid():
            losses = _solved(rounds, bulk_temperatures or (at_rest, at_rest), band)
        warn_of_pressure(lubricant, float(losses.path.hertz_pressure.max()))
        return losses


def _solved(rounds: LossRounds, bulk: tuple[float, float], ends: tuple[float, float]) -> MeshLosses:
    """Losses with films that agree with all they depend on, first by few of them."""
    watch = Stopwatch()
    first, tried = rounds.agree(FEW, FIRST_FRICTION, bulk)
    agreed, settled = rounds.agree(None, first.means.friction, first.bulk, first.films)
    means, full_cycle = agreed.means, rounds.cycle(agreed.means.friction, rounds.positions)
    along = rounds.along(agreed, full_cycle)
    path = losses_along(rounds.teeth.pair, along, agreed.bulk)
    over, over_lines, carried = None, None, 0.0
    if isinstance(agreed.films, HeatedTable):
        halves = (rounds.means(agreed.cycle, agreed.films.every_second(axis)) for axis in (0, 1))
        carried = sum(HALVED * half.off(means) for half in halves)
        known = rounds.teeth.pair, full_cycle, rounds.speed, agreed.films, carried
        if full_cycle.lines is None:
            over = face_losses(*known)
            path = of_all_cells(path, over, full_cycle)
        else:
            over_lines = line_losses(*known)
            path = of_all_lines(path, over_lines, full_cycle)
    lost = path.sliding_loss
    by_films = np.average(path.friction_error, weights=lost) if lost.any() else 0.0
    error = float(by_films) + rounds.means(full_cycle, agreed.films).off(means) + agreed.shares + carried
    return MeshLosses(
        cycle=agreed.cycle,
        path=path,
        speed=rounds.speed,
        input_power=rounds.power,
        mean_friction=means.friction,
        sliding_loss=means.sliding_loss,
        rolling_loss=means.rolling_loss,
        edge_loss=means.edge_loss,
        loss_factor=means.loss_factor,
        ohlendorf_loss_factor=_ohlendorf(rounds.teeth.pair),
        bulk_temperatures=np.array(agreed.bulk),
        heat=means.heat,
        heat_transfer=rounds.transfer,
        band=loss_band(rounds, agreed, along, FEW, error),
        boundary=None if rounds.oil.roughness is None else boundary_band_of(rounds, agreed, ends),
        rounds=tried + settled,
        share_mismatch=agreed.shares,
        temperature_mismatch=agreed.trial.change,
        error=error,
        message=_message(error, carried) if error > rounds.oil.tolerance else "",
        cost=Cost(watch.seconds, max(film.cost.unknowns for film in agreed.films.films)),
        over_face=over,
        over_lines=over_lines,
    )


def _message(error: float, carried: float) -> str:
    """Remark for the user on an error above the tolerance."""
    if carried > 0.5 * error:
        return f"errs by {error:.1e}, most of it what is interpolated between films of the face's cells"
    return f"errs by {error:.1e}: {MORE}"


def _ohlendorf(pair: gears.GearPair) -> float | None:
    try:
        return gears.closed_form.ohlendorf_loss_factor(pair)
    except gears.GeometryError:
        return None
