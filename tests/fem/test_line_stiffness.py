"""Stiffness of a helical mesh against approach and tilt: further loads, tilted flanks, spur pairs, the mirror."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from base import Array
from fem import MeshCycle, PairCompliance, compliance, mesh_cycle
from gears import Bearing, Gear, GearPair, Lead, Shaft, ShaftSegment, Topography

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
TORQUE, POSITIONS, CELLS = 8.0, 6, 24


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


def at(bodies: PairCompliance, torque: float = TORQUE, pair: GearPair = SMALL) -> MeshCycle:
    return mesh_cycle(pair, torque, POSITIONS, replace(bodies, pair=pair), cells=CELLS)


def moment(cycle: MeshCycle) -> Array:
    """Sum of cos(beta_b) F zeta over all cells [N m]."""
    lines, pair = cycle.lines, cycle.pair
    assert lines is not None
    zeta = np.nan_to_num(lines.z + (lines.rho[0] - pair.points.C) * pair.helix.base_tangent)
    return np.asarray(pair.helix.base_cosine * (lines.force * zeta).sum(axis=(1, 2)))


def matrix(cycle: MeshCycle) -> Array:
    assert cycle.lines is not None
    return cycle.lines.tilting[0]


@pytest.mark.slow
def test_a_further_load_meets_slopes_of_force_and_moment(bodies: PairCompliance) -> None:
    """Measured against the bodies and against the bores, whose turn by the load counts in D alone."""
    less, here, more = (at(bodies, torque) for torque in (0.98 * TORQUE, TORQUE, 1.02 * TORQUE))
    for reference in ("body", "bore"):
        first, between, last = (cycle.against(reference) for cycle in (less, here, more))
        turn = last.transmission_error - first.transmission_error
        found = matrix(between)
        assert found[:, 0, 0] == pytest.approx((last.force - first.force) / turn, rel=2e-3)
        assert found[:, 0, 0] == pytest.approx(between.stiffness, rel=1e-9)
        size = np.sqrt(found[:, 0, 0] * found[:, 1, 1])
        assert found[:, 0, 1] == pytest.approx((moment(last) - moment(first)) / turn, abs=2e-3 * size.max())
        assert between.lines is not None
        summed = between.lines.slopes.sum(axis=2)
        assert summed == pytest.approx(between.pair_stiffness, rel=1e-9, abs=1e-6)


@pytest.mark.slow
def test_flanks_that_are_tilted_meet_the_stiffness_against_tilt(bodies: PairCompliance) -> None:
    """Material that grows with zeta closes gaps as a tilt does; the force stays, and D gives way."""
    tilt, here = 2e-5, matrix(at(bodies))
    rho, z = np.array([0.0, 8e-3]), np.array([-2.5e-3, 2.5e-3])
    zeta = z + (rho[:, None] - SMALL.points.C) * SMALL.helix.base_tangent
    moments = []
    for sign in (-1.0, 1.0):
        table = tuple(map(tuple, (sign * tilt * zeta).tolist()))
        lead = Lead(topography=Topography(tuple(rho.tolist()), tuple(z.tolist()), table, "linear"))
        moments.append(moment(at(bodies, pair=replace(SMALL, pinion=replace(SMALL.pinion, lead=lead)))))
    resists = here[:, 1, 1] - here[:, 0, 1] ** 2 / here[:, 0, 0]
    assert (moments[1] - moments[0]) / (2.0 * tilt) == pytest.approx(resists, rel=5e-3)


@pytest.mark.slow
def test_springs_in_series_with_cells_soften_the_mesh_by_the_squares_of_slopes(
    bodies: PairCompliance,
) -> None:
    """In the first order, whatever the bodies couple; what the load then moves is left out here, and small."""
    plain, softness = at(bodies), 5e-14
    assert plain.lines is not None
    length = np.where(plain.lines.length > 0.0, plain.lines.length, np.inf)
    foreseen = softness * (plain.lines.slopes**2 / length[..., None]).sum(axis=(1, 2))

    def film(rho1: Array, force: Array) -> tuple[Array, Array]:
        slope = -softness / SMALL.face_width
        return np.where(np.isfinite(rho1), slope * force, 0.0), np.full_like(force, slope)

    soft = mesh_cycle(SMALL, TORQUE, POSITIONS, bodies, cells=CELLS, film=film)
    # one stiffness per length of a line would be off by 2 to 13 %
    assert plain.stiffness - soft.stiffness == pytest.approx(foreseen, rel=0.03)


@pytest.mark.slow
def test_half_as_many_cells_are_near(bodies: PairCompliance) -> None:
    lines = at(bodies).lines
    assert lines is not None
    fine, coarse = lines.tilting
    size = np.sqrt(fine[:, 0, 0] * fine[:, 1, 1]).max()
    assert np.abs(coarse[:, 1, 1] / fine[:, 1, 1] - 1.0).max() < 0.02
    assert np.abs(coarse[:, 0, 1] - fine[:, 0, 1]).max() < 0.02 * size


@pytest.mark.slow
def test_the_other_hand_is_the_mirror(bodies: PairCompliance) -> None:
    left = replace(SMALL, helix_angle=-SMALL.helix_angle)
    other = matrix(mesh_cycle(left, TORQUE, POSITIONS, compliance(left, tolerance=0.02), cells=CELLS))
    here = matrix(at(bodies))
    size = np.sqrt(here[:, 0, 0] * here[:, 1, 1]).max()
    assert other[:, 1, 1] == pytest.approx(here[:, 1, 1], rel=4e-3)
    assert other[:, 0, 1] == pytest.approx(-here[:, 0, 1], abs=4e-3 * size)


@pytest.mark.slow
@pytest.mark.long
def test_a_small_helix_resists_tilt_as_a_spur_pair_on_shafts() -> None:
    """That has its stiffness against approach and tilt from cells of the face, on shafts that hardly yield.

    Both solve free ends apart. Their compliances differ in the cells at the ends, by what answers of a helix near an
    end leave between the five places of the flank; farther in by less than 0.4 % against tilt. A compliance d that is
    added at both ends, z = b/2, makes a part d/S of that against approach, S the sum of the compliances of all cells,
    and (b/2)^2 d/T of that against tilt, T their sum by z z': a weight of (b/2)^2 S/T. With even slopes of force over
    the face the stiffnesses are 1/S and (b^2/12)^2/T, to a common factor: the weight is 36 k_tilt/(b^2 k_approach). It
    is 3 where cells do not couple, k_tilt = b^2/12 k_approach, and more where bodies yield to all of them together.
    """
    spur = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3)
    shaft = Shaft((ShaftSegment(0.06, 0.03),), (Bearing(0.0, 1e12), Bearing(0.06, 1e12)), 0.03, 0.0)
    straight = mesh_cycle(
        spur, TORQUE, POSITIONS, cells=16, beyond_path=False, shafts=(shaft, None), reference="body"
    )
    nearly = replace(spur, helix_angle=1e-6)
    twisted = mesh_cycle(nearly, TORQUE, POSITIONS, cells=16, beyond_path=False, reference="body")
    assert straight.face is not None
    spur_matrix = straight.face.mesh_matrix
    assert spur_matrix is not None
    errors = straight.error + twisted.error
    approach, tilt = spur_matrix[:, 0, 0], spur_matrix[:, 1, 1]
    weight = 36.0 * tilt / (spur.face_width**2 * approach)
    print(
        weight,
        errors,
        np.c_[matrix(twisted)[:, 0, 0] / approach - 1.0, matrix(twisted)[:, 1, 1] / tilt - 1.0],
    )
    assert np.all(weight > 3.0)
    assert matrix(twisted)[:, 0, 0] == pytest.approx(approach, rel=errors)
    assert np.all(np.abs(matrix(twisted)[:, 1, 1] / tilt - 1.0) < weight * errors)
