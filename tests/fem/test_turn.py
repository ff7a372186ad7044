"""Turned stresses are those of the turned tensor, and equal points have equal vectors in either frame."""

from __future__ import annotations

import numpy as np
import pytest

from fem.fields.turn import Turn

RNG = np.random.default_rng(3)
ANGLES = [RNG.uniform(-4.0, 4.0), RNG.uniform(-4.0, 4.0, 6)]


@pytest.mark.parametrize("angle", ANGLES, ids=["one", "each"])
def test_turned_stress_pulls_on_turned_facets_with_the_turned_traction(angle):
    turn, stress, normal = Turn.by(angle), RNG.normal(size=(6, 3)), RNG.normal(size=(6, 2))

    def traction(components, facet):
        xx, yy, xy = components.T
        x, y = facet.T
        return np.stack([xx * x + xy * y, xy * x + yy * y], axis=1)

    turned = traction(turn.stresses(stress), turn.vectors(normal))
    np.testing.assert_allclose(turned, turn.vectors(traction(stress, normal)), rtol=0, atol=1e-14)


@pytest.mark.parametrize("angle", ANGLES, ids=["one", "each"])
def test_a_turn_anticlockwise_and_back(angle):
    turn, values, stress = Turn.by(angle), RNG.normal(size=(6, 2)), RNG.normal(size=(6, 3))
    lean = np.arctan2(*turn.vectors(values).T[::-1]) - np.arctan2(*values.T[::-1])
    np.testing.assert_allclose(np.exp(1j * lean), np.exp(1j * np.broadcast_to(angle, 6)), rtol=1e-12)
    np.testing.assert_allclose(turn.back().vectors(turn.vectors(values)), values, rtol=0, atol=1e-14)
    np.testing.assert_allclose(turn.back().stresses(turn.stresses(stress)), stress, rtol=0, atol=1e-14)
