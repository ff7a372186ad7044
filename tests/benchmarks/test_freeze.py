"""The tool that compares two commits: what counts as the same, what is left out, and a planted change that it sees."""

from __future__ import annotations

import doctest
import tomllib
from pathlib import Path

import numpy as np
import pytest

from benchmarks.freeze import case, cases_scenes, comparing, folders
from benchmarks.freeze.__main__ import chosen, line, main, passed, summary
from benchmarks.freeze.case import NOT_THERE, Case, flat, public, take
from benchmarks.freeze.cases_scenes import EXAMPLES, shortened, toml
from benchmarks.freeze.cases_studies import STUDIES
from benchmarks.freeze.comparing import compare, within
from benchmarks.freeze.folders import folder_arrays, page
from benchmarks.freeze.running import Outcome, run_cases
from benchmarks.freeze.trees import ROOT, checked_out, git
from benchmarks.freeze.worker import PACKAGES, all_cases


def only(first, second):
    (change,) = compare({"a": np.asarray(first)}, {"a": np.asarray(second)})
    return change


def test_equal_bits_are_no_change():
    values = {
        "nan": np.array([1.0, np.nan]),
        "wave": np.array([1 + 2j, complex(np.nan, -0.0)]),
        "text": np.array(["a", "bc"]),
        "none": np.array([]),
        "infinite": np.array([np.inf, -np.inf]),
        "yes": np.array(True),
    }
    assert compare(values, {name: value.copy() for name, value in values.items()}) == ()


def test_one_last_bit_is_a_change_and_its_size_is_said():
    change = only([1.0, 4.0], [1.0, np.nextafter(4.0, 5.0)])
    assert change.absolute == np.spacing(4.0)
    assert change.relative == pytest.approx(np.spacing(4.0) / 4.0)
    assert "1 of 2 entries" in str(change)
    assert within((change,), 1e-15)
    assert not within((change,), 1e-17)


@pytest.mark.parametrize(
    ("first", "second", "words"),
    [
        ([1.0, 2.0], [1.0], "shape (2,) and (1,)"),
        ([1.0], np.array([1.0], dtype=np.float32), "type float64 and float32"),
        ([1.0], [1], "type float64 and int64"),
        (["up"], ["down"], "'up' and 'down'"),
        ([1.0], [np.nan], "inf"),
        ([True, False], [True, True], "1 of 2 entries"),
        (NOT_THERE, [1.0], "in the second commit alone"),
        ([1.0], NOT_THERE, "in the first commit alone"),
        (NOT_THERE, NOT_THERE, "in neither commit"),
    ],
)
def test_changes_that_no_tolerance_accepts(first, second, words):
    change = only(first, second)
    assert words in str(change)
    assert not within((change,), 1e6)


def test_the_sign_of_zero_is_a_bit_and_imaginary_parts_count():
    assert only([0.0], [-0.0]).absolute == 0.0
    assert only([1 + 0j, 2.0], [1 + 1e-9j, 2.0]).absolute == pytest.approx(1e-9)
    assert only([3], [5]).absolute == 2.0


def test_names_in_one_commit_alone_come_before_differences():
    changes = compare({"b": np.array(1.0), "a": np.array(1.0)}, {"b": np.array(2.0), "c": np.array(1.0)})
    assert [change.name for change in changes] == ["a", "c", "b"]


def test_a_name_may_have_moved():
    assert public("math.no_such_name", "no_such_module.pi", "math.pi") == np.pi
    with pytest.raises(AttributeError, match=r"none of math\.tau1, math\.tau2"):
        public("math.tau1", "math.tau2")
    assert take(2.0, "whole|real gone") == {"whole": 2.0, "gone": NOT_THERE}


def test_values_of_every_kind_become_arrays_without_pickling(tmp_path):
    ragged = [np.zeros(2), np.zeros(3)]
    arrays = flat(
        {"a": ragged, "b": (1, None, "x"), "c": {"d": ["p", "q"], "e": 1 + 2j}, "f": np.array(["o"], object)}
    )
    assert arrays["a/length"] == 2
    assert arrays["a/1"].shape == (3,)
    assert arrays["b/1"] == "None"
    assert arrays["c/d"].tolist() == ["p", "q"]
    np.savez(tmp_path / "kept.npz", **arrays)
    with np.load(tmp_path / "kept.npz", allow_pickle=False) as kept:
        assert compare(arrays, {name: kept[name] for name in kept.files}) == ()
    with pytest.raises(TypeError, match="name the figures"):
        flat({"a": object()})


def test_folders_without_clocks_and_versions(tmp_path):
    import h5py

    def fill(folder: Path, seconds: float, stiffness: float) -> Path:
        (folder / "csv").mkdir(parents=True)
        (folder / "csv" / "t.csv").write_text(f"row,k,seconds\n0,{stiffness!r},{seconds!r}\n")
        (folder / "report.html").write_text(f"<title>T</title><p>k = {stiffness}</p><p>after {seconds} s</p>")
        (folder / "files.json").write_text(str(seconds))
        with h5py.File(folder / "results.nc", "w") as data:
            data["k"] = stiffness
            data["k"].attrs["units"] = "N/m"
            data["seconds"] = seconds
            data.attrs["versions_json"] = f'{{"python": "{seconds}"}}'
            data.attrs["decisions_json"] = f'[{{"choice": "fem", "seconds": {seconds}}}]'
        return folder

    first, later, other = (
        folder_arrays(fill(tmp_path / name, seconds, stiffness))
        for name, seconds, stiffness in (("a", 1.5, 2.0), ("b", 3.25, 2.0), ("c", 1.5, 2.5))
    )
    assert compare(first, later) == ()
    changed = {change.name for change in compare(first, other)}
    assert changed == {"results.nc/k", "csv/t.csv/1 k", "report.html"}


def test_masked_times_leave_other_figures():
    words = page("<p>12.5 s of work</p><p>0.3 ms</p><p>200 rad/s, 15 mm, 3 m/s, 5 N s/m</p>")
    row = "<tr><td>{}</td><td>{}</td><td>{}</td></tr>"
    listed = page(row.format("films", "", "6 ms") + row.format("mesh", "0.1 %", "1 min 5 s"))
    assert listed == ["mesh", "0.1 %", "(time)"]  # what is listed for its time alone depends on the time
    assert words == ["(time) of work", "(time)", "200 rad/s, 15 mm, 3 m/s, 5 N s/m"]


def test_a_shortened_scene_stands_beside_its_own_and_reads_as_toml(tmp_path):
    source = tmp_path / "a.toml"
    source.write_text('title = "Ä"\n[dynamics]\nsweep = { points = 400, speed_rpm = [1, 2] }\nzeta = 1e-3\n')
    short = shortened(source, {"dynamics.sweep.points": 8, "film.model": "none"})
    assert short.parent == source.parent
    read = tomllib.loads(short.read_text(encoding="utf-8"))
    assert read["dynamics"] == {"sweep": {"points": 8, "speed_rpm": [1, 2]}, "zeta": 1e-3}
    assert read["film"] == {"model": "none"}
    assert tomllib.loads(toml(read)) == read
    assert shortened(source, {}) == source


def test_every_example_is_a_case():
    scenes = {path.relative_to(ROOT / "examples").with_suffix("").as_posix() for path in _toml("examples")}
    folders = ("studies/", "optimise/")
    assert EXAMPLES.keys() == {name for name in scenes if not name.startswith(folders)}
    assert STUDIES.keys() == {name.removeprefix("studies/") for name in scenes if name.startswith("studies/")}


def _toml(folder: str) -> list[Path]:
    return sorted((ROOT / folder).rglob("*.toml"))


def test_cases_have_one_name_each_and_are_chosen_by_it():
    cases = all_cases()
    names = [case.name for case in cases]
    assert len(set(names)) == len(names)
    assert {case.name.partition("/")[0] for case in chosen(cases, ["fem/*", "ehl/*"], quick=False)} == {
        "fem",
        "ehl",
    }
    assert all(case.quick for case in chosen(cases, None, quick=True))


def test_what_cannot_be_compared_is_said(capsys):
    assert main(["no-such-commit"]) == 2
    assert "no-such-commit" in capsys.readouterr().err
    assert main(["HEAD", "--only", "no/such"]) == 2
    assert "--list" in capsys.readouterr().out


def outcome(first=(), second=(), faults=("", "")) -> Outcome:
    arrays = [{f"a{k}": np.asarray(value) for k, value in enumerate(values)} for values in (first, second)]
    return Outcome(Case("fem/x", lambda room: {}), compare(*arrays), faults, len(first), (1.0, 2.0))


def test_what_is_said_of_an_outcome():
    same, moved = outcome([1.0], [1.0]), outcome([1.0] * 9, [1.0 + 1e-9] * 9)
    failed = outcome(faults=("", "ValueError: x"))
    both = outcome(faults=("ValueError: x", "ValueError: x"))
    assert "bitwise (1 arrays)" in line(same, 0.0, False)
    assert "CHANGED: 9 of 9" in line(moved, 0.0, False)
    assert "and 3 more" in line(moved, 0.0, False)
    assert len(line(moved, 0.0, True).splitlines()) == 10
    assert "within the tolerance" in line(moved, 1e-8, False)
    assert "FAILS in the second: ValueError: x" in line(failed, 0.0, False)
    assert "FAILS in both" in line(both, 0.0, False)
    assert passed([same], 0.0)
    assert passed([same, moved], 1e-8)
    assert not any(passed([one], 1.0 if one is not moved else 0.0) for one in (moved, failed, both))
    assert summary([same, moved, failed], 0.0) == "1 of 3 cases bitwise; 1 changed (fem/x); 1 failed (fem/x)"


@pytest.fixture
def project(tmp_path):
    """A repository with the names of the project's packages."""
    root = tmp_path / "project"
    for package in PACKAGES:
        (root / package).mkdir(parents=True)
        (root / package / "__init__.py").write_text("")
    (root / "gears" / "__init__.py").write_text("SIZE = 1.0\n")
    (root / ".gitignore").write_text("ignored\n")
    (root / "ignored").write_text("")
    for command in (
        ("init", "-q"),
        ("add", "-A"),
        ("-c", "user.name=n", "-c", "user.email=e", "commit", "-qm", "one"),
    ):
        git(*command, root=root)
    return root


def test_trees_are_copies_and_go_again(project, tmp_path):
    (project / "gears" / "__init__.py").write_text("SIZE = 2.0\n")
    (project / "new.py").write_text("")
    with (
        checked_out("HEAD", tmp_path / "first", project) as first,
        checked_out(None, tmp_path / "second", project) as second,
    ):
        assert (first / "gears" / "__init__.py").read_text() == "SIZE = 1.0\n"
        assert (second / "gears" / "__init__.py").read_text() == "SIZE = 2.0\n"
        assert (second / "new.py").exists()
        assert not (second / "ignored").exists()
        assert len(git("worktree", "list", root=project).splitlines()) == 2
    assert not first.exists()
    assert len(git("worktree", "list", root=project).splitlines()) == 1


def test_worktrees_go_when_the_comparison_breaks_off(project, tmp_path):
    with pytest.raises(KeyboardInterrupt), checked_out("HEAD", tmp_path / "first", project):
        raise KeyboardInterrupt
    assert len(git("worktree", "list", root=project).splitlines()) == 1


PLANTED = """
from gears import peak_pressure as _before


def peak_pressure(*given):
    return {!r} * _before(*given)
"""
"""Changes what a package shows, wherever its files are."""


@pytest.mark.parametrize("change", [None, 1.0 + 1e-12])
def test_a_planted_change_is_seen_and_none_without(tmp_path, change):
    """Two copies of this tree, one with a factor in the Hertz pressure: the case that holds it says so."""
    trees = tmp_path / "first", tmp_path / "second"
    with checked_out(None, trees[0]), checked_out(None, trees[1]):
        if change is not None:
            with (trees[1] / "gears" / "__init__.py").open("a") as package:
                package.write(PLANTED.format(change))
        cases = chosen(all_cases(), ["gears/flanks_and_heat"], quick=False)
        (tmp_path / "work").mkdir()
        (found,) = run_cases(cases, trees, tmp_path / "work", tmp_path)
    assert found.faults == ("", "")
    assert [one.name for one in found.changes] == ([] if change is None else ["contact/pressure"])
    if change is not None:
        assert found.changes[0].relative == pytest.approx(1e-12, rel=0.01)


@pytest.mark.parametrize(
    "module", [case, cases_scenes, comparing, folders], ids=lambda module: module.__name__
)
def test_examples_of_the_tool_run(module):
    failed, tried = doctest.testmod(module)
    assert failed == 0
    assert tried
