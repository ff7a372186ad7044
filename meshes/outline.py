"""Outline of one tooth sector: exact curves, each cut into edges of the wished length.

A sector is one pitch of the gear, its tooth along +y and the gear's axis at the origin. The outline is run
through anticlockwise, with the material on the left hand: up the right side (x > 0), over the tooth, down the
left side and back along the bottom arc. Every edge keeps the parameters of its ends on its curve, so that
mid-side nodes and nodes of refined meshes can be put on the exact curve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Faults, Limit
from gears.tooth.rotation import polar

if TYPE_CHECKING:
    from gears import ToothProfile


_LENGTH = Limit.above(0.0, unit="modules", remedy="give a positive edge length")
_LIMITS = dict.fromkeys(("flank", "fillet", "root", "top", "corner", "rim", "growth"), _LENGTH) | {
    "layer_growth": Limit(1.0, remedy="layers grow towards the bore")
}


OFF_MIDDLE, HALVINGS = 0.1, 40


@dataclass(frozen=True)
class Sizes:
    """Wished lengths of element edges, in modules, and how fast they may grow.

    Attributes
    ----------
    flank, fillet, root, top : float
        Edge lengths on the flanks, fillets, root arcs and the top land.
    corner : float
        Edge length at the tip corner of the working flank: the displacement under a load near the corner
        changes over the load's distance from it.
    rim : float
        Edge length at the bottom of the part that gmsh meshes.
    growth : float
        Growth of the edge length per length away from the corner.
    layer_growth : float
        Ratio of the heights of successive layers between the rim and the bore.
    """

    flank: float = 1.0
    fillet: float = 0.21
    root: float = 0.3
    top: float = 1.0
    corner: float = 0.0135
    rim: float = 1.2
    growth: float = 0.69
    layer_growth: float = 1.4

    def __post_init__(self) -> None:
        """Refuse lengths that are not positive."""
        Faults.of(self, _LIMITS, "sizes.").raise_if_any()

    def scaled(self, factor: float) -> Sizes:
        """Sizes of a similar mesh with all edges longer by a factor."""
        lengths = {name: value * factor for name, value in vars(self).items() if name != "layer_growth"}
        return Sizes(**lengths, layer_growth=self.layer_growth**factor)


@dataclass(frozen=True)
class Curve:
    """One named piece of the outline.

    Attributes
    ----------
    name : str
        ``side_right``, ``root_right``, ``fillet_right``, ``flank_right``, ``chamfer_right``, ``top`` and so
        on down the left; ``bottom`` is the arc under the sector.
    start, end : float
        Parameters where the anticlockwise run enters and leaves the curve: arc length from the base circle,
        rho^2/(2 r_b) [m], on
        flanks, t on fillets and chamfers, polar angle from the centre line [rad] on arcs, radius [m]
        on sides.
    at : callable
        Points (n, 2) [m] at parameters (n,).
    size : callable
        Wished edge length [m] at points (n, 2).
    """

    name: str
    start: float
    end: float
    at: Callable[[Array], Array]
    size: Callable[[Array], Array]

    def middles(self, ends: Array) -> Array:
        """Parameters in the middle of pieces, given those of their ends (n, 2).

        The mean of both, unless that is off the middle by more than `OFF_MIDDLE` of the chord, as where a fillet's
        parameter runs unevenly: a node a quarter of an edge off its middle folds the element. Then it is as far from
        either end.
        """
        low, high = np.array(ends, dtype=float).T
        first, last = self.at(low), self.at(high)

        def farther(middle: Array) -> Array:
            """How far a point is beyond the middle of the chord, along it and over it."""
            off = self.at(middle) - 0.5 * (first + last)
            chord = last - first
            return np.asarray(np.sum(off * chord, axis=1) / np.sum(chord * chord, axis=1))

        means = 0.5 * (low + high)
        uneven = np.abs(farther(means)) > OFF_MIDDLE
        if not uneven.any():
            return np.asarray(means)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            beyond = farther(middle) > 0.0
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return np.asarray(np.where(uneven, 0.5 * (low + high), means))

    def scaled(self, factor: float) -> Curve:
        """Curve of a gear that is larger by a factor; a parameter that is a length grows with it."""
        stretch = factor if self.name.startswith(("flank", "side")) else 1.0
        return Curve(
            self.name,
            self.start * stretch,
            self.end * stretch,
            lambda t: factor * self.at(t / stretch),
            lambda points: factor * self.size(points / factor),
        )


def arc(name: str, radius: float, start: float, end: float, size: Callable[[Array], Array]) -> Curve:
    """Curve about the gear's axis, between polar angles [rad]."""
    return Curve(name, start, end, lambda angle: polar(radius, angle), size)


def cut(curve: Curve, samples: int = 400) -> Array:
    """Parameters of the nodes on a curve: the edge length follows ``curve.size``.

    The number of edges is the integral of ds/size, rounded up, and each edge gets an equal part of it.
    """
    # the ends sampled densely: the size may fall by two decades towards the tip corner
    s = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, samples))
    t = curve.start + (curve.end - curve.start) * s
    points = curve.at(t)
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    wished = curve.size(0.5 * (points[1:] + points[:-1]))
    count = np.concatenate([[0.0], np.cumsum(step / wished)])
    edges = max(1, int(np.ceil(count[-1] - 1e-9)))
    cuts = np.interp(np.linspace(0.0, count[-1], edges + 1), count, t)
    cuts[0], cuts[-1] = curve.start, curve.end
    return cuts


def sector_curves(
    profile: ToothProfile, sizes: Sizes, bottom_radius: float, working: str = "left"
) -> tuple[Curve, ...]:
    """Curves of the outline in anticlockwise order, from ``bottom_radius`` up over the tooth.

    Parameters
    ----------
    profile : gears.ToothProfile
    sizes : Sizes
    bottom_radius : float
        Radius of the arc under the sector [m]: the bore, or the rim's bottom where layers follow.
    working : {"left", "right"}
        The loaded flank, whose tip corner is meshed finely.

    Returns
    -------
    tuple of Curve
    """
    m, half_pitch = profile.module, 0.5 * profile.pitch_angle
    mirror = np.array([-1.0, 1.0])
    corner = profile.involute(np.array([profile.flank_rho[1]]))[0]
    corner = corner if working == "right" else corner * mirror

    def constant(length: float) -> Callable[[Array], Array]:
        def size(points: Array) -> Array:
            away = np.linalg.norm(points - corner, axis=-1)
            return np.asarray(np.minimum(length * m, sizes.corner * m + sizes.growth * away))

        return size

    def curved(points: Array) -> Array:
        # towards the base circle the involute bends more and more, on the scale of the arc length from there
        arc = np.maximum(np.sum(points**2, axis=-1) / profile.base_radius - profile.base_radius, 0.0) / 2
        return np.asarray(np.minimum(constant(sizes.flank)(points), np.maximum(arc, sizes.corner * m)))

    def turning(points: Array) -> Array:
        # a fillet edge turns by no more than about half a radian at its tightest place
        tangent = np.gradient(points, axis=0)
        turn = np.abs(np.gradient(np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0]))))
        radius = np.linalg.norm(tangent, axis=1) / np.maximum(turn, 1e-12)
        limit: Array = sizes.fillet * np.minimum(m, 2.0 * np.maximum(radius, 0.02 * m))
        return limit

    # stresses fall off from a tight fillet over its radius: lengths may only grow with the distance from it
    tight = profile.fillet(np.linspace(0.0, 1.0, 60))
    tightness = turning(tight)

    def graded(size: Callable[[Array], Array]) -> Callable[[Array], Array]:
        def smaller(points: Array) -> Array:
            x, y = np.abs(points[..., :1]) - tight[:, 0], points[..., 1:] - tight[:, 1]
            away = np.sqrt(x * x + y * y)
            return np.asarray(np.minimum(size(points), np.min(tightness + sizes.growth * away, axis=-1)))

        return smaller

    def side(points: Array) -> Array:
        deep = (profile.root_radius - np.linalg.norm(points, axis=-1)) / m
        edge: Array = m * np.minimum(sizes.root + 0.45 * np.maximum(deep, 0.0), sizes.rim)
        return edge

    rho_form, rho_end = profile.flank_rho
    right: list[Curve] = [
        Curve("side_right", bottom_radius, profile.root_radius, lambda r: polar(r, half_pitch), graded(side))
    ]
    if (half_pitch - profile.root_half_angle) * profile.root_radius > 1e-6 * m:
        ends = half_pitch, profile.root_half_angle
        right.append(arc("root_right", profile.root_radius, *ends, graded(constant(sizes.root))))
    right.append(Curve("fillet_right", 0.0, 1.0, profile.fillet, graded(constant(sizes.fillet))))
    base2 = 2.0 * profile.base_radius

    def involute(arc: Array) -> Array:
        return np.asarray(profile.involute(np.sqrt(base2 * np.maximum(arc, 0.0))))

    right.append(Curve("flank_right", rho_form**2 / base2, rho_end**2 / base2, involute, graded(curved)))
    if profile.flank_end_radius < profile.tip_radius * (1 - 1e-12):
        right.append(Curve("chamfer_right", 0.0, 1.0, profile.chamfer, constant(sizes.top)))

    def mirrored(curve: Curve) -> Curve:
        def at(t: Array, original: Callable[[Array], Array] = curve.at) -> Array:
            return np.asarray(original(t) * mirror)

        return Curve(curve.name.replace("right", "left"), curve.end, curve.start, at, curve.size)

    land = profile.tip_half_angle
    top = arc("top", profile.tip_radius, land, -land, constant(sizes.top))
    # a rim thinner than 1.7 modules bends: its edges are shorter in proportion
    thin = min(1.0, 0.6 * (profile.root_radius - bottom_radius) / m)
    bottom_edges = max(3, int(np.ceil(profile.pitch_angle * bottom_radius / (sizes.rim * m * thin) - 1e-9)))
    edge = profile.pitch_angle * bottom_radius / bottom_edges
    bottom = arc("bottom", bottom_radius, -half_pitch, half_pitch, lambda points: np.full(len(points), edge))
    return (*right, top, *(mirrored(curve) for curve in reversed(right)), bottom)


def crossing(points: Array) -> tuple[int, int] | None:
    """First pair of edges of a closed polygon that cut each other; None when it is simple."""
    a, b = points, np.roll(points, -1, axis=0)

    def turn(p: Array, q: Array, r: Array) -> Any:
        d, e = q - p, r - p
        return d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0]

    a1, b1, a2, b2 = a[:, None], b[:, None], a[None], b[None]
    cuts = (turn(a1, b1, a2) * turn(a1, b1, b2) < 0) & (turn(a2, b2, a1) * turn(a2, b2, b1) < 0)
    hits = np.argwhere(cuts)
    return None if len(hits) == 0 else (int(hits[0, 0]), int(hits[0, 1]))
