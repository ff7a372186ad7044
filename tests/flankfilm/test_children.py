"""Processes that commands start: they import nothing that lies about, and none remains."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from flankfilm.children import Ended, answering_signals, environment, python
from tests.flankfilm.program import SCRIPT

STUDY = """
outputs = ["contact_ratio"]
[vary]
"pair.pinion.profile_shift" = { from = -0.2, to = 0.4, steps = 3000 }
[scene]
wants = ["geometry"]
[scene.pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36 }
wheel = { teeth = 40 }
"""

PATIENCE = 10.0
"""Seconds within which no process may remain."""


def of_session(leader: int) -> list[int]:
    """Processes of a session, zombies left out."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except (OSError, ValueError):
            continue
        if entry.name.isdigit() and int(fields[3]) == leader and fields[0] != "Z":
            found.append(int(entry.name))
    return found


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are read from /proc")
@pytest.mark.parametrize(
    ("name", "status"),
    [("SIGTERM", 143), ("SIGHUP", 129), ("SIGINT", 130), ("SIGQUIT", -3), ("SIGKILL", -9)],
)
def test_no_worker_outlives_a_study_that_is_ended(tmp_path, name, status):
    path, rows = tmp_path / "study.toml", tmp_path / "out" / "rows.csv"
    path.write_text(STUDY)
    study = subprocess.Popen(
        [str(SCRIPT), "study", str(path), "--out", str(tmp_path / "out"), "--workers", "2"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    until = time.monotonic() + 60
    while not (rows.exists() and rows.read_bytes().count(b"\n") > 5) and time.monotonic() < until:
        time.sleep(0.01)
    assert len(of_session(study.pid)) >= 3  # two workers
    study.send_signal(getattr(signal, name))
    said = study.communicate(timeout=PATIENCE)[1].decode()
    assert study.returncode == status
    assert "Traceback" not in said
    if status > 0:
        assert "next run resumes" in said
    until = time.monotonic() + PATIENCE
    while (left := of_session(study.pid)) and time.monotonic() < until:
        time.sleep(0.05)
    assert not left
    kept = rows.read_text(encoding="utf-8").splitlines()
    assert kept[0].startswith("row,")
    assert len({line.split(",")[0] for line in kept[1:]}) == len(kept) - 1 > 4


def test_workers_import_nothing_from_the_current_folder(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY.replace("3000", "2"))
    for module in ("numpy", "pickle", "multiprocessing", "flankfilm", "json"):
        (tmp_path / f"{module}.py").write_text("open('executed', 'w').close()\n")
    subprocess.run(
        [str(SCRIPT), "study", "study.toml", "--out", "out", "--workers", "1"],
        cwd=tmp_path,
        check=True,
        capture_output=True,
    )
    assert not (tmp_path / "executed").exists()


def test_commands_import_nothing_from_the_current_folder(tmp_path):
    (tmp_path / "json.py").write_text("open('executed', 'w').close()\n")
    subprocess.run(python("-c", "import json"), cwd=tmp_path, check=True)
    assert not (tmp_path / "executed").exists()
    with environment():
        subprocess.run([sys.executable, "-c", "import json"], cwd=tmp_path, check=True)
    assert not (tmp_path / "executed").exists()
    assert "PYTHONSAFEPATH" not in os.environ


def test_a_signal_becomes_an_exception_and_then_what_it_was():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(Ended, match="SIGTERM") as ended, answering_signals():
        signal.raise_signal(signal.SIGTERM)
    assert ended.value.signal == signal.SIGTERM
    assert signal.getsignal(signal.SIGTERM) is before


def test_an_end_that_a_destructor_swallowed_is_asked_for_again(monkeypatch):
    """What is raised in a destructor is ignored there, with a note, and nothing would end."""

    class Swallows:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("flankfilm.children.AGAIN", 0.2)
    monkeypatch.setattr("sys.unraisablehook", lambda note: None)

    def work() -> None:
        with answering_signals():
            Swallows()
            time.sleep(5.0)

    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        work()
    assert time.monotonic() - began < 3.0


def test_a_child_ends_with_its_parent(tmp_path):
    """A command that watches its parent, whose parent is killed."""
    child = "from flankfilm.children import end_with_parent; import time; end_with_parent(); time.sleep(60)"
    parent = (
        "import subprocess, sys, time; from flankfilm.children import python; "
        f"print(subprocess.Popen(python('-c', {child!r})).pid, flush=True); time.sleep(60)"
    )
    started = subprocess.Popen(python("-c", parent), stdout=subprocess.PIPE, text=True)
    assert started.stdout is not None
    number = int(started.stdout.readline())
    time.sleep(1.0)  # the child begins to watch
    started.kill()
    started.wait()
    until = time.monotonic() + PATIENCE
    while _alive(number) and time.monotonic() < until:
        time.sleep(0.05)
    assert not _alive(number)


def _alive(number: int) -> bool:
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    stat = Path(f"/proc/{number}/stat")
    return not (stat.exists() and stat.read_text().rpartition(")")[2].split()[0] == "Z")
