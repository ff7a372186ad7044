"""Events of the loaded contact and the figures that follow from arcs between them, against brute force."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import fem
from base import SolverError
from gears import Gear, GearDeviations, GearPair, Material, PitchDeviations, TipRelief
from gears.sharing.mesh_arcs import CURVES

MANY = 1600

FLOOR = 1e-5
"""True errors below this are those of the reference, a tenth of its tolerance."""


def figures(cycle):
    """Figures by samples alone: means, peak to peak, two harmonics over the mean."""
    found = {
        "mean_stiffness": cycle.stiffness.mean(),
        "mean_secant_stiffness": cycle.secant_stiffness.mean(),
        "transmission_error_range": np.ptp(cycle.transmission_error),
    }
    pitches = round(cycle.position[-1])
    for name in ("stiffness", "secant_stiffness"):
        spectrum = np.abs(np.fft.rfft(getattr(cycle, name)))
        found[f"{name}_harmonics"] = 2 * spectrum[[pitches, 2 * pitches]] / spectrum[0]
    return found


@pytest.fixture(scope="module")
def relieved():
    relief = TipRelief(amount=12e-6, length=2.5e-3, form="linear")
    steel, plastic = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
    pair = GearPair(
        Gear(23, profile_shift=0.3, tip_relief=relief), Gear(47), 2e-3, 0.02, material=(steel, plastic)
    )
    return pair, fem.compliance(pair, tolerance=0.005)


def test_numbers_of_the_article_pair(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, reference="bore")
    assert cycle.transmission_error_range == pytest.approx(7.577e-6, abs=0.002e-6)
    np.testing.assert_allclose(
        cycle.stiffness_harmonics[:2], [0.026361, 0.006530], atol=5e-6
    )  # 12800 samples
    assert cycle.errors["transmission_error_range"] < 1e-3
    assert np.all(cycle.stiffness_harmonics_error[:2] < 0.01 * cycle.stiffness_harmonics[:2])
    # the samples alone miss 7 % of it
    assert np.ptp(cycle.transmission_error) < 0.95 * cycle.transmission_error_range


@pytest.mark.parametrize(
    ("torque", "options"),
    [
        (600.0, {}),
        (600.0, {"beyond_path": False}),
        (6.0, {}),
        (600.0, {"tip_rounding": 4e-5}),
        (600.0, {"friction": 0.1}),
        (1500.0, {}),
    ],
)
def test_figures_are_those_of_very_many_positions(article_pair, article_bodies, torque, options):
    # limits of the deflection against the bores: of a smaller one the same error is a larger part
    options = {**options, "reference": "bore"}
    few = fem.mesh_cycle(article_pair, torque, 4, article_bodies, **options)
    many = fem.mesh_cycle(article_pair, torque, MANY, article_bodies, **options)
    brute, arcs = figures(many), few.arcs.arcs
    for curve in CURVES:
        # each step is somewhere between two samples: half an interval of it, and the square of one for corners
        rows = np.array([arc.values[CURVES.index(curve), [0, -1]] for arc in arcs.arcs])
        steps = np.sum(np.abs(rows[:, 0] - np.roll(rows[:, 1], 1)))
        # at an event the tangent goes on as the inverse of a logarithm, of which the first sample shows more
        sampled, after = getattr(many, curve), np.searchsorted(many.position, few.event_position) % MANY
        steps = max(steps, np.sum(np.abs(sampled[after] - sampled[after - 1])))
        mean, error = arcs.mean(curve)
        allowed = error + 0.5 / MANY * steps + MANY**-2.0 * mean
        assert abs(mean - np.mean(getattr(many, curve))) < allowed
        found, errors = arcs.harmonics(curve, [1, 2])
        spectrum = np.fft.rfft(getattr(many, curve))[1:3] * 2 / MANY
        assert np.all(np.abs(np.abs(found) - np.abs(spectrum)) < errors + 2 * allowed)
        if curve != "transmission_error":
            assert getattr(few, f"mean_{curve}") == mean
            ratios = getattr(few, f"{curve}_harmonics")[:2]
            assert np.all(np.abs(ratios - brute[f"{curve}_harmonics"]) < 3 * (allowed + max(errors)) / mean)
        # a tenth of the tolerance is what the last coefficients may be, of which there are several; the tangent has the
        # tolerance itself where laws of edges change from strip to strip, and next to an event the inverse of a
        # logarithm, which no series follows evenly
        off = np.abs(arcs.curve(curve, many.position) / getattr(many, curve) - 1)
        near = np.min(np.abs(many.position[:, None] - few.event_position), axis=1) < 2e-3
        assert off.mean() < 1e-4
        assert off[~near].max() < (1e-3 if curve == "stiffness" else 2e-4)
        assert off.max() < (4e-3 if curve == "stiffness" else 2e-4)
    # the greatest is never beyond what is found, and at most one interval away from it
    missed = few.transmission_error_range - brute["transmission_error_range"]
    assert missed / few.transmission_error_range > -1e-7
    assert missed < np.max(np.abs(np.diff(many.transmission_error)))


def test_events_are_where_the_active_set_changes(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, MANY, article_bodies)
    turned = np.argwhere((cycle.forces[1:] > 0) != (cycle.forces[:-1] > 0))
    division = cycle.arcs.division
    switched = division.events.switched
    assert len(turned) == np.count_nonzero(switched >= 0) == 2
    for row, column in turned:
        (here,) = np.flatnonzero(switched == column)
        at = division.events.position[here]
        assert cycle.position[row] < at < cycle.position[row + 1]
        # a hair before and after, the force is there on one side only
        both = fem.contact.solver.solve_contact(
            cycle.problem.setup.at(np.array([at - 1e-7, at + 1e-7])),
            article_bodies,
            np.array([cycle.force]),
            None,
        )
        assert np.count_nonzero(both.share.forces[0, 0, :, column] > 0) == 1


def test_relief_and_pitch_deviations_over_several_pitches(relieved):
    pair, bodies = relieved
    rng = np.random.default_rng(3)
    deviations = [
        GearDeviations(pitch=PitchDeviations.from_single(rng.normal(0, 3e-6, gear.teeth)))
        for gear in (pair.pinion, pair.wheel)
    ]
    options = {"deviations": deviations, "pitches": 3, "first_teeth": (2, 5)}
    few = fem.mesh_cycle(pair, 4.0, 8, bodies, **options)
    many = fem.mesh_cycle(pair, 4.0, MANY, bodies, **options)
    brute = figures(many)
    assert few.arcs.division.events.position[-1] == 3.0
    for name in ("mean_stiffness", "mean_secant_stiffness", "transmission_error_range"):
        assert getattr(few, name) == pytest.approx(brute[name], rel=2e-3)
    np.testing.assert_allclose(few.stiffness_harmonics[:2], brute["stiffness_harmonics"], atol=4e-4)


def test_a_film_in_series(article_pair, article_bodies):
    def film(rho1, forces):
        size = 1 + np.maximum(forces, 0.0) / 2000.0
        return 1e-6 * size**-0.13, -1e-6 * 0.13 / 2000.0 * size**-1.13

    few = fem.mesh_cycle(article_pair, 600.0, 4, article_bodies, film=film)
    brute = figures(fem.mesh_cycle(article_pair, 600.0, MANY, article_bodies, film=film))
    for name in ("mean_stiffness", "mean_secant_stiffness", "transmission_error_range"):
        assert getattr(few, name) == pytest.approx(brute[name], rel=1e-3)


def test_arcs_travel_without_what_they_are_found_from(article_pair, article_bodies):
    def film(rho1, forces):
        return np.full_like(forces, 1e-7), np.zeros_like(forces)

    cycle = fem.mesh_cycle(article_pair, 600.0, 8, article_bodies, film=film)
    copy = pickle.loads(pickle.dumps(cycle))
    assert copy.problem is None
    assert copy.transmission_error_range == cycle.transmission_error_range
    assert copy.mean_stiffness == cycle.mean_stiffness


def test_a_contact_without_a_solution_has_no_figures(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 2e6, 8, article_bodies)
    assert not cycle.converged
    assert np.isnan(cycle.transmission_error_range)
    assert cycle.errors["transmission_error_range"] is None


def test_more_than_the_mean_may_err_in_the_peak_to_peak(article_pair):
    """Each figure's own estimate against a fine mesh: on a coarse one they err differently."""
    from meshes import Sizes

    rough = fem.compliance(article_pair, sizes=Sizes().scaled(1.6), refinements=1)
    fine = fem.compliance(article_pair, refinements=2)
    first, second = (
        fem.mesh_cycle(article_pair, 600.0, 8, bodies, tolerance=1e-4) for bodies in (rough, fine)
    )
    for name, found in first.errors.items():
        true = abs(getattr(first, name) / getattr(second, name) - 1)
        assert found > 0.8 * true, name
        assert found < 5 * true + FLOOR, name


def test_no_solution_between_the_positions_is_said(article_pair, article_bodies):
    """At four positions no tip edge presses too hard, but between them one does."""
    cycle = fem.mesh_cycle(article_pair, 24e3, 4, article_bodies)
    assert cycle.converged
    copy = pickle.loads(pickle.dumps(cycle))
    for one in (cycle, copy, cycle.against("teeth")):
        for name in ("mean_stiffness", "errors", "stiffness_harmonics", "event_position"):
            with pytest.raises(SolverError, match=r"between the positions .* a tip edge presses"):
                getattr(one, name)
        assert "MeshCycle(torque 24000 N m, converged" in repr(one).replace(f", error {one.error:.1e}", "")


def test_third_order_energies_wait_until_they_are_asked_for(article_pair, no_gear_solved):
    bodies = fem.compliance(article_pair, tolerance=0.005)
    cycle = fem.mesh_cycle(article_pair, 600.0, 8, bodies)
    assert cycle.mean_stiffness > 0
    assert "motions" not in vars(bodies)
    assert 0 < cycle.model_error < 0.01
    assert pickle.loads(pickle.dumps(cycle)).model_error == cycle.model_error
    moving = fem.mesh_cycle(article_pair, 600.0, 8, bodies, moving_contact=True)
    assert moving.model_error < cycle.model_error


def test_laws_of_tip_edges_are_computed_once(article_pair, article_bodies, monkeypatch):
    """For either corner, whatever the pitch and the torque, on both meshes of an estimate."""
    from fem.laws import corner_laws, corner_surface

    corner_laws.forget_laws()
    asked, laws = [], corner_surface.edge_laws

    def counted(pair, strips, corner, rho1, *others, **more):
        asked.extend((id(strips), corner, round(one / article_pair.base_pitch, 12)) for one in rho1)
        return laws(pair, strips, corner, rho1, *others, **more)

    monkeypatch.setattr(corner_surface, "edge_laws", counted)
    cycles = fem.mesh_cycle(article_pair, (300.0, 600.0), 10, article_bodies, pitches=3)
    for cycle in cycles:
        assert cycle.errors["transmission_error_range"] > 0
    once = len(asked)
    assert once == len(set(asked))
    assert len({mesh for mesh, *_ in asked}) == 4
    one = fem.mesh_cycle(article_pair, 600.0, 10, article_bodies)
    assert one.transmission_error_range == pytest.approx(cycles[1].transmission_error_range, rel=1e-6)
    assert len(asked) == once > 0


@pytest.mark.slow
def test_greatest_load_share_is_that_of_very_many_positions(relieved):
    """With relief and a load so light that two pairs bear nearly always; sampled shares miss the steps."""
    pair, bodies = relieved
    few, many = (fem.mesh_cycle(pair, 1.0, n, bodies) for n in (4, 4000))
    assert few.greatest_load_share == pytest.approx(np.max(many.load_share), abs=2e-4)
    assert few.greatest_load_share >= np.max(many.load_share) - 1e-6
    assert few.errors["greatest_load_share"] < 1e-3
