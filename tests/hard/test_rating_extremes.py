"""Ratings where the standards end: few teeth, steep helices, resonance, thin and hot oil, long spectra, odd sizes."""

from __future__ import annotations

import math
import warnings
from typing import Any

import pytest

from base import InputError
from flankfilm.stages.rating import RATING
from gears.rating import Rating
from tests.flankfilm.test_rating_scene import GEAR, WHOLE, engine, faults, put


def rated(**values: Any) -> tuple[Rating, tuple[str, ...]]:
    """Rating of a scene with other values, and what the run warns of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = engine(put(WHOLE, **values))
        return run[RATING], run.runs[RATING.name].warnings


@pytest.mark.filterwarnings("ignore::gears.GeometryWarning")
@pytest.mark.parametrize("teeth", [8, 9])
def test_fewer_than_ten_teeth(teeth: int):
    """Undercut pinions are rated, or refused with a reason that names what has none."""
    pinion = {"teeth": teeth, "profile_shift": 0.5}
    said = faults(put(WHOLE, pair__pinion=pinion))
    assert "above" not in said
    assert "up to which running in is confirmed" in said["rating.K_Hbeta"]
    rating, _ = rated(pair__pinion=pinion, rating__K_Hbeta=1.3, operating__pinion_torque_Nm=40.0)
    assert 0.0 < rating.S_H[0] < 100.0
    assert rating.bending_fault or rating.S_F[0] > 0.0
    assert rating.scuffing_fault or rating.S_S > 0.0


@pytest.mark.parametrize("angle", [35.0, -35.0, 45.0])
def test_steep_helices_are_rated_with_a_warning(angle: float):
    rating, heard = rated(pair__helix_angle_deg=angle)
    assert any("up to 30 deg" in text for text in heard)
    assert rating.S_H[0] > 1.0
    assert rated(pair__helix_angle_deg=30.0)[1] == ()


def test_hands_of_the_helix_have_one_rating():
    right, left = (rated(pair__helix_angle_deg=angle)[0] for angle in (20.0, -20.0))
    assert pytest.approx(right.S_H, rel=1e-12) == left.S_H
    assert pytest.approx(right.S_F, rel=1e-12) == left.S_F


def test_through_the_resonance():
    """A warning from N 0.85 to 1.15 alone, and a safety that is least there."""
    subcritical = rated()[0].factors
    speeds = {N: 2000.0 * N / subcritical.N for N in (0.5, 0.86, 1.0, 1.14, 1.3, 3.0)}
    found = {N: rated(operating__pinion_speed_rpm=speed) for N, speed in speeds.items()}
    at_resonance = {N for N, (_, heard) in found.items() if any("resonance ratio" in text for text in heard)}
    assert at_resonance == {0.86, 1.0, 1.14}
    factors = {N: rating.factors.K_v for N, (rating, _) in found.items()}
    assert max(factors, key=factors.__getitem__) in at_resonance
    assert next(rating.factors.regime for rating, _ in found.values()) == "subcritical"
    assert [rating.factors.regime for rating, _ in found.values()][-1] == "supercritical"


def test_speeds_from_creep_to_turbines():
    for rpm in (1e-3, 1.0, 1e5):
        rating, _ = rated(operating__pinion_speed_rpm=rpm)
        assert all(math.isfinite(safety) and safety > 0.0 for safety in (*rating.S_H, *rating.S_F))


def test_oil_at_the_ends_of_its_law():
    for celsius in (-19.0, 149.0):
        rating, _ = rated(lubricant__temperature_C=celsius)
        assert math.isfinite(rating.S_S)
    assert set(faults(put(WHOLE, lubricant__temperature_C=200.0))) == {"lubricant.temperature_C"}
    thin = {"nu_40_mm2_per_s": 10.0, "nu_100_mm2_per_s": 12.0, "temperature_C": 80.0}
    assert set(faults(put(WHOLE, rating__oil=thin))) == {"rating.oil.nu_100_mm2_per_s"}


def test_reversed_and_idle_spectra_are_refused():
    idle = {"torque_Nm": 0.0, "speed_rpm": 100.0, "duration_h": 1.0}
    assert set(faults(put(WHOLE, rating__spectrum=[idle]))) == {"rating.spectrum"}
    back = idle | {"torque_Nm": -100.0}
    said = faults(put(WHOLE, rating__spectrum=[idle, back]))
    assert set(said) == {"rating.spectrum.1.torque_Nm"}
    assert set(faults(put(WHOLE, rating__spectrum=[idle | {"cycles": 1e6}]))) == {"rating.spectrum.0"}


def test_an_overload_is_the_end_of_a_life():
    """A step above the life curve fails the gear at once: its damage is infinite, and no life is left."""
    steps = [{"torque_Nm": 5000.0, "speed_rpm": 100.0, "duration_h": 1.0}]
    spectrum = rated(rating__spectrum=steps, rating__K_Hbeta=1.2)[0].spectrum
    assert math.isinf(max(spectrum.damage_H))
    assert spectrum.life == 0.0
    light = [{"torque_Nm": 1.0, "speed_rpm": 1000.0, "duration_h": 1e4}]
    spectrum = rated(rating__spectrum=light, rating__K_Hbeta=1.2)[0].spectrum
    assert max(spectrum.damage_H) == 0.0
    assert math.isinf(spectrum.life)


def test_a_long_spectrum_is_that_of_its_pieces():
    piece = {"torque_Nm": 280.0, "speed_rpm": 2000.0, "duration_h": 10.0}
    many = rated(rating__spectrum=[piece] * 200)[0].spectrum
    whole = rated(rating__spectrum=[piece | {"duration_h": 2000.0}])[0].spectrum
    assert many.damage_H == pytest.approx(whole.damage_H, rel=1e-9)
    assert pytest.approx(whole.S_F, rel=1e-9) == many.S_F


def test_what_is_not_of_steel_and_not_external_is_refused_with_the_reason():
    plastic = {"pinion": {"name": "steel"}, "wheel": {"youngs_modulus_GPa": 3.0, "poisson_ratio": 0.4}}
    said = faults(put(WHOLE, material=plastic))
    assert set(said) == {"material.wheel.youngs_modulus_GPa"}
    assert "are of steel" in said["material.wheel.youngs_modulus_GPa"]
    assert "Internal gears" in faults(put(WHOLE, pair__wheel__teeth=-95))["pair.wheel.teeth"]
    assert set(faults(put(WHOLE, rating__pinion=GEAR | {"steel": "POM"}))) == {"rating.pinion.steel"}


@pytest.mark.parametrize("grade", [0, 12])
def test_first_and_last_grade(grade: int):
    rating, _ = rated(rating__accuracy_grade=grade, rating__K_Hbeta=1.2)
    assert rating.tolerances.grade == grade
    assert rating.S_H[0] > 0.0


def test_gears_beyond_the_tolerances_are_refused_by_their_sizes():
    with pytest.raises(InputError) as caught:
        engine(put(WHOLE, pair__module_mm=0.2, operating__pinion_torque_Nm=0.01))[RATING]
    assert "pair.module_mm" in {fault.where for fault in caught.value.faults}
