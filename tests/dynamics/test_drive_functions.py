"""Every public function of motion takes a drive train or refuses it by name; orbits that one shot cannot reach."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import dynamics
from base import InputError
from dynamics import FourierStiffness, GearOscillator, find_orbit
from tests.dynamics.test_drives import chain, same_as

DRIVE = chain(mean_force=[0.4, 0.0, 0.0, 0.5], error_amplitude=0.1, error_phase=0.0)
BRANCH = ("frequency", (0.89, 0.91))
STATE = DRIVE.rest_state()
TAKEN = {
    "period_map": lambda: dynamics.period_map(DRIVE, STATE),
    "trajectory": lambda: dynamics.trajectory(DRIVE, STATE, 1, 10),
    "find_orbit": lambda: find_orbit(DRIVE, STATE, transient=100),
    "continue_branch": lambda: dynamics.continue_branch(find_orbit(DRIVE, STATE, transient=100), *BRANCH),
    "doubled_orbit": None,  # tests.dynamics.test_drive_branches
    "sweep": lambda: dynamics.sweep(DRIVE, "frequency", [0.9], transient=50),
    "lyapunov_exponents": lambda: dynamics.lyapunov_exponents(DRIVE, 20, transient=0),
    "lyapunov_scan": lambda: dynamics.lyapunov_scan(DRIVE, "frequency", [0.9], 20, transient=0),
    "motion_spectrum": lambda: dynamics.motion_spectrum(DRIVE, find_orbit(DRIVE, STATE, transient=100).state),
    "diagram": lambda: dynamics.diagram(DRIVE, "frequency", (0.89, 0.91), searches=1, swept=2),
    "multi_sweep": lambda: dynamics.multi_sweep(DRIVE, "frequency", [0.89, 0.91], seeds=1, starts=2, limit=100),
    "run_up": lambda: dynamics.run_up(DRIVE, (0.89, 0.91), 64),
    "basins": lambda: dynamics.basins(DRIVE, (-0.1, 0.1, 2), (-0.1, 0.1, 2), limit=40),
    "basin_boundary": None,  # tests.dynamics.test_drive_global
    "edge_saddles": None,  # tests.dynamics.test_drive_global
    "chaos_end": None,  # tests.dynamics.test_drive_global
    "manifold": None,  # tests.dynamics.test_drive_global
    "boundary_crisis": None,  # tests.dynamics.test_drive_global
    "contact_grazing": None,  # tests.dynamics.test_drive_contact
    "carried_point": None,  # tests.dynamics.test_drive_special
    "continue_locus": None,  # tests.dynamics.test_drive_special
    "special_sensitivities": None,  # tests.dynamics.test_drive_special
    "find_orbits": None,  # tests.dynamics.test_drive_finding
}  # fmt: skip
REFUSED = {
    "restoring_force": (0.0, 0.1),
}


def test_every_function_is_one_or_the_other():
    """What takes an oscillator, or an orbit of one, is in one of the two lists."""
    asked = set()
    for name in dynamics.__all__:
        thing = getattr(dynamics, name)
        if inspect.isfunction(thing) and (arguments := list(inspect.signature(thing).parameters.values())):
            first = arguments[0]
            if first.name in ("oscillator", "orbit", "saddle") or "Oscillator" in str(first.annotation):
                asked.add(name)
    assert asked == TAKEN.keys() | REFUSED.keys()


@pytest.mark.parametrize("name", [name for name, call in TAKEN.items() if call is not None])
def test_results_of_what_takes_it(name):
    result = TAKEN[name]()
    assert result.converged is not None
    assert len(repr(result)) <= 200
    assert result.error < 1e-3 or name.startswith(("lyapunov", "basins", "motion_spectrum"))
    assert result.cost.seconds > 0.0


@pytest.mark.parametrize("name", REFUSED)
def test_what_needs_the_plane_says_so(name):
    with pytest.raises(InputError, match=f"Oscillator in {name}") as raised:
        getattr(dynamics, name)(DRIVE, *REFUSED[name])
    assert "DriveOscillator" in str(raised.value)


def test_a_stable_manifold_in_several_freedoms_is_no_curve():
    with pytest.raises(InputError, match="it is no curve: it has 7 dimensions"):
        dynamics.manifold(find_orbit(DRIVE, STATE, transient=100))


def test_slow_motion_by_many_shots():
    """Omega .02 and negative stiffness at times: a map that stretches by 1e18 and more, as in one freedom."""
    gear = GearOscillator(FourierStiffness(1.0, (1.5,), (0.0,)), 0.05, 0.1, 0.2, 0.02, half_backlash=0.2)
    drive = same_as(gear)
    theirs, ours = find_orbit(gear, gear.rest_state()), find_orbit(drive, drive.rest_state())
    assert len(theirs.nodes) > 1
    assert ours.converged
    assert len(ours.nodes) > 1
    shift = np.ravel(drive.error_motion(np.zeros(1)))
    # Newton's method ends where the gaps are rounding, a step before or after: both errors say which
    off = 1e-11 + 2.0 * (ours.error + theirs.error) * float(np.max(np.abs(theirs.state)))
    assert off < 1e-7
    assert ours.state - shift == pytest.approx(theirs.state, abs=off)
    assert ours.multipliers[0] == pytest.approx(theirs.multipliers[0], rel=1e-8)
    assert ours.determinant == pytest.approx(theirs.determinant, rel=1e-12)
    assert ours.counts == theirs.counts
