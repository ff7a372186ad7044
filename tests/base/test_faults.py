"""Faults speak one grammar, are raised together, and survive a worker's end."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import pytest

from base import Fault, Faults, InputError, Limit


def test_a_fault_is_one_sentence_and_a_remedy():
    fault = Fault("pinion.teeth", "3", "must be at least 5", "give more teeth")
    assert str(fault) == "pinion.teeth = 3: must be at least 5. Give more teeth"
    assert str(Fault("[pair]", "", "is required by the film")) == "[pair]: is required by the film"


def test_an_error_comes_back_from_another_process_with_its_faults():
    error = pickle.loads(
        pickle.dumps(InputError([Fault("a", "1", "must be 2"), Fault("b", "", "is missing")]))
    )
    assert [fault.where for fault in error.faults] == ["a", "b"]
    assert str(error) == "a = 1: must be 2\nb: is missing"


@pytest.mark.parametrize("value", [True, "3", None, math.nan, math.inf, 0.0, 1.5])
def test_a_limit_refuses_what_is_no_number_not_finite_or_outside(value: object):
    assert Limit(0.0, 1.0, "m", low_open=True).faults("length", value)


def test_a_limit_in_another_unit_holds_for_the_same_lengths():
    metres = Limit(1e-5, 1.0, "m")
    millimetres = metres.in_unit(1e-3, "mm")
    assert millimetres.holds(1000.0)
    assert not millimetres.holds(1001.0)
    assert str(millimetres) == "must be a finite number, at least 0.01 and at most 1000 mm"


def test_all_faults_are_raised_together():
    found = Faults()
    assert found.number("a", 2, Limit(0, 3)) == 2.0
    assert math.isnan(found.number("b", 4, Limit(0, 3)))
    assert found.whole("n", 2.5, 1, 9) == 1
    assert found.whole("n", 2.0, 1, 9) == 2
    found.choice("plane", "stress", ("strain", "stress"))
    found.choice("plane", "both", ("strain", "stress"))
    with pytest.raises(InputError) as caught:
        found.raise_if_any()
    assert [fault.where for fault in caught.value.faults] == ["b", "n", "plane"]


def test_a_block_raises_what_it_noted_as_the_error_asked_for_unless_it_fails_itself():
    class OutOfStockError(InputError):
        """Faults of a shelf."""

    limits = {"width": Limit(0, 3), "height": Limit(0, 3), "depth": Limit(0, 3)}
    with pytest.raises(OutOfStockError) as caught, Faults(OutOfStockError) as found:
        found.numbers(limits, (4, 5))
    assert [fault.where for fault in caught.value.faults] == ["width", "height"]
    with pytest.raises(ZeroDivisionError), Faults() as found:
        found.numbers(limits, (4, 1 / 0))
    with Faults() as found:
        found.numbers(limits, (1, 2, 3))


def test_an_error_of_one_fault_shows_texts_as_they_are_and_other_values_by_their_representation():
    assert str(InputError.at(Path("a.toml"), "", "does not exist")) == "a.toml: does not exist"
    (fault,) = InputError.at("nodes", (1, 2), "must be a number", "129 is usual").faults
    assert fault == Fault("nodes", "(1, 2)", "must be a number", "129 is usual")
