"""Errors of helical cycles: what is doubtful of free ends, when it is looked at, and what is believed."""

from __future__ import annotations

from dataclasses import replace
from math import radians, sqrt
from typing import Any

import numpy as np
import pytest

from base import Array
from base.later import known
from base.results import WORST
from fem import MeshCycle, PairCompliance, compliance, mesh_cycle
from fem.contact import shared_contacts
from fem.contact.face_errors import cell_errors, half_as_many
from fem.elasticity.lengthened import FacePieces
from fem.influence.flank_variable import FlankVariable
from fem.influence.helix_ends import BETWEEN, FEWER, OF_ENDS, OFF_BY, PLACES, HelixEnds, _Effect
from fem.influence.helix_lines import ContactLine
from fem.pair.face_setting import FaceSetting
from gears import Alignment, Gear, GearPair
from gears.sharing.mesh_arcs import MeshArcs, Scatter

SPUR = GearPair(Gear(20), Gear(20), module=2e-3, face_width=12e-3).with_backlash(100e-6)
SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
PIECES, PLACE = FacePieces(np.array([0.0, 0.5, 2.0])), FlankVariable((3.0, 9.0))
RHO = np.array([3.0, 4.1, 5.2, 7.4, 9.0])


def _ends(orders: int) -> HelixEnds:
    """Of chance answers whose orders along the flank are below a number."""
    rng, n = np.random.default_rng(5), PIECES.functions
    table = rng.normal(size=(PLACES, n, PLACES, n))
    table[orders:], table[:, :, orders:] = 0.0, 0.0
    whole = (table + table.transpose(2, 3, 0, 1)).reshape(PLACES * n, -1)
    return HelixEnds((_Effect(0.0, 1, PIECES, PLACE, {0: whole}),), RHO)


def _line(rho: Array) -> ContactLine:
    return ContactLine(0, np.linspace(0.1, 1.9, len(rho)), rho, 0.2)


def _apart(orders: int, doubt: str, rho: Array) -> float:
    """What a doubt changes, in parts of the largest answer."""
    ends, line = _ends(orders), _line(rho)
    known, off = (each.between(line, line) for each in (ends, ends.off_by(doubt)))
    return float(np.abs(off - known).max() / np.abs(known).max())


def test_at_the_places_of_loads_only_the_order_is_doubtful() -> None:
    assert _apart(PLACES, BETWEEN, RHO) < 1e-12
    assert _apart(PLACES, FEWER, RHO) > 0.01


@pytest.mark.parametrize(("orders", "doubt"), [(2, BETWEEN), (PLACES - 1, FEWER)])
def test_what_is_as_simple_as_the_doubt_says_is_not_doubtful(orders: int, doubt: str) -> None:
    """Straight lines have what is linear along the flank, and a lower order what has no higher one."""
    between = 0.5 * (RHO[1:] + RHO[:-1])
    assert _apart(orders, doubt, between) < 1e-12
    assert _apart(PLACES, doubt, between) > 0.01


def test_on_lines_all_that_half_as_many_cells_change_is_error() -> None:
    (_, face), (_, line) = (half_as_many(FaceSetting(64), helical) for helical in (False, True))
    assert line == 1.0
    assert face == pytest.approx(1.0 / sqrt(3.0))


@pytest.fixture(scope="module")
def spur() -> MeshCycle:
    bodies = compliance(SPUR, tolerance=0.02)
    return mesh_cycle(SPUR, 60.0, 4, bodies, cells=16, alignment=Alignment(20e-6), beyond_path=False)


def test_errors_are_looked_for_once_and_not_between_positions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Arcs solve the contact at many more positions, whose errors nobody asks for."""
    asked = []
    monkeypatch.setattr(
        shared_contacts, "cell_errors", lambda *given: asked.append(given) or cell_errors(*given)
    )
    bodies = compliance(SPUR, tolerance=0.02)
    found = mesh_cycle(
        SPUR, 60.0, 4, bodies, cells=16, alignment=Alignment(20e-6), face_model="walls", beyond_path=False
    )
    assert len(asked) == 1
    assert found.errors
    assert len(asked) == 1


def with_fewer(known_arcs: MeshArcs, **changes: Any) -> MeshArcs:
    """Arcs that are compared with others of fewer cells."""
    compared = known_arcs.compared
    assert compared.fewer is not None
    return replace(known_arcs, others=known(replace(compared, fewer=replace(compared.fewer, **changes))))


def test_free_ends_change_ranges_and_harmonics_but_no_mean(spur: MeshCycle) -> None:
    """Of helical gears: the mean's part is a further error of all figures."""
    arcs = spur.arcs
    assert arcs is not None
    few = arcs.compared.fewer
    assert few is not None
    quiet = with_fewer(arcs, ends=(few.arcs, 4.0), ends_scatter={})
    scatter = {"transmission_error": Scatter(9e-6, 5e-6, 1e-6)}
    loud = with_fewer(quiet, ends_scatter=scatter)
    off = with_fewer(quiet, ends=(arcs.compared.before, 1.0))
    for name in ("transmission_error", "stiffness"):
        assert quiet.range(name).error == arcs.range(name).error
        assert loud.mean(name).error == off.mean(name).error == arcs.mean(name).error
    known, told = arcs.range("transmission_error").error, loud.range("transmission_error").error
    assert told == pytest.approx(np.hypot(known, 5e-6), rel=1e-12)
    size = loud.extreme("transmission_error", greatest=True)
    assert size.error == pytest.approx(np.hypot(arcs.extreme("transmission_error", True).error, 9e-6))
    orders = np.array([1, 2])
    assert np.all(off.harmonics("stiffness", orders)[1] > arcs.harmonics("stiffness", orders)[1])
    assert off.range("stiffness").error > arcs.range("stiffness").error


def test_harmonics_that_do_not_change_by_chance_are_as_doubtful_as_positions(spur: MeshCycle) -> None:
    """A part of the range that free ends move, and what cells change at positions."""
    arcs, orders, name = spur.arcs, np.array([1, 2, 5]), "transmission_error"
    assert arcs is not None
    few = arcs.compared.fewer
    assert few is not None
    none = Scatter(0.0, 0.0, 0.0)
    quiet = with_fewer(arcs, scatter={name: none}, ends=(few.arcs, 4.0))
    ends = with_fewer(quiet, ends_scatter={name: Scatter(9e-6, 6e-6, 1e-6)})
    cells = with_fewer(quiet, arcs=arcs.arcs, scatter={name: Scatter(9e-6, 6e-6, 0.0)})
    known, told = (each.harmonics(name, orders)[1] for each in (quiet, ends))
    assert np.allclose(told, np.hypot(known, 6e-6 / np.array([3, 3, 6])), rtol=1e-12)
    assert np.all(cells.harmonics(name, orders)[1] >= 6e-6)
    mean = arcs.mean(name).value
    known, told = (each.over_mean(name, orders)[1] for each in (quiet, ends))
    assert np.allclose(told, np.hypot(known, 6e-6 / mean / np.array([3, 3, 6])), rtol=1e-12)


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


@pytest.mark.slow
def test_doubts_of_free_ends_move_answers_by_about_their_errors(bodies: PairCompliance) -> None:
    """Gears that are off by either doubt, solved as others are: a cycle tells of what they change."""
    usual = mesh_cycle(SMALL, 8.0, 6, bodies, cells=32)
    assert usual.converged
    assert usual.lines is not None
    for doubt in OF_ENDS:
        off = mesh_cycle(SMALL, 8.0, 6, bodies.doubtful(doubt), cells=32)
        assert off.lines is not None
        apart = (off.lines.load_centre - usual.lines.load_centre) / OFF_BY
        assert 0.0 < np.sqrt(np.mean(apart**2)) < 1.5 * usual.lines.centre_error
        mean = abs(off.secant_stiffness.mean() / usual.secant_stiffness.mean() - 1.0) / OFF_BY
        assert 0.0 < mean < (5.0 if doubt == BETWEEN else 1.5) * usual.errors["mean_secant_stiffness"]
        if doubt == BETWEEN:
            changed = abs(np.ptp(off.transmission_error) / np.ptp(usual.transmission_error) - 1.0) / OFF_BY
            assert changed < 1.5 * usual.errors["transmission_error_range"]
            factors = [each.lines.greatest_line_load_factor for each in (off, usual)]
            assert abs(factors[0] / factors[1] - 1.0) / OFF_BY < 1.5 * usual.lines.error


@pytest.mark.slow
def test_no_figure_is_believed_whose_error_is_too_large(
    bodies: PairCompliance, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of a compliance: not converged from `base.results.WORST` on, whatever the figures look like."""
    for ends, believed in ((0.9 * WORST, True), (WORST, False)):

        def off(*given, ends=ends):
            errors = cell_errors(*given)
            return replace(errors, ends=np.full_like(errors.ends, ends), relative=0.0 * errors.relative)

        monkeypatch.setattr(shared_contacts, "cell_errors", off)
        found = mesh_cycle(SMALL, 8.0, 4, bodies, cells=16)
        assert found.converged == believed
        assert ("no figure is believed: give a wider face" in found.message) != believed
