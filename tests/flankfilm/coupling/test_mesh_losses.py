"""Losses of a mesh: the record against itself, against what each contact loses, and what changes them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import ehl
import flankfilm as ff
from base import SolverError
from ehl import Lubricant, Roughness
from ehl.solving.options import PressureWarning
from flankfilm.coupling import MeshLosses, PlacedMeniscus
from gears import Gear, GearPair
from gears.closed_form import ohlendorf_loss_factor

PAIR = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
OIL = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
SPEED, TORQUE = 209.44, 300.0
QUICK = {"model": "potential-energy", "positions": 4}


def losses(torque: float = TORQUE, pair: GearPair = PAIR, oil: Lubricant = OIL, **options) -> MeshLosses:
    return ff.mesh_losses(pair, torque, SPEED, oil, **{**QUICK, **options})


@pytest.fixture(scope="module")
def found() -> MeshLosses:
    return losses()


def test_power_put_in_is_put_out_or_lost(found):
    assert found.input_power == pytest.approx(TORQUE * SPEED)
    assert found.mesh_loss == found.sliding_loss + found.rolling_loss + found.edge_loss
    assert found.efficiency * found.input_power + found.mesh_loss == pytest.approx(found.input_power)
    assert found.heat.sum() == pytest.approx(found.mesh_loss, rel=1e-12)
    assert found.sliding_loss == pytest.approx(
        found.mean_friction * found.input_power * found.loss_factor, rel=1e-12
    )
    assert found.edge_loss == 0.0  # no tip edges in a closed form


def test_single_contacts_lose_what_the_mean_says(found):
    path = found.path
    assert path.sliding_loss.sum() / QUICK["positions"] == pytest.approx(
        found.sliding_loss, rel=2.0 * found.error
    )
    assert path.friction_coefficient.min() < found.mean_friction < path.friction_coefficient.max()
    power = 40e-3 * path.friction_coefficient * path.load * np.abs(path.sliding_speed)
    assert path.sliding_loss == pytest.approx(power)
    width = path.load / path.hertz_pressure * 4.0 / np.pi  # of the whole Hertz contact
    assert path.shear_stress * width == pytest.approx(
        np.sign(path.sliding_speed) * path.friction_coefficient * path.load
    )


def test_rolling_by_heat_is_rolling_by_forces(found):
    """What the oil's flow under its pressure turns to heat is what both flanks push against."""
    pushed = 2.0 * found.path.entrainment * found.path.rolling_friction * 40e-3
    assert found.path.rolling_loss == pytest.approx(pushed, rel=0.05)


def test_temperatures_stand_where_they_should(found):
    path = found.path
    assert found.bulk_temperatures == pytest.approx(353.15)
    assert path.contact_temperature == pytest.approx(353.15 + path.surface_temperature_rise.max(axis=0))
    assert np.all(path.oil_temperature_rise > path.surface_temperature_rise.max(axis=0))
    sliding = np.abs(path.sliding_speed) > 0.5
    # oil that takes its heat to both flanks by conduction, and Blok's flanks that meet, are as hot within a third
    assert path.flash_temperature[sliding] == pytest.approx(
        path.surface_temperature_rise.mean(axis=0)[sliding], rel=0.33
    )
    # before C the wheel is the faster, and the pinion's slower flank is the hotter
    before = path.sliding_speed < -0.5
    assert np.all(np.diff(path.surface_temperature_rise[:, before], axis=0) < 0.0)
    assert path.least_film == found.least_film == path.minimum_thickness.min()


def test_what_is_held_at_the_inlets_holds_for_films_with_heat(found):
    """A layer of a third of the film leaves a third of it; less oil is sheared more steeply, and the load stays."""
    starved = losses(supply=ehl.OilLayer(found.least_film / 3.0))
    # behind a layer the flow is the layer's: the film at the middle is the compressed layer, the least film less
    assert np.all(starved.path.minimum_thickness < found.least_film / 3.0)
    assert starved.path.load == pytest.approx(found.path.load)
    assert starved.mean_friction > found.mean_friction
    placed = losses(supply=PlacedMeniscus(1.3))
    assert np.all(placed.path.minimum_thickness < found.path.minimum_thickness)


def test_the_band_begins_at_the_given_stress(found):
    band = found.band
    assert band.eyring_stress.tolist() == [5e6, 10e6]
    assert band.mesh_loss[0] == pytest.approx(found.mesh_loss, rel=1e-12)
    assert band.mean_friction[0] < band.mean_friction[1]
    assert band.efficiency == pytest.approx(1.0 - band.mesh_loss / found.input_power)


def test_an_error_above_the_tolerance_is_said(found):
    assert found.error > 0.01
    assert "more positions" in found.message


def test_the_closed_form_stands_beside_the_loss_factor(found):
    assert found.ohlendorf_loss_factor == ohlendorf_loss_factor(PAIR)
    assert found.loss_factor == pytest.approx(found.ohlendorf_loss_factor, rel=0.1)
    assert found.path.film_ratio is None
    assert found.heat_transfer is None


@pytest.mark.slow
def test_the_end_of_the_band_is_what_that_stress_gives(found):
    other = losses(oil=replace(OIL, eyring_stress=10e6))
    assert found.band.mesh_loss[1] == pytest.approx(other.mesh_loss, rel=0.01 + found.band.error)
    assert found.band.mean_friction[1] == pytest.approx(other.mean_friction, rel=0.01 + found.band.error)


@pytest.mark.slow
def test_gears_as_warm_as_their_surroundings_take_their_heat():
    found = losses(heat_transfer=(8.0, 12.0), ambient_temperature=333.15)
    assert found.heat_transfer is not None
    taken = found.heat_transfer * (found.bulk_temperatures - 333.15)
    assert taken == pytest.approx(found.heat, abs=12.0 * (found.temperature_mismatch + 1e-9))
    assert found.temperature_mismatch < 0.3
    assert found.bulk_temperatures[0] > found.bulk_temperatures[1] + 2.0
    # the same, given
    again = losses(bulk_temperatures=tuple(found.bulk_temperatures.tolist()))
    assert again.mesh_loss == pytest.approx(found.mesh_loss, rel=0.01)


@pytest.mark.slow
def test_equal_gears_lose_the_same_whichever_drives():
    pair = GearPair(Gear(teeth=30), Gear(teeth=30), module=2e-3, face_width=20e-3)
    one, other = losses(150.0, pair, positions=6), losses(-150.0, pair, positions=6)
    assert other.mesh_loss == pytest.approx(one.mesh_loss, rel=0.02)
    # approach and recess mirror each other where friction tilts no force, as in closed forms
    path = one.path
    mirrored = np.interp(pair.line_of_action - path.rho1, path.rho1, path.friction_coefficient)
    far = np.abs(path.sliding_speed) > 0.3
    assert path.friction_coefficient[far] == pytest.approx(mirrored[far], rel=0.03)


@pytest.mark.slow
def test_rough_flanks_rub():
    rough = Roughness(deviation=0.3e-6, density=3e11, tip_radius=4e-7)
    found, smooth = losses(roughness=rough, boundary_friction=0.12), losses()
    path = found.path
    assert path.asperity_share is not None
    assert path.film_ratio is not None
    assert path.film_ratio == pytest.approx(path.minimum_thickness / 0.3e-6)
    assert np.all(path.asperity_share > 0.0)
    assert smooth.mean_friction < found.mean_friction < 0.12
    assert smooth.boundary is None


def test_the_friction_of_asperities_has_a_band_in_the_model_error():
    rough = Roughness(deviation=0.3e-6, density=3e11, tip_radius=4e-7)
    given = {"roughness": rough, "boundary_friction": 0.12, "positions": 2}
    found = losses(boundary_band=(0.09, 0.12), **given)
    band = found.boundary
    assert band.boundary_friction.tolist() == [0.09, 0.12]
    assert band.mesh_loss[1] == pytest.approx(found.mesh_loss, rel=1e-9)
    lower = losses(**{**given, "boundary_friction": 0.09})
    assert band.mesh_loss[0] == pytest.approx(lower.mesh_loss, rel=0.01)  # load share and films stay
    assert lower.boundary.boundary_friction == pytest.approx([0.072, 0.108])
    part = (0.12 / 0.03) * (1.0 - band.mesh_loss[0] / found.mesh_loss)  # linear in the friction
    assert band.loss_part == pytest.approx(part, rel=1e-9)
    by_stress = np.max(np.abs(found.band.mesh_loss / found.mesh_loss - 1.0))
    assert found.model_error == pytest.approx(by_stress + 0.25 * band.loss_part, rel=1e-9)


def test_a_tolerance_that_films_do_not_reach_keeps_the_losses(found):
    fine = losses(tolerance=1e-4, positions=2)
    assert 1e-4 < fine.least_film_error < 0.05
    assert fine.mesh_loss == pytest.approx(found.mesh_loss, rel=0.05)


@pytest.mark.filterwarnings("default:Hertz pressure")
def test_the_pressure_that_is_warned_of_is_that_of_a_contact():
    with pytest.warns(PressureWarning) as heard:
        found = losses(900.0, positions=2)
    said = [str(one.message) for one in heard if "Hertz pressure" in str(one.message)]
    assert [one.split()[2] for one in said] == [f"{1e-9 * found.path.hertz_pressure.max():.2f}"]


@pytest.mark.slow
def test_thinner_and_hotter_oil_has_thinner_films_and_less_friction():
    found, warmer = losses(), losses(bulk_temperatures=(373.15, 373.15))
    assert warmer.least_film < 0.65 * found.least_film
    assert warmer.mean_friction < found.mean_friction
    assert warmer.rolling_loss < found.rolling_loss


@pytest.mark.slow
@pytest.mark.parametrize("torque", [2.0, 60.0])
def test_light_loads_slide_on_thick_films(torque):
    found = losses(torque)
    # a Newtonian oil in the whole: friction grows with the load towards that of Eyring's; behind light contacts the
    # oil between the streaks of gas is sheared too
    assert found.mean_friction < 0.0125
    assert found.least_film > 0.5e-6
    assert found.rolling_loss > found.sliding_loss


def test_hardly_any_load_is_refused_with_the_place():
    with pytest.raises(SolverError, match=r"no film with heat at rho1 = [\d.]+ mm"):
        losses(0.01)


@pytest.mark.slow
def test_few_teeth_slide_much():
    pair = GearPair(Gear(9, 0.5), Gear(11, 0.5), module=3e-3, face_width=20e-3)
    found = losses(60.0, pair)
    assert found.ohlendorf_loss_factor == pytest.approx(found.loss_factor, rel=0.1)
    assert found.loss_factor > 0.3
    assert found.mesh_loss / found.input_power > 0.01


@pytest.mark.slow
@pytest.mark.parametrize("bulk", [(560.0, 560.0), (330.0, 330.0), (373.0, 333.0)])
def test_bulk_temperatures_far_from_the_oil_s(bulk):
    found = losses(bulk_temperatures=bulk)
    assert found.bulk_temperatures.tolist() == list(bulk)
    assert found.path.contact_temperature == pytest.approx(
        np.max(np.array(bulk)[:, None] + found.path.surface_temperature_rise, axis=0)
    )
    assert 0.002 < found.mean_friction < 0.04
