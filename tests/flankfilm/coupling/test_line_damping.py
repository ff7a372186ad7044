"""Damping by films on lines of contact: cells by hand, the spur limit, the mirror."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ehl
from flankfilm.coupling import FilmModel, Flanks, MeshCycle, film_damping, mesh_cycle
from gears import Gear, GearPair

PAIR = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0)).with_backlash(
    30e-6
)
OIL = ehl.Lubricant(viscosity=0.1, pressure_viscosity=19.6e-9)
TORQUE, SPEED, OMEGA, CELLS = 0.3, 1000.0, 1e5, 12
FLANKS = Flanks(beyond_path=False, cells=CELLS)


def loaded(pair: GearPair = PAIR) -> MeshCycle:
    return mesh_cycle(pair, TORQUE, model="fem", tolerance=0.02, flanks=FLANKS)


@pytest.mark.slow
@pytest.mark.parametrize(
    "film", [FilmModel(), FilmModel(roughness=ehl.Roughness.of_deviation(2e-7))], ids=["smooth", "rough"]
)
def test_the_sum_over_cells_is_that_of_their_films_by_hand(film: FilmModel) -> None:
    """At the reference of the bodies, in which motion counts deflections: each cell has its place and line load."""
    cycle = loaded().against("body")
    found = film_damping(cycle, PAIR, TORQUE, SPEED, OIL, film=film, frequency=OMEGA, tolerance=0.01)
    assert cycle.contact is not None
    lines = cycle.contact.lines
    assert lines is not None
    position, total, cosine = 7, 0.0, PAIR.helix.base_cosine
    for line, cell in zip(*np.nonzero(np.nan_to_num(lines.line_load[position]) > 0.0), strict=True):
        load, rho1 = lines.line_load[position, line, cell], lines.rho[0, position, line, cell]
        path = PAIR.path_at(np.array([rho1]))
        radius = float(path.radius[0]) / cosine
        contact = ehl.LineContact(load, float(path.entrainment(SPEED)[0]), radius, PAIR.reduced_modulus, OIL)
        solved = (
            ehl.solve(contact, 0.01)
            if film.roughness is None
            else ehl.solve_mixed(contact, film.roughness, 0.01)
        )
        yielding = complex(ehl.film_response(solved, OMEGA).compliance) / lines.length[position, line]
        slope = lines.slopes[position, line, cell] / cosine
        total += cosine**2 * (1.0 / (1.0 / slope + yielding)).imag / OMEGA
    assert found.damping_curve[position] == pytest.approx(total, rel=0.05)
    assert found.damping == pytest.approx(np.mean(found.damping_curve))
    assert found.error < 0.2


@pytest.mark.slow
def test_hands_are_damped_alike() -> None:
    """Ends of the other hand are solved by a half turn, which a coarse section shows to some thousandths of them."""
    left = replace(PAIR, helix_angle=-PAIR.helix_angle)
    first, second = (
        film_damping(loaded(pair), pair, TORQUE, SPEED, OIL, frequency=OMEGA, tolerance=0.02).damping
        for pair in (PAIR, left)
    )
    assert second == pytest.approx(first, rel=5e-3)


@pytest.mark.slow
@pytest.mark.long
def test_a_small_helix_is_damped_as_a_spur_pair_within_the_errors() -> None:
    spur = replace(PAIR, helix_angle=0.0).with_backlash(30e-6)
    nearly = replace(spur, helix_angle=1e-6)
    straight = mesh_cycle(spur, TORQUE, model="fem", tolerance=0.02, flanks=Flanks(beyond_path=False))
    damped = [
        film_damping(cycle, pair, TORQUE, SPEED, OIL, frequency=OMEGA, tolerance=0.02)
        for cycle, pair in ((straight, spur), (loaded(nearly), nearly))
    ]
    assert damped[1].damping == pytest.approx(damped[0].damping, rel=damped[0].error + damped[1].error)
    assert max(one.error for one in damped) < 0.3
