"""Balance of the load between film and asperities: what asperities carry at a gap, and what their share asks for."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.discrete.film_ratio import share_by_ratio
from ehl.discrete.regressions import moes_central
from ehl.discrete.supply import OilLayer, Supply

LEAST_SHARE = 1e-10
NOTHING = math.log(LEAST_SHARE)
"""Odds of a share that counts as none."""

ALL = -math.log(1e-6)
"""Odds of a share that leaves a millionth to the film."""

_VACUUM = 1e-300
_ROUNDS = 80
_LESS = 0.99  # part of what is left over which Moes' formula is differentiated
_FORESEEN = 1e-9  # last step of odds that are foreseen
_END = 1e-6  # odds as near to nothing or all are these


class Excess(NamedTuple):
    """By how much asperities carry more than their share asks for: 0 at balance, and derivatives."""

    value: float  # difference of ln of pressures; of ln of odds where the film ratio decides
    by_gap: float  # [1/m]
    by_odds: float
    by_load: float  # ln of the load


class KnownGap(NamedTuple):
    """A central film at odds of the asperities' share, and the power of what is left to it with which it grows."""

    gap: float  # [m]
    odds: float
    grows: float

    def at(self, odds: float) -> float:
        """Film at other odds [m]."""
        return self.gap * math.pow(share_of(-odds) / share_of(-self.odds), self.grows)


def share_of(odds: float) -> float:
    """Share s of the asperities at odds ln[s/(1-s)]; 0 at odds of minus infinity."""
    return 1.0 / (1.0 + math.exp(-odds))


def odds_of(share: float) -> float:
    """Odds ln[s/(1-s)] of a share."""
    return math.log(share / (1.0 - share)) if share > 0.0 else -math.inf


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
    return _asked(contact, roughness, share)[0]


def _asked(contact: LineContact, roughness: Roughness, share: float) -> tuple[float, float]:
    """Pressure by the fit [Pa], and how ln of its bracket follows ln of the spread."""
    R, sigma = contact.radius, roughness.deviation
    asperities = roughness.density / share * R**1.5 * math.sqrt(roughness.tip_radius)
    spread = 1.558 * asperities**0.0337 * (sigma / R) ** -0.442 * contact.W**0.4757
    lowered = spread**-1.70
    return share * contact.peak_pressure * (1.0 + lowered) ** (-1.0 / 1.70), lowered / (1.0 + lowered)


def eased(contact: LineContact, film_share: float) -> LineContact:
    """Return the contact of the part of load and modulus that asperities leave to the film."""
    return replace(
        contact, load=film_share * contact.load, reduced_modulus=film_share * contact.reduced_modulus
    )


def usual_growth(contact: LineContact, film_share: float, supply: Supply | None) -> float:
    """Power of what is left to it with which a film grows, by Moes' formula; none behind a layer, which it follows."""
    if isinstance(supply, OilLayer):
        return 0.0
    here, less = (moes_central(eased(contact, part * film_share)) for part in (1.0, _LESS))
    return math.log(less / here) / math.log(_LESS)


def excess(contact: LineContact, roughness: Roughness, gap: float, odds: float) -> Excess:
    """By how much asperities under a film carry more than their share asks for.

    Parameters
    ----------
    contact : LineContact
        The whole load, and the bodies' modulus.
    roughness : Roughness
        Of both surfaces together.
    gap : float
        Central mean gap [m].
    odds : float
        ln[s/(1-s)] of the asperities' share s.
    """
    if not roughness.elastic:
        ratio_share = share_by_ratio(gap, roughness.deviation)
        return Excess(ratio_share.odds - odds, ratio_share.odds_steep, -1.0, 0.0)
    pressure, slope = roughness.under_film(gap, contact.reduced_modulus, contact.peak_pressure)
    asked, follows = _asked(contact, roughness, share_of(odds))
    return Excess(
        math.log(max(pressure, _VACUUM) / asked),
        slope / pressure if pressure > _VACUUM else 0.0,
        -(1.0 - 0.0337 * follows) * share_of(-odds),
        -(0.5 + 0.4757 * follows),
    )


class Balance(NamedTuple):
    """Film and asperities at odds, the film growing as a power of what is left to it."""

    excess: float  # of what asperities carry over what is asked of them
    by_film: float  # its derivatives, by ln of the film at a given share
    by_odds: float  # with the film that follows

    @classmethod
    def at(cls, contact: LineContact, roughness: Roughness, known: KnownGap, odds: float) -> Balance:
        """Follow a known film to odds."""
        gap = known.at(odds)
        at = excess(contact, roughness, gap, odds)
        by_film = at.by_gap * gap
        return cls(at.value, by_film, at.by_odds - by_film * known.grows * share_of(odds))


def share_error(
    contact: LineContact, roughness: Roughness, known: KnownGap, film: float, left: float = 0.0
) -> float:
    """Relative error of the share at balance, which asperities answer to an error of the film by.

    Parameters
    ----------
    contact : LineContact
        The whole load, and the bodies' modulus.
    roughness : Roughness
        Of both surfaces together.
    known : KnownGap
        Film and odds at balance; at odds of minus infinity the film carries all.
    film : float
        Relative error of the film.
    left : float
        Step of the odds that is left to do.
    """
    if math.isinf(known.odds):
        return 0.0
    balance = Balance.at(contact, roughness, known, known.odds)
    return share_of(-known.odds) * (abs(balance.by_film / balance.by_odds) * film + left)


def foreseen(contact: LineContact, roughness: Roughness, known: KnownGap) -> float:
    """Odds at which a known film balances if it grows as a power of what is left to it; from nothing to all.

    The excess falls as the odds rise: Newton's method between bounds.
    """
    low, high, odds = NOTHING, ALL, min(max(known.odds, NOTHING), ALL)
    for _ in range(_ROUNDS):
        at = Balance.at(contact, roughness, known, odds)
        low, high = (odds, high) if at.excess > 0.0 else (low, odds)
        target = odds - at.excess / at.by_odds if at.by_odds < 0.0 else math.inf
        before, odds = odds, target if low < target < high else 0.5 * (low + high)
        if abs(odds - before) < _FORESEEN:
            break
    return NOTHING if odds - NOTHING < _END else ALL if ALL - odds < _END else odds
