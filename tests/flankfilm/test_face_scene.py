"""Face width in scenes: leads and alignment from their keys to the ground, and what scenes with them cannot have."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from base import InputError
from fem import forget_gears
from flankfilm import figures
from flankfilm.building.face import even_along_face, face, varies_by
from flankfilm.building.pair import gear_pair
from flankfilm.building.preflight import refuse
from flankfilm.coupling.mesh.face_models import _linear
from flankfilm.files.cache import Cache
from flankfilm.products import root_stress
from flankfilm.products.catalogue import goals
from flankfilm.products.face import FACE_MODELS
from flankfilm.products.root_stress import ROOT_STRESS
from flankfilm.report import face_parts, film_parts
from flankfilm.runs.dataset import results_dataset, results_tables
from flankfilm.scene import parse_scene
from flankfilm.scene.plain_gears import plain_flanks
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE, FACE_GEARS, FILM, PAIR
from flankfilm.studies.outputs import OUTPUTS
from gears import Alignment, Lead, closed_form
from tests.flankfilm.scenes import ishikawa

SCENE = ishikawa("Face", "stiffness").replace('model = "ishikawa"\npairs = "independent"\n', "")
LEADS = SCENE.replace(
    "pinion = { teeth = 36 }",
    "pinion = { teeth = 36, crowning_um = 10, end_relief_um = 8, end_relief_length_mm = 5 }",
).replace("wheel = { teeth = 40 }", "wheel = { teeth = 40, lead_slope_um = -6 }")
TWISTED = SCENE.replace("teeth = 40 }", "teeth = 40, lead_twist_um = 7 }")
WIDE = SCENE.replace("teeth = 36 }", "teeth = 36, face_width_mm = 45, face_offset_mm = 2 }")
ALIGNED = SCENE + "[alignment]\nin_plane_um = 20\ncells = 32\n"


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        refuse(parse_scene(text))
    return {fault.where: str(fault) for fault in caught.value.faults}


def test_keys_become_leads_and_alignment():
    pair = gear_pair(parse_scene(LEADS))
    assert pair.pinion.lead == Lead(
        crowning=pytest.approx(10e-6), end_relief=pytest.approx(8e-6), end_relief_length=pytest.approx(5e-3)
    )
    assert pair.wheel.lead == Lead(slope=pytest.approx(-6e-6))
    assert face(parse_scene(LEADS)) == {}
    given = face(parse_scene(ALIGNED))
    assert given == {"alignment": Alignment(pytest.approx(20e-6)), "cells": 32, "face_model": "free-ends"}
    assert face(parse_scene(ALIGNED + 'out_of_plane_um = 50\nface_model = "walls"'))[
        "alignment"
    ] == Alignment(pytest.approx(20e-6), pytest.approx(50e-6))


def test_a_twist_is_a_key_and_varies_the_load():
    scene = parse_scene(TWISTED)
    assert gear_pair(scene).wheel.lead == Lead(twist=pytest.approx(7e-6))
    assert varies_by(scene) == ["pair.wheel.lead_twist_um"]
    assert (
        gear_pair(plain_flanks(scene)) == even_along_face(gear_pair(scene)) == gear_pair(parse_scene(SCENE))
    )
    found = faults(TWISTED.replace("= 7", "= 1e6"))
    assert "at least -1000 and at most 1000 um" in found["pair.wheel.lead_twist_um"]
    refused = faults(TWISTED + 'model = "ishikawa"\n')
    assert "pair.wheel.lead_twist_um" in refused["stiffness.model"]


def test_a_gear_has_a_width_of_its_own_and_overhangs_vary_the_load():
    scene = parse_scene(WIDE)
    assert gear_pair(scene).face_widths == pytest.approx((45e-3, 40e-3))
    assert gear_pair(scene).face_offsets == pytest.approx((2e-3, 0.0))
    assert varies_by(scene) == ["pair.pinion.face_width_mm"]
    assert varies_by(parse_scene(WIDE.replace("= 45, face_offset_mm = 2", "= 40"))) == []
    assert even_along_face(gear_pair(scene)) == gear_pair(parse_scene(SCENE))
    refused = faults(WIDE + 'model = "ishikawa"\n')
    assert "pair.pinion.face_width_mm" in refused["stiffness.model"]


def test_what_varies_the_load_is_named_and_plain_flanks_have_none_of_it():
    assert varies_by(parse_scene(SCENE)) == []
    assert varies_by(parse_scene(LEADS)) == [
        "pair.pinion.crowning_um",
        "pair.pinion.end_relief_um",
        "pair.wheel.lead_slope_um",
    ]
    assert varies_by(parse_scene(SCENE + "[alignment]\n")) == ["[alignment]"]
    assert gear_pair(plain_flanks(parse_scene(LEADS))) == gear_pair(parse_scene(SCENE))


def test_faults_of_keys_come_together_in_their_units():
    found = faults(LEADS.replace("crowning_um = 10", "crowning_um = 1010").replace("= -6", "= 1e6"))
    assert "at least -1000 and at most 1000 um" in found["pair.pinion.crowning_um"]
    assert "at least -1000 and at most 1000 um" in found["pair.wheel.lead_slope_um"]
    found = faults(ALIGNED.replace("= 20", "= 6000").replace("= 32", "= 2"))
    assert "at least -5000 and at most 5000 um" in found["alignment.in_plane_um"]
    assert "at least 4 and at most 512" in found["alignment.cells"]
    assert "at least 44 mm" in faults(WIDE.replace("= 45", "= 43"))["pair.pinion.face_width_mm"]
    assert "at most 100000 mm" in faults(WIDE.replace("= 2 }", "= 1e6 }"))["pair.pinion.face_offset_mm"]
    assert (
        "20 mm, half the face" in faults(LEADS.replace("= 5 }", "= 21 }"))["pair.pinion.end_relief_length_mm"]
    )


def test_a_face_that_takes_more_memory_than_is_free_is_refused_beforehand(monkeypatch):
    monkeypatch.setattr("fem.pair.face_memory.free_memory", lambda: 0.6e9)
    found = faults(ALIGNED.replace("cells = 32", "cells = 512"))
    assert "more memory than is free, 0.6 GB: at 120 positions" in found["alignment.cells"]
    assert "Take 166 cells or free memory" in found["alignment.cells"]


def test_an_end_relief_without_a_length_is_listed_beside_faults_of_the_same_gear():
    found = faults(LEADS.replace(", end_relief_length_mm = 5", "").replace("teeth = 36", "teeth = 3"))
    assert "must be more than 0 mm" in found["pair.pinion.end_relief_length_mm"]
    assert "at least 5" in found["pair.pinion.teeth"]


def test_what_is_not_known_with_cells_is_refused_at_once_before_anything_is_computed():
    text = ALIGNED.replace('["stiffness"]', '["stiffness", "film", "root-stress"]').replace(
        "pinion_torque_Nm = 600", "pinion_torque_Nm = 600\npinion_speed_rpm = 2000"
    )
    text += '[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\n[film]\nmodel = "ehl"\n'
    refuse(parse_scene(text))
    found = faults(text + 'stiffness = "tangent"\n')
    assert list(found) == ["film.stiffness"]
    assert "by [alignment]" in found["film.stiffness"]
    assert "or drop [alignment]" in found["film.stiffness"]


QUICK = (
    LEADS.replace("teeth = 36", "teeth = 20")
    .replace("teeth = 40", "teeth = 30")
    .replace("width_mm = 40", "width_mm = 20")
    + '[alignment]\nin_plane_um = 26\ncells = 8\nface_model = "walls"\n'
).replace("Nm = 600", "Nm = 100")


@pytest.fixture(scope="module")
def ran() -> Engine:
    """Walls, which take two seconds, beside slices and ISO 6336-1."""
    engine = Engine(parse_scene(QUICK), Cache(None))
    for stage in (PAIR, DRY_CYCLE, FACE_MODELS):
        engine[stage]
    return engine


def test_slices_are_no_answer_but_a_column_beside_it():
    message = faults(QUICK.replace('"walls"', '"slices"'))["alignment.face_model"]
    assert message.endswith("must be 'free-ends' or 'walls'")


def test_only_an_uneven_load_asks_for_the_face():
    names = {stage.name for stage in goals(parse_scene(QUICK))}
    assert {"gears along the face", "load over the face"} <= names
    assert not {"gears along the face", "load over the face"} & {s.name for s in goals(parse_scene(SCENE))}
    pair = gear_pair(parse_scene(LEADS))
    assert even_along_face(pair) == gear_pair(parse_scene(SCENE))


def test_the_cycle_has_the_scenes_cells_and_leads(ran):
    found = ran[DRY_CYCLE].contact.face
    assert found.setting.cells == 8
    assert found.setting.model == "walls"
    assert found.setting.leads == (ran[PAIR].pinion.lead, ran[PAIR].wheel.lead)
    # the load of the cells is that of the pairs, and the end that the axes open bears less
    np.testing.assert_allclose(found.line_load.mean(axis=-1) * 20e-3, ran[DRY_CYCLE].forces, rtol=1e-9)
    assert found.line_load[..., 0].sum() > 1.2 * found.line_load[..., -1].sum()
    # the greatest pressure of a pair is that of its cells
    contact = ran[DRY_CYCLE].contact
    np.testing.assert_allclose(contact.hertz_pressure, found.hertz_pressure.max(axis=-1), rtol=1e-12)


def test_other_models_beside_it(ran):
    found, pair = ran[FACE_MODELS], ran[PAIR]
    assert found.model == ("between walls", "independent slices", "ISO 6336-1, method C")
    assert found.misalignment == pytest.approx(20e-6)  # 26 less the slope of 6
    iso = closed_form.iso6336_face_load(pair, 100.0, 20e-6).K_Hbeta
    assert found.pitch_point_factor[-1] == found.face_load_factor[-1] == pytest.approx(iso)
    left_out = "crowning of the pinion, end relief of the pinion, free ends of the face, running in"
    assert found.iso_left_out == left_out
    assert found.line_load_difference[0] == 0.0
    assert found.pitch_point_factor[1] < found.pitch_point_factor[0]  # slices bear too evenly
    # all have the load of the pair at the pitch point
    np.testing.assert_allclose(found.line_load[:2].mean(axis=1), found.line_load[0].mean(), rtol=0.01)


@pytest.mark.parametrize("factor", [1.0, 1.3, 2.0, 3.7])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_line_of_iso_has_its_factor_and_its_mean(factor: float, side: float):
    x = (np.arange(20_000) + 0.5) / 20_000 - 0.5
    load = _linear(443.0, factor, side, x)
    assert load.mean() == pytest.approx(443.0, rel=1e-6)
    assert load.max() == pytest.approx(factor * 443.0, rel=1e-3)
    if factor > 1.0:
        assert (x[np.argmax(load)] > 0.0) == (side > 0.0)


def test_files_and_pictures_of_the_face(ran):
    values: Mapping[str, Any] = {stage.name: ran[stage] for stage in (PAIR, DRY_CYCLE, FACE_MODELS)}
    data = results_dataset(Computed(ran.scene, values))
    face_loads = ran[DRY_CYCLE].contact.face
    assert float(data["dry_face_greatest_face_load_factor"]) == face_loads.greatest_face_load_factor
    assert data["dry_face_face_load_factor"].attrs["error"] == face_loads.error
    assert (
        data["face_models_face_load_factor"].attrs["error_variable"] == "face_models_face_load_factor_error"
    )
    assert data["dry_face_line_load"].sizes["dry_face_cell"] == 8
    rows = results_tables(data)["face_load_dry"]
    assert rows["line_load_N_per_mm_pair_1"].size == 120 * 8
    for draw in (figures.flank_map, figures.face_load_factor, figures.line_load_models):
        assert all("[" in axes.get_xlabel() + axes.get_ylabel() for axes in draw(data).axes)
    curves = figures.line_load_models(data).axes[0].lines
    np.testing.assert_allclose(curves[1].get_ydata(), 1e-3 * ran[FACE_MODELS].line_load[1])
    part = face_parts.face(face_loads, ran[FACE_MODELS], data)
    assert "crowning of the pinion 10 µm" in part.paragraphs[0]
    assert "axes 26 µm out of parallel in the plane of action" in part.paragraphs[0]
    assert [row[0] for row in part.tables[1].rows] == list(ran[FACE_MODELS].model)
    assert len(part.figures) == 3
    assert "20 µm of slopes" in part.notes[-1]
    assert "Not in it: crowning of the pinion" in part.notes[-1]
    head = {one.name: one.note for one in face_parts.headlines(face_loads)}
    assert "walls, 8 cells" in head["maximum face-load factor"]


def test_outputs_of_studies_are_those_of_the_face(ran):
    loads, models = ran[DRY_CYCLE].contact.face, ran[FACE_MODELS]
    expected = {
        "face_load_factor": loads.greatest_face_load_factor,
        "greatest_line_load_N_per_mm": 1e-3 * loads.greatest_line_load,
        "face_pressure_MPa": 1e-6 * np.nanmax(loads.hertz_pressure),
        "contact_pattern": loads.contact_pattern,
        "face_load_factor_error": loads.error,
        "greatest_line_load_error": loads.line_load_error,
        "face_load_factor_at_C": models.pitch_point_factor[0],
        "slices_face_load_factor": models.pitch_point_factor[1],
        "iso_face_load_factor": models.pitch_point_factor[-1],
    }
    assert {name: OUTPUTS[name].value(ran) for name in expected} == pytest.approx(expected, rel=1e-12)
    even = Engine(parse_scene(ishikawa("Even", "stiffness")), Cache(None))
    assert all(np.isnan(OUTPUTS[name].value(even)) for name in expected)


ROOTS = QUICK.replace('["stiffness"]', '["root-stress"]')


@pytest.fixture(scope="module")
def rooted() -> Engine:
    engine = Engine(parse_scene(ROOTS.replace("tolerance = 0.005", "tolerance = 0.05")), Cache(None))
    for stage in (PAIR, DRY_CYCLE, ROOT_STRESS):
        engine[stage]
    return engine


@pytest.mark.slow
def test_root_stress_over_the_face_from_scene_to_page(rooted):
    assert "root stress" in {stage.name for stage in goals(rooted.scene)}
    found, pair = rooted[ROOT_STRESS], rooted[PAIR]
    gear = found.stress.wheel
    # crowning, the lead's slope and the axes together leave the end bearing that the axes close
    assert gear.greatest_tension.face_position < 0.0
    assert 1.0 < gear.face.face_factor < rooted[DRY_CYCLE].contact.face.greatest_face_load_factor
    iso = closed_form.iso6336_face_load(pair, 100.0, 20e-6)
    assert found.iso_face.K_Fbeta == pytest.approx(iso.K_Hbeta**iso.N_F)
    values: Mapping[str, Any] = {stage.name: rooted[stage] for stage in (PAIR, DRY_CYCLE, ROOT_STRESS)}
    data = results_dataset(Computed(rooted.scene, values))
    np.testing.assert_array_equal(data["root_face_wheel_cycle_tension"], gear.face.cycle_tension)
    assert float(data["iso6336_face_K_Fbeta"]) == found.iso_face.K_Fbeta
    rows = results_tables(data)["root_face_pinion"]
    assert rows["cycle_tension_MPa"].size == len(found.stress.pinion.face.face_position)
    axes = figures.root_face_map(data).axes
    assert len(axes[2].lines) == 2
    np.testing.assert_allclose(axes[2].lines[1].get_ydata(), 1e-6 * gear.face.cycle_tension)
    part = root_stress.section(found, data)
    assert [len(table.rows) for table in part.tables][:2] == [4, 6]
    assert "N_F" in part.tables[1].rows[5][0]
    assert "crowning of the pinion" in part.notes[1]
    assert len(part.figures) == 2
    expected = {
        "root_face_position_wheel_mm": 1e3 * gear.greatest_tension.face_position,
        "root_face_factor_wheel": gear.face.face_factor,
        "root_over_even_wheel": gear.face.over_even,
        "iso_root_face_factor": found.iso_face.K_Fbeta,
        "root_tension_wheel_MPa": 1e-6 * gear.greatest_tension_Pa,
    }
    assert {name: OUTPUTS[name].value(rooted) for name in expected} == pytest.approx(expected, rel=1e-12)


def test_gears_along_the_face_are_announced_once_and_kept(tmp_path: Path, no_gear_solved: None):
    scene = parse_scene(QUICK)

    def told() -> list[str]:
        forget_gears()
        titles: list[str] = []
        engine = Engine(scene, Cache(tmp_path), lambda stage: titles.append(stage.title))
        assert engine[FACE_GEARS].ends is None
        return titles

    line = "gears along the face, solved once and kept"
    assert line in told()
    assert line not in told()


OILED = QUICK.replace('["stiffness"]', '["film", "report"]').replace(
    "pinion_torque_Nm = 100", "pinion_torque_Nm = 100\npinion_speed_rpm = 2000"
) + (
    "[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\ntemperature_C = 80\n"
    '[film]\nmodel = "dowson"\n'
)


def test_films_over_the_face_from_scene_to_page():
    engine = Engine(parse_scene(OILED.replace("teeth = 20", "teeth = 20, lead_slope_um = 0")), Cache(None))
    pair, cycle = engine[PAIR], engine[FILM]
    over = cycle.over_face
    assert over.line_load.shape[-1] == 8
    values = {"pair": pair, "dry cycle": engine[DRY_CYCLE], "film": cycle}
    data = results_dataset(Computed(engine.scene, values))
    assert float(data["film_face_least_film"]) == over.least_film
    assert data["film_face_minimum_thickness"].dims[-1] == "film_face_cell"
    assert OUTPUTS["least_film_um"].value(engine) == pytest.approx(1e6 * over.least_film, rel=0.02)
    film, pressure = figures.film_map(data).axes[:2]
    assert "minimum_thickness" not in film.get_ylabel()
    assert film.collections[0].norm.vmin == pytest.approx(1e6 * over.least_film, rel=1e-6)
    assert film.collections[0].norm.vmax <= 1.5001e6 * over.least_film
    assert pressure.collections[0].norm.vmin == 0.0
    part = film_parts.film(cycle, data, 0.01)
    assert "most loaded cell" in part.paragraphs[1]
    assert len(part.figures) == 2


def test_films_that_do_not_follow_from_place_and_load_are_refused_under_their_keys():
    for old, new, where in (
        ('model = "dowson"', 'supply = "meniscus"\nmeniscus_half_widths = 1.3', "film.meniscus_half_widths"),
        ('model = "dowson"', 'model = "ehl"\nstiffness = "tangent"', "film.stiffness"),
    ):
        assert old in OILED
        assert "where the load varies along the face" in faults(OILED.replace(old, new))[where]
    refuse(parse_scene(OILED.replace('model = "dowson"', 'supply = "oil-layer"\noil_layer_um = 0.2')))
    refuse(parse_scene(OILED.replace('model = "dowson"', 'supply = "meniscus"\nmeniscus_mm = 0.4')))
    near = faults(OILED.replace('model = "dowson"', 'supply = "meniscus"\nmeniscus_mm = 0.01'))
    assert near["film.meniscus_mm"].endswith(" mm")  # in half-widths it would be refused
    refuse(parse_scene(OILED.replace('["film", "report"]', '["losses"]')))
