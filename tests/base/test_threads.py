"""Work on several cores: the results of one, errors raised, compilation not counted."""

import threading
import time

import pytest

from base import InputError, Stopwatch, cores, in_blocks, side_by_side, threads, unclocked


@pytest.fixture(params=[1, 2, 3])
def hands(request, monkeypatch):
    monkeypatch.setattr(threads, "cores", lambda: request.param)
    return request.param


def test_results_stand_in_the_order_of_the_tasks(hands):
    assert side_by_side([lambda k=k: (time.sleep(0.01 * (3 - k)), k)[1] for k in range(4)]) == [0, 1, 2, 3]


def test_tasks_run_at_the_same_time(hands):
    meeting = threading.Barrier(hands)
    assert side_by_side([lambda: meeting.wait(timeout=5.0) >= 0] * hands) == [True] * hands


@pytest.mark.parametrize("which", [0, 1])
def test_what_is_raised_is_raised(hands, which):
    def task(k):
        if k == which:
            raise InputError.at("x", 1, "must be 2", "give 2")

    with pytest.raises(InputError, match="must be 2"):
        side_by_side([lambda: task(0), lambda: task(1)])


@pytest.mark.parametrize("number", [0, 1, 15, 40, 1000, 1001])
def test_every_piece_is_in_one_block(hands, number):
    done = [0] * number

    def work(first, last):
        for k in range(first, last):
            done[k] += 1
        return last - first

    assert in_blocks(number, work) == number
    assert done == [1] * number


def test_what_is_not_counted_in_another_thread_is_not_counted(monkeypatch):
    monkeypatch.setattr(threads, "cores", lambda: 2)

    def load():
        with unclocked():
            time.sleep(0.1)

    watch = Stopwatch()
    side_by_side([lambda: None, load])
    assert watch.seconds < 0.05


def test_what_no_thread_counts_at_the_same_time_is_left_out_once(monkeypatch):
    """Threads that compile the same functions wait for each other: a cost of less than nothing came of it."""
    monkeypatch.setattr(threads, "cores", lambda: 2)
    watch = Stopwatch()

    def load():
        with unclocked():
            time.sleep(0.2)

    side_by_side([load, load])
    assert watch.seconds >= 0.0


def test_cores_are_as_many_as_asked_for(monkeypatch):
    monkeypatch.setenv("NUMBA_NUM_THREADS", "1")
    assert cores() == 1
    monkeypatch.delenv("NUMBA_NUM_THREADS")
    assert cores() >= 1
