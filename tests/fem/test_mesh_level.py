"""Meshes that errors compare: an answer and its error are the same, whatever else has been asked for before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from gears import Gear, GearPair

PAIR = GearPair(Gear(24, bore_radius=0.008), Gear(31), 2e-3, 0.04)
FIGURES = ("mean_stiffness", "mean_secant_stiffness", "transmission_error_range", "greatest_stiffness")


@pytest.fixture(scope="module")
def bodies():
    return fem.compliance(PAIR, tolerance=0.01)


def figures(cycle):
    return [getattr(cycle, name) for name in FIGURES] + [cycle.errors[name] for name in FIGURES]


@pytest.mark.parametrize("asked", ["tips", "motions", "back_flanks"])
def test_the_coarser_mesh_is_the_same_whatever_has_been_asked_of_the_finer_one(bodies, asked):
    new, used = replace(bodies), replace(bodies)
    getattr(used, asked)
    for one, other in zip(new.coarser.tips, used.coarser.tips, strict=True):
        for name in ("kernel", "mixed", "tangential"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    # and it is not the mesh in use
    assert not np.array_equal(new.coarser.tips[0].kernel, bodies.tips[0].kernel)


@pytest.fixture(scope="module")
def used(bodies):
    """Bodies that have answered for other loads, and on all of their meshes."""
    asked = replace(bodies)
    figures(fem.mesh_cycle(PAIR, 500.0, 4, asked, moving_contact=True))
    figures(fem.mesh_cycle(PAIR, 200.0, 4, asked))
    _ = asked.coarser, asked.back_flanks
    return asked


@pytest.mark.parametrize("options", [{}, {"moving_contact": True}, {"beyond_path": False}])
def test_figures_and_errors_do_not_depend_on_what_was_asked_before(bodies, used, options):
    def asked(one):
        return figures(fem.mesh_cycle(PAIR, 300.0, 4, one, **options))

    assert asked(replace(bodies)) == asked(used)


def test_a_cycle_against_something_else_is_the_same_before_and_after_its_arcs_are_known(bodies):
    new, used = (fem.mesh_cycle(PAIR, 300.0, 8, bodies, reference="bore") for _ in range(2))
    assert used.arcs is not None
    assert figures(new.against("teeth")) == figures(used.against("teeth"))
    assert figures(new.against("teeth").against("body")) == figures(used.against("teeth").against("body"))
