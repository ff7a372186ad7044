"""Traction curves of a scene's oil as a table."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest

import ehl
from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.exchange.commands import export_traction
from flankfilm.exchange.traction_files import traction_of
from flankfilm.scene import parse_scene, read_scene

SCENE = Path(__file__).parents[2] / "examples" / "losses.toml"


def test_the_command(tmp_path, monkeypatch, capsys):
    scene = read_scene(SCENE)
    (tmp_path / "pair.toml").write_bytes(SCENE.read_bytes())
    monkeypatch.chdir(tmp_path)
    assert export_traction(tmp_path / "pair.toml", pressure_gpa=0.8, speed_m_per_s=4.0, ratios="0,0.1") == 0
    with (tmp_path / "pair-traction.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    curve = traction_of(scene, [0.0, 0.1], 0.8e9, 4.0)
    assert [float(row["traction_coefficient"]) for row in rows] == curve.traction_coefficient.tolist()
    assert float(rows[1]["hertz_pressure_GPa"]) == pytest.approx(0.8)
    assert float(rows[1]["oil_temperature_rise_K"]) == curve.oil_temperature_rise[1]
    assert "greatest_traction" in capsys.readouterr().out
    for options, words in (
        ({"ratios": "a,b"}, "numbers with commas"),
        ({"out": tmp_path / "a.txt"}, r"end in \.csv"),
    ):
        with pytest.raises(InputError, match=words):
            export_traction(tmp_path / "pair.toml", **{"ratios": "0"} | options)


def test_pressure_and_speed_are_those_at_the_pitch_point():
    scene = read_scene(SCENE)
    pair, curve = gear_pair(scene), traction_of(scene, [0.0])
    at_pitch = pair.path_at(pair.points.C)
    load = pair.normal_force(scene.operating.pinion_torque_Nm) / pair.face_width
    contact = ehl.LineContact(
        load, 1.0, at_pitch.radius.item(), pair.reduced_modulus, curve.contact.lubricant
    )
    assert curve.hertz_pressure == pytest.approx(contact.peak_pressure, rel=1e-12)
    speed = scene.operating.pinion_speed_rpm * math.pi / 30
    assert curve.entrainment == pytest.approx(at_pitch.entrainment(speed).item(), rel=1e-9)
    bare = """
        wants = ["geometry"]
        [pair]
        module_mm = 2
        face_width_mm = 20
        pinion = { teeth = 20 }
        wheel = { teeth = 30 }
        [material]
        name = "steel 18CrNiMo7-6"
        [operating]
        pinion_torque_Nm = 100
    """
    with pytest.raises(InputError, match="lubricant"):
        traction_of(parse_scene(bare), [0.0])
