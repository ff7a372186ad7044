"""The model of a window without a browser: edits, files, runs; 200 random edits raise nothing and leave nothing."""

from __future__ import annotations

import contextlib
import json
import random
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest

from base import InputError
from flankfilm.app import scene_files
from flankfilm.app.form import form_keys
from flankfilm.app.model import Model
from flankfilm.app.scene_files import SceneFiles
from tests.processes import MARK, left_after, new_mark
from tests.seeds import SEED

ROOT = Path(__file__).parents[3]
ARTICLE = (ROOT / "examples" / "article.toml").read_text(encoding="utf-8")


class Still:
    """Live answers that never come."""

    def __init__(self, tell):
        self.asked, self.process = 0, None

    def ask(self, document, place):
        self.asked += 1
        return self.asked

    def forget(self):
        pass

    def close(self):
        pass


@pytest.fixture
def window(tmp_path, monkeypatch):
    """A window on a folder with the article's scene, without live answers."""
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    (tmp_path / "article.toml").write_text(ARTICLE, encoding="utf-8")
    told = []
    model = Model(SceneFiles(tmp_path), lambda kind, content: told.append((kind, content)), "article.toml")
    yield model
    model.close()


def test_a_view_has_values_faults_answers_and_a_drawing_as_plain_values(window):
    view = window.view()
    assert json.loads(json.dumps(view, allow_nan=False))
    assert view["name"] == "article.toml"
    assert view["faults"] == {}
    answers = {answer["name"]: answer for answer in view["answers"]}
    assert answers["transverse contact ratio"]["text"] == "1.70299"
    assert all(answer["error"] for answer in view["answers"])
    assert {answer["group"] for answer in view["answers"]} == {
        "Geometry",
        "Sliding",
        "ISO 6336",
        "Inspection",
    }
    assert view["drawing"]["turn"] == (10.0, -9.0)
    assert view["number"] == 1


def test_an_edit_is_judged_and_taken_back(window):
    window.edit("pair.module_mm", "2.")
    assert "must be a finite number" in window.view()["faults"]["pair.module_mm"][0]
    assert window.view()["answers"] == []
    window.edit("pair.module_mm", "2.5")
    assert window.view()["faults"] == {}
    assert not window.view()["saved"]
    window.undo()
    window.undo()
    window.undo()
    assert window.text == ARTICLE
    assert window.view()["saved"]


def test_a_fault_asks_for_no_contact(window):
    asked = window._live.asked
    window.edit("pair.module_mm", "x")
    assert window._live.asked == asked
    assert window.view()["why_no_curves"] == "Correct the faults first."


def test_files_are_saved_below_the_folder_with_their_comments(window, tmp_path):
    window.edit("pair.module_mm", "3")
    window.save("sub/other.toml")
    text = (tmp_path / "sub" / "other.toml").read_text(encoding="utf-8")
    assert text == ARTICLE.replace("module_mm = 2.0", "module_mm = 3")
    assert (tmp_path / "article.toml").read_text(encoding="utf-8") == ARTICLE
    assert window.files.listed() == ("article.toml", "sub/other.toml")
    for name in ("../out.toml", str(tmp_path.parent / "out.toml"), "out.txt", ".toml", ""):
        with pytest.raises(InputError):
            window.save(name)
    (tmp_path / "link.toml").symlink_to("/etc/hostname")
    with pytest.raises(InputError, match="must be below"):
        window.open("link.toml")


def test_a_file_that_somebody_else_wrote_meanwhile_is_kept(window, tmp_path):
    window.edit("pair.module_mm", "3")
    (tmp_path / "article.toml").write_text("# theirs\n", encoding="utf-8")
    with pytest.raises(InputError, match="somebody else"):
        window.save("article.toml")
    assert (tmp_path / "article.toml").read_text(encoding="utf-8") == "# theirs\n"
    window.save("mine.toml")


def test_examples_and_the_template_open(window):
    for name in ("", *window.files.examples()):
        window.example(name)
        assert window.view()["faults"] == {}, name
    assert len(window.files.examples()) > 5
    with pytest.raises(InputError):
        window.example("../pyproject")


def test_gear_data_go_out_and_come_in(window, tmp_path):
    window.save("pair.rexs")
    assert "pair.rexs" in window.files.listed()
    before = window.view()["answers"]
    window.open("pair.rexs")
    assert window.view()["answers"][0] == before[0]
    window.edit("wants", '["geometry"]')
    with pytest.raises(InputError, match="exists already"):
        window.save("pair.rexs")


def test_the_python_of_a_scene_makes_the_same_scene(window, tmp_path):
    window.edit("title", 'with """ and \\')
    for code in (window.python(), scene_files.python_of(window.files.open("article.toml").document, "x")):
        head = code.partition("results =")[0]
        shown = f"{head}\nimport sys; sys.stdout.write(SCENE)"
        text = subprocess.run(
            [sys.executable, "-c", shown], capture_output=True, text=True, check=True
        ).stdout
        assert tomllib.loads(text)["pair"]["module_mm"] == 2.0
    assert tomllib.loads(ARTICLE) == tomllib.loads(text)


WORDS = ["", "0", "-", "1e", "2.", "nan", "inf", "1e400", "-3", "17", "0.1", "2000", "[1, 2]", "{ teeth = 9 }", "true",
         '"', "ehl", "fem", "[[", "é", "x = 3", "9" * 60, "[" * 40, "../../x.csv"]  # fmt: skip


def test_200_random_edits_raise_nothing(window):
    dice = random.Random(SEED)
    paths = sorted(form_keys())
    for _ in range(200):
        path = dice.choice(paths)
        typed = dice.choice([*WORDS, *form_keys()[path].choices, form_keys()[path].example])
        with contextlib.suppress(InputError):  # a table that was typed over
            window.edit(path, typed)
        json.dumps(window.view(), allow_nan=False)
        if dice.random() < 0.2:
            window.undo()
    tomllib.loads(window.text)


@pytest.mark.slow
def test_200_random_edits_with_live_answers_leave_no_process(tmp_path, monkeypatch):
    mark = new_mark()
    monkeypatch.setenv(MARK, mark)
    told = []
    model = Model(SceneFiles(tmp_path), lambda kind, content: told.append(content))
    dice = random.Random(SEED)
    drags = {
        "operating.pinion_torque_Nm": (100, 900),
        "pair.pinion.tip_relief.amount_um": (0, 30),
        "pair.pinion.profile_shift": (-0.3, 0.5),
        "pair.backlash_um": (-20, 100),
        "pair.wheel.tip_relief.length_mm": (-1, 3),
    }
    for _ in range(200):
        path = dice.choice(sorted(drags))
        model.edit(path, f"{dice.uniform(*drags[path]):.3g}")
        model.view()
        time.sleep(dice.choice([0.0, 0.02, 0.3]))
    until = time.monotonic() + 60.0
    model.example("")
    while not any(message["number"] == model._number for message in told) and time.monotonic() < until:
        time.sleep(0.05)
    assert told[-1]["number"] == model._number
    assert model.processes
    model.close()
    assert left_after(mark) == {}


RUN = """
wants = ["geometry", "report"]
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36 }
wheel = { teeth = 40 }
"""


@pytest.mark.slow
def test_a_run_writes_its_report_and_a_cancelled_one_leaves_nothing_running(tmp_path, monkeypatch):
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    mark = new_mark()
    monkeypatch.setenv(MARK, mark)
    (tmp_path / "pair.toml").write_text(RUN, encoding="utf-8")
    states = []
    model = Model(SceneFiles(tmp_path), lambda kind, content: states.append(content), "pair.toml")
    model.run()
    with pytest.raises(InputError, match="is at work already"):
        model.run()
    state = model._run.wait(120.0)
    assert (state.status, state.report, state.what) == (0, True, "done"), state.log
    assert (tmp_path / "pair-results" / "report.html").is_file()
    assert {one["what"] for one in states} >= {"geometry", "done"}
    lefts = [one["left"] for one in states if one["left"] is not None]
    assert lefts[0] > lefts[-1] >= 0.0
    assert state.left is None
    for pause in (0.0, 1.0):
        model.example("article")
        model.run()
        time.sleep(pause)
        model.cancel()
        state = model._run.wait(30.0)
        assert state.cancelled
        assert state.status not in (0, None)
    model.run()
    model.close()
    assert left_after(mark) == {}


def test_a_scene_with_faults_is_not_run(window):
    window.edit("pair.module_mm", "x")
    with pytest.raises(InputError, match="must be a finite number"):
        window.run()
