"""Laws of a pair's tip edges, kept by place: pitches, torques and both meshes of an estimate ask for the same ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, record
from fem.local_law import Table
from fem.tip_contact import edge_laws

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.contact_candidates import ContactCandidates
    from fem.setting import Setting

__all__ = ["EdgeTables"]

APART = 1e-11
"""Base pitches within which two places are one: laws are continuous in the place."""

MOST = 20_000
"""Laws kept of either gear's tip; when there are more all are forgotten."""


@record
class _Laws:
    """Laws of one gear's tip, in order of their places.

    Attributes
    ----------
    key : (n,) array
        Places, rounded; growing.
    force, approach : (n, points) arrays
        [N], [m]
    largest : (n,) array
        [N]
    """

    key: Array
    force: Array
    approach: Array
    largest: Array

    def has(self, key: Array) -> Booleans:
        """Whether the law of each place is here."""
        at = np.minimum(np.searchsorted(self.key, key), len(self.key) - 1)
        found: Booleans = self.key[at] == key if len(self.key) else np.zeros(len(key), dtype=bool)
        return found

    def rows(self, key: Array) -> _Laws:
        """Laws of places that are here."""
        return self._part(np.searchsorted(self.key, key))

    def joined(self, other: _Laws) -> _Laws:
        """These and others."""
        every = zip(
            (self.key, self.force, self.approach, self.largest),
            (other.key, other.force, other.approach, other.largest),
            strict=True,
        )
        both = _Laws(*(np.concatenate(pair) for pair in every))
        return both._part(np.argsort(both.key))

    def _part(self, rows: Integers) -> _Laws:
        return _Laws(self.key[rows], self.force[rows], self.approach[rows], self.largest[rows])


class EdgeTables:
    """Laws of all tip edges of a pair by the place of the contact.

    Parameters
    ----------
    given : Setting
        At any positions: what counts is how the gears are set up.
    bodies : Compliance
        On any of its meshes that share the answer of the tips.
    """

    def __init__(self, given: Setting, bodies: Compliance) -> None:
        self.given, self.bodies = given, bodies
        self._kept: dict[int, _Laws] = {}

    def serves(self, bodies: Compliance) -> bool:
        """Whether laws of these bodies, on whichever mesh, are the ones that are kept here."""
        strips = bodies.tip_strips
        return bodies is self.bodies or strips is None or strips is self.bodies.tips

    def at(self, where: ContactCandidates) -> tuple[Table | None, Array]:
        """Laws of all tip edges in row-major order, and the largest forces kappa F that they cover [N]."""
        if not where.edge.any():
            return None, np.zeros(0)
        found = [(chosen, self._laws(corner, where.place[chosen])) for corner, chosen in where.corners()]
        points = max(laws.force.shape[1] for _, laws in found)
        order = np.argsort(np.concatenate([np.flatnonzero(chosen) for chosen, _ in found]))
        force, approach = (
            np.concatenate([_extended(values, points) for values in every])[order]
            for every in ([laws.force for _, laws in found], [laws.approach for _, laws in found])
        )
        return Table.through(force, approach), np.concatenate([laws.largest for _, laws in found])[order]

    def _laws(self, corner: int, place: Array) -> _Laws:
        """Laws of one gear's tip at places (n,) [m]; those that are known are not computed again."""
        key = np.round(place / (APART * self.given.pair.base_pitch))
        known = self._kept.get(corner)
        if known is None or len(known.key) > MOST:
            known = self._computed(corner, key, place)
        elif not (here := known.has(key)).all():
            known = known.joined(self._computed(corner, key[~here], place[~here]))
        self._kept[corner] = known
        return known.rows(key)

    def _computed(self, corner: int, key: Array, place: Array) -> _Laws:
        key, first = np.unique(key, return_index=True)
        given, bodies = self.given, self.bodies
        touched = (bodies.pinion, bodies.wheel)[1 - corner].law
        tips = bodies.tips[corner]
        law = edge_laws(given.pair, tips, corner, place[first], touched, given.rounds[corner], given.removed)
        return _Laws(key, law.force, law.approach - law.approach[:, :1], law.largest)


def _extended(values: Array, points: int) -> Array:
    """Rows continued in a straight line to a number of points."""
    more = np.arange(1, points - values.shape[1] + 1)
    beyond = values[:, -1:] + more * (values[:, -1:] - values[:, -2:-1])
    return np.concatenate([values, beyond], axis=1)
