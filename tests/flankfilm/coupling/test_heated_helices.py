"""Helical pairs at their temperatures: the spur limit, even growth, unequal growth, and heat in and out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import ehl
import fem
from flankfilm import coupling
from flankfilm.coupling import Flanks, LoadedTeeth
from gears import Gear, GearPair, Heat, WarmPair, warm_pair

PAIR = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=math.radians(18.0))
OIL = ehl.Lubricant(0.05, 19e-9, 870.0, temperature=353.15, eyring_stress=5e6)
SPEED, TORQUE = 300.0, 8.0
HOT = Heat(383.15, 343.15, 393.15)
"""Pinion 40 K above the wheel, and a housing that leaves room for both."""


def loaded(warm: WarmPair, cells: int = 16) -> LoadedTeeth:
    """Pair at its temperatures under the torque."""
    flanks = Flanks(beyond_path=False, cells=cells, base_pitch_difference=warm.base_pitch_difference)
    bodies = fem.compliance(warm.pair, tolerance=0.02)
    return LoadedTeeth(warm.pair, TORQUE, compliance=bodies, flanks=flanks)


def lost(teeth: LoadedTeeth, **given: object) -> coupling.MeshLosses:
    """Losses of a pair at its temperatures."""
    own = {"compliance": teeth.compliance, "flanks": teeth.flanks, "tolerance": 0.05, "positions": 8}
    return coupling.mesh_losses(teeth.pair, TORQUE, SPEED, OIL, **(own | given))


@pytest.mark.slow
class TestGrowth:
    @pytest.fixture(scope="class")
    @classmethod
    def cold(cls) -> coupling.MeshCycle:
        return loaded(warm_pair(PAIR, Heat())).cycle(5)

    def test_at_the_temperature_of_reference_nothing_moves_to_the_last_bit(self, cold):
        flanks = Flanks(beyond_path=False, cells=16)
        plain = LoadedTeeth(PAIR, TORQUE, compliance=fem.compliance(PAIR, tolerance=0.02), flanks=flanks)
        bare = plain.cycle(5)
        for name in ("forces", "transmission_error", "stiffness", "secant_stiffness"):
            assert np.array_equal(getattr(bare, name), getattr(cold, name)), name

    def test_even_growth_keeps_the_share_of_every_cell(self, cold):
        """All lengths grow alike, the centre distance too: forces fall as the base radius grows, and no more."""
        warm = warm_pair(PAIR, Heat(373.15, 373.15, 373.15))
        grown = 1.0 + 11.5e-6 * 80.0
        assert warm.base_pitch_difference == 0.0
        found = loaded(warm).cycle(5)
        np.testing.assert_allclose(
            grown * found.lines.force, cold.lines.force, rtol=5e-4, atol=1e-4 * cold.lines.force.max()
        )
        # line loads fall by the square, stiffness grows with the face but for Hertz's logarithm
        assert found.secant_stiffness / cold.secant_stiffness == pytest.approx(grown, rel=3e-4)

    def test_a_warmer_pinion_gives_load_to_the_lines_that_leave(self):
        """By one difference of the base pitches from line to line; with a warmer wheel it is the other way round.

        Of the same grown gears: forces that minimise one convex energy go the way of their gaps.
        """
        warm = warm_pair(PAIR, HOT)
        step = warm.base_pitch_difference
        assert step == pytest.approx(11.5e-6 * 40.0 * PAIR.base_pitch, rel=1e-12)
        found = [loaded(replace(warm, base_pitch_difference=by)).cycle(5) for by in (-step, 0.0, step)]
        for each in found:
            across = each.forces.sum(axis=1) * PAIR.helix.base_cosine
            assert across == pytest.approx(TORQUE / warm.pair.base_radii[0], rel=1e-9)
        lines = np.arange(found[0].forces.shape[1])
        ahead = np.diff([each.load_share @ lines for each in found], axis=0)
        assert np.all(ahead > 0.0)
        assert ahead[1] == pytest.approx(ahead[0], rel=0.3)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("angle", [1e-6, 1e-3])
def test_a_small_helix_is_the_warm_spur_face_within_the_errors(angle):
    spur = replace(PAIR, helix_angle=0.0)
    warm = [warm_pair(pair, HOT) for pair in (spur, replace(spur, helix_angle=angle))]
    for name in ("backlash", "base_pitch_difference", "pressure_angle", "centre_distance"):
        assert getattr(warm[1], name) == pytest.approx(getattr(warm[0], name), rel=1e-6), name
    teeth = [loaded(each) for each in warm]
    straight, twisted = (each.cycle(16) for each in teeth)
    error = straight.error + twisted.error
    assert twisted.secant_stiffness == pytest.approx(straight.secant_stiffness, rel=error)
    np.testing.assert_allclose(
        np.sort(twisted.load_share, axis=1)[:, -2:], np.sort(straight.load_share, axis=1)[:, -2:], atol=error
    )
    flanks = {"bulk_temperatures": (HOT.pinion_temperature, HOT.wheel_temperature)}
    face, lines = (lost(each, **flanks) for each in teeth)
    assert lines.mesh_loss == pytest.approx(face.mesh_loss, rel=lines.error + face.error)
    # films at the same places under the same loads; ends of the face count for the one, not for the other
    warmer = [
        np.nanmax(cells.contact_temperature[..., 3:-3]) - HOT.pinion_temperature
        for cells in (face.over_face, lines.over_lines)
    ]
    assert warmer[0] > 1.0
    assert warmer[1] == pytest.approx(warmer[0], rel=lines.error + face.error)


@pytest.mark.slow
@pytest.mark.long
def test_heat_that_cells_make_is_what_leaves_both_gears():
    """Of warm gears with unequal base pitches: powers of cells are the loss, and their heat is taken away."""
    warm, transfer = warm_pair(PAIR, HOT), np.array([4.0, 5.0])
    found = lost(loaded(warm), heat_transfer=(4.0, 5.0), ambient_temperature=313.15)
    cells = found.over_lines
    assert cells.power_lost.mean() == pytest.approx(found.mesh_loss, rel=found.error)
    assert found.heat.sum() == pytest.approx(found.mesh_loss, rel=1e-9)
    assert transfer * (found.bulk_temperatures - 313.15) == pytest.approx(found.heat, abs=5.0 * 0.2)
    assert found.efficiency == pytest.approx(1.0 - found.mesh_loss / (TORQUE * SPEED), rel=1e-12)
    rho1, rho2 = np.nan_to_num(cells.rho)
    across = np.nan_to_num(cells.friction_coefficient) * cells.force * np.sign(rho1 - warm.pair.points.C)
    turned = SPEED * ((across * rho1).sum() - 18 / 23 * (across * rho2).sum()) / len(rho1)
    assert turned == pytest.approx((cells.sliding_loss * cells.length[..., None]).sum() / len(rho1), rel=1e-9)
