"""What yields in series with the teeth in laws of the contact: films, and shafts of a train, by exact springs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from dynamics.motion.gridded_motion import gridded_motions
from flankfilm.coupling import LoadedTeeth, given_series, pair_drive, pair_oscillator
from flankfilm.coupling.films.lubricated_record import LubricatedCycle
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.rating.contact_laws import SHARES, ContactLaws, gridded
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04).with_backlash(50e-6)
TORQUE, SIZE = 250.0, 60
FORCE = TORQUE / PAIR.base_radii[0]
SLOW = 0.06
PLACE = (np.arange(SIZE) + 0.5) / SIZE
TEETH = 8e8 * (1.0 + 0.2 * np.cos(2.0 * np.pi * PLACE))
FILMS = 5e9 * (1.0 + 0.5 * np.sin(2.0 * np.pi * PLACE))


@pytest.fixture(scope="module")
def dry() -> MeshCycle:
    """At fewer positions than laws have."""
    return LoadedTeeth(PAIR, TORQUE, compliance=fem.compliance(PAIR, tolerance=0.02)).cycle(24)


def springs(stiffness: np.ndarray, power: float = 1.0) -> ContactLaws:
    """Deflections in proportion to a power of the force, of a secant stiffness at the mean load."""
    shares = np.array(SHARES)
    even = shares[:, None] ** power * FORCE / stiffness
    return ContactLaws(0.0, shares, even, even, even, np.zeros((3, stiffness.size)), stiffness, 0.0)


def with_films(dry: MeshCycle, films: np.ndarray) -> LubricatedCycle:
    """A cycle whose secant is that of the teeth and films in series, at the positions of laws."""
    teeth = replace(dry, position=PLACE, secant_stiffness=TEETH, contact=None)
    both = replace(teeth, secant_stiffness=TEETH * films / (TEETH + films))
    return LubricatedCycle(
        **MeshCycle.fields_of(both), least_film=None, rounds=1, mismatch=0.0, dry=teeth, film=None, otherwise={}
    )  # fmt: skip


def moving(cycle: MeshCycle):
    """The pair, with the scales of a given stiffness and films of a cycle."""
    given = given_series(8e8, [0.2])
    return pair_oscillator(PAIR, replace(given, cycle=cycle, kind="secant"), TORQUE, 200.0)


def test_dry_teeth_keep_their_law_whatever_positions_the_cycle_has(dry):
    """Bitwise that of a motion without a mesh cycle, whose stiffness is given."""
    alone = gridded(
        springs(TEETH, 0.8), "even", pair_oscillator(PAIR, given_series(8e8, [0.2]), TORQUE, 200.0)
    )
    beside = gridded(springs(TEETH, 0.8), "even", moving(dry))
    assert np.array_equal(alone.forces, beside.forces)
    assert (alone.lowest, alone.spacing) == (beside.lowest, beside.spacing)


def test_films_are_springs_in_series_at_every_position(dry):
    """k k_s/(k + k_s) of linear teeth, from the first touch on."""
    motion = moving(with_films(dry, FILMS))
    law = gridded(springs(TEETH), "even", motion)
    slopes = np.diff(law.forces, axis=1)[:, 1:] / law.spacing * motion.scales.mean_stiffness
    together = TEETH * FILMS / (TEETH + FILMS)
    assert slopes == pytest.approx(np.tile(together[:, None], slopes.shape[1]), rel=1e-9)


def test_films_move_no_first_touch_and_leave_forces_rising(dry):
    """Contact is lost at the same approach, and what films yield under a force is the force over their stiffness."""
    plain, motion = gridded(springs(TEETH, 0.7), "even", moving(dry)), moving(with_films(dry, FILMS))
    soft = gridded(springs(TEETH, 0.7), "even", motion)
    assert soft.lowest == pytest.approx(plain.lowest, abs=1e-12)
    assert np.all(np.diff(soft.forces, axis=1) >= 0.0)
    for row, films in zip(range(SIZE), FILMS, strict=True):
        for force in (0.3, 1.0, 2.5):
            depths = [
                np.interp(
                    force * motion.mean_force, law.forces[row], law.lowest + law.spacing * np.arange(600)
                )
                for law in (plain, soft)
            ]
            apart = (depths[1] - depths[0]) * motion.scales.length
            assert apart == pytest.approx(force * FORCE / films, abs=2e-2 * FORCE / films)


def test_energy_of_films_is_that_of_their_springs(dry):
    """Work up to twice the mean force: that of the teeth and F^2/(2 k_s)."""
    plain, soft = (
        gridded(springs(TEETH, 0.7), "even", moving(each)) for each in (dry, with_films(dry, FILMS))
    )
    scales, top = moving(dry).scales, 2.0 * moving(dry).mean_force
    for row in range(0, SIZE, 7):
        work = []
        for law in (plain, soft):
            forces = np.linspace(0.0, top, 2001)
            depths = np.interp(forces, law.forces[row], law.spacing * np.arange(600))
            work.append(top * depths[-1] - np.trapezoid(depths, forces))
        more = (work[1] - work[0]) * scales.length * scales.mean_stiffness * scales.length
        assert more == pytest.approx((2.0 * FORCE) ** 2 / (2.0 * FILMS[row]), rel=0.02)


@pytest.fixture(scope="module")
def drive():
    """Heavy ends on shafts whose bending is far faster than they turn."""
    shaft = Shaft((ShaftSegment(0.1, 0.04),), (Bearing(0.01, 2e9), Bearing(0.09, 2e9)), 0.05, 0.0)
    return pair_drive(
        PAIR, given_series(8e8), TORQUE, 200.0, shafts=(shaft, shaft), end_inertias=(100.0, 100.0),
        error_amplitude=1e-6, shaft_damping_ratio=0.05,
    )  # fmt: skip


def test_the_law_of_a_train_is_that_of_the_pair(drive):
    """Shafts are displacements of the train: they may be no part of the law beside."""
    law = gridded(springs(TEETH, 0.8), "even", drive)
    assert np.array_equal(law.forces, gridded(springs(TEETH, 0.8), "even", drive.rigid).forces)


@pytest.mark.parametrize("N", [0.3, 0.7])
def test_a_linear_law_in_a_train_answers_as_its_matrices_do(drive, N):
    """Force under a transmission error: the frequency response of the train with the mesh as a spring."""
    own = drive.oscillator.with_parameter("frequency", N)
    law = gridded(springs(np.full(12, 8e8)), "even", drive)
    found = gridded_motions(own, law, [N]).force[0]
    mass, damping, stiffness, g = (
        np.asarray(getattr(own, name)) for name in ("mass", "damping", "stiffness", "direction")
    )
    mesh, error = 1.0 + 1j * N * own.mesh_damping, own.error_series[0, 0]
    whole = -(N**2) * mass + 1j * N * damping + stiffness + mesh * np.outer(g, g)
    y = g @ np.linalg.lstsq(whole, mesh * error * g, rcond=None)[0] - error
    assert found - drive.mean_force == pytest.approx(abs(y), rel=5e-3)


def test_between_ends_that_stand_still_shafts_are_springs_in_series(drive):
    """Slow beside the gears and fast beside the ends: force over error is k k_s/(k + k_s)."""
    soft = sum(
        1.0 / felt.bending_stiffness + 1.0 / (felt.torsion_stiffness / radius**2)
        for felt, radius in zip(drive.shafts, PAIR.base_radii, strict=True)
    )
    law = gridded(springs(np.full(12, 8e8)), "even", drive)
    swing = gridded_motions(drive.oscillator, law, [SLOW]).force[0] - drive.mean_force
    alone = 1e-6 / drive.rigid.scales.length
    assert swing == pytest.approx(alone / (1.0 + 8e8 * soft), rel=0.02)
