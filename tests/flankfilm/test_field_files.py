"""Fields for ParaView are written while a run goes on, and replace those of an earlier one when it has ended."""

from __future__ import annotations

import re
from types import SimpleNamespace

import pytest

from fem.fields.vtk import Frames
from flankfilm.files.folder import UNFINISHED, occupied, unfinished
from flankfilm.files.manifest import conclude
from flankfilm.processes.assistant import Assistant
from flankfilm.stages.vtk import FieldFiles

OVER_FACE = SimpleNamespace(face=True, lines=None)


def wrote(folder, rows):
    """Frames of some rows, as `fem.fields.vtk.write_frames` gives them."""
    steps = []
    for row in rows:
        files = {name: folder / "vtk" / f"{name}_{row:04d}.vtu" for name in ("pinion", "wheel")}
        for name, file in files.items():
            file.parent.mkdir(exist_ok=True)
            file.write_text(f"new {name} {row}")
        steps.append((0.1 * row, files))
    return Frames(tuple(steps), ())


@pytest.fixture
def earlier(tmp_path):
    """Folder with a file of an earlier run."""
    folder = tmp_path / "out"
    (folder / "vtk").mkdir(parents=True)
    (folder / "vtk" / "pinion_0001.vtu").write_text("old")
    return folder


def test_an_earlier_run_keeps_its_fields_until_the_new_ones_are_asked_for(earlier):
    helper = Assistant()
    with occupied(earlier), unfinished(earlier) as beside:
        parts = tuple(helper.submit(wrote, beside, rows) for rows in ((0, 1), (2,)))
        begun = FieldFiles(beside, None, OVER_FACE, range(3), parts)
        for part in parts:
            helper.result(part)
        assert (earlier / "vtk" / "pinion_0001.vtu").read_text() == "old"
        (series,) = begun.written(earlier, helper)
        named = re.findall(r'file="([^"]+)"', series.read_text())
        assert named == [f"vtk/{name}_{row:04d}.vtu" for row in range(3) for name in ("pinion", "wheel")]
        assert (earlier / "vtk" / "pinion_0001.vtu").read_text() == "new pinion 1"
        assert conclude(earlier, [series]) == ()
    assert not [path for path in earlier.iterdir() if path.name.startswith(UNFINISHED)]


def test_a_run_that_fails_leaves_the_fields_of_an_earlier_one_and_none_beside_them(earlier):
    def fail():
        with occupied(earlier), unfinished(earlier) as beside:
            wrote(beside, (1,))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert [path.name for path in earlier.rglob("*.vtu")] == ["pinion_0001.vtu"]
    assert (earlier / "vtk" / "pinion_0001.vtu").read_text() == "old"


def test_what_a_killed_run_left_is_removed_by_the_next_one_and_links_are_not_followed(earlier, tmp_path):
    left = earlier / f"{UNFINISHED}killed"
    (left / "vtk").mkdir(parents=True)
    (left / "vtk" / "pinion_0001.vtu").write_text("half a fi")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "precious").write_text("kept")
    (earlier / f"{UNFINISHED}link").symlink_to(tmp_path / "elsewhere")
    assert conclude(earlier, []) == ("vtk/pinion_0001.vtu",)
    with unfinished(earlier) as beside:
        assert not left.exists()
        assert beside is not None
        assert not list(beside.iterdir())
    assert (tmp_path / "elsewhere" / "precious").read_text() == "kept"


def test_a_file_that_cannot_be_replaced_is_named(earlier):
    (earlier / "vtk" / "wheel_0001.vtu" / "folder").mkdir(parents=True)
    with unfinished(earlier) as beside, pytest.raises(OSError, match=r"vtk/wheel_0001\.vtu") as refused:
        wrote(beside, (1,)).moved(beside, earlier)
    assert UNFINISHED not in str(refused.value)
