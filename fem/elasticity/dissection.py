"""Nested groups of a sector's elements, and the unknowns that each of them eliminates: no number of the stiffness.

The elements are halved again and again across the longer side of the region that they fill. In a group of few
elements the nodes that no other element has are eliminated, then in each union of two groups those that only these two
have, up to the whole sector, where the cuts are left (nested dissection: A. George, SIAM J. Numer. Anal. 10, 1973,
doi:10.1137/0710032). Waves along the face share the groups of their mesh.
"""

from __future__ import annotations

import numpy as np

from base import Array, Integers, record

__all__ = ["Dissection", "Group", "Half", "dissection", "unknowns_of"]

FEW, LEAST = 32, 4
"""Elements of a group that is not halved, of two unknowns at a node, and the smallest of them with more unknowns."""


LONG = 32
"""Mean unknowns of neighbouring nodes from which on matrices are added block by block."""


@record
class Half:
    """Where the unknowns that a half leaves are among those of the whole.

    Attributes
    ----------
    unknowns : (n,) array of int
    runs : tuple of (slice, slice), optional
        Of neighbours, in the whole and in the half, where these are long.
    """

    unknowns: Integers
    runs: tuple[tuple[slice, slice], ...] | None


@record
class Group:
    """Elements that are taken together: a few, or two halves.

    Attributes
    ----------
    done, shared : arrays of int
        Unknowns of the sector that the group eliminates, and those that it leaves.
    size : int
        Of its matrix, whose rows are those eliminated, those left, and those on the hub.
    members : (m,) array of int
        Elements; none where there are halves.
    places : (m, 6 components) array of int
        Of the elements' unknowns in the matrix.
    halves : tuple of Half
    """

    done: Integers
    shared: Integers
    size: int
    members: Integers
    places: Integers
    halves: tuple[Half, ...]


@record
class Dissection:
    """Groups of a sector's elements.

    Attributes
    ----------
    groups : tuple of Group
        From the smallest up: both halves of a group stand before it, the second one last.
    cut : (cut,) array of int
        Unknowns on the cuts, in the order that is wanted.
    left : (cut,) array of int
        Their places among those that the last group leaves.
    """

    groups: tuple[Group, ...]
    cut: Integers
    left: Integers


@record
class _Shared:
    """Nodes that a group of elements shares with others, in order of their numbers, and how many of it have each."""

    nodes: Integers
    used: Integers


def dissection(
    points: Array, triangles: Integers, cut: Integers, hub: Integers, components: int = 2
) -> Dissection:
    """Divide a sector's elements.

    Parameters
    ----------
    points : (n, 2) array
        Nodes.
    triangles : (m, 6) array
    cut, hub : index arrays
        Nodes on the cuts, in the order that is wanted, and held ones.
    components : int
        Displacements of a node.
    """
    users = np.bincount(triangles.ravel(), minlength=len(points))
    users[cut] += 1  # never all in one group
    users[hub] = 0
    middles = points[triangles[:, :3]].mean(axis=1)
    number = np.empty(len(points), dtype=np.int64)  # of each node in the group at work
    groups: list[Group] = []
    none = np.zeros(0, dtype=np.int64)

    def ordered(times: Integers) -> tuple[Integers, tuple[int, int]]:
        nodes = np.flatnonzero(times)
        order, ends = _order(users[nodes], times[nodes])
        nodes = nodes[order]
        number[nodes] = np.arange(len(nodes))
        return nodes, ends

    def few(members: Integers) -> _Shared:
        times = np.bincount(triangles[members].ravel())
        nodes, ends = ordered(times)
        places = unknowns_of(number[triangles[members].ravel()], components).reshape(len(members), -1)
        return added(nodes, times, ends, members, places, ())

    def merged(first: _Shared, second: _Shared) -> _Shared:
        times = np.zeros(len(points), dtype=np.int64)
        for part in (first, second):
            times[part.nodes] += part.used
        nodes, ends = ordered(times)
        halves = tuple(_half(number[part.nodes], components) for part in (first, second))
        return added(nodes, times, ends, none, none, halves)

    def added(
        nodes: Integers,
        times: Integers,
        ends: tuple[int, int],
        members: Integers,
        places: Integers,
        halves: tuple[Half, ...],
    ) -> _Shared:
        kept = nodes[ends[0] : ends[1]]
        done, shared = (_kept(unknowns_of(each, components)) for each in (nodes[: ends[0]], kept))
        groups.append(Group(done, shared, components * len(nodes), members, places, halves))
        return _Shared(kept, times[kept])

    def group(members: Integers) -> _Shared:
        if len(members) <= max(LEAST, 2 * FEW // components):
            return few(members)
        place = middles[members]
        along = place[:, int(np.argmax(np.ptp(place, axis=0)))]
        order = np.argpartition(along, len(members) // 2)
        return merged(group(members[order[: len(members) // 2]]), group(members[order[len(members) // 2 :]]))

    whole = group(np.arange(len(triangles)))
    number[whole.nodes] = np.arange(len(whole.nodes))
    left = _kept(unknowns_of(number[cut], components))
    return Dissection(tuple(groups), _kept(unknowns_of(cut, components)), left)


def _half(nodes: Integers, components: int) -> Half:
    """Places of the nodes that a half leaves, as blocks of neighbours where they are long."""
    starts = np.append(0, np.flatnonzero(nodes[1:] - nodes[:-1] != 1) + 1)
    ends = np.append(starts[1:], len(nodes))
    unknowns = unknowns_of(nodes, components)
    if LONG * len(starts) > len(unknowns):
        return Half(unknowns, None)
    first, low, high = (components * each for each in (nodes[starts], starts, ends))
    runs = [
        (slice(at, at + b - a), slice(a, b))
        for at, a, b in zip(first.tolist(), low.tolist(), high.tolist(), strict=True)
    ]
    return Half(unknowns, tuple(runs))


def _order(users: Integers, used: Integers) -> tuple[Integers, tuple[int, int]]:
    """Order that puts nodes of this group alone first and held ones last, and where the first two kinds end."""
    kind = np.where(users == 0, 2, np.where(used == users, 0, 1))
    order = np.argsort(kind, kind="stable")
    first, second, _ = np.bincount(kind, minlength=3)
    return order, (int(first), int(first + second))


def _kept(unknowns: Integers) -> Integers:
    """Unknowns that many condensations share: nobody can change them."""
    unknowns.flags.writeable = False
    return unknowns


def unknowns_of(nodes: Integers, components: int = 2) -> Integers:
    """Unknowns of nodes, one after the other (components n,)."""
    unknowns: Integers = (components * nodes[:, None] + np.arange(components)).ravel()
    return unknowns
