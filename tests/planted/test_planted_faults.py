"""The script that plants faults, on a few modules of the ground floors."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.planted.faults import faults_at, named, sample, sites, written_since

ROOT = Path(__file__).parents[2]
SEED = 11
AMONG = (
    "base/units.py",
    "gears/tooth/involute.py",
    "gears/tooth/bisection.py",
    "gears/closed_form/dynamic_factor.py",
)
TESTS = ("tests/base", "tests/gears/test_dynamic_factor.py", "tests/gears/test_profile.py")


def test_every_fault_is_one_change_that_python_takes(tmp_path: Path):
    source = b"""import math

def area(radius: float, times: int = 2) -> float:
    if radius < 0.0 and times:
        raise ValueError("a message of 3 words, and more than 1 - 1")
    return (
        math.pi
        * max(radius, 0.5) ** 2
    )
"""
    (tmp_path / "one.py").write_bytes(source)
    every = sites(source)
    found = [fault for site in every for fault in faults_at("one.py", source, site, every)]
    names = {fault.name for fault in found}
    assert len(names) == len(found)
    for wanted in ("0.5 -> 0.505", "2 -> 3", "max(radius, 0.5) -> min(radius, 0.5)", "radius < 0.0 -> radius >= 0.0",
                   "max(radius, 0.5) ** 2 -> max(radius, 0.5)", "radius < 0.0 and times -> times"):  # fmt: skip
        assert any(wanted in name for name in names), wanted
    for fault in found:
        planted = fault.planted(source)
        assert ast.dump(ast.parse(planted)) != ast.dump(ast.parse(source))
        assert planted.count(b"\n") == source.count(b"\n")  # lines stay where they were
        assert b"a message of 3 words, and more than 1 - 1" in planted
    drawn = sample(tmp_path, [tmp_path / "one.py"], 5, SEED)
    assert drawn == sample(tmp_path, [tmp_path / "one.py"], 5, SEED)
    (tmp_path / "one.py").write_bytes(b"# a line more\n" + source)
    again = named(tmp_path, [fault.name for fault in drawn])
    assert [(one.name, one.line - 1) for one in again] == [(one.name, one.line) for one in drawn]


def test_faults_stand_in_lines_written_since_a_revision(tmp_path: Path):
    def git(*arguments: str) -> None:
        who = ("-c", "user.name=A", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
        subprocess.run(["git", *who, *arguments], cwd=tmp_path, check=True, capture_output=True)

    old = "def half(a):\n    b = a + 1\n    return 0.5 * b\n"
    (tmp_path / "kept.py").write_text(old)
    (tmp_path / "moved.py").write_text(old.replace("half", "part"))
    git("init", "--quiet")
    git("add", ".")
    git("commit", "--quiet", "--message", "first")
    git("mv", "moved.py", "there.py")
    (tmp_path / "kept.py").write_text(
        "# one line more\n" + old.replace("0.5 * b", "0.5 * b - a") + "C = 2.0\n"
    )
    (tmp_path / "new.py").write_text("A = 3.0 * 2.0\n")
    git("add", ".")
    git("commit", "--quiet", "--message", "second")
    lines = written_since(tmp_path, "HEAD~1")
    assert lines == {"kept.py": {1, 4, 5}, "new.py": {1}}
    drawn = sample(tmp_path, tmp_path.rglob("*.py"), 100, SEED, lines)
    assert {(fault.path, fault.line) for fault in drawn} == {("kept.py", 4), ("kept.py", 5), ("new.py", 1)}
    assert len(sample(tmp_path, tmp_path.rglob("*.py"), 100, SEED)) > len(drawn)


@pytest.mark.slow
def test_tests_of_ground_floors_see_planted_faults(tmp_path: Path):
    def run(*arguments: str) -> str:
        command = [sys.executable, "-m", "tests.planted", *arguments, "--map", str(tmp_path)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=200, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("map", *TESTS)
    places = ("--work", str(tmp_path), "--out", str(tmp_path / "planted.jsonl"))
    said = run("plant", "--faults", "10", "--seed", str(SEED), "--among", *AMONG, *places, "--seconds", "10")
    print(said)
    assert f"seed {SEED}" in said
    found = re.search(r"seen: (\d+) of 10", said)
    assert found is not None, said
    assert int(found[1]) >= 5, said  # some of any ten change no result
    assert not {
        path for path in AMONG if (ROOT / path).read_bytes() != (tmp_path / "tree" / path).read_bytes()
    }
