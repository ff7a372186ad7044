"""Rounds of films until they agree, and the secants by which bulk temperatures are balanced."""

from __future__ import annotations

import pytest

from base import SolverError
from flankfilm.coupling.films.agreement import MOST_ROUNDS, in_agreement
from flankfilm.coupling.losses.bulk_balance import BulkTrial

AMBIENT = 340.0


def balanced(slope: float) -> tuple[BulkTrial, int]:
    """Bulk temperatures of gears whose losses warm them by a rise that changes with their temperature."""

    def trial(bulk: tuple[float, float], before: BulkTrial | None = None) -> BulkTrial:
        rise = 20.0 + slope * (0.5 * sum(bulk) - AMBIENT)
        return BulkTrial(bulk, (AMBIENT + 1.2 * rise, AMBIENT + 0.8 * rise), before)

    return in_agreement(
        trial((AMBIENT, AMBIENT)),
        lambda last: trial(last.following, last),
        lambda last: last.change < 1e-9,
        lambda last: f"still {last.change:.2g} K",
    )


@pytest.mark.parametrize("slope", [-2.5, -0.5, 0.0, 0.4])
def test_secants_balance_linear_losses_soon(slope: float):
    settled, rounds = balanced(slope)
    rise = 20.0 / (1.0 - slope)
    assert settled.bulk == pytest.approx((AMBIENT + 1.2 * rise, AMBIENT + 0.8 * rise))
    assert rounds <= 4


def test_rounds_that_never_agree_end_with_what_is_lacking():
    seen = [1]
    with pytest.raises(SolverError, match="round 12 still changes"):
        in_agreement(
            1,
            lambda last: seen.append(last + 1) or last + 1,
            lambda last: last > MOST_ROUNDS,
            lambda last: f"round {last} still changes",
        )
    assert seen == [*range(1, MOST_ROUNDS + 1)]


def test_a_first_round_that_agrees_is_the_only_one():
    assert in_agreement(3.0, lambda last: last / 0.0, lambda last: last > 2.0, str) == (3.0, 1)


def test_temperatures_that_ask_for_no_change_stay_to_the_last_digit():
    bulk = (361.1, 354.7)
    assert BulkTrial(bulk, bulk, None).following == bulk
