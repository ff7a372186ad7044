"""What must not go wrong: results that do not reproduce, runs at once, unwritable places, scenes of strangers."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from base import InputError
from flankfilm.files.folder import claim, locked
from flankfilm.files.manifest import conclude
from flankfilm.output.reproduce import scene_in
from flankfilm.runs.report import summary
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene, read_scene
from flankfilm.studies.kept import Work, kept_rows
from flankfilm.studies.table import Columns
from tests.flankfilm.scenes import ishikawa

ROOT = Path(__file__).parents[2]
PACKAGES = ("flankfilm", "base", "gears", "meshes", "fem", "ehl", "dynamics")

SMALL = ishikawa("X", "closed-forms", "stiffness", "fourier")
SMALL = SMALL.replace('"X"', "'../../x<script>alert(1)</script>\"; import os'")
NEXT = ishikawa("Y", "geometry")
"""What is run after it in its folder."""

MOTION = """
wants = ["sweep"]
[stiffness]
model = "given"
amplitudes = [0.18]
[dynamics]
mean_force = 0.1
error_amplitude = 0.2
half_backlash = 0.2
sweep = { frequency = [0.5, 0.7], points = 8 }
"""


def flankfilm(*arguments, cwd, wait=True, packages=ROOT, **environment):
    begun = subprocess.Popen(
        [sys.executable, "-m", "flankfilm", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(packages), "PYTHONDONTWRITEBYTECODE": "1", **environment},
    )
    return ended(begun) if wait else begun


def ended(begun, status=0):
    out, err = begun.communicate(timeout=250)
    assert begun.returncode == status, err
    assert "Traceback" not in err
    return out + err


def listing(folder):
    return {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in folder.rglob("*")}


@pytest.fixture(scope="module")
def small_run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("small")
    run_scene(parse_scene(SMALL), folder / "out", use_cache=False)
    return folder / "out"


def same(first, second):
    with xr.open_dataset(first, engine="h5netcdf") as a, xr.open_dataset(second, engine="h5netcdf") as b:
        assert set(a.variables) == set(b.variables)
        for name in a.variables:
            np.testing.assert_array_equal(a[name].values, b[name].values, name)


class TestResultsReproduceThemselves:
    def test_the_scene_in_a_results_file_gives_the_same_results(self, small_run, tmp_path):
        scene, differences = scene_in(small_run / "results.nc")
        assert scene == parse_scene(SMALL)
        assert differences == ()
        run_scene(scene, tmp_path, use_cache=False)
        same(small_run / "results.nc", tmp_path / "results.nc")

    def test_the_command_takes_a_results_file_and_says_what_differs(self, small_run, tmp_path):
        import h5py

        shutil.copy(small_run / "results.nc", tmp_path / "old.nc")
        with h5py.File(tmp_path / "old.nc", "r+") as file:
            file.attrs["code_sha256"] = "0" * 64
            file.attrs["versions_json"] = '{"python": "3.0", "numpy": "1.0"}'
        output = flankfilm("check", "old.nc", cwd=tmp_path)
        assert "numpy 1.0, here" in output
        assert "other source code" in output
        assert "is valid" in output

    @pytest.mark.parametrize("text", ["", "{", "[1]", "[" * 100_000, '{"wants": 3}', '{"wants": ["sweep"]}'])
    def test_a_damaged_scene_in_it_is_refused(self, small_run, tmp_path, text):
        import h5py

        path = tmp_path / "damaged.nc"
        shutil.copy(small_run / "results.nc", path)
        with h5py.File(path, "r+") as file:
            file.attrs["scene_json"] = text
        with pytest.raises(InputError):
            scene_in(path)

    def test_flipped_and_cut_files_are_read_or_refused(self, small_run, tmp_path):
        whole, path = (small_run / "results.nc").read_bytes(), tmp_path / "damaged.nc"
        rng = np.random.default_rng()
        for trial in range(120):
            at = int(rng.integers(len(whole)))
            content = bytearray(whole)
            content[at] ^= 1 << int(rng.integers(8))
            path.write_bytes(content[:at] if trial % 3 == 0 else content)
            with contextlib.suppress(InputError):
                scene_in(path)

    @pytest.mark.parametrize("text", ["[1]", "3", "null", "[" * 100_000, '{"python": [1]}'])
    def test_odd_versions_are_told_as_different(self, small_run, tmp_path, text):
        import h5py

        path = tmp_path / "odd.nc"
        shutil.copy(small_run / "results.nc", path)
        with h5py.File(path, "r+") as file:
            file.attrs["versions_json"] = text
        assert scene_in(path)[0] == parse_scene(SMALL)

    def test_other_files_are_refused(self, small_run, tmp_path):
        whole = (small_run / "results.nc").read_bytes()
        for name, content in (
            ("cut.nc", whole[: len(whole) // 2]),
            ("text.nc", b"not netCDF"),
            ("none.nc", b""),
        ):
            (tmp_path / name).write_bytes(content)
            with pytest.raises(InputError, match="cannot be read"):
                scene_in(tmp_path / name)
        with pytest.raises(InputError, match="does not exist"):
            scene_in(tmp_path / "missing.nc")


@pytest.mark.slow
def test_two_runs_at_once_with_one_cache_end_well(tmp_path, small_run):
    (tmp_path / "scene.toml").write_text(SMALL, encoding="utf-8")
    shared = {"cwd": tmp_path, "wait": False, "FLANKFILM_CACHE": str(tmp_path / "cache")}
    outs = ("out", "other")
    begun = [flankfilm("run", "scene.toml", "--out", out, **shared) for out in outs]
    for process in begun:
        ended(process)
    for out in outs:
        same(tmp_path / out / "results.nc", small_run / "results.nc")
        assert [p.name for p in (tmp_path / out).rglob(".*")] == [".lock"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
class TestAFolderThatSomebodyPrepared:
    """Links, pipes and folders stand where a run or study puts files: said at once, and nothing else is touched."""

    @pytest.fixture
    def begun(self, tmp_path):
        (tmp_path / "victim").write_text("precious")
        (tmp_path / "out").mkdir()
        yield tmp_path / "out"
        assert (tmp_path / "victim").read_text() == "precious"
        assert not (tmp_path / "new").exists()

    def put(self, path: Path, how: str) -> None:
        match how:
            case "pipe":
                os.mkfifo(path)
            case "folder":
                path.mkdir()
            case "file":
                path.write_text("mine")
            case target:
                path.symlink_to(path.parent.parent / target)

    @pytest.mark.timeout(30)
    @pytest.mark.parametrize(
        ("name", "how"),
        [(".lock", "pipe"), (".lock", "victim"), (".lock", "new"), (".lock", "folder"), ("csv", "file"),
         ("csv", "new"), ("results.nc", "folder"), ("report.html", "folder"), ("files.json", "folder")],
    )  # fmt: skip
    def test_a_run_refuses_it_before_it_computes(self, begun, name, how, monkeypatch):
        monkeypatch.setattr("flankfilm.runs.run_scene._computed", lambda *_: pytest.fail("computed"))
        self.put(begun / name, how)
        with pytest.raises(InputError, match=re.escape(name)) as refused:
            run_scene(parse_scene(SMALL), begun)
        assert "Move it away" in str(refused.value)

    @pytest.mark.timeout(30)
    @pytest.mark.parametrize(
        ("name", "how"), [("rows.csv", "new"), ("rows.csv", "pipe"), ("study.json", "pipe")]
    )
    def test_a_study_refuses_it(self, begun, name, how):
        self.put(begun / name, how)
        work = Work("study", "", {}, Columns(("a",), ("contact_ratio",)))
        with pytest.raises(InputError, match=re.escape(name)), kept_rows(begun, work, True):
            pass

    @pytest.mark.timeout(30)
    def test_a_list_of_files_that_is_a_pipe_is_none(self, begun):
        os.mkfifo(begun / "files.json")
        (begun / "results.nc").write_text("of this run")
        assert conclude(begun, [begun / "results.nc"]) == ()
        assert json.loads((begun / "files.json").read_text())["sha256"].keys() == {"results.nc"}

    @pytest.mark.timeout(30)
    def test_a_pipe_is_no_scene(self, begun):
        os.mkfifo(begun / "scene.toml")
        with pytest.raises(InputError, match="a pipe or a device, not a file"):
            read_scene(begun / "scene.toml")


@pytest.mark.parametrize("data", ["results.nc", "study.nc", "optimum.nc", "verify.nc"])
def test_a_report_is_not_replaced_by_that_of_something_else(tmp_path, data):
    """A folder holds a run, a study, an optimisation or a verification; each may be done again there."""
    for name in (data, "report.html"):
        (tmp_path / name).write_text("of an earlier one")
    for other in ("results.nc", "study.nc", "optimum.nc", "verify.nc"):
        if other == data:
            claim(tmp_path, other)
        else:
            with pytest.raises(
                InputError, match=f"holds an? .* \\({data}\\), whose report.html would be replaced"
            ):
                claim(tmp_path, other)
    (tmp_path / "report.html").unlink()
    claim(tmp_path, "study.nc")


def test_two_runs_do_not_share_a_folder(tmp_path):
    (tmp_path / "scene.toml").write_text(SMALL, encoding="utf-8")
    (tmp_path / "out").mkdir()
    with locked(tmp_path / "out"):
        begun = flankfilm("run", "scene.toml", "--out", "out", cwd=tmp_path, wait=False)
        assert "another run or study is at work there" in ended(begun, status=2)


HOLDS = """
import sys, time
from pathlib import Path
from flankfilm.files.folder import locked

with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def test_the_lock_of_a_killed_process_goes_with_it(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", HOLDS, str(tmp_path)], stdout=subprocess.PIPE, text=True
    ) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(InputError, match="at work there"), locked(tmp_path):
            pass
        holder.kill()
    with locked(tmp_path):
        pass


class TestManifest:
    """Files of an earlier run go, those of somebody stay."""

    @pytest.fixture
    def folder(self, small_run, tmp_path):
        return Path(shutil.copytree(small_run, tmp_path / "out"))

    def test_what_the_next_run_does_not_write_goes(self, folder):
        before = {str(path.relative_to(folder)) for path in folder.rglob("*.csv")}
        found = run_scene(parse_scene(NEXT), folder)
        after = {str(path.relative_to(folder)) for path in folder.rglob("*.csv")}
        assert after == {str(path.relative_to(folder)) for path in found.files if path.suffix == ".csv"}
        assert before - after
        assert found.others == ()
        assert json.loads((folder / "files.json").read_text())["sha256"].keys() == {
            path.relative_to(folder).as_posix() for path in found.files
        }

    def test_what_somebody_wrote_or_changed_stays_and_is_named(self, folder):
        changed = folder / "csv" / "mesh_cycle_dry.csv"  # which the next run does not write
        changed.write_text(changed.read_text() + "# mine\n")
        (folder / "notes.txt").write_text("mine")
        found = run_scene(parse_scene(NEXT), folder)
        assert set(found.others) == {"notes.txt", f"csv/{changed.name}"}
        assert "notes.txt" in summary(found)[-1]
        assert (folder / "notes.txt").read_text() == "mine"

    @pytest.mark.parametrize("name", ["../mine", "/mine", "link/mine", "files.json", "a\0b"])
    def test_a_changed_list_removes_nothing_outside(self, folder, name):
        mine, other = folder.parent / "mine", folder.parent / "elsewhere"
        mine.write_text("mine")
        other.mkdir()
        (other / "mine").write_text("mine")
        (folder / "link").symlink_to(other)
        digest = hashlib.sha256(b"mine").hexdigest()
        (folder / "files.json").write_text(json.dumps({"sha256": {name: digest}}))
        run_scene(parse_scene(NEXT), folder)
        assert mine.read_text() == (other / "mine").read_text() == "mine"

    @pytest.mark.parametrize("text", ["", "[]", "{", '{"sha256": 3}', "[" * 100_000, '{"sha256": {"x": 1}}'])
    def test_a_damaged_list_is_none(self, folder, text):
        (folder / "files.json").write_text(text)
        assert run_scene(parse_scene(NEXT), folder).files


@pytest.mark.parametrize(
    "text", [SMALL, pytest.param(MOTION, marks=pytest.mark.slow)], ids=["closed form", "compiled"]
)
def test_an_install_that_cannot_be_written_works(tmp_path, monkeypatch, text):
    monkeypatch.delenv("NUMBA_CACHE_DIR")  # the program itself has to find a place
    # root may write everywhere, so that besides the permissions what was written is looked at
    place = tmp_path / "packages"
    for package in PACKAGES:
        shutil.copytree(ROOT / package, place / package)
    before = listing(place)
    for path in (place, *place.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    flankfilm(
        *("run", "scene.toml", "--out", "out"), cwd=tmp_path, packages=place, FLANKFILM_CACHE="/proc/none"
    )
    assert listing(place) == before
    assert (tmp_path / "out" / "results.nc").exists()


def test_compiled_code_finds_a_place_where_no_cache_can_be_kept(monkeypatch):
    from flankfilm.files.cache import keep_compiled_code

    monkeypatch.setenv("FLANKFILM_CACHE", "/proc/none")
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    keep_compiled_code()
    place = Path(os.environ["NUMBA_CACHE_DIR"])
    assert place.stat().st_mode & 0o077 == 0  # private: compiled code is trusted
    place.rmdir()


def test_a_strangers_scene_writes_only_into_its_folder_and_runs_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("FLANKFILM_CACHE", str(tmp_path / "cache"))
    deep = tmp_path / "a" / "b" / "out"
    run_scene(parse_scene(SMALL.replace('"fourier"]', '"fourier", "report"]')), deep)
    outside = [p for p in tmp_path.rglob("*") if p.is_file() and not p.is_relative_to(deep)]
    assert all(p.is_relative_to(tmp_path / "cache") for p in outside)
    page = (deep / "report.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert "&lt;script&gt;" in page
