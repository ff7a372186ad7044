"""The share of the load that asperities carry: from film to film in its odds, with heat and without."""

from __future__ import annotations

import math
from typing import Protocol

from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.discrete.method import METHOD
from ehl.solving.load_share import ALL, NOTHING, KnownGap, excess, foreseen, share_of

_REACH = 3.0  # largest step of the odds
_CLOSE = 1e-2  # between bounds as close as this the balance is straight in the odds
_TRIES = 60
_APART = 1e-3  # of ln of what is left, where two films show how it grows


class NoFilmError(Exception):
    """A trial film failed, or none is left to the load."""


class Films(Protocol):
    """Films of one contact under what asperities leave to it, each started from the last."""

    def gap(self, odds: float) -> float:
        """Central film [m] at odds ln[s/(1-s)] of the asperities' share; NoFilmError where there is none."""

    def growth(self) -> float:
        """Power of what is left to it with which the last film grows."""


class ShareSearch:
    """Share at which the asperities carry what is asked.

    The asperities' pressure falls as their share rises, since the film that carries less is thicker, and what the share
    asks for rises: bounds hold the balance. Each film foresees the next: it grows as a power of what is left to it, by
    its derivative or by the last two films.
    """

    def __init__(self, contact: LineContact, roughness: Roughness, films: Films, enough: float = 0.0) -> None:
        self.contact, self.roughness, self.films = contact, roughness, films
        self.enough = enough  # step of the odds that is left to do

    def odds(self, start: float = -math.inf) -> float:
        """Odds of the balance, from odds to start from: the last film is the one there; -inf: the film carries all."""
        if math.isinf(start):
            gap = self.films.gap(-math.inf)
            if excess(self.contact, self.roughness, gap, NOTHING).value <= 0.0:
                return -math.inf
            start = foreseen(self.contact, self.roughness, KnownGap(gap, -math.inf, self.films.growth()))
            if start <= NOTHING:
                return -math.inf
        balance = self._between(start)
        if math.isinf(balance):
            self.films.gap(-math.inf)
        return balance

    def _between(self, odds: float) -> float:
        """From film to film between bounds.

        Close bounds that a step leaves were films on a coarser grid, or solved less exactly: the balance has moved, and
        they are forgotten.
        """
        low, high = -math.inf, math.inf
        last: KnownGap | None = None
        for _ in range(_TRIES):
            gap = self.films.gap(odds)
            more = excess(self.contact, self.roughness, gap, odds).value
            if abs(more) < METHOD.asperity_balance:
                return odds
            low, high = (odds, high) if more > 0.0 else (low, odds)
            if high <= NOTHING:
                return -math.inf
            if low >= ALL:
                raise NoFilmError(
                    "the asperities carry all but a millionth of the load: take the contact as dry"
                )
            last = KnownGap(gap, odds, self._grows(gap, odds, last))
            ahead = foreseen(self.contact, self.roughness, last) - odds
            if abs(ahead) < self.enough:
                return odds
            step = max(-_REACH, min(_REACH, ahead))
            if high - low < min(abs(step), _CLOSE):
                low, high = -math.inf, math.inf
            target = max(NOTHING, min(ALL, odds + step))
            odds = target if low < target < high else 0.5 * (max(low, NOTHING) + min(high, ALL))
        raise NoFilmError("no share of the load on which film and asperities agree was found")

    def _grows(self, gap: float, odds: float, last: KnownGap | None) -> float:
        """Power with which the film grows: by its derivative first, then from film to film where they differ."""
        if last is None:
            return self.films.growth()
        between = math.log(share_of(-odds) / share_of(-last.odds))
        return math.log(gap / last.gap) / between if abs(between) > _APART else last.grows
