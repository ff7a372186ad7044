from __future__ import annotations

import numpy as np
import pytest

import fem
from fem.elasticity.flamant import hertz_indentation


@pytest.fixture(scope="session")
def article_bodies(article_pair):
    return fem.compliance(article_pair)


def quadratic_ring(inner, outer, around, layers, curved=True):
    """A plain ring of P2 triangles, for exact solutions; nodes are shared, middles on the circles if curved.

    Returns points, triangles and the edges (first, last, middle) of the inner and the outer circle.
    """
    radii = inner * (outer / inner) ** (np.arange(2 * layers + 1) / (2 * layers))
    angles = np.arange(2 * around) * np.pi / around
    number = np.arange(radii.size * angles.size).reshape(radii.size, angles.size)
    points = np.stack([np.outer(radii, np.cos(angles)), np.outer(radii, np.sin(angles))], axis=-1).reshape(
        -1, 2
    )
    triangles = []
    for i in range(0, 2 * layers, 2):
        for j in range(0, 2 * around, 2):

            def n(di, dj, i=i, j=j):
                return number[i + di, (j + dj) % (2 * around)]

            triangles.append([n(0, 0), n(2, 0), n(2, 2), n(1, 0), n(2, 1), n(1, 1)])
            triangles.append([n(0, 0), n(2, 2), n(0, 2), n(1, 1), n(1, 2), n(0, 1)])
    triangles = np.array(triangles)
    if not curved:
        for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
            points[triangles[:, m]] = 0.5 * (points[triangles[:, a]] + points[triangles[:, b]])
    ends = np.arange(0, 2 * around, 2)
    rims = [
        np.stack([number[row, ends], number[row, (ends + 2) % (2 * around)], number[row, ends + 1]], axis=1)
        for row in (0, -1)
    ]
    return points, triangles, rims[0], rims[1]


def edge_load(points, edges, traction):
    """Nodal forces of a traction given as a function of (points, outward normals); material on either side."""
    t, weight = np.polynomial.legendre.leggauss(5)
    t, weight = 0.5 * (t + 1), 0.5 * weight
    shape = np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)], axis=1)
    slope = np.stack([4 * t - 3, 4 * t - 1, 4 - 8 * t], axis=1)
    place = np.einsum("qk,eka->eqa", shape, points[edges])
    along = np.einsum("qk,eka->eqa", slope, points[edges])
    length = np.linalg.norm(along, axis=2, keepdims=True)
    normal = np.stack([along[..., 1], -along[..., 0]], axis=-1) / length
    pull = traction(place, normal) * length
    force = np.zeros_like(points)
    np.add.at(force, edges, np.einsum("qk,eqa,q->eka", shape, pull, weight))
    return force


def true_error(bodies, reference):
    """Largest relative difference of a pair's deflection along the path, and of cross terms to the least of it."""
    pair = bodies.pair
    rho1 = np.linspace(pair.points.A, pair.points.E, 60)
    local = sum(
        hertz_indentation(0.1 * pair.module, gear.law, pair.module) for gear in (bodies.pinion, bodies.wheel)
    )
    own = reference.own(rho1) + local / pair.face_width
    difference = np.abs(bodies.own(rho1) - reference.own(rho1)) / own
    crossed = 0.0
    for gear, rho in (("pinion", rho1), ("wheel", pair.line_of_action - rho1)):
        load, point = np.meshgrid(rho, rho)
        for k in range(1, bodies.reach + 1):
            terms = [getattr(one, gear).cross(k, load, point) for one in (bodies, reference)]
            crossed += np.max(np.abs(terms[0] - terms[1])) / pair.face_width / bodies.reach
    return max(float(np.max(difference)), crossed / float(np.min(own)))
