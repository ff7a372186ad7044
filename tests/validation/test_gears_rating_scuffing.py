"""Scuffing by the integral temperature against a published listing (`rated_pairs`).

Its B_M, 13.780, is that of k rho c = 50 W/(m K), 7750 kg/m3, 490 J/(kg K); any other steel of this product does.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from gears import Material
from gears.closed_form import ohlendorf_loss_factor
from gears.rating import GearOil, load_factors, run_in, run_in_relief, scuffing_safety, tolerances
from tests.validation.rated_pairs import CASE_HARDENED, RPM, listing, printed

SPEED = 1165.9 * RPM
OIL = GearOil(220e-6, 19e-6, 890.0, 353.15)
STEEL = Material(206e9, 0.3, 7750.0, conductivity=50.0, heat_capacity=490.0)


def rated(line_load=None):
    """The listing's rating, with the load factors computed here or with its printed line load w_Bt [N/mm]."""
    pair = replace(listing(), material=STEEL)
    effective, relief = run_in(pair, CASE_HARDENED, SPEED, tolerances(pair, 6)), run_in_relief(CASE_HARDENED)
    given = {"effective": effective, "relief": relief, "face_load_factor": 1.15, "mass": 365.03}
    loads = load_factors(pair, 40_953.0, SPEED, application_factor=1.25, **given)
    if line_load is not None:
        scale = 1e3 * line_load / (loads.line_load * loads.contact)
        loads = replace(loads, K_Hbeta=loads.K_Hbeta * scale)
    test = {"test_torque": 714.2, "structure": 1.0, "supply": 1.0}
    return scuffing_safety(pair, SPEED, loads, OIL, roughness=0.6e-6, relief=relief, **test)


@pytest.fixture(scope="module")
def safety():
    return rated(line_load=1119.632)


@pytest.mark.parametrize(
    ("name", "value", "digits"),
    [
        ("K_Bgamma", 1.274, 3),
        ("X_M", 50.058, 3),
        ("X_alphabeta", 1.016, 3),
        ("mu", 0.030, 3),
        ("X_R", 0.712, 3),
        ("X_BE", 0.230, 3),
        ("X_eps", 0.263, 3),
        ("X_Ca", 1.095, 3),
        ("theta_flaint", 16.25, 2),
    ],
)
def test_factors_and_safety(safety, name, value, digits):
    assert getattr(safety, name) == printed(value, digits)


def test_thermal_coefficient(safety):
    assert 1e-3 * safety.B_M[0] == printed(13.780, 3)


def test_temperatures(safety):
    """With the oil's viscosity by Ubbelohde and Walther, and a density that falls by 0.7 kg/m3 per kelvin."""
    assert safety.theta_M - 273.15 == printed(91.37, 2)
    assert safety.theta_int - 273.15 == printed(115.75, 2)
    assert safety.S_intS == printed(3.932, 3)
    assert safety.theta_Sint - 273.15 == printed(455.17, 2)


def test_with_the_load_factors_computed_here():
    """Their line load is 2e-4 below the print, within the unprinted digits of its C_R; temperatures follow."""
    ours = rated()
    assert 1e-3 * ours.w_Bt == pytest.approx(1119.632, rel=2e-4)
    assert ours.theta_flaint == pytest.approx(16.25, rel=5e-4)
    assert ours.S_intS == pytest.approx(3.932, rel=3e-4)


def test_mesh_loss(safety):
    """15.635 kW of 5000 kW by Ohlendorf's factor; its friction has the viscosity with the density at 15 degC."""
    at_15 = OIL.kinematic_viscosity * OIL.density_15
    mu = safety.mu * (at_15 / OIL.dynamic_viscosity) ** -0.05
    assert 5000.0 * mu * ohlendorf_loss_factor(listing()) == printed(15.635, 3)
