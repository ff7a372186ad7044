"""Rigid hubs under helical gears, and springs that hold them."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from fem import Support, compliance, mesh_cycle
from gears import Gear, GearPair

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))


def test_a_hub_is_a_larger_bore() -> None:
    """The same section is solved, of which waves and ends of the twisted body follow."""
    hubs = Support(hub_radius=4.5e-3), Support(hub_radius=6e-3)
    held = compliance(SMALL, tolerance=0.05, supports=hubs)
    bored = replace(
        SMALL, pinion=replace(SMALL.pinion, bore_radius=4.5e-3), wheel=replace(SMALL.wheel, bore_radius=6e-3)
    )
    assert held.meshed == compliance(bored, tolerance=0.05).meshed
    assert held.meshed != compliance(SMALL, tolerance=0.05).meshed


@pytest.mark.slow
def test_springs_of_hubs_turn_and_shift_all_teeth() -> None:
    """D grows by F r_b^2/k_t and F/k_r, F the force in the section, whatever was solved before; no force changes."""
    turn, shift = 2e4, 1e8
    bores = [profile.bore_radius for profile in SMALL.teeth_profiles]
    springs = Support(torsional_stiffness=turn), Support(radial_stiffness=shift, hub_radius=bores[1])
    plain, held = (
        mesh_cycle(SMALL, 8.0, 4, compliance(SMALL, tolerance=0.02, supports=one), cells=16, reference="bore")
        for one in (None, springs)
    )
    more = held.force * (SMALL.base_radii[0] ** 2 / turn + 1.0 / shift)
    np.testing.assert_allclose(held.transmission_error - plain.transmission_error, more, rtol=1e-6)
    np.testing.assert_allclose(held.forces, plain.forces, rtol=1e-6)
