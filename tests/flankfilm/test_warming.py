"""`flankfilm warm-up`: every kernel is compiled by one of its parts."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from flankfilm.processes.progress import compiling_line
from flankfilm.warm_up import PARTS, Warmed, warmed

ROOT = Path(__file__).resolve().parents[2]
KERNEL = re.compile(r"^@(?:kernel|law_kernel|njit\(cache=True.*)\ndef (\w+)", re.MULTILINE)


def test_a_part_says_whether_it_was_compiled():
    part = warmed("branches of orbits")
    assert str(part).startswith("branches of orbits: ")
    assert str(Warmed("films", 0, 0.25)) == "films: was ready, 0.2 s"
    assert str(Warmed("films", 3, 2.0)) == "films: 3 functions compiled, 2.0 s"


def test_the_line_of_compilation_names_what_the_parts_do():
    modules = ["flow", "correcting", "drives.propagating", "stepwise.laws"]
    lines = [
        compiling_line(name)
        for name in (*(f"dynamics.kernels.{m}" for m in modules), "ehl.kernels.film_kernels")
    ]
    assert [line.removeprefix("compiling for ").split(",")[0] for line in lines] == list(PARTS)
    assert compiling_line("elsewhere") == "compiling, once: later runs load what is kept"


@pytest.mark.slow
def test_all_kernels_are_kept_afterwards(tmp_path):
    env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "flankfilm", "warm-up"]
    for again in (False, True):
        done = subprocess.run(command, capture_output=True, text=True, check=True, env=env)
        said = sorted(line.split(":")[0] for line in done.stdout.splitlines())
        assert said == sorted(PARTS)
        assert done.stdout.count("was ready") == (len(PARTS) if again else 0)
    kept = {path.name.split("-")[0].rpartition(".")[2] for path in tmp_path.rglob("*.nbi")}
    sources = [*(ROOT / "dynamics" / "kernels").rglob("*.py"), *(ROOT / "ehl").rglob("*.py")]
    kernels = {name for source in sources for name in KERNEL.findall(source.read_text())}
    assert len(kernels) > 20
    assert kernels <= kept
