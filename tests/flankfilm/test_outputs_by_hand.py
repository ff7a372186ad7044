"""Outputs of a study against numbers worked out from the gears' radii, a closed form's curve and Dowson's formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flankfilm.files.cache import Cache
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.studies.outputs import OUTPUTS
from gears import Gear, GearPair, Material, closed_form
from tests.flankfilm.scenes import ARTICLE

SCENE = f"""
wants = [WANTS]
tolerance = 0.005
{ARTICLE}
[stiffness]
model = "potential-energy"
pairs = "independent"
[film]
model = "FILM"
"""
ALPHA, TURN = math.radians(20), 2000 * math.pi / 30
R_B = (36e-3 * math.cos(ALPHA), 40e-3 * math.cos(ALPHA))
PITCH = 2e-3 * math.pi * math.cos(ALPHA)
LINE = 76e-3 * math.sin(ALPHA)
END = math.sqrt(38e-3**2 - R_B[0] ** 2)  # rho1 at E, on the pinion's tip circle
START = LINE - math.sqrt(42e-3**2 - R_B[1] ** 2)  # at A, on the wheel's
FORCE = 600 / R_B[0]
MODULUS = 200.2e9 / 0.91
"""E', of equal materials with nu = 0.3."""


def values(wants: str, film: str) -> dict[str, float]:
    engine = Engine(parse_scene(SCENE.replace("WANTS", wants).replace("FILM", film)), Cache(None))
    asked = set(wants.replace('"', "").split(", ")) | {"geometry"}
    return {name: one.value(engine) for name, one in OUTPUTS.items() if set(one.wants) <= asked}


def single_pair(rho1: np.ndarray) -> np.ndarray:
    """Stiffness of one pair of teeth that carries the whole force [N/m], zero beyond the path."""
    pair = GearPair(Gear(36, bore_radius=16.75e-3), Gear(40, bore_radius=18.75e-3), 2e-3, 0.04,
                    material=Material(200.2e9, 0.3, 7850.0))  # fmt: skip
    path = pair.path_of_contact(n=400)
    return np.interp(
        rho1,
        path.rho1,
        np.asarray(closed_form.potential_energy(pair, path, force=FORCE)),
        left=0.0,
        right=0.0,
    )


def pressure(load: float, rho1: float) -> float:
    """Hertz pressure [GPa]."""
    return math.sqrt(load * MODULUS / (2 * math.pi * rho1 * (LINE - rho1) / LINE)) / 1e9


def test_geometry_and_stiffness():
    found = values('"stiffness"', "none")
    assert found["contact_ratio"] == pytest.approx((END - START) / PITCH, rel=1e-12)
    assert found["centre_distance_mm"] == pytest.approx(76.0, rel=1e-12)
    assert found["working_pressure_angle_deg"] == pytest.approx(20.0, rel=1e-12)
    speeds = np.array([[TURN * rho, 0.9 * TURN * (LINE - rho)] for rho in (START, END)])
    sliding = np.abs(speeds[:, 0] - speeds[:, 1])
    assert found["sliding_speed_m_per_s"] == pytest.approx(sliding.max(), rel=1e-12)
    assert found["specific_sliding"] == pytest.approx((sliding[:, None] / speeds).max(), rel=1e-12)
    places = (np.arange(20000) + 0.5) / 20000
    mesh = sum(single_pair(START + (places + ahead) * PITCH) for ahead in (0, 1))
    per_face = 1e-9 / 0.04
    for name in ("mean_secant_stiffness", "mean_stiffness"):
        assert found[f"{name}_N_per_mm_um"] == pytest.approx(per_face * mesh.mean(), rel=5e-4)
    assert found["least_secant_stiffness_N_per_mm_um"] == pytest.approx(per_face * mesh.min(), rel=1e-3)
    assert found["largest_secant_stiffness_N_per_mm_um"] == pytest.approx(per_face * mesh.max(), rel=1e-3)
    apart = 1e6 * FORCE * (1 / mesh.min() - 1 / mesh.max())
    assert found["transmission_error_um"] == pytest.approx(apart, rel=2e-3)
    for order in range(1, 6):
        size = 2 * abs(np.mean(mesh * np.exp(-2j * math.pi * order * places))) / mesh.mean()
        assert found[f"harmonic_{order}"] == pytest.approx(size, rel=5e-3)
        assert found[f"tangent_harmonic_{order}"] == pytest.approx(size, rel=5e-3)


def test_film_and_pressure():
    found = values('"stiffness", "film"', "dowson")
    pitch_point = 36e-3 * math.sin(ALPHA)
    radius, load = pitch_point * (LINE - pitch_point) / LINE, FORCE / 0.04
    U = 0.075 * TURN * pitch_point / (MODULUS * radius)
    W, G = load / (MODULUS * radius), 19.6e-9 * MODULUS
    central = 3.06 * U**0.69 * G**0.56 * W**-0.1 * radius
    least = 2.65 * U**0.7 * G**0.54 * W**-0.13 * radius
    assert found["film_at_C_um"] == pytest.approx(1e6 * central, rel=1e-3)
    # films stand at forty positions of a base pitch, the nearest within an eightieth
    assert found["least_film_at_C_um"] == pytest.approx(1e6 * least, rel=0.01)
    half = PITCH / 80
    inside = {"B": END - PITCH + half, "C": pitch_point, "D": START + PITCH - half}
    for point, rho1 in inside.items():
        assert found[f"hertz_pressure_at_{point}_GPa"] == pytest.approx(pressure(load, rho1), rel=3e-3)
    for point, rho1, other in (
        ("A", START + half, START + half + PITCH),
        ("E", END - half, END - half - PITCH),
    ):
        stiff = single_pair(np.array([rho1, other]))
        share = load * stiff[0] / stiff.sum()
        assert found[f"hertz_pressure_at_{point}_GPa"] == pytest.approx(pressure(share, rho1), rel=0.02)
    assert found["hertz_pressure_GPa"] == pytest.approx(pressure(load, inside["B"]), rel=3e-3)
    at_points = min(found[f"least_film_at_{point}_um"] for point in "ABCDE")
    assert 0.98 * at_points < found["least_film_um"] <= at_points
    assert 0.98 * found["film_at_C_um"] < found["least_central_film_um"] < found["film_at_C_um"]
    # 10 w/h_c = 5.9e12 N/m per m in series with about 13 to 23 N/(mm um)
    assert -0.6 < found["film_change_percent"] < -0.2
