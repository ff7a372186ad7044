"""The stepwise flow: against closed forms, against the exact flow, its derivatives, its events."""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.special import beta, ellipj, ellipk

from dynamics import (
    CompiledLaw,
    FourierStiffness,
    GearOscillator,
    PowerContact,
    SmoothedBacklash,
    SmoothOscillator,
    SqueezeFilm,
    Surface,
    TabulatedContact,
    period_map,
    trajectory,
)
from dynamics.branches.sensitivity import map_derivatives
from dynamics.kernels.stepwise import tableau

SERIES = FourierStiffness(1.0, (0.3, 0.1), (0.4, -1.1))


def duffing(theta, x, v, region, q):
    return q[0] * x + q[1] * x * x * x


def friction(theta, x, v, region, q):
    return x + (q[0] if region & 1 else -q[0])


def linear_contact(d=0.2, **options) -> PowerContact:
    return PowerContact(stiffness=SERIES, half_backlash=d, exponent=1.0, **options)


def test_tableau_meets_the_order_conditions():
    stages = slice(0, tableau.STAGES)
    for k in range(8):
        assert tableau.B @ tableau.C[stages] ** k == pytest.approx(1 / (k + 1), abs=1e-15)
        if k < 5:  # the estimates see what schemes of order 3 and 5 do not
            assert tableau.E5[stages] @ tableau.C[stages] ** k == pytest.approx(0.0, abs=1e-14)
        if k < 3:
            assert tableau.E3[stages] @ tableau.C[stages] ** k == pytest.approx(0.0, abs=1e-14)
    assert tableau.A.sum(axis=1)[:12] == pytest.approx(tableau.C[:12], abs=1e-15)
    assert tableau.A.sum(axis=1)[13:] == pytest.approx(tableau.C[13:], abs=1e-15)


def one_step(y, h: float):
    """A step of x'' + x + x^3 = 0 straight from the tableau, and X and V on 21 places of it."""
    k = np.zeros((16, 2))
    for s in range(16):
        weights = tableau.A[s, :s] if s != tableau.STAGES else tableau.B
        x, v = y + h * weights @ k[:s]
        k[s] = v, -x - x**3
    end = y + h * tableau.B @ k[: tableau.STAGES]
    rise = end - y
    parts = [rise, h * k[0] - rise, 2 * rise - h * (k[tableau.STAGES] + k[0]), *(h * tableau.DENSE @ k)]
    s = np.linspace(0, 1, 21)[:, None]
    inside = np.zeros((21, 2))
    for i, part in enumerate(parts[::-1]):
        inside = (inside + part) * (s if i % 2 == 0 else 1 - s)
    return end, y + inside


def duffing_motion(size: float, t):
    """X and V of x'' + x + x^3 = 0 from rest at `size`."""
    w = np.sqrt(1 + size**2)
    sn, cn, dn, _ = ellipj(w * np.asarray(t), size**2 / (2 * (1 + size**2)))
    return size * cn, -size * w * sn * dn


def test_order_of_step_and_dense_output():
    """Errors after the same time fall by 2^8 as steps are halved; within one step too."""
    ends, between = [], []
    for count in (10, 20, 40, 80):
        h, y = 5.0 / count, np.array([1.3, 0.0])
        for _ in range(count):
            y, _ = one_step(y, h)
        ends.append(np.max(np.abs(y - np.array(duffing_motion(1.3, 5.0)))))
        middle = np.array(duffing_motion(1.3, 0.7))
        inside = np.array(duffing_motion(1.3, 0.7 + h * np.linspace(0, 1, 21))).T
        between.append(np.max(np.abs(one_step(middle, h)[1] - inside)))
    assert np.log2(ends[0] / ends[3]) / 3 == pytest.approx(8.0, abs=0.4)
    assert np.log2(between[0] / between[3]) / 3 == pytest.approx(8.0, abs=0.4)


def test_error_falls_with_the_eighth_power_of_the_work_or_faster():
    """The compiled flow with its choice of steps, on a smooth law."""
    osc = SmoothOscillator(CompiledLaw(duffing, (("a", 1.0), ("b", 1.0))), 0.0, 0.0, 0.0, 1.0)
    exact = duffing_motion(1.3, 6 * np.pi)
    work, errors = [], []
    for tolerance in 10.0 ** np.arange(-12, -5):
        done = period_map(osc, (1.3, 0.0), 3, tolerance=tolerance)
        work.append(done.cost.counts["evaluations of the law"])
        errors.append(np.max(np.abs(done.state - exact)))
    assert np.polyfit(np.log(work), np.log(errors), 1)[0] < -7.7


@pytest.mark.parametrize("size", [0.1, 1.0, 10.0])
def test_duffing_period(size):
    """A free undamped motion returns after 4 K(m)/sqrt(1 + a^2)."""
    period = 4 * ellipk(size**2 / (2 * (1 + size**2))) / np.sqrt(1 + size**2)
    law = CompiledLaw(duffing, (("a", 1.0), ("b", 1.0)), size=size)
    done = period_map(SmoothOscillator(law, 0.0, 0.0, 0.0, 2 * np.pi / period), (size, 0.0), tolerance=1e-13)
    assert np.max(np.abs(done.state - (size, 0.0))) < 3e-12 * size * np.sqrt(1 + size**2)


@pytest.mark.parametrize(("n", "d"), list(itertools.product((1.0, 10 / 9, 1.5, 3.0), (0.0, 0.2))))
def test_period_of_a_power_law(n, d):
    """4 sqrt((n+1)/2) a^((1-n)/2) B(1/(n+1), 1/2)/(n+1) in contact and 4 D/v in the gap."""
    a = 0.7
    touch = np.sqrt(2 / (n + 1)) * a ** ((n + 1) / 2)
    inside = 4 * np.sqrt((n + 1) / 2) * a ** ((1 - n) / 2) * beta(1 / (n + 1), 0.5) / (n + 1)
    law = PowerContact(stiffness=FourierStiffness(1.0), half_backlash=d, exponent=n)
    osc = SmoothOscillator(law, 0.0, 0.0, 0.0, 2 * np.pi / (inside + 4 * d / touch))
    done = period_map(osc, (a + d, 0.0), 3, tolerance=1e-13)
    assert np.max(np.abs(done.state - (a + d, 0.0))) < 1e-11
    assert done.counts.tolist() == [[1, 1]] * 3


def test_energy_is_kept():
    law = PowerContact(stiffness=FourierStiffness(1.0), half_backlash=0.1, exponent=1.5)
    osc = SmoothOscillator(law, 0.0, 0.0, 0.0, 0.3)
    path = trajectory(osc, (0.8, 0.1), 20, 30, tolerance=1e-13)
    depth = np.maximum(np.abs(path.x) - 0.1, 0.0)
    energy = 0.5 * path.v**2 + depth**2.5 / 2.5
    assert np.ptp(energy) < 1e-10 * energy[0]


def random_pairs():
    rng = np.random.default_rng(7)
    for d in (0.2, 0.0, 1e-13, 0.05, 0.3, 0.0):
        phases = rng.uniform(-3, 3, 3)
        series = FourierStiffness(1.0, tuple(rng.uniform(0, 0.5, 2)), tuple(phases[:2]))
        z, f, e, w = rng.uniform((0.0, -0.2, 0.0, 0.3), (0.3, 0.2, 0.4, 2.5))
        yield d, series, z, f, e, w, phases[2], bool(rng.integers(2)), rng.uniform(-0.6, 0.6, 2)


@pytest.mark.parametrize("case", list(random_pairs()))
def test_exponent_one_is_the_exact_flow(case):
    """State, Jacobian and derivatives by every parameter agree with the exact flow's."""
    d, series, z, f, e, w, phase, one_sided, start = case
    law = PowerContact(stiffness=series, half_backlash=d, exponent=1.0, one_sided=one_sided)
    osc = SmoothOscillator(law, z, f, e, w, phase)
    names = GearOscillator(series, z, f, e, w, d, phase, one_sided).parameters
    exact = map_derivatives(GearOscillator(series, z, f, e, w, d, phase, one_sided), start, periods=2)
    done = period_map(osc, start, 2, parameters=names, tolerance=1e-13)
    size = max(1.0, np.max(np.abs(exact.jacobian)))
    assert np.max(np.abs(done.state - exact.state)) < 1e-11 * size
    assert done.error < 1e-11 * size
    assert np.max(np.abs(done.jacobian - exact.jacobian)) < 1e-11 * size
    assert np.max(np.abs(done.slope - exact.slope)) < 1e-10 * max(1.0, np.max(np.abs(exact.slope)))
    assert tuple(done.counts.sum(axis=0)) == exact.counts
    assert done.log_determinant == pytest.approx(-2 * z * osc.period * 2, abs=1e-13)


@pytest.mark.parametrize(
    ("kappa", "zeta", "frequency", "d"),
    [
        (5.0, 0.05, 0.6, 0.2),
        (1.5, 0.0, 50.0, 0.2),
        (0.2, 2.0, 0.6, 0.2),
        (0.2, 0.05, 0.02, 0.2),
        (0.5, 0.0, 0.6, 1e-13),
    ],
)
def test_hard_cases_against_the_exact_flow(kappa, zeta, frequency, d):
    """Negative stiffness, no and much damping, long and short periods: within the tolerance times the stretch."""
    series = FourierStiffness(1.0, (kappa,), (0.0,))
    exact = map_derivatives(GearOscillator(series, zeta, 0.1, 0.2, frequency, d), (0.5, 0.2), ("mean_force",))
    law = PowerContact(stiffness=series, half_backlash=d, exponent=1.0)
    osc = SmoothOscillator(law, zeta, 0.1, 0.2, frequency)
    done = period_map(osc, (0.5, 0.2), parameters=("mean_force",), tolerance=1e-13)
    stretch = max(1.0, np.max(np.abs(exact.jacobian)))
    assert np.max(np.abs(done.state - exact.state)) < 1e-11 * stretch
    assert np.max(np.abs(done.jacobian - exact.jacobian)) < 1e-10 * stretch
    assert np.max(np.abs(done.slope - exact.slope)) < 1e-10 * max(stretch, np.max(np.abs(exact.slope)))
    assert tuple(done.counts[0]) == exact.counts
    assert done.log_determinant == pytest.approx(-2 * zeta * osc.period, rel=1e-12, abs=1e-13)


def laws():
    film = SqueezeFilm(0.2, 0.05)
    depths = np.linspace(0, 1, 13) ** 2 * 2.0
    angles = 2 * np.pi * np.arange(9) / 9
    forces = (1 + 0.2 * np.cos(angles))[:, None] * depths**1.2
    return {
        "power": PowerContact(stiffness=SERIES, half_backlash=0.2),
        "power with film": PowerContact(stiffness=SERIES, half_backlash=0.2, exponent=1.5, film=film),
        "smoothed": SmoothedBacklash(stiffness=SERIES, half_backlash=0.2, width=0.03),
        "table": TabulatedContact.from_forces(depths, forces, half_backlash=0.2, order=2, film=film),
        "own": CompiledLaw(duffing, (("a", 1.0), ("b", 2.0))),
        "friction": CompiledLaw(friction, (("mu", 0.05),), (Surface((0.0, 1.0)),)),
        "moving belt": CompiledLaw(
            friction, (("mu", 0.05), ("speed", 0.05)), (Surface((0.0, 1.0), "speed"),)
        ),
    }


@pytest.mark.parametrize("name", list(laws()))
def test_derivatives_against_differences(name):
    """Jacobian and slopes by central differences of the map; det by Liouville's equation, jumps included."""
    osc = SmoothOscillator(laws()[name], 0.03, 0.1, 0.25, 0.7, 0.3)
    start = np.array([0.5, 0.2])
    done = period_map(osc, start, parameters=osc.parameters, tolerance=1e-13)
    assert done.message == ""
    h = 1e-5

    def image(state, parameter=None, change=0.0):
        here = osc if parameter is None else osc.with_parameter(parameter, osc.get(parameter) + change)
        return period_map(here, state, tolerance=1e-14).state

    for j in range(2):
        step = h * np.eye(2)[j]
        column = (image(start + step) - image(start - step)) / (2 * h)
        assert column == pytest.approx(done.jacobian[:, j], abs=2e-7)
    for j, parameter in enumerate(osc.parameters):
        if parameter.startswith("film") and osc.get(parameter) < h:
            continue  # no negative damping
        column = (image(start, parameter, h) - image(start, parameter, -h)) / (2 * h)
        assert column == pytest.approx(done.slope[:, j], abs=1e-6 * max(1, np.max(np.abs(done.slope)))), (
            parameter
        )
    assert np.log(np.linalg.det(done.jacobian)) == pytest.approx(done.log_determinant, abs=1e-11)
    film = getattr(osc.law, "film", None)
    if film is not None and film.damping == 0.0:
        assert done.log_determinant == pytest.approx(-0.06 * osc.period, abs=1e-13)


@pytest.mark.parametrize("name", ["power", "friction", "table"])
def test_events_are_the_same_with_derivatives(name):
    """They are looked for along the same path."""
    osc = SmoothOscillator(laws()[name], 0.03, 0.1, 0.25, 0.7, 0.3)
    alone = period_map(osc, (0.5, 0.2), periods=3, extrema=True, tolerance=1e-12)
    beside = period_map(osc, (0.5, 0.2), periods=3, extrema=True, tolerance=1e-12, parameters=osc.parameters)
    assert len(alone.events) == len(beside.events) > 3
    assert beside.events[:, :4] == pytest.approx(alone.events[:, :4], abs=1e-8)
    assert beside.state == pytest.approx(alone.state, abs=1e-9)


def test_friction_in_closed_form():
    """Dry friction on a free oscillator takes 2 mu from the amplitude every half turn."""
    law = CompiledLaw(friction, (("mu", 0.01),), (Surface((0.0, 1.0)),))
    done = period_map(SmoothOscillator(law, 0.0, 0.0, 0.0, 1.0 / 1.5), (1.0, -1e-9), tolerance=1e-13)
    ends = np.abs(done.events[done.events[:, 1] == 0, 3])
    assert ends == pytest.approx(1.0 - 0.02 * np.arange(1, 4), abs=1e-12)


def test_a_motion_that_sticks_is_refused():
    law = CompiledLaw(friction, (("mu", 0.5),), (Surface((0.0, 1.0)),))
    done = period_map(SmoothOscillator(law, 0.0, 0.0, 0.0, 0.1), (1.0, 0.0))
    assert "sticks" in done.message
    assert np.all(np.isnan(done.states))


@pytest.mark.parametrize("depth", [1e-4, 1e-8, 1e-10, 1e-12, 1e-13])
def test_shallow_double_crossing_is_not_missed(depth):
    """The motion X = D + F_m + a cos t dips a - F_m into the gap; ends of steps do not show it."""
    law = PowerContact(stiffness=FourierStiffness(1.0), half_backlash=0.2, exponent=1.0, one_sided=True)
    osc = SmoothOscillator(law, 0.0, 0.3, 0.0, 1.0)

    def counts(dip):
        return period_map(osc, (0.2 + 0.6 + dip, 0.0), tolerance=1e-14).counts[0, 0]

    assert counts(depth) == 1
    assert counts(-depth) == 0


@pytest.mark.parametrize("depth", [1e-8, 1e-10, 1e-13])
def test_touch_in_one_long_step(depth):
    """A parabola in the gap, exact in one step of any length, touches the flank at its vertex."""
    law = PowerContact(stiffness=FourierStiffness(1.0), half_backlash=0.5, exponent=1.5, one_sided=True)
    osc = SmoothOscillator(law, 0.0, -1.0, 0.0, 1.0)
    for sign, expected in ((1.0, 1), (-1.0, 0)):
        speed = np.sqrt(2 * (1.0 + sign * depth))
        done = period_map(osc, (-0.5, speed), tolerance=1e-6)
        assert done.counts[0, 0] == expected


def test_trajectory_has_the_exact_events():
    exact = GearOscillator(SERIES, 0.05, 0.1, 0.2, 0.6, 0.2)
    ours = trajectory(SmoothOscillator(linear_contact(), 0.05, 0.1, 0.2, 0.6), (0.5, 0.2), 3, 40)
    theirs = trajectory(exact, (0.5, 0.2), 3, 40)
    for name in ("tau", "x", "v", "events", "extrema"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), abs=2e-11), name
    assert ours.error < 1e-10


def test_tolerance_governs_the_error():
    """Over eight decades the true error stays within a hundred tolerances, and the estimate shows it."""
    exact = map_derivatives(GearOscillator(SERIES, 0.05, 0.1, 0.2, 0.6, 0.2), (0.5, 0.2), ("frequency",), 3)
    osc = SmoothOscillator(linear_contact(), 0.05, 0.1, 0.2, 0.6)
    for tolerance in (1e-5, 1e-7, 1e-9, 1e-11, 1e-13):
        done = period_map(osc, (0.5, 0.2), 3, tolerance=tolerance)
        true = np.max(np.abs(done.state - exact.state)) / np.max(np.abs(done.states))
        assert true < 100 * tolerance
        assert true < 5 * done.error + 1e-14


def test_building_an_oscillator_compiles_nothing():
    code = (
        "import sys, dynamics as d; k = d.FourierStiffness(1.0, (0.2,), (0.0,))\n"
        "d.SmoothOscillator(d.PowerContact(stiffness=k, half_backlash=0.1), 0.05, 0.1, 0.2, 0.6)\n"
        "sys.exit('numba' in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


INTERPRETED = """
import json, numpy as np, dynamics as d
series, film = d.FourierStiffness(1.0, (0.18,), (0.3,)), d.SqueezeFilm(0.1, 0.05)
depths, angles = np.linspace(0, 1, 9) ** 2 * 1.5, 2 * np.pi * np.arange(5) / 5
forces = (1 + 0.2 * np.cos(angles))[:, None] * depths**1.2
found = []
for law in (
    d.PowerContact(stiffness=series, half_backlash=0.2, film=film),
    d.SmoothedBacklash(stiffness=series, half_backlash=0.2, width=0.05),
    d.TabulatedContact.from_forces(depths, forces, half_backlash=0.2, order=2),
):
    osc = d.SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6, 0.1)
    done = d.period_map(osc, (0.5, 0.2), parameters=osc.parameters, extrema=True, tolerance=1e-8)
    found += [*done.state, *done.jacobian.ravel(), *done.slope.ravel(), *done.events.ravel(), *done.counts.ravel()]
print(json.dumps([float(v) for v in found]))
"""


@pytest.mark.slow
def test_compiled_code_computes_what_is_written():
    """The kernels interpreted give the same figures."""
    runs = []
    for switch in ({}, {"NUMBA_DISABLE_JIT": "1"}):
        done = subprocess.run(
            [sys.executable, "-c", INTERPRETED],
            capture_output=True,
            text=True,
            env={**os.environ, **switch},
            check=True,
        )
        runs.append(json.loads(done.stdout))
    assert runs[0] == pytest.approx(runs[1], rel=1e-9, abs=1e-9)
