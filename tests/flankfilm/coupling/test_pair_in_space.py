"""Gears with six freedoms each: symmetry, closed forms, balance of momentum, and the limit of torsion alone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from base import Array, InputError, SolverError
from fem import compliance, mesh_cycle
from flankfilm.coupling.drive.mesh_in_space import SpatialMesh, cell_wrenches, spatial_mesh
from flankfilm.coupling.drive.pair_in_space import SpatialPair, spatial_pair
from flankfilm.coupling.drive.spatial_bearings import bearing_stiffness
from gears import Gear, GearPair, contact_lines

SPUR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
PAIR = replace(SPUR, helix_angle=math.radians(20.0))
POSITIONS, TORQUE, PER_LENGTH = 32, 600.0, 2e10
SOFT = bearing_stiffness([(-0.06, 3e8, 1e8), (0.08, 2e8, 0.0)])
FIRM = bearing_stiffness([(-0.1, 1e14, 1e14), (0.1, 1e14, 1e14)])


def even_mesh(pair: GearPair = PAIR, cells: int = 40, shake: float = 0.0) -> SpatialMesh:
    """Lines of contact, or the face of a spur pair at C, with one stiffness per length, secant and tangent alike."""
    rows = []
    for position in (np.arange(POSITIONS) + 0.5) / POSITIONS:
        if pair.helix_angle == 0.0:
            z = ((np.arange(cells) + 0.5) / cells - 0.5) * pair.face_width
            rho, length = np.full(cells, pair.points.C), np.full(cells, pair.face_width / cells)
        else:
            ends = _lines(pair, position)
            parts = (np.arange(cells) + 0.5) / cells
            z = np.concatenate([low + (high - low) * parts for _, low, high in ends])
            rho = np.concatenate(
                [
                    middle + pair.helix.base_tangent * (low + (high - low) * parts)
                    for middle, low, high in ends
                ]
            )
            length = np.repeat([(high - low) / cells for _, low, high in ends], cells)
        more = 1.0 + shake * math.cos(2.0 * math.pi * position)
        rows.append((cell_wrenches(pair, rho, z), more * PER_LENGTH * length))
    stiffness = np.array([np.einsum("c,ci,cj->ij", k, g, g) for g, k in rows])
    unit = np.zeros(12)
    unit[5] = 1.0 / pair.base_radii[0]
    turn = TORQUE / pair.base_radii[0] / (unit @ stiffness @ unit)
    load = np.array([(k * (g @ unit) * d) @ g for (g, k), d in zip(rows, turn, strict=True)])
    return SpatialMesh(stiffness, load, turn, pair, TORQUE)


def _lines(pair: GearPair, position: float) -> list[tuple[float, float, float]]:
    """rho1 at mid-face, and where each line that touches starts and ends along the face."""
    slope, half, found = pair.helix.base_tangent, 0.5 * pair.face_width, []
    for j in range(-4, 6):
        middle = pair.points.A + (position + j) * pair.base_pitch
        low, high = sorted(((pair.points.A - middle) / slope, (pair.points.E - middle) / slope))
        low, high = max(low, -half), min(high, half)
        if high > low:
            found.append((middle, low, high))
    return found


def held(mesh: SpatialMesh, bearing: Array = SOFT, **given: float) -> SpatialPair:
    return spatial_pair(mesh, (bearing, bearing), **given)  # type: ignore[arg-type]


class TestMesh:
    def test_the_lines_are_those_of_the_pair(self) -> None:
        total = [sum(high - low for _, low, high in _lines(PAIR, p)) for p in (0.1, 0.6)]
        assert np.array(total) / PAIR.helix.base_cosine == pytest.approx(
            contact_lines(PAIR).length([0.1, 0.6]), rel=1e-9
        )

    @pytest.mark.parametrize("beta", [0.0, 20.0, -20.0])
    def test_it_is_symmetric_and_reaches_two_motions(self, beta: float) -> None:
        mesh = even_mesh(replace(SPUR, helix_angle=math.radians(beta)))
        size = np.abs(mesh.stiffness).max()
        assert np.abs(mesh.stiffness - np.swapaxes(mesh.stiffness, 1, 2)).max() < 1e-14 * size
        units = np.array([1.0, 1.0, 1.0, 50.0, 50.0, 50.0] * 2)  # turns by 20 mm
        for matrix in units[:, None] * mesh.stiffness * units:
            values = np.linalg.eigvalsh(matrix)
            assert np.abs(values[:-2]).max() < 1e-12 * values[-1]
            assert values[-2] > 1e-4 * values[-1]

    def test_neither_mesh_nor_load_acts_on_bodies_that_move_as_one(self) -> None:
        """Displacements and turns about a common point, and the rolling of the gears."""
        mesh, pair = even_mesh(), PAIR
        apart = np.array([pair.line_of_action, -sum(pair.base_radii), 0.0])  # from pinion's to wheel's middle
        together = np.zeros((7, 12))
        together[6] = mesh.free_turn
        for i in range(3):
            together[i, [i, 6 + i]] = 1.0
            turn = np.eye(3)[i]
            together[3 + i, 3:6] = together[3 + i, 9:12] = turn
            together[3 + i, 6:9] = np.cross(turn, apart)
        size = np.abs(mesh.stiffness).max()
        assert np.abs(mesh.stiffness @ together.T).max() < 1e-13 * size
        rigid = np.abs(mesh.load).max()
        assert np.abs(mesh.load @ together.T).max() < 1e-12 * rigid

    def test_cells_press_along_the_normal_of_their_lines(self) -> None:
        """No cell moves by sliding along its line, nor is the normal longer than one."""
        along = np.array([PAIR.helix.base_tangent, 0.0, 1.0])
        g = cell_wrenches(PAIR, np.array([10e-3, 15e-3]), np.array([-5e-3, 7e-3]))
        assert g[:, :3] @ along == pytest.approx(0.0, abs=1e-15)
        assert np.linalg.norm(g[:, :3], axis=1) == pytest.approx(1.0, rel=1e-14)

    def test_the_force_on_the_pinion_is_axial_as_its_hand_says(self) -> None:
        for pair in (PAIR, replace(PAIR, helix_angle=-PAIR.helix_angle)):
            mesh = even_mesh(pair)
            assert -mesh.load[:, 2] == pytest.approx(pair.axial_force(TORQUE), rel=1e-9)
            assert mesh.load[:, 0] == pytest.approx(TORQUE / pair.base_radii[0], rel=1e-9)
            assert mesh.load[:, 5] == pytest.approx(TORQUE, rel=1e-9)

    def test_a_turn_meets_the_stiffness_of_the_pair_that_turns_alone(self) -> None:
        """k = cos(beta_b)^2 times the sum over cells."""
        length = [
            sum(high - low for _, low, high in _lines(PAIR, p))
            for p in (np.arange(POSITIONS) + 0.5) / POSITIONS
        ]
        by_hand = PER_LENGTH * PAIR.helix.base_cosine**2 * np.array(length)
        assert even_mesh().torsional_stiffness == pytest.approx(by_hand, rel=1e-12)

    def test_an_even_mesh_resists_tilt_by_a_twelfth(self) -> None:
        """k b^3/12 about the normal of shaft and line of action, as the number of cells grows, with its square."""
        off = []
        for cells in (10, 20):
            tilt = even_mesh(SPUR, cells).stiffness[0, 4, 4]
            off.append(1.0 - tilt / (PER_LENGTH * SPUR.face_width**3 / 12.0))
        assert off == pytest.approx([1e-2, 2.5e-3], rel=1e-9)


class TestPair:
    def test_bodies_that_nothing_holds_have_ten_motions_without_a_frequency(self) -> None:
        found = spatial_pair(even_mesh(), (np.zeros((6, 6)),) * 2).natural_frequencies
        assert found[:10].max() < 1e-4 * found[-1]
        assert found[10] > 1e-2 * found[-1]

    def test_firm_bearings_leave_the_pair_that_turns_alone(self) -> None:
        mesh = even_mesh()
        inertia, radii = PAIR.moments_of_inertia, PAIR.base_radii
        mass = 1.0 / (radii[0] ** 2 / inertia[0] + radii[1] ** 2 / inertia[1])
        alone = math.sqrt(mesh.torsional_stiffness.mean() / mass) / (2.0 * math.pi)
        off = [abs(held(mesh, size * FIRM).natural_frequencies[1] / alone - 1.0) for size in (1e-2, 1e-1)]
        assert off[1] < 1e-4
        assert off[0] / off[1] == pytest.approx(10.0, rel=0.05)  # falls as the bearings' compliance does

    def test_on_firm_bearings_it_moves_as_its_torsion_in_time(self) -> None:
        """m p'' + c p' + k(t) p = F, integrated step by step; k varies by a fifth."""
        mesh = even_mesh(shake=0.2)
        pair = held(mesh, FIRM, damping_ratio=0.1)
        inertia, radii = PAIR.moments_of_inertia, PAIR.base_radii
        mass = 1.0 / (radii[0] ** 2 / inertia[0] + radii[1] ** 2 / inertia[1])
        mean, force = mesh.torsional_stiffness.mean(), TORQUE / radii[0]
        damping, omega = 2 * 0.1 * math.sqrt(mean * mass), 0.7 * math.sqrt(mean / mass)
        places = (np.arange(POSITIONS) + 0.5) / POSITIONS
        waves = (
            np.fft.fft(mesh.torsional_stiffness)
            / POSITIONS
            * np.exp(-2j * np.pi * np.arange(POSITIONS) * places[0])
        )

        def rate(time: float, state: Array) -> list[float]:
            angle = omega * time * np.arange(1, POSITIONS // 2)
            stiff = mean + 2.0 * np.real(np.exp(1j * angle) @ waves[1 : POSITIONS // 2])
            return [state[1], (force - damping * state[1] - stiff * state[0]) / mass]

        period = 2 * math.pi / omega
        solved = solve_ivp(
            rate,
            (0.0, 41 * period),
            [force / mean, 0.0],
            rtol=1e-9,
            atol=1e-15,
            t_eval=(40 + places) * period,
        )
        row = np.zeros(12)
        row[5], row[11] = radii
        off = []
        for harmonics in (3, 5, 7):
            motion = pair.bearing_forces(omega / 36, harmonics=harmonics).motion
            waves = np.exp(2j * np.pi * np.outer(places, np.arange(len(motion))))
            off.append(np.abs(np.real(waves @ (motion @ row)) / solved.y[0] - 1.0).max())
        assert off[0] > off[1] > off[2]
        assert off[2] < 1e-4

    def test_bearings_carry_what_bodies_do_not(self) -> None:
        """Mesh forces cancel between both: forces on all bearings change the momentum of both bodies, no more."""
        pair = held(even_mesh(shake=0.1), damping_ratio=0.03)
        found = pair.bearing_forces(150.0)
        omega = 150.0 * 36 * np.arange(len(found.motion))
        push = -(omega[:, None] ** 2) * (found.motion @ pair.mass)
        for i in range(3):
            both = found.harmonics[:, 0, i] + found.harmonics[:, 1, i]
            change = push[:, i] + push[:, 6 + i]
            assert np.abs(both + change).max() < 1e-9 * np.abs(found.harmonics[:, :, :3]).max()

    def test_means_are_those_of_the_static_load(self) -> None:
        found = held(even_mesh()).bearing_forces(1e-3)
        force, axial = TORQUE / PAIR.base_radii[0], PAIR.axial_force(TORQUE)
        assert found.harmonics[0, 0, 0].real == pytest.approx(-force, rel=1e-6)
        assert found.harmonics[0, 1, 0].real == pytest.approx(force, rel=1e-6)
        assert found.harmonics[0, 0, 2].real == pytest.approx(axial, rel=1e-6)
        assert found.harmonics[0, 0, 3].real == pytest.approx(-axial * PAIR.base_radii[0], rel=1e-6)

    def test_a_load_that_travels_shakes_bearings_without_any_error(self) -> None:
        """One stiffness and one turn all over the mesh; the centre goes to and fro by a millimetre.

        At slow speed bearings carry the moment F z(t) of the static load, less what they yield to; near a resonance
        several times as much.
        """
        mesh = even_mesh(SPUR)
        z = 1e-3 * np.cos(2.0 * math.pi * (np.arange(POSITIONS) + 0.5) / POSITIONS)
        force, load = TORQUE / SPUR.base_radii[0], mesh.load.copy()
        load[:, 4] += force * z
        load[:, 10] -= force * z
        pair = held(replace(mesh, load=load), FIRM)
        assert np.ptp(mesh.turn) < 1e-12 * mesh.turn.mean()
        slow = pair.bearing_forces(1e-2)
        assert slow.amplitude[0, :, 4] == pytest.approx(force * 1e-3, rel=1e-3)
        assert slow.amplitude[0, :, 0].max() < 1e-6 * force
        soft = held(replace(mesh, load=load))
        rates = 2 * math.pi * soft.natural_frequencies[soft.natural_frequencies > 100.0] / 36
        assert max(soft.bearing_forces(rate).amplitude[0, 0, 4] for rate in rates) > 3.0 * force * 1e-3

    def test_hands_mirror_each_other(self) -> None:
        """z reversed: axial forces and the moments about axes across the shaft change sign."""
        other = replace(PAIR, helix_angle=-PAIR.helix_angle)
        bearing = bearing_stiffness([(-0.07, 3e8, 1e8), (0.07, 3e8, 0.0)])
        first, second = (
            held(even_mesh(pair), bearing).bearing_forces(200.0).harmonics for pair in (PAIR, other)
        )
        signs = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
        assert second == pytest.approx(first * signs, abs=1e-9 * np.abs(first).max())

    def test_more_harmonics_settle(self) -> None:
        pair = held(even_mesh(shake=0.1))
        most = np.abs(pair.bearing_forces(180.0, 7).amplitude[:, :, :3]).max()
        error = pair.bearing_forces(180.0, 4).error
        off = np.abs(pair.bearing_forces(180.0, 4).harmonics - pair.bearing_forces(180.0, 7).harmonics[:5])[
            ..., :3
        ].max()
        assert off <= error * most

    def test_contact_that_is_lost_is_refused(self) -> None:
        mesh = even_mesh(shake=0.6)
        pair = held(mesh, FIRM, damping_ratio=0.005)
        at = 2 * math.pi * pair.natural_frequencies[1] / 36
        with pytest.raises(SolverError, match="contact is lost"):
            pair.bearing_forces(at)

    @pytest.mark.parametrize(
        ("bearing", "said"),
        [
            (np.zeros((5, 5)), r"bearings\[0\] = shape \(5, 5\): must be \(6, 6\)"),
            (np.triu(np.ones((6, 6))), "must be symmetric"),
            (-np.eye(6), "must not be negative"),
        ],
    )
    def test_what_is_no_bearing_is_refused(self, bearing: Array, said: str) -> None:
        with pytest.raises(InputError, match=said):
            spatial_pair(even_mesh(), (bearing, SOFT))

    def test_arguments_are_refused_together(self) -> None:
        with pytest.raises(InputError) as caught:
            held(even_mesh()).bearing_forces(-1.0, 50)
        assert len(caught.value.faults) == 2


@pytest.mark.slow
@pytest.mark.long
def test_of_a_loaded_contact_the_turn_meets_its_tangent_and_its_moments() -> None:
    small = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=math.radians(18.0))
    cycle = mesh_cycle(small, 8.0, 16, compliance(small, tolerance=0.02), cells=24)
    mesh = spatial_mesh(cycle)
    assert cycle.lines is not None
    assert mesh.torsional_stiffness == pytest.approx(cycle.stiffness, rel=1e-9)
    assert mesh.load[:, 4] == pytest.approx(cycle.lines.tilting_moment[0], rel=1e-9)
    assert -mesh.load[:, 10] == pytest.approx(cycle.lines.tilting_moment[1], rel=1e-9)
    assert mesh.load[:, 5] == pytest.approx(8.0, rel=1e-9)
    found = spatial_pair(mesh, (SOFT, SOFT)).bearing_forces(200.0, harmonics=3)
    assert found.amplitude[0, :, 2].min() > 0.0  # axial forces swing
    with pytest.raises(InputError, match="must be of a pinion that drives"):
        spatial_mesh(replace(cycle, flank="back"))
    with pytest.raises(InputError, match="must have lines of contact"):
        spatial_mesh(replace(cycle, lines=None))
