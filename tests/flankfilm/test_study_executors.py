"""Executors of the caller: the same rows as by one process, and what becomes of an executor that breaks."""

from __future__ import annotations

import multiprocessing
import os
import time
import warnings
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import pytest

from base import InputError, SolverError
from flankfilm.studies.execution import Execution
from flankfilm.studies.plan import read_plan
from flankfilm.studies.row import Row, RowResult, compute_row
from flankfilm.studies.run import run_study
from flankfilm.studies.workers import Workers
from tests.flankfilm.test_study import SHIFTS, study_file

VARY = SHIFTS + '\n"pair.pinion.tip_alteration" = [0.0, 0.9]'
"""Eight rows, of which some fail."""


def spawned(workers: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"))


@pytest.fixture
def plan(tmp_path):
    return read_plan(study_file(tmp_path, VARY))


@pytest.mark.parametrize("make", [ThreadPoolExecutor, spawned])
def test_rows_are_those_of_one_process(tmp_path, plan, make):
    alone = [compute_row(Row(index, plan.raw_scene(index), plan.outputs)) for index in range(len(plan.rows))]
    filters = list(warnings.filters)
    with make(2) as pool:
        study = run_study(plan, tmp_path / "out", Execution(pool, workers=2, cache=False))
        assert pool.submit(os.getpid).result() > 0  # it is not shut down
    assert repr([(row.values, row.fault) for row in study.rows]) == repr(
        [(row.values, row.fault) for row in alone]
    )
    assert len(study.failures) == 4
    assert warnings.filters == filters


def die_on(row: Row) -> RowResult:
    """Stand in for a row's work."""
    if row.index == 1:
        os._exit(9)
    return RowResult(row.index, (float(row.index),), 0.0)


def test_threads_take_turns(monkeypatch):
    """Each row sets the filters of warnings, which the whole process has in common, and puts them back."""
    at_work, most = [], []

    def counted(row: Row) -> RowResult:
        at_work.append(row)
        time.sleep(0.01)
        most.append(len(at_work))
        at_work.remove(row)
        return RowResult(row.index, (0.0,), 0.0)

    monkeypatch.setattr("flankfilm.studies.row._computed", counted)
    with ThreadPoolExecutor(4) as pool, Workers(pool, 4) as workers:
        done = list(workers.computed([Row(index, {}, ("contact_ratio",)) for index in range(20)]))
    assert len(done) == 20
    assert set(most) == {1}


@pytest.mark.slow
def test_a_process_that_dies_costs_its_row_and_the_executor(monkeypatch):
    monkeypatch.setattr("flankfilm.studies.workers.compute_row", die_on)
    rows = [Row(index, {}, ("contact_ratio",)) for index in range(30)]
    arrived: list[RowResult] = []

    def compute(asked: list[Row]) -> None:
        arrived.clear()
        with spawned(1) as pool, Workers(pool, 1) as workers:
            for result in workers.computed(asked):
                arrived.append(result)

    with pytest.raises(SolverError, match="rows are missing; give another executor, with resume=True"):
        compute(rows)
    assert {0, 1} <= {result.index for result in arrived}
    assert len(arrived) < 30
    compute(rows[:3])
    assert {result.index: bool(result.fault) for result in arrived} == {0: False, 1: True, 2: False}
    assert "died twice" in next(result for result in arrived if result.fault).fault


class Idle(Executor):
    """Takes calls and does the first one."""

    def __init__(self) -> None:
        self.futures: list[Future[RowResult]] = []

    def submit(self, fn, /, *args, **kwargs):
        self.futures.append(Future())
        if len(self.futures) == 1:
            self.futures[0].set_result(RowResult(0, (0.0,), 0.0))
        return self.futures[-1]


def test_rows_that_wait_are_cancelled_when_a_study_ends_early():
    idle = Idle()

    def interrupted() -> None:
        with Workers(idle, 2) as workers:
            for _ in workers.computed([Row(index, {}, ("contact_ratio",)) for index in range(30)]):
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [future.cancelled() for future in idle.futures] == [False] + [True] * 5


def test_what_is_no_executor_is_refused():
    for wrong in ("threads", 4, None):
        with pytest.raises(InputError, match=r"concurrent\.futures\.Executor"):
            Execution(wrong)
