"""The oil film at every point of the mesh cycle, in series with the teeth before load sharing."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np

import ehl
import gears
from base import unclocked
from ehl.solving.options import warn_of_pressure
from flankfilm.coupling.films.along_path import FilmAlongPath
from flankfilm.coupling.films.films import FilmModel
from flankfilm.coupling.films.lubricated_cells import lubricate_cells
from flankfilm.coupling.films.lubricated_path import FilmRun, lubricate_path
from flankfilm.coupling.films.lubricated_record import LubricatedCycle
from flankfilm.coupling.mesh.cells import has_cells
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth, TeethOptions
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.mesh_cycles import resolved
from flankfilm.coupling.mesh.resolution import Resolution
from flankfilm.coupling.mesh.warn_once import pressures_unsaid, warned_once

BEHIND = 1e-3
"""Part of the load that films on back flanks carry, from which films of a plane pair are solved over place and load.

The law along the path knows the loads of the front flanks alone: below these it would give too thin films.
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
    """Mesh cycle with films in series, along the path or, over a face and near back flanks, over place and line load.

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
        over_loads = has_cells(dry) or (
            model.follows_load and _carried_behind(teeth, dry, speed, lubricant) > BEHIND
        )
        put_in = lubricate_cells if over_loads else lubricate_path
        run = FilmRun(teeth, dry, speed, lubricant, resolution, model)
        lubricated = put_in(run, profiles=profiles)
    if model.name == "ehl":
        warn_of_pressure(lubricant, lubricated.film.greatest_pressure)
    return lubricated


def _carried_behind(teeth: LoadedTeeth, dry: MeshCycle, speed: float, lubricant: ehl.Lubricant) -> float:
    """Part of the load that films on back flanks would carry at most, by rigid cylinders in an isoviscous oil.

    F = 4.896 eta u R b/h, Martin's, with h the backlash and what the teeth give way by.
    """
    if (teeth.model, teeth.pairs) != ("fem", "coupled"):
        return 0.0  # pairs without a common body have no back flanks
    pair, moved = teeth.pair, dry.transmission_error
    gap = float(np.min(pair.backlash + moved if teeth.torque > 0.0 else -moved))
    path = pair.path_at(np.linspace(pair.points.A, pair.points.E, 41))
    rolling = float(np.mean(path.entrainment(speed) * path.radius)) * pair.contact_ratio
    carried = 4.896 * lubricant.viscosity * abs(rolling) * pair.face_width
    return carried / (max(gap, 1e-9) * teeth.force)
