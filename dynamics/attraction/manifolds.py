"""Stable and unstable manifolds of periodic orbits; the inverse of the period map that the stable ones need."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Stopwatch, quantity, record
from dynamics.flow.exact_flow import ExactFlow, tabulated
from dynamics.flow.flows import flow_of
from dynamics.flow.motions import period_map
from dynamics.flow.protocol import Flow, propagated
from dynamics.model.limits import POSITIVE
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import Oscillator
from dynamics.model.reasons import FLOW
from dynamics.model.states import Region, within
from dynamics.orbits.shooting import Orbit, multipliers_of

FIRST = 1e-6  # of the size of the orbit: where a manifold starts, on the eigenvector
ROUNDS = 2000  # of a manifold at most
SPLIT = 1e-12  # minimum gap of the start's parameter that is still halved


@record
class Manifold:
    """A manifold of a periodic orbit in the plane tau = 0."""

    no_error = FLOW

    headline = ("kind", "message")

    orbit: Orbit = quantity("", "the saddle")
    kind: str = quantity("", "stable or unstable")
    curves: tuple[Array, ...] = quantity(
        "1",
        "states along every branch, shape (any, dimension), from the orbit outwards: two for each point of the orbit",
    )
    rounds: tuple[int, ...] = quantity("1", "rounds of the orbit that carried each branch out", "branch")
    error: float = quantity(
        "1",
        "bend of the first stretches, over the size of the orbit: by how much images depart from the eigenvector",
    )
    cost: Cost
    converged: bool = quantity("1", "whether all gaps within the region are within the spacing")
    message: str = quantity("", "why the branches ended")


def is_saddle(multipliers: npt.ArrayLike) -> bool:
    """Whether one real multiplier is outside the unit circle and all others within."""
    first, *others = np.asarray(multipliers, dtype=np.complex128).tolist()
    return bool(first.imag == 0.0 and abs(first) > 1.0 > max(map(abs, others)))


def is_direct_saddle(multipliers: npt.ArrayLike) -> bool:
    """Whether one multiplier is above 1 and all others within the unit circle."""
    return is_saddle(multipliers) and bool(np.real(np.asarray(multipliers)[0]) > 1.0)


def reversed_tables(oscillator: GearOscillator) -> ExactFlow:
    """Tabulate the oscillator that runs backwards in time.

    With time and speed reversed about tau = 0 the equation keeps its form; the damping and all phases change their
    signs. So the inverse of the period map is as exact as the map: carry (X, -V) and reverse V again.
    """
    packed = oscillator.packed()
    for name in oscillator.parameters:
        if "damping" in name or "phase" in name:
            packed[oscillator.places(name)] *= -1.0
    cells = math.ceil(oscillator.cells)
    return tabulated(packed, cells)


def manifold(
    orbit: Orbit,
    kind: str = "stable",
    region: Region | None = None,
    *,
    length: float = 20.0,
    spacing: float = 0.02,
    max_points: int = 20_000,
) -> Manifold:
    """Follow the manifolds of a saddle.

    A branch starts as a short stretch of the eigenvector, from a point to its image, and is carried on by the map
    (its inverse for the stable manifold). Where neighbours lie farther apart than the spacing, points are put
    between them at the start and carried along.

    The stable manifold is that of a pair alone: it takes the flow backwards in time, which a `GearOscillator` has, and
    in several freedoms it is no curve. The unstable one is a curve in any number of freedoms.

    Parameters
    ----------
    orbit : Orbit
        A saddle: one multiplier outside the unit circle, all others within.
    kind : str
        "stable": the motions that reach the orbit, which bound basins; "unstable": those that leave it.
    region : ((x0, x1), (v0, v1)), optional
        Of X and V, in several freedoms y and its rate; outside it points are not put closer. Left out: three times the
        size of the orbit.
    length : float
        Length of each branch, over the size of the orbit.
    spacing : float
        Largest distance of neighbours, over the size of the orbit.
    max_points : int
        Points of each branch at most.

    Returns
    -------
    Manifold
        Its branches.

    Raises
    ------
    InputError
        If the orbit is no saddle, its stable manifold no curve, or an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, find_orbits, manifold
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> saddle = next(orbit for orbit in find_orbits(osc, (1,)).orbits if not orbit.stable)
    >>> manifold(saddle, "stable", length=3.0).message
    '2 branches ended: length'
    """
    watch = Stopwatch()
    with Faults() as faults:
        if kind not in ("stable", "unstable"):
            faults.add("kind", kind, "must be 'stable' or 'unstable'", "name one of these")
        if not orbit.converged or not is_saddle(orbit.multipliers):
            faults.add(
                "orbit",
                orbit.label or "not converged",
                "must be a saddle",
                "take an unstable orbit of find_orbits",
            )
        _check_backwards(faults, orbit.oscillator, kind)
        long = faults.number("length", length, replace(POSITIVE, remedy="20 is usual"))
        gap = faults.number("spacing", spacing, replace(POSITIVE, remedy="0.02 is usual"))
        most = faults.whole("max_points", max_points, 10, 10**7, "20 000 is usual")
    grower = _Grower(orbit, kind == "stable", region, long, gap, most)
    grown = [
        grower.grow(point, sign * along)
        for point in np.roll(orbit.points, 1, axis=0)
        for along in (grower.direction(point),)
        for sign in (1.0, -1.0)
    ]
    curves, rounds, ended, errors = zip(*grown, strict=True)
    message = ", ".join(f"{ended.count(why)} branches ended: {why}" for why in sorted(set(ended)))
    cost = Cost(watch.seconds, 2, 0, grower.periods)
    fine = all(why in ("length", "left the region") for why in ended)
    return Manifold(orbit, kind, curves, rounds, max(errors), cost, fine, message)


def _check_backwards(faults: Faults, oscillator: Oscillator, kind: str) -> None:
    """Note where a stable manifold is no curve, or the flow that would carry it out is missing."""
    if kind != "stable" or oscillator.is_exact:
        return
    many = oscillator.directions - 1
    lacking = (
        "its flow backwards in time is missing" if many == 1 else f"it is no curve: it has {many} dimensions"
    )
    allowed = f"must be 'unstable' for a {type(oscillator).__name__}: the stable manifold cannot be followed, {lacking}"
    faults.add("kind", kind, allowed, "basin_boundary shows where it cuts a plane")


class _Grower:
    """Carries branches of the manifolds of one orbit."""

    def __init__(
        self, orbit: Orbit, backwards: bool, region: Region | None, length: float, gap: float, most: int
    ) -> None:
        self.orbit, self.backwards = orbit, backwards
        self.forward: Flow = flow_of(orbit.oscillator)
        self.table = reversed_tables(orbit.oscillator) if backwards else self.forward
        self.scale = max(float(np.max(np.abs(self._in_plane(orbit.points)))), 1e-300)
        box = 3.0 * self.scale
        self.region = ((-box, box), (-box, box)) if region is None else region
        self.length, self.gap, self.most = length * self.scale, gap * self.scale, most
        multiplier = float(np.real(orbit.multipliers[1 if backwards else 0]))
        self.round = orbit.periods * (1 if multiplier > 0.0 else 2)  # two rounds come back to the same branch
        stretch = multiplier if multiplier > 0.0 else multiplier * multiplier
        self.stretch = 1.0 / stretch if backwards else stretch
        self.periods = 0

    def direction(self, point: Array) -> Array:
        """Eigenvector at a point of the orbit, from its exact multiplier."""
        n = self.orbit.periods
        image = period_map(self.forward, point, n)
        jacobian = image.jacobian
        multipliers = multipliers_of(jacobian, math.exp(image.log_determinant))
        wanted = float(np.real(multipliers[1 if self.backwards else 0]))
        return np.asarray(np.linalg.svd(jacobian - wanted * np.eye(len(jacobian)))[2][-1])

    def grow(self, point: Array, along: Array) -> tuple[Array, int, str, float]:
        """Curve, rounds, why it ended, and the bend of its first stretch."""

        def images(share: Array, rounds: int, first: float = FIRST * self.scale) -> Array:
            return self._carry(point + np.outer(first * self.stretch**share, along), rounds)

        share = np.linspace(0.0, 1.0, 9)
        at = images(share, 0)
        halved = images(share, 1, 0.5 * FIRST * self.scale)
        error = float(np.max(np.abs((self._carry(at, 1) - point) - 2.0 * (halved - point)))) / self.scale
        curves, total, number, count = [point[None]], 0.0, 0, 0
        while True:
            step = np.linalg.norm(np.diff(at, axis=0), axis=1)
            inside = within(self.region, self._in_plane(at))
            total += float(np.sum(step[inside[:-1] & inside[1:]]))
            count += len(at)
            curves.append(at)
            reasons = {
                "left the region": not np.any(inside),
                "length": total > self.length,
                f"{self.most} points: raise max_points": count > self.most,
                f"{ROUNDS} rounds": number > ROUNDS,
            }
            if any(reasons.values()):
                ended = next(why for why, holds in reasons.items() if holds)
                return np.concatenate(curves), number, ended, error
            number += 1
            share, at = self._refined(partial(images, rounds=number), share, self._carry(at, 1))

    def _refined(self, images: Callable[[Array], Array], share: Array, at: Array) -> tuple[Array, Array]:
        """Starts and their images with gaps within the spacing."""
        while True:
            step = np.linalg.norm(np.diff(at, axis=0), axis=1)
            inside = within(self.region, self._in_plane(at))
            wide = (step > self.gap) & (inside[:-1] | inside[1:]) & (np.diff(share) > SPLIT)
            if not np.any(wide) or len(at) > self.most:
                return share, at
            positions = np.flatnonzero(wide)
            middle = 0.5 * (share[positions] + share[positions + 1])
            share, at = (
                np.insert(share, positions + 1, middle),
                np.insert(at, positions + 1, images(middle), axis=0),
            )

    def _in_plane(self, at: Array) -> Array:
        plane: Array = self.orbit.oscillator.in_plane(at)
        return plane

    def _carry(self, at: Array, rounds: int) -> Array:
        self.periods += len(at) * rounds * self.round
        return propagated(self.table, at, rounds * self.round, self.backwards) if rounds else at
