"""Processes that commands start: they import nothing that lies about, and none remains."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from flankfilm.processes.worker_processes import (
    Ended,
    answering_signals,
    ends_later,
    environment,
    module,
    python,
)
from tests.flankfilm.program import SCRIPT
from tests.processes import MARK, PATIENCE, left_after, marked, new_mark

ROOT = Path(__file__).parents[2]

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


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are read from /proc")
@pytest.mark.parametrize(
    ("name", "status"),
    [
        ("SIGTERM", 143),
        ("SIGKILL", -9),
        *(
            pytest.param(*one, marks=pytest.mark.slow)
            for one in (("SIGHUP", 129), ("SIGINT", 130), ("SIGQUIT", -3))
        ),
    ],
)
def test_no_worker_outlives_a_study_that_is_ended(tmp_path, name, status):
    path, rows = tmp_path / "study.toml", tmp_path / "out" / "rows.csv"
    path.write_text(STUDY)
    study = subprocess.Popen(
        [str(SCRIPT), "study", str(path), "--out", str(tmp_path / "out"), "--workers", "2"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env={**os.environ, MARK: (mark := new_mark())},
    )
    until = time.monotonic() + 60
    while not (rows.exists() and rows.read_bytes().count(b"\n") > 5) and time.monotonic() < until:
        time.sleep(0.01)
    assert len(marked(mark)) >= 3  # two workers
    study.send_signal(getattr(signal, name))
    said = study.communicate(timeout=PATIENCE)[1].decode()
    assert study.returncode == status
    assert "Traceback" not in said
    if status > 0:
        assert "next run resumes" in said
    assert not left_after(mark)
    kept = rows.read_text(encoding="utf-8").splitlines()
    assert kept[0].startswith("row,")
    assert len({line.split(",")[0] for line in kept[1:]}) == len(kept) - 1 > 4


POOL = """
import multiprocessing, os, sys, time
from flankfilm.studies.executors import executor
if __name__ == "__main__":
    with executor("processes", 1) as pool:
        print(pool.executor.submit(os.getpid).result(), flush=True)
        time.sleep(60)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the system kills children with their parent on Linux")
def test_a_stopped_worker_does_not_outlive_a_parent_that_is_killed(tmp_path):
    """Stopped processes answer no signal but the one that kills."""
    (tmp_path / "pool.py").write_text(POOL)
    paths = {"PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, str(tmp_path / "pool.py")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, env={**os.environ, **paths}) as parent:
        assert parent.stdout is not None
        worker = int(parent.stdout.readline())
        os.kill(worker, signal.SIGSTOP)
        parent.kill()
    until = time.monotonic() + 10.0
    while Path(f"/proc/{worker}").exists() and time.monotonic() < until:
        time.sleep(0.05)
    left = Path(f"/proc/{worker}").exists()
    if left:
        os.kill(worker, signal.SIGKILL)
    assert not left


def test_workers_import_nothing_from_the_current_folder(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY.replace("3000", "2"))
    for name in ("numpy", "pickle", "multiprocessing", "flankfilm", "json"):
        (tmp_path / f"{name}.py").write_text("open('executed', 'w').close()\n")
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


def test_settings_of_libraries_in_the_current_folder_are_not_obeyed(tmp_path):
    """matplotlib would start LaTeX on what another one wrote, and numba compile otherwise."""
    (tmp_path / "matplotlibrc").write_bytes(b"text.usetex: True\nfont.size: 80\n\xff\xfe no text\n")
    draw = (
        "from flankfilm import figures\nfrom flankfilm.figures.style import sheet\nimport matplotlib\n"
        "assert not matplotlib.rcParams['text.usetex']\nwith sheet() as (drawn, panels): pass\n"
    )
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    said = subprocess.run(
        python("-c", draw),
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert (said.returncode, said.stderr) == (0, "")
    early = (
        "import sys\nfrom flankfilm.processes.current_folder import disregard_settings\n"
        "disregard_settings()\nassert 'matplotlib' in sys.modules\n"
    )
    subprocess.run(python("-c", early), cwd=tmp_path, env={**os.environ, "PYTHONPATH": path}, check=True)
    (tmp_path / ".numba_config.yaml").write_text("disable_jit: 1\n")
    refused = subprocess.run([str(SCRIPT), "new", "scene.toml"], cwd=tmp_path, capture_output=True, text=True)
    assert refused.returncode == 2
    assert ".numba_config.yaml: must not lie in the current folder" in refused.stderr
    assert not (tmp_path / "scene.toml").exists()


def test_loading_pictures_leaves_the_current_folder_alone(tmp_path):
    """It is that of all threads: one that writes files meanwhile would write them elsewhere."""
    load = (
        "import sys\nsys.addaudithook(lambda event, _: print(event) if event == 'os.chdir' else None)\n"
        "import flankfilm.figures.motion, flankfilm.runs.report\n"
    )
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    said = subprocess.run(
        python("-c", load),
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert (said.returncode, said.stdout, said.stderr) == (0, "", "")


def test_a_signal_becomes_an_exception_and_then_what_it_was():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(Ended, match="SIGTERM") as ended, answering_signals():
        signal.raise_signal(signal.SIGTERM)
    assert ended.value.signal == signal.SIGTERM
    assert signal.getsignal(signal.SIGTERM) is before


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_an_end_that_a_destructor_swallowed_is_asked_for_again(monkeypatch, name):
    """What is raised in a destructor is ignored there, with a note: nothing would end, and it is no fault of ours."""
    notes = []

    class Swallows:
        def __init__(self, fault):
            self.fault = fault

        def __del__(self):
            if self.fault:
                raise self.fault
            signal.raise_signal(getattr(signal, name))

    def work() -> None:
        with answering_signals():
            Swallows(ValueError("ours"))
            Swallows(None)
            time.sleep(5.0)

    monkeypatch.setattr("sys.unraisablehook", lambda note: notes.append(str(note.exc_value)))
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt if name == "SIGINT" else Ended):
        work()
    assert time.monotonic() - began < 1.0
    assert notes == ["ours"]


def test_an_end_that_something_else_swallowed_is_asked_for_again(monkeypatch):
    monkeypatch.setattr("flankfilm.processes.worker_processes.AGAIN", 0.2)

    def work() -> None:
        with answering_signals():
            with suppress(BaseException):
                signal.raise_signal(signal.SIGTERM)
            time.sleep(5.0)

    with pytest.raises(Ended):
        work()


def test_an_end_waits_for_what_must_not_be_left_half_way():
    done = []

    def start() -> None:
        with ends_later():
            signal.raise_signal(signal.SIGTERM)
            done.append("started")
        done.append("gone on")

    with pytest.raises(Ended, match="SIGTERM"), answering_signals():
        start()
    assert done == ["started"]


def test_an_end_that_is_asked_for_again_waits_too(monkeypatch):
    monkeypatch.setattr("flankfilm.processes.worker_processes.AGAIN", 0.1)
    done = []

    def start() -> None:
        with suppress(BaseException):
            signal.raise_signal(signal.SIGTERM)
        with ends_later():
            time.sleep(0.3)
            done.append("started")
        done.append("gone on")

    with pytest.raises(Ended, match="SIGTERM"), answering_signals():
        start()
    assert done == ["started"]


HOLDS = """
import ctypes, multiprocessing, os, sys, time
from flankfilm.studies.executors import executor

def hold() -> None:  # a call that keeps the interpreter, as compiled code does
    print(os.getpid(), flush=True)
    ctypes.PyDLL(None).sleep(60)

if __name__ == "__main__":
    with executor("processes", 2) as pool:
        for _ in range(2):
            pool.executor.submit(hold)
        time.sleep(60)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends a process that does not listen")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_workers_end_that_are_busy_in_compiled_code(tmp_path, how):
    """Those of a parent that was killed, and of one that wants them to end."""
    (tmp_path / "holds.py").write_text(HOLDS)
    mark = new_mark()
    parent = subprocess.Popen(
        [sys.executable, str(tmp_path / "holds.py")],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, MARK: mark},
    )
    assert parent.stdout is not None
    for _ in range(2):
        parent.stdout.readline()
    parent.send_signal(how)
    parent.wait(PATIENCE)
    parent.stdout.close()
    assert not left_after(mark)


READS = ("timeit", "-n", "1", "-s", "import time; print(1, flush=True)", "time.sleep(60)")
"""A module of the standard library that is at work until it is ended."""


def test_a_module_that_is_run_ends_with_its_parent():
    mark = new_mark()
    parent = (
        "import subprocess, time; from flankfilm.processes.worker_processes import module, python; "
        f"child = subprocess.Popen(python(*module(*{READS}))); time.sleep(60)"
    )
    started = subprocess.Popen(
        python("-c", parent), stdout=subprocess.PIPE, text=True, env={**os.environ, MARK: mark}
    )
    assert started.stdout is not None
    assert started.stdout.readline() == "1\n"
    assert len(marked(mark)) == 2
    started.kill()
    started.wait(PATIENCE)
    started.stdout.close()
    assert not left_after(mark)


def test_a_module_whose_parent_died_before_it_began_ends_at_once():
    parent, *rest = module(*READS)[2:]
    assert parent == str(os.getpid())
    begun = subprocess.run(
        python("-m", "flankfilm.processes.worker_processes", "1", *rest), timeout=PATIENCE, check=False
    )
    assert begun.returncode == 1


def test_a_worker_of_dask_says_nothing_of_a_scheduler_that_has_gone():
    """What ends a study closes its connections; anything else that a worker finds is said as before."""
    said = subprocess.run(
        python(
            "-c",
            "import logging, flankfilm.processes.worker_processes\n"
            "flankfilm.processes.worker_processes.dask_setup(None)\n"
            "for error in (ConnectionResetError('gone'), MemoryError('full')):\n"
            "    try:\n"
            "        raise error\n"
            "    except Exception:\n"
            "        logging.getLogger('distributed.worker').exception('heartbeat')\n",
        ),
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])},
        capture_output=True,
        text=True,
        check=True,
    ).stderr
    assert "MemoryError: full" in said
    assert "gone" not in said


def test_a_session_that_leaves_processes_behind_fails_and_names_them(tmp_path):
    (tmp_path / "conftest.py").write_text(
        "import tests.processes\n"
        "from tests.processes import pytest_configure, pytest_sessionfinish\n"
        "tests.processes.left_after.__defaults__ = (0.2,)\n"
    )
    (tmp_path / "test_it.py").write_text(
        "import subprocess, sys\n"
        "def test_it():\n"
        "    global child\n"
        "    child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(8)'])\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert "1 passed" in done.stdout
    assert done.returncode == 1
    assert "left behind" in done.stderr
    assert "time.sleep(8)" in done.stderr
