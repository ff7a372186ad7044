"""Optimisation: known optima, limits, fronts, phases of tolerance, and what a killed one leaves behind."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq

from base import InputError, SolverError
from flankfilm.build import gear_pair
from flankfilm.optimisation.files import phases
from flankfilm.optimisation.run import Evaluation, Optimum, optimise
from flankfilm.optimisation.search import front
from flankfilm.optimisation.task import read_task
from flankfilm.scene import read_scene
from flankfilm.scene.reader import validated
from flankfilm.studies.execution import Execution
from flankfilm.studies.row import RowResult
from tests.flankfilm.program import flankfilm

EXAMPLES = Path(__file__).parents[2] / "examples"

SHIFT = """
[vary]
"pair.pinion.profile_shift" = { from = -0.3, to = 0.6 }
[follow]
"pair.wheel.profile_shift" = { of = "pair.pinion.profile_shift", times = -1.0 }
"""


def task_file(folder, wanted, rest=SHIFT):
    path = folder / "task.toml"
    scene = (EXAMPLES / "article.toml").as_posix()
    path.write_text(f'scene = "{scene}"\npopulation = 12\n{wanted}\n{rest}', encoding="utf-8")
    return path


def balance(task, shift):
    """Specific sliding of the wheel's foot at A less that of the pinion's foot, by the sizes."""
    pair = gear_pair(validated(task.raw_scene((shift, -shift), 0.005)))
    ends = pair.path_at(np.array([pair.points.A, pair.points.E]))
    first, second = (np.abs(part).max() for part in ends.specific_sliding)
    return first - second


def largest_sliding(pair):
    ends = pair.path_at(np.array([pair.points.A, pair.points.E]))
    return max(np.abs(part).max() for part in ends.specific_sliding)


def test_least_sliding_is_balanced_sliding(tmp_path):
    """The larger of two figures, one falling and one rising with the shift, is least where they are equal."""
    task = read_task(task_file(tmp_path, 'minimise = ["specific_sliding"]\nevaluations = 300'))
    found = optimise(task, tmp_path / "out", Execution(workers=1))
    best = found.evaluations[found.best[0]]
    balanced = brentq(lambda x: balance(task, x), -0.3, 0.6)
    assert best.values[0] == pytest.approx(balanced, abs=2e-3)
    assert best.tolerance == task.tolerances[1]
    assert {e.tolerance for e in found.evaluations} == set(task.tolerances)


@pytest.mark.slow
def test_a_limit_is_kept_and_reached(tmp_path):
    wanted = 'maximise = ["specific_sliding"]\nevaluations = 200'
    upper = SHIFT.replace("-0.3", "0.1")  # there sliding grows and the contact ratio falls with the shift
    limit = '[limits]\n"contact_ratio" = { at_least = 1.68 }\n' + upper
    task = read_task(task_file(tmp_path, wanted, limit))
    found = optimise(task, tmp_path / "out", Execution(workers=1))
    best = found.evaluations[found.best[0]]
    sliding, ratio = best.result.values
    assert ratio >= 1.68
    free = optimise(read_task(task_file(tmp_path, wanted, upper)), tmp_path / "free", Execution(workers=1))
    assert free.evaluations[free.best[0]].result.values[0] > sliding  # the limit costs something
    assert ratio == pytest.approx(1.68, abs=2e-3)


def test_limits_that_nothing_keeps_end_with_a_reason(tmp_path):
    limit = '[limits]\n"contact_ratio" = { at_least = 3.0 }\n' + SHIFT
    task = read_task(task_file(tmp_path, 'minimise = ["specific_sliding"]\nevaluations = 24', limit))
    with pytest.raises(SolverError, match="none of"):
        optimise(task, tmp_path / "out", Execution(workers=1))


def test_a_front_holds_what_nothing_betters():
    values = np.array([[1.0, 4.0], [2.0, 2.0], [2.0, 3.0], [4.0, 1.0], [0.5, 9.0], [0.1, 0.1]])
    allowed = np.array([True, True, True, True, True, False])
    assert front(values, allowed).tolist() == [4, 0, 1, 3]


def test_several_objectives_trade_off(tmp_path):
    wanted = 'minimise = ["specific_sliding"]\nmaximise = ["contact_ratio"]\nevaluations = 120'
    task = read_task(task_file(tmp_path, wanted))
    found = optimise(task, tmp_path / "out", Execution(workers=1))
    front_values = np.array([found.evaluations[i].result.values for i in found.best])
    # the grid's front, found by trying, is not better than ours anywhere by more than the search's steps
    shifts = np.linspace(-0.3, 0.6, 181)
    pairs = [gear_pair(validated(task.raw_scene((s, -s), 0.005))) for s in shifts.tolist()]
    sliding = [
        max(np.abs(part).max() for part in p.path_at(np.array([p.points.A, p.points.E])).specific_sliding)
        for p in pairs
    ]
    tried = np.column_stack([sliding, [p.contact_ratio for p in pairs]])
    for s, ratio in front_values:
        better = tried[tried[:, 0] <= s]
        assert not better.size or better[:, 1].max() <= ratio + 1e-3
    assert np.all(np.diff(front_values[:, 0]) >= 0)
    assert np.all(np.diff(front_values[:, 1]) >= 0)
    assert len(front_values) > 5


@pytest.mark.slow
def test_taken_up_again_it_ends_with_the_same_points(tmp_path):
    path = task_file(tmp_path, 'minimise = ["specific_sliding"]\nevaluations = 60')
    task = read_task(path)
    whole = optimise(task, tmp_path / "whole", Execution(workers=1))
    rows = tmp_path / "whole" / "rows.csv"
    for kept in (1, 17, 40):
        folder = tmp_path / f"cut{kept}"
        folder.mkdir()
        (folder / "optimisation.json").write_bytes((rows.parent / "optimisation.json").read_bytes())
        lines = rows.read_bytes().splitlines(keepends=True)
        # rows of a batch arrive in any order: leave out one from the middle
        cut = lines[: kept + 1] if kept < 17 else lines[: kept // 2] + lines[kept // 2 + 1 : kept + 1]
        (folder / "rows.csv").write_bytes(b"".join(cut) + b"9,0.0")
        with pytest.raises(InputError, match="--resume"):
            optimise(task, folder, Execution(workers=1))
        again = optimise(task, folder, Execution(workers=1, resume=True))
        assert [e.values for e in again.evaluations] == [e.values for e in whole.evaluations]
        assert [e.result.values for e in again.evaluations] == [e.result.values for e in whole.evaluations]
        assert again.computed == whole.computed - (len(cut) - 1)
        indices = pd.read_csv(folder / "rows.csv")["row"]
        assert indices.is_unique


def test_it_is_said_what_the_coarse_phase_saved(tmp_path):
    task = read_task(task_file(tmp_path, 'minimise = ["specific_sliding"]\nevaluations = 60'))
    coarse, fine = task.tolerances
    assert coarse == 5 * fine
    costs = [(coarse, 1.0, "")] * 6 + [(fine, 3.0, "")] * 4 + [(fine, 0.1, "pointed")] * 5
    points = tuple(
        Evaluation(tolerance, (float(i),), RowResult(i, (1.0,), seconds, fault))
        for i, (tolerance, seconds, fault) in enumerate(costs)
    )
    found = Optimum(task, points, np.array([6]), 15, 20.0)
    assert phases(found) == pytest.approx((1.0, 3.0, 1 - 18 / 30))
    assert phases(Optimum(task, points[6:], np.array([0]), 9, 20.0)) is None


def test_a_wide_tolerance_is_not_narrowed_far_away(tmp_path):
    wide = SHIFT + '[set]\n"tolerance" = 0.2\n'
    assert read_task(task_file(tmp_path, 'minimise = ["specific_sliding"]', wide)).tolerances == (0.2, 0.2)


@pytest.mark.slow
def test_the_command_writes_a_scene_that_runs(tmp_path):
    path = task_file(tmp_path, 'minimise = ["specific_sliding"]\nevaluations = 24')
    done = flankfilm("optimise", path, "--out", tmp_path / "out", "--workers", 1)
    assert "specific_sliding" in done.stdout
    raw = tomllib.loads((tmp_path / "out" / "optimum.toml").read_text(encoding="utf-8"))
    best = pd.read_csv(tmp_path / "out" / "optimum.csv")
    assert raw["pair"]["pinion"]["profile_shift"] == best["pair.pinion.profile_shift"][0]
    pair = gear_pair(read_scene(tmp_path / "out" / "optimum.toml"))
    assert largest_sliding(pair) == pytest.approx(best["specific_sliding"][0])
    assert "<svg" in (tmp_path / "out" / "optimum.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("wanted", "rest", "expected"),
    [
        ("", SHIFT, "minimise: needs an output"),
        ('minimise = ["beauty"]', SHIFT, "is not an output"),
        ('minimise = ["contact_ratio"]', "[vary]", "vary"),
        ('minimise = ["contact_ratio"]', '[vary]\n"pair.colour" = { from = 0.0, to = 1.0 }', "colour"),
        ('minimise = ["contact_ratio"]', '[limits]\n"contact_ratio" = {}' + SHIFT, "at_least or at_most"),
    ],
)
def test_faults_name_the_key(tmp_path, wanted, rest, expected):
    with pytest.raises(InputError, match=expected):
        read_task(task_file(tmp_path, wanted, rest))


@pytest.mark.parametrize("path", sorted((EXAMPLES / "optimise").glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_is_in_order(path):
    task = read_task(path)
    assert task.outputs
