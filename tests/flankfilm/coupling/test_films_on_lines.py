"""Films and losses on lines of contact: single contacts by hand, closed forms, energy, mirror, the spur limit."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import ehl
import fem
from base import Array
from fem.laws.line_candidates import contact_lines, line_offsets
from flankfilm import coupling
from flankfilm.coupling import FilmModel, Flanks, LoadedTeeth, LubricatedCycle, lubricate
from flankfilm.coupling.films.line_contacts import line_contacts, with_sliding
from flankfilm.coupling.films.most_loaded import most_loaded
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.coupling.losses.mean_losses import means_of
from flankfilm.coupling.mesh.cells import cells_of
from flankfilm.coupling.mesh.resolution import resolution_of
from gears import Gear, GearPair, closed_form

PAIR = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=math.radians(18.0))
OIL = ehl.Lubricant(0.05, 19e-9, 870.0, temperature=353.15, eyring_stress=5e6)
SPEED, TORQUE = 300.0, 8.0
HELD = Flanks(beyond_path=False, cells=24)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.02)


def lubricated(bodies: fem.PairCompliance, model: FilmModel, positions: int = 12) -> LubricatedCycle:
    teeth = LoadedTeeth(bodies.pair, TORQUE, compliance=bodies, flanks=HELD)
    return lubricate(teeth, teeth.cycle(positions), SPEED, OIL, resolution_of(0.01), model, profiles=False)


@pytest.fixture(scope="module")
def solved(bodies: fem.PairCompliance) -> LubricatedCycle:
    return lubricated(bodies, FilmModel())


def by_hand(rho1: float, load: float) -> ehl.LineContact:
    """Contact across a line, with the numbers of the section."""
    beta, alpha_n = math.radians(18.0), math.radians(20.0)
    alpha = math.atan(math.tan(alpha_n) / math.cos(beta))
    base = math.atan(math.tan(beta) * math.cos(alpha))
    rho2 = 0.5 * 41e-3 / math.cos(beta) * math.sin(alpha) - rho1
    u1, u2 = SPEED * rho1, SPEED * 18 / 23 * rho2
    return ehl.LineContact(
        load=load,
        entrainment=0.5 * (u1 + u2),
        sliding=u1 - u2,
        radius=rho1 * rho2 / (rho1 + rho2) / math.cos(base),
        reduced_modulus=PAIR.reduced_modulus,
        lubricant=OIL,
    )


def test_contacts_are_those_across_the_line():
    rho1 = np.linspace(PAIR.points.A, PAIR.points.E, 5)
    load = np.linspace(1e5, 3e5, 5)
    found = with_sliding(PAIR, rho1, line_contacts(PAIR, rho1, load, SPEED, OIL), SPEED)
    for contact, place, force in zip(found, rho1.tolist(), load.tolist(), strict=True):
        hand = by_hand(place, force)
        for name in ("load", "entrainment", "sliding", "radius", "reduced_modulus"):
            assert getattr(contact, name) == pytest.approx(getattr(hand, name), rel=1e-12, abs=1e-12), name


def even_lines(pair: GearPair, positions: int, cells: int) -> SimpleNamespace:
    """Cycle whose load is even over the length of all lines, whatever the bodies yield."""
    offset, slope = line_offsets(pair), pair.helix.base_tangent
    position = (np.arange(positions) + 0.5) / positions
    middle = pair.points.A + (position[:, None] + offset) * pair.base_pitch
    lines = contact_lines(pair, slope, (pair.points.A, pair.points.E), middle)
    parts, cosine = lines.divided(cells), pair.helix.base_cosine
    length = np.where(lines.touches, parts.length, 0.0) / cosine
    whole = (length * parts.count).sum(axis=1)
    load = np.broadcast_to((pair.normal_force(TORQUE) / whole)[:, None, None], parts.z.shape)

    def used(values: Array) -> Array:
        return np.where(parts.used, values, np.nan)

    loads = SimpleNamespace(
        line_load=used(load),
        rho=np.stack([used(each) for each in parts.rho]),
        length=length,
        inside=parts.used,
        on_path=parts.used.astype(float),
    )
    return SimpleNamespace(lines=loads, face=None, position=position, contact=None)


class ConstantFriction(HeatedTable):
    """Films that all have one friction."""

    def at(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        return np.full(rho1.shape, {"friction": 0.05, "rolling": 0.0, "first_part": 0.5}[figure])


@pytest.mark.parametrize("overlap", [1.0, 2.0, 1.37])
def test_a_constant_friction_loses_what_the_closed_form_says(overlap):
    """Even load: H_V = pi (1/z1 + 1/z2) (eps_1^2 + eps_2^2)/(eps_alpha cos(beta_b)), at whole overlap ratios."""
    width = overlap * math.pi * PAIR.module / math.sin(PAIR.helix_angle)
    pair = replace(PAIR, face_width=width)
    assert pair.overlap_ratio == pytest.approx(overlap)
    table = ConstantFriction(np.zeros(1), np.zeros(1), (), (350.0, 350.0))
    power = TORQUE * SPEED
    means = means_of(pair, even_lines(pair, 64, 400), SPEED, power, table)
    points, pitch = pair.points, pair.base_pitch
    first, second = (points.E - points.C) / pitch, (points.C - points.A) / pitch
    factor = (
        math.pi * (1 / 18 + 1 / 23) * (first**2 + second**2) / pair.contact_ratio / pair.helix.base_cosine
    )
    # between whole overlap ratios the length, and with it the load, changes over the cycle
    assert means.loss_factor == pytest.approx(factor, rel=2e-4 if overlap != 1.37 else 0.02)
    assert means.sliding_loss == pytest.approx(0.05 * means.loss_factor * power, rel=1e-12)
    assert means.friction == pytest.approx(0.05, rel=1e-12)
    # two pairs that share evenly and one alone lose less: the load is at C more often than evenly
    assert 0.6 < closed_form.ohlendorf_loss_factor(pair) / means.loss_factor < 1.0


@pytest.mark.slow
class TestFilms:
    def test_each_cell_has_the_film_of_a_single_contact(self, solved):
        films = solved.over_lines
        assert films is not None
        known = np.argwhere(films.counts & np.isfinite(films.minimum_thickness))
        error = films.error + 0.01
        for at in known[:: len(known) // 4]:
            place = tuple(at)
            contact = by_hand(float(films.rho[0][place]), float(films.line_load[place]))
            single = ehl.solve(contact, tolerance=0.01)
            assert films.minimum_thickness[place] == pytest.approx(single.minimum_thickness, rel=error)
            assert films.hertz_pressure[place] == pytest.approx(contact.peak_pressure, rel=1e-9)
            assert films.half_width[place] == pytest.approx(contact.half_width, rel=1e-9)

    def test_the_minimum_is_that_of_cells_away_from_ends(self, solved):
        films = solved.over_lines
        assert films is not None
        there = films.minimum_thickness[films.counts]
        assert films.least_film == np.nanmin(there)
        assert films.end_zone == pytest.approx(0.5e-3)
        away = np.abs(films.z[films.counts])
        assert away.max() <= 0.5 * PAIR.face_width - films.end_zone * PAIR.helix.base_cosine
        assert solved.thinnest_film == pytest.approx(films.least_film, rel=0.01 + solved.thinnest_film_error)

    def test_forces_carry_the_torque_with_films(self, solved):
        across = solved.lines.force.sum(axis=(1, 2)) * PAIR.helix.base_cosine
        assert across == pytest.approx(TORQUE / PAIR.base_radii[0], rel=1e-9)

    def test_films_soften_the_mesh_by_their_own_slopes(self, solved):
        """In series: by the mean over the load of what films give way per load, to the first order."""
        cells, table = cells_of(solved), solved.over_lines.table
        slope = -table.at("separation", np.nan_to_num(cells.rho1), np.maximum(cells.line_load, 1.0), 1)
        softness = np.where(cells.bear, slope * cells.line_load * cells.force, 0.0).sum(axis=(1, 2))
        yields = softness / cells.force.sum(axis=(1, 2)) / PAIR.helix.base_cosine
        expected = -float(np.mean(yields)) * solved.dry.mean_secant_stiffness * PAIR.base_radii[0] / TORQUE
        assert solved.secant_stiffness_change < 0.0
        assert solved.secant_stiffness_change == pytest.approx(expected, rel=0.1)

    def test_places_of_the_path_have_the_most_loaded_cells(self, solved):
        cells = cells_of(solved)
        rho1, load = most_loaded(PAIR, solved, np.arange(12))
        assert np.all(np.diff(rho1) > 0.0)
        assert load.max() == cells.line_load[cells.inside].max()

    def test_every_model_of_the_face_serves_lines(self, bodies, solved):
        layer = lubricated(bodies, FilmModel(supply=ehl.OilLayer(0.08e-6)))
        formula = lubricated(bodies, FilmModel("dowson"))
        assert layer.over_lines.least_film < 0.95 * solved.over_lines.least_film
        assert formula.over_lines.error is None
        assert formula.over_lines.least_film == pytest.approx(solved.over_lines.least_film, rel=0.25)

    def test_the_other_hand_has_the_same_films(self, bodies, solved):
        left = replace(PAIR, helix_angle=-PAIR.helix_angle)
        other = lubricated(fem.compliance(left, tolerance=0.02), FilmModel("dowson")).over_lines
        own = lubricated(bodies, FilmModel("dowson")).over_lines
        assert other.least_film == pytest.approx(own.least_film, rel=2e-3)
        assert other.least_film_place == pytest.approx(-own.least_film_place, abs=3e-4)


@pytest.mark.slow
@pytest.mark.long
class TestLosses:
    @pytest.fixture(scope="class")
    @classmethod
    def lost(cls, bodies) -> coupling.MeshLosses:
        return coupling.mesh_losses(
            PAIR, TORQUE, SPEED, OIL, tolerance=0.05, positions=8, compliance=bodies, flanks=HELD
        )

    def test_friction_turns_both_gears_by_the_power(self, lost):
        """Friction acts across the line, on pinion and wheel by the levers rho1 and rho2: M1 w1 + M2 w2 is lost."""
        lines = lost.over_lines
        rho1, rho2 = np.nan_to_num(lines.rho)
        tangential = np.nan_to_num(lines.friction_coefficient) * lines.force * np.sign(rho1 - PAIR.points.C)
        first, second = ((tangential * rho).sum(axis=(1, 2)) for rho in (rho1, rho2))
        power = SPEED * first - SPEED * 18 / 23 * second
        own = (lines.sliding_loss * lines.length[..., None]).sum(axis=(1, 2))
        assert power == pytest.approx(own, rel=1e-9)
        assert lost.sliding_loss == pytest.approx(own.mean(), rel=lost.error)
        # torque of the losses on the driving shaft
        missing = TORQUE * (1.0 - lost.efficiency)
        assert missing == pytest.approx(lost.mesh_loss / SPEED, rel=1e-9)

    def test_powers_along_the_path_add_up(self, lost):
        lines, count = lost.over_lines, math.ceil(PAIR.contact_ratio * 8)
        along = (lost.path.sliding_loss + lost.path.rolling_loss).sum() * PAIR.contact_ratio / count
        # cells at ends of lines come by places without a film that is shown
        assert along == pytest.approx(lines.power_lost.mean(), rel=0.1)

    def test_the_loss_factor_is_near_the_closed_forms(self, lost):
        points, pitch = PAIR.points, PAIR.base_pitch
        parts = (points.E - points.C) / pitch, (points.C - points.A) / pitch
        teeth = math.pi * (1 / 18 + 1 / 23) / PAIR.helix.base_cosine
        even = teeth * (parts[0] ** 2 + parts[1] ** 2) / PAIR.contact_ratio
        assert lost.loss_factor == pytest.approx(even, rel=0.15)

    def test_forces_are_those_that_the_mean_friction_tilts(self, lost):
        """Normal forces and friction carry the torque together, at each position."""
        contact = lost.cycle.contact
        assert contact.friction == pytest.approx(lost.mean_friction, rel=0.02)
        first, _ = contact.lines.rubbed
        across = contact.lines.across * PAIR.base_radii[0]
        assert across + contact.friction * first == pytest.approx(TORQUE, rel=1e-9)
        assert np.max(np.abs(across / TORQUE - 1.0)) > 1e-3


@pytest.mark.slow
@pytest.mark.long
def test_a_small_helix_has_the_films_of_the_spur_face():
    spur = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3)
    held = Flanks(beyond_path=False, cells=16)
    found = []
    for pair in (spur, replace(spur, helix_angle=1e-6)):
        teeth = LoadedTeeth(pair, TORQUE, compliance=fem.compliance(pair, tolerance=0.02), flanks=held)
        dry = teeth.cycle(16)
        found.append(
            lubricate(teeth, dry, SPEED, OIL, resolution_of(0.01), FilmModel("dowson"), profiles=False)
        )
    straight, twisted = found
    face, lines = straight.over_face, twisted.over_lines
    assert face is not None
    assert lines is not None
    error = straight.error + twisted.error
    assert twisted.secant_stiffness == pytest.approx(straight.secant_stiffness, rel=error)
    inner = slice(3, -3)  # ends of the face count for the one, not for the other
    # a film goes as the load to the power of -0.13: within the errors of the loads
    assert np.nanmin(lines.minimum_thickness[..., inner]) == pytest.approx(
        np.nanmin(face.minimum_thickness[..., inner]), rel=error
    )
    softer = [cycle.secant_stiffness.mean() / cycle.dry.secant_stiffness.mean() - 1.0 for cycle in found]
    assert softer[1] == pytest.approx(softer[0], rel=0.05)
