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
from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.discrete.regressions import moes_central
from ehl.discrete.supply import OilLayer, Supply
from ehl.films.film import Film
from ehl.films.mixed_film import MixedFilm
from ehl.films.result import Found
from ehl.films.rough_slopes import RoughSlopes, rough_slopes
from ehl.films.solver import solve_checked
from ehl.solving.levels import State, figures
from ehl.solving.load_share import (
    ALL,
    NOTHING,
    KnownGap,
    eased,
    excess,
    foreseen,
    odds_of,
    share_of,
    usual_growth,
)
from ehl.solving.options import Options, warn_of_range
from ehl.solving.response import Response, by_share

_BALANCED = 1e-7  # relative difference of what asperities carry and are asked for
_REACH = 3.0  # largest step of the odds
_CLOSE = 1e-2  # between bounds as close as this the balance is straight in the odds
_TRIES = 60
_APART = 1e-3  # of ln of what is left, where two films show how it grows


def solve_mixed(
    contact: LineContact,
    roughness: Roughness,
    tolerance: float = 0.005,
    supply: Supply | None = None,
    start: Film | MixedFilm | None = None,
    nodes: int | None = None,
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
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.

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
    The share is sought in ln[s/(1-s)] between bounds, each film giving the next share. The asperities' pressure falls
    as their share rises, since the film that carries less is thicker, and what the share asks for rises. The film's
    derivative by the share comes from its own Newton matrix at first, then from the last two films.

    References
    ----------
    K. L. Johnson, J. A. Greenwood and S. Y. Poon, A simple theory of asperity contact in elastohydrodynamic
    lubrication, Wear 19 (1972) 91-108, doi:10.1016/0043-1648(72)90445-0;
    :func:`ehl.discrete.asperities.plane_distance`.

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
    options = Options(tolerance, nodes, supply=supply).checked(contact)
    search = _Search(contact, roughness, options, start)
    try:
        mixed = search.solved()
    except _NoFilmError as reason:
        return search.failed(str(reason))
    warn_of_range(mixed.film.contact)
    return mixed


class _NoFilmError(Exception):
    """A trial film failed, or none is left to the load."""


class _Balance(NamedTuple):
    """A film under the share of the load that its asperities leave to it."""

    film: Found
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
        self.cost = Cost(0.0)
        self.odds = -math.inf
        if isinstance(start, MixedFilm) and start.converged and start.asperity_share > 0.0:
            self.odds = self.likely_odds(start)

    def film_at(self, odds: float) -> Found:
        """Film that carries what the asperities leave, at odds ln[s/(1-s)] of their share."""
        self.last = film = solve_checked(eased(self.contact, share_of(-odds)), self.options, self.state)
        self.cost += film.run.cost() + Cost(0.0, counts={"films": 1})
        if not film.converged:
            raise _NoFilmError(film.film().message)
        self.state = film.state.bare()
        return film

    def solved(self) -> MixedFilm:
        """Share the load, with the asperities' stiffness at the contact's width and both derivatives."""
        if math.isinf(self.odds):
            smooth = self.film_at(-math.inf)
            self.odds = self.first_odds(smooth)
            if self.odds <= NOTHING:
                return self.smooth(smooth)
        balance = self.balance()
        if balance is None:
            return self.smooth(self.film_at(-math.inf))
        film = balance.film.film()
        answers = rough_slopes(self.contact, self.roughness, film, balance.odds, balance.by)
        return self.result(film, share_of(balance.odds), answers)

    def first_odds(self, smooth: Found) -> float:
        """Odds that the smooth film makes likely; NOTHING where asperities do not reach through it."""
        gap = figures(smooth.fine).central_thickness
        if excess(self.contact, self.roughness, gap, NOTHING).value <= 0.0:
            return NOTHING
        return foreseen(self.contact, self.roughness, KnownGap(gap, -math.inf, self.growth(smooth)))

    def likely_odds(self, start: MixedFilm) -> float:
        """Odds that a neighbour makes likely: its film, changed as Moes' formula has it; behind a layer as it is."""
        share, near = start.asperity_share, start.film.contact
        film_share, supply = 1.0 - share, self.options.supply
        ratio = 1.0
        if not isinstance(supply, OilLayer):
            ratio = moes_central(eased(self.contact, film_share)) / moes_central(near)
        grows = usual_growth(self.contact, film_share, supply)
        known = KnownGap(ratio * start.central_thickness, odds_of(share), grows)
        return foreseen(self.contact, self.roughness, known)

    def growth(self, film: Found) -> float:
        """Power of what is left to it with which a film grows, by its derivative."""
        by = by_share(film.fine, film.run.supply)
        return by.central / figures(film.fine).central_thickness

    def balance(self) -> _Balance | None:
        """Share at which the asperities carry what is asked, from film to film in its odds between bounds.

        The asperities' pressure falls as their share rises, since the film that carries less is thicker, and what
        the share asks for rises. Each film foresees the next: it grows as a power of what is left to it, by its
        derivative or by the last two films. None where asperities carry nothing. Close bounds that a step leaves were
        films on a coarser grid, or solved less exactly: the balance has moved, and they are forgotten.
        """
        odds, low, high = self.odds, -math.inf, math.inf
        last: KnownGap | None = None
        for _ in range(_TRIES):
            film = self.film_at(odds)
            gap = figures(film.fine).central_thickness
            more = excess(self.contact, self.roughness, gap, odds).value
            if abs(more) < _BALANCED:
                by = by_share(film.fine, film.run.supply).scaled(-share_of(odds))  # ln(1 - s) falls by s
                return _Balance(film, odds, by)
            low, high = (odds, high) if more > 0.0 else (low, odds)
            if high <= NOTHING:
                return None
            if low >= ALL:
                raise _NoFilmError(
                    "the asperities carry all but a millionth of the load: take the contact as dry"
                )
            last = KnownGap(gap, odds, self.grows(film, gap, odds, last))
            ahead = foreseen(self.contact, self.roughness, last) - odds
            step = max(-_REACH, min(_REACH, ahead))
            if high - low < min(abs(step), _CLOSE):
                low, high = -math.inf, math.inf
            target = max(NOTHING, min(ALL, odds + step))
            odds = target if low < target < high else 0.5 * (max(low, NOTHING) + min(high, ALL))
        raise _NoFilmError("no share of the load on which film and asperities agree was found")

    def grows(self, film: Found, gap: float, odds: float, last: KnownGap | None) -> float:
        """Power with which the film grows: by its derivative first, then from film to film where they differ."""
        if last is None:
            return self.growth(film)
        between = math.log(share_of(-odds) / share_of(-last.odds))
        return math.log(gap / last.gap) / between if abs(between) > _APART else last.grows

    def smooth(self, film_alone: Found) -> MixedFilm:
        """Return a film that carries all."""
        film = film_alone.film()
        return self.result(film, 0.0, RoughSlopes(0.0, film.separation_slope, film.central_slope))

    def result(self, film: Film, share: float, answers: RoughSlopes) -> MixedFilm:
        """Return the film with the share of the asperities and the answers to the load."""
        return MixedFilm(self.contact, self.roughness, film, self.cost, True, "converged", share, *answers)

    def failed(self, reason: str) -> MixedFilm:
        """Return no figures."""
        blank = replace(self.last.film(), converged=False, central_thickness=math.nan)
        return MixedFilm(self.contact, self.roughness, blank, self.cost, False, reason)
