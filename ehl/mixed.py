"""Mixed lubrication: film and asperities share the load.

Johnson, Greenwood and Poon's load sharing: asperities and film carry the shares s and 1 - s of the load at every
point alike. The bodies then deform under the film's pressure as a contact of load w (1 - s) and modulus
E' (1 - s) would: the half-width stays. The film of that contact is the mean gap between the surfaces; the mean planes
of their heights are as far apart as leaves that gap, less than it and at thin films less than nothing. Asperities carry
their pressure at that distance, and s is where this is what the share asks for at the middle of the contact. So the
share tends to 1 as films vanish, whatever the load.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from base import Cost, InputError, shorten
from ehl.asperities import Roughness
from ehl.contact import LineContact
from ehl.film import Film
from ehl.levels import State, figures
from ehl.mixed_film import MixedFilm
from ehl.options import Options, warn_of_range
from ehl.outcome import Found
from ehl.response import Response, by_share
from ehl.solver import solve_checked
from ehl.supply import Supply

_LEAST_SHARE = 1e-10
_NOTHING = math.log(_LEAST_SHARE)  # odds of a share that counts as none,
_ALL = -math.log(1e-6)  # and of one that leaves a millionth to the film
_BALANCED = 1e-7  # relative difference of the pressures that asperities carry and are asked for
_REACH = 3.0  # largest step of the odds
_CLOSE = 1e-2  # between bounds as close as this the balance is straight in the odds
_TRIES = 60
_VACUUM = 1e-300


def central_asperity_pressure(contact: LineContact, roughness: Roughness, share: float) -> float:
    """Pressure on the asperities at the middle of a rough line contact [Pa], by Gelinck and Schipper's fit.

    ``p_c = s p_H [1 + (1.558 (n/s R^1.5 beta^0.5)^0.0337 (sigma/R)^-0.442 W^0.4757)^-1.70]^(-1/1.70)``, s the
    asperities' share of the load: the Hertz pressure of the share, lowered by the spread of a rough contact. Where
    the film ratio decides it is the Hertz pressure of the share.

    References
    ----------
    E. R. M. Gelinck and D. J. Schipper, Calculation of Stribeck curves for line contacts, Tribology
    International 33 (2000) 175-181. The constants were taken from a secondary source; the bracket is within
    some per cent of one for hard contacts, which limits what an error in them can do.
    """
    if not roughness.elastic:
        return share * contact.peak_pressure
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
    start: Film | MixedFilm | None = None,
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
    start : Film or MixedFilm, optional
        A film to start from; one with asperities gives their share to start with as well.

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
    The share is sought in ln[s/(1-s)] by Newton's method between bounds: the asperities' pressure falls as their
    share rises, since the film that carries less is thicker, and what the share asks for rises. The film's derivative
    by the share comes from its own Newton matrix.

    References
    ----------
    K. L. Johnson, J. A. Greenwood and S. Y. Poon, A simple theory of asperity contact in elastohydrodynamic
    lubrication, Wear 19 (1972) 91-108, doi:10.1016/0043-1648(72)90445-0; :func:`ehl.asperities.plane_distance`.

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
    options = Options(tolerance, supply=supply).checked(contact)
    search = _Search(contact, roughness, options, start)
    try:
        found = search.solved()
    except _NoFilmError as reason:
        return search.failed(str(reason))
    warn_of_range(found.film.contact)
    return found


class _NoFilmError(Exception):
    """A trial film failed, or none is left to the load."""


class _Balance(NamedTuple):
    """A film under the share of the load that its asperities leave to it."""

    found: Found
    odds: float
    by: Response  # derivatives by the odds


class _Search:
    """Films at trial shares, each started from the last."""

    def __init__(
        self, contact: LineContact, roughness: Roughness, options: Options, start: Film | MixedFilm | None
    ) -> None:
        self.contact = contact
        self.roughness = roughness
        self.options = options
        before = start.film if isinstance(start, MixedFilm) else start
        self.state: State | None = None if before is None else before.state
        share = start.asperity_share if isinstance(start, MixedFilm) and start.converged else 0.0
        self.odds = math.log(share / (1.0 - share)) if share > 0.0 else -math.inf
        self.cost = Cost(0.0)

    def film_at(self, odds: float) -> Found:
        """Film that carries what the asperities leave, at odds ln[s/(1-s)] of their share."""
        left = 1.0 - _share(odds)
        eased = replace(
            self.contact, load=left * self.contact.load, reduced_modulus=left * self.contact.reduced_modulus
        )
        self.last = found = solve_checked(eased, self.options, self.state)
        self.cost += found.run.cost() + Cost(0.0, counts={"films": 1})
        if not found.converged:
            raise _NoFilmError(found.film().message)
        self.state = found.state.bare()
        return found

    def carried(self, central: float) -> tuple[float, float]:
        """Asperities' pressure at a central thickness [Pa] and its derivative by that [Pa/m]."""
        contact = self.contact
        return self.roughness.under_film(central, contact.reduced_modulus, contact.peak_pressure)

    def asked(self, odds: float, heavier: float = 1.0) -> float:
        """Pressure that the asperities' share asks of them [Pa], at a multiple of the load."""
        contact = replace(self.contact, load=heavier * self.contact.load)
        return central_asperity_pressure(contact, self.roughness, _share(odds))

    def asked_slopes(self, odds: float) -> tuple[float, float]:
        """Derivatives of ln of that pressure by the odds and by ln of the load."""
        step = 1e-6
        by_odds = math.log(self.asked(odds + step)) - math.log(self.asked(odds - step))
        by_load = math.log(self.asked(odds, 1 + step)) - math.log(self.asked(odds, 1 - step))
        return by_odds / (2 * step), by_load / (2 * step)

    def solved(self) -> MixedFilm:
        """Share the load, with the asperities' stiffness at the contact's width and both derivatives."""
        if math.isinf(self.odds):
            smooth = self.film_at(-math.inf)
            alone = self.carried(figures(smooth.fine).central_thickness)[0] / self.contact.peak_pressure
            if alone < _LEAST_SHARE:
                return self.smooth(smooth)
            share = min(alone, 0.5)
            self.odds = math.log(share / (1.0 - share))
        balance = self.balance()
        if balance is None:
            return self.smooth(self.film_at(-math.inf))
        film, share, by = balance.found.film(), _share(balance.odds), balance.by
        pressure, slope = self.carried(film.central_thickness)
        closer = float(self.roughness.planes(film.central_thickness)[1])  # planes by gap
        stiffness = -share * self.contact.load * slope / pressure / closer
        # ln p_a(h(w, s)) = ln p_c(w, s) gives ds/dw
        left, steep = 1.0 - share, slope / pressure
        asked_by_odds, asked_by_load = self.asked_slopes(balance.odds)
        separation_w, central_w = left * film.separation_slope, left * film.central_slope
        if not self.roughness.elastic:  # what is carried grows with the Hertz pressure alike
            asked_by_load = 0.0
        follow = asked_by_load / self.contact.load - steep * central_w
        follow /= steep * by.central - asked_by_odds
        central = central_w + by.central * follow
        separation = separation_w + by.separation * follow + (closer - 1.0) * central
        return self.result(film, share, stiffness, separation, central)

    def balance(self) -> _Balance | None:
        """Share at which the asperities carry what is asked, by Newton's method in its odds between bounds.

        The asperities' pressure falls as their share rises, since the film that carries less is thicker, and what
        the share asks for rises. None where they carry nothing. Close bounds that Newton's step leaves were films on
        a coarser grid, or solved less exactly: the balance has moved, and they are forgotten.
        """
        odds, low, high = self.odds, -math.inf, math.inf
        for _ in range(_TRIES):
            found = self.film_at(odds)
            excess, slope, by = self.excess(found, odds)
            if abs(excess) < _BALANCED:
                return _Balance(found, odds, by)
            low, high = (odds, high) if excess > 0.0 else (low, odds)
            if high <= _NOTHING:
                return None
            if low >= _ALL:
                raise _NoFilmError(
                    "the asperities carry all but a millionth of the load: take the contact as dry"
                )
            # of a held layer the film's part of the slope is rounding where asperities carry nearly all
            ahead = -excess / slope if slope < 0.0 else math.copysign(_REACH, excess)
            step = max(-_REACH, min(_REACH, ahead))
            if high - low < min(abs(step), _CLOSE):
                low, high = -math.inf, math.inf
            target = max(_NOTHING, min(_ALL, odds + step))
            odds = target if low < target < high else 0.5 * (low + high)
        raise _NoFilmError("no share of the load on which film and asperities agree was found")

    def excess(self, found: Found, odds: float) -> tuple[float, float, Response]:
        """Ln of the asperities' pressure over what their share asks for, its derivative and the film's by the odds."""
        by = by_share(found.fine, found.run.supply).scaled(-_share(odds))  # ln(1 - s) falls by s
        pressure, slope = self.carried(figures(found.fine).central_thickness)
        excess = math.log(max(pressure, _VACUUM) / self.asked(odds))
        steep = slope / pressure * by.central if pressure > _VACUUM else 0.0
        return excess, steep - self.asked_slopes(odds)[0], by

    def smooth(self, found: Found) -> MixedFilm:
        """Return a film that carries all."""
        film = found.film()
        return self.result(film, 0.0, 0.0, film.separation_slope, film.central_slope)

    def result(self, film: Film, *figures: float) -> MixedFilm:
        """Return what was found: share and stiffness of the asperities, slopes of separation and central film."""
        return MixedFilm(self.contact, self.roughness, film, self.cost, True, "converged", *figures)

    def failed(self, reason: str) -> MixedFilm:
        """Return no figures."""
        blank = replace(self.last.film(), converged=False, central_thickness=math.nan)
        return MixedFilm(self.contact, self.roughness, blank, self.cost, False, reason)


def _share(odds: float) -> float:
    """Share s of the asperities at odds ln[s/(1-s)]; 0 at odds of minus infinity."""
    return 1.0 / (1.0 + math.exp(-odds))
