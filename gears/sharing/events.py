"""Instants of the mesh cycle at which curves are not smooth, and the smooth arcs between them.

Pairs of teeth and tip edges begin and end contact at positions that follow from the loaded gears; they are located by
bracketing. A signed reserve says which side one is on: positive where a pair bears, by its force, negative where it
does not, by the gap that is left. Other corners, such as the start of tip relief, follow from the geometry and are
given.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from base import Array, Integers, part, quantity, record
from gears.sharing.arcs import Arcs
from gears.sharing.curve_pieces import LOCATED, Bracket, End, Piece, Sampled

__all__ = ["Events", "Sampled", "Sampler", "arcs_alike", "arcs_between_events"]

NEAR = np.concatenate([-(4.0 ** -np.arange(9.0)), 4.0 ** -np.arange(8.0, -1.0, -1.0)])
"""Places about a known event at which slightly different gears are asked for theirs."""

DEGREES = (8, 16, 32)
"""Degrees of the arcs; one that the last does not resolve is halved."""

HALVINGS = 1
"""Most halvings of an arc that no degree resolves: laws with many small corners are left to the estimate."""

LOOKS = 4
"""Most divisions of an arc where a switch may turn for a moment."""

ALIKE = 1e-6
"""Width of the bracket in which an event of slightly different gears is left [base pitches]: they give an estimate."""

SHORTEST = 1e-8
"""Arcs shorter than this are one event [base pitches]."""


Sampler = Callable[[Array], Sampled]
"""Curves at positions (n,) in base pitches."""


@dataclass(frozen=True)
class Events:
    """Instants between arcs.

    Attributes
    ----------
    position : (n,) array
        Growing, base pitches from A; the ends of all pitches included.
    switched : (n,) array of int
        Number of the switch that changes its sign; -1 at corners of the geometry and where an arc was divided.
    """

    position: Array
    switched: Integers


@record
class Division:
    """Arcs between the events of a mesh cycle."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    arcs: Arcs = part("curves on them")
    events: Events = part("where they meet")
    resolved: bool = part("whether all arcs are resolved to the tolerance")
    samples: int = quantity("1", "positions at which the contact was solved")
    calls: int = quantity("1", "times that it was solved for many positions at once")


def arcs_between_events(
    sample: Sampler, names: tuple[str, ...], corners: Array, pitches: int = 1, tolerance: float = 1e-4
) -> Division:
    """Divide some base pitches at all events, and resolve curves on the arcs between them.

    Parameters
    ----------
    sample : Sampler
    names : tuple of str
        Of the curves.
    corners : (n,) array
        Where the laws change by the geometry, in every base pitch alike, 0 to 1.
    pitches : int
        Base pitches to be covered.
    tolerance : float
        What the last quarter of an arc's series may be, relative to the range of the curve, or to a hundredth of its
        size where that is more. On arcs shorter than a quarter of a base pitch it may be more in proportion, unless
        an extreme of the curve may lie between their ends.

    Returns
    -------
    Division
    """
    return _Search(sample, names, pitches, tolerance).run(corners)


def arcs_alike(sample: Sampler, names: tuple[str, ...], division: Division, pitches: int = 1) -> Arcs | None:
    """Arcs of slightly different gears, with their own events close to known ones and the degrees that are known.

    Parameters
    ----------
    sample : Sampler
        Of the other gears.
    names, pitches
        As of `arcs_between_events`.
    division : Division
        Of the gears that are known.

    Returns
    -------
    Arcs or None
        None where an event is not to be found near the known one.
    """
    return _Search(sample, names, pitches, 1.0).alike(division)


class _Search:
    """Search for events and degrees."""

    def __init__(self, sample: Sampler, names: tuple[str, ...], pitches: int, tolerance: float) -> None:
        self.sample, self.names, self.pitches = sample, names, pitches
        self.tolerance = tolerance
        self.samples = self.calls = 0
        self.low = self.high = np.empty(0)

    def ask(self, position: Array) -> Sampled:
        """Sample, and count it."""
        self.samples += position.size
        self.calls += 1
        return self.sample(position)

    def run(self, corners: Array) -> Division:
        """Resolve arcs; those in which a switch turns are divided there."""
        within = np.unique(np.concatenate([[0.0], np.mod(corners, 1.0)]))
        known = np.append((np.arange(self.pitches)[:, None] + within).ravel(), self.pitches)
        known = known[np.diff(known, prepend=-1.0) > SHORTEST]
        known[-1] = self.pitches
        ends = [End.at(float(position)) for position in known]
        pending = [Piece.between(*neighbours) for neighbours in pairwise(ends)]
        done: list[Piece] = []
        resolved = True
        while pending:
            self._sampled(pending)
            turning = [(piece, piece.brackets()) for piece in pending]
            located = iter(self._located([bracket for _, of_piece in turning for bracket in of_piece]))
            following = []
            for piece, brackets in turning:
                events = [next(located) for _ in brackets]
                more = self._divided(piece, events)
                if more is None:
                    resolved = resolved and self._smooth(piece)
                    done.append(piece)
                else:
                    following += more
            pending = following
        done.sort(key=lambda piece: piece.ends)
        return self._division(done, resolved)

    def alike(self, division: Division) -> Arcs | None:
        """Follow known events, and sample the arcs between them at known degrees."""
        events, known = division.events, []
        ends = [End.at(position) for position in events.position.tolist()]
        for number in np.flatnonzero(events.switched >= 0).tolist():
            room = float(np.min(np.diff(events.position)[max(number - 1, 0) : number + 1]))
            known.append((number, events.position[number] + 0.4 * min(room, 0.05) * NEAR))
        if known:
            reserves, start = self.ask(np.concatenate([place for _, place in known])).reserve, 0
            brackets = []
            for number, place in known:
                switch = int(events.switched[number])
                reserve = reserves[start : (start := start + len(place)), switch]
                turns = np.flatnonzero((reserve[1:] >= 0.0) != (reserve[:-1] >= 0.0))
                if len(turns) != 1 or not np.all(np.isfinite(reserve)):
                    return None
                brackets.append(Bracket(switch, place, reserve, int(turns[0])))
            for (number, _), end in zip(known, self._located(brackets, ALIKE), strict=True):
                ends[number] = end
        pieces = [Piece.between(*neighbours) for neighbours in pairwise(ends)]
        degrees = [arc.values.shape[1] - 1 for arc in division.arcs.arcs]
        self._take(pieces, degrees)
        return self._division(pieces, True).arcs

    def _sampled(self, pieces: list[Piece]) -> None:
        """Sample pieces at their next degree, all at once."""
        self._take(pieces, [next(degree for degree in DEGREES if degree > piece.degree) for piece in pieces])

    def _take(self, pieces: list[Piece], degrees: list[int]) -> None:
        """Sample pieces at given degrees."""
        places = [piece.place(degree) for piece, degree in zip(pieces, degrees, strict=True)]
        sampled, start = self.ask(np.concatenate(places)), 0
        for piece, degree, place in zip(pieces, degrees, places, strict=True):
            here = slice(start, start := start + len(place))
            pairs = None if sampled.pairs is None else sampled.pairs[here]
            piece.add(degree, Sampled(sampled.curves[:, here], sampled.reserve[here], pairs))
        least, most = sampled.curves.min(axis=1), sampled.curves.max(axis=1)
        self.low = least if self.low.size == 0 else np.minimum(self.low, least)
        self.high = most if self.high.size == 0 else np.maximum(self.high, most)

    def _divided(self, piece: Piece, events: list[End]) -> list[Piece] | None:
        """Parts that have to be sampled again, the piece itself for a higher degree; None if it is good."""
        first, last = piece.ends
        if last - first < SHORTEST:
            return None
        inside = sorted(
            (event for event in events if first < event.before and event.after < last),
            key=lambda event: event.before,
        )
        if inside:
            ends = _parted([piece.low, *_apart(inside), piece.high])
            return [Piece.between(*neighbours, piece.halvings) for neighbours in pairwise(ends)]
        look = piece.degree == DEGREES[0] and piece.halvings < LOOKS
        middle = piece.missed() if look else None
        if middle is None and self._smooth(piece):
            return None
        if middle is None and piece.degree < DEGREES[-1]:
            return [piece]
        if middle is None and (piece.halvings >= HALVINGS or piece.towards):
            return None
        end = End.at(0.5 * (first + last) if middle is None else middle)
        more = piece.halvings + 1
        return [Piece.between(piece.low, end, more), Piece.between(end, piece.high, more)]

    def _smooth(self, piece: Piece) -> bool:
        """Whether the series of all curves have decayed."""
        size = np.maximum(self.high - self.low, 0.01 * np.maximum(np.abs(self.low), np.abs(self.high)))
        arc = piece.arc()
        nodes, tail = arc.values, arc.tail
        short = np.full(len(tail), min(1.0, 4.0 * arc.width))
        for sign, most in ((1.0, self.high), (-1.0, -self.low)):
            inside, ends = (sign * nodes[:, 1:-1]).max(axis=1), (sign * nodes[:, [0, -1]]).max(axis=1)
            short[(inside > ends) & (inside + tail >= most)] = 1.0
        return bool(np.all(tail * short <= self.tolerance * size))

    def _located(self, brackets: list[Bracket], width: float = LOCATED) -> list[End]:
        """Events in brackets, all at once, to a width [base pitches]."""
        while wide := [bracket for bracket in brackets if bracket.width > width]:
            asked = [bracket.asked() for bracket in wide]
            reserves, start = self.ask(np.concatenate(asked)).reserve, 0
            for bracket, places in zip(wide, asked, strict=True):
                bracket.add(places, reserves[start : start + len(places), bracket.switch])
                start += len(places)
        return [bracket.end() for bracket in brackets]

    def _division(self, pieces: list[Piece], resolved: bool) -> Division:
        ends = [piece.low for piece in pieces] + [pieces[-1].high]
        middle = np.array([0.5 * (end.before + end.after) for end in ends])
        arcs = tuple(
            piece.arc(low, high) for piece, (low, high) in zip(pieces, pairwise(middle), strict=True)
        )
        events = Events(middle, np.array([end.switch for end in ends]))
        return Division(Arcs(self.names, arcs, self.pitches), events, resolved, self.samples, self.calls)


def _parted(ends: list[End]) -> list[End]:
    """Ends with one more in the middle where contacts begin at one of two and end at the other."""
    parted = ends[:1]
    for low, high in pairwise(ends):
        if low.rises > 0 and high.rises < 0:
            parted.append(End.at(0.5 * (low.after + high.before)))
        parted.append(high)
    return parted


def _apart(ends: list[End]) -> list[End]:
    """Events that do not overlap; of those that do, one over both."""
    kept = [ends[0]]
    for end in ends[1:]:
        if end.before - kept[-1].after < SHORTEST:
            kept[-1] = End(kept[-1].before, max(end.after, kept[-1].after), end.switch, end.rises)
        else:
            kept.append(end)
    return kept
