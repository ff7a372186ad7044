"""Tooth displacement in an open finite-element study of whole gears (module 1, E 206 GPa, plane strain).

Reference: displacement in um per N/mm of face, along the load, where the load's line crosses the tooth's centre
line; bore of the root radius over 1.4, held. Teeth 17 and 43, two loads each.
"""

from __future__ import annotations

import numpy as np
import pytest

from fem.elasticity import flamant
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import ring_of
from gears import Gear, GearPair
from meshes import mesh_sector
from meshes.triangle import shape

LAW = PlaneElasticity("strain", 206e9, 0.3)


def inside(mesh, point):
    """Element with straight sides that holds a point, and the shape functions there."""
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    frame = np.stack([b - a, c - a], axis=2)
    local = np.linalg.solve(frame, (point - a)[..., None])[..., 0]
    least = np.minimum(local.min(axis=1), 1 - local.sum(axis=1))
    element = int(np.argmax(least))
    assert least[element] > -1e-9
    return mesh.triangles[element], shape(local[element, 0], local[element, 1])


@pytest.mark.parametrize(
    ("teeth", "radius", "reference"),
    [(17, 8.0023, 0.01626), (17, 8.5, 0.02226), (43, 21.5, 0.02085), (43, 22.4434, 0.05411)],
)
def test_displacement_on_the_centre_line(teeth, radius, reference):
    root = 0.5 * teeth - 1.25
    pair = GearPair(
        Gear(teeth, bore_radius=root / 1.4 * 1e-3), Gear(60, bore_radius=20e-3), module=1e-3, face_width=0.02
    )
    profile = pair.teeth_profiles[0]
    mesh = mesh_sector(profile, refinements=2)
    ring = ring_of(mesh, LAW)
    rho = np.sqrt((radius * 1e-3) ** 2 - profile.base_radius**2)
    at = flank_points(mesh, np.array([rho]))
    loads = line_loads(ring, at)
    load, inward = at.points[0], at.inward[0]
    crossing = load - load[0] / inward[0] * inward
    nodes, weights = inside(mesh, crossing)
    full = np.zeros(mesh.unknowns)
    full[ring.inner] = loads.inner(0)[:, 0]
    moved = weights @ full.reshape(-1, 2)[nodes]
    moved = moved + flamant.displacement(crossing[None], load, inward, LAW, mesh.module)[0]
    # um per N/mm: 1 N/mm is 1000 N/m, and 1e6 um to the metre
    assert float(moved @ inward) * 1e3 * 1e6 == pytest.approx(reference, rel=0.003)
