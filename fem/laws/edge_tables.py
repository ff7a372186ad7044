"""Laws of a pair's tip edges, kept by place: pitches and torques ask for the same ones, on each mesh of an estimate."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, record
from fem.influence.memo import Memo
from fem.laws.local_law import Table
from fem.laws.place_surface import PlaceSurface, place_surface, slid
from fem.laws.tip_contact import edge_laws

if TYPE_CHECKING:
    from fem.laws.contact_candidates import ContactCandidates
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["EdgeTables", "edge_tables"]

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
    smooth : (n,) boolean array
    """

    key: Array
    force: Array
    approach: Array
    largest: Array
    smooth: Booleans

    def _nearest(self, key: Array) -> Integers:
        """Laws whose places are nearest; there is at least one."""
        after = np.clip(np.searchsorted(self.key, key), 1, max(len(self.key) - 1, 1))
        before, after = after - 1, np.minimum(after, len(self.key) - 1)
        return np.where(key - self.key[before] <= self.key[after] - key, before, after)

    def has(self, key: Array) -> Booleans:
        """Whether the law of each place is here, or of one that rounding has put beside it."""
        if not len(self.key):
            return np.zeros(len(key), dtype=bool)
        known: Booleans = np.abs(self.key[self._nearest(key)] - key) <= 1.0
        return known

    def rows(self, key: Array) -> _Laws:
        """Laws of places that are here."""
        return self._part(self._nearest(key))

    def joined(self, other: _Laws) -> _Laws:
        """These and others."""
        columns = [(getattr(self, field.name), getattr(other, field.name)) for field in fields(self)]
        laws = _Laws(*(np.concatenate(pair) for pair in columns))
        return laws._part(np.argsort(laws.key))

    def _part(self, rows: Integers) -> _Laws:
        return _Laws(*(getattr(self, field.name)[rows] for field in fields(self)))


class EdgeTables:
    """Laws of all tip edges of a pair by the place of the contact.

    Parameters
    ----------
    setup : MeshSetup
        At any positions: what counts is how the gears are set up.
    bodies : PairCompliance
        On any of its meshes that share the answer of the tips; others have separate tables (`serving`).
    """

    def __init__(self, setup: MeshSetup, bodies: PairCompliance) -> None:
        self.setup, self.bodies = setup, bodies
        self._kept: dict[int, _Laws] = {}
        self._other: EdgeTables | None = None

    def serving(self, bodies: PairCompliance) -> EdgeTables:
        """Tables of the same pair with the tips of other bodies: these, or others that are kept here as well."""
        strips = bodies.tip_strips
        if bodies is self.bodies or strips is None or strips is self.bodies.tips:
            return self
        if self._other is None or self._other.bodies.tip_strips is not strips:
            self._other = EdgeTables(self.setup, bodies)
        return self._other

    def at(
        self, candidates: ContactCandidates, slid: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[Table | None, Array]:
        """Laws of all tip edges in row-major order, and the largest forces kappa F that they cover [N].

        What strips ``slid`` on pinion and wheel is given back (``fem.laws.cut_off``).
        """
        if not candidates.edge.any():
            return None, np.zeros(0)
        by_corner = [
            (chosen, self._laws(corner, candidates.place[chosen], slid[corner]))
            for corner, chosen in candidates.corners()
        ]
        points = max(laws.force.shape[1] for _, laws in by_corner)
        order = np.argsort(np.concatenate([np.flatnonzero(chosen) for chosen, _ in by_corner]))
        force, approach = (
            np.concatenate([_extended(values, points) for values in columns])[order]
            for columns in ([laws.force for _, laws in by_corner], [laws.approach for _, laws in by_corner])
        )
        largest = np.concatenate([laws.largest for _, laws in by_corner])[order]
        smooth = np.concatenate([laws.smooth for _, laws in by_corner])[order]
        return Table.through(force, approach, smooth), largest

    @cached_property
    def slid(self) -> tuple[float, float]:
        """What strips slide on the teeth of pinion and wheel, for contacts that move."""
        return slid(self.bodies)

    @cached_property
    def surfaces(self) -> tuple[PlaceSurface, PlaceSurface]:
        """Laws beside the corners of pinion and wheel over place and force, for contacts that move."""
        first, second = (
            place_surface(self.setup, self.bodies, corner, self.slid[corner]) for corner in (0, 1)
        )
        return first, second

    def _laws(self, corner: int, place: Array, slid: float) -> _Laws:
        """Laws of one gear's tip at places (n,) [m]; those that are known are not computed again."""
        laws = self._held(corner, place)
        return laws if slid == 0.0 else replace(laws, approach=laws.approach + 3 * slid * laws.force**2)

    def _held(self, corner: int, place: Array) -> _Laws:
        key = np.round(place / (APART * self.setup.pair.base_pitch))
        known = self._kept.get(corner)
        if known is None or len(known.key) > MOST:
            known = self._computed(corner, key, place)
        elif not (here := known.has(key)).all():
            known = known.joined(self._computed(corner, key[~here], place[~here]))
        self._kept[corner] = known
        return known.rows(key)

    def _computed(self, corner: int, key: Array, place: Array) -> _Laws:
        key, first = np.unique(key, return_index=True)
        apart = np.diff(key, prepend=-np.inf) > 1.0  # what rounding has parted is one place
        key, first = key[apart], first[apart]
        setup, bodies = self.setup, self.bodies
        touched = (bodies.pinion, bodies.wheel)[1 - corner].law
        tips = bodies.tips[corner]
        law = edge_laws(setup.pair, tips, corner, place[first], touched, setup.rounds[corner], setup.removed)
        return _Laws(key, law.force, law.approach - law.approach[:, :1], law.largest, law.smooth)


_TABLES: Memo[EdgeTables] = Memo(4)


def edge_tables(setup: MeshSetup, bodies: PairCompliance) -> EdgeTables:
    """Tables of a face set up likewise, with what loads before have left in them; new ones of flanks with relief.

    Parameters
    ----------
    setup : MeshSetup
    bodies : PairCompliance
        The very record: tables that are kept hold theirs, so that no other one can take its place.
    """
    if setup.removed is not None or setup.face.even_load:
        return EdgeTables(setup, bodies)
    return _TABLES.obtain((id(bodies), setup.rounds), lambda: EdgeTables(setup, bodies))


def _extended(values: Array, points: int) -> Array:
    """Rows continued in a straight line to a number of points."""
    more = np.arange(1, points - values.shape[1] + 1)
    beyond = values[:, -1:] + more * (values[:, -1:] - values[:, -2:-1])
    return np.concatenate([values, beyond], axis=1)
