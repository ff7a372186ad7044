"""Random gears pressed together on cells of the face: steel and plastics, askew, crowned, relieved, without torque."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from gears import Alignment, Gear, GearPair, Lead, Material, TipRelief

STEEL, POM, PA66 = Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.36, 1410.0), Material(3e9, 0.4, 1140.0)


def drawn(seed):
    """Pair whose teeth overlap, its alignment, and a torque that adds less than the overlap presses."""
    rng = np.random.default_rng(seed)
    module = float(rng.choice([0.5e-3, 2e-3, 6e-3]))
    relief = TipRelief(5e-3 * module, 0.4 * module) if rng.random() < 0.3 else None
    lead = Lead(crowning=float(rng.choice([0.0, 4e-3])) * module)
    first = Gear(int(rng.integers(17, 40)), float(rng.uniform(0.0, 0.3)), tip_relief=relief, lead=lead)
    second = Gear(int(rng.integers(20, 70)), float(rng.uniform(-0.2, 0.3)), tip_relief=relief)
    material = [STEEL, (STEEL, POM), (PA66, PA66)][int(rng.integers(3))]
    plain = GearPair(first, second, module, float(rng.uniform(8.0, 20.0)) * module, material=material)
    overlap = float(rng.uniform(2e-3, 8e-3)) * module
    pair = replace(plain, centre_distance=plain.centre_distance_of_backlash(-overlap), tight=True)
    alignment = Alignment(float(rng.uniform(-8e-3, 8e-3)) * module, float(rng.uniform(-8e-3, 8e-3)) * module)
    softest = min(each.youngs_modulus for each in pair.materials)
    torque = (
        2e-4 * softest * pair.face_width * module * pair.base_radii[0] * float(rng.choice([0.0, 1.0, -1.0]))
    )
    return pair, alignment, torque


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_both_sides_balance_the_torque_and_let_nothing_overlap_or_are_refused(seed):
    pair, alignment, torque = drawn(seed)
    bodies = fem.compliance(pair, tolerance=0.05)
    over = fem.mesh_cycle(pair, torque, 5, bodies, cells=8, face_model="walls", alignment=alignment)
    if not over.converged:
        assert any(word in over.message for word in ("reduce the torque", "give more backlash")), over.message
        return
    assert np.any(over.opposite_force > 0.0)
    size = (over.forces.sum(axis=1) + over.opposite_force) * pair.base_radii[0]
    carried = over._moments()[0][0] * pair.base_radii[0]
    np.testing.assert_allclose(carried, abs(torque), atol=1e-8 * size.max())
    face = over.face
    np.testing.assert_allclose(
        face.line_load.sum(axis=-1) * pair.face_width / 8, over.forces, rtol=1e-9, atol=1e-6
    )
    assert np.all(face.gap[face.line_load > 0.0] == 0.0)
    assert np.all(over.stiffness > 0.0)
