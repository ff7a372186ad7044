"""Reported against true error of the figures of a mesh cycle over random pairs."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from gears import Gear, GearPair, Material, TipRelief
from meshes import Sizes

ROUNDING = 1e-7
"""Differences of figures below which they say nothing."""

STEEL, PLASTIC = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)


def drawn(rng):
    """A pair, its torque and how it is set up."""
    teeth, shifts = rng.integers(17, 80, 2), rng.uniform(-0.1, 0.4, 2)
    relief = (
        TipRelief(rng.uniform(5e-6, 3e-5), rng.uniform(1e-3, 3e-3), str(rng.choice(["linear", "parabolic"])))
        if rng.random() < 0.4
        else None
    )
    soft = rng.random() < 0.2
    gears = [
        Gear(int(z), profile_shift=float(x), tip_relief=relief) for z, x in zip(teeth, shifts, strict=True)
    ]
    pair = GearPair(*gears, 2e-3, 0.04, material=(STEEL, PLASTIC) if soft else STEEL)
    torque = 600.0 * teeth[0] / 36 * rng.choice([1.0, 0.1, 0.02]) * (0.015 if soft else 1.0)
    options = {
        "friction": 0.08 if rng.random() < 0.2 else 0.0,
        "beyond_path": bool(rng.random() < 0.8),
    }
    return pair, float(torque), options


@pytest.mark.long
@pytest.mark.slow
def test_reported_errors_are_those_of_a_much_finer_mesh():
    rng, ratios = np.random.default_rng(7), {}
    for _ in range(8):
        pair, torque, options = drawn(rng)
        usual = fem.mesh_cycle(pair, torque, 8, fem.compliance(pair), **options)
        fine = fem.compliance(pair, refinements=3)
        best = fem.mesh_cycle(pair, torque, 8, fine, tolerance=1e-5, **options)
        for name, error in usual.errors.items():
            true = abs(getattr(usual, name) / getattr(best, name) - 1)
            if true > ROUNDING:  # a pair that bears alone has all of the load on every mesh
                ratios.setdefault(name, []).append(error / true)
    for name, found in ratios.items():
        assert min(found) > 0.5, (name, found)
        if name.startswith("mean") or name.endswith("range"):
            assert max(found) < 5, (name, found)


@pytest.mark.parametrize("torque", [200.0, 600.0])
def test_errors_hold_where_the_elements_at_a_corner_do_not_resolve_its_edge(article_pair, torque):
    """With the strips of the finer mesh in both, the tangent of an edge that barely touches had 0.07 of its error."""
    pair, sizes = article_pair, Sizes(corner=0.4, growth=1.5)
    usual = fem.mesh_cycle(pair, torque, 8, fem.compliance(pair, sizes=sizes, refinements=1))
    best = fem.mesh_cycle(pair, torque, 8, fem.compliance(pair, refinements=2), tolerance=1e-5)
    for name, error in usual.errors.items():
        if name == "greatest_load_share":  # hardly depends on the mesh
            continue
        true = abs(getattr(usual, name) / getattr(best, name) - 1)
        assert 0.5 < error / true < 5, name
