"""A part of a scene that fails leaves the others' results, and stands nowhere with a number."""

from __future__ import annotations

import json
from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import flankfilm as ff
from base import PartWarning, SolverError
from flankfilm import cli, coupling
from flankfilm.files.cache import Cache
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.processes.assistant import Assistant
from flankfilm.processes.exit_status import guarded
from flankfilm.report.page import Headline
from flankfilm.runs.report import headlines, misses, summary
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine, Stage, StageRun
from flankfilm.stages.mesh import DRY_CYCLE, FIELDS, FILM, PAIR
from flankfilm.stages.motion import FOURIER
from flankfilm.studies.row import Row, compute_row
from tests.flankfilm.scenes import CLOSED_FORMS_WITH_FILM as SCENE
from tests.flankfilm.scenes import ISHIKAWA

WHY = "no film at rho1 = 7.000 mm: as good as dry; raise the viscosity"


def lubricate(*_, **__):
    """Films that have no solution."""
    raise SolverError(WHY)


@pytest.fixture
def without_film(monkeypatch):
    monkeypatch.setattr(coupling, "lubricate", lubricate)
    return parse_scene(SCENE)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    scene = parse_scene(SCENE.replace('"fourier"]', '"fourier", "report"]'))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(coupling, "lubricate", lubricate)
        return run_scene(scene, tmp_path_factory.mktemp("parts") / "out", use_cache=False)


class TestARunWhoseFilmFails:
    def test_it_names_what_failed_and_what_needs_it(self, found):
        assert {one.name: one.because for one in found.failures} == {
            "film": "",
            "mesh": "oil film in series with the teeth",
            "fourier": "oil film in series with the teeth",
        }
        assert found.failures[0].why == WHY
        with pytest.raises(SolverError, match="as good as dry"):
            found.get(FILM)
        with pytest.raises(SolverError, match="as good as dry"):
            found.get(FOURIER)
        assert found.get(DRY_CYCLE).mean_secant_stiffness > 0
        assert "failed 3" in repr(found)

    def test_its_files_hold_the_others_and_nothing_of_the_film(self, found):
        assert {"results.nc", "report.html"} <= {path.name for path in found.files}
        with xr.open_dataset(found.folder / "results.nc", engine="h5netcdf") as data:
            assert np.all(data.dry_secant_stiffness > 0)
            assert not [name for name in data.variables if name.startswith(("film", "lubricated", "fourier"))]
            said = json.loads(data.attrs["not_computed_json"])
        assert [one["part"] for one in said] == ["film", "mesh", "fourier"]
        assert said[0]["why"] == WHY

    def test_its_report_says_so_and_shows_no_dry_number_as_the_lubricated_one(self, found):
        page = (found.folder / "report.html").read_text(encoding="utf-8")
        assert "Not computed" in page
        assert WHY in page
        assert "those of teeth without film" in page
        assert all("without the film" in one.name for one in headlines(found.computed))
        assert WHY in found._repr_html_()
        assert any("without the film" in line for line in summary(found))


def test_the_command_says_so_and_ends_with_4(without_film, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE, encoding="utf-8")
    options = cli.SceneOptions(out=tmp_path / "out", cache=False)
    assert guarded(lambda: cli.run(path, options=options)) == 4
    said = capsys.readouterr()
    assert f"not computed: oil film in series with the teeth: {WHY}" in said.err
    assert "because of it: mesh stiffness of the motion, Fourier stiffness" in said.err
    assert "mean mesh stiffness (secant, relative to the root circles), without the film" in said.out


def test_a_run_from_python_warns(without_film):
    with pytest.warns(PartWarning, match=r"as good as dry|because of it"):
        found = ff.run(without_film, cache=False)
    assert "dry_secant_stiffness" in found.dataset


def test_a_run_without_any_result_raises_and_writes_nothing(without_film, tmp_path, monkeypatch):
    def sampled(*_):
        raise SolverError("no contact; reduce the torque")

    monkeypatch.setattr(coupling.LoadedTeeth, "sampled", sampled)
    alone = without_film.model_copy(update={"wants": ("stiffness",)})
    with pytest.raises(SolverError, match="no contact"):
        run_scene(alone, tmp_path / "out", use_cache=False)
    assert not list((tmp_path / "out").glob("[!.]*"))


def test_fields_that_cannot_be_written_leave_the_rest(tmp_path, monkeypatch):
    from flankfilm.runs import begin
    from flankfilm.runs import run_scene as running

    def begin_fields(*_):
        raise SolverError("no field; refine")

    text = ISHIKAWA.replace("[WANTS]", '["geometry", "vtk"]')
    scene = parse_scene(text.replace('"ishikawa"', '"fem"').replace('"independent"', '"coupled"'))
    monkeypatch.setattr(running, "begin_fields", begin_fields)
    monkeypatch.setattr(begin, "goals", lambda _: (PAIR,))
    found = run_scene(scene, tmp_path, use_cache=False)
    assert [one.title for one in found.failures] == ["fields for ParaView"]
    with xr.open_dataset(tmp_path / "results.nc", engine="h5netcdf") as data:
        assert "no field" in data.attrs["not_computed_json"]


def test_fields_are_begun_before_their_stage_and_not_written_where_it_fails(tmp_path, monkeypatch):
    from flankfilm.runs import ahead, begin
    from flankfilm.runs import run_scene as running

    order = []

    def fail(run):
        order.append("stage")
        raise SolverError("no field; refine")

    def begin_fields(*_):
        order.append("files")
        return SimpleNamespace(written=lambda *_: pytest.fail("fields of a stage that failed"))

    fields = Stage(FIELDS.name, FIELDS.title, fail, lambda scene: {})
    mesh = Stage("some mesh", "some mesh", lambda run: order.append("mesh"), lambda scene: {})
    monkeypatch.setattr(running, "FIELDS", fields)
    monkeypatch.setattr(ahead, "MESH", mesh)
    monkeypatch.setattr(ahead, "begin_fields", begin_fields)
    monkeypatch.setattr(running, "assistant", lambda _: nullcontext(Assistant()))
    monkeypatch.setattr(Assistant, "there", True)
    monkeypatch.setattr(begin, "goals", lambda _: (PAIR, fields, mesh))
    text = ISHIKAWA.replace("[WANTS]", '["geometry", "vtk"]')
    scene = parse_scene(text.replace('"ishikawa"', '"fem"').replace('"independent"', '"coupled"'))
    found = run_scene(scene, tmp_path, use_cache=False)
    assert order == ["mesh", "files", "stage"]
    assert [one.title for one in found.failures] == [FIELDS.title]


def test_a_stage_that_failed_is_not_computed_again():
    calls = []

    def fail(run):
        calls.append(1)
        raise SolverError("no")

    below = Stage("below", "what is below", fail, lambda scene: {})
    first, second = (Stage(name, name, lambda run: run[below], lambda scene: {}, (below,)) for name in "ab")
    engine = Engine(parse_scene(SCENE), Cache(None))
    for stage in (first, second, below):
        with pytest.raises(SolverError):
            engine[stage]
    assert len(calls) == 1
    assert {one.name: one.because for one in engine.failures.values()} == {
        "below": "",
        "a": "what is below",
        "b": "what is below",
    }
    fine = Stage("fine", "fine", lambda run: 3, lambda scene: {})
    assert engine[fine] == 3
    assert engine.runs["fine"].seconds >= 0


def test_a_row_keeps_the_outputs_that_do_not_need_what_failed(without_film):
    raw = without_film.model_dump(exclude_none=True, mode="json")
    outputs = ("contact_ratio", "least_film_um", "hertz_pressure_GPa")
    found = compute_row(Row(0, raw, outputs, use_cache=False))
    assert found.values[0] == pytest.approx(1.703, abs=1e-3)
    assert np.isnan(found.values[1:]).all()
    assert found.fault == f"least_film_um, hertz_pressure_GPa: {WHY}"
    assert not found.lost
    assert compute_row(Row(0, raw, outputs[1:], use_cache=False)).lost


def test_an_error_above_the_tolerance_is_said(found):
    def said(error):
        return Headline("stress", "1", unit="MPa", uncertainty=Uncertainty(error, 0.3)).miss(0.005)

    assert said(0.0123) == "stress: its numerical error of 1.2 % is above the tolerance of 0.5 %"
    assert said(0.004) == said(None) == ""
    assert misses(found.computed) == []
    torques = SimpleNamespace(converged=False, message="1e+09 N m: reduce the torque")
    run = StageRun("torques", "mesh cycles over torque", 0.1, cached=False)
    doubted = replace(found, values={**found.values, "torques": torques}, runs={**found.runs, "torques": run})
    line = "mesh cycles over torque: 1e+09 N m: reduce the torque"
    assert line in misses(doubted.computed)
    assert line in summary(doubted)
