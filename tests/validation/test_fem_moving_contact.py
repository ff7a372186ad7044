"""One pair of teeth whose contact moves under load, against CalculiX with NLGEOM on two gears.

Source: own runs of CalculiX 2.20, ``benchmarks/studies/fem_moving_contact.py``: surface-to-surface contact,
penalty 1e7 N/mm^3, curved CPE6, 33 000 nodes, edges of 40 um at the contact, whole annuli held at their bores.
Steel 17 on PA66 51 (E 3 GPa, nu 0.4), m 2 mm, b 20 mm, one pair 0.8 base pitches after A. The bore of one gear is
turned by D over its base radius, the other is held. The figure is the change of the secant stiffness against Hertz's
pressure where the undeformed teeth touch, on the same meshes and at the torque found, so that the discretisation
drops out of it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.moving_contact import contact_moves, model_error
from fem.contact.moving_contacts import MovingContacts
from fem.laws.contact_candidates import contact_candidates
from fem.laws.local_law import PairLaws
from fem.laws.mesh_setup import MeshSetup
from gears import Gear, GearPair, Material, share_load
from gears.sharing.active_set import share_forces
from gears.sharing.load_coupling import DenseCoupling

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
PAIR = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66))
ARTICLE = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 40e-3, material=STEEL)
POSITION = 0.8

CALCULIX = (  # turned gear, torque of the pinion [N m], change of the secant [%], allowed [%]
    ("pinion", 5.0213, 0.410, 0.3),
    ("pinion", 20.4792, 2.299, 0.6),
    ("pinion", 42.0373, 4.880, 1.2),
    ("wheel", 5.0032, 0.062, 0.3),
    ("wheel", 20.1807, 0.867, 0.6),
    ("wheel", 40.8467, 2.029, 1.2),
)
NEO_HOOKE = 3.3
"""The same [%] at 20 N m, pinion turned, with CalculiX's neo-Hookean law of the same E and nu (an earlier model)."""


@pytest.fixture(scope="module")
def bodies():
    return fem.compliance(PAIR, tolerance=1e-3)


def alone(bodies, position, torque):
    """Deflections of one pair whose contact stays or moves, and the model error of the second."""
    pair = bodies.pair
    rho1 = pair.points.A + position * pair.base_pitch
    rho = np.array([[[rho1]], [[pair.line_of_action - rho1]]])
    yes, no = np.ones((1, 1), dtype=bool), np.zeros((1, 1), dtype=bool)
    where = replace(contact_candidates(MeshSetup(pair, 1, False)), rho=rho, touchable=yes, edge=no)
    moves, laws = contact_moves(bodies, where), PairLaws(bodies.hertz(rho[0]))
    force, bulk, gaps = np.array([torque / pair.base_radii[0]]), bodies.bulk(rho[0]), np.zeros((1, 1))
    stays = share_load(force, bulk, laws, gaps)
    contacts = MovingContacts(
        1,
        DenseCoupling(bulk),
        DenseCoupling(moves.roll),
        laws,
        None,
        gaps,
        gaps,
        0.0,
        yes,
        np.ones((1, 1)),
        np.ones((1, 1)),
        moves,
        np.ones((1, 1, 1, 1)),
        None,
    )
    moved = share_forces(contacts, force, stays.forces, stays.transmission_error)
    assert moved is not None
    error = model_error(moves, moved.forces, moved.transmission_error, True)
    return float(stays.transmission_error[0]), float(moved.transmission_error[0]), error


@pytest.mark.parametrize(("turned", "torque", "change", "allowed"), CALCULIX)
def test_calculix_with_large_displacements(bodies, turned, torque, change, allowed):
    stays, moved, error = alone(bodies, POSITION, torque)
    if turned == "wheel":  # the pinion stands at the position: the same state as the pinion turned at x - D
        for _ in range(3):
            _, moved, error = alone(bodies, POSITION - moved / PAIR.base_pitch, torque)
    found = 100 * (stays / moved - 1)
    print(
        f"{turned} turned, {torque:g} N m: {found:+.3f} %, CalculiX {change:+.3f} %, error {100 * error:.2f} %"
    )
    assert abs(found - change) < allowed
    assert abs(found - change) < 100 * error


def test_neo_hooke_is_inside_the_model_error(bodies):
    stays, moved, error = alone(bodies, POSITION, 20.0)
    assert abs(100 * (stays / moved - 1) - NEO_HOOKE) < 100 * error


POM = Material(2.8e9, 0.36, 1410.0)
ON_POM = GearPair(Gear(19, 0.2), Gear(45, -0.1), 1.5e-3, 12e-3, material=(STEEL, POM))
TWO_CODES = {2.0: 0.3861, 5.0: 0.4052, 8.0: 0.4183}
"""Torque [N m] to secant stiffness against the bores [1e9 N/m per m], 0.8 base pitches after A, held to the path.

Of two independent codes with large displacements, pinion turned; one pair bears there.
"""


def test_steel_on_pom_against_two_codes_with_large_displacements():
    """The cycle as a user has it: contacts of plastics move unless asked to stay."""
    bodies = fem.compliance(ON_POM, tolerance=1e-3)
    cycles = fem.mesh_cycle(ON_POM, list(TWO_CODES), 50, bodies, beyond_path=False, reference="bore")
    for cycle, (torque, expected) in zip(cycles, TWO_CODES.items(), strict=True):
        assert cycle.moving_contact
        found = 1e-9 * float(np.interp(POSITION, cycle.position, cycle.secant_stiffness)) / ON_POM.face_width
        print(
            f"{torque:g} N m: {found:.4f}, {found / expected - 1:+.2%} (model error {cycle.model_error:.2%})"
        )
        assert abs(found / expected - 1) < min(0.005, cycle.model_error + cycle.error)


def test_steel_at_the_pitch_point():
    """CalculiX: -0.249 % at 598.44 N m, 0.849 p_H over its penalty of 1e8 N/mm^3 being -0.045 % of the deflection."""
    at_C = (ARTICLE.points.C - ARTICLE.points.A) / ARTICLE.base_pitch
    stays, moved, error = alone(fem.compliance(ARTICLE, tolerance=1e-3), at_C, 598.44)
    found = 100 * (stays / moved - 1)
    assert abs(found - (-0.249 + 0.045)) < 0.02
    assert abs(found) < 0.25
    assert 0.001 < error < 0.003
