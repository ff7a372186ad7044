"""Temperature, friction and film of the flanks by our own films, beside the scuffing methods of ISO/TR 13989."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import gears.rating
from base import described, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    from flankfilm.coupling.films.lubricated_record import LubricatedCycle
    from flankfilm.coupling.losses.losses_record import MeshLosses
    from gears.rating import Rating

MOST_SHARE = 1.3
"""Share of a pair up to which the flash temperature of the standard is formed."""


@record
class OwnContact:
    """Flanks by our own films at the nominal torque; None where the run has no such film."""

    headline = ("contact_temperature", "friction", "least_film", "film_ratio")

    bulk_temperatures: tuple[float, float] | None = quantity(
        "K", "bulk temperatures of the flanks; None without losses", "gear", error="bulk_error"
    )
    flash: float | None = quantity(
        "K", "maximum rise of a flank above its bulk; None without losses", error="flash_error"
    )
    contact_temperature: float | None = quantity(
        "K", "maximum temperature of the flanks; None without losses", error="temperature_error"
    )
    friction: float | None = quantity(
        "1", "mean coefficient of friction; None without losses", error="friction_error"
    )
    least_film: float | None = quantity("m", "minimum film along the path", shown="um", error="film_error")
    roughness: float = quantity("m", "Ra, the mean of both flanks", shown="um", no_error=EXACT)
    theta_B: float | None = quantity(
        "K",
        "maximum contact temperature by the factors of ISO/TR 13989-1, bulk theta_M and the shares of our loaded "
        "contact; None without scuffing or of helical pairs",
        no_error=STANDARD,
    )
    bulk_error: float | None = quantity("1", "estimated relative error of the bulk temperatures")
    flash_error: float | None = quantity("1", "estimated relative error of that rise")
    temperature_error: float | None = quantity("1", "estimated relative error of the maximum temperature")
    friction_error: float | None = quantity("1", "estimated relative error of the mean friction")
    film_error: float | None = quantity("1", "estimated relative error of the minimum film")

    @described("1", error="film_error")
    def film_ratio(self) -> float | None:
        """Minimum film over Ra."""
        return None if self.least_film is None else self.least_film / self.roughness

    @property
    def error(self) -> float | None:
        """Relative error of the minimum film and of the film ratio."""
        return self.film_error


def own_contact(
    rating: Rating,
    roughness: float,
    *,
    losses: MeshLosses | None = None,
    film: LubricatedCycle | None = None,
) -> OwnContact:
    """Put temperature, friction and film by our own films beside a rating of scuffing.

    Ours is at the nominal torque, without K_A, K_v and the load factors, which are all in the standard's line load.
    The standard's theta_B has that line load with the share of each pair by our loaded contact.

    Parameters
    ----------
    rating : Rating
    roughness : float
        Ra, the mean of both flanks [m].
    losses : MeshLosses, optional
        Films with heat along the path.
    film : LubricatedCycle, optional
        Films without; where there are losses theirs count.

    References
    ----------
    ISO/TR 13989-1:2000; ISO/TS 6336-22 for the film ratio, film over Ra. Its film h_Y is left out: no source confirms
    its constants here.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from gears.rating import RatedSteel, RatingData, rate
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> data = RatingData(6, (RatedSteel("Eh", 1500e6, 430e6),) * 2, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6))
    >>> found = own_contact(rate(pair, 300.0, 209.44, data), 0.8e-6)
    >>> found.film_ratio is None  # neither losses nor films were given
    True
    """
    if losses is None:
        least, off = (None, None) if film is None else (film.film.least_film, film.film.least_film_error)
        return OwnContact(None, None, None, None, least, roughness, None, None, None, None, None, off)
    path, bulk = losses.path, losses.bulk_temperatures
    rises, errors = path.greatest_flank_rise, path.greatest_flank_rise_error
    hotter = int(np.argmax(rises))
    return OwnContact(
        (float(bulk[0]), float(bulk[1])),
        float(rises[hotter]),
        path.greatest_contact_temperature,
        losses.mean_friction,
        path.least_film,
        roughness,
        standard_temperature(rating, losses),
        float(np.max(losses.bulk_temperatures_error)),
        float(errors[hotter]),
        path.greatest_contact_temperature_error,
        losses.error,
        path.least_film_error,
    )


def standard_temperature(rating: Rating, losses: MeshLosses) -> float | None:
    """Maximum contact temperature theta_B of the standard with the shares of a loaded contact; None without scuffing.

    Parameters
    ----------
    rating : Rating
    losses : MeshLosses
        Its dry cycle has the shares.
    """
    scuffing, cycle, contact = rating.scuffing, losses.cycle, losses.cycle.contact
    if scuffing is None or contact is None or contact.pair.helix_angle != 0.0:
        return None
    points = contact.pair.points
    with np.errstate(invalid="ignore"):
        inside = (cycle.rho1 >= points.A) & (cycle.rho1 <= points.E)
    return gears.rating.flash_temperature(
        contact.pair,
        scuffing.w_Bt * scuffing.K_Bgamma,
        rating.speed,
        friction=scuffing.mu,
        temperature=scuffing.theta_M,
        rho1=cycle.rho1[inside],
        share=np.minimum(cycle.load_share[inside], MOST_SHARE),
    ).theta_Bmax
