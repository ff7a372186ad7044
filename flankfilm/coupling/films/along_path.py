"""Films at the loaded contacts of a mesh cycle, gathered in the order of the path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

import ehl
import gears
from base import Array, Cost, described, part, quantity, record
from flankfilm.coupling.films import film_points
from flankfilm.coupling.films.films import FilmModel, PathFilms, film_inside
from flankfilm.coupling.films.least_film import least_of, least_sampled
from flankfilm.coupling.mesh.extreme_errors import of_greatest, of_sampled_greatest
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from gears.pair.hertz import HERTZ

FORMULA = "unknown: Dowson's formula"


@record
class FilmAlongPath:
    """Film at the loaded contacts of a mesh cycle, in the order of the path, at the loads that they carry with it.

    What only solved, starved or mixed films have is None for others. ``error`` is the largest of the films'
    thicknesses, None by formula.
    """

    headline = ("model", "supply", "least_film", "greatest_pressure")

    model: str = quantity("", "model of the film")
    supply: str = quantity("", "what is held at the inlet")
    rho1: Array = quantity("m", "curvature radius of the pinion's flank at the film", "point", shown="mm")
    load: Array = quantity("N/m", "force per length of face", "point", shown="N/mm", no_error=HERTZ)
    central_thickness: Array = quantity(
        "m", "central film, on the line of centres", "point", shown="um", error="error"
    )
    minimum_thickness: Array = quantity("m", "minimum film", "point", shown="um", error="error")
    hertz_pressure: Array = quantity(
        "Pa", "Hertz pressure, the largest of the dry contact", "point", shown="GPa", no_error=HERTZ
    )
    stiffness: Mapping[str, Array] = quantity("N/m", "film stiffness of the whole face", "point")
    inlet: Array | None = quantity(
        "1", "where oil fills the gap, in half-widths ahead of the middle", "point"
    )
    oil_layer: Array | None = quantity(
        "m", "layer of oil at ambient pressure that passes the contact", "point", shown="um"
    )
    starvation: Array | None = quantity(
        "1",
        "central film over that of the smooth flooded contact",
        "point",
        no_error="not estimated: the ratio of two films that each have an error",
    )
    film_ratio: Array | None = quantity("1", "film ratio Lambda, minimum mean gap over sigma", "point")
    asperity_share: Array | None = quantity(
        "1", "asperities' share of the load", "point", error="asperity_share_error"
    )
    asperity_share_error: Array | None = quantity(
        "1", "estimated relative error of the asperities' share", "point"
    )
    at_pitch: tuple[ehl.StiffnessRow, ...] = part(
        "film stiffness by every definition at the contact nearest to C, in series with the stiffness of its teeth; "
        "none of helical pairs, whose lines of contact cross C"
    )
    profiles: Mapping[str, ehl.Film] = part("whole films at points of the path by label, for pictures")
    error: float | None
    cost: Cost
    on_lines: bool = part(
        "whether films are those of the most loaded cells of lines of contact that come by", default=False
    )
    converged: bool = True
    message: str = ""

    @property
    def no_error(self) -> str:
        """Why figures that say nothing of their error have none."""
        return FORMULA if self.error is None else "not estimated; the films themselves have an error"

    @described("m", shown="um", error="least_film_error")
    def least_film(self) -> float:
        """Minimum film along the path, between the films as well."""
        return self._least[0]

    @property
    def least_film_error(self) -> float | None:
        """Relative error of the minimum film and film ratio: of the films and of their steps; None by formula."""
        value, off = self._least
        return None if self.error is None else float(np.hypot(self.error, off / value))

    @described("1", error="least_film_error")
    def least_film_ratio(self) -> float | None:
        """Minimum film ratio Lambda along the path, between the films as well; None for smooth flanks."""
        return None if self.film_ratio is None else self._least_of(self.film_ratio)[0]

    @cached_property
    def _least(self) -> tuple[float, float]:
        return self._least_of(self.minimum_thickness)

    def _least_of(self, film: Array) -> tuple[float, float]:
        """Minimum of films, or of film ratios, and how far it may be off by their places."""
        return least_sampled(film) if self.on_lines else least_of(film, self.load)

    @described("Pa", shown="GPa", error="greatest_pressure_error")
    def greatest_pressure(self) -> float:
        """Largest Hertz pressure along the path."""
        return float(self.hertz_pressure.max())

    @property
    def greatest_pressure_error(self) -> float:
        """Relative error of the largest Hertz pressure by the steps between the contacts.

        Contacts of a single pair bear the whole force; where the largest is one of several, that of their load share
        comes in addition.
        """
        return of_sampled_greatest(self.hertz_pressure)

    @property
    def greatest_asperity_share_error(self) -> float | None:
        """Relative error of the largest asperities' share of the load; None of smooth flanks."""
        if self.asperity_share is None or self.asperity_share_error is None:
            return None
        return of_greatest(self.asperity_share, self.asperity_share_error)


def gathered(
    model: FilmModel,
    path: PathFilms,
    pair: gears.GearPair,
    dry: MeshCycle,
    seconds: float,
    positions: int | None,
) -> FilmAlongPath:
    """Gather films along the path.

    Parameters
    ----------
    model : FilmModel
    path : PathFilms
    pair : gears.GearPair
    dry : MeshCycle
        Of the same pair.
    seconds : float
        Cost of the films [s].
    positions : int or None
        Positions of a base pitch at which there are films, for the whole films at points; None leaves these out.
    """
    films, solved, rough = path.films, model.name == "ehl", model.roughness is not None
    inside = [film_inside(film) for film in films] if solved else []
    central = _each(films, "central_thickness")
    return FilmAlongPath(
        model=model.name,
        supply=model.held,
        rho1=path.rho1,
        load=np.array([film.contact.load for film in films]),
        central_thickness=central,
        minimum_thickness=_each(films, "minimum_thickness"),
        hertz_pressure=np.array([film.contact.peak_pressure for film in films]),
        stiffness={
            name: np.array([pair.face_width * film.stiffness(name) for film in films])
            for name in film_points.definitions(model.name)
        },
        inlet=np.array([film.inlet / film.contact.half_width for film in inside]) if solved else None,
        oil_layer=_each(inside, "flow") if solved else None,
        starvation=central / _each(path.flooded, "central_thickness") if path.flooded else None,
        film_ratio=_each(films, "film_ratio") if rough else None,
        asperity_share=_each(films, "asperity_share") if rough else None,
        asperity_share_error=_each(films, "asperity_share_error") if rough else None,
        at_pitch=film_points.stiffness_rows(pair, dry, path) if solved and not pair.helix_angle else (),
        profiles=film_points.profiles(pair, path, positions, model.grid) if solved and positions else {},
        error=max(film.error for film in films) if solved else None,
        on_lines=dry.lines is not None,
        cost=Cost(seconds, max((film.cost.unknowns for film in inside), default=0)),
    )


def _each(films: Sequence[object], figure: str) -> Array:
    """A figure of every film."""
    return np.array([getattr(film, figure) for film in films])
