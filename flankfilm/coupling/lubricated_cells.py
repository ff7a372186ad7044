"""Films of all cells in series with the teeth: a load that is even along the face has one cell.

Where flanks bear on cells of a face, the active set is one over pairs and cells; flanks on the other side of the teeth
have the same films, under whatever they bear.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import ehl
from base import Array, Integers, Stopwatch
from fem.contact.shared_contacts import yielding_over_face
from flankfilm.coupling import films
from flankfilm.coupling.along_path import gathered
from flankfilm.coupling.cells import line_loads
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.face_films import face_films
from flankfilm.coupling.film_table import FilmTable, film_table
from flankfilm.coupling.films import FilmModel, PathFilms, contacts_of, films_of
from flankfilm.coupling.lubricated_path import FLOODED, held_otherwise
from flankfilm.coupling.lubricated_record import LubricatedCycle

if TYPE_CHECKING:
    from flankfilm.coupling.loaded_teeth import LoadedTeeth
    from flankfilm.coupling.resolution import Resolution

__all__ = ["lubricate_cells"]


def lubricate_cells(
    teeth: LoadedTeeth,
    dry: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    resolution: Resolution,
    model: FilmModel,
    *,
    profiles: bool,
) -> LubricatedCycle:
    """Put films of all cells in series with the teeth; arguments as of `lubricate`.

    Films are functions of place and line load alone, so that a table of them is solved once and no rounds are needed:
    load share and films agree to the last digit of the table. The film along the path is solved at the most loaded cell
    of each contact, where it is smallest.
    """
    watch, pair = Stopwatch(), teeth.pair
    table = film_table(pair, dry, speed, lubricant, model, resolution.films)
    seconds = watch.seconds
    cycle = _in_series(teeth, dry, table, resolution, f"{dry.label} with film")
    load = line_loads(cycle, pair.face_width)
    least = table.thickness("minimum_thickness", np.broadcast_to(cycle.rho1[..., None], load.shape), load)
    watch, shown = Stopwatch(), _shown(cycle.position.size)
    path = _of_most_loaded(teeth, cycle, speed, lubricant, resolution, model)
    otherwise = {}
    if cycle.face is None and model.supply is not None:
        smooth = film_table(pair, dry, speed, lubricant, model.smooth_and_flooded, resolution.films)
        otherwise = {FLOODED: _in_series(teeth, dry, smooth, resolution, FLOODED)}
        otherwise |= held_otherwise(teeth, dry, speed, lubricant, resolution, model, path)
    return LubricatedCycle(
        **MeshCycle.fields_of(cycle),
        least_film=_least(least),
        rounds=1,
        mismatch=0.0,
        dry=dry,
        film=gathered(model, path, pair, cycle, watch.seconds, shown.size if profiles else None),
        otherwise=otherwise,
        over_face=None if cycle.face is None else face_films(cycle, table, seconds),
    )


def _in_series(
    teeth: LoadedTeeth, dry: MeshCycle, table: FilmTable, resolution: Resolution, label: str
) -> MeshCycle:
    """Mesh cycle with films in series, whose secant counts what they yield, and whose error what they err by."""
    tolerance = min(resolution.sampling, resolution.transmission_error)
    cycle = teeth.with_films(dry.position.size, table, tolerance, table.varied())
    load = line_loads(cycle, teeth.pair.face_width)
    forces = load * teeth.pair.face_width / load.shape[-1]
    yields = yielding_over_face(table, cycle.rho1, forces, cycle.load_share)
    secant = teeth.force / (teeth.force / cycle.secant_stiffness + yields)
    changed = float(np.max(np.abs(secant / dry.secant_stiffness - 1.0)))
    unknown = 0.0 if table.error is None else table.error
    error = None if cycle.error is None else cycle.error + unknown * changed
    return replace(cycle, label=label, secant_stiffness=secant, error=error)


def _least(thickness: Array) -> Array:
    """Smallest over the cells (positions, pairs); nan where none is known."""
    least = np.where(np.isfinite(thickness), thickness, np.inf).min(axis=-1)
    return np.where(np.isfinite(least), least, np.nan)


def _shown(positions: int) -> Integers:
    """Positions at which films are solved by themselves, at equal steps."""
    step = max(1, positions // films.FILM_POSITIONS)
    return np.arange(step // 2, positions, step)


def _of_most_loaded(
    teeth: LoadedTeeth,
    cycle: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    resolution: Resolution,
    model: FilmModel,
) -> PathFilms:
    """Films of the most loaded cells at some of the positions."""
    kept = _shown(cycle.position.size)
    few = replace(
        cycle,
        rho1=cycle.rho1[kept],
        forces=cycle.forces[kept],
        load_share=cycle.load_share[kept],
        contact=None,
    )
    greatest = line_loads(cycle, teeth.pair.face_width).max(axis=-1)[kept]
    rho1, contacts = contacts_of(teeth.pair, few, speed, lubricant, greatest)
    return films_of(model, rho1, contacts, None, resolution.films)
