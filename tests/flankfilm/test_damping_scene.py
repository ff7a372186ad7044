"""Scenes whose motion is damped by the films: the number, its error, what else damps, refusals with remedies."""

from __future__ import annotations

import math
import re

import pytest

import ehl
import gears
from base import InputError
from flankfilm.coupling import film_damping, pair_drive
from flankfilm.files.cache import Cache
from flankfilm.products.oscillator import oscillator_rows
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from flankfilm.stages.damping import FILM_DAMPING
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import MESH, PAIR
from flankfilm.stages.motion import SCALING
from tests.flankfilm.scenes import PAIR_WITH_BACKLASH

SCENE = f"""
wants = ["spectrum", "report"]
tolerance = 0.02
{PAIR_WITH_BACKLASH}
[operating]
pinion_torque_Nm = 20
pinion_speed_rpm = 2000
[stiffness]
model = "ishikawa"
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
[film]
model = "ehl"
[dynamics]
damping_ratio = "film"
error_amplitude_um = 5
"""
OIL = ehl.Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9)


@pytest.fixture(scope="module")
def kept(tmp_path_factory) -> Cache:
    """What scenes that differ in other keys have in common."""
    return Cache(tmp_path_factory.mktemp("kept"))


@pytest.fixture(scope="module")
def engine(kept) -> Engine:
    return Engine(parse_scene(SCENE), kept)


def test_the_motion_has_the_films_damping(engine):
    found = engine[FILM_DAMPING]
    again = film_damping(engine[MESH], engine[PAIR], 20.0, 2000 * math.pi / 30, OIL, tolerance=0.02)
    assert found is not None
    assert found.damping_ratio == pytest.approx(again.damping_ratio, rel=1e-6)
    assert 0.01 < found.damping_ratio < 0.3
    motion = engine[SCALING]
    assert motion.oscillator.damping_ratio == found.damping_ratio
    assert motion.scales is not None
    assert motion.scales.omega_n == pytest.approx(
        found.natural_frequency, rel=0.01
    )  # by a series of one harmonic


@pytest.mark.slow
def test_results_and_report_say_so_and_what_else_damps(tmp_path):
    run_scene(parse_scene(SCENE), tmp_path / "first")
    results = run_scene(parse_scene(SCENE), tmp_path)  # its film from the cache, without the dry cycle
    ratio = results.dataset["damping_ratio"]
    assert float(ratio) == pytest.approx(results.values["scaling"].oscillator.damping_ratio)
    assert 0.0 < ratio.attrs["error"] < 1.0
    page = (tmp_path / "report.html").read_text()
    text = re.sub(r"\s+", " ", page)
    assert "Damping by the films" in text
    assert "What else damps is not known and not counted" in text


def test_what_damps_in_the_backlash_is_named_beside_the_films(engine, kept):
    """Read through to the oscillator and its drive train, and said in the table of the report."""
    beside = SCENE.replace('damping_ratio = "film"', 'damping_ratio = "film"\nfree_damping_ratio = 0.004')
    motion = Engine(parse_scene(beside), kept)[SCALING]
    pressed = engine[SCALING].oscillator.damping_ratio
    assert motion.oscillator.damping_ratios == (pressed, 0.004)
    said = {name: (physical, value) for name, physical, value in oscillator_rows(motion)}
    assert motion.scales is not None
    assert said["damping ratio in the backlash zeta_0"][1] == "0.004"
    assert float(said["damping ratio in the backlash zeta_0"][0].split()[0]) == pytest.approx(
        0.008 * motion.scales.equivalent_mass * motion.scales.omega_n, rel=1e-3
    )
    assert not any("zeta_0" in row[0] for row in oscillator_rows(engine[SCALING]))


def test_drive_trains_have_it_too(engine):
    shaft = gears.Shaft(
        (gears.ShaftSegment(0.2, 0.04),), (gears.Bearing(0.02, 4e8), gears.Bearing(0.18, 4e8)), 0.1, 0.0
    )
    drive = pair_drive(
        engine[PAIR], engine[MESH], 20.0, 209.44, shafts=(shaft, shaft), end_inertias=(0.02, 0.05),
        damping_ratio=0.05, free_damping_ratio=0.01, fourier_order=1,
    )  # fmt: skip
    assert drive.oscillator.dampings == (0.1, 0.02)
    assert drive.rigid.oscillator.damping_ratios == (0.05, 0.01)


def test_a_damping_in_the_backlash_beyond_its_range_is_refused_with_its_key():
    with pytest.raises(InputError, match=r"dynamics.free_damping_ratio = -0.1"):
        parse_scene(SCENE.replace('damping_ratio = "film"', "free_damping_ratio = -0.1"))


@pytest.mark.slow
def test_films_that_damp_nothing_are_refused_with_a_remedy():
    heavy = Engine(parse_scene(SCENE.replace("_Nm = 20", "_Nm = 300")), Cache(None))
    with pytest.raises(InputError, match=r"as good as nothing. Give a number"):
        _ = heavy[SCALING]


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ('[film]\nmodel = "ehl"', '[film]\nmodel = "dowson"', "film.model"),
        ('[film]\nmodel = "ehl"', '[film]\nmodel = "none"', "film.model"),
        ("pinion_speed_rpm = 2000", "", "operating.pinion_speed_rpm"),
        (
            '"film"\nerror_amplitude_um = 5',
            '"film"\nmean_force = 0.1\nhalf_backlash = 0.1\nerror_amplitude = 0.1',
            "damping_ratio",
        ),
        ('damping_ratio = "film"', 'damping_ratio = "oil"', "damping_ratio"),
        ('damping_ratio = "film"', "damping_ratio = 6.0", "damping_ratio"),
    ],
)
def test_scenes_without_films_that_damp_are_refused(old, new, where):
    assert old in SCENE
    with pytest.raises(InputError, match=where):
        parse_scene(SCENE.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('model = "ehl"', 'model = "ehl"\nsupply = "oil-layer"\noil_layer_um = 0.5'),
        ("[dynamics]", "[roughness]\nRa_um = 0.6\nwheel_Ra_um = 0.6\n[dynamics]"),
    ],
    ids=["layer", "rough"],
)
def test_layers_and_rough_flanks_damp_too(engine, kept, old, new):
    found = Engine(parse_scene(SCENE.replace(old, new)), kept)[FILM_DAMPING]
    smooth = engine[FILM_DAMPING]
    assert found.damping_ratio > 0.0
    assert found.damping_ratio != pytest.approx(smooth.damping_ratio, rel=0.02)


def test_a_number_asks_for_no_film():
    scene = parse_scene(
        SCENE.replace('"film"\nerror', "0.07\nerror").replace('model = "ehl"', 'model = "none"')
    )
    engine = Engine(scene, Cache(None))
    assert engine[FILM_DAMPING] is None
    assert engine[SCALING].oscillator.damping_ratio == 0.07
