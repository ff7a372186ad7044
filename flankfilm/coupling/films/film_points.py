"""Films at chosen points of the path: stiffness by every definition at C, whole films for pictures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

import ehl
import gears
from flankfilm.coupling.films.films import PathFilms, film_inside
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

SPIKE = 0.01
"""Wanted relative error of the pressure spike in pictures."""

_NARROW = 30.0
"""alpha p_H beyond which no spike is sought: at 29 it is 5e-6 half-widths wide, and narrows fast from there."""


def definitions(model: str) -> tuple[str, ...]:
    """Definitions of film stiffness that a film model has."""
    return ehl.DEFINITIONS if model == "ehl" else ("dowson-central", "dowson-minimum")


def stiffness_rows(pair: gears.GearPair, dry: MeshCycle, path: PathFilms) -> tuple[ehl.StiffnessRow, ...]:
    """Every definition of the film's stiffness at the contact nearest to C, and what it costs its pair of teeth.

    The teeth's stiffness is the dry mesh's tangent with a pair nearest to C, times that pair's share of the
    force: all of it where one pair carries the load there.
    """
    distance = np.where(dry.load_share > 0.0, np.abs(dry.rho1 - pair.points.C), np.inf)
    position, column = np.unravel_index(int(np.nanargmin(distance)), distance.shape)
    bodies = float(dry.stiffness[position] * dry.load_share[position, column])
    film = path.films[int(np.argmin(np.abs(path.rho1 - pair.points.C)))]
    table = ehl.stiffness_table(film_inside(film), pair.face_width, bodies)
    return (
        _with_asperities(film, table, pair.face_width, bodies) if isinstance(film, ehl.MixedFilm) else table
    )


def _with_asperities(
    film: ehl.MixedFilm, table: tuple[ehl.StiffnessRow, ...], face_width: float, bodies: float
) -> tuple[ehl.StiffnessRow, ...]:
    """Put the asperities parallel to each film, and the whole derivative below."""
    parallel = face_width * film.asperity_stiffness
    between = [film.gap_slope * row.stiffness + parallel for row in table]  # mean planes
    rows = [
        replace(
            row,
            meaning=f"{row.meaning}; asperities in parallel",
            stiffness=stiffness,
            loss=bodies / (bodies + stiffness),
        )
        for row, stiffness in zip(table, between, strict=True)
    ]
    whole = -face_width / film.separation_slope
    meaning = "-1/(ds/dw) of film and asperities, the contact widening with the load"
    rows.append(replace(table[0], definition="whole", meaning=meaning, stiffness=whole, error=math.nan,
                        loss=bodies / (bodies + whole)))  # fmt: skip
    return tuple(rows)


def profiles(pair: gears.GearPair, path: PathFilms, positions: int, grid: str) -> dict[str, ehl.Film]:
    """Films nearest to A, C and E, and to B and D on their single-pair side, with the pressure spike resolved.

    The tolerance asks for thicknesses, which a grid too coarse for the spike meets.
    """
    points, step = pair.points, pair.base_pitch / positions
    wanted = {
        "near A": points.A,
        "after B": points.B + step,
        "C": points.C,
        "before D": points.D - step,
        "near E": points.E,
    }
    nearest = {name: int(np.argmin(np.abs(path.rho1 - rho))) for name, rho in wanted.items()}
    inside = {name: film_inside(path.films[i]) for name, i in nearest.items()}
    fine = inside if grid == "article" else _fine(inside)
    return {name: replace(film, state=None) for name, film in fine.items() if film.converged}


def _fine(films: dict[str, ehl.Film]) -> dict[str, ehl.Film]:
    """Solve films again for pictures, the lightest load first.

    Spikes narrow with the pressure: after one that grids do not resolve, which takes seconds to find out,
    those of heavier contacts are left alone. Without its spike a film is as good as the one along the path.
    """
    sharpened = {name: replace(film, spike=None) for name, film in films.items()}
    for name in sorted(films, key=lambda name: films[name].contact.peak_pressure):
        contact, supply = films[name].contact, films[name].supply
        if contact.lubricant.pressure_viscosity * contact.peak_pressure > _NARROW:
            break
        sharp = ehl.solve(contact, spike=SPIKE, supply=supply)
        if not sharp.converged:
            break
        sharpened[name] = sharp
    return sharpened
