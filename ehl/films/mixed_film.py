"""Films between rough surfaces, asperities beside them: the records."""

from __future__ import annotations

import math

from base import Cost, described, part, record
from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.films.film import Film, unsolved


@record
class RoughFilm:
    """What films between rough surfaces have, with heat or without: film and asperities carry the load together."""

    no_error = "not estimated; the film has one"

    contact: LineContact = part("the contact, with its whole load")
    roughness: Roughness = part("of both surfaces together")
    film: Film = part("film that carries the rest of the load")
    cost: Cost
    converged: bool
    message: str
    asperity_share: float = unsolved(
        "1", "share of the load that the asperities carry", shown="%", error="asperity_share_error"
    )
    asperity_stiffness: float = unsolved("N/m2", "stiffness of the asperities at the contact's width")
    separation_slope: float = unsolved(
        "m2/N", "derivative of the separation by the load at fixed speed, asperities included"
    )
    central_slope: float = unsolved(
        "m2/N", "derivative of the central thickness by the load at fixed speed, asperities included"
    )

    asperity_share_error: float = unsolved(
        "1", "error of the asperities' share, relative: as it answers to that of the central film"
    )

    @described("1")
    def error(self) -> float:
        """Estimated relative error of the film."""
        return self.film.error if self.converged else math.nan

    @described("m", shown="um", error="error")
    def central_thickness(self) -> float:
        """Mean gap at x = 0."""
        return self.film.central_thickness

    @described("m", shown="um", error="error")
    def plane_distance(self) -> float:
        """Distance of the mean planes at x = 0; negative where heights overlap by more than they leave open."""
        return self.roughness.planes(self.film.central_thickness)[0]

    @described("m", shown="um", error="error")
    def minimum_thickness(self) -> float:
        """Minimum mean gap."""
        return self.film.minimum_thickness

    @described("1", error="error")
    def film_ratio(self) -> float:
        """Lambda, minimum mean gap over the standard deviation of heights."""
        return self.film.minimum_thickness / self.roughness.deviation

    @described("m", shown="um")
    def separation(self) -> float:
        """Approach of the dry, smooth contact less that of the mean planes with film and asperities."""
        return self.film.separation + self.plane_distance - self.central_thickness

    @property
    def gap_slope(self) -> float:
        """Derivative of the mean gap by the distance of the mean planes at x = 0 [-]."""
        return 1.0 / self.roughness.planes(self.film.central_thickness)[1]

    @described("N/m", error="asperity_share_error")
    def asperity_load(self) -> float:
        """Load on the asperities per length of face."""
        return self.asperity_share * self.contact.load

    def film_stiffness(self, definition: str = "approach") -> float:
        """Stiffness of the film between the mean planes, at its own share of the load [N/m per m of face]."""
        return self.film.stiffness(definition) * self.gap_slope

    def stiffness(self, definition: str = "approach") -> float:
        """Film and asperities in parallel [N/m per m of face]: goes in series with the tooth.

        Parameters
        ----------
        definition : str
            As for :meth:`ehl.Film.stiffness`, of the film's part.
        """
        return self.film_stiffness(definition) + self.asperity_stiffness


@record
class MixedFilm(RoughFilm):
    """A film between rough surfaces. Figures are NaN when ``converged`` is False.

    ``film`` is that of the load and modulus that are left to it; its half-width is that of ``contact``.
    ``cost.counts["films"]`` counts the films solved.

    The stiffnesses are those of springs in parallel between the mean planes, at fixed speed and fixed width of the
    contact. A contact that asperities carry widens with the load, which makes it stiffer again by up to two:
    ``separation_slope`` (of the mean planes) and ``central_slope`` (of the mean gap) are the derivatives with all of
    that, -1/separation_slope the whole stiffness.
    """

    headline = ("central_thickness", "minimum_thickness", "film_ratio", "asperity_share")
