"""The command line as a user meets it: messages, exit statuses, files, what is loaded."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

from flankfilm.cli import app
from flankfilm.output.files import write_csv
from flankfilm.scene import template
from tests.flankfilm.program import EXAMPLES, SCRIPT, command, flankfilm
from tests.flankfilm.scenes import ishikawa


def scene_file(folder: Path, *changes: tuple[str, str]) -> Path:
    text = template()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_new_writes_a_scene_that_check_accepts(tmp_path):
    command("new", "first.toml", cwd=tmp_path)
    output = flankfilm("check", "first.toml", cwd=tmp_path).stdout
    assert "Contact ratio 1.7030" in output


def test_new_keeps_what_is_there(tmp_path):
    (tmp_path / "mine.toml").write_text("precious")
    output = command("new", "mine.toml", cwd=tmp_path, status=2).stderr
    assert "kept" in output
    assert (tmp_path / "mine.toml").read_text() == "precious"


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        (
            "profile_shift = 0.0, bore_mm = 33.5",
            "profile_shift = 1.5, bore_mm = 33.5",
            "wheel.tip_radius",
        ),
        (
            "profile_shift = 0.0, bore_mm = 33.5",
            "tip_alteration = 0.9, bore_mm = 33.5",
            "pinion.tip_alteration",
        ),
        ("bore_mm = 33.5", "bore_mm = 70", "pair.pinion.bore_mm"),
        ("backlash_um = 50", "centre_distance_mm = 75.0", "pair.centre_distance_mm"),
        ("backlash_um = 50", "centre_distance_mm = 79.9", "contact_ratio"),
        ("teeth = 36, profile_shift = 0.0", "teeth = 8, profile_shift = -0.3", "pair.pinion"),
    ],
)
def test_impossible_gears_are_refused_under_their_keys(tmp_path, old, new, where):
    output = command("check", scene_file(tmp_path, (old, new)), cwd=tmp_path, status=2).stderr
    assert where in output


def test_all_faults_of_both_gears_come_at_once(tmp_path):
    path = scene_file(tmp_path, ("bore_mm = 33.5", "bore_mm = 70"), ("bore_mm = 37.5", "bore_mm = 78"))
    output = command("run", path, cwd=tmp_path, status=2).stderr
    assert "pair.pinion.bore_mm" in output
    assert "pair.wheel.bore_mm" in output


def test_missing_and_unreadable_places(tmp_path):
    assert "does not exist" in command("run", "none.toml", cwd=tmp_path, status=2).stderr
    assert "is a folder" in command("run", tmp_path, cwd=tmp_path, status=2).stderr
    (tmp_path / "taken").write_text("a file")
    output = command("run", EXAMPLES / "oscillator.toml", "--out", "taken", cwd=tmp_path, status=2).stderr
    assert "is a file, not a folder" in output
    output = command(
        "run", EXAMPLES / "oscillator.toml", "--out", "/proc/none", cwd=tmp_path, status=2
    ).stderr
    assert "cannot be written" in output


@pytest.mark.parametrize("tolerance", ["0", "-1%", "half", "50%", "nan", "0.5%%"])
def test_a_senseless_tolerance_is_refused(tmp_path, tolerance):
    output = command("run", scene_file(tmp_path), f"--tolerance={tolerance}", cwd=tmp_path, status=2).stderr
    assert "--tolerance" in output


def test_a_date_that_is_none_ends_in_no_traceback(tmp_path):
    scene = EXAMPLES / "oscillator.toml"
    output = flankfilm("check", scene, cwd=tmp_path, status=2, SOURCE_DATE_EPOCH="yesterday").stderr
    assert "SOURCE_DATE_EPOCH = yesterday: must be whole seconds" in output


def test_the_program_asks_for_one_thread_before_numpy_is_loaded():
    """OpenBLAS reads the number once; with two threads on a busy machine a misaligned scene took nine times as long."""
    code = (
        "import os, sys\n"
        "class Watch:\n"
        "    def find_spec(name, path=None, target=None):\n"
        "        if name == 'numpy': print('numpy sees', os.environ.get('OPENBLAS_NUM_THREADS'))\n"
        "sys.meta_path.insert(0, Watch)\n"
        "from flankfilm.__main__ import main\n"
        "sys.argv = ['flankfilm', '--version']\n"
        "main()\n"
    )
    given = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    for more, seen in ({}, "1"), ({"OPENBLAS_NUM_THREADS": "2"}, "2"):
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True, env={**given, **more}
        )
        assert done.stdout.startswith(f"numpy sees {seen}\n")


def test_a_full_disk_ends_with_a_message_and_no_half_written_file(tmp_path, monkeypatch):
    def full(handle):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    (tmp_path / "scene.toml").write_text(ishikawa("X", "geometry"), encoding="utf-8")
    done = command("run", "scene.toml", "--out", "out", "--no-cache", cwd=tmp_path, status=2)
    assert "No space left on device" in done.stderr
    assert "Traceback" not in done.stderr
    assert [path.name for path in (tmp_path / "out").rglob("*.*")] == [".lock"]


def test_a_reader_who_left_keeps_no_file_from_being_written(tmp_path):
    (tmp_path / "scene.toml").write_text(ishikawa("X", "geometry", "report"), encoding="utf-8")
    gone, end = os.pipe()
    os.close(gone)
    with os.fdopen(end, "w") as out:
        done = subprocess.run(
            [SCRIPT, "run", tmp_path / "scene.toml", "--out", tmp_path / "out"],
            stdout=out,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert "Traceback" not in done.stderr
    assert {"results.nc", "report.html"} <= {path.name for path in (tmp_path / "out").iterdir()}


LOADED = """
import sys
from flankfilm.__main__ import main
try:
    main()
finally:
    print("loaded:", *sorted({name.partition(".")[0] for name in sys.modules}))
"""


@pytest.fixture(scope="module")
def oscillator_run(tmp_path_factory):
    """Motion alone, as a shell of a notebook would start it; `said.txt` ends with what was loaded."""
    folder = tmp_path_factory.mktemp("oscillator")
    shutil.copy(EXAMPLES / "oscillator.toml", folder)
    places = {
        "FLANKFILM_CACHE": str(folder / "cache"),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    done = subprocess.run(
        [sys.executable, "-c", LOADED, "run", "oscillator.toml", "--out", "out"],
        capture_output=True,
        text=True,
        cwd=folder,
        check=False,
        env={**os.environ, **places},
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    (folder / "said.txt").write_text(done.stdout, encoding="utf-8")
    return folder


def test_dynamics_alone_loads_no_mesher_and_no_finite_elements(oscillator_run):
    said, _, loaded = (oscillator_run / "said.txt").read_text(encoding="utf-8").rpartition("loaded:")
    assert " files in out after " in said
    assert {"dynamics", "matplotlib", "xarray"} <= set(loaded.split())
    assert not {"gmsh", "skfem", "meshio", "pyvista", "vtkmodules", "distributed"} & set(loaded.split())


def test_results_carry_units_scene_and_the_known_grazing(oscillator_run):
    import xarray as xr

    with xr.open_dataset(oscillator_run / "out" / "results.nc", engine="h5netcdf") as found:
        assert found.sweep_up.shape == (400, 64, 2)
        assert found.sweep_up.attrs["units"] == "1"
        assert json.loads(found.attrs["scene_json"])["dynamics"]["damping_ratio"] == 0.05
        grazing = found.sweep_grazings.values
    assert abs(grazing[0] - 0.633533993217297) < 1e-12


def test_the_report_needs_nothing_else(oscillator_run):
    page = (oscillator_run / "out" / "report.html").read_text(encoding="utf-8")
    assert "<svg" in page
    for outside in ('src="http', 'href="http', "<script", "<link"):
        assert outside not in page
    ids = [part.split('"')[0] for part in page.split(' id="')[1:]]
    assert len(ids) == len(set(ids))


def test_csv_reads_back(oscillator_run):
    import pandas as pd

    table = pd.read_csv(oscillator_run / "out" / "csv" / "sweep_up.csv")
    assert list(table.columns) == ["frequency", "up_displacement", "up_velocity", "up_label"]
    assert len(table) == 400 * 64


def test_control_characters_are_spelt_out_and_formulas_are_text(tmp_path):
    text = ishikawa("X", "closed-forms").replace('"X"', '"=cmd()\\u001b[31m\\nred"')
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    said = command("check", "scene.toml", cwd=tmp_path).stdout
    assert "=cmd()\\x1b[31m\\nred is valid" in said
    refused = command("check", "x\x1b[31m.toml", cwd=tmp_path, status=2).stderr
    assert "\x1b" not in refused
    write_csv(tmp_path / "table.csv", {"model": ["=1+1", "plain"], "x": [-1.0, 2.0]})
    assert (tmp_path / "table.csv").read_text().split() == ["model,x", "'=1+1,-1.0", "plain,2.0"]


@pytest.mark.parametrize("name", ["", "  "])
def test_a_folder_without_a_name_is_refused(tmp_path, name):
    (tmp_path / "scene.toml").write_text(ishikawa("X", "geometry"), encoding="utf-8")
    said = command("run", "scene.toml", "--out", name, cwd=tmp_path, status=2).stderr
    assert "must name a folder" in said
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]


@pytest.mark.parametrize(
    "closed",
    ["<&- >&- 2>&-", *(pytest.param(one, marks=pytest.mark.slow) for one in ("2>&-", ">&-", "<&-"))],
)
def test_closed_streams_change_nothing(tmp_path, closed):
    (tmp_path / "scene.toml").write_text(ishikawa("X", "closed-forms"), encoding="utf-8")
    for line, status in ((f"'{SCRIPT}' run scene.toml --out out", 0), (f"'{SCRIPT}' run none.toml", 2)):
        done = subprocess.run(
            ["sh", "-c", f"{line} {closed}"], cwd=tmp_path, capture_output=True, check=False
        )
        assert done.returncode == status
        assert "fault" not in done.stdout.decode()
    with xr.open_dataset(tmp_path / "out" / "results.nc", engine="h5netcdf") as results:
        assert results.sizes


@pytest.mark.parametrize("name", [name for name in app if not name.startswith("-")])
def test_every_argument_of_every_command_says_what_it_is(name):
    for argument in app[name].assemble_argument_collection(parse_docstring=True):
        if argument.name != "*":  # the options that follow, each with its own
            assert len(argument.parameter.help or "") > 10, argument.name


def test_a_terminal_without_greek_or_micro_is_told_all_the_same(tmp_path):
    path = scene_file(tmp_path)
    said = flankfilm("check", path, PYTHONIOENCODING="ascii", PYTHONUTF8="0").stdout
    assert "normal backlash 50.0 \\xb5m" in said
