"""Points and vectors in the plane of a gear: turned about its axis, mirrored at a tooth's centre line, polar."""

from __future__ import annotations

import math

import numpy as np

from base import Array


def turned(points: Array, angle: float) -> Array:
    """Points or vectors (n, 2) turned anticlockwise about the origin by `angle` [rad]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y = points[..., 0], points[..., 1]
    return np.stack((cosine * x - sine * y, sine * x + cosine * y), axis=-1)


def polar(radius: float | Array, angle: float | Array) -> Array:
    """Points (..., 2) at polar angles [rad] from a tooth's centre line +y, positive towards +x."""
    return np.stack(np.broadcast_arrays(radius * np.sin(angle), radius * np.cos(angle)), axis=-1)


def mirrored(points: Array) -> Array:
    """Left-hand counterpart of points or vectors (n, 2) of the right-hand side of a tooth."""
    return np.asarray(points * np.array([-1.0, 1.0]))
