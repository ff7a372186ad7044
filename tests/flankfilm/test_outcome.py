"""One outcome of run, study, optimisation and verification: data, files, page, lines and picture; one folder each."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import flankfilm as ff
from base import InputError
from flankfilm.files.folder import REPORTS, locked, occupied
from flankfilm.optimisation.files import OptimumOutcome, optimum_outcome
from flankfilm.optimisation.optimum import Evaluation, Optimum
from flankfilm.optimisation.task import read_task
from flankfilm.outcome.outcome import Outcome, concluded
from flankfilm.runs import report
from flankfilm.runs.run_scene import run_outcome, run_scene
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.studies.execution import Execution
from flankfilm.studies.files import StudyOutcome, study_outcome
from flankfilm.studies.plan import read_plan
from flankfilm.studies.row import RowResult
from flankfilm.studies.run import StudyResults
from flankfilm.verification.run import verification_outcome
from tests.flankfilm.scenes import ishikawa
from tests.flankfilm.test_optimise import task_file
from tests.flankfilm.test_study import SHIFTS, study_file

RUN = ishikawa("one outcome", "closed-forms", "stiffness", "report")


def ran(source: Path, folder: Path | None) -> Outcome:
    return run_outcome(parse_scene(RUN), folder, use_cache=False)


def studied(source: Path, folder: Path | None) -> Outcome:
    plan = read_plan(study_file(source, SHIFTS))
    rows = tuple(RowResult(index, (1.5 + 0.1 * index, 2.0), 0.1, "") for index in range(len(plan.rows)))
    with occupied(folder, StudyOutcome.data):
        if folder is not None:
            (folder / "rows.csv").write_text("rows")
        return concluded(StudyOutcome(StudyResults(plan, rows, 4, 1.0)), folder)


def optimised(source: Path, folder: Path | None) -> Outcome:
    task = read_task(task_file(source, 'minimise = ["specific_sliding"]\nevaluations = 40'))
    points = [
        Evaluation(task.tolerances[1], task.values([0.1 * k]), RowResult(k, (3.0 - 0.1 * k,), 0.1))
        for k in range(4)
    ]
    with occupied(folder, OptimumOutcome.data):
        if folder is not None:
            (folder / "rows.csv").write_text("rows")
        return concluded(OptimumOutcome(Optimum(task, tuple(points), np.array([3]), 4, 1.0)), folder)


def verified(source: Path, folder: Path | None) -> Outcome:
    return verification_outcome(parse_scene(RUN), folder)


def test_figures_of_a_run_are_known_before_its_files_are(tmp_path):
    said: list[str] = []

    def computed(results: Computed) -> None:
        assert not [path for path in tmp_path.rglob("*") if path.suffix]
        said.extend(report.figure_lines(results))

    outcome = run_outcome(parse_scene(RUN), tmp_path, use_cache=False, computed=computed)
    assert (tmp_path / "results.nc").exists()
    assert said
    assert list(outcome.lines[: len(said)]) == said


KINDS = {"results.nc": ran, "study.nc": studied, "optimum.nc": optimised, "verify.nc": verified}


@pytest.fixture(scope="module", params=KINDS)
def outcome(request, tmp_path_factory) -> Outcome:
    place = tmp_path_factory.mktemp("outcome")
    return KINDS[request.param](place, place / "out")


def test_each_file_of_data_has_its_outcome():
    assert list(KINDS) == list(REPORTS)


def test_files_are_there_and_listed_and_nothing_else_is(outcome):
    folder = outcome.folder
    names = {path.relative_to(folder).as_posix() for path in outcome.files}
    there = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert there - {"files.json", ".lock"} == names
    assert {outcome.data, "report.html"} <= names
    assert len(names) == len(outcome.files)
    assert outcome.files[-1].name == "report.html"
    assert outcome.others == ()
    assert json.loads((folder / "files.json").read_text())["sha256"].keys() == names


def test_the_dataset_is_what_the_file_holds(outcome):
    held = ff.open_results(outcome.folder)
    assert set(held.variables) == set(outcome.dataset.variables)
    for name, variable in held.variables.items():
        np.testing.assert_array_equal(variable.values, outcome.dataset[name].values)
    assert held.attrs["scene_json"] == outcome.dataset.attrs["scene_json"]


def test_it_has_lines_a_status_and_a_picture(outcome):
    texts = [line for line in outcome.lines if isinstance(line, str)]
    assert any(str(outcome.folder) in text for text in texts)
    assert (outcome.status, tuple(outcome.faults)) == (0, ())
    assert isinstance(outcome.plot(), Figure)


@pytest.mark.parametrize("kind", KINDS)
def test_without_a_folder_nothing_is_written(kind, tmp_path, monkeypatch):
    (tmp_path / "source").mkdir()
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    outcome = KINDS[kind](tmp_path / "source", None)
    assert (outcome.folder, outcome.files, outcome.others) == (None, (), ())
    assert list((tmp_path / "here").iterdir()) == []


COMMANDS = {
    "results.nc": lambda source, folder: run_outcome(parse_scene(RUN), folder),
    "study.nc": lambda source, folder: study_outcome(
        read_plan(study_file(source, SHIFTS)), folder, Execution(workers=1)
    ),
    "optimum.nc": lambda source, folder: optimum_outcome(
        read_task(task_file(source, 'minimise = ["specific_sliding"]\nevaluations = 40')),
        folder,
        Execution(workers=1),
    ),
    "verify.nc": lambda source, folder: verification_outcome(parse_scene(RUN), folder),
}


@pytest.mark.parametrize("kind", COMMANDS)
def test_a_folder_in_use_or_of_something_else_is_refused_before_anything_is_computed(
    kind, tmp_path, monkeypatch
):
    def computed(*_, **__):
        pytest.fail("computed")

    for place in ("runs.run_scene._computed", "studies.files.computed", "optimisation.files.searched",
                  "verification.run._verified"):  # fmt: skip
        monkeypatch.setattr(f"flankfilm.{place}", computed)
    out = tmp_path / "out"
    out.mkdir()
    with locked(out), pytest.raises(InputError, match="at work there"):
        COMMANDS[kind](tmp_path, out)
    for name in REPORTS.keys() - {kind}:
        (out / name).write_text("of something else")
        (out / "report.html").write_text("of something else")
        with pytest.raises(InputError, match=r"whose report\.html would be replaced"):
            COMMANDS[kind](tmp_path, out)
        (out / name).unlink()
        (out / "report.html").unlink()


def test_a_study_removes_nothing_of_a_run_beside_it(tmp_path):
    """Without a report they may share a folder."""
    out = tmp_path / "out"
    run_scene(parse_scene(ishikawa("beside", "geometry")), out, use_cache=False)
    written = set(out.rglob("*.csv")) | {out / "results.nc"}
    outcome = studied(tmp_path, out)
    assert all(path.exists() for path in written)
    assert {"results.nc"} <= set(outcome.others)
    (out / "report.html").unlink()
    run_scene(parse_scene(ishikawa("beside", "geometry")), out, use_cache=False)
    assert (out / "study.nc").exists()
