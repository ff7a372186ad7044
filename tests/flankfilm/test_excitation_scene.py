"""Scenes with harmonics of the unloaded error, a curve in a file, pitches: one harmonic stays what it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from base import InputError
from flankfilm import figures
from flankfilm.files.cache import Cache
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.motion import SCALING
from flankfilm.studies.outputs import OUTPUTS
from tests.flankfilm.scenes import ARTICLE

HEAD = f"""
wants = ["fourier", "spectrum"]
tolerance = 0.01
{ARTICLE}
[stiffness]
model = "given"
mean_N_per_m = 7.6e8
amplitudes = [0.18]
[dynamics]
"""


def scaled(keys: str, folder: Path = Path()):
    return Engine(parse_scene(HEAD + keys, folder=folder), Cache(None))[SCALING]


def test_a_number_and_a_list_of_one_are_the_same_to_the_last_digit():
    number, listed = (
        scaled(f"error_amplitude_um = {e}\nerror_phase_deg = {p}")
        for e, p in (("10", "20"), ("[10]", "[20]"))
    )
    assert number.oscillator == listed.oscillator
    assert number.oscillator.error_amplitude * number.scales.length == pytest.approx(1e-5, rel=1e-14)


def test_lists_of_harmonics_reach_the_oscillator():
    both = scaled("error_amplitude_um = [10, 3]\nerror_phase_deg = [0, 90]")
    assert both.error_amplitude == pytest.approx([1e-5, 3e-6])
    assert both.oscillator.error_series[1] == pytest.approx([0.0, np.pi / 2])
    assert 2e-5 < both.error_range < 2.6e-5


def test_a_curve_in_a_file_is_the_curve_in_the_scene(tmp_path: Path):
    at = np.arange(64) / 64
    error = 8.0 * np.cos(2 * np.pi * at + 0.5) + 2.0 * np.cos(6 * np.pi * at)
    rows = "\n".join(f"{a!r};{e!r}" for a, e in zip(at.tolist(), error.tolist(), strict=True))
    (tmp_path / "e.csv").write_text(f"# measured\nposition;error_um\n{rows}\n", encoding="utf-8")
    by_file = scaled('error_curve = "e.csv"', tmp_path)
    points = f"error_curve = {{ position = {at.tolist()}, error_um = {error.tolist()} }}"
    assert by_file.oscillator == scaled(points).oscillator
    straight = np.sinc(np.arange(1, 4) / 64) ** 2  # what straight lines between 64 points leave of a harmonic
    assert by_file.error_amplitude == pytest.approx(straight * [8e-6, 0.0, 2e-6], rel=1e-4, abs=1e-12)
    named = scaled('error_curve = "e.csv"\nerror_order = 1', tmp_path)
    assert len(named.error_amplitude) == 1


@pytest.mark.parametrize(
    ("keys", "where", "said"),
    [
        ('error_curve = "no.csv"', "dynamics.error_curve", "does not exist|not there|no such|is not"),
        ('error_curve = "bad.csv"', "dynamics.error_curve", "position and error_um"),
        ('error_curve = "gap.csv"', "dynamics.error_curve", "two numbers"),
        ("error_curve = { position = [0, 1], error_um = [0, 1] }", "dynamics.error_curve", "at least 3"),
        ("error_curve = { position = [0, 0.5, 0.4], error_um = [0, 1, 2] }", "position", "rise"),
        ('error_curve = "unloaded"\nerror_amplitude_um = 3', "dynamics", "beside error_curve"),
        ("error_amplitude_um = [1, 2]\nerror_phase_deg = [1, 2, 3]", "dynamics", "as many"),
        ("error_amplitude_um = [1, 20000]", "dynamics.error_amplitude_um", "at most 10000"),
    ],
)
def test_faults_name_the_key(keys: str, where: str, said: str, tmp_path: Path):
    (tmp_path / "bad.csv").write_text("position,error_mm\n0,1\n")
    (tmp_path / "gap.csv").write_text("position,error_um\n0,1\n0.5,\n0.7,2\n")
    with pytest.raises(InputError, match=said) as caught:
        parse_scene(HEAD + keys, folder=tmp_path)
    assert any(where in fault.where for fault in caught.value.faults)


def test_the_spectrum_of_a_scene_without_a_pair_is_that_of_its_oscillator():
    text = """
wants = ["spectrum"]
[stiffness]
model = "given"
amplitudes = [0.18]
[dynamics]
mean_force = 0.1
error_amplitude = [0.02, 0.01]
half_backlash = 0.2
sweep = { frequency = [0.4, 0.5] }
"""
    data = run_scene(parse_scene(text), None).dataset
    assert data.spectrum_order.values.tolist() == [1.0, 2.0, 3.0, 4.0]
    assert data.spectrum_sidebands == 0.0
    assert figures.spectrum(data).axes


@pytest.mark.slow
def test_unloaded_error_and_sidebands_of_pitches_come_out_of_a_scene(tmp_path: Path):
    pitches = [0.0] * 36
    pitches[5], pitches[6] = 6.0, -6.0
    text = HEAD.replace("bore_mm = 33.5", f"bore_mm = 33.5, deviations = {{ single_pitch_um = {pitches} }}")
    given = text[text.index("[stiffness]") : text.index("[dynamics]")]
    scene = parse_scene(text.replace(given, "") + 'error_curve = "unloaded"\nerror_order = 2')
    found = run_scene(scene, None)
    data = found.dataset
    assert found.failures == ()
    assert data.spectrum_meshes == 36
    assert data.spectrum_order.values[0] == pytest.approx(1 / 36)
    assert data.spectrum_sidebands > 1e-4
    assert np.array_equal(data.excitation_amplitude, np.zeros(2))  # perfect involutes but for the pitches
    for draw in (figures.spectrum, figures.excitation):
        assert draw(data).axes
    engine = Engine(scene, Cache(None))
    assert engine[EXCITATION].range == 0.0
    assert OUTPUTS["sidebands"].value(engine) == pytest.approx(float(data.spectrum_sidebands))
