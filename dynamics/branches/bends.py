"""How a period map bends: derivatives of its Jacobian and of what singles special orbits out, by the unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from base import Array
from dynamics.branches.branch_problem import MapPoint, match_extrema

# of the unknowns: central differences are then good to about 1e-9; the shorter ones beside impacts
ASIDE = (1e-6, 1e-8)
Sides = tuple[tuple[float, MapPoint], tuple[float, MapPoint]]


@dataclass(frozen=True, eq=False)
class Bend:
    """Derivatives by the unknowns, the state over the scale and each parameter over its range; nan where there is none.

    Parameters
    ----------
    first : ndarray, shape (size, size + m)
        Of the image of the state.
    second : ndarray, shape (size + m, size, size)
        Of the Jacobian.
    fold, flip, torus : ndarray, shape (size + m,)
        Of the products of the multipliers that vanish at special orbits, as of `MapPoint`.
    extrema : ndarray, shape (k, size + m)
        Of X at every extremum, over the scale.
    """

    first: Array
    second: Array
    fold: Array
    flip: Array
    torus: Array
    extrema: Array


class Course(Protocol):
    """What differences ask of a problem."""

    @property
    def scale(self) -> float:
        """Size of the motion."""

    def beside(self, point: MapPoint, change: Array) -> MapPoint | None:
        """Image of the unknowns of a point and a change of them; None if there is none."""

    def course(self, point: MapPoint) -> Sequence[int]:
        """Impacts on the way and the flanks at its ends: the map is smooth where they stay the same."""


def bend_by_differences(problem: Course, point: MapPoint) -> Bend:
    """Derivatives of a map of which the first are known alone: differences of its Jacobian and extrema."""
    size = len(point.u)
    second, products = np.full((size, point.size, point.size), np.nan), np.full((3, size), np.nan)
    first, extrema = np.full((point.size, size), np.nan), np.full((len(point.extrema), size), np.nan)
    first[:, : point.size] = point.jacobian
    for k, unit in enumerate(np.eye(size)):
        sides = _smooth_sides(problem, point, unit)
        if sides is None:
            continue
        weights = _weights(*(way for way, _ in sides))
        three = (*(beside for _, beside in sides), point)
        if k >= point.size:
            first[:, k] = sum(w * p.image for w, p in zip(weights, three, strict=True))
        second[k] = sum(w * p.jacobian for w, p in zip(weights, three, strict=True))
        for row, name in zip(products, ("fold", "flip", "torus"), strict=True):
            row[k] = sum(w * getattr(p, name) for w, p in zip(weights, three, strict=True))
        pairs = [dict(match_extrema(point, beside)) for _, beside in sides]
        for i in pairs[0].keys() & pairs[1].keys():
            heights = [p.extrema[j, 1] for (_, p), j in zip(sides, (pairs[0][i], pairs[1][i]), strict=True)]
            extrema[i, k] = np.dot(weights, [*heights, point.extrema[i, 1]]) / problem.scale
    fold, flip, torus = products
    return Bend(first, second, fold, flip, torus, extrema)


def _smooth_sides(problem: Course, point: MapPoint, unit: Array) -> Sides | None:
    """Two neighbours along one unknown with which the map is smooth: one on each side, or two on one side.

    Next to a grazing the sides differ by impacts; that with fewer of them has no square root.
    """
    for aside in ASIDE:
        near = [(way, problem.beside(point, way * unit)) for way in (aside, -aside)]
        there = [(way, beside) for way, beside in near if beside is not None]
        courses = [list(problem.course(beside)) for _, beside in there]
        if len(there) == 2 and courses[0] == courses[1]:
            return there[0], there[1]
        for way, beside in sorted(there, key=lambda side: sum(side[1].counts)):
            further = problem.beside(point, 2.0 * way * unit)
            if further is not None and problem.course(further) == problem.course(beside):
                return (way, beside), (2.0 * way, further)
    return None


def _weights(a: float, b: float) -> tuple[float, float, float]:
    """Weights of values at a, b and 0 in the slope at 0 of the parabola through them."""
    return -b / (a * (a - b)), -a / (b * (b - a)), -(a + b) / (a * b)
