"""Films of all cells in series with the teeth, over place and line load; a plane pair has one cell.

Where flanks bear on cells of a face, the active set is one over pairs and cells; flanks on the other side of the teeth
have the same films, under whatever they bear.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import gears
from base import Array, Integers, Stopwatch
from fem.contact.shared_contacts import yielding_over_face
from flankfilm.coupling.films import films
from flankfilm.coupling.films.along_path import gathered
from flankfilm.coupling.films.face_films import face_films
from flankfilm.coupling.films.film_table import FilmTable, film_table
from flankfilm.coupling.films.films import PathFilms, films_of
from flankfilm.coupling.films.line_contacts import line_contacts
from flankfilm.coupling.films.line_films import line_films
from flankfilm.coupling.films.lubricated_path import FilmRun
from flankfilm.coupling.films.lubricated_record import LubricatedCycle
from flankfilm.coupling.films.most_loaded import most_loaded
from flankfilm.coupling.mesh.cells import cells_of, has_cells, line_loads
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["lubricate_cells"]


def lubricate_cells(run: FilmRun, *, profiles: bool) -> LubricatedCycle:
    """Put films of all cells in series with the teeth; see `lubricate`.

    Films are functions of place and line load alone, so that a table of them is solved once and no rounds are needed:
    load share and films agree to the last digit of the table. The film along the path is solved at the most loaded cell
    of each contact, where it is smallest.
    """
    watch, pair, dry = Stopwatch(), run.teeth.pair, run.dry
    table = film_table(pair, dry, run.speed, run.lubricant, run.model, run.resolution.films)
    seconds = watch.seconds
    cycle = _in_series(run, table, f"{dry.label} with film")
    load = line_loads(cycle, pair.face_width)
    least = table.thickness("minimum_thickness", _places(cycle, load), load)
    watch, shown = Stopwatch(), _shown(cycle.position.size)
    path = _of_most_loaded(run, cycle)
    return LubricatedCycle(
        **MeshCycle.fields_of(cycle),
        least_film=_least(least),
        rounds=1,
        mismatch=0.0,
        dry=dry,
        film=gathered(run.model, path, pair, cycle, watch.seconds, shown.size if profiles else None),
        otherwise={},
        over_face=None if cycle.face is None else face_films(cycle, table, seconds),
        over_lines=None if cycle.lines is None else line_films(cycle, table, seconds),
    )


def _in_series(run: FilmRun, table: FilmTable, label: str) -> MeshCycle:
    """Mesh cycle with films in series, whose secant counts what they yield, and whose error what they err by."""
    teeth, dry = run.teeth, run.dry
    tolerance = min(run.resolution.sampling, run.resolution.transmission_error)
    cycle = teeth.with_films(dry.position.size, table, tolerance, table.varied())
    # in the section, as the deflection is counted
    force, yields = teeth.force * teeth.pair.helix.base_cosine, _yielding(table, cycle, teeth.pair)
    secant = force / (force / cycle.secant_stiffness + yields)
    changed = float(np.max(np.abs(secant / dry.secant_stiffness - 1.0)))
    unknown = 0.0 if table.error is None else table.error
    error = None if cycle.error is None else cycle.error + unknown * changed
    return replace(cycle, label=label, secant_stiffness=secant, error=error)


def _places(cycle: MeshCycle, load: Array) -> Array:
    """Places of all cells (positions, pairs, cells) [m]: each of lines of contact, others with their pair."""
    return cells_of(cycle).rho1 if has_cells(cycle) else np.broadcast_to(cycle.rho1[..., None], load.shape)


def _yielding(table: FilmTable, cycle: MeshCycle, pair: gears.GearPair) -> Array:
    """What films of all cells yield beyond the transmission error (positions,) [m]."""
    if cycle.lines is None:
        load = line_loads(cycle, pair.face_width)
        forces = load * pair.face_width / load.shape[-1]
        return yielding_over_face(table, cycle.rho1, forces, cycle.load_share)
    cells = cells_of(cycle)
    faces = np.divide(
        pair.face_width, cells.length, out=np.zeros(cells.length.shape), where=cells.length > 0.0
    )
    yields = yielding_over_face(table, cells.rho1, cells.force, cycle.load_share, faces, cells.part)
    return yields / pair.helix.base_cosine


def _least(thickness: Array) -> Array:
    """Smallest over the cells (positions, pairs); nan where none is known."""
    least = np.where(np.isfinite(thickness), thickness, np.inf).min(axis=-1)
    return np.where(np.isfinite(least), least, np.nan)


def _shown(positions: int) -> Integers:
    """Positions at which films are solved by themselves, at equal steps."""
    step = max(1, positions // films.FILM_POSITIONS)
    return np.arange(step // 2, positions, step)


def _of_most_loaded(run: FilmRun, cycle: MeshCycle) -> PathFilms:
    """Films of the most loaded cells, at some of the positions."""
    rho1, load = most_loaded(run.teeth.pair, cycle, _shown(cycle.position.size))
    contacts = line_contacts(run.teeth.pair, rho1, load, run.speed, run.lubricant)
    return films_of(run.model, rho1, contacts, None, run.resolution.films)
