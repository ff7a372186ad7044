"""Mixed lubrication: film and asperities share the load.

Johnson, Greenwood and Poon's load sharing: asperities and film carry the shares s and 1 - s of the load at every
point alike. The bodies then deform under the film's pressure as a contact of load w (1 - s) and modulus
E' (1 - s) would: the half-width stays. The film of that contact gives the separation, the asperities their
pressure at it, and s is where that pressure is what the share asks for at the middle of the contact.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field, replace

from base import Cost, InputError, RangeWarning, described, part, record, shorten
from ehl.asperities import Roughness
from ehl.contact import LineContact
from ehl.film import Film, unsolved
from ehl.options import warn_of_range
from ehl.solver import solve
from ehl.supply import Supply

_LEAST_SHARE = 1e-10
_LEAST_FILM_SHARE = 1e-6
_ODDS_STEP = 0.02


@record
class MixedFilm:
    """A film between rough surfaces. Figures are NaN when ``converged`` is False.

    ``film`` is that of the load and modulus that are left to it; its half-width is that of ``contact``.
    ``cost.counts["films"]`` counts the films solved.

    The stiffnesses are those of springs in parallel, at fixed speed and fixed width of the contact. A contact that
    asperities carry widens with the load, which makes it stiffer again by up to two: ``separation_slope`` and
    ``central_slope`` are the derivatives with all of that, -1/slope the whole stiffness.
    """

    no_error = "not estimated; the film has one"

    headline = ("central_thickness", "minimum_thickness", "film_ratio", "asperity_share")

    contact: LineContact = part("the contact, with its whole load")
    roughness: Roughness = part("of both surfaces together")
    film: Film = part("film that carries the rest of the load")
    cost: Cost
    converged: bool
    message: str
    asperity_share: float = unsolved("1", "share of the load that the asperities carry", shown="%")
    asperity_stiffness: float = unsolved("N/m2", "stiffness of the asperities at the contact's width")
    separation_slope: float = unsolved(
        "m2/N", "derivative of the separation by the load at fixed speed, asperities included"
    )
    central_slope: float = unsolved(
        "m2/N", "derivative of the central thickness by the load at fixed speed, asperities included"
    )

    @described("1")
    def error(self) -> float:
        """Estimated relative error of the film."""
        return self.film.error if self.converged else math.nan

    @described("m", shown="um", error="error")
    def central_thickness(self) -> float:
        """Distance of the mean planes at x = 0."""
        return self.film.central_thickness

    @described("m", shown="um", error="error")
    def minimum_thickness(self) -> float:
        """Least distance of the mean planes."""
        return self.film.minimum_thickness

    @described("m", shown="um")
    def separation(self) -> float:
        """Approach of the dry contact less that with film and asperities."""
        return self.film.separation

    @described("1", error="error")
    def film_ratio(self) -> float:
        """Lambda, least distance of the mean planes over the standard deviation of heights."""
        return self.film.minimum_thickness / self.roughness.deviation

    @described("N/m")
    def asperity_load(self) -> float:
        """Load on the asperities per length of face."""
        return self.asperity_share * self.contact.load

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

    Examples
    --------
    >>> ground = Roughness(deviation=0.1e-6, density=4e10, tip_radius=1e-5)
    >>> mixed = solve_mixed(LineContact.from_moes(M=20.0, L=10.0), ground)
    >>> f"film ratio {mixed.film_ratio:.2f}, asperities carry {100 * mixed.asperity_share:.1f} %"
    'film ratio 2.43, asperities carry 0.2 %'
    """
    if not isinstance(roughness, Roughness):
        raise InputError.at(
            "roughness", shorten(roughness), "must be a Roughness", "build one with ehl.Roughness"
        )
    search = _Search(contact, roughness, tolerance, supply, start)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)  # trial shares leave films that nothing shows
            found = search.solved()
    except _NoFilmError as reason:
        return search.failed(str(reason))
    warn_of_range(found.film.contact)
    return found


class _NoFilmError(Exception):
    """A trial film failed, or none is left to the load."""


@dataclass
class _Search:
    """Films at trial shares, each started from the last."""

    contact: LineContact
    roughness: Roughness
    tolerance: float
    supply: Supply | None
    start: Film | None
    cost: Cost = field(default_factory=lambda: Cost(0.0))
    last: Film = field(init=False)

    def film_at(self, odds: float) -> Film:
        """Film that carries what the asperities leave, at odds ln[s/(1-s)] of their share."""
        left = 1.0 - _share(odds)
        eased = replace(
            self.contact, load=left * self.contact.load, reduced_modulus=left * self.contact.reduced_modulus
        )
        self.last = film = solve(eased, self.tolerance, start=self.start, supply=self.supply)
        self.cost += film.cost + Cost(0.0, counts={"films": 1})
        if not film.converged:
            raise _NoFilmError(film.message)
        self.start = film
        return film

    def carried(self, film: Film) -> tuple[float, float]:
        """Asperities' pressure at a film's central thickness [Pa] and its derivative by that [Pa/m]."""
        pressure, slope = self.roughness.pressure(film.central_thickness, self.contact.reduced_modulus)
        return float(pressure), float(slope)

    def asked(self, odds: float, heavier: float = 1.0) -> float:
        """Pressure that the asperities' share asks of them [Pa], at a multiple of the load."""
        contact = replace(self.contact, load=heavier * self.contact.load)
        return central_asperity_pressure(contact, self.roughness, _share(odds))

    def excess(self, odds: float) -> float:
        """Ln of the asperities' pressure over what their share asks for."""
        carried = self.carried(self.film_at(odds))[0]
        return math.log(max(carried, 1e-300) / self.asked(odds))

    def solved(self) -> MixedFilm:
        """Share the load, with the asperities' stiffness at the contact's width and both derivatives."""
        smooth = self.film_at(-math.inf)
        alone = self.carried(smooth)[0] / self.contact.peak_pressure
        if alone < _LEAST_SHARE:
            return self.result(smooth, 0.0, 0.0, smooth.separation_slope, smooth.central_slope)
        share = min(alone, 0.5)
        odds = self.balance(math.log(share / (1.0 - share)))
        film, share = self.film_at(odds), _share(odds)
        pressure, slope = self.carried(film)
        stiffness = -share * self.contact.load * slope / pressure
        return self.result(film, share, stiffness, *self.slopes(film, odds, slope / pressure))

    def balance(self, odds: float) -> float:
        """Odds at which the asperities carry what is asked: steps until the root is passed, then Brent's method."""
        from scipy.optimize import brentq

        at = self.excess(odds)
        step, far, at_far = at, odds, at
        while at * at_far > 0.0:
            if far > -math.log(_LEAST_FILM_SHARE):
                raise _NoFilmError(
                    "the asperities carry all but a millionth of the load: take the contact as dry"
                )
            odds, at = far, at_far
            far += math.copysign(max(abs(step), 0.1), step)
            at_far, step = self.excess(far), 2.0 * step
        return float(brentq(self.excess, odds, far, xtol=1e-9, rtol=1e-12)) if at != 0.0 else odds

    def slopes(self, film: Film, odds: float, steep: float) -> tuple[float, float]:
        """Derivatives of separation and central film by the load, the share moving along.

        ln p_a(h(w, s)) = ln p_c(w, s) gives ds/dw; the film's own derivatives by w are known, those by s are
        differences of two films at neighbouring odds.
        """
        low, high = (self.film_at(odds + step) for step in (-_ODDS_STEP, _ODDS_STEP))
        separation_s = (high.separation - low.separation) / (2.0 * _ODDS_STEP)
        central_s = (high.central_thickness - low.central_thickness) / (2.0 * _ODDS_STEP)
        left = 1.0 - _share(odds)
        separation_w, central_w = left * film.separation_slope, left * film.central_slope
        step = 1e-6
        by_load = math.log(self.asked(odds, 1 + step)) - math.log(self.asked(odds, 1 - step))
        by_load /= 2 * step * self.contact.load
        by_odds = (math.log(self.asked(odds + step)) - math.log(self.asked(odds - step))) / (2 * step)
        follow = (by_load - steep * central_w) / (steep * central_s - by_odds)
        return separation_w + separation_s * follow, central_w + central_s * follow

    def result(self, film: Film, *figures: float) -> MixedFilm:
        """Return what was found: share and stiffness of the asperities, slopes of separation and central film."""
        return MixedFilm(self.contact, self.roughness, film, self.cost, True, "converged", *figures)

    def failed(self, reason: str) -> MixedFilm:
        """Return no figures."""
        blank = replace(self.last, converged=False, central_thickness=math.nan)
        return MixedFilm(self.contact, self.roughness, blank, self.cost, False, reason)


def _share(odds: float) -> float:
    """Share s of the asperities at odds ln[s/(1-s)]; 0 at odds of minus infinity."""
    return 1.0 / (1.0 + math.exp(-odds))
