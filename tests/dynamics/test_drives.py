"""Drive trains: the exact flow in several freedoms against one freedom, closed forms and an independent integrator."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import dynamics
from base import InputError
from dynamics import DriveOscillator, FourierStiffness, GearOscillator, find_orbit, period_map, trajectory
from dynamics.flow.drive_flow import drive_flow
from dynamics.model.drive_coordinates import coordinates_of

SERIES = FourierStiffness(1.0, (0.18, 0.05), (0.3, 1.0))
ERROR, PHASE = (0.2, 0.03), (0.4, 1.0)
START = np.array([0.5, 0.2])
KICK = np.array([0.3, -0.4, 0.1, 0.2, 0.5, -0.6, 0.2, 0.1])


def same_as(gear: GearOscillator) -> DriveOscillator:
    """The drive of one freedom with the equation of a GearOscillator."""
    return DriveOscillator(
        [[1.0]], [[0.0]], [[0.0]], [1.0], gear.stiffness, 2.0 * gear.damping_ratio, [gear.mean_force],
        gear.error_amplitude, gear.frequency, gear.half_backlash, gear.error_phase, gear.one_sided,
        2.0 * gear.damping_ratios[1],
    )  # fmt: skip


def chain(**changes) -> DriveOscillator:
    """Motor, pinion, wheel and load: four freedoms along the line of action, soft shafts, all of it held."""
    mass = np.diag([2.0, 0.9, 1.3, 3.0])
    joints = [(0, 1, 0.8), (2, 3, 0.6)]
    stiff = np.diag([0.05, 0.0, 0.0, 0.1])
    for i, j, k in joints:
        rows = np.zeros(4)
        rows[i], rows[j] = 1.0, -1.0
        stiff += k * np.outer(rows, rows)
    given = {
        "mass": mass, "damping": 0.02 * mass + 0.03 * stiff, "stiffness": stiff, "direction": [0.0, 1.0, 1.0, 0.0],
        "mesh_stiffness": SERIES, "mesh_damping": 0.03, "mean_force": [0.1, 0.0, 0.0, 0.12],
        "error_amplitude": ERROR, "error_phase": PHASE, "frequency": 0.9, "half_backlash": 0.15,
    }  # fmt: skip
    return DriveOscillator(**{**given, **changes})


def by_steps(drive: DriveOscillator, state, duration: float, max_step=0.1):
    """State, derivative and crossings by scipy, in q itself, in the stretches between crossings."""
    n = drive.dimension // 2
    mass, damping, stiffness, g, force = (
        np.asarray(getattr(drive, name))
        for name in ("mass", "damping", "stiffness", "direction", "mean_force")
    )
    inverse, d, w = np.linalg.inv(mass), drive.half_backlash, drive.frequency
    error, phase = (np.atleast_1d(part) for part in (drive.error_amplitude, drive.error_phase))
    j = np.arange(1, len(error) + 1)
    swing, turn = (np.atleast_1d(part) for part in (drive.force_amplitude, drive.force_phase))
    i = np.arange(1, len(swing) + 1)
    along = np.zeros(n) if drive.force_direction is None else np.asarray(drive.force_direction)

    def gap(t, q):
        return g @ q - error @ np.cos(j * w * t + phase)

    def rate(t, speed):
        return g @ speed + (j * w * error) @ np.sin(j * w * t + phase)

    def system(t, region):
        k = drive.mesh_stiffness(w * t) if region else 0.0
        c = drive.mesh_damping if region or drive.free_mesh_damping is None else drive.free_mesh_damping
        return float(k), c

    y = np.concatenate([state, np.eye(2 * n).ravel()])
    now, region = 0.0, int(np.sign(gap(0.0, y[:n]))) * (abs(gap(0.0, y[:n])) > d)
    crossings = 0
    while True:

        def rhs(t, y, region=region or int(d == 0.0)):
            k, c = system(t, region)
            q, speed = y[:n], y[n : 2 * n]
            push = k * (gap(t, q) - region * d) + c * rate(t, speed)
            columns = y[2 * n :].reshape(2 * n, 2 * n)
            bent = inverse @ (
                (stiffness + k * np.outer(g, g)) @ columns[:n] + (damping + c * np.outer(g, g)) @ columns[n:]
            )
            pressed = force + along * (swing @ np.cos(i * w * t + turn))
            bend = inverse @ (pressed - damping @ speed - stiffness @ q - g * push)
            return np.concatenate([speed, bend, columns[n:].ravel(), -bent.ravel()])

        def upper(t, y):
            return gap(t, y[:n]) - d

        def lower(t, y):
            return gap(t, y[:n]) + d

        upper.terminal = lower.terminal = True
        upper.direction, lower.direction = (-1 if region == 1 else 1), (1 if region == -1 else -1)
        events = [upper] if region == 1 else [lower] if region == -1 else [upper, lower]
        if d == 0.0:
            region, events = 1, None  # f(y) = y: nothing to cross
        done = solve_ivp(
            rhs, (now, duration), y, "DOP853", events=events, rtol=1e-12, atol=1e-14, max_step=max_step
        )
        now, y = done.t[-1], done.y[:, -1].copy()
        if done.status != 1:
            return y[: 2 * n], y[2 * n :].reshape(2 * n, 2 * n), crossings
        crossings += 1
        before = system(now, region)[1]
        region = 0 if region else (1 if len(done.t_events[0]) else -1)
        jump = system(now, region)[1] - before
        columns = y[2 * n :].reshape(2 * n, 2 * n)
        columns[n:] -= jump * np.outer(inverse @ g, g @ columns[:n])


GEARS = [
    GearOscillator(SERIES, 0.05, 0.1, ERROR, 0.6, 0.2, PHASE),
    GearOscillator(SERIES, 0.01, -0.05, ERROR, 1.3, 0.0, PHASE),
    GearOscillator(SERIES, 0.02, 0.05, 0.4, 0.9, 0.5, one_sided=True),
    GearOscillator(SERIES, 0.05, 0.1, ERROR, 0.6, 0.2, PHASE, free_damping_ratio=0.3),
    GearOscillator(SERIES, 0.05, 0.1, ERROR, 0.6, 0.2, PHASE, one_sided=True, free_damping_ratio=0.0),
]


@pytest.mark.parametrize(
    "gear", GEARS, ids=["two flanks", "no play", "one flank", "damping jumps", "none between"]
)
def test_one_freedom_is_the_gear_oscillator(gear):
    """States, Jacobian, damping and impacts to 1e-13 over five periods: neither flow has an error but rounding."""
    drive = same_as(gear)
    shift = np.ravel(drive.error_motion(np.zeros(1)))
    ours, theirs = period_map(drive, shift + START, 5), period_map(gear, START, 5)
    assert ours.states - shift == pytest.approx(theirs.states, abs=1e-13)
    near = (
        1e-13 if gear.free_damping_ratio is None else 1e-12
    )  # what was larger on the way leaves its rounding
    assert ours.jacobian == pytest.approx(theirs.jacobian, abs=near * np.max(np.abs(theirs.jacobian)))
    assert ours.log_determinant == pytest.approx(theirs.log_determinant, rel=1e-14)
    assert np.array_equal(ours.counts, theirs.counts)
    mine, other = trajectory(drive, shift + START, 2, 25), trajectory(gear, START, 2, 25)
    assert mine.columns()[:, 0] == pytest.approx(other.tau)
    assert np.column_stack([mine.x, mine.v]) == pytest.approx(other.states, abs=1e-13)
    assert mine.events == pytest.approx(other.events, abs=1e-12)
    assert mine.extrema == pytest.approx(other.extrema, abs=1e-12)


@pytest.mark.parametrize("size", [1e-18, 1e18])
def test_free_rotations_are_those_of_the_train_in_any_unit(size):
    """Stiffness and damping of any size beside each other: a held train has none, one that nothing holds has one."""
    mass, n = np.diag([2.0, 0.9, 1.3, 3.0]), 4
    joint = np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = np.kron(np.eye(2), 0.7 * joint)  # two shafts that turn freely but for the mesh
    held = free + np.diag([0.05, 0.0, 0.0, 0.1])
    g = np.array([0.0, 1.0, 1.0, 0.0])
    for stiffness, left_out in ((held, 0), (free, 1)):
        found = coordinates_of(mass, 0.01 * stiffness, size * stiffness, g)
        assert found.down.shape == (n - left_out, n)
        assert found.drift.shape == (left_out, n)


@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("one_sided", [False, True])
def test_a_drive_rests_where_forces_balance(one_sided, apart):
    """Static balance of the train: forces that pull the flanks apart are held by the second flank, if there is one."""
    force = np.array([0.1, 0.0, 0.0, 0.12]) * (-1.0 if apart else 1.0)
    drive = chain(one_sided=one_sided, mean_force=force, error_amplitude=0.0, error_phase=0.0)
    q, speed = drive.rest_state().reshape(2, 4)
    g = np.asarray(drive.direction)
    y, d = float(g @ q), drive.half_backlash
    push = drive.mesh_stiffness.mean * (max(y - d, 0.0) if one_sided else y - np.clip(y, -d, d))
    assert np.asarray(drive.stiffness) @ q + push * g == pytest.approx(force, abs=1e-12)
    assert np.sign(push) == (-(not one_sided) if apart else 1.0)
    assert not speed.any()
    uneven = chain(one_sided=one_sided, mean_force=force)
    tau = np.array([0.0, 1.3])
    at, rate = uneven.contact_motion(tau, uneven.balanced(tau))
    assert at == pytest.approx([y, y], abs=1e-12)  # at rest about the error
    assert rate == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    "changes",
    [{}, {"free_mesh_damping": 0.4}, {"half_backlash": 0.0}, {"mean_force": [-0.1, 0.0, 0.0, -0.2]}],
    ids=["chain", "damping jumps", "no play", "other flank"],
)
def test_four_freedoms_against_an_integrator(changes):
    """States to 1e-9 after two periods with impacts, Jacobian to 1e-8: what the integrator's tolerance leaves."""
    drive = chain(**changes)
    start = drive.rest_state() + KICK
    state, jacobian, crossings = by_steps(drive, start, 2 * drive.period)
    ours = period_map(drive, start, 2)
    assert crossings > 3 or drive.half_backlash == 0.0
    assert ours.state == pytest.approx(state, abs=1e-9)
    assert ours.jacobian == pytest.approx(jacobian, abs=1e-8 * np.max(np.abs(jacobian)))


@pytest.mark.parametrize(
    "changes",
    [
        {"mean_force": [0.4, 0.0, 0.0, 0.48], "frequency": 0.11},  # never out of contact
        {"frequency": 0.23, "half_backlash": 0.05},  # impacts in some strides, on both flanks
        {"frequency": 0.23, "mean_force": [-0.1, 0.0, 0.0, -0.12]},  # mostly on the other flanks
    ],
)
def test_strides_of_many_cells_are_the_cells_one_by_one(changes):
    """A motion that is followed for long takes eight cells at once where no impact can be; derivatives as well."""
    drive = chain(free_mesh_damping=0.01, **changes)
    start = drive.rest_state() + (1.0 if drive.frequency > 0.2 else 0.05) * KICK
    cells = drive_flow(drive)
    short = [cells.follow(start)]
    for _ in range(3):
        short.append(cells.follow(short[-1].state))
    assert "in_strides" not in vars(cells)
    strides = drive_flow(drive)
    assert len(strides.in_strides[-1]) == strides.cells // 8 > 4
    found = strides.follow(start, 4)
    np.testing.assert_allclose(found.states, [one.state for one in short], rtol=0.0, atol=1e-12)
    jacobian = np.linalg.multi_dot([one.jacobian for one in reversed(short)])
    np.testing.assert_allclose(found.jacobian, jacobian, rtol=0.0, atol=1e-11)
    np.testing.assert_array_equal(found.counts, np.vstack([one.counts for one in short]))
    assert found.log_determinant == pytest.approx(sum(one.log_determinant for one in short), rel=1e-12)
    many = drive_flow(drive)
    many.follow(start, 100, derivatives=False)
    assert "in_strides" in vars(many)


def test_unlike_masses_and_matrices_that_are_not_symmetric():
    """A full mass matrix, cross-coupled stiffness and gyroscopic damping: nothing is assumed but a mass."""
    rng = np.random.default_rng(3)
    root = rng.normal(size=(3, 3))
    drive = DriveOscillator(
        root @ root.T + np.eye(3), 0.1 * np.eye(3) + 0.3 * (root - root.T), np.eye(3) + 0.3 * root,
        [1.0, -0.4, 0.7], SERIES, 0.05, [0.2, 0.1, -0.1], 0.1, 0.8, 0.1,
    )  # fmt: skip
    start = np.array([0.4, -0.2, 0.1, 0.3, 0.2, -0.5])
    state, jacobian, crossings = by_steps(drive, start, drive.period)
    ours = period_map(drive, start)
    assert crossings > 0
    assert ours.state == pytest.approx(state, abs=1e-9)
    assert ours.jacobian == pytest.approx(jacobian, abs=1e-8)


@pytest.mark.parametrize("free", [None, 0.5])
def test_determinant_is_what_damping_takes(free):
    """det of the monodromy is exp(-int tr(M^-1 (C + c g g^T)) dt), c that of contact or of the dead zone."""
    drive = chain(free_mesh_damping=free)
    start = drive.rest_state() + 0.4
    image = period_map(drive, start, 3)
    motion = trajectory(drive, start, 3, 2000)
    apart = np.mean(np.abs(motion.x[:-1]) < drive.half_backlash)
    inverse, g = np.linalg.inv(drive.mass), np.asarray(drive.direction)
    pressed = np.trace(inverse @ (drive.damping + drive.mesh_damping * np.outer(g, g)))
    extra = (0.0 if free is None else free - drive.mesh_damping) * g @ inverse @ g
    assert 0.1 < apart < 0.9
    # the share of time between the flanks is counted on samples
    expected = -3 * drive.period * (pressed + extra * apart)
    assert image.log_determinant == pytest.approx(expected, rel=1e-13 if free is None else 2e-3)
    assert np.linalg.slogdet(image.jacobian)[1] == pytest.approx(image.log_determinant, abs=1e-11)


def test_monodromy_is_the_derivative():
    """Central differences of the map, with their own error of 1e-8."""
    drive = chain(free_mesh_damping=0.2)
    start = drive.rest_state() + 0.3
    step, image = 1e-5, period_map(drive, start, 1)
    for k in range(8):
        ahead, back = (period_map(drive, start + way * step * np.eye(8)[k]).state for way in (1, -1))
        assert (ahead - back) / (2 * step) == pytest.approx(image.jacobian[:, k], abs=1e-8)


def test_without_damping_energy_is_kept():
    """A constant mesh, no error, no damping: kinetic and potential energy over 40 periods with all their impacts."""
    drive = chain(
        damping=np.zeros((4, 4)), mesh_damping=0.0, mesh_stiffness=FourierStiffness(1.0), error_amplitude=0.0,
        error_phase=0.0,
    )  # fmt: skip
    motion = trajectory(drive, drive.rest_state() + 0.5, 40, 20)
    q, speed = motion.states[:, :4], motion.states[:, 4:]
    past = motion.x - np.clip(motion.x, -drive.half_backlash, drive.half_backlash)
    energy = 0.5 * np.einsum("ti,ij,tj->t", speed, drive.mass, speed)
    energy += 0.5 * np.einsum("ti,ij,tj->t", q, drive.stiffness, q) - q @ np.asarray(drive.mean_force)
    energy += 0.5 * past**2
    assert len(motion.events) > 40
    assert energy == pytest.approx(np.full(len(energy), energy[0]), abs=1e-12)


def test_freedom_apart_moves_by_itself():
    """A freedom that touches nothing else and is no part of the mesh: the closed form of a damped oscillator."""
    drive = DriveOscillator(
        np.diag([1.0, 2.0]), np.diag([0.1, 0.3]), np.diag([0.4, 1.7]), [1.0, 0.0], SERIES, 0.05, [0.2, 0.3], 0.1, 0.8,
        0.1,
    )  # fmt: skip
    state = np.array([0.3, 0.2, 0.1, -0.4])
    system = np.array([[0.0, 1.0], [-1.7 / 2.0, -0.3 / 2.0]])
    rest = np.array([0.3 / 1.7, 0.0])
    moved = expm(system * drive.period) @ (state[[1, 3]] - rest) + rest
    assert period_map(drive, state).state[[1, 3]] == pytest.approx(moved, abs=1e-14)


def test_in_contact_without_variation_it_is_a_linear_system():
    """Constant mesh stiffness, pressed together throughout: the response to the error by the complex stiffness."""
    drive = chain(
        mesh_stiffness=FourierStiffness(1.0),
        mean_force=[5.0, 0.0, 0.0, 6.0],
        error_amplitude=0.1,
        error_phase=0.0,
    )
    orbit = find_orbit(drive, drive.rest_state())
    w, g = drive.frequency, np.asarray(drive.direction)
    whole = drive.stiffness + np.outer(g, g) + 1j * w * (drive.damping + drive.mesh_damping * np.outer(g, g))
    swing = np.linalg.solve(whole - w**2 * drive.mass, g * (1.0 + 1j * w * drive.mesh_damping) * 0.1)
    rest = np.linalg.solve(
        drive.stiffness + np.outer(g, g), np.asarray(drive.mean_force) + g * drive.half_backlash
    )
    assert orbit.label == "1-0-0"
    assert orbit.state == pytest.approx(np.concatenate([rest + swing.real, (1j * w * swing).real]), abs=1e-12)


def pair(**changes) -> DriveOscillator:
    """Two gears, nothing that holds them: q are their motions along the line of action."""
    given = {
        "mass": np.diag([2.0, 3.0]), "damping": np.zeros((2, 2)), "stiffness": np.zeros((2, 2)),
        "direction": [1.0, -1.0],
        "mesh_stiffness": SERIES, "mesh_damping": 0.12, "mean_force": [0.12, -0.12], "error_amplitude": ERROR,
        "error_phase": PHASE, "frequency": 0.7, "half_backlash": 0.2,
    }  # fmt: skip
    return DriveOscillator(**{**given, **changes})


def test_free_train_is_the_oscillator_of_its_mesh():
    """Two free gears: their relative motion is one freedom of mass m1 m2 / (m1 + m2) = 1.2."""
    free = pair()
    mass = 1.2
    one = DriveOscillator([[mass]], [[0.0]], [[0.0]], [1.0], SERIES, 0.12, [0.12], ERROR, 0.7, 0.2, PHASE)
    orbit = find_orbit(free, free.rest_state(), transient=200)
    other = find_orbit(one, one.rest_state(), transient=200)
    assert orbit.state[[0, 2]] - orbit.state[[1, 3]] == pytest.approx(other.state, abs=1e-12)
    assert free.mass.diagonal() @ orbit.state[:2] == pytest.approx(0.0, abs=1e-13)
    assert orbit.multipliers[:2] == pytest.approx(other.multipliers, abs=1e-12)
    assert orbit.multipliers[2:] == pytest.approx(np.zeros(2), abs=1e-15)
    assert len(dynamics.lyapunov_exponents(free, 40, transient=0).exponents) == 2
    turned = orbit.state + np.array([1.0, 1.0, 0.5, 0.5])
    assert period_map(free, turned).state == pytest.approx(orbit.state, abs=1e-12)


@pytest.mark.parametrize("rounding", [1e-18, -1e-15, 1e-11])
def test_a_free_rotation_may_carry_the_rounding_of_the_load(rounding: float):
    """A rotation that is a coordinate: nothing cancels in its load, which is measured by that of the others."""

    def turning(load: float) -> DriveOscillator:
        return DriveOscillator(
            np.eye(2), np.diag([0.0, 0.1]), np.diag([0.0, 0.5]), [0.0, 1.0], SERIES, 0.05, [load, 0.2], 0.1, 0.7, 0.2
        )  # fmt: skip

    assert turning(rounding).directions == 2
    assert np.array_equal(turning(rounding).rest_state(), turning(0.0).rest_state())
    for load in (1e-3, 1e-8):
        with pytest.raises(InputError, match="must balance over a rotation"):
            turning(load)


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"mean_force": [0.12, 0.1]}, "mean_force", "must balance over a rotation"),
        ({"damping": np.diag([0.1, 0.0])}, "stiffness", "must hold every freedom"),
        ({"mass": np.diag([1.0, 0.0])}, "mass", "must be positive definite"),
        ({"mass": [[1.0, 0.1], [0.0, 1.0]]}, "mass", "must be symmetric"),
        ({"direction": [0.0, 0.0]}, "direction", "must not be zero"),
        ({"stiffness": np.eye(3)}, "stiffness", "finite numbers of shape"),
        ({"mean_force": [1.0]}, "mean_force", "finite numbers of shape"),
        ({"mesh_stiffness": 1.0}, "mesh_stiffness", "must be a FourierStiffness"),
        ({"mesh_damping": -1.0}, "mesh_damping", "at least 0"),
        ({"frequency": 1e-9, "mass": np.eye(2)}, "frequency", "must give tables of at most"),
    ],
)
def test_what_cannot_move_is_refused_by_name(changes, where, words):
    with pytest.raises(InputError, match=words) as raised:
        pair(**changes)
    assert raised.value.faults[0].where == where


def test_parameters_by_name():
    drive = chain(free_mesh_damping=0.1)
    assert drive.get("mean_force[3]") == 0.12
    assert drive.with_parameter("mean_force[3]", 0.5).mean_force.tolist() == [0.1, 0.0, 0.0, 0.5]
    assert drive.with_parameter("mesh_stiffness.amplitudes[1]", 0.3).mesh_stiffness.amplitudes == (0.18, 0.3)
    for name in drive.parameters:
        assert drive.with_parameter(name, drive.get(name)).get(name) == drive.get(name)
    with pytest.raises(InputError, match="must be one of frequency, error_amplitude"):
        drive.get("mass")
    assert dataclasses.replace(drive, frequency=0.5).frequency == 0.5


def test_orbits_sweeps_and_exponents_are_those_of_one_freedom():
    """What is made of the map: the same orbit, multipliers, labels, exponents and basins."""
    gear = GEARS[0]
    drive = same_as(gear)
    shift = np.ravel(drive.error_motion(np.zeros(1)))
    ours, theirs = find_orbit(drive, shift + START), find_orbit(gear, START)
    assert ours.converged
    assert ours.label == theirs.label
    assert ours.state - shift == pytest.approx(theirs.state, abs=1e-13)
    assert ours.multipliers == pytest.approx(theirs.multipliers, abs=1e-13)
    for value in (0.5, 0.7):
        here = drive.with_parameter("frequency", value)
        moved = np.ravel(here.error_motion(np.zeros(1)))
        options = {"transient": 100, "keep": 8, "max_period": 4}
        mine = dynamics.sweep(drive, "frequency", [value], initial=moved + START, **options)
        other = dynamics.sweep(gear, "frequency", [value], initial=START, **options)
        assert mine.labels == other.labels
        assert mine.states[0] - moved == pytest.approx(other.states[0], abs=1e-9)
    grown, other = (dynamics.lyapunov_exponents(osc, 40, transient=20) for osc in (drive, gear))
    assert grown.exponents == pytest.approx(other.exponents, abs=1e-11)
    field, other = (
        dynamics.basins(osc, x=(-0.9, 0.9, 4), v=(-0.9, 0.9, 4), limit=60, **more)
        for osc, more in ((drive, {"through": shift}), (gear, {}))
    )
    assert np.array_equal(field.labels, other.labels)
    assert [a.label for a in field.attractors] == [a.label for a in other.attractors]


def test_exponents_add_up_to_all_damping():
    jumping = dynamics.lyapunov_scan(chain(free_mesh_damping=0.3), "frequency", [0.8], 40, transient=10)
    assert jumping.defect < 1e-12
    drive = chain()
    found = dynamics.lyapunov_scan(drive, "frequency", [0.8, 1.1], 40, transient=10)
    assert found.exponents.shape == (2, 8)
    total = np.trace(drive.coordinates.damping) + drive.coordinates.gain * drive.mesh_damping
    assert found.exponents.sum(axis=1) == pytest.approx(np.full(2, -total), abs=1e-12)
    assert found.defect < 1e-12


def test_basins_on_a_plane_of_choice():
    """Starts in the plane of the motor's motion; each comes to where it comes to when it is followed."""
    drive = chain(mean_force=[0.02, 0.0, 0.0, 0.03], error_amplitude=0.5, error_phase=0.0)
    plane, through = np.eye(8)[[0, 4]], drive.rest_state()
    found = dynamics.basins(
        drive, x=(-2.0, 2.0, 3), v=(-2.0, 2.0, 3), plane=plane, through=through, limit=100
    )
    start = through + 2.0 * plane[0] - 2.0 * plane[1]
    label = found.labels[2, 0]
    assert label >= 0
    orbit = found.attractors[label].orbit
    end = period_map(drive, start, orbit.periods, 400 * orbit.periods - 1).states
    assert np.min(np.max(np.abs(end - orbit.state), axis=1)) < 1e-4
    with pytest.raises(InputError, match="must be two independent directions of 8 numbers"):
        dynamics.basins(drive, x=(-1, 1, 2), v=(-1, 1, 2), plane=np.ones((2, 8)))
    with pytest.raises(InputError, match="must be 8 finite numbers, 4 displacements"):
        find_orbit(drive, (0.1, 0.2))


def test_modal_damping_gives_each_mode_its_ratio():
    """Eigenvalues of the damped system lie at -zeta omega; a free train keeps its free rotation."""
    mass = np.diag([1.0, 2.0, 3.0])
    stiff = np.array([[2.0, -2.0, 0.0], [-2.0, 5.0, -3.0], [0.0, -3.0, 3.0]])
    damping = dynamics.modal_damping(mass, stiff, (0.02, 0.05))
    assert damping @ np.ones(3) == pytest.approx(np.zeros(3), abs=1e-14)
    inverse = np.linalg.inv(mass)
    system = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ stiff, -inverse @ damping]])
    values = [v for v in np.linalg.eigvals(system) if v.imag > 1e-3]
    values.sort(key=abs)
    assert [-v.real / abs(v) for v in values] == pytest.approx([0.02, 0.05], abs=1e-12)
    with pytest.raises(InputError, match="must be one, or 2"):
        dynamics.modal_damping(mass, stiff, (0.1, 0.1, 0.1))
    with pytest.raises(InputError, match="must be symmetric"):
        dynamics.modal_damping(mass, stiff + np.triu(stiff), 0.1)


def test_rayleigh_damping_by_frequency():
    """A mode of frequency omega has alpha / (2 omega) + beta omega / 2."""
    damping = dynamics.rayleigh_damping([[2.0]], [[18.0]], of_mass=0.12, of_stiffness=0.02)
    assert damping[0, 0] / (2.0 * np.sqrt(2.0 * 18.0)) == pytest.approx(
        0.12 / 6.0 + 0.02 * 3.0 / 2.0, rel=1e-14
    )
    with pytest.raises(InputError, match="of_stiffness"):
        dynamics.rayleigh_damping([[2.0]], [[18.0]], of_stiffness=-1.0)
