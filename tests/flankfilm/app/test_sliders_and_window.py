"""Sliders reach what makes sense and bring what they need; a window answers whatever it is called with."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from base import InputError
from flankfilm.app import command
from flankfilm.app.command import app
from flankfilm.app.document import Document
from flankfilm.app.scene_files import SceneFiles
from flankfilm.app.sliders import STEPS, sliders
from flankfilm.app.window import MOST_TABS, Window
from tests.flankfilm.app.test_model import ARTICLE, Still

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("*.toml")), ids=lambda path: path.stem)
def test_a_slider_holds_the_value_of_the_scene_on_a_round_step(example):
    document = Document.read(example.read_text(encoding="utf-8"))
    for one in sliders(document, 76.0):
        assert one.low <= one.value <= one.high, one
        assert STEPS <= (one.high - one.low) / one.step <= 3.0 * STEPS, one
        assert float(f"{one.step:.0e}") == one.step, one


@pytest.fixture
def window(tmp_path, monkeypatch):
    """A window on the article's scene."""
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    (tmp_path / "article.toml").write_text(ARTICLE, encoding="utf-8")
    opened = Window(SceneFiles(tmp_path), "article.toml", lambda kind, content: None)
    yield opened
    opened.close()


def test_dragging_a_relief_or_the_axes_leaves_a_scene_without_faults(window):
    for path, typed in (
        ("pair.pinion.tip_relief.amount_um", "12"),
        ("pair.centre_distance_mm", "76.1"),
        ("alignment.in_plane_um", "-8"),
        ("pair.pinion.crowning_um", "5"),
    ):
        answer = window.call("drag", path, typed)
        assert (answer["problem"], answer["view"]["faults"]) == ("", {}), path
        assert answer["view"]["values"][path] == typed
    assert answer["view"]["values"]["pair.pinion.tip_relief.length_mm"] == "2"
    assert "pair.backlash_um" not in answer["view"]["values"]


def test_the_ends_of_all_sliders_are_answered(window):
    view = window.call("start")["view"]
    assert len(view["sliders"]) == 9
    for one in view["sliders"]:
        for value in (one["low"], one["high"], one["value"]):
            answer = window.call("drag", one["path"], repr(value))
            assert answer["problem"] == ""
            json.dumps(answer, allow_nan=False)
        while window.call("undo")["view"]["saved"] is False:
            pass


def test_helix_angles_through_zero_are_answered(window):
    for angle in ("-1", "-0.1", "0", "-0", "0.1", "1"):
        answer = window.call("drag", "pair.helix_angle_deg", angle)
        assert answer["problem"] == ""


def test_a_page_that_is_loaded_again_goes_on_with_the_edits_of_its_tab(tmp_path, monkeypatch):
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    (tmp_path / "article.toml").write_text(ARTICLE, encoding="utf-8")
    tabs = {}

    def loaded(tab: str) -> Window:
        window = Window(SceneFiles(tmp_path), "article.toml", lambda kind, content: None, tabs)
        window.view = window.call("start", tab)["view"]
        return window

    first = loaded("a")
    assert first.view["saved"]
    first.call("edit", "pair.module_mm", "3")
    first.close()
    again, other = loaded("a"), loaded("b")
    assert (again.view["values"]["pair.module_mm"], again.view["saved"]) == ("3", False)
    assert (other.view["values"]["pair.module_mm"], other.view["saved"]) == ("2.0", True)
    beside = loaded("a")  # a tab that was duplicated
    assert not again.call("start", "a")["view"]["saved"]
    for window in (again, beside):
        back = window.call("undo")["view"]
        assert (back["values"]["pair.module_mm"], back["saved"]) == ("2.0", True)
    for k in range(MOST_TABS):
        loaded(f"further {k}")
    assert len(tabs) == MOST_TABS
    assert "a" not in tabs


@pytest.mark.parametrize(
    ("method", "arguments"),
    [
        ("close", ()),
        ("__init__", ()),
        ("edit", ()),
        ("edit", ("pair.module_mm",)),
        ("edit", ("os.system", "ls")),
        ("edit", ("pair.module_mm", 3)),
        ("edit", ("pair.module_mm", "1" * 2_000_000)),
        ("open", ("/etc/passwd",)),
        ("open", ("../secret.toml",)),
        ("open", ("missing.toml",)),
        ("save", ("../out.toml",)),
        ("example", ("../../pyproject",)),
        ("no such method", ()),
    ],
)
def test_calls_that_are_wrong_are_answered_with_a_problem(window, method, arguments):
    answer = window.call(method, *arguments)
    assert answer["problem"]
    assert answer["view"]["name"] == "article.toml"


def test_a_scene_that_cannot_be_opened_is_a_problem_once(tmp_path, monkeypatch):
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    window = Window(SceneFiles(tmp_path), "missing.toml", lambda kind, content: None)
    assert "missing.toml" in window.call("start")["problem"]
    assert window.call("start")["problem"] == ""
    window.close()


def test_a_disk_that_is_full_is_a_problem(window, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device", "article.toml")

    monkeypatch.setattr(Path, "write_text", full)
    window.call("edit", "pair.module_mm", "3")
    assert "No space left" in window.call("save", "article.toml")["problem"]


def test_without_the_extra_the_command_says_how_to_install_it(monkeypatch):
    monkeypatch.setattr(command, "NEEDED", ("a_library_that_is_not_there",))
    with pytest.raises(InputError, match=r"needs a_library_that_is_not_there.*flankfilm\[app\]"):
        app()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [({"port": -1}, "0 to 65535"), ({"folder": Path("nowhere")}, "is no folder")],
)
def test_wrong_options_are_refused(monkeypatch, arguments, said):
    monkeypatch.setattr(command, "NEEDED", ())
    with pytest.raises(InputError, match=said):
        app(**arguments)
    with pytest.raises(InputError, match="must be below"):
        app(ROOT / "examples" / "article.toml", folder=ROOT / "docs")
