"""Mixed lubrication: film and asperities share the load.

Johnson, Greenwood and Poon's load sharing: asperities and film carry the shares s and 1 - s of the load at every
point alike. The bodies then deform under the film's pressure as a contact of load w (1 - s) and modulus
E' (1 - s) would: the half-width stays. The film of that contact gives the separation, the asperities their
pressure at it, and s is where that pressure is what the share asks for at the middle of the contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from base import Faults
from ehl.asperities import Roughness
from ehl.contact import LineContact
from ehl.film import Film
from ehl.solver import solve
from ehl.supply import Supply

__all__ = ["MixedFilm", "central_asperity_pressure", "solve_mixed"]

_LEAST_SHARE = 1e-10
_LEAST_FILM_SHARE = 1e-6
_ODDS_STEP = 0.02


@dataclass(frozen=True)
class MixedFilm:
    """A film between rough surfaces. Figures are NaN when ``converged`` is False.

    The stiffnesses are those of springs in parallel, at fixed speed and fixed width of the contact. A contact that
    asperities carry widens with the load, which makes it stiffer again by up to two: ``separation_slope`` and
    ``central_slope`` are the derivatives with all of that, -1/slope the whole stiffness.
    """

    contact: LineContact
    roughness: Roughness
    film: Film  # of the load and modulus that are left to the film; its half-width is that of `contact`
    asperity_share: float  # s, share of the load that the asperities carry [-]
    asperity_stiffness: float  # -dw_a/dh of the asperities at the contact's width [N/m per m of face]
    separation_slope: float  # d separation/d load of film and asperities together at fixed speed [m per N/m]
    central_slope: float  # d h_cen/d load likewise [m per N/m]
    error: float  # estimated relative error of the film
    rounds: int  # films solved
    converged: bool
    message: str

    @property
    def central_thickness(self) -> float:
        """Distance of the mean planes at x = 0 [m]."""
        return self.film.central_thickness

    @property
    def minimum_thickness(self) -> float:
        """Least distance of the mean planes [m]."""
        return self.film.minimum_thickness

    @property
    def film_ratio(self) -> float:
        """Lambda = h_min/sigma [-]."""
        return self.film.minimum_thickness / self.roughness.deviation

    @property
    def asperity_load(self) -> float:
        """Load on the asperities [N/m]."""
        return self.asperity_share * self.contact.load

    @property
    def separation(self) -> float:
        """Approach of the dry contact less that of film and asperities together [m]."""
        return self.film.separation

    def film_stiffness(self, definition: str = "approach") -> float:
        """Stiffness of the film at its own share of the load [N/m per m of face]."""
        return self.film.stiffness(definition)

    def stiffness(self, definition: str = "approach") -> float:
        """Film and asperities in parallel [N/m per m of face]: goes in series with the tooth.

        Parameters
        ----------
        definition : str
            As for :meth:`ehl.Film.stiffness`, of the film's part.
        """
        return self.film.stiffness(definition) + self.asperity_stiffness


def central_asperity_pressure(contact: LineContact, roughness: Roughness, share: float) -> float:
    """Pressure on the asperities at the middle of a rough line contact [Pa], by Gelinck and Schipper's fit.

    ``p_c = s p_H [1 + (1.558 (n/s R^1.5 beta^0.5)^0.0337 (sigma/R)^-0.442 W^0.4757)^-1.70]^(-1/1.70)``, s the
    asperities' share of the load: the Hertz pressure of the share, lowered by the spread of a rough contact.

    References
    ----------
    E. R. M. Gelinck and D. J. Schipper, Calculation of Stribeck curves for line contacts, Tribology
    International 33 (2000) 175-181. The constants were taken from a secondary source; the bracket is within
    some per cent of one for hard contacts, which limits what an error in them can do.
    """
    R, sigma = contact.radius, roughness.deviation
    asperities = roughness.density / share * R**1.5 * math.sqrt(roughness.tip_radius)
    spread = 1.558 * asperities**0.0337 * (sigma / R) ** -0.442 * contact.W**0.4757
    found: float = share * contact.peak_pressure * (1.0 + spread**-1.70) ** (-1.0 / 1.70)
    return found


def solve_mixed(
    contact: LineContact,
    roughness: Roughness,
    tolerance: float = 0.005,
    supply: Supply | None = None,
    start: Film | None = None,
) -> MixedFilm:
    """Share the load between film and asperities.

    Parameters
    ----------
    contact : LineContact
        The whole load, and the bodies' modulus.
    roughness : Roughness
        Of both surfaces together.
    tolerance : float
        Wanted relative error of the film, as for :func:`ehl.solve`.
    supply : Meniscus or OilLayer, optional
        As for :func:`ehl.solve`.
    start : Film, optional
        A film to start from.

    Returns
    -------
    MixedFilm
        With ``converged=False`` where a film fails, or where the asperities would have to carry more than
        all but a millionth of the load.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Notes
    -----
    The share is sought in ln[s/(1-s)] by Brent's method: the asperities' pressure falls as their share
    rises, since the film that carries less is thicker, and what the share asks for rises.

    References
    ----------
    K. L. Johnson, J. A. Greenwood and S. Y. Poon, A simple theory of asperity contact in elastohydrodynamic
    lubrication, Wear 19 (1972) 91-108.
    """
    if not isinstance(roughness, Roughness):
        found = Faults()
        found.add("roughness", roughness, "must be a Roughness", "build one with ehl.Roughness")
        found.raise_if_any()
    search = _Search(contact, roughness, tolerance, supply, start)
    smooth = search.film_at(0.0)
    if not smooth.converged:
        return search.failed(smooth, smooth.message)
    pressure, _ = roughness.pressure(smooth.central_thickness, contact.reduced_modulus)
    if float(pressure) < _LEAST_SHARE * contact.peak_pressure:
        return search.found(smooth, 0.0)
    return search.shared(min(float(pressure) / contact.peak_pressure, 0.5))


class _NoFilmError(Exception):
    """A trial film failed."""


class _Search:
    """Films at trial shares, each started from the last."""

    def __init__(
        self,
        contact: LineContact,
        roughness: Roughness,
        tolerance: float,
        supply: Supply | None,
        start: Film | None,
    ) -> None:
        self.contact = contact
        self.roughness = roughness
        self.tolerance = tolerance
        self.supply = supply
        self.start = start
        self.rounds = 0
        self.last: Film

    def film_at(self, share: float) -> Film:
        """Film that carries what a share of the asperities leaves."""
        left = 1.0 - share
        eased = replace(
            self.contact, load=left * self.contact.load, reduced_modulus=left * self.contact.reduced_modulus
        )
        self.rounds += 1
        film = solve(eased, self.tolerance, start=self.start, supply=self.supply)
        if film.converged:
            self.start = film
        self.last = film
        return film

    def excess(self, odds: float) -> float:
        """Ln of the asperities' pressure over what their share asks for."""
        share = 1.0 / (1.0 + math.exp(-odds))
        film = self.film_at(share)
        if not film.converged:
            raise _NoFilmError(film.message)
        carried, _ = self.roughness.pressure(film.central_thickness, self.contact.reduced_modulus)
        asked = central_asperity_pressure(self.contact, self.roughness, share)
        return math.log(max(float(carried), 1e-300) / asked)

    def shared(self, guess: float) -> MixedFilm:
        """Find the share: steps from the guess until the root is passed, then Brent's method."""
        from scipy.optimize import brentq

        try:
            odds = math.log(guess / (1.0 - guess))
            at = self.excess(odds)
            step, far, at_far = at, odds, at
            while at * at_far > 0.0:
                if far > -math.log(_LEAST_FILM_SHARE):
                    reason = "the asperities carry all but a millionth of the load: take the contact as dry"
                    return self.failed(self.last, reason)
                odds, at = far, at_far
                far += math.copysign(max(abs(step), 0.1), step)
                at_far, step = self.excess(far), 2.0 * step
            odds = float(brentq(self.excess, odds, far, xtol=1e-9, rtol=1e-12)) if at != 0.0 else odds
        except _NoFilmError as reason:
            return self.failed(self.last, str(reason))
        share = 1.0 / (1.0 + math.exp(-odds))
        return self.found(self.film_at(share), share)

    def found(self, film: Film, share: float) -> MixedFilm:
        """Return the shared load, with the asperities' stiffness at the contact's width and both derivatives."""
        if not film.converged:
            return self.failed(film, film.message)
        stiffness, slopes = 0.0, (film.separation_slope, film.central_slope)
        if share > 0.0:
            pressure, slope = self.roughness.pressure(film.central_thickness, self.contact.reduced_modulus)
            steep = float(slope) / float(pressure)
            stiffness = -share * self.contact.load * steep
            try:
                slopes = self.slopes(film, share, steep)
            except _NoFilmError as reason:
                return self.failed(self.last, str(reason))
        return MixedFilm(
            self.contact,
            self.roughness,
            film,
            share,
            stiffness,
            *slopes,
            film.error,
            self.rounds,
            converged=True,
            message="converged",
        )

    def slopes(self, film: Film, share: float, steep: float) -> tuple[float, float]:
        """Derivatives of separation and central film by the load, the share moving along.

        ln p_a(h(w, s)) = ln p_c(w, s) gives ds/dw; the film's own derivatives by w are known, those by s are
        differences of two films at neighbouring odds.
        """
        odds = math.log(share / (1.0 - share))
        sides = [self.film_at(1.0 / (1.0 + math.exp(-odds - step))) for step in (-_ODDS_STEP, _ODDS_STEP)]
        for side in sides:
            if not side.converged:
                raise _NoFilmError(side.message)
        separation_s, central_s = (
            (getattr(sides[1], name) - getattr(sides[0], name)) / (2.0 * _ODDS_STEP)
            for name in ("separation", "central_thickness")
        )
        separation_w, central_w = (1.0 - share) * film.separation_slope, (1.0 - share) * film.central_slope

        def asked(load: float, at: float) -> float:
            contact = replace(self.contact, load=load)
            return math.log(central_asperity_pressure(contact, self.roughness, 1.0 / (1.0 + math.exp(-at))))

        load, step = self.contact.load, 1e-6
        by_load = (asked(load * (1 + step), odds) - asked(load * (1 - step), odds)) / (2 * step * load)
        by_odds = (asked(load, odds + step) - asked(load, odds - step)) / (2 * step)
        follow = (by_load - steep * central_w) / (steep * central_s - by_odds)
        return separation_w + separation_s * follow, central_w + central_s * follow

    def failed(self, film: Film, reason: str) -> MixedFilm:
        """Return no figures."""
        nan = math.nan
        blank = film if not film.converged else replace(film, converged=False, central_thickness=nan)
        return MixedFilm(
            self.contact,
            self.roughness,
            blank,
            nan,
            nan,
            nan,
            nan,
            nan,
            self.rounds,
            converged=False,
            message=reason,
        )
