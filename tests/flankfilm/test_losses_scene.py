"""Losses and films with heat in scenes: what is asked for, decided, written, drawn and said."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import ehl
from base import InputError, SolverError
from flankfilm import coupling, figures
from flankfilm.building.heat import shearing_oil, solids, warmth
from flankfilm.building.pair import gear_pair
from flankfilm.files.cache import Cache
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.plan.heat_choice import heat_choice
from flankfilm.products.catalogue import goals
from flankfilm.report import losses_parts
from flankfilm.report.text import percent
from flankfilm.runs.dataset import results_dataset, results_tables
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.losses import HEAT_CHOICE, HOT_CONTACT, HOT_FILM, LOSSES
from flankfilm.stages.mesh import FILM, PAIR
from flankfilm.studies.outputs import ERROR_OF, OUTPUTS

EXAMPLE = Path("examples/losses.toml").read_text(encoding="utf-8")
QUICK = EXAMPLE.replace("tolerance = 0.01", "tolerance = 0.1").replace(
    "[film]", '[stiffness]\nmodel = "potential-energy"\npairs = "independent"\n[film]'
)


def changed(*changes: tuple[str, str]) -> str:
    text = QUICK
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def names(text: str) -> set[str]:
    return {goal.name for goal in goals(parse_scene(text))}


def test_wants_and_keys_decide_what_is_computed():
    assert {"losses", "film with heat", "hot contact"} <= names(QUICK)
    film_alone = changed(('"film", "losses"', '"film"'))
    assert "losses" not in names(film_alone)  # until heat is found to count
    assert "film with heat" in names(film_alone)
    assert "film with heat" not in names(film_alone.replace('model = "auto"', 'model = "ehl"'))
    assert "film with heat" in names(film_alone.replace('model = "auto"', 'model = "ehl"\nheat = "on"'))
    assert "film with heat" not in names(film_alone + 'heat = "off"\n')
    losses_alone = changed(('"film", "losses"', '"losses"'))
    assert {"losses", "mesh"} & names(losses_alone) == {"losses"}


@pytest.mark.parametrize(
    ("old", "new", "where", "said"),
    [
        ("temperature_C = 80", "", "lubricant.temperature_C", "is required by the wanted losses"),
        ("[lubricant]", "[lubricants]", "[lubricant]", "is required by"),
        ("pinion_speed_rpm = 2000", "", "operating.pinion_speed_rpm", "is required by"),
        (
            'model = "potential-energy"',
            'model = "given"\namplitudes = [0.1]',
            "stiffness.model",
            "wanted losses",
        ),
        ('model = "auto"', 'model = "dowson"\nheat = "on"', "film", "film with model"),
        ('model = "auto"', 'heat = "warm"', "film.heat", "'on', 'off' or 'auto'"),
        ("[film]", "[heat]\nambient_temperature_C = 60\n[film]", "heat", "heat_transfer_W_per_K beside"),
        (
            "[film]",
            "[heat]\npinion_temperature_C = 90\nheat_transfer_W_per_K = { pinion = 9.0, wheel = 9.0 }\n[film]",
            "heat",
            "pinion_temperature_C, or heat_transfer_W_per_K",
        ),
        (
            "[film]",
            "[heat]\nheat_transfer_W_per_K = { pinion = 0.0, wheel = 9.0 }\n[film]",
            "heat.heat_transfer_W_per_K.pinion",
            "at least 0.001",
        ),
    ],
)
def test_a_fault_names_key_and_remedy(old: str, new: str, where: str, said: str):
    with pytest.raises(InputError) as caught:
        parse_scene(changed((old, new)))
    found = {fault.where: str(fault) for fault in caught.value.faults}
    assert where in found
    assert said in found[where]


def test_temperatures_of_the_flanks():
    assert warmth(parse_scene(QUICK)).bulk == (353.15, 353.15)
    given = "[heat]\npinion_temperature_C = 90\nwheel_temperature_C = 70\n[film]"
    assert warmth(parse_scene(changed(("[film]", given)))).bulk == pytest.approx((363.15, 343.15))
    balanced = "[heat]\nheat_transfer_W_per_K = { pinion = 8.0, wheel = 9.0 }\n[film]"
    found = warmth(parse_scene(changed(("[film]", balanced))))
    assert (found.bulk, found.transfer, found.ambient) == (None, (8.0, 9.0), 353.15)
    cooler = balanced.replace("[film]", "ambient_temperature_C = 40\n[film]")
    scene = parse_scene(changed(("[film]", cooler)))
    assert warmth(scene).ambient == pytest.approx(313.15)
    assert gear_pair(scene) == gear_pair(
        parse_scene(QUICK)
    )  # nothing grows by temperatures that are looked for


def test_an_oil_without_a_stress_thins_at_5_MPa():
    assert shearing_oil(parse_scene(changed(("eyring_stress_MPa = 5 ", "# ")))).eyring_stress == 5e6
    assert (
        shearing_oil(parse_scene(changed(("eyring_stress_MPa = 5 ", "eyring_stress_MPa = 8 ")))).eyring_stress
        == 8e6
    )


def choice(text: str, change: float = -0.2, solved: bool = True):
    asked: list[float] = []

    def screen(tolerance: float) -> Any:
        asked.append(tolerance)
        return SimpleNamespace(change=change, rho1=7e-3)

    return heat_choice(parse_scene(text), solved, screen), asked


def test_heat_is_weighed_by_the_tolerance():
    on, asked = choice(QUICK)
    assert (on.choice, on.asked, on.effect, on.share) == ("on", False, 0.2, 0.1)
    assert "-20 % of the minimum film" in on.line
    assert asked == [0.05]
    off, _ = choice(QUICK, change=-0.06)
    assert (off.choice, off.effect) == ("off", 0.06)
    assert "below the tolerance of 10 %: left out" in off.line
    assert choice(QUICK, change=+0.3)[0].choice == "on"


def test_heat_that_is_named_or_cannot_count_is_not_weighed():
    for text, solved, taken, why in (
        (QUICK + 'heat = "on"\n', True, "on", 'asks for film.heat = "on"'),
        (
            changed(('model = "auto"', 'model = "ehl"')),
            True,
            "off",
            'isothermal; the scene asks for film.model = "ehl"',
        ),
        (QUICK, False, "off", "by formula"),
        (changed(('"film", "losses"', '"film"'), ("temperature_C = 80", "")), True, "off", "is not given"),
        (changed(("[film]", '[film]\nsupply = "oil-layer"\noil_layer_um = 0.2')), True, "on", "above the"),
        (changed(("[film]", "[roughness]\nRa_um = 0.4\n[film]")), True, "off", "smooth"),
    ):
        decided, asked = choice(text, solved=solved)
        assert decided.choice == taken
        assert why in decided.reason
        assert bool(asked) == ("above" in why)

    def fails(tolerance: float) -> Any:
        raise SolverError("error 0.3 left on 513 nodes")

    assert "left on 513 nodes" in heat_choice(parse_scene(QUICK), True, fails).reason


@pytest.fixture(scope="module")
def few() -> Mapping[str, Any]:
    """Results with films at four positions of the base pitch."""
    scene = parse_scene(changed(('"film", "losses"', '"losses"')))
    pair, oil = gear_pair(scene), shearing_oil(scene)
    lost = coupling.mesh_losses(
        pair, 600.0, 209.44, oil, solids=solids(pair), tolerance=0.1, model="potential-energy", positions=4
    )
    hot = coupling.hottest_film(pair, lost, oil, solids(pair), 0.1)
    return {"scene": scene, "pair": pair, "losses": lost, "hot contact": hot}


def test_the_hottest_contact_is_that_of_the_path(few):
    lost, hot = few["losses"], few["hot contact"]
    assert hot.converged
    assert hot.oil_temperature_rise == pytest.approx(lost.path.oil_temperature_rise.max(), rel=0.02)
    assert hot.minimum_thickness in (pytest.approx(h, rel=0.02) for h in lost.path.minimum_thickness)


def test_the_screen_is_the_hottest_contact_with_heat_and_without(few):
    pair, lost, oil = few["pair"], few["losses"], shearing_oil(few["scene"])
    at = SimpleNamespace(rho1=lost.path.rho1, load=lost.path.load)
    found = coupling.heat_screen(pair, at, 209.44, oil, solids=solids(pair), tolerance=0.1)
    slid = lost.path.load * np.abs(lost.path.sliding_speed)
    assert found.rho1 == lost.path.rho1[int(np.argmax(slid))]
    assert -0.25 < found.change < -0.12
    cool = replace(oil, viscosity_slope=0.0)  # shear thinning alone
    thinned = coupling.heat_screen(pair, at, 209.44, cool, solids=solids(pair), tolerance=0.1)
    assert -0.1 < thinned.change < -0.03


def test_files_pictures_and_page_of_losses(few):
    scene, lost = few["scene"], few["losses"]
    data = results_dataset(Computed(scene, {name: few[name] for name in ("pair", "losses", "hot contact")}))
    assert float(data["losses_mesh_loss"]) == lost.mesh_loss
    assert data["losses_mesh_loss"].attrs["error"] == lost.error
    tables = results_tables(data)
    assert tables["losses_along_path"]["friction_coefficient"].shape == lost.path.rho1.shape
    assert tables["losses_by_eyring_stress"]["eyring_stress_MPa"].tolist() == [5.0, 10.0]
    errors = tables["uncertainties"]
    row = errors["variable"].tolist().index("losses_mesh_loss")
    assert errors["numerical_error"][row] == lost.error
    assert errors["total_uncertainty"][row] == lost.error + lost.model_error
    assert errors["tolerance_met"][row] == int(lost.error <= scene.tolerance)
    low, high = data["losses_band_friction_coefficient"].values
    assert np.all(low < high)
    for draw in (figures.losses_along_path, figures.temperatures_along_path, figures.temperature_field):
        for axes in draw(data).axes:
            shown = axes.get_xlabel() or axes.get_ylabel() or axes.yaxis.get_label().get_text()
            assert "[" in shown or not shown
    part = losses_parts.losses(lost, data, scene)
    assert "by sliding" in part.paragraphs[0]
    assert "Eyring's law with 5 MPa (as the scene gives it)" in part.paragraphs[1]
    assert "bulk 80.0 and 80.0 °C, as warm as the oil" in part.paragraphs[2]
    assert [row[0] for row in part.tables[0].rows] == ["5", "10"]
    assert len(part.figures) == 3
    head = {one.name: one for one in losses_parts.headlines(lost)}
    power, hottest = head["power lost in the mesh"], head["maximum temperature of the flanks"]
    assert "W for Eyring stresses of 5 to 10 MPa" in power.note
    # one quantity, one error: the page, its tables and the files
    assert power.uncertainty == Uncertainty(lost.error, lost.model_error)
    assert data["losses_mesh_loss"].attrs["model_error"] == lost.model_error
    assert lost.model_error == pytest.approx(lost.band.mesh_loss[1] / lost.mesh_loss - 1.0, rel=1e-3)
    assert data["losses_band_mesh_loss"].attrs["error_variable"] == "losses_band_end_error"
    assert lost.band.end_error[0] == lost.error < lost.band.end_error[1]
    assert part.tables[0].rows[0][-1] == percent(lost.error)
    kelvin = data["losses_greatest_contact_temperature"].attrs["error"] * lost.greatest_contact_temperature
    assert hottest.uncertainty.numerical * hottest.uncertainty.size == pytest.approx(kelvin)
    at = int(np.argmax(lost.path.contact_temperature))
    rises = lost.path.temperature_error * lost.path.surface_temperature_rise.max(axis=0)
    assert rises[at] <= kelvin * (1 + 1e-9)
    assert kelvin <= rises.max() * (1 + 1e-9)
    rough = replace(lost, path=replace(lost.path, film_ratio=np.full(lost.path.rho1.shape, 0.7)))
    named = {one.name: one.note for one in losses_parts.headlines(rough)}["minimum film with heat"]
    assert named.startswith("boundary lubrication at Lambda = 0.7 ")
    assert head["minimum film with heat"].note == ""  # of smooth flanks there is no ratio
    film = head["minimum film with heat"].uncertainty.numerical
    assert film == data["losses_least_film"].attrs["error"] == data["losses_path_least_film"].attrs["error"]
    assert data["losses_least_film"].attrs["tolerance_met"] == int(film <= scene.tolerance)


def test_outputs_of_studies_are_those_of_the_losses(few):
    lost = few["losses"]
    engine = {LOSSES: lost, PAIR: few["pair"]}
    asked = {name: one for name, one in OUTPUTS.items() if one.wants == ("losses",)}
    found = {name: one.value(engine) for name, one in asked.items()}
    assert found["mesh_loss_W"] == lost.mesh_loss
    assert found["mesh_loss_by_5_MPa_W"] == pytest.approx(lost.mesh_loss, rel=1e-6)
    assert found["mesh_loss_by_10_MPa_W"] == lost.band.mesh_loss[1] > lost.mesh_loss
    assert found["mesh_efficiency"] == lost.efficiency
    assert found["least_film_with_heat_um"] == pytest.approx(1e6 * lost.path.minimum_thickness.min())
    assert found["flank_temperature_rise_wheel_K"] == lost.path.surface_temperature_rise[1].max()
    assert found["bulk_temperature_pinion_K"] == 353.15
    assert np.isnan(found["film_ratio_with_heat"])
    of_rough = {name for name in found if "film_ratio" in name or "boundary" in name or "regime" in name}
    assert {name for name, value in found.items() if np.isnan(value)} == of_rough
    for name, error in ERROR_OF.items():
        if name in asked and name not in of_rough:
            given = error.startswith("bulk_temperature")  # which is exact
            assert (found[error] == 0.0) if given else (0.0 < found[error] < 0.2), error
    assert found["losses_model_error"] == lost.model_error
    assert found["film_with_heat_error"] == lost.least_film_error


@pytest.mark.slow
def test_the_stages_agree_with_the_functions():
    engine = Engine(parse_scene(QUICK), Cache(None))
    assert engine[HEAT_CHOICE].choice == "on"
    lost = engine[HOT_FILM]
    assert lost is engine[LOSSES]
    assert lost.bulk_temperatures.tolist() == [353.15, 353.15]
    assert lost.least_film < 0.85 * engine[FILM].film.least_film
    assert lost.mean_friction == pytest.approx(0.028, rel=0.05)
    assert isinstance(engine[HOT_CONTACT], ehl.ThermalFilm)
    assert "compliance" not in engine.runs or engine.runs["compliance"].seconds < 0.1
    balanced = changed(
        (
            "[film]",
            "[heat]\nheat_transfer_W_per_K = { pinion = 12.0, wheel = 13.0 }\nambient_temperature_C = 60\n[film]",
        )
    )
    warm = Engine(parse_scene(balanced), Cache(None))[LOSSES]
    assert warm.bulk_temperatures == pytest.approx(333.15 + warm.heat / np.array([12.0, 13.0]), abs=1.0)
