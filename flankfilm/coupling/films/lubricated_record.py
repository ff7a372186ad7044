"""Mesh cycle with the film in series: the record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, replace
from typing import Self

import numpy as np

from base import Array, described, part, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.films.along_path import FORMULA, FilmAlongPath
from flankfilm.coupling.films.face_films import FaceFilms
from flankfilm.coupling.films.line_films import LineFilms
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

DIFFERENCE = "not estimated: the difference of two means that have errors"


@record
class LubricatedCycle(MeshCycle):
    """Mesh cycle with the film in series in each pair, in agreement with the load share.

    For starved films ``otherwise`` holds the mesh with the flooded film, and with the same starved films where what is
    held at the inlet is the other of meniscus and layer, each at the forces of the films found.

    Where the load varies along the face, `film` is that of the most loaded cell of each contact, its stiffness that of
    a face which bears so much everywhere.
    """

    headline = ("mean_secant_stiffness", "mean_stiffness", "thinnest_film")

    _: KW_ONLY
    least_film: Array = quantity(
        "m",
        "minimum film of each pair; nan where unloaded",
        "position pair",
        shown="um",
        no_error="not estimated in single positions; thinnest_film has one where films are solved",
    )
    rounds: int = quantity("1", "times that films and load share were brought into agreement", no_error=EXACT)
    mismatch: float = quantity("1", "last change of a pair's force over the whole force", no_error=ITSELF)
    dry: MeshCycle = part("the cycle without film")
    film: FilmAlongPath = part("film along the path, with a separate error")
    otherwise: Mapping[str, MeshCycle] = part(
        "the mesh with other films, by name; empty unless films are starved"
    )
    over_face: FaceFilms | None = part(
        "films over the face; None where the load is even along it", default=None
    )
    over_lines: LineFilms | None = part("films on lines of contact; None of spur pairs", default=None)

    def against(self, reference: str, bore_inertia: tuple[float, float] = (0.0, 0.0)) -> Self:
        """Measure the deflections of this cycle, of the dry one and of those with other films against something else.

        See `MeshCycle.against`.
        """
        measured = super().against(reference, bore_inertia)
        others = {name: cycle.against(reference, bore_inertia) for name, cycle in self.otherwise.items()}
        return replace(measured, dry=self.dry.against(reference, bore_inertia), otherwise=others)

    @property
    def film_compliance(self) -> Array:
        """What films yield by the mean load beyond dry teeth, over that load (positions,) [m/N]."""
        teeth = np.interp(self.position, self.dry.position, 1.0 / self.dry.secant_stiffness, period=1.0)
        return np.asarray(1.0 / self.secant_stiffness - teeth)

    @described("m", shown="um", error="thinnest_film_error", no_error=FORMULA)
    def thinnest_film(self) -> float:
        """Minimum film of all pairs along the path."""
        return self.film.least_film

    @property
    def thinnest_film_error(self) -> float | None:
        """Relative error of the minimum film; None by formula."""
        return self.film.least_film_error

    @described("1", shown="%", no_error=DIFFERENCE)
    def secant_stiffness_change(self) -> float:
        """What the film changes the mean secant stiffness by, relative."""
        return self.mean_secant_stiffness / self.dry.mean_secant_stiffness - 1

    @described("1", shown="%", no_error=DIFFERENCE, called="tangent_stiffness_change")
    def stiffness_change(self) -> float:
        """What the film changes the mean tangent stiffness by, relative."""
        return self.mean_stiffness / self.dry.mean_stiffness - 1
