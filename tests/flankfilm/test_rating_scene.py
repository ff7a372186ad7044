"""A wanted rating: the listing from a scene, all faults at once, what the run adds of our own, and studies."""

from __future__ import annotations

import copy
import math
from typing import Any

import pytest

from base import InputError
from flankfilm.building.preflight import refuse
from flankfilm.files.cache import Cache
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE
from flankfilm.stages.rating import LOADED_FACTORS, RATING
from flankfilm.studies.outputs import OUTPUTS
from tests.validation.rated_pairs import printed

GEAR = {"steel": "Eh", "sigma_Hlim_MPa": 1500.0, "sigma_Flim_MPa": 430.0, "root_Rz_um": 20.0}
WHOLE: dict[str, Any] = {
    "wants": ["rating"],
    "pair": {
        "module_mm": 2.0, "face_width_mm": 40.0, "pinion": {"teeth": 36}, "wheel": {"teeth": 40}, "backlash_um": 50.0,
    },
    "material": {"name": "steel"},
    "operating": {"pinion_torque_Nm": 300.0, "pinion_speed_rpm": 2000.0},
    "lubricant": {"iso_vg": 220.0, "temperature_C": 80.0},
    "rating": {
        "accuracy_grade": 6, "K_A": 1.25, "life_h": 20000.0, "flank_Rz_um": 4.8, "pinion": GEAR,
        "scuffing": {"T_1T_Nm": 450.1},
    },
}  # fmt: skip

LISTING: dict[str, Any] = {
    "wants": ["rating"],
    "pair": {
        "module_mm": 14.0, "face_width_mm": 360.0, "helix_angle_deg": 10.0, "centre_distance_mm": 861.0,
        "pinion": {"teeth": 24, "profile_shift": 0.48, "tip_alteration": -0.067},
        "wheel": {
            "teeth": 95, "profile_shift": 0.6691, "tip_alteration": -0.067,
            "blank": {"rim_thickness_mm": 42.0, "web_thickness_mm": 142.128},
        },
    },
    "material": {
        "youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3, "density_kg_per_m3": 7750.0, "conductivity_W_per_m_K": 50.0,
        "heat_capacity_J_per_kg_K": 490.0,
    },
    "operating": {"pinion_torque_Nm": 40953.0, "pinion_speed_rpm": 1165.9},
    "rating": {
        "accuracy_grade": 6, "K_A": 1.25, "K_Hbeta": 1.15, "life_h": 175200.0, "flank_Ra_um": 0.6, "flank_Rz_um": 4.8,
        "reduced_mass_kg_per_m": 365.03, "pinion": GEAR, "scuffing": {"T_1T_Nm": 714.2},
        "oil": {
            "nu_40_mm2_per_s": 220.0, "nu_100_mm2_per_s": 19.0, "density_15_kg_per_m3": 890.0, "temperature_C": 80.0,
        },
    },
}  # fmt: skip


def put(raw: dict[str, Any], **values: Any) -> dict[str, Any]:
    """Scene with other values at paths whose dots are double underscores; None leaves a key out."""
    changed = copy.deepcopy(raw)
    for path, value in values.items():
        *tables, key = path.split("__")
        table = changed
        for name in tables:
            table = table.setdefault(name, {})
        table[key] = value
        if value is None:
            del table[key]
    return changed


def engine(raw: dict[str, Any]) -> Engine:
    return Engine(validated(copy.deepcopy(raw)), Cache(None))


def faults(raw: dict[str, Any]) -> dict[str, str]:
    """Faults of a scene by their keys: those of its file, or else those that show without solving."""
    with pytest.raises(InputError) as caught:
        refuse(validated(copy.deepcopy(raw)))
    return {fault.where: str(fault) for fault in caught.value.faults}


@pytest.mark.filterwarnings("ignore::base.RangeWarning")
def test_the_listing_from_a_scene():
    rating = engine(LISTING)[RATING]
    factors, pitting, bending, scuffing = rating.factors, rating.pitting, rating.bending, rating.scuffing
    assert (factors.K_v, factors.K_Halpha) == (printed(1.092, 3), printed(1.069, 3))
    assert printed(0.410, 3) == factors.N
    limits = [1e-6 * limit for limit in (*pitting.sigma_HG, *bending.sigma_FG)]
    assert limits == [
        printed(1338.30, 2),
        pytest.approx(1387.31, abs=0.01),
        printed(637.15, 2),
        printed(654.72, 2),
    ]
    assert (printed(1.81, 2), printed(1.88, 2)) == rating.S_H
    assert (printed(3.26, 2), printed(3.09, 2)) == rating.S_F
    assert scuffing.theta_Sint - 273.15 == printed(455.17, 2)
    assert pytest.approx(3.932, abs=1.5e-3) == rating.S_S
    assert rating.enough


def test_oil_and_roughness_come_from_their_sections():
    graded = engine(WHOLE)[RATING]
    sheet = {
        "nu_40_mm2_per_s": 220.0,
        "nu_100_mm2_per_s": 18.9,
        "density_15_kg_per_m3": 885.0,
        "temperature_C": 80.0,
    }
    by_sheet = engine(put(WHOLE, lubricant=None, rating__oil=sheet))[RATING]
    assert by_sheet.S_H == graded.S_H
    assert pytest.approx(graded.S_S, rel=1e-3) == by_sheet.S_S
    roughness = {"Ra_um": 0.6, "wheel_Ra_um": 1.0}
    drawn = engine(put(WHOLE, rating__flank_Rz_um=None, roughness=roughness))[RATING]
    assert drawn.S_H == graded.S_H  # 6 Ra, the mean of both flanks


def test_faults_of_keys_come_together():
    said = faults(
        put(
            WHOLE,
            rating__accuracy_grade=13,
            rating__pinion__steel="GGG",
            rating__K_A=0.5,
            rating__spectrum=[{"torque_Nm": -5.0, "speed_rpm": 100.0, "duration_h": 1.0}],
            pair__wheel__teeth=-40,
            operating__pinion_speed_rpm=None,
        )
    )
    assert {
        "rating.accuracy_grade", "rating.pinion.steel", "rating.K_A", "rating.spectrum.0.torque_Nm", "pair.wheel.teeth",
        "operating.pinion_speed_rpm",
    } == set(said)  # fmt: skip


def test_faults_that_show_without_solving_come_together():
    plastic = {"youngs_modulus_GPa": 3.0, "poisson_ratio": 0.4, "density_kg_per_m3": 1140.0}
    soft = GEAR | {"steel": "V"}
    said = faults(put(WHOLE, material=plastic, rating__wheel=soft))
    assert "are of steel" in said["material.youngs_modulus_GPa"]
    assert "VDI 2736" in said["material.youngs_modulus_GPa"]
    assert "required by the notch sensitivity" in said["rating.wheel.proof_stress_MPa"]
    assert len(said) == 2
    assert set(faults(put(WHOLE, pair__face_width_mm=3.0))) == {"pair.face_width_mm"}


def test_what_is_missing_is_named():
    assert set(faults(put(WHOLE, rating=None))) == {"[rating]"}
    oil = {"viscosity_Pa_s": 0.03, "pressure_viscosity_per_GPa": 16.0}
    assert set(faults(put(WHOLE, lubricant=oil, rating__flank_Rz_um=None))) == {
        "rating.flank_Rz_um", "rating.oil.nu_40_mm2_per_s", "rating.oil.nu_100_mm2_per_s", "rating.oil.temperature_C",
    }  # fmt: skip
    assert "X_L" in faults(put(WHOLE, lubricant__base="pao"))["lubricant.base"]
    assert set(faults(put(WHOLE, rating__life_h=None))) == {"rating.life_h"}
    hot = {"nu_40_mm2_per_s": 220.0, "nu_100_mm2_per_s": 19.0, "temperature_C": 250.0}
    assert set(faults(put(WHOLE, rating__oil=hot))) == {"rating.oil.temperature_C"}


def test_outputs_of_studies():
    run = engine(put(WHOLE, rating__spectrum=[{"torque_Nm": 300.0, "speed_rpm": 2000.0, "cycles": 1e8}]))
    rating = run[RATING]
    value = {name: OUTPUTS[name].value(run) for name in OUTPUTS if OUTPUTS[name].wants == ("rating",)}
    assert value["S_H"] == min(rating.S_H)
    assert value["S_F_wheel"] == rating.S_F[1]
    assert value["S_S"] == rating.S_S
    assert value["iso_K_v"] == rating.factors.K_v
    assert value["damage_flanks"] == max(rating.spectrum.damage_H)
    assert value["spectrum_life_h"] == pytest.approx(rating.spectrum.life / 3600.0)
    assert all(math.isfinite(number) for number in value.values())


@pytest.mark.parametrize(
    ("change", "where", "said"),
    [
        ({"rating__accuracy_grade": 13}, "rating.accuracy_grade", "ISO 1328-1:1995 has these grades"),
        (
            {"rating__pinion": {**GEAR, "steel": "GGG"}},
            "rating.pinion.steel",
            "irons, and plastics, are not rated",
        ),
        (
            {"rating__spectrum": [{"torque_Nm": -100.0, "speed_rpm": 1000.0, "duration_h": 10.0}]},
            "rating.spectrum.0.torque_Nm",
            "load the other flanks",
        ),
    ],
)
def test_what_no_rating_takes_says_what_to_do(change, where, said):
    with pytest.raises(InputError, match=said) as caught:
        validated(put(WHOLE, **change))
    assert [fault.where for fault in caught.value.faults] == [where]


@pytest.mark.slow
@pytest.mark.long
def test_lines_of_a_helical_pair_go_on_over_tip_edges_in_its_load_factors():
    """Held to the path they begin in a corner of the face with their whole approach, which no gear has."""
    whole = {**WHOLE, "wants": ["rating", "stiffness"], "tolerance": 0.1}
    scene = put(whole, pair__helix_angle_deg=20.0, operating__pinion_torque_Nm=600.0)
    run, held = engine(scene), engine(put(scene, stiffness__contact_beyond_path=False))
    factors, without = run[LOADED_FACTORS], held[LOADED_FACTORS]
    assert run[DRY_CYCLE].lines.greatest_line_load_factor == without.K_H
    assert 1.0 < factors.K_H < 0.8 * without.K_H
    assert factors.K_H < factors.K_H_unequal < 0.8 * without.K_H_unequal
