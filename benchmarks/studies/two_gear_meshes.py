"""Second-order mesh of a tooth sector with fine places and perhaps a rounded tip corner, for the two-gear model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from meshes import SectorMesh
from meshes.gmsh_fill import triangulate
from meshes.outline import Curve, cut, sector_curves

MIRROR = np.array([-1.0, 1.0])


@dataclass(frozen=True)
class Focus:
    """Fine elements about a point of a tooth's outline: size h up to a distance w, growing from there."""

    point: np.ndarray
    h: float
    w: float


def rounded(profile, radius):
    """Circle of a radius tangent to the left flank and the tip circle: its curve, the flank's end, the top's."""
    inside = profile.tip_radius - radius

    def miss(rho):
        centre = profile.involute(rho) - radius * profile.normal(rho)
        return np.linalg.norm(centre) - inside

    low, high = profile.flank_rho
    rho = brentq(miss, 0.5 * (low + high), high, xtol=1e-16)
    centre = (profile.involute(rho) - radius * profile.normal(rho)) * MIRROR
    end = (profile.normal(rho)) * MIRROR
    first, last = np.arctan2(centre[0], centre[1]), np.arctan2(end[0], end[1])

    def at(angle):
        return centre + radius * np.stack([np.sin(angle), np.cos(angle)], axis=-1)

    return at, (first, last), rho**2 / (2 * profile.base_radius), first


def tooth_curves(profile, sizes, foci, radius, growth):
    """Outline of a sector down to the bore, with a rounded left tip corner and fine places."""
    curves = list(sector_curves(profile, sizes, profile.bore_radius))
    if radius > 0:
        at, (first, last), arc, top = rounded(profile, radius)
        names = [curve.name for curve in curves]
        i, k = names.index("top"), names.index("flank_left")
        curves[i], curves[k] = replace(curves[i], end=top), replace(curves[k], start=arc)
        curves.insert(
            k, Curve("round_left", first, last, at, lambda p: np.full(len(p), sizes.top * profile.module))
        )

    def finer(curve):
        def size(points):
            wished = curve.size(points)
            for focus in foci:
                away = np.linalg.norm(points - focus.point, axis=-1)
                wished = np.minimum(wished, focus.h + growth * np.maximum(away - focus.w, 0.0))
            return wished

        return replace(curve, size=size)

    return [
        finer(c) if c.name.startswith(("flank_left", "round", "top", "fillet_left")) else c for c in curves
    ]


def sector(profile, sizes, foci=(), radius=0.0, growth=0.15):
    """Second-order mesh of a sector, boundary middles on the exact curves."""
    curves = tooth_curves(profile, sizes, foci, radius, growth)
    cuts = [cut(curve, 4000) for curve in curves]
    outline = np.concatenate([curve.at(t[:-1]) for curve, t in zip(curves, cuts, strict=True)])
    corners, triangles = triangulate(outline)
    count = len(corners)
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    keys, inverse = np.unique(sides[..., 0] * count + sides[..., 1], return_inverse=True)
    low, high = np.divmod(keys, count)
    points = np.concatenate([corners, 0.5 * (corners[low] + corners[high])])
    facets, parameters, first = {}, {}, 0
    for curve, t in zip(curves, cuts, strict=True):
        ends = np.stack([first + np.arange(len(t) - 1), first + 1 + np.arange(len(t) - 1)], axis=1) % len(
            outline
        )
        middle = count + np.searchsorted(keys, ends.min(axis=1) * count + ends.max(axis=1))
        points[middle] = curve.at(0.5 * (t[1:] + t[:-1]))
        name = "bore" if curve.name == "bottom" else curve.name
        facets[name], parameters[name] = np.column_stack([ends, middle]), np.column_stack([t[:-1], t[1:]])
        first += len(t) - 1
    six = np.concatenate([triangles, count + inverse.reshape(-1, 3)], axis=1)
    named = {("bore" if curve.name == "bottom" else curve.name): curve for curve in curves}
    gear = (profile.teeth, profile.module, profile.base_radius)
    return SectorMesh(points, six, facets, parameters, named, *gear)
