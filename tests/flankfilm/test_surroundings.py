"""What surrounds a run: links in its folder, forged rows, no memory, no room for compiled code, files of megabytes."""

from __future__ import annotations

import os
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

from base import InputError
from flankfilm.files.folder import claim
from flankfilm.processes.exit_status import LONGEST, MOST_FAULTS, SOLVER_FAULT, USER_FAULT, guarded
from flankfilm.scene import parse_scene, template
from flankfilm.studies.execution import Execution
from flankfilm.studies.plan import read_plan
from flankfilm.studies.run import run_study

STUDY = """
scene = "scene.toml"
outputs = ["contact_ratio"]
[vary]
"pair.pinion.profile_shift" = {}
"""


def study(folder: Path, values: str = "[0.0, 0.1, 0.2]") -> Path:
    (folder / "scene.toml").write_text(template(), encoding="utf-8")
    (folder / "study.toml").write_text(STUDY.format(values), encoding="utf-8")
    return folder / "study.toml"


def faults(text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    return [str(fault) for fault in caught.value.faults]


@pytest.mark.parametrize("name", ["csv", "vtk"])
def test_a_folder_that_is_a_link_is_refused(tmp_path, name):
    """Files were replaced where it led."""
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / name).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="is a link"):
        claim(tmp_path / "out", "results.nc", folders=("csv", "vtk"))


def test_no_memory_is_said_in_a_line(capsys):
    def command() -> int:
        raise MemoryError("Unable to allocate 900. GiB")

    assert guarded(command) == SOLVER_FAULT
    said = capsys.readouterr().err
    assert said.startswith("flankfilm: out of memory (Unable to allocate 900. GiB); give a larger tolerance")
    assert "Traceback" not in said


def test_messages_of_megabytes_are_cut(capsys):
    def command() -> int:
        raise InputError([*InputError.at("a" * 10**4, "", "is wrong").faults] * 1000)

    assert guarded(command) == USER_FAULT
    said = capsys.readouterr().err
    assert len(said) < (LONGEST + 100) * (MOST_FAULTS + 2)
    assert said.endswith("and 900 more\n")


def forged(rows: Path, cells: list[str], last: bool = True) -> None:
    """Put a row with its right checksum into the table: in place of the last one, or behind it."""
    line = ",".join(cells)
    checksum = zlib.crc32((line + "\n").encode())
    text = f"{line},{checksum:08x}"
    lines = rows.read_text(encoding="utf-8").splitlines()
    rows.write_text("\n".join([*(lines[:-1] if last else lines), text]) + "\n", encoding="utf-8")


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        (["two", "0.2", "1.6", "0.1", ""], "a text where a number belongs"),
        (["2", "0.2", "x", "0.1", ""], "a text where a number belongs"),
        (["2", "0.2", "1.6", "soon", ""], "a text where a number belongs"),
        (["2.0", "0.2", "1.6", "0.1", ""], "a text where a number belongs"),
        (["1", "0.1", "1.6", "0.1", ""], "a row that no run wrote"),
        (["-1", "0.2", "1.6", "0.1", ""], "a row that no run wrote"),
        (["2", "0.2", "1.6", "inf", ""], "a row that no run wrote"),
        (["99", "0.2", "1.6", "0.1", ""], "must be one of 0 to 2"),
        (["2", "0.3", "1.6", "0.1", ""], "other values of the keys"),
    ],
)
@pytest.mark.usefixtures("rows_here")
def test_a_forged_row_with_its_checksum_is_refused(tmp_path, cells, said):
    plan = read_plan(study(tmp_path))
    run_study(plan, tmp_path / "out", Execution(workers=1))
    forged(tmp_path / "out" / "rows.csv", cells)
    with pytest.raises(InputError, match=said):
        run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))


@pytest.mark.usefixtures("rows_here")
def test_a_genuine_row_is_taken(tmp_path):
    plan = read_plan(study(tmp_path))
    found = run_study(plan, tmp_path / "out", Execution(workers=1))
    forged(tmp_path / "out" / "rows.csv", ["2", "0.2", repr(found.rows[2].values[0]), "0.1", ""])
    assert run_study(plan, tmp_path / "out", Execution(workers=1, resume=True)).computed == 0


@pytest.mark.parametrize("values", ["[0.0, nan]", "{ from = nan, to = 0.2, steps = 3 }"])
def test_one_nan_in_a_study_has_one_message(tmp_path, values):
    """It had one for each kind of value that a list may have."""
    with pytest.raises(InputError) as caught:
        read_plan(study(tmp_path, values))
    (fault,) = caught.value.faults
    assert fault.allowed == "must be a finite number"
    assert "float" not in fault.where


def test_the_form_that_a_message_shows_is_accepted():
    """A table in place of a list of tables was answered by a list of numbers."""
    shaft = "\n[shafts.pinion]\nsegments = {}\nbearings = {}\ngear_position_mm = 100\n"
    found = faults(template() + shaft.format("{ length_mm = 200 }", "{ position_mm = 20 }"))
    segments, bearings = (line.partition("such as ")[2] for line in found)
    accepted = parse_scene(template() + shaft.format(segments, bearings)).shafts
    assert accepted is not None
    assert accepted.pinion is not None
    assert len(accepted.pinion.bearings) == 2


KERNEL = "from numba import njit\n@njit(cache=True)\ndef more(x):\n    return x + 1.0\n"

FULL = """
import resource, signal
from base import hide_compilation
hide_compilation()
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
from kernel_of_test import more
assert more(1.0) == 2.0
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no limits of files there")
def test_without_room_for_compiled_code_a_run_goes_on_and_says_so(tmp_path):
    """It ended the run."""
    (tmp_path / "kernel_of_test.py").write_text(KERNEL, encoding="utf-8")
    (tmp_path / "go.py").write_text(FULL, encoding="utf-8")
    place = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    done = subprocess.run(
        [sys.executable, str(tmp_path / "go.py")],
        env={**os.environ, **place, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "compiled code is not kept" in done.stderr
