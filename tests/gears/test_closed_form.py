"""Closed forms against quadrature of what they integrate, and against identities."""

from __future__ import annotations

import math
import pickle
import warnings
from dataclasses import asdict

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from base import RangeWarning
from gears import (
    BasicRack,
    Gear,
    GearPair,
    GeometryError,
    Material,
    closed_form,
    half_width,
    peak_pressure,
)
from gears.closed_form.loaded_tooth import loaded_teeth
from gears.closed_form.trapezoid import dimensions
from gears.pair.hertz import depth_compliance

FORCE = 17736.3
MODELS = {
    "ishikawa": lambda pair, path: closed_form.ishikawa(pair, path),
    "weber_banaschek": lambda pair, path: closed_form.weber_banaschek(pair, path, FORCE),
    "potential_energy": lambda pair, path: closed_form.potential_energy(pair, path),
    "potential_energy with force": lambda pair, path: closed_form.potential_energy(pair, path, FORCE),
    "hertz": lambda pair, path: closed_form.hertz(pair, path, FORCE),
}


def test_ishikawa_parts_are_the_beam_integrals_of_rectangle_and_taper(article_pair):
    path = article_pair.path_of_contact(5)
    parts = closed_form.ishikawa(article_pair, path).parts
    for i in range(5):
        rectangle = taper = shear = 0.0
        for tooth in loaded_teeth(article_pair, path):
            d, E, nu = dimensions(tooth.profile), 206e9, 0.3
            h_x = float(tooth.radius[i] * np.cos(tooth.half_angle[i])) - d.y_0
            scale = math.cos(float(tooth.load_angle[i])) ** 2 / (E * 40e-3)

            def width(y, d=d):
                return d.s_F if y < d.h_r else d.s_F * (d.h_i - y) / (d.h_i - d.h_r)

            def bending(y, h_x=h_x, width=width):
                return 12 * (h_x - y) ** 2 / width(y) ** 3

            rectangle += scale * quad(bending, 0, d.h_r, epsrel=1e-12)[0]
            taper += scale * quad(bending, d.h_r, h_x, epsrel=1e-12)[0]
            whole = (
                quad(lambda y, w=width: 1 / w(y), 0, d.h_r)[0]
                + quad(lambda y, w=width: 1 / w(y), d.h_r, h_x)[0]
            )
            shear += scale * 2 * (1 + nu) * whole
        assert parts["bending_rectangle"][i] == pytest.approx(rectangle, rel=1e-10)
        assert parts["bending_trapezoid"][i] == pytest.approx(taper, rel=1e-9)
        assert parts["shear"][i] == pytest.approx(shear, rel=1e-10)


@pytest.mark.parametrize(
    "gear",
    [
        Gear(17),
        *(pytest.param(one, marks=pytest.mark.slow) for one in (Gear(36), Gear(12, -0.2), Gear(200, 0.4))),
    ],
)
def test_integrals_over_the_true_profile(gear):
    """The quadrature in the curves' parameters against one in the height, by the tooth's boundary."""
    pair = GearPair(Gear(60), Gear(61), 2e-3, 0.02)
    from gears.closed_form.loaded_tooth import LoadedTooth
    from gears.tooth.profile import generate

    profile = generate(gear, 2e-3, BasicRack())
    assert profile is not None
    tooth = LoadedTooth(profile, pair.materials[0], np.array([np.mean(profile.flank_rho)]))
    foot = tooth.root_section[0]
    for top in (float(tooth.crossing[0]), foot + 0.3e-3):

        def half(y):
            def off(x):
                return math.atan2(x, y) - float(profile.boundary_angle(math.hypot(x, y)))

            return brentq(
                off, 0.05e-3, profile.root_radius * math.tan(profile.root_half_angle) * 1.01, xtol=1e-16
            )

        join = min(float(profile.fillet(1.0)[1]), top)
        for integrand in (
            lambda y, x, top=top: 12 * (top - y) ** 2 / (2 * x) ** 3,
            lambda y, x: 0.5 / x + 0 * y,
        ):
            low = foot + 1e-9
            expected = quad(lambda y, f=integrand: f(y, half(y)), low, join, epsrel=1e-9, limit=200)[0]
            expected += quad(lambda y, f=integrand: f(y, half(y)), join, top, epsrel=1e-9)[0]
            found = float(tooth.integrate(integrand, np.array([top]))[0])
            assert found == pytest.approx(expected, rel=2e-5)


def test_coefficients_of_weber_and_banaschek_at_a_ratio_of_0_3():
    nu = 0.3
    strain = 1 - nu**2
    assert 12 * strain == pytest.approx(10.92)
    assert 2.4 / (1 - nu) * strain == pytest.approx(3.1, rel=0.01)
    assert (1 - nu) / 2.4 == pytest.approx(0.294, rel=0.01)
    assert 18 / math.pi * strain == pytest.approx(5.2, rel=0.005)
    assert 2 * (1 - 2 * nu) / (1 - nu) * strain == pytest.approx(1.0, rel=0.05)
    assert 4.8 / math.pi * strain == pytest.approx(1.4, rel=0.01)


def test_bending_of_the_half_plane_is_the_work_of_a_linear_pressure():
    """18/pi: a pressure 12 M x / s^3 on a half-plane does the work of M on the rotation 18 M / (pi E* s^2).

    With u = -(2 / (pi E*)) Int p ln|x - x'| dx', the work on unit width s = 1 is
    -(2/pi) 144 Int Int x x' ln|x - x'|; the double integral is Int_0^1 2 ln(t) C(t) dt with the
    autocorrelation C(t) of x on [-1/2, 1/2].
    """

    def correlation(t):
        return quad(lambda x: x * (x + t), -0.5, 0.5 - t)[0]

    double = quad(lambda t: 2 * math.log(t) * correlation(t), 0, 1)[0]
    assert -2 / math.pi * 144 * double == pytest.approx(18 / math.pi, rel=1e-8)


def test_hertz_approach_is_the_strain_integrated_to_the_depth():
    """Against the exact stresses on the axis of a Hertz line contact in plane strain."""
    a, E, nu = 1.0, 1.0, 0.3
    strain_modulus, ratio = E / (1 - nu**2), nu / (1 - nu)
    p_0 = 2 / (math.pi * a)  # unit load

    def strain(z):
        root = math.hypot(a, z)
        along = a / root
        across = (a**2 + 2 * z**2) / (a * root) - 2 * z / a
        return p_0 * (along - ratio * across) / strain_modulus

    for depth, error in ((5.0, 0.01), (20.0, 1e-3), (100.0, 5e-5)):
        exact = quad(strain, 0, depth, limit=200)[0]
        assert depth_compliance(depth, a, strain_modulus, nu) == pytest.approx(exact, rel=error)


def test_hertz_line_contact_identities():
    load, radius, modulus = 4.4e5, 6e-3, 2.26e11
    a, p = half_width(load, radius, modulus), peak_pressure(load, radius, modulus)
    assert p == pytest.approx(float(modulus * a / (4 * radius)))
    assert 0.5 * math.pi * a * p == pytest.approx(load)


@pytest.mark.parametrize("name", MODELS)
def test_record_and_symmetries(name, article_pair):
    model = MODELS[name]
    path = article_pair.path_of_contact(7)
    found = model(article_pair, path)
    k = np.asarray(found)
    assert k.shape == (7,)
    assert k.dtype == float
    assert np.allclose(k, 1 / sum(found.parts.values()))
    assert all(np.all(part > 0) for part in found.parts.values())
    assert found.error is None
    assert np.array_equal(np.asarray(pickle.loads(pickle.dumps(found))), k)
    with pytest.raises(TypeError):
        found.parts["bending"] = k
    swapped = GearPair(article_pair.wheel, article_pair.pinion, 2e-3, 40e-3)
    assert np.allclose(np.asarray(model(swapped, swapped.path_of_contact(7)))[::-1], k, rtol=1e-9)


@pytest.mark.parametrize("name", ["ishikawa", "potential_energy"])
def test_linear_forms_scale_with_face_width_and_modulus_not_with_the_module(name):
    one = GearPair(Gear(30), Gear(50), 1e-3, 10e-3)
    two = GearPair(Gear(30), Gear(50), 5e-3, 20e-3, material=Material(103e9, 0.3, 1000.0))
    k = [np.asarray(MODELS[name](pair, pair.path_of_contact(5))) for pair in (one, two)]
    assert np.allclose(k[0], k[1], rtol=1e-10)


def test_only_the_contact_depends_on_the_force_and_hardens(article_pair):
    path = article_pair.path_of_contact(3)
    light, heavy = (closed_form.weber_banaschek(article_pair, path, f) for f in (2e3, 2e4))
    assert np.array_equal(light.parts["tooth"], heavy.parts["tooth"])
    assert np.array_equal(light.parts["body"], heavy.parts["body"])
    assert np.all(np.asarray(heavy) > np.asarray(light))
    # ln a^2 falls by ln 10
    expected = 2 * (1 - 0.3**2) / (math.pi * 206e9 * 40e-3) * math.log(10)
    assert np.allclose(light.parts["contact"] - heavy.parts["contact"], expected)


@pytest.mark.parametrize("force", [0.0, -1.0, math.nan, math.inf])
def test_forces_that_are_none(article_pair, force):
    path = article_pair.path_of_contact(3)
    for call in (closed_form.weber_banaschek, closed_form.potential_energy, closed_form.hertz):
        with pytest.raises(GeometryError, match="force"):
            call(article_pair, path, force)
    with pytest.raises(GeometryError, match="force"):
        closed_form.iso6336(article_pair, force)


def test_points_beyond_the_flanks_are_refused(article_pair):
    path = article_pair.path_at([article_pair.points.E + 1e-4])
    with pytest.raises(GeometryError, match="between A and E"):
        closed_form.ishikawa(article_pair, path)


def test_ranges_warn(article_pair):
    path = article_pair.path_of_contact(3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for model in MODELS.values():
            model(article_pair, path)
        closed_form.iso6336(article_pair)
    few = GearPair(Gear(18), Gear(40), 2e-3, 0.02)
    with pytest.warns(RangeWarning, match=r"the pinion has theta_f = 0\.1"):
        closed_form.potential_energy(few, few.path_of_contact(3))
    solid = GearPair(Gear(36, bore_radius=3e-3), Gear(40), 2e-3, 0.04)
    with pytest.warns(RangeWarning, match="the pinion has h = 11"):
        closed_form.potential_energy(solid, solid.path_of_contact(3))
    with pytest.warns(RangeWarning, match="depth over half-width"):
        closed_form.hertz(article_pair, path, 2e6)
    odd = GearPair(Gear(36, -0.1), Gear(40, 0.1), 2e-3, 0.04)
    with pytest.warns(RangeWarning, match="x1 = -0.1 is less than x2"):
        closed_form.iso6336(odd)


def test_stress_of_spur_gears_falls_with_the_contact_ratio(article_pair):
    """Z_eps^2 = (4 - eps_alpha)/3 (ISO 6336-2, clause 6)."""
    z = closed_form.iso6336_2(article_pair, 10e3).Z_eps
    assert 3.0 * z**2 + article_pair.contact_ratio == pytest.approx(4.0, rel=1e-12)


def test_shear_of_a_rectangle_is_a_fifth_more_than_that_of_its_mean():
    """Of a parabola over the depth, Int (3/2)^2 (1 - s^2)^2 ds/2 = 6/5; axial and shear share the rest."""
    ratio = quad(lambda s: 2.25 * (1.0 - s**2) ** 2 / 2.0, -1.0, 1.0)[0]
    pair = GearPair(Gear(30), Gear(30), 2e-3, 0.04)
    path = pair.path_at(np.array([pair.points.C]))  # where both gears are alike
    (angle,) = loaded_teeth(pair, path)[0].load_angle
    parts = closed_form.potential_energy(pair, path).parts
    wanted = ratio * 2.0 * (1.0 + pair.materials[0].poisson_ratio) / math.tan(angle) ** 2
    np.testing.assert_allclose(parts["shear"] / parts["axial"], wanted, rtol=1e-10)


def test_iso_light_load_and_modulus(article_pair):
    full = closed_form.iso6336(article_pair)
    limit = 100e3 * 40e-3 / math.cos(math.radians(20))
    assert closed_form.iso6336(article_pair, limit).c_prime == pytest.approx(full.c_prime)
    assert asdict(closed_form.iso6336(article_pair, 2 * limit)) == asdict(full)
    assert closed_form.iso6336(article_pair, limit / 16).c_prime == pytest.approx(full.c_prime / 2)
    assert full.single_stiffness == pytest.approx(full.c_prime * 1e9 * 40e-3)
    soft = GearPair(Gear(36), Gear(40), 2e-3, 0.04, material=Material(103e9, 0.3, 100.0))
    assert closed_form.iso6336(soft).c_gamma == pytest.approx(full.c_gamma / 2)


def test_ring_wind_up_is_the_twist_of_concentric_rings():
    """Two rings in series twist as one."""
    whole = closed_form.ring_wind_up(0.03, 0.01, 0.032, 80e9)
    parts = closed_form.ring_wind_up(0.03, 0.02, 0.032, 80e9) + closed_form.ring_wind_up(
        0.02, 0.01, 0.032, 80e9
    )
    assert whole == pytest.approx(parts)


@pytest.mark.parametrize(
    ("ratio", "share"), [(0.2, 0.0138), (0.5, 0.0933), (0.7, 0.1817), (0.9, 0.2827), (0.9999, 1 / 3)]
)
def test_inertia_leaves_a_share_of_the_wind_up(ratio, share):
    """Known numbers, and the integral by quadrature, with an inertia on the bore too."""
    found = closed_form.inertial_share(ratio)
    assert found == pytest.approx(share, abs=1.2e-4)
    t, weight = np.polynomial.legendre.leggauss(60)
    x = ratio + 0.5 * (1 - ratio) * (1 + t)
    for hub in (0.0, 0.05, 3.0):
        carried = (hub + x**4 - ratio**4) / (hub + 1 - ratio**4)
        expected = weight @ (carried**2 / x**3) / (weight @ x**-3.0)
        assert closed_form.inertial_share(ratio, hub) == pytest.approx(expected, rel=1e-10)


def test_a_heavy_hub_holds_the_ring():
    shares = [closed_form.inertial_share(0.5, hub) for hub in (0.0, 0.1, 1.0, 10.0, 1e6)]
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1.0, abs=1e-5)
