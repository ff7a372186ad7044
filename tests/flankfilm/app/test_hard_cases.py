"""A full disk, a second app on the same folder, and results that an earlier run left."""

from __future__ import annotations

import contextlib
import resource
import time

import pytest

from base import InputError
from flankfilm.app.model import Model
from flankfilm.app.scene_files import SceneFiles
from flankfilm.app.window import Window
from tests.flankfilm.app.test_model import RUN, Still
from tests.processes import MARK, left_after, new_mark


@contextlib.contextmanager
def largest_file(size: int):
    """Files of this process, and of those that it starts, may grow no further, as on a disk that is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr("flankfilm.app.model.Live", Still)
    (tmp_path / "pair.toml").write_text(RUN, encoding="utf-8")
    return tmp_path


def test_a_scene_is_not_saved_on_a_full_disk_and_the_file_stays_as_it_was(folder):
    window = Window(SceneFiles(folder), "pair.toml", lambda kind, content: None)
    window.call("edit", "pair.module_mm", "3")
    with largest_file(20):
        answer = window.call("save", "pair.toml")
    assert "File too large" in answer["problem"]
    assert (folder / "pair.toml").read_text(encoding="utf-8") == RUN
    assert [path.name for path in folder.iterdir()] == ["pair.toml"]
    assert not answer["view"]["saved"]
    assert window.call("save", "pair.toml")["problem"] == ""
    window.close()


@pytest.mark.slow
def test_a_run_on_a_full_disk_ends_with_its_fault_and_the_next_one_is_whole(folder, monkeypatch):
    mark = new_mark()
    monkeypatch.setenv(MARK, mark)
    model = Model(SceneFiles(folder), lambda kind, content: None, "pair.toml")
    with largest_file(20_000):
        model.run()
    state = model._run.wait(120.0)
    assert state.status not in (0, None)
    assert "free some space" in " ".join(state.log), state.log
    assert not state.report
    assert left_after(mark) == {}
    model.run()
    state = model._run.wait(120.0)
    assert (state.status, state.report) == (0, True), state.log
    model.run()
    model.cancel()
    state = model._run.wait(120.0)
    assert state.cancelled
    assert not state.report  # that of the run before is not this one's
    model.close()


@pytest.mark.slow
def test_two_apps_on_one_folder_do_not_write_over_each_other(folder):
    first, second = (Model(SceneFiles(folder), lambda kind, content: None, "pair.toml") for _ in range(2))
    first.example("article")
    first.save("article.toml")
    second.open("article.toml")
    first.run()
    until = time.monotonic() + 60.0
    while first._run.state.done == 0 and time.monotonic() < until:
        time.sleep(0.02)
    second.run()
    state = second._run.wait(60.0)
    assert state.status == 2
    assert "another run or study is at work there" in " ".join(state.log)
    first.edit("pair.module_mm", "3")
    second.edit("pair.module_mm", "4")
    first.save("article.toml")
    with pytest.raises(InputError, match="somebody else"):
        second.save("article.toml")
    assert "module_mm = 3" in (folder / "article.toml").read_text(encoding="utf-8")
    for model in (first, second):
        model.close()


@pytest.mark.slow
@pytest.mark.long
def test_a_run_cancelled_at_every_stage_leaves_nothing_running_and_the_next_one_is_whole(folder, monkeypatch):
    mark = new_mark()
    monkeypatch.setenv(MARK, mark)
    monkeypatch.setenv("FLANKFILM_CACHE", str(folder / "cache"))
    operating = (
        "[operating]\npinion_torque_Nm = 200\n[material]\nyoungs_modulus_GPa = 206\npoisson_ratio = 0.3\n"
    )
    text = RUN.replace('"geometry"', '"geometry", "stiffness"') + operating
    (folder / "pair.toml").write_text(text, encoding="utf-8")
    stages: list[str] = []

    def told(kind: str, content) -> None:
        if kind == "run" and content["status"] is None and content["what"] not in (*stages, "starting"):
            stages.append(content["what"])
            model.cancel()

    model = Model(SceneFiles(folder), told, "pair.toml")
    while True:
        before = len(stages)
        model.run()
        state = model._run.wait(120.0)
        assert left_after(mark) == {}
        if len(stages) == before:  # all stages have been cancelled once
            break
        assert state.cancelled
        assert state.status != 0 or state.what == "done"
    assert (state.status, state.report) == (0, True), state.log
    assert len(stages) >= 6
    assert {"geometry", "writing the report", "netCDF and CSV files"} <= set(stages)
    model.close()
