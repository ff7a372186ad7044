"""Why CalculiX presses more on a tip edge that just touches: its elements are ten times as wide as the contact.

Reference: the two-gear model of test_fem_two_gear_contact_model (elements of 0.03 mm), 33 of 443 N/mm on the neighbour
behind with a pair at C, 15.67 N/(mm um). Its corner is where ours is, but its pressure cannot be narrower than an
element. Our strips made as wide as that press as it does; a rounded corner, which takes material off, goes the
other way.
"""

from __future__ import annotations

import importlib
from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.elasticity.ring import mesh_and_factor
from fem.laws.local_law import Table
from meshes import Sizes
from tests.validation.article import PER_MM_UM


def at_pitch_point(pair, cycle):
    C = (pair.points.C - pair.points.A) / pair.base_pitch
    edge = np.where(cycle.edge, cycle.forces, 0.0).max(axis=1) / 40.0
    return (
        float(np.interp(C, cycle.position, cycle.secant_stiffness) / PER_MM_UM),
        float(np.interp(C, cycle.position, edge)),
    )


def test_strips_as_wide_as_elements_press_as_elements_do(article_pair, monkeypatch):
    bodies = fem.compliance(article_pair)
    rings = mesh_and_factor(article_pair, "strain", Sizes(), 1)
    tip = importlib.import_module("fem.influence.tip_strips")
    # no contact is narrower than the strip at the corner: its law does not go on to nothing
    through = Table.through
    monkeypatch.setattr(
        importlib.import_module("fem.laws.tip_contact"), "begun", lambda force, approach: (force, approach)
    )
    monkeypatch.setattr(Table, "through", lambda force, approach, _: through(force, approach, smooth=False))
    stiffness, force = [], []
    for width in (0.2e-6, 10e-6, 30e-6, 60e-6):
        monkeypatch.setattr(tip, "FIRST_EDGE", width / article_pair.module)
        monkeypatch.setattr(
            tip, "RESOLVED", min(0.01, 0.2 * width / article_pair.module) if width > 1e-6 else 0.01
        )
        tips = [tip.tip_strips(*both) for both in zip(rings, article_pair.teeth_profiles, strict=True)]
        cycle = fem.mesh_cycle(
            article_pair, 600.0, 200, replace(bodies, tip_strips=tuple(tips)), reference="bore"
        )
        k, edge = at_pitch_point(article_pair, cycle)
        stiffness.append(k)
        force.append(edge)
    assert np.all(np.diff(stiffness) > 0)
    assert np.all(np.diff(force) > 0)
    assert stiffness[2] == pytest.approx(15.67, rel=0.003)  # sharp: 0.25 % below
    assert abs(33.0 - force[2]) < 1 / 3 * (33.0 - force[0])  # at least two thirds of the way


def test_a_round_edge_presses_less(article_pair):
    bodies = fem.compliance(article_pair)
    found = [
        at_pitch_point(
            article_pair, fem.mesh_cycle(article_pair, 600.0, 200, bodies, tip_rounding=r, reference="bore")
        )
        for r in (0.0, 20e-6, 50e-6)
    ]
    assert found[0][0] > found[1][0] > found[2][0]
    assert found[0][1] > found[1][1] > found[2][1]
