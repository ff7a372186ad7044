"""What flanks on both sides of the teeth yield is that of one elastic body: no load gains energy from another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.contact_sides import both_sides
from fem.contact.loaded_flanks import loaded_flanks
from fem.laws.contact_candidates import REACHES
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from gears import Gear, GearPair

FORCE = 1e4


def held_by(bore: float, teeth: tuple[int, int] = (36, 40), shift: float = 0.0) -> GearPair:
    """Pair whose gears are held at a part of their root radius, with hardly any backlash."""
    first, second = Gear(teeth[0], shift), Gear(teeth[1], -shift)
    radii = GearPair(first, second, 2e-3, 0.04).root_radii
    gears = (replace(one, bore_radius=bore * r) for one, r in zip((first, second), radii, strict=True))
    return GearPair(*gears, 2e-3, 0.04).with_backlash(5e-6)


def energy_over_loads(pair: GearPair, reach: float) -> np.ndarray:
    """Smallest eigenvalue over the mean diagonal of what the contacts yield at a force, at every position."""
    bodies, given = fem.compliance(pair, 0.01), MeshSetup(pair, 12)
    corner_laws = CornerLaws(given, bodies)
    front, back = (loaded_flanks(one, bodies, None, reach, corner_laws) for one in (given, given.opposite))
    both = both_sides(given, bodies, front, back)
    np.testing.assert_array_equal(both.matrix, np.swapaxes(both.matrix, 1, 2))
    secant = both.laws.approach(np.full(both.gaps.shape, FORCE))[0] / FORCE
    touches = np.concatenate([front.candidates.touchable, back.candidates.touchable], axis=-1)
    whole = both.matrix + np.where(touches, secant, 0.0)[:, None, :] * np.eye(touches.shape[-1])
    smallest = []
    for matrix, some in zip(whole, touches, strict=True):
        kept = matrix[np.ix_(some, some)]
        smallest.append(np.linalg.eigvalsh(kept)[0])
    return np.array(smallest)


@pytest.mark.filterwarnings("ignore::gears.tooth.errors.GeometryWarning")
@pytest.mark.parametrize("seed", range(6))
def test_no_loads_on_both_sides_gain_energy(seed):
    """Weak hubs turn by far more than the teeth bend, by all contacts, tip edges too, in the same proportion."""
    rng = np.random.default_rng(seed)
    teeth = tuple(rng.integers(17, (50, 90)).tolist())
    bore, shift = 10.0 ** rng.uniform(-2.0, -0.03), rng.uniform(0.0, 0.2)
    pair = held_by(bore, teeth, shift)
    for reach in REACHES:
        assert energy_over_loads(pair, reach).min() > 0.0


@pytest.mark.parametrize(("teeth", "shift"), [((17, 17), 0.0), ((17, 90), 0.1), ((36, 40), 0.0)])
def test_no_loads_gain_energy_on_hubs_that_hardly_hold(teeth, shift):
    """Tip edges a base pitch beside the path have a tenth of the others' lever."""
    for reach in REACHES:
        assert energy_over_loads(held_by(0.01, teeth, shift), reach).min() > 0.0


def test_far_teeth_feel_the_hub_alone():
    """Teeth farther than any that were looked at turn with the body."""
    pair = held_by(0.05)
    bodies = fem.compliance(pair, 0.01)
    given = MeshSetup(pair, 2)
    corner_laws = CornerLaws(given, bodies)
    front, back = (loaded_flanks(one, bodies, None, 0.6, corner_laws) for one in (given, given.opposite))
    near = both_sides(given, bodies, front, back).matrix
    reached = bodies.back_flanks
    few = tuple(replace(one, series={0: one.series[0]}) for one in reached)
    object.__setattr__(bodies, "back_flanks", few)
    far = both_sides(given, bodies, front, back).matrix
    np.testing.assert_allclose(far, near, rtol=0.02)


@pytest.mark.filterwarnings("ignore::base.RangeWarning")
@pytest.mark.parametrize("bore", [0.02, 0.05])
@pytest.mark.parametrize("deep", [0.3, 1.0])
def test_weak_hubs_under_deflections_of_a_module_share_with_back_flanks(bore, deep):
    """The hubs' turn closes no gap: no load sharing is left out, and back flanks stand clear or bear."""
    pair = held_by(bore)
    bodies = fem.compliance(pair, 0.01)
    torque = deep * pair.module / sum(bodies.hub_windup) * pair.base_radii[0]
    cycle = fem.mesh_cycle(pair, torque, 8, bodies, moving_contact=False, reference="bore")
    assert cycle.converged, cycle.message
    assert "left out" not in cycle.message
    assert np.max(cycle.transmission_error) > 0.25 * pair.module
    assert np.all(cycle.back_gap >= 0.0)
