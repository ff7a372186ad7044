"""The article's frequency scans (lubricated and starved), as far as the orbit that never leaves contact goes.

The article does not print kappa and phi of its lubricated scan; kappa = 0.18 (fitted to the first point
only) and phi = 0 reproduce the rest. Its starved scan belongs to zeta = 0.01, F_m = 0.05, kappa = 0.1, D =
1.0, found by an inverse search, not to the parameters it prints. The computed values come from an
independent prototype.
"""

from __future__ import annotations

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, contact_grazing, sweep


def test_lubricated_grazing():
    osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    result = contact_grazing(osc, bounds=(0.4, 1.0))
    (point,) = result.points
    assert point.parameter == pytest.approx(0.633533993217297, rel=0, abs=1e-14)
    assert round(point.parameter, 4) == 0.6335  # as printed
    assert result.error < 1e-14


def test_starved_grazing_is_printed_late():
    osc = GearOscillator(FourierStiffness(1.0, (0.1,), (0.0,)), 0.01, 0.05, 0.2, 0.4, half_backlash=1.0)
    (point,) = contact_grazing(osc, bounds=(0.42, 0.45)).points
    assert point.parameter == pytest.approx(0.43252601, rel=0, abs=5e-9)
    assert abs(point.parameter - 0.43701486) > 4e-3  # the printed value lies on the fold that follows


def test_lubricated_scan_from_both_ends():
    """As the article says: 1-0-0 first, 1-1-0 last, hysteresis from 0.5694 to 0.6556, 2-1-1 and 6-4-4 between."""
    osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    values = np.linspace(0.1, 2.1, 201)
    up, down = (sweep(osc, values=values, direction=d) for d in ("up", "down"))
    assert up.labels[0] == down.labels[0] == "1-0-0"
    assert up.labels[-1] == down.labels[-1] == "1-1-0"
    for value, low, high in ((0.60, "1-1-1", "1-0-0"), (0.56, "1-0-0", "1-0-0"), (0.67, "1-1-1", "1-1-1")):
        i = int(np.argmin(np.abs(values - value)))
        assert (down.labels[i], up.labels[i]) == (low, high)
    for label in ("2-1-1", "6-4-4"):
        assert label in up.labels
    assert "aperiodic" in up.labels
