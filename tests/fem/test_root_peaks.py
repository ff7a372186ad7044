"""Greatest stress between the nodes of arcs and the samples of a fillet, of a bump whose top is known."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from fem.stress.root_peaks import LOADED, OTHER, RootNodes
from gears.sharing.arcs import Arc, Arcs

LINE = SimpleNamespace(arc=np.linspace(0.0, 1e-3, 81))
CORNER = 0.35


def nodes(bump, degree=8):
    """Stress by a law of position and arc length, on two arcs that meet in a corner."""
    bounds = (0.0, CORNER, 1.0)
    arcs = tuple(Arc(low, high, np.zeros((1, degree + 1))) for low, high in pairwise(bounds))
    position = np.concatenate([arc.position for arc in arcs])
    one = bump(position[:, None], LINE.arc[None])
    # a tooth whose greatest stress jumps along the fillet half way, a little less than the greatest of all
    other = 0.97 * np.where(LINE.arc > 5e-4, 1.0 - 0.2 * position[:, None], 0.8 + 0.2 * position[:, None])
    both = np.stack([np.stack([one, -one], axis=1), np.stack([other, -other], axis=1)], axis=1)
    return RootNodes(Arcs(("none",), arcs, 1), position, both)


@pytest.mark.parametrize("top", [0.55, 0.613, 0.7, 0.81])
@pytest.mark.parametrize("side", [LOADED, OTHER])
def test_a_top_between_nodes_is_met(top, side):
    """It moves along the fillet, as stresses do; the greatest of the nodes is too low by up to its bend."""

    def bump(x, s):
        return np.exp(-2.0 * (x - top) ** 2) * (1.0 - 0.5 * ((s - 4e-4) / 1e-4 - 2.0 * (x - top)) ** 2)

    found = nodes(bump, 16).greatest(LINE, side)
    assert found.value == pytest.approx(1.0, rel=2e-5)
    assert (found.tooth, found.position) == (0, pytest.approx(top, abs=3e-3))
    assert found.off < 1e-4
    assert abs(found.value - 1.0) < 5.0 * found.off + 1e-6 or found.off == 0.0


def test_a_corner_is_met_exactly():
    def bump(x, s):
        return (1.0 - np.abs(x - CORNER)) * (1.0 - ((s - 4e-4) / 2e-4) ** 2)

    found = nodes(bump).greatest(LINE, LOADED)
    assert found.value == pytest.approx(1.0, rel=1e-12)
    assert (found.position, found.off) == (pytest.approx(CORNER, abs=1e-12), 0.0)
