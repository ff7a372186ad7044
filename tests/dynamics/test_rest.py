"""Where an oscillator rests: on the flank that the mean force presses, which only is there if the law has it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator

PLAIN = GearOscillator(FourierStiffness(1.0, (0.2,), (0.0,)), 0.05, 0.1, 0.0, 0.8, half_backlash=0.5)


@pytest.mark.parametrize("force", [0.3, 1e-3])
def test_a_second_flank_is_rested_on_where_there_is_one(force):
    np.testing.assert_allclose(replace(PLAIN, mean_force=-force).rest_state(), [-0.5 - force, 0.0])
    for one_sided in (False, True):
        pressed = replace(PLAIN, mean_force=force, one_sided=one_sided)
        np.testing.assert_allclose(pressed.rest_state(), [0.5 + force, 0.0])
        assert pressed.deflection(pressed.rest_state()[0]) == pytest.approx(force)


@pytest.mark.parametrize("force", [-0.3, -1e-3])
def test_nothing_holds_what_falls_off_a_single_flank(force):
    falling = replace(PLAIN, mean_force=force, one_sided=True)
    assert np.array_equal(falling.rest_state(), np.zeros(2))
    starts = falling.balanced(np.linspace(0.0, falling.period, 7))
    assert np.all(starts[:, 0] == 0.5)
    shaken = replace(falling, error_amplitude=1.0).balanced(np.linspace(0.0, falling.period, 7))
    assert np.all(shaken[:, 0] >= 0.5)


def test_a_negative_stiffness_balances_what_pulls():
    hung = replace(PLAIN, stiffness=FourierStiffness(-1.0, (), ()), mean_force=-0.2, one_sided=True)
    at = hung.rest_state()
    assert at[0] == pytest.approx(0.7)
    assert hung.stiffness(0.0) * hung.deflection(at[0]) == pytest.approx(hung.mean_force)
