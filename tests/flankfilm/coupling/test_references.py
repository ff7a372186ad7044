"""References of the deflection in cycles, oscillators, scenes and reports."""

from __future__ import annotations

import pickle
import re

import numpy as np
import pytest
import xarray as xr

import fem
import flankfilm as ff
from base import InputError
from fem.cycle.breakdown import deflection_parts
from fem.pair.references import turns
from flankfilm.coupling import MeshCycle, mesh_series, stiffness_references
from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.files.cache import Cache
from flankfilm.products.further_cycles import TORQUES
from flankfilm.products.oscillator import scaling
from flankfilm.products.stiffness import REFERENCES
from flankfilm.report.stiffness_parts import references as report_part
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FILM
from flankfilm.stages.motion import FOURIER, SCALING
from tests.flankfilm.scenes import ARTICLE
from tests.validation.article import PAIR

TORQUE, SPEED = 600.0, 209.44
MOTION = """
[stiffness]
model = "MODEL"
[film]
model = "none"
[dynamics]
fourier_order = 3
KEYS
diagram = { speed_rpm = [15000, 16000], max_period = 1, searches = 2 }
"""


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR)


@pytest.fixture(scope="module")
def cycle(bodies: fem.PairCompliance) -> MeshCycle:
    return ff.mesh_cycle(PAIR, TORQUE, positions=40, compliance=bodies)


def run_of(keys: str, model: str = "fem", wants: str = '"stiffness", "diagram"') -> Engine:
    text = f"wants = [{wants}]\ntolerance = 0.01\n" + ARTICLE + MOTION
    return Engine(ff.parse_scene(text.replace("KEYS", keys).replace("MODEL", model)), Cache(None))


def test_cycles_measure_as_finite_elements_do(bodies, cycle):
    for reference in MEANINGS:
        found = ff.mesh_cycle(PAIR, TORQUE, positions=40, compliance=bodies, reference=reference)
        whole = fem.mesh_cycle(PAIR, TORQUE, compliance=bodies, reference=reference)
        assert found.reference == whole.reference == reference
        for name in ("stiffness", "secant_stiffness", "transmission_error"):
            np.testing.assert_allclose(getattr(found, name), getattr(whole, name), rtol=1e-12)
        assert found.error == pytest.approx(whole.error)
    assert np.ptp(cycle.transmission_error) == pytest.approx(np.ptp(found.transmission_error), rel=2e-3)


@pytest.mark.slow
def test_a_film_yields_by_as_much_against_every_reference(bodies):
    oil = ff.FilmModel("dowson")
    given = {"tolerance": 0.01, "film": oil, "compliance": bodies}
    from ehl import Lubricant

    wet = ff.lubricated_cycle(
        PAIR, TORQUE, SPEED, Lubricant(0.075, 19.6e-9, 910.0), reference="bore", **given
    )
    body = wet.against("body")
    direct = ff.lubricated_cycle(PAIR, TORQUE, SPEED, Lubricant(0.075, 19.6e-9, 910.0), **given)
    assert body.dry.reference == body.reference == "body"
    np.testing.assert_allclose(direct.secant_stiffness, body.secant_stiffness, rtol=1e-13)
    yields = [1 / one.secant_stiffness - 1 / one.dry.secant_stiffness for one in (wet, body)]
    # tip edges, whose levers about the wheel are shorter, carry a little less with a film
    np.testing.assert_allclose(yields[0], yields[1], rtol=5e-3)
    np.testing.assert_allclose(np.median(yields[0] / yields[1]), 1.0, rtol=1e-6)
    kept = pickle.loads(pickle.dumps(wet)).against("body")  # as the results cache gives it back
    assert kept.mean_secant_stiffness == pytest.approx(body.mean_secant_stiffness, rel=1e-6)
    assert body.secant_stiffness_change < wet.secant_stiffness_change < 0  # of a stiffer mesh


def test_the_oscillator_of_a_pair_takes_the_body(cycle):
    """A cycle or a series, against whatever it was measured: the oscillator is that of the bodies."""
    inertia = (1e-3, 2e-3)
    found = {
        reference: ff.pair_oscillator(PAIR, cycle, TORQUE, SPEED, extra_inertia=inertia, reference=reference)
        for reference in MEANINGS
    }
    default = ff.pair_oscillator(PAIR, cycle.against("teeth"), TORQUE, SPEED, extra_inertia=inertia)
    assert default.reference == "body"
    assert MEANINGS["body"] in default.message
    assert MEANINGS["body"] in str(scaling(default, xr.Dataset()))
    assert default.natural_frequency == pytest.approx(found["body"].natural_frequency, rel=1e-7)
    series = mesh_series(cycle, order=3)
    fitted = ff.pair_oscillator(PAIR, series, TORQUE, SPEED, extra_inertia=inertia)
    assert fitted.series.order == 3
    # arcs of a cycle that was measured twice are interpolated twice
    assert fitted.natural_frequency == pytest.approx(default.natural_frequency, rel=1e-7)
    assert found["bore"].natural_frequency < default.natural_frequency < found["teeth"].natural_frequency
    for reference, one in found.items():
        mean = cycle.against(reference, inertia).mean_secant_stiffness
        assert one.scales.mean_stiffness == pytest.approx(mean, rel=1e-7)
    # inertia on the bores holds them: less of the hubs' wind-up is left out
    free = ff.pair_oscillator(PAIR, cycle, TORQUE, SPEED)
    assert free.scales.mean_stiffness > default.scales.mean_stiffness


def test_other_models_stay_as_they_are():
    closed = ff.mesh_cycle(PAIR, TORQUE, model="ishikawa")
    motion = ff.pair_oscillator(PAIR, closed, TORQUE, SPEED)
    assert motion.reference == closed.reference == "teeth"
    assert motion.scales.mean_stiffness == pytest.approx(closed.mean_secant_stiffness, rel=1e-12)
    with pytest.raises(InputError, match="finite elements"):
        ff.mesh_cycle(PAIR, TORQUE, model="ishikawa", reference="body")
    with pytest.raises(InputError, match="finite elements"):
        closed.against("bore")
    with pytest.raises(InputError, match="'shaft'"):
        ff.mesh_cycle(PAIR, TORQUE, reference="shaft")


def test_parts_of_the_deflection_add_up(bodies, cycle):
    held = fem.mesh_cycle(PAIR, TORQUE, compliance=bodies, beyond_path=False)
    parts = deflection_parts(held, bodies)
    np.testing.assert_allclose(parts["rest"], 0.0, atol=1e-10 * held.transmission_error.max())
    np.testing.assert_allclose(parts["windup"], sum(bodies.hub_windup) * held.force, rtol=1e-12)
    assert all(np.all(parts[name] > 0) for name in ("hertz", "pinion", "wheel"))
    alone, both = (held.forces > 0).sum(axis=1) == 1, (held.forces > 0).sum(axis=1) == 2
    assert np.all(parts["coupling"][alone] == 0.0)
    assert np.all(parts["coupling"][both] > 0.0)
    again = deflection_parts(held.against("teeth"), bodies)
    np.testing.assert_allclose(again["windup"], parts["windup"], rtol=1e-12)
    # with tip edges the parts still add up, and the rest is theirs
    assert cycle.contact is not None
    free = deflection_parts(cycle.contact, bodies)
    np.testing.assert_allclose(sum(free.values()), cycle.against("bore").transmission_error, rtol=1e-12)
    assert 0 < np.mean(free["rest"]) < 0.1 * np.mean(cycle.transmission_error)


def test_the_bodies_are_the_reference_unless_another_is_given(bodies, cycle):
    whole = fem.mesh_cycle(PAIR, TORQUE, compliance=bodies)
    assert cycle.reference == whole.reference == "body"
    bore, teeth = (cycle.against(name) for name in ("bore", "teeth"))
    assert bore.mean_secant_stiffness < cycle.mean_secant_stiffness < teeth.mean_secant_stiffness
    # what contacts leave out is an error of D in metres: of the smaller D a larger part
    assert bore.model_error < cycle.model_error < teeth.model_error
    ratio = np.max(cycle.secant_stiffness / bore.secant_stiffness)
    assert cycle.model_error == pytest.approx(ratio * bore.model_error, rel=1e-6)
    # without hubs a compliance measures against the teeth, and stays there
    stiff = fem.mesh_cycle(PAIR, TORQUE, 8, compliance=bodies.without("hub_windup"))
    assert stiff.reference == "teeth"


def test_one_pair_alone_is_against_the_bores_unless_a_reference_is_given(bodies):
    rho1, force = PAIR.path_of_contact(9).rho1, 10_000.0
    found = {name: fem.single_pair_stiffness(PAIR, force, rho1, bodies, reference=name) for name in MEANINGS}
    np.testing.assert_array_equal(found["bore"], fem.single_pair_stiffness(PAIR, force, rho1, bodies))
    stiff = fem.single_pair_stiffness(PAIR, force, rho1, bodies.without("hub_windup"))
    np.testing.assert_allclose(found["teeth"], stiff, rtol=1e-12)
    less = turns(PAIR, bodies.supports, "bore") - turns(PAIR, bodies.supports, "body")
    np.testing.assert_allclose(1 / found["bore"] - 1 / found["body"], less.sum(), rtol=1e-9)
    held = fem.single_pair_stiffness(PAIR, force, rho1, bodies, reference="body", bore_inertia=(1.0, 1.0))
    assert np.all(held < found["body"])
    with pytest.raises(InputError, match="reference"):
        fem.single_pair_stiffness(PAIR, force, rho1, bodies, reference="shaft")


def test_a_scene_has_one_reference_for_all_its_stiffnesses():
    run = run_of("")
    motion, found, dry = run[SCALING], run[REFERENCES], run[DRY_CYCLE]
    assert motion.reference == "body"
    assert dry.reference == "body"
    secant = dict(zip(found.reference, found.mean_secant_stiffness, strict=True))
    assert secant["body"] == dry.mean_secant_stiffness == run[FOURIER].mean
    np.testing.assert_array_equal(run[FOURIER].samples, dry.secant_stiffness)
    iso = dict(zip(found.reference, found.iso_mesh_stiffness / found.mean_secant_stiffness, strict=True))
    # tip edges touch beside the path, and the wind-up makes up for it
    assert 0.8 < iso["teeth"] < 0.95 < iso["bore"] < 1.05
    at_bores = dry.against("bore").transmission_error.mean()
    assert sum(found.deflection.values()) == pytest.approx(at_bores, rel=1e-12)
    hubs = found.deflection["hub_windup"]
    assert at_bores - hubs == pytest.approx(dry.transmission_error.mean(), rel=1e-12)
    own = turns(PAIR, run[COMPLIANCE].supports, "body").sum() * dry.contact.force
    assert found.deflection["body_windup"] == pytest.approx(own, rel=0.04)  # tip edges have other levers
    text = str(report_part(found, PAIR.face_width))
    assert all(meaning in text for meaning in MEANINGS.values())
    assert re.search(r"c_gamma of ISO 6336-1', '', '\d", text)


@pytest.mark.parametrize("reference", ["bore", "teeth"])
def test_a_scene_can_ask_for_another_reference(reference: str):
    inertia = "extra_inertia_kg_m2 = { pinion = 1e-3 }"
    run = run_of(f'stiffness_reference = "{reference}"\n{inertia}')
    found = run[REFERENCES]
    row = found.reference.index(reference)
    assert run[SCALING].reference == run[DRY_CYCLE].reference == run[TORQUES].reference == reference
    assert run[SCALING].scales.mean_stiffness == pytest.approx(found.mean_secant_stiffness[row], rel=1e-12)
    assert run[DRY_CYCLE].mean_secant_stiffness == pytest.approx(found.mean_secant_stiffness[row], rel=1e-12)
    named = run_of(inertia, model=f'fem"\nreference = "{reference}')  # the key of [stiffness]
    assert named[DRY_CYCLE].mean_secant_stiffness == run[DRY_CYCLE].mean_secant_stiffness
    with pytest.raises(InputError, match=r"dynamics\.stiffness_reference = 'body': must be that of"):
        run_of('stiffness_reference = "body"', model=f'fem"\nreference = "{reference}')


def test_inertia_on_the_bores_counts_for_every_stiffness_of_a_scene():
    run = run_of("extra_inertia_kg_m2 = { pinion = 1e-3, wheel = 2e-3 }")
    free, held = run_of("")[DRY_CYCLE], run[DRY_CYCLE]
    assert held.mean_secant_stiffness < 0.99 * free.mean_secant_stiffness
    assert run[SCALING].scales.mean_stiffness == pytest.approx(held.mean_secant_stiffness, rel=1e-12)
    assert run[REFERENCES].mean_secant_stiffness[0] == pytest.approx(held.mean_secant_stiffness, rel=1e-12)
    over = run[TORQUES]
    assert over.secant_stiffness[0] == pytest.approx(held.mean_secant_stiffness, rel=1e-4)


def test_films_from_the_cache_follow_the_reference_of_another_scene(tmp_path):
    def lubricated(keys: str) -> Engine:
        text = (
            f'wants = ["stiffness"]\ntolerance = 0.01\n{ARTICLE}[stiffness]\n{keys}\n[film]\nmodel = "dowson"'
        )
        return Engine(ff.parse_scene(text), Cache(tmp_path))

    first, second = lubricated(""), lubricated('reference = "bore"')
    body, bore = first[FILM], second[FILM]
    assert not first.runs["film"].cached
    assert second.runs["film"].cached
    assert (body.reference, body.dry.reference) == ("body", "body")
    assert (bore.reference, bore.dry.reference) == ("bore", "bore")
    np.testing.assert_allclose(bore.secant_stiffness, body.against("bore").secant_stiffness, rtol=1e-12)
    assert bore.dry.mean_secant_stiffness == pytest.approx(second[DRY_CYCLE].mean_secant_stiffness, rel=1e-6)


def test_the_reference_is_of_finite_elements_alone():
    closed = run_of("", "ishikawa")
    assert closed[SCALING].reference == "teeth"
    assert closed[REFERENCES] is None
    with pytest.raises(InputError, match=r"dynamics\.stiffness_reference"):
        run_of('stiffness_reference = "bore"', "ishikawa")
    with pytest.raises(InputError, match="body"):
        run_of('stiffness_reference = "shaft"')


def test_references_need_a_loaded_contact(bodies):
    with pytest.raises(InputError, match="finite elements"):
        stiffness_references(PAIR, ff.mesh_cycle(PAIR, TORQUE, model="ishikawa"), bodies)
