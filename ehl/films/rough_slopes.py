"""How a film between rough surfaces answers to its load, of which asperities carry a share."""

from __future__ import annotations

from typing import NamedTuple

from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.films.film import Film
from ehl.solving.load_share import excess, share_of
from ehl.solving.response import Response


class RoughSlopes(NamedTuple):
    """Answers to the load; those of a film alone where asperities carry nothing."""

    asperity_stiffness: float  # at the contact's width [N/m2]
    separation: float  # derivatives by the load [m2/N]
    central: float


def rough_slopes(
    contact: LineContact, roughness: Roughness, film: Film, odds: float, by_part: Response | None
) -> RoughSlopes:
    """Stiffness of the asperities at the contact's width, and derivatives of separation and central film by the load.

    The excess of what asperities carry stays 0 as film, share and load change: that gives the odds by the load.

    Parameters
    ----------
    contact : LineContact
        With the whole load.
    roughness : Roughness
        Of both surfaces.
    film : Film
        Under what the asperities leave to it, with its derivatives by its load.
    odds : float
        ln[s/(1-s)] of the asperities' share s.
    by_part : Response or None
        Derivatives of the film by ln of the part 1 - s that is left to it; None where it carries all.
    """
    share, gap = share_of(odds), film.central_thickness
    if by_part is None or share == 0.0:
        return RoughSlopes(0.0, film.separation_slope, film.central_slope)
    by = by_part.scaled(-share)  # ln(1 - s) falls by s
    pressure, slope = roughness.under_film(gap, contact.reduced_modulus, contact.peak_pressure)
    closer = roughness.planes(gap)[1]  # planes by gap
    stiffness = -share * contact.load * slope / pressure / closer
    at = excess(contact, roughness, gap, odds)
    film_share = share_of(-odds)
    separation_w, central_w = film_share * film.separation_slope, film_share * film.central_slope
    follow = -(at.by_load / contact.load + at.by_gap * central_w)
    follow /= at.by_gap * by.central + at.by_odds
    central = central_w + by.central * follow
    return RoughSlopes(stiffness, separation_w + by.separation * follow + (closer - 1.0) * central, central)
