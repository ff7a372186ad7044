"""Finite elements against ISO 6336-3, one pair loaded at the outer point of single contact.

The standard's factors were fitted to strain gauges and finite elements of gears of usual size: solid spur gears
without shift, on rack profile A, should agree within a few per cent, best for few teeth.
"""

from __future__ import annotations

import numpy as np
import pytest

from fem.pair.pair_fillets import fillets
from gears import Gear, GearPair, closed_form


@pytest.mark.parametrize(("teeth", "ratio"), [(20, 0.998), (36, 0.986), (100, 0.951)])
def test_greatest_tension(teeth, ratio):
    pair = GearPair(Gear(teeth), Gear(60), 2e-3, 0.04)
    influence = fillets(pair, 0.01).pinion
    stress = influence.stress(0, np.array([pair.points.D]))[0]
    nominal = closed_form.iso6336_3(pair, 1.0).stresses[0] * pair.face_width
    assert 0.9 < stress[0].max() / nominal < 1.05
    # our own value, so that a change is seen
    assert stress[0].max() / nominal == pytest.approx(ratio, abs=0.006)
    # the place lies below the standard's, towards the gap, and compression is greater than tension
    lean = np.degrees(influence.line.tangent_angle)
    assert 30 < lean[np.argmax(stress[0])] < 50
    assert stress[1].min() < -stress[0].max()
