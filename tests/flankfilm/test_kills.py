"""Killed at random moments: no row is lost, no file is torn, no process stays, and it goes on to the same digits.

Slow. ``FLANKFILM_KILLS`` says how often each command is killed (2 if it is not set), ``FLANKFILM_SEED`` repeats the
moments, which are printed:

    FLANKFILM_KILLS=50 ./run test --slow -s tests/flankfilm/test_kills.py
"""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import pytest
import xarray as xr

from tests.flankfilm.program import EXAMPLES, SCRIPT
from tests.flankfilm.scenes import ARTICLE
from tests.processes import MARK, left_after, marked, new_mark
from tests.seeds import SEED

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(0),
    pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are read from /proc"),
]

KILLS = int(os.environ.get("FLANKFILM_KILLS", "2"))
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGHUP)

ANSWER = 60.0
"""Seconds within which a command that is asked to end must have: it may be in compiled code, on a busy machine."""

ALL_SIGNALS = 50
"""Kills from which on every signal is tried on every command, instead of one."""

SCENE = f"""
title = "Killed"
wants = ["closed-forms", "stiffness", "fourier", "vtk", "report"]
tolerance = 0.02
{ARTICLE}
[film]
model = "none"
"""

STUDY = f"""
scene = "{(EXAMPLES / "article.toml").as_posix()}"
outputs = ["contact_ratio", "specific_sliding"]
[vary]
"pair.pinion.profile_shift" = {{ from = -0.2, to = 0.4, steps = 600 }}
"""

TASK = f"""
scene = "{(EXAMPLES / "article.toml").as_posix()}"
population = 20
evaluations = 400
minimise = ["specific_sliding"]
[vary]
"pair.pinion.profile_shift" = {{ from = -0.3, to = 0.6 }}
[follow]
"pair.wheel.profile_shift" = {{ of = "pair.pinion.profile_shift", times = -1.0 }}
"""


@dataclass
class Told:
    """What happened to the commands of one kind."""

    kills: Counter[str] = field(default_factory=Counter)
    completed: int = 0
    rows: int = 0
    slowest_answer: float = 0.0
    slowest_end: float = 0.0


@dataclass
class Command:
    """One command, which is started again and again in one folder."""

    name: str
    text: str
    options: tuple[str, ...]
    place: Path
    cache: Path

    def start(self, out: Path) -> tuple[subprocess.Popen[str], str]:
        """Begin, or go on; give the process and the mark of all that it starts."""
        mark = new_mark()
        resumes = () if self.name == "run" else ("--resume",)
        file = self.place / f"{self.name}.toml"
        file.write_text(self.text, encoding="utf-8")
        begun = subprocess.Popen(
            [str(SCRIPT), self.name, str(file), "--out", str(out), *self.options, *resumes],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, MARK: mark, "FLANKFILM_CACHE": str(self.cache)},
        )
        return begun, mark

    def whole(self, out: Path) -> float:
        """Let it come to its end; give the seconds that it took."""
        began = time.monotonic()
        begun, mark = self.start(out)
        said = begun.communicate(timeout=300)[1]
        assert begun.returncode == 0, said
        assert not left_after(mark)
        return time.monotonic() - began


def lines_of(out: Path) -> list[str]:
    """Whole lines of the table of rows."""
    table = out / "rows.csv"
    text = table.read_bytes() if table.exists() else b""
    return text[: text.rfind(b"\n") + 1].decode("utf-8").splitlines()


def digits(out: Path) -> object:
    """What must be the same whenever and wherever it was computed."""
    if (out / "rows.csv").exists():
        head, *lines = (line.split(",") for line in lines_of(out))
        last = head.index("seconds")
        by_keys = sorted(tuple(line[1:last]) for line in lines)
        assert len({line[0] for line in lines}) == len(lines)
        return by_keys
    with xr.open_dataset(out / "results.nc", engine="h5netcdf") as found:
        names = sorted(name for name in map(str, found.variables) if "seconds" not in name)
        return [(name, found[name].values.tobytes()) for name in names if found[name].dtype.kind in "fiub"]


READERS: dict[str, Callable[[Path], object]] = {
    ".json": lambda path: json.loads(path.read_text(encoding="utf-8")),
    ".nc": lambda path: xr.load_dataset(path, engine="h5netcdf"),
    ".pvd": ElementTree.parse,
    ".vtu": lambda path: _ends(path, b"</VTKFile>"),
    ".svg": ElementTree.parse,
    ".html": lambda path: _ends(path, b"</html>"),
    ".csv": lambda path: path.name == "rows.csv" or _ends(path, b"\n", strip=False),
    ".toml": lambda path: _ends(path, b"\n", strip=False),
}


def _ends(path: Path, how: bytes, strip: bool = True) -> None:
    content = path.read_bytes()
    assert (content.rstrip() if strip else content).endswith(how), path


def none_torn(out: Path) -> None:
    """Every file that has its name is whole."""
    for path in out.rglob("*") if out.exists() else ():
        if path.is_file() and not path.name.startswith("."):
            READERS.get(path.suffix, lambda path: path.read_bytes())(path)


def kill(command: Command, out: Path, seconds: float, chance: random.Random, told: Told) -> bool:
    """Start a command and kill it some time later; tell whether it had come to its end."""
    before = lines_of(out)
    begun, mark = command.start(out)
    how = chance.choice(SIGNALS)
    wait = chance.uniform(0.0, seconds)
    if command.name != "run" and chance.random() < 0.7:  # while rows arrive, wherever the machine has got to
        more = chance.randrange(1, 300)
        until = time.monotonic() + 60.0
        while begun.poll() is None and len(lines_of(out)) < len(before) + more and time.monotonic() < until:
            time.sleep(0.002)
        wait = chance.uniform(0.0, 0.05)
    try:
        said = begun.communicate(timeout=wait)[1]
    except subprocess.TimeoutExpired:
        begun.send_signal(how)
        asked = time.monotonic()
        said = begun.communicate(timeout=ANSWER)[1]
        told.slowest_answer = max(told.slowest_answer, time.monotonic() - asked)
    ended = time.monotonic()
    left = left_after(mark)
    told.slowest_end = max(told.slowest_end, time.monotonic() - ended)
    assert not left, (how, left)
    # nobody can tell a worker that is about to start that its parent was killed
    assert "Traceback" not in said or (how == signal.SIGKILL and "in spawn_main" in said), said
    none_torn(out)
    after = lines_of(out)
    assert after[: len(before)] == before  # no row is lost
    told.rows += len(after) - len(before)
    if begun.returncode == 0:
        told.completed += 1
        return True
    # killed before Python could answer, it ends by the signal
    assert begun.returncode in (-how, 128 + how), (how, begun.returncode, said)
    told.kills[how.name] += 1
    return False


@pytest.mark.parametrize(
    ("name", "text", "options"),
    [
        pytest.param("run", SCENE, (), id="run"),
        pytest.param("study", STUDY, ("--workers", "2"), id="study"),
        pytest.param("study", STUDY, ("--workers", "2", "--executor", "dask"), id="study-dask"),
        pytest.param("optimise", TASK, ("--workers", "2"), id="optimise"),
        pytest.param("optimise", TASK, ("--workers", "2", "--executor", "dask"), id="optimise-dask"),
    ],
)
@pytest.mark.long
def test_killed_at_random_moments(tmp_path, name, text, options):
    print(f"\nFLANKFILM_SEED={SEED}", end=" ")
    chance = random.Random(f"{SEED} {name} {options}")
    command = Command(name, text, options, tmp_path, tmp_path / "cache0")
    expected_in = tmp_path / "whole"
    command.whole(expected_in)  # compiled code is kept from then on
    command.cache = tmp_path / "cache1"
    seconds = command.whole(expected_in.with_name("again"))
    expected = digits(expected_in)
    told, series = Told(), 0
    while sum(told.kills.values()) < KILLS:
        series += 1
        out = tmp_path / f"out{series}"
        command.cache = tmp_path / f"cache_of_{series}"
        while not (done := kill(command, out, seconds, chance, told)) and sum(told.kills.values()) < KILLS:
            pass
        if not done:
            command.whole(out)
        same(digits(out), expected)
    print(f"{name} {' '.join(options)}: {dict(told.kills)}, {told.completed} came to their end in between, "
          f"{series} folders, {told.rows} rows kept, answer within {told.slowest_answer:.1f} s, "
          f"processes gone within {told.slowest_end:.1f} s")  # fmt: skip


def same(found: object, expected: object) -> None:
    """Equal to the last digit; what differs is named."""
    if isinstance(found, list) and isinstance(expected, list) and found != expected:
        differ = [a[0] for a, b in zip(found, expected, strict=False) if a != b]
        pytest.fail(f"{len(found)} and {len(expected)} entries, that differ: {differ[:10]}")


@pytest.mark.parametrize(
    ("arguments", "statuses"),
    [
        (("check", "run.toml"), {0}),
        (("verify", "run.toml", "--out", "verified"), {0}),
        (("run", "run.toml", "--out", "out"), {0}),
        (("export", "run.toml", "--out", "gears.msh"), {0, 2}),
        (("animate", "out"), {0, 3}),
        (("view", "out", "--out", "picture.png"), {0, 3}),
        (("view", "nowhere", "--out", "picture.png"), {2}),
        (("study", "study.toml", "--out", "rows", "--workers", "2", "--resume"), {0}),
        (("bench", "--quick", "--only", "gears", "--out", "bench"), {0}),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
@pytest.mark.parametrize("ended", ["by itself", "by signals"])
def test_nothing_is_left_of_a_command(place, arguments, statuses, ended):
    """Whether it came to its end, or was ended while whatever it started was at work."""
    if ended == "by itself":
        begun, mark = started(place, arguments)
        said = begun.communicate(timeout=300)[1]
        assert begun.returncode in statuses, said
        assert not left_after(mark)
        return
    chance = random.Random(f"{SEED} {arguments}")
    for how in (
        (*SIGNALS, signal.SIGINT, signal.SIGQUIT) if KILLS >= ALL_SIGNALS else (chance.choice(SIGNALS),)
    ):
        begun, mark = started(place, arguments)
        until = time.monotonic() + 3.0  # it starts a process, or is at work by then
        while begun.poll() is None and len(marked(mark)) < 2 and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(0.2)
        begun.send_signal(how)
        begun.communicate(timeout=ANSWER)
        assert not left_after(mark), how


def started(place: Path, arguments: tuple[str, ...]) -> tuple[subprocess.Popen[str], str]:
    """Begin a command in a folder; give it and the mark of all that it starts."""
    mark = new_mark()
    begun = subprocess.Popen(
        [str(SCRIPT), *arguments],
        cwd=place,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, MARK: mark},
    )
    return begun, mark


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a scene, a study, and a finished run."""
    folder = tmp_path_factory.mktemp("place")
    (folder / "run.toml").write_text(SCENE, encoding="utf-8")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    subprocess.run(
        [str(SCRIPT), "run", "run.toml", "--out", "out"], cwd=folder, check=True, capture_output=True
    )
    return folder
