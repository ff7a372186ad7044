"""Pictures of the documentation and of the scripts of motion: units, nothing covered, nothing cut off."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import dynamics
from flankfilm.bench import pictures as bench
from flankfilm.bench.measuring import measure
from tests.example_scripts import example
from tests.flankfilm.pictured import OSCILLATOR, RECORDS, faults_of, orbit, values
from tests.flankfilm.test_bench import second_order
from tests.flankfilm.test_gallery import QUICK


@pytest.fixture(scope="module")
def drawing() -> ModuleType:
    return example("drawing")


def test_a_diagram_with_what_sweeps_met(drawing: ModuleType):
    diagram = RECORDS["dynamics.attraction.diagrams:Diagram"]()
    met = RECORDS["dynamics.attraction.multi_sweeps:MultiSweep"]()
    assert faults_of(drawing.diagram_figure(diagram, met, "mesh frequency")) == []


def test_exponents_of_sweeps(drawing: ModuleType):
    rows = np.column_stack([values(3), [-0.1, 0.02, -0.05], [-0.2, -0.3, -0.2], [0.01, 0.02, 0.01]])
    assert faults_of(drawing.exponent_figure([("up", rows), ("down", rows)], "mesh frequency")) == []


def test_portraits(drawing: ModuleType):
    motion = dynamics.trajectory(OSCILLATOR, orbit().state)
    named = [(f"{k}-1-0 at 0.6 (0.55 to 0.65)", motion) for k in range(1, 5)]
    assert faults_of(drawing.portrait_figure(named, OSCILLATOR.half_backlash)) == []


def test_basins_with_many_unstable_orbits(drawing: ModuleType):
    basins = RECORDS["dynamics.attraction.basins:BasinResult"]()
    unstable = [(f"U{k}-1-0", np.array([[0.1 * k, 0.1]])) for k in range(1, 13)]
    assert faults_of(drawing.basin_figure(basins, unstable, [], "frequency = 0.6")) == []


def test_error_against_cost():
    measured = measure("own", second_order(), repeat=1)
    for picture in (
        bench.error_against_cost(measured),
        bench.overview([measured]),
        bench.estimates([measured]),
    ):
        assert faults_of(picture) == []


def test_the_single_contact_and_the_deflections_of_the_article():
    script = example("article_figures", "../docs")
    assert faults_of(script.contact()) == []
    assert faults_of(script.deflection()) == []


def test_a_title_without_a_unit_is_seen(drawing: ModuleType):
    rows = np.column_stack([values(3), np.zeros((3, 2)), np.full(3, 0.01)])
    figure = drawing.exponent_figure([("up", rows), ("down", rows)], "mesh frequency")
    figure.axes[0].set_xlabel("mesh frequency")
    assert faults_of(figure) == ["'mesh frequency' has no unit"]


@pytest.mark.parametrize("name", sorted(QUICK))
def test_quick_scripts_of_the_gallery(name: str):
    assert faults_of(example(name, "gallery").draw()) == []
