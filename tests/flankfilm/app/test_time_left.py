"""Time left of a run: exact where stages keep to what was foreseen, corrected at their ends, or none."""

from __future__ import annotations

from pathlib import Path

import pytest

from flankfilm.app.time_left import TRUST, Clock, foreseen
from flankfilm.scene.reader import read_scene

EXAMPLES = Path(__file__).parents[3] / "examples"
THREE = {"mesh": 2.0, "film": 6.0, "report": 4.0}


def test_stages_that_keep_to_their_costs_leave_the_rest_exactly():
    clock = Clock(THREE)
    assert clock.left(0.0) is None  # nothing has begun
    clock.begins("mesh", 0, 3, 10.0)
    assert clock.left(10.0) == (12.0, 2.0)
    assert clock.left(11.5) == (10.5, 0.5)
    clock.begins("film", 1, 3, 12.0)
    assert clock.left(12.0) == (10.0, 6.0)
    clock.begins("report", 2, 3, 18.0)
    assert clock.left(20.0) == (2.0, 2.0)


def test_each_end_of_a_stage_corrects_what_follows_by_the_measured_pace():
    clock = Clock(THREE)
    clock.begins("mesh", 0, 3, 0.0)
    clock.begins("film", 1, 3, 8.0)
    pace = (TRUST + 8.0) / (TRUST + 2.0)
    assert clock.left(8.0) == pytest.approx((10.0 * pace, 6.0 * pace), rel=1e-12)
    clock.begins("report", 2, 3, 14.0)  # as foreseen
    pace = (TRUST + 14.0) / (TRUST + 8.0)
    assert clock.left(14.0) == pytest.approx((4.0 * pace, 4.0 * pace), rel=1e-12)


def test_a_stage_that_takes_longer_than_foreseen_says_nothing_until_it_ends():
    clock = Clock(THREE)
    clock.begins("mesh", 0, 3, 0.0)
    assert clock.left(2.1) is None
    clock.begins("film", 1, 3, 2.1)
    assert clock.left(2.1) is not None


def test_an_unknown_cost_says_nothing_until_it_is_behind():
    clock = Clock({"mesh": 1.0, "branches": None, "report": 3.0})
    clock.begins("mesh", 0, 3, 0.0)
    assert clock.left(0.5) is None
    clock.begins("branches", 1, 3, 1.0)
    assert clock.left(2.0) is None
    clock.begins("report", 2, 3, 60.0)
    assert clock.left(60.0) == (3.0, 3.0)
    assert Clock().left(0.0) is None


def test_rows_that_a_stage_counts_tell_its_time_left_better_than_what_was_foreseen():
    clock = Clock({"sweep": None, "report": 3.0})
    clock.begins("sweep", 0, 2, 0.0)
    assert clock.left(0.0) is None
    clock.begins("sweep: 2 of 8 speeds, 30 s left", 2, 8, 10.0)
    assert clock.left(10.0) == (33.0, 30.0)


def test_a_stage_of_the_cache_is_behind_and_one_in_which_code_is_compiled_tells_nothing_of_the_pace():
    clock = Clock(THREE)
    clock.begins("film", 0, 3, 0.0)  # the mesh was in the cache
    assert clock.left(0.0) == (10.0, 6.0)
    clock.begins("compiling for films, once", 0, 1, 1.0)
    assert clock.left(1.0) is None
    clock.begins("report", 2, 3, 30.0)
    assert clock.left(30.0) == (4.0, 4.0)


@pytest.mark.parametrize("name", ["article", "face_width", "losses", "drive", "rating", "oscillator"])
def test_a_scene_is_foreseen_in_the_titles_of_its_stages(name):
    scene = read_scene(EXAMPLES / f"{name}.toml")
    costs = foreseen(scene)
    assert all(cost is None or cost >= 0.0 for cost in costs.values())
    assert "netCDF and CSV files" in costs
    assert ("writing the report" in costs) == ("report" in scene.wants)
    unknown = {title for title, cost in costs.items() if cost is None}
    assert (unknown == set()) == (name == "article"), unknown


def test_what_the_plan_foresees_is_what_the_stages_are_foreseen_to_cost():
    coarse, fine = (
        foreseen(read_scene(EXAMPLES / "article.toml").model_copy(update={"tolerance": tolerance}))
        for tolerance in (0.02, 0.001)
    )
    film = "oil film in series with the teeth"
    assert fine[film] > coarse[film] > 0.0
    assert coarse["gears along the face, solved once and kept"] == 0.0
