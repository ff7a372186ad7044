"""Shape functions of the second-order triangle: corners 0 1 2, then the middles of 01, 12 and 20."""

from __future__ import annotations

import numpy as np

from base import Array

NODES: Array = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
"""Reference coordinates of the six nodes."""


def shape(xi: Array, eta: Array) -> Array:
    """Evaluate the shape functions (..., 6) at reference coordinates."""
    corners = np.stack([1 - xi - eta, xi, eta], axis=-1)
    middles = 4 * corners * np.roll(corners, -1, axis=-1)
    return np.concatenate([corners * (2 * corners - 1), middles], axis=-1)


def shape_gradients(xi: Array, eta: Array) -> Array:
    """Differentiate the shape functions by the reference coordinates (..., 6, 2)."""
    l0 = 1 - xi - eta
    zero = np.zeros_like(xi)
    d_xi = np.stack([1 - 4 * l0, 4 * xi - 1, zero, 4 * (l0 - xi), 4 * eta, -4 * eta], axis=-1)
    d_eta = np.stack([1 - 4 * l0, zero, 4 * eta - 1, -4 * xi, 4 * xi, 4 * (l0 - eta)], axis=-1)
    return np.stack([d_xi, d_eta], axis=-1)
