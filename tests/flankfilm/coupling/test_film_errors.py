"""What films err by is part of the errors of all figures of a lubricated cycle: against tighter and more films."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
import pytest

import ehl
from flankfilm.coupling import LoadedTeeth, LubricatedCycle, resolution_of
from flankfilm.coupling.films import films, lubricated
from flankfilm.coupling.films.film_law import FilmLaw, HeldMeniscus
from flankfilm.coupling.films.films import FilmModel, PlacedMeniscus
from flankfilm.coupling.films.lubricated import lubricate
from flankfilm.coupling.films.lubricated_path import BETWEEN
from gears import Gear, GearPair
from gears.sharing.mesh_arcs import MeshArcs

PAIR = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
OIL = ehl.Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)


@dataclass(frozen=True)
class Case:
    """A pair under a torque [N m], at a speed [rad/s], with its oil."""

    pair: GearPair = PAIR
    torque: float = 600.0
    speed: float = 209.44
    oil: ehl.Lubricant = OIL
    film: FilmModel = lubricated.SOLVED
    most: float = 20.0
    """Median of estimates over true errors: means are on the safe side, since errors along the path cancel in them."""


THICK = ehl.Lubricant(viscosity=0.4, pressure_viscosity=25e-9, density=910.0)
LARGE = GearPair(
    pinion=Gear(teeth=20, profile_shift=0.2), wheel=Gear(teeth=80), module=4e-3, face_width=40e-3
)
CASES = {
    "light and fast": Case(torque=10.0, speed=2000.0),
    "article pair": Case(),
    "thick oil": Case(LARGE, 100.0, 300.0, THICK),
    "meniscus held": Case(torque=200.0, film=FilmModel(supply=PlacedMeniscus(1.3)), most=60.0),
}


def cycle_of(case: Case, positions: int, finer: float = 1.0) -> LubricatedCycle:
    """Cycle whose arcs err by next to nothing, with so many films to a part of their tolerance."""
    teeth = LoadedTeeth(case.pair, case.torque, "potential-energy")
    asked = resolution_of(0.005, teeth.model)
    asked = replace(asked, sampling=1e-5, transmission_error=1e-5, films=asked.films / finer)
    dry = teeth.sampled(asked.sampling, asked.transmission_error)
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        patch.setattr(films, "FILM_POSITIONS", positions)
        return lubricate(teeth, dry, case.speed, case.oil, asked, case.film, profiles=False)


def estimates(cycle: LubricatedCycle) -> np.ndarray:
    """Means of tangent and secant, peak to peak and extremes of both, with their errors, relative (7, 2)."""
    assert isinstance(cycle.arcs, MeshArcs)
    found = replace(cycle.arcs, other=0.0)
    both = ("stiffness", "secant_stiffness")
    every = [found.mean(name) for name in both] + [found.range("transmission_error")]
    every += [found.extreme(name, greatest) for name in both for greatest in (False, True)]
    return np.array([(one.value, one.error) for one in every])


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", CASES)
def test_estimates_hold_what_more_and_tighter_films_change(name: str):
    """No figure is off by more than twice its estimate, and estimates do not lose touch with the error."""
    case = CASES[name]
    found, finer = estimates(cycle_of(case, 40)), estimates(cycle_of(case, 120, 10.0))
    true = np.abs(found[:, 0] - finer[:, 0])
    assert np.all(true < 2.0 * found[:, 1])
    assert np.median(found[:, 1] / true) < case.most


def test_films_by_formula_err_by_their_interpolation_alone():
    cycle = cycle_of(Case(film=FilmModel("dowson")), 40)
    assert cycle.arcs is not None
    halves, own = cycle.arcs.compared.varied, cycle.arcs.arcs
    assert [share for _, share in halves] == [BETWEEN, BETWEEN]
    changed = [other.mean("stiffness")[0] - own.mean("stiffness")[0] for other, _ in halves]
    error = replace(cycle.arcs, other=0.0).mean("stiffness").error
    assert error == pytest.approx(np.hypot(BETWEEN * np.hypot(*changed), own.mean("stiffness")[1]), rel=1e-12)
    assert error > 0.0


def law() -> FilmLaw:
    rho1 = np.arange(1.0, 6.0)
    return FilmLaw(1e-3 * rho1, np.full(5, 1000.0), 1e-7 * (1 + rho1**2), np.full(5, 0.1))


def test_a_law_goes_on_half_a_step_beyond_its_films():
    found = law()
    places = 1e-3 * np.array([[0.5, 0.75, 0.2, 5.5, 7.0]])
    separation, slope = found(places, np.full_like(places, 1000.0))
    first = 2 - 3 * np.array([0.5, 0.25, 0.5])
    assert separation[0] == pytest.approx(1e-7 * np.append(first, [26 + 4.5, 26 + 4.5]))
    assert np.all(slope <= 0.0)


def test_halves_of_the_films():
    one = np.ones(5)
    held = replace(law(), held=HeldMeniscus(2 * one, 1e-6 * one, 0.1 * one))
    for found in (law().halves()[0], held.halves()[0]):
        assert found.rho1 == pytest.approx([1e-3, 3e-3, 5e-3])
        assert found.separation == pytest.approx([2e-7, 10e-7, 26e-7])
    assert law().halves()[1].rho1 == pytest.approx([2e-3, 4e-3])
    # behind a meniscus the nearest film stands beyond the ends
    assert held.halves()[1].rho1 == pytest.approx([1e-3, 2e-3, 4e-3, 5e-3])


def test_films_left_out_tell_what_the_end_of_the_path_errs_by():
    """A smooth law through films in the middle of intervals, at the start of the first one: 2/3 of its error."""
    rho1 = 1e-3 * (np.arange(12) + 0.5)
    given = FilmLaw(rho1, np.full(12, 1000.0), 1e-7 * (1 + (1e3 * rho1 - 3.0) ** 2), np.full(12, 0.1))
    start, force = np.zeros((1, 1)), np.full((1, 1), 1000.0)
    here, fewer = (float(one(start, force)[0][0, 0]) for one in (given, given.halves()[0]))
    assert (fewer - here) / (here - 1e-6) == pytest.approx(2 / 3, rel=1e-6)
