"""From which error on the finest mesh a compliance and fillets have not converged."""

from __future__ import annotations

import pytest

from base.results import WORST
from fem import compliance, fillets
from fem.pair import compliance as pair_compliance
from fem.pair import pair_fillets
from gears import Gear, GearPair

PAIR = GearPair(Gear(teeth=20), Gear(teeth=21), module=2e-3, face_width=20e-3)


def test_errors_from_a_fifth_on_are_no_results():
    assert WORST == 0.2
    for module in (pair_compliance, pair_fillets):
        assert module.WORST is WORST


def test_a_compliance_above_the_bound_has_not_converged(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(pair_compliance, "_errors", lambda *_: (0.25, 0.0))
    monkeypatch.setattr(pair_compliance, "_finer", lambda *_: None)
    found = compliance(PAIR, tolerance=0.05)
    assert not found.converged
    assert "the mesh is the finest allowed; from 20% on no figure is believed" in found.message
    assert not compliance(PAIR, tolerance=0.5).converged
    assert compliance(PAIR, tolerance=0.05, refinements=1).converged
    monkeypatch.setattr(pair_compliance, "_errors", lambda *_: (0.19, 0.0))
    kept = compliance(PAIR, tolerance=0.05)
    assert kept.converged
    assert kept.error == pytest.approx(0.19)
    assert kept.message.endswith("above the tolerance 5.0e-02: the mesh is the finest allowed")


def test_fillets_above_the_bound_have_not_converged(monkeypatch: pytest.MonkeyPatch):
    found = fillets(PAIR, tolerance=0.1)
    assert found.converged
    monkeypatch.setattr(pair_fillets, "WORST", 0.5 * found.error)
    above = fillets(PAIR, tolerance=0.1)
    assert not above.converged
    assert "no figure is believed: lower the tolerance" in above.message
    assert fillets(PAIR, tolerance=0.1, fillet_edge=0.16).converged
