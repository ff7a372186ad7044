"""The oil film over the face: films of all cells in series with the teeth, in the active set over pairs and cells."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import ehl
from base import Array, Stopwatch
from fem.contact.shared_contacts import yielding_over_face
from flankfilm.coupling.along_path import FilmAlongPath, gathered
from flankfilm.coupling.cells import cells_of
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.face_films import face_films
from flankfilm.coupling.film_table import film_table
from flankfilm.coupling.films import FilmModel, contacts_of, films_of
from flankfilm.coupling.lubricated_record import LubricatedCycle

if TYPE_CHECKING:
    from flankfilm.coupling.loaded_teeth import LoadedTeeth
    from flankfilm.coupling.resolution import Resolution

__all__ = ["lubricate_face"]

SHOWN = 40
"""Positions of a base pitch at which the film of the most loaded cell is solved by itself."""


def lubricate_face(
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
    watch = Stopwatch()
    table = film_table(teeth.pair, dry, speed, lubricant, model, resolution.films)
    seconds = watch.seconds
    tolerance = min(resolution.sampling, resolution.transmission_error)
    cycle = teeth.cycle(dry.position.size, table, tolerance, table.varied())
    face = cycle.face
    assert face is not None
    forces = face.line_load * teeth.pair.face_width / face.line_load.shape[-1]
    yields = yielding_over_face(table, cycle.rho1, forces, cycle.load_share)
    secant = teeth.force / (teeth.force / cycle.secant_stiffness + yields)
    over = face_films(cycle, table, seconds)
    unknown = 0.0 if over.error is None else over.error
    changed = float(np.max(np.abs(secant / dry.secant_stiffness - 1.0)))
    return LubricatedCycle(
        **{
            **MeshCycle.fields_of(cycle),
            "label": f"{dry.label} with film",
            "secant_stiffness": secant,
            "error": None if cycle.error is None else cycle.error + unknown * changed,
        },
        least_film=_least(over.minimum_thickness),
        rounds=1,
        mismatch=0.0,
        dry=dry,
        film=_along_path(teeth, cycle, speed, lubricant, resolution, model, profiles=profiles),
        otherwise={},
        over_face=over,
    )


def _least(thickness: Array) -> Array:
    """Smallest over the cells (positions, pairs); nan where none is known."""
    least = np.where(np.isfinite(thickness), thickness, np.inf).min(axis=-1)
    return np.where(np.isfinite(least), least, np.nan)


def _along_path(
    teeth: LoadedTeeth,
    cycle: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    resolution: Resolution,
    model: FilmModel,
    *,
    profiles: bool,
) -> FilmAlongPath:
    """Films of the most loaded cells at some of the positions."""
    watch, step = Stopwatch(), max(1, cycle.position.size // SHOWN)
    kept = slice(step // 2, None, step)
    few = replace(
        cycle,
        rho1=cycle.rho1[kept],
        forces=cycle.forces[kept],
        load_share=cycle.load_share[kept],
        contact=None,
    )
    greatest = cells_of(cycle).greatest[kept]
    rho1, contacts = contacts_of(teeth.pair, few, speed, lubricant, greatest)
    path = films_of(model, rho1, contacts, None, resolution.films)
    positions = greatest.shape[0] if profiles else None
    return gathered(model, path, teeth.pair, cycle, watch.seconds, positions)
