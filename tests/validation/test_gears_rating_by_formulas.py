"""The listing's whole rating by another program: `listing_by_formulas`, written from the formulas without `gears`."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from gears import Blank, Gear
from gears.closed_form.tooth_stiffness import iso6336
from gears.rating import load_factors, pitting_safety, reduced_mass, run_in, run_in_relief, tolerances
from gears.rating.bending import bending_safety
from tests.validation import listing_by_formulas as formulas
from tests.validation.rated_pairs import CASE_HARDENED, RPM, listing, printed
from tests.validation.test_gears_rating_scuffing import rated

SPEED = 1165.9 * RPM
PAIR = listing()
CLOSE = 5e-6
"""The centre distance of the shifts and the printed one differ by 0.1 um."""


@pytest.fixture(scope="module")
def loads():
    effective, relief = run_in(PAIR, CASE_HARDENED, SPEED, tolerances(PAIR, 6)), run_in_relief(CASE_HARDENED)
    given = {"effective": effective, "relief": relief, "face_load_factor": 1.15, "mass": 365.03}
    return load_factors(PAIR, 40_953.0, SPEED, application_factor=1.25, **given)


def of_ours(**readings):
    """Formulas with the C_R that the listing's wheel has here: 0.898 but for further digits."""
    return {"C_R": iso6336(PAIR).C_R, **readings}


def test_load_factors(loads):
    other = formulas.load_factors(**of_ours())
    assert loads.K_v == pytest.approx(other["K_v"], rel=CLOSE)
    assert loads.K_Halpha == pytest.approx(other["K_Halpha"], rel=CLOSE)
    assert pytest.approx(other["N"], rel=CLOSE) == loads.N
    assert loads.resonance_speed / RPM == pytest.approx(other["n_E1"], rel=CLOSE)


def test_pitting(loads):
    other = formulas.pitting(**of_ours())
    ours = pitting_safety(
        PAIR, 40_953.0, SPEED, loads, CASE_HARDENED,
        viscosity_40=220e-6, roughness=4.8e-6, life=175200.0 * 3600.0, Z_W=(1.0, 1.0), Z_X=1.0, pitting_permitted=False,
    )  # fmt: skip
    assert 1e-6 * ours.sigma_H[0] == pytest.approx(other["sigma_H"], rel=CLOSE)
    assert [1e-6 * limit for limit in ours.sigma_HG] == pytest.approx(other["sigma_HG"], rel=CLOSE)
    assert pytest.approx(other["S_H"], rel=CLOSE) == ours.S_H
    assert pytest.approx([other[n] for n in ("Z_L", "Z_V", "Z_R")], rel=CLOSE) == (
        ours.Z_L,
        ours.Z_V,
        ours.Z_R,
    )


def test_factors_of_the_roots(loads):
    other = formulas.bending()
    ours = bending_safety(
        PAIR, 40_953.0, SPEED, loads, CASE_HARDENED, root_roughness=(20e-6, 20e-6), life=175200.0 * 3600.0
    )
    assert pytest.approx(other["Y_NT"], rel=1e-9) == ours.Y_NT
    assert ours.Y_RrelT[0] == pytest.approx(other["Y_RrelT"], rel=1e-9)
    assert ours.Y_X[0] == pytest.approx(other["Y_X"], rel=1e-9)


@pytest.mark.parametrize("line_load", [None, 1119.632])
def test_scuffing(line_load):
    ours = rated(line_load)
    other = formulas.scuffing(**of_ours(), **({} if line_load is None else {"line_load": line_load}))
    for name in ("K_Bgamma", "mu", "X_R", "X_M", "X_alphabeta", "X_BE", "X_eps", "theta_flaint"):
        assert getattr(ours, name) == pytest.approx(other[name], rel=1e-5)
    assert ours.X_Ca == pytest.approx(other["X_Ca"], rel=1e-5)
    assert ours.theta_int - 273.15 == pytest.approx(other["theta_int"], rel=CLOSE)
    assert ours.S_intS == pytest.approx(other["S"], rel=CLOSE)
    assert 1e-3 * ours.w_Bt == pytest.approx(other["w_Bt"], rel=CLOSE)


def test_the_printed_line_load_lies_within_the_unprinted_digits():
    """C_R 0.898 may be 0.8975 to 0.8985; f_pb 15.95 or rounded to 16 um; z_n by the base helix or z/cos^3(beta)."""
    angle = formulas.geometry()["alpha_t"]
    loads = [
        formulas.scuffing(C_R=C_R, cube=cube, f_pt=f_pt)["w_Bt"]
        for C_R in (0.8975, 0.8985)
        for cube in (False, True)
        for f_pt in (17.0, 16.0 / math.cos(angle))
    ]
    assert min(loads) < 1119.632 < max(loads)
    assert max(loads) / min(loads) < 1.0 + 4e-4


def test_one_wheel_has_the_printed_stiffness_and_mass():
    """A rim of 36.24 mm gives m_red 0.36503 kg/mm at 7830 kg/m3, and with a web of 0.425 of its width C_R 0.898."""
    blank = Blank(rim_thickness=36.24e-3, web_thickness=0.425 * 0.36)
    wheel = Gear(95, 0.6691, tip_alteration=-0.938 / 14.0, blank=blank)
    steel = replace(PAIR.materials[0], density=7830.0)
    pair = replace(PAIR, wheel=wheel, material=steel)
    assert 1e-3 * reduced_mass(pair) == printed(0.36503, 5)
    assert printed(0.898, 3) == iso6336(pair).C_R
