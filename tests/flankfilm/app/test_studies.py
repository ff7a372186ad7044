"""Studies and optimisations from the page: list, growing table, cancelled and resumed; files within the root."""

from __future__ import annotations

import shutil
import time
from pathlib import Path

import pytest

from base import InputError
from flankfilm.app.checking import Place
from flankfilm.app.model import Model
from flankfilm.app.scene_files import SceneFiles
from flankfilm.app.studies import Growing, asked_rows, heads, refuse_outside, rows_files
from flankfilm.studies.row import RowResult
from flankfilm.studies.table import Columns, append
from tests.flankfilm.app.test_model import RUN, Still
from tests.processes import MARK, left_after, new_mark

STUDY = """
title = "Contact ratio over the profile shift"
scene = "pair.toml"
outputs = ["contact_ratio"]
[vary]
"pair.pinion.profile_shift" = { from = 0.0, to = 0.3, steps = 4 }
"""
OPTIMUM = """
title = "Largest contact ratio"
scene = "pair.toml"
maximise = ["contact_ratio"]
evaluations = 24
population = 8
[vary]
"pair.pinion.profile_shift" = { from = -0.1, to = 0.3 }
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "pair.toml").write_text(RUN, encoding="utf-8")
    (tmp_path / "shift.toml").write_text(STUDY, encoding="utf-8")
    (tmp_path / "best.toml").write_text(OPTIMUM, encoding="utf-8")
    return tmp_path


def test_studies_and_optimisations_are_listed_with_their_rows_and_scenes_are_not(folder):
    own = [asked for asked in rows_files(SceneFiles(folder)) if not asked.example]
    assert [(asked.name, asked.kind, asked.folder, asked.rows) for asked in own] == [
        ("best.toml", "optimise", "best-optimum", 0),
        ("shift.toml", "study", "shift-study", 0),
    ]
    examples = {asked.name for asked in rows_files(SceneFiles(folder)) if asked.example}
    assert {"studies/tip_relief.toml", "optimise/tip_relief.toml"} <= examples
    for name in ("pair.toml", "none.toml", "../shift.toml"):
        with pytest.raises(InputError):
            asked_rows(SceneFiles(folder), name, example=False)


COLUMNS = Columns(("pair.module_mm",), ("contact_ratio",))


def test_a_table_gives_each_row_once_when_it_is_whole(tmp_path):
    path = tmp_path / "rows.csv"
    table = Growing(path)
    assert table.more() == (0, [])
    append(path, COLUMNS, (2.0,), RowResult(0, (1.7,), 0.5))
    assert table.more() == (0, [["0", "2.0", "1.7", "0.5", ""]])
    assert table.more() == (1, [])
    append(path, COLUMNS, (3.0,), RowResult(1, (1.8,), 0.5, "a, fault"))
    data = path.read_bytes()
    path.write_bytes(data[:-4])  # half written
    assert table.more() == (1, [])
    path.write_bytes(data)
    assert table.more() == (1, [["1", "3.0", "1.8", "0.5", "a, fault"]])
    path.unlink()
    append(path, COLUMNS, (4.0,), RowResult(0, (1.9,), 0.5))
    assert table.more() == (0, [["0", "4.0", "1.9", "0.5", ""]])  # made anew
    assert len(heads(COLUMNS.keys, COLUMNS.outputs)) == len(COLUMNS.header) - 1


def test_files_outside_the_root_are_refused_wherever_a_study_names_them(folder, tmp_path_factory):
    outside = tmp_path_factory.mktemp("outside") / "pair.toml"
    outside.write_text(RUN, encoding="utf-8")
    place = Place(folder, folder)
    refuse_outside(folder / "shift.toml", place)
    wear = '\n[set]\n"pair.pinion.wear.file" = "/etc/hostname"\n'
    varied = STUDY.replace("[vary]", '[vary]\n"pair.pinion.wear.file" = ["/etc/hostname"]')
    for text in (STUDY.replace("pair.toml", str(outside)), STUDY + wear, varied):
        (folder / "evil.toml").write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match="must be below"):
            refuse_outside(folder / "evil.toml", place)


def finished(model, told, seconds=120.0):
    state = model._run.wait(seconds)
    assert state.status is not None, state.log
    return state, [row for kind, content in told if kind == "rows" for row in content["rows"]]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "rows"), [("shift.toml", 4), ("best.toml", 8)])
def test_rows_arrive_and_the_end_has_a_report(folder, monkeypatch, name, rows):
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    told = []
    model = Model(SceneFiles(folder), lambda kind, content: told.append((kind, content)))
    model.rows(name)
    with pytest.raises(InputError, match="at work already"):
        model.rows(name)
    state, arrived = finished(model, told)
    assert (state.status, state.report) == (0, True), state.log
    assert len(arrived) >= rows
    assert sorted(int(row[0]) for row in arrived) == list(range(len(arrived)))  # workers end in any order
    (named,) = (content["heads"] for kind, content in told if content.get("heads"))
    assert "contact_ratio" in [head["name"] for head in named]
    model.close()


@pytest.mark.slow
def test_a_cancelled_study_is_resumed_to_the_rows_of_one_that_was_not(folder, monkeypatch):
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    mark = new_mark()
    monkeypatch.setenv(MARK, mark)
    (folder / "shift.toml").write_text(STUDY.replace("steps = 4", "steps = 400"), encoding="utf-8")
    shutil.copy(folder / "shift.toml", folder / "whole.toml")
    told = []
    model = Model(SceneFiles(folder), lambda kind, content: told.append((kind, content)))
    model.rows("shift.toml")
    until = time.monotonic() + 60.0
    while not any(content.get("rows") for _, content in told) and time.monotonic() < until:
        time.sleep(0.01)
    model.cancel()
    state, early = finished(model, told)
    assert state.cancelled
    assert 0 < len(early) < 400
    assert left_after(mark) == {}
    model.rows("shift.toml")  # neither begun anew nor resumed by itself
    state, _ = finished(model, told)
    assert state.status == 2
    assert "holds" in " ".join(state.log)
    told.clear()
    model.rows("shift.toml", "", "resume")
    state, resumed = finished(model, told)
    assert state.status == 0, state.log
    model.rows("whole.toml")
    state, _ = finished(model, told)
    assert state.status == 0
    numbers = [without_costs(folder / name / "rows.csv") for name in ("shift-study", "whole-study")]
    assert numbers[0] == numbers[1]
    assert len(resumed) == 400
    model.close()


def without_costs(path: Path) -> list[list[str]]:
    return sorted(line.split(",")[:3] for line in path.read_text(encoding="utf-8").splitlines())
