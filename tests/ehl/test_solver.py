import os
import subprocess
import sys
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from base import InputError, RangeWarning
from ehl import LineContact, Lubricant, Meniscus, solve, solve_path
from tests.ehl.films import sound
from tests.validation.article import PITCH

GEAR = replace(PITCH, load=2.2e5)


def check_identities(film):
    """What every solution has to fulfil, whatever the contact."""
    sound(film)
    assert 0 < film.minimum_thickness <= film.central_thickness * (1 + 1e-9)
    assert film.flow > 0
    assert 0 < film.error < 1


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.floats(-2, 2.7), st.floats(0.01, 25) | st.just(0.0), st.floats(0.35, 1.0), st.booleans())
def test_identities(log_M, L, z, compressible):
    contact = LineContact.from_moes(10**log_M, L, roelands_z=z, compressible=compressible)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = solve(contact)
    check_identities(film)
    # the load again, by the trapezoidal rule on what is returned; the oil ahead of the grid carries the rest
    carried = np.trapezoid(film.pressure, film.x)
    assert carried == pytest.approx(contact.load, rel=2e-3)
    # pressure rises exactly where more than the mean flow is dragged along
    surplus = contact.lubricant.density_ratio(film.pressure)[0] * film.thickness / film.flow - 1
    rise = np.diff(film.pressure)
    last = np.flatnonzero(film.pressure > 0)[-1]
    both_above = (np.minimum(surplus[1:], surplus[:-1]) > 0.02)[:last]
    both_below = (np.maximum(surplus[1:], surplus[:-1]) < -0.02)[:last]
    assert (rise[:last][both_above] > 0).all()
    assert (rise[:last][both_below] < 0).all()


@settings(max_examples=15, deadline=None)
@given(
    st.floats(1, 200), st.floats(0.01, 20), st.floats(1e-3, 0.1), st.floats(1e9, 4e11), st.floats(5e-9, 30e-9)
)
def test_the_film_depends_on_the_groups_alone(M, L, radius, modulus, alpha):
    # incompressible, so that alpha p_H and z are all that is left of the pressure
    def scaled(**size):
        contact = LineContact.from_moes(M, L, compressible=False, **size)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            return solve(contact, nodes=65)

    one = scaled()
    # Roelands' p0 is fixed in Pa: another alpha is another contact unless its modulus follows
    other = scaled(radius=radius, reduced_modulus=modulus)
    assert other.central_moes == pytest.approx(one.central_moes, rel=1e-9)
    assert other.minimum_moes == pytest.approx(one.minimum_moes, rel=1e-9)
    assert other.separation / other.central_thickness == pytest.approx(
        one.separation / one.central_thickness, rel=1e-8
    )
    barus = [
        scaled_barus.central_moes
        for scaled_barus in (
            _quiet(LineContact.from_moes(M, L, 1.0, a, compressible=False), nodes=65) for a in (alpha, 2e-8)
        )
    ]
    assert barus[0] == pytest.approx(barus[1], rel=1e-9)


def _quiet(contact, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return solve(contact, **options)


@pytest.mark.parametrize(("M", "L"), [(2.0, 1.0), (5.0, 5.0), (20.0, 10.0)])
def test_the_film_converges_at_second_order_or_better(M, L):
    contact = LineContact.from_moes(M, L)
    n = np.array([33, 65, 129, 257])
    films = [solve(contact, nodes=int(k), domain=(-15, 2.5)) for k in n]
    best = solve(contact, nodes=1025, domain=(-15, 2.5)).central_thickness
    errors = np.abs([f.central_thickness / best - 1 for f in films])
    order = -np.polyfit(np.log(n - 1), np.log(np.maximum(errors, 1e-9)), 1)[0]
    assert order > 1.9
    assert errors[2] < 5e-4
    assert errors[3] < 2e-4


def test_error_estimate_bounds_the_change_to_a_finer_grid():
    for M, L in [(2.0, 1.0), (20.0, 10.0), (100.0, 10.0), (5.0, 12.0)]:
        contact = LineContact.from_moes(M, L)
        best = _quiet(contact, nodes=1025)
        for n in (65, 129, 257):
            film = _quiet(contact, nodes=n)
            true = max(
                abs(film.central_thickness / best.central_thickness - 1),
                abs(film.minimum_thickness / best.minimum_thickness - 1),
            )
            assert true < 2 * film.error


def test_a_tighter_tolerance_takes_more_nodes_and_is_met():
    loose, tight = _quiet(GEAR, tolerance=0.02), _quiet(GEAR, tolerance=5e-4)
    assert tight.cost.unknowns > loose.cost.unknowns
    assert tight.error < 5e-4
    assert loose.central_thickness == pytest.approx(tight.central_thickness, rel=0.02)


def test_open_inlet_is_the_limit_of_a_long_one():
    contact = LineContact.from_moes(2.0, 1.0)
    open_inlet = solve(contact, nodes=513)
    long_inlet = solve(contact, nodes=1025, domain=(-300, 2.5))
    short_inlet = solve(contact, nodes=513, domain=(-15, 2.5))
    assert open_inlet.central_thickness == pytest.approx(long_inlet.central_thickness, rel=5e-5)
    assert abs(short_inlet.central_thickness / open_inlet.central_thickness - 1) > 5e-4


def test_starting_from_a_neighbour_gives_the_same_film_in_few_steps():
    first = _quiet(GEAR)
    heavier = replace(GEAR, load=1.01 * GEAR.load)
    again = _quiet(heavier, start=first)
    check_identities(again)
    assert again.cost.iterations <= 8  # on two grids
    assert again.central_thickness == pytest.approx(_quiet(heavier).central_thickness, rel=1e-3)
    same = _quiet(GEAR, start=first)
    assert same.cost.iterations <= 4
    assert same.central_thickness == pytest.approx(first.central_thickness, rel=1e-9)
    assert same.x.size == first.x.size


def test_a_start_on_other_nodes_or_another_domain_is_carried_over():
    first = _quiet(GEAR)
    for options in ({"nodes": 97}, {"domain": (-5.0, 1.5)}, {"grid": "uniform", "domain": (-4, 1.5)}):
        film = _quiet(GEAR, start=first, **options)
        check_identities(film)
        assert film.central_thickness == pytest.approx(_quiet(GEAR, **options).central_thickness, rel=1e-7)


def test_path_through_load_jumps():
    s = np.linspace(-1, 1, 41)
    contacts = [
        replace(
            GEAR,
            load=GEAR.load * (2.0 if abs(t) < 0.35 else 1.0),
            radius=GEAR.radius * (1 - 0.25 * t * t),
            entrainment=GEAR.entrainment * (1 + 0.05 * t),
        )
        for t in s
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        films = solve_path(contacts)
        alone = [solve(c) for c in contacts]
    for film, cold in zip(films, alone, strict=True):
        check_identities(film)
        assert film.error < 0.005
        assert film.central_thickness == pytest.approx(cold.central_thickness, rel=0.005)
    assert sum(f.cost.iterations for f in films) < 0.7 * sum(f.cost.iterations for f in alone)


def test_an_ordinary_film_is_reported_without_remarks():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert solve(LineContact.from_moes(5.0, 5.0)).message == "converged"


def test_the_film_that_reaches_the_outlet_is_reported():
    with pytest.warns(RangeWarning, match="reaches the outlet"):
        film = solve(LineContact.from_moes(5.0, 5.0), domain=(-4.0, 1.0))
    assert "outlet" in film.message


def test_high_pressure_and_thick_films_are_warned_of():
    with pytest.warns(RangeWarning, match="GPa"):
        solve(replace(GEAR, load=4.5e5))
    with pytest.warns(RangeWarning, match="parabola"):
        solve(replace(GEAR, load=10.0))


def test_bad_arguments_are_listed_at_once():
    with pytest.raises(InputError) as caught:
        solve(GEAR, tolerance=-1.0, nodes=3.5, domain=(2.0, -1.0), grid="fancy")
    assert [f.where for f in caught.value.faults] == ["tolerance", "nodes", "grid", "domain"]
    with pytest.raises(InputError, match="contact"):
        solve("not a contact")


def test_an_unmet_tolerance_keeps_the_figures_with_their_error():
    contact = LineContact.from_moes(100.0, 10.0)
    film, usual = _quiet(contact, tolerance=1e-6), _quiet(contact, tolerance=1e-3)
    assert film.converged
    assert 1e-6 < film.error < usual.error
    assert film.central_thickness == pytest.approx(usual.central_thickness, rel=usual.error)
    assert film.stiffness() == pytest.approx(usual.stiffness(), rel=usual.errors.approach_stiffness)
    assert "above the tolerance of 1e-06" in film.message
    held = _quiet(contact, tolerance=1e-6, supply=Meniscus(-1.5 * contact.half_width))
    assert held.error > 1e-6
    assert isinstance(held.supply, Meniscus)


def test_importing_the_package_is_light():
    heavy = {"numba", "scipy", "matplotlib"}
    code = f"import sys, ehl; ehl.Lubricant(0.05, 2e-8); assert not {heavy} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_cost_holds_no_compilation(tmp_path):
    code = """
import time
from ehl import LineContact, solve
contact = LineContact.from_moes(20.0, 10.0)
began = time.perf_counter()
print(solve(contact).cost.seconds / (time.perf_counter() - began))
"""
    nothing_kept = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], check=True, env=nothing_kept, capture_output=True)
    assert float(done.stdout) < 0.2


def test_public_names():
    import ehl

    assert {"Lubricant", "LineContact", "solve", "solve_path", "Film"} <= set(ehl.__all__)
    for name in ehl.__all__:
        assert getattr(ehl, name) is not None
    assert sorted(ehl.__all__) == sorted(dir(ehl))
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = ehl.no_such_name


def test_fine_films_along_a_path_need_no_fine_start():
    """High pressure-viscosity wants 257 nodes and more; from a film of half the load none may be lost."""
    oil = Lubricant(viscosity=0.075, pressure_viscosity=32.6e-9, density=910.0)
    contacts = [
        LineContact(load=w, entrainment=2.58, radius=6.5e-3, reduced_modulus=2.2e11, lubricant=oil)
        for w in (2.2e5, 2.3e5, 4.4e5, 4.4e5, 2.2e5)
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        films = solve_path(contacts, tolerance=0.005)
        alone = [solve(contact, tolerance=0.005) for contact in contacts]
    assert all(film.converged for film in films)
    for film, own in zip(films, alone, strict=True):
        assert film.central_thickness == pytest.approx(own.central_thickness, rel=0.005)
