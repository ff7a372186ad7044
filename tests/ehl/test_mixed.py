import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from base import InputError, RangeWarning
from ehl import LineContact, Lubricant, Meniscus, OilLayer, Roughness, solve, solve_mixed
from ehl.discrete.asperities import height_integral, plane_distance
from ehl.discrete.regressions import moes_central
from ehl.films.solver import solve_checked
from ehl.solving.levels import figures
from ehl.solving.load_share import central_asperity_pressure, odds_of
from ehl.solving.options import Options
from ehl.solving.response import by_share
from tests.validation.article import PITCH

STIFF = Roughness(2e-7, 2.5e10, 1e-5, "greenwood-williamson")
SOFT = Roughness(1e-7, 4e10, 1e-5)


def quiet(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return function(*arguments, **options)


@pytest.mark.parametrize("n", [0.5, 1.5, 2.5])
@pytest.mark.parametrize("x", [-12.0, -3.0, -1.0, 0.0, 1.3, 4.0, 6.0])
def test_height_integrals_by_quadrature(n, x):
    exact, _ = quad(
        lambda s: (s - x) ** n * math.exp(-(s**2) / 2) / math.sqrt(2 * math.pi),
        max(x, -12),
        max(x + 12, 12),
        epsabs=0,
        limit=400,
        points=[0.0] if x < 0 else None,
    )
    assert float(height_integral(n, x)) == pytest.approx(exact, rel=1e-6)


def test_the_usual_fit_of_the_height_integral():
    assert float(height_integral(2.5, 0.0)) == pytest.approx(0.6166, rel=1e-3)
    x = np.linspace(0.0, 2.0, 9)
    np.testing.assert_allclose(4.4086e-5 * (4.0 - x) ** 6.804, height_integral(2.5, x), rtol=0.12)
    assert height_integral(2.5, 9.0) == 0.0


@pytest.mark.parametrize("t", [-6.0, -2.0, 0.0, 0.7, 3.0, 7.0])
def test_mean_planes_leave_the_gap_that_a_surface_of_such_heights_leaves(t):
    gap, _ = quad(lambda z: (t + z) * math.exp(-(z**2) / 2) / math.sqrt(2 * math.pi), -t, 12, epsabs=0)
    distance, slope = plane_distance(gap)
    assert distance == pytest.approx(t, abs=1e-8)
    open_share = 0.5 * math.erfc(-t / math.sqrt(2))  # of the area
    assert slope == pytest.approx(1 / open_share, rel=1e-6)
    if t > 3:
        assert distance == pytest.approx(gap, rel=1e-3)


def test_planes_of_gaps_of_every_size():
    gaps = np.geomspace(1e-200, 50.0, 200)
    distance, slope = np.transpose([plane_distance(gap) for gap in gaps])
    assert (np.diff(distance) > 0).all()
    assert (slope >= 1.0).all()
    assert distance[0] < -25.0
    np.testing.assert_array_equal(distance[gaps > 8], gaps[gaps > 8])


@pytest.mark.parametrize("h", [0.5, 1.5, 3.0])
def test_pressures_from_hertz_contacts_of_single_asperities(h):
    """Sum Hertz's (4/3) E* sqrt(R) d^1.5 over heights, and for two rough surfaces over misalignments."""
    modulus = 2.2e11

    def over_heights(load, sigma, offset):
        density = 1 / (sigma * math.sqrt(2 * math.pi))
        plane = h * sigma - offset * sigma
        value, _ = quad(
            lambda z: load(z - plane) * density * math.exp(-0.5 * (z / sigma) ** 2),
            plane,
            plane + 10 * sigma,
            epsabs=0,
        )
        return value

    sigma, beta, n = STIFF.deviation, STIFF.tip_radius, STIFF.density
    one = n * over_heights(lambda d: 4 / 3 * modulus / 2 * math.sqrt(beta) * d**1.5, sigma, STIFF.offset)
    assert STIFF.pressure(h * sigma, modulus)[0] == pytest.approx(one, rel=1e-6)

    sigma, beta, n = SOFT.deviation, SOFT.tip_radius, SOFT.density

    def pairs(d):
        # tips of radius beta a distance r apart meet r^2/(4 beta) later, with the combined radius beta/2
        value, _ = quad(
            lambda r: (
                4 / 3 * modulus / 2 * math.sqrt(beta / 2) * (d - r * r / (4 * beta)) ** 1.5 * 2 * math.pi * r
            ),
            0,
            2 * math.sqrt(beta * d) * (1 - 1e-12),
            epsabs=0,
        )
        return value

    two = n**2 * over_heights(pairs, sigma, SOFT.offset)
    assert SOFT.pressure(h * sigma, modulus)[0] == pytest.approx(two, rel=1e-5)


@pytest.mark.parametrize("rough", [STIFF, SOFT])
def test_slope_of_the_asperities_pressure(rough):
    h = np.array([0.5, 1.0, 2.0, 3.0]) * rough.deviation
    step = 1e-5 * rough.deviation
    high, low = (rough.pressure(h + s, 2.2e11)[0] for s in (step, -step))
    np.testing.assert_allclose((high - low) / (2 * step), rough.pressure(h, 2.2e11)[1], rtol=1e-6)


def test_smooth_surfaces_leave_the_smooth_film():
    film = quiet(solve, PITCH)
    for sigma in (1e-9, 1e-8):
        mixed = quiet(solve_mixed, PITCH, replace(STIFF, deviation=sigma))
        assert mixed.asperity_share == 0.0
        assert mixed.asperity_stiffness == 0.0
        assert mixed.central_thickness == film.central_thickness
        assert mixed.stiffness() == film.stiffness()


def test_central_pressure_of_asperities_by_hand():
    """(n/s) R^1.5 beta^0.5 = 2e10/0.3 1e-3 3.1622777e-3 = 210818.51; powers of it, of sigma/R = 4e-5, W = 1e-4."""
    contact = LineContact(1e-4 * 2.2e11 * 0.01, 1.0, 0.01, 2.2e11, PITCH.lubricant)
    spread = 1.558 * 1.5115264 * 87.879886 * 0.012508349
    pressure = 0.3 * 2.2e11 * math.sqrt(1e-4 / (2 * math.pi)) * (1 + spread**-1.7) ** (-1 / 1.7)
    rough = Roughness(0.4e-6, 2e10, 1e-5)
    assert central_asperity_pressure(contact, rough, 0.3) == pytest.approx(pressure, rel=1e-6)


def test_film_ratio_from_three_to_that_of_the_dry_rough_contact():
    speeds = np.geomspace(3.0, 1e-4, 12)
    films = [quiet(solve_mixed, replace(PITCH, entrainment=float(u)), STIFF) for u in speeds]
    assert all(m.converged for m in films)
    ratio = np.array([m.film_ratio for m in films])
    share = np.array([m.asperity_share for m in films])
    assert ratio[0] > 3.0
    assert ratio[-1] == pytest.approx(ratio[-2], rel=1e-3)
    assert ratio[-1] < 0.4
    assert (np.diff(ratio) < 0).all()
    assert (np.diff(share) > 0).all()
    assert share[0] < 0.01
    # film to nothing: the asperities carry all, at the separation of the dry rough contact
    assert share[-1] > 0.999
    pressure, slope = STIFF.pressure(films[-1].plane_distance, PITCH.reduced_modulus)
    assert pressure == pytest.approx(central_asperity_pressure(PITCH, STIFF, share[-1]), rel=1e-6)
    assert films[-1].asperity_stiffness == pytest.approx(-PITCH.load * slope / pressure, rel=1e-3)
    assert films[-1].stiffness() == pytest.approx(films[-1].asperity_stiffness, rel=0.1)


@pytest.mark.parametrize("rough", [STIFF, SOFT])
def test_the_loads_of_film_and_asperities_add_up(rough):
    contact = replace(PITCH, entrainment=0.1)
    mixed = quiet(solve_mixed, contact, rough)
    film = mixed.film
    assert film.contact.load + mixed.asperity_load == pytest.approx(contact.load, rel=1e-12)
    assert film.contact.half_width == pytest.approx(contact.half_width, rel=1e-12)
    pressure, _ = rough.pressure(mixed.plane_distance, contact.reduced_modulus)
    asked = central_asperity_pressure(contact, rough, mixed.asperity_share)
    assert pressure == pytest.approx(asked, rel=1e-6)
    assert mixed.stiffness() == mixed.film_stiffness() + mixed.asperity_stiffness
    assert mixed.cost.counts["films"] < 8


@pytest.mark.parametrize("rough", [STIFF, SOFT])
@pytest.mark.parametrize("u", [1.0, 0.1, 0.01, 1e-4])
def test_derivatives_by_the_load_against_differences(u, rough):
    contact, step = replace(PITCH, entrainment=u), 0.02
    mixed = quiet(solve_mixed, contact, rough, 2e-3)
    light, heavy = (
        quiet(solve_mixed, replace(contact, load=contact.load * f), rough, 2e-3) for f in (1 - step, 1 + step)
    )
    change = 2 * step * contact.load
    by_difference = (heavy.central_thickness - light.central_thickness) / change
    assert mixed.central_slope == pytest.approx(by_difference, rel=0.02)
    by_difference = (heavy.separation - light.separation) / change
    assert mixed.separation_slope == pytest.approx(by_difference, rel=0.02)


def test_parallel_springs_leave_out_that_the_contact_widens():
    # p_a b ~ w with p_a and b each as w^1/2: at s = 1 half of the whole stiffness
    for u, factor in ((1.0, 1.0), (1e-4, 0.5)):
        mixed = quiet(solve_mixed, replace(PITCH, entrainment=u), STIFF)
        closer = mixed.central_slope / mixed.gap_slope
        assert mixed.stiffness("tangent") * -closer == pytest.approx(factor, abs=0.1)


@pytest.mark.parametrize(
    "rough",
    [STIFF, SOFT, Roughness(0.3e-6, 3.3e9, 4e-5), Roughness.from_drawing(0.4e-6, law="greenwood-tripp")],
)
@pytest.mark.parametrize("load", [1e5, 3e5, 9e5])
def test_the_share_tends_to_one_as_the_speed_falls_whatever_the_load(rough, load):
    """The film vanishes with the speed, and the planes of its gap close without end: the rest falls."""
    oil = Lubricant(0.05, 18e-9, 860.0)
    films = [quiet(solve_mixed, LineContact(load, u, 0.012, 2.2e11, oil), rough) for u in (3e-2, 3e-3, 3e-4)]
    left = 1 - np.array([film.asperity_share for film in films])
    assert (left[1:] < 0.85 * left[:-1]).all()
    pressure = rough.pressure([film.plane_distance for film in films], 2.2e11)[0]
    asked = [central_asperity_pressure(film.contact, rough, film.asperity_share) for film in films]
    np.testing.assert_allclose(pressure, asked, rtol=1e-5)
    assert films[-1].plane_distance < films[-1].central_thickness


DRAWN = Roughness.from_drawing(0.4e-6)


@pytest.mark.parametrize("load", [1e5, 3e5, 9e5])
def test_the_film_ratio_decides_the_share_of_drawn_surfaces(load):
    contact = LineContact(load, 3.0, 0.012, 2.2e11, Lubricant(0.05, 18e-9, 860.0))
    speeds = (30.0, 3.0, 0.3, 3e-2, 3e-3, 3e-4)
    films = [quiet(solve_mixed, replace(contact, entrainment=u), DRAWN) for u in speeds]
    shares = [film.asperity_share for film in films]
    for film, share in zip(films, shares, strict=True):
        ratio = film.central_thickness / DRAWN.deviation
        carried = math.exp(-1.90 * ratio**0.99)
        assert share == pytest.approx(carried if carried > 1e-10 else 0.0, rel=2e-7)
        assert 1 - share == pytest.approx(1 - carried, rel=2e-7)
    assert shares[0] < 1e-3
    assert (np.diff(shares) > 0).all()
    left = 1 - np.array(shares)
    assert (left[3:] < 0.6 * left[2:-1]).all()  # towards 1 as the speed falls


@pytest.mark.parametrize("u", [3.0, 0.3, 1e-2])
def test_derivatives_by_the_load_where_the_film_ratio_decides(u):
    contact, step = replace(PITCH, entrainment=u), 0.02
    mixed = quiet(solve_mixed, contact, DRAWN, 2e-3)
    light, heavy = (
        quiet(solve_mixed, replace(contact, load=contact.load * f), DRAWN, 2e-3) for f in (1 - step, 1 + step)
    )
    for figure, slope in (("central_thickness", "central_slope"), ("separation", "separation_slope")):
        by_difference = (getattr(heavy, figure) - getattr(light, figure)) / (2 * step * contact.load)
        assert getattr(mixed, slope) == pytest.approx(by_difference, rel=0.02)


def test_starved_and_rough():
    starved = quiet(solve_mixed, PITCH, STIFF, supply=OilLayer(0.11e-6))
    flooded = quiet(solve_mixed, PITCH, STIFF)
    assert starved.converged
    assert starved.film_ratio < 1.0 < flooded.film_ratio
    assert starved.asperity_share > 0.3


@pytest.mark.parametrize("fill", [0.5, 0.8, 1.0, 1.5])
@pytest.mark.parametrize("density", [1e10, 4e10])
@pytest.mark.parametrize("speed", [0.1, 10.0])
def test_layers_as_thin_as_the_roughness_are_shared_or_said_to_be_dry(fill, density, speed):
    """Asperities that ask for more than the load at the layer's own thickness leave none to the film."""
    oil = Lubricant(0.05, 18e-9, 860.0)
    contact = LineContact(1e5, speed, 0.012, 2.2e11, oil)
    rough = quiet(Roughness, 0.3e-6, density, 1e-5)
    found = quiet(solve_mixed, contact, rough, supply=OilLayer(fill * rough.deviation))
    held, _ = rough.under_film(fill * rough.deviation, contact.reduced_modulus, contact.peak_pressure)
    alone = central_asperity_pressure(contact, rough, 1.0)
    if held > 1.1 * alone:
        assert not found.converged
        assert "take the contact as dry" in found.message
    elif held < 0.5 * alone:
        assert found.converged
        assert 0.0 < found.asperity_share < 1.0


def test_bad_roughness_is_listed_at_once():
    with pytest.raises(InputError) as caught:
        Roughness(-1.0, 0.0, float("nan"), law="sandpaper", offset=-1)
    assert len(caught.value.faults) == 5
    with pytest.raises(InputError, match="roughness"):
        solve_mixed(PITCH, 1e-7)


def test_roughness_of_drawings():
    """Ra and Rz of normal heights, the root of the sum of squares of both flanks, and the usual asperities."""
    rough = Roughness.from_drawing(mean=(0.3e-6, 0.4e-6))
    heights = np.random.default_rng(1).normal(0.0, 1.0, 400_000)
    assert rough.deviation == pytest.approx(0.5e-6 / np.abs(heights).mean(), rel=3e-3)
    assert rough.number == pytest.approx(0.04, rel=1e-12)
    assert rough.tip_radius == pytest.approx(1e3 * rough.deviation, rel=1e-12)
    assert Roughness.from_drawing(peaks=(1.8e-6, 2.4e-6)).deviation == pytest.approx(
        rough.deviation, rel=1e-12
    )
    alike = Roughness.from_drawing(mean=0.4e-6, density=1e11, tip_radius=5e-7)
    assert alike.deviation == pytest.approx(0.4e-6 * np.sqrt(np.pi), rel=1e-12)
    assert (alike.density, alike.tip_radius) == (1e11, 5e-7)
    assert (rough.law, alike.law) == ("zhou-hoeprich", "greenwood-tripp")
    with pytest.raises(InputError, match="must be a law of asperities"):
        rough.pressure(1e-7, 2.2e11)
    with pytest.raises(InputError, match="Ra or Rz, one of them"):
        Roughness.from_drawing()
    with pytest.raises(InputError, match="Ra or Rz in m"):
        Roughness.from_drawing(mean=0.4)


@pytest.mark.parametrize(("number", "warned"), [(0.029, True), (0.03, False), (0.05, False), (0.051, True)])
def test_unusual_roughness_is_warned_of(number, warned):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        Roughness(1e-7, number / 1e-12, 1e-5)
    assert ["sigma beta eta" in str(one.message) for one in caught] == [True] * warned


def test_trials_warn_of_no_films_that_nothing_shows(monkeypatch):
    """From a share that leaves 2e-6 of the load: the first trial film exceeds R/1000."""
    contact = replace(PITCH, entrainment=1e-4, load=0.05 * PITCH.load)
    start = quiet(solve_mixed, contact, STIFF, 0.05)
    trials = []

    def noted(eased, *arguments):
        trials.append(moes_central(eased) / eased.radius)
        return solve_checked(eased, *arguments)

    monkeypatch.setattr("ehl.films.mixed.solve_checked", noted)
    monkeypatch.setattr("ehl.films.mixed._likely_odds", lambda *near: odds_of(1 - 2e-6))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RangeWarning)
        found = solve_mixed(contact, STIFF, tolerance=0.05, start=start)
    assert found.converged
    assert max(trials) > 1e-3
    assert found.film.central_thickness < 1e-3 * contact.radius


@pytest.mark.parametrize("supply", [None, OilLayer(0.11e-6), Meniscus(-1.05 * PITCH.half_width)])
def test_a_neighbour_leaves_few_films_to_solve(supply):
    """Newton's method in the share from the neighbour's: three films, of which none is flooded if the oil is not."""
    before = quiet(solve_mixed, replace(PITCH, entrainment=1.03 * PITCH.entrainment), STIFF, supply=supply)
    near = quiet(solve_mixed, PITCH, STIFF, supply=supply, start=before)
    alone = quiet(solve_mixed, PITCH, STIFF, supply=supply)
    assert near.cost.counts["films"] <= 4
    # from nothing half the load is the first trial, which behind the meniscus lies near
    assert near.cost.iterations < (0.8 if isinstance(supply, Meniscus) else 0.6) * alone.cost.iterations
    for figure in ("central_thickness", "asperity_share", "separation"):
        assert getattr(near, figure) == pytest.approx(getattr(alone, figure), rel=2 * alone.error)
    pressure, _ = STIFF.pressure(near.plane_distance, PITCH.reduced_modulus)
    asked = central_asperity_pressure(PITCH, STIFF, near.asperity_share)
    assert pressure == pytest.approx(asked, rel=1e-6)


def test_bounds_of_the_share_are_of_one_grid():
    """A finer grid moved the balance out of bounds that films on the coarse one had set."""
    oil = Lubricant(viscosity=0.031029031503132052, pressure_viscosity=2.8243152265808212e-08, density=870.0)
    contact = LineContact(1777526.446816397, 0.9380669908840178, 0.019569748921321798, 2.2e11, oil)
    other = replace(contact, load=914079.2657449252, entrainment=0.850212009351362)
    rough = Roughness(3.267265760805142e-08, 37470636305.42699, 3.2672657608051416e-05)
    near_inlet, far = (Meniscus(-1.0184871581147488 * one.half_width) for one in (contact, other))
    start = quiet(solve_mixed, other, rough, supply=far)
    near, alone = (quiet(solve_mixed, contact, rough, supply=near_inlet, start=s) for s in (start, None))
    assert near.converged
    assert near.asperity_share == pytest.approx(alone.asperity_share, rel=0.05)


def test_a_neighbour_on_whose_asperities_much_rests_may_have_none_beside_it():
    heavy = quiet(solve_mixed, replace(PITCH, entrainment=0.05), STIFF)
    assert heavy.asperity_share > 0.3
    fast = replace(PITCH, entrainment=50.0)
    found = quiet(solve_mixed, fast, STIFF, start=heavy)
    assert found.asperity_share == 0.0
    film = quiet(solve, fast)
    assert found.central_thickness == pytest.approx(film.central_thickness, rel=2 * film.error)


@pytest.mark.parametrize("supply", [None, OilLayer(0.11e-6), Meniscus(-1.05 * PITCH.half_width)])
def test_derivatives_by_the_share_against_differences(supply):
    """Films of contacts with load and modulus 2 % down and up, at the same width."""
    step = 0.02

    def eased(by):
        part = math.exp(by)
        contact = replace(PITCH, load=part * PITCH.load, reduced_modulus=part * PITCH.reduced_modulus)
        return quiet(solve_checked, contact, Options(nodes=257, supply=supply), None)

    by = by_share(eased(0.0).fine, supply)
    low, high = (figures(eased(d).fine) for d in (-step, step))
    for figure in ("central", "separation"):
        name = "central_thickness" if figure == "central" else figure
        difference = (getattr(high, name) - getattr(low, name)) / (2 * step)
        # of a held layer only its compressibility moves: hundredths of the others, and of the grid's error as much
        assert getattr(by, figure) == pytest.approx(difference, rel=0.01 if supply is None else 0.03)


@pytest.mark.parametrize("supply", [None, OilLayer(1e-7), Meniscus(-1.2 * PITCH.half_width)])
def test_rough_films_are_solved_on_the_nodes_asked_for(supply):
    ground = Roughness(0.2e-6, 1e10, 1e-5)
    films = {n: solve_mixed(PITCH, ground, supply=supply, nodes=n) for n in (97, 193, 385)}
    finest = films[385]
    for n, mixed in films.items():
        assert mixed.film.x.size == n
        assert mixed.central_thickness == pytest.approx(finest.central_thickness, rel=mixed.error + 1e-9)
    assert films[193].error < films[97].error
    with pytest.raises(InputError, match="nodes"):
        solve_mixed(PITCH, ground, nodes=3)


@pytest.mark.parametrize("law", ["greenwood-tripp", "zhou-hoeprich"])
@pytest.mark.parametrize("supply", [None, OilLayer(1e-7), Meniscus(-1.2 * PITCH.half_width)])
def test_the_share_errs_by_what_it_makes_of_the_error_of_its_film(supply, law):
    ground = Roughness.of_deviation(0.25e-6, law=law)
    coarse, middle, fine = (solve_mixed(PITCH, ground, supply=supply, nodes=n) for n in (65, 129, 257))
    for film in (coarse, middle):
        true = abs(film.asperity_share / fine.asperity_share - 1.0)
        assert 0.5 * true < film.asperity_share_error < 5.0 * true
    assert middle.asperity_share_error < 0.5 * coarse.asperity_share_error


def test_no_asperities_no_error_of_their_share():
    smooth = solve_mixed(PITCH, Roughness.of_deviation(1e-9))
    assert (smooth.asperity_share, smooth.asperity_share_error) == (0.0, 0.0)
