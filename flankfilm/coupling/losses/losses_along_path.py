"""Friction, losses and temperatures at the loaded contacts of a mesh cycle, in the order of the path."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import ehl
import gears
from base import Array, described, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.losses.heated_films import HeatedFilms
from flankfilm.coupling.mesh.extreme_errors import of_greatest, of_least, of_sampled_greatest
from gears.pair.hertz import HERTZ

_CLOSED_FORM = "unknown: a closed form"


@record
class LossesAlongPath:
    """Friction, losses and temperatures at the loaded contacts of a mesh cycle, in the order of the path.

    Powers are those of a single contact over the whole face. Where the load varies along it, loads, friction,
    temperatures and films are those of the most loaded cell.
    """

    no_error = "not estimated in single places; films have an error, and so have friction and temperatures"
    headline = ("least_film", "greatest_pressure_times_sliding", "greatest_contact_temperature")

    rho1: Array = quantity("m", "curvature radius of the pinion's flank at the contact", "point", shown="mm")
    load: Array = quantity("N/m", "force per length of face", "point", shown="N/mm", no_error=HERTZ)
    hertz_pressure: Array = quantity(
        "Pa", "Hertz pressure, the largest of the dry contact", "point", shown="GPa", no_error=HERTZ
    )
    sliding_speed: Array = quantity(
        "m/s", "sliding speed u1 - u2, negative before C", "point", no_error=EXACT
    )
    entrainment: Array = quantity("m/s", "entrainment speed, the mean (u1 + u2)/2", "point", no_error=EXACT)
    friction_coefficient: Array = quantity(
        "1", "coefficient of friction of film and asperities", "point", error="friction_error"
    )
    shear_stress: Array = quantity(
        "Pa",
        "friction over the Hertz width, as the pinion feels it",
        "point",
        shown="MPa",
        error="friction_error",
    )
    rolling_friction: Array = quantity(
        "N/m", "force by which the oil's pressure resists rolling on either flank", "point", shown="N/mm"
    )
    sliding_loss: Array = quantity("W", "power lost by sliding", "point", error="friction_error")
    rolling_loss: Array = quantity("W", "power lost by the oil's flow under its pressure", "point")
    oil_temperature_rise: Array = quantity(
        "K", "highest oil temperature above the mean of the flanks' bulk", "point", error="temperature_error"
    )
    surface_temperature_rise: Array = quantity(
        "K",
        "maximum temperature of pinion's and wheel's flank above its bulk",
        "gear point",
        no_error="that of the oil's rise at the same contact, temperature_error, holds for both",
    )
    contact_temperature: Array = quantity(
        "K", "maximum temperature of the flanks", "point", error="contact_temperature_error"
    )
    flash_temperature: Array = quantity(
        "K", "flash temperature after Blok beside it", "point", no_error=_CLOSED_FORM
    )
    minimum_thickness: Array = quantity("m", "minimum film", "point", shown="um", error="film_error")
    film_ratio: Array | None = quantity(
        "1", "film ratio Lambda, minimum film over sigma; None of smooth flanks", "point", error="film_error"
    )
    asperity_share: Array | None = quantity(
        "1", "asperities' share of the load; None of smooth flanks", "point", error="asperity_share_error"
    )
    asperity_share_error: Array | None = quantity(
        "1", "estimated relative error of the asperities' share; None of smooth flanks", "point"
    )
    closure: Array = quantity("1", "heat that arrives over heat that is made, less 1", "point")
    friction_error: Array = quantity("1", "estimated relative error of friction, by the grid", "point")
    temperature_error: Array = quantity(
        "1", "estimated relative error of the oil's rise, by the grid", "point"
    )
    film_error: Array = quantity("1", "estimated relative error of the film", "point")

    @described("Pa m/s", "point", no_error=HERTZ)
    def pressure_times_sliding(self) -> Array:
        """Hertz pressure times sliding speed, p v."""
        return np.asarray(self.hertz_pressure * np.abs(self.sliding_speed))

    @described("Pa m/s", error="greatest_pressure_times_sliding_error")
    def greatest_pressure_times_sliding(self) -> float:
        """Maximum Hertz pressure times sliding speed of the contacts."""
        return float(self.pressure_times_sliding.max())

    @property
    def greatest_pressure_times_sliding_error(self) -> float:
        """Relative error of that maximum by the steps between the contacts, that of their load share left out."""
        return of_sampled_greatest(self.pressure_times_sliding)

    @described("1", "point", no_error=ITSELF)
    def contact_temperature_error(self) -> Array:
        """Estimated relative error of the flanks' maximum temperature [K], as their rise errs."""
        rise = self.surface_temperature_rise.max(axis=0)
        return np.asarray(self.temperature_error * rise / self.contact_temperature)

    @described("m", shown="um", error="least_film_error")
    def least_film(self) -> float:
        """Minimum film of the contacts."""
        return float(self.minimum_thickness.min())

    @property
    def least_film_error(self) -> float:
        """Relative error of the minimum film and of the minimum film ratio."""
        return of_least(self.minimum_thickness, self.film_error)

    @described("1", error="least_film_error")
    def least_film_ratio(self) -> float | None:
        """Minimum film ratio Lambda of the contacts; None of smooth flanks."""
        return None if self.film_ratio is None else float(self.film_ratio.min())

    @described("K", error="greatest_oil_rise_error")
    def greatest_oil_rise(self) -> float:
        """Maximum oil temperature of the contacts above the mean of the flanks' bulk."""
        return float(self.oil_temperature_rise.max())

    @property
    def greatest_oil_rise_error(self) -> float:
        """Relative error of the maximum rise of the oil."""
        return of_greatest(self.oil_temperature_rise, self.temperature_error)

    @described("K", "gear", error="greatest_flank_rise_error")
    def greatest_flank_rise(self) -> Array:
        """Maximum rise of pinion's and wheel's flank above its bulk."""
        return np.asarray(self.surface_temperature_rise.max(axis=1))

    @described("1", "gear", no_error=ITSELF)
    def greatest_flank_rise_error(self) -> Array:
        """Relative error of the maximum rise of pinion's and wheel's flank."""
        return np.array([of_greatest(rise, self.temperature_error) for rise in self.surface_temperature_rise])

    @described("K", error="greatest_contact_temperature_error")
    def greatest_contact_temperature(self) -> float:
        """Maximum temperature of the flanks at the contacts."""
        return float(self.contact_temperature.max())

    @property
    def greatest_contact_temperature_error(self) -> float:
        """Relative error of the flanks' maximum temperature [K], that of their bulk left out."""
        return of_greatest(self.contact_temperature, self.contact_temperature_error)


def losses_along(pair: gears.GearPair, heated: HeatedFilms, bulk: tuple[float, float]) -> LossesAlongPath:
    """Read friction, losses and temperatures off heated films.

    Parameters
    ----------
    pair : gears.GearPair
    heated : HeatedFilms
    bulk : (float, float)
        Temperatures of pinion and wheel [K].
    """
    films, contacts, width = heated.films, heated.contacts, pair.face_width
    friction = heated.friction
    half_width = _each(contacts, "half_width")
    load, sliding = _each(contacts, "load"), _each(contacts, "sliding")
    rises = np.array([_surface_rises(film, bulk) for film in films]).T
    return LossesAlongPath(
        rho1=heated.rho1,
        load=load,
        hertz_pressure=_each(contacts, "peak_pressure"),
        sliding_speed=sliding,
        entrainment=_each(contacts, "entrainment"),
        friction_coefficient=friction,
        shear_stress=np.sign(sliding) * friction * load / (2.0 * half_width),
        rolling_friction=_each(films, "rolling_friction"),
        sliding_loss=width * friction * load * np.abs(sliding),
        rolling_loss=width * heated.rolling,
        oil_temperature_rise=_each(films, "oil_temperature_rise"),
        surface_temperature_rise=rises,
        contact_temperature=np.max(rises + np.array(bulk)[:, None], axis=0),
        flash_temperature=np.array(
            [
                ehl.blok_flash_temperature(contact, mu, heated.solids)
                for contact, mu in zip(contacts, friction.tolist(), strict=True)
            ]
        ),
        minimum_thickness=heated.minimum_thickness,
        film_ratio=heated.film_ratio,
        asperity_share=heated.asperity_share if heated.rough else None,
        asperity_share_error=heated.asperity_share_error if heated.rough else None,
        closure=np.array([film.losses.closure for film in films if film.losses is not None]),
        friction_error=heated.friction_error,
        temperature_error=_each(films, "temperature_error"),
        film_error=_each(films, "error"),
    )


def _surface_rises(film: ehl.ThermalFilm, bulk: tuple[float, float]) -> tuple[float, float]:
    """Maximum rise of both surfaces above their bulk [K]."""
    assert film.temperature is not None
    return float(film.temperature[:, 0].max() - bulk[0]), float(film.temperature[:, -1].max() - bulk[1])


def _each(records: Sequence[object], figure: str) -> Array:
    """A figure of every record."""
    return np.array([getattr(one, figure) for one in records])
