"""The mesh as a table for other programs: the motion's own figures, read back from CSV and npz."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest

import flankfilm as ff
from base import InputError
from flankfilm.coupling import mesh_table
from flankfilm.exchange.commands import export_table
from flankfilm.exchange.mesh_files import write_table
from gears import Gear, GearPair
from tests.flankfilm.scenes import ishikawa

PAIR = GearPair(
    Gear(teeth=36, bore_radius=16e-3), Gear(teeth=40, bore_radius=18e-3), 2e-3, 40e-3
).with_backlash(50e-6)
EXTRA = (1e-4, 2e-4)
CYCLE = ff.mesh_cycle(PAIR, 600.0, model="potential-energy", pairs="independent", positions=24)
TABLE = mesh_table(PAIR, CYCLE, EXTRA)


def test_figures_are_those_of_the_motion():
    motion = ff.pair_oscillator(PAIR, CYCLE, torque=600.0, speed=100.0, extra_inertia=EXTRA, fourier_order=1)
    assert motion.scales is not None
    assert TABLE.equivalent_mass == pytest.approx(motion.scales.equivalent_mass, rel=1e-12)
    assert TABLE.inertias == motion.inertias
    assert TABLE.force == pytest.approx(600.0 / PAIR.base_radii[0], rel=1e-9)
    assert TABLE.backlash == PAIR.backlash
    assert TABLE.angle[-1] - TABLE.angle[0] == pytest.approx(23 / 24 * 2 * math.pi / 36, rel=1e-12)
    # two discs on the spring swing at the pair's natural frequency
    (r1, r2), (j1, j2) = TABLE.base_radii, TABLE.inertias
    k = TABLE.mean_stiffness * np.array([[r1 * r1, -r1 * r2], [-r1 * r2, r2 * r2]])
    greatest = max(np.linalg.eigvals(np.diag([1 / j1, 1 / j2]) @ k).real)
    assert math.sqrt(greatest) == pytest.approx(
        math.sqrt(TABLE.mean_stiffness / TABLE.equivalent_mass), rel=1e-12
    )


@pytest.mark.slow
def test_the_stiffness_is_measured_against_the_bodies():
    """As discs turn: by finite elements stiffer than against the bores, which wind up."""
    cycle = ff.mesh_cycle(PAIR, 600.0, positions=8, tolerance=0.05)
    table = mesh_table(PAIR, cycle, EXTRA)
    assert table.reference.startswith("the rotation of the bodies")
    assert table.mean_stiffness == pytest.approx(cycle.against("body", EXTRA).mean_stiffness, rel=1e-12)
    assert table.mean_stiffness > 1.05 * cycle.against("bore").mean_stiffness
    assert table.relative_error == pytest.approx(cycle.against("body", EXTRA).error)


def test_both_formats_read_back(tmp_path):
    write_table(tmp_path / "pair.csv", TABLE)
    with (tmp_path / "pair.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 24
    for name in ("tangent_stiffness_N_per_m", "stiffness_N_per_m"):  # the older name for one version
        assert [float(row[name]) for row in rows] == TABLE.stiffness.tolist()
    assert float(rows[0]["backlash_um"]) == pytest.approx(50.0)
    assert float(rows[7]["inertias_kg_m2_wheel"]) == TABLE.inertias[1]
    assert math.isnan(float(rows[0]["relative_error"]))  # a closed form's is unknown
    write_table(tmp_path / "pair.npz", TABLE)
    with np.load(tmp_path / "pair.npz", allow_pickle=False) as held:
        assert held["transmission_error"].tolist() == TABLE.transmission_error.tolist()
        assert float(held["equivalent_mass"]) == TABLE.equivalent_mass
        assert str(held["label"]) == TABLE.label
    with pytest.raises(InputError, match=r"must end in \.csv or \.npz"):
        write_table(tmp_path / "pair.txt", TABLE)


SCENE = ishikawa("Table", "stiffness")


def test_the_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pair.toml").write_text(SCENE, encoding="utf-8")
    assert export_table(tmp_path / "pair.toml") == 0
    assert (
        (tmp_path / "pair-mesh.csv")
        .read_text(encoding="utf-8")
        .startswith("angle_deg,tangent_stiffness_N_per_m")
    )
    assert "120 positions" in capsys.readouterr().out
    (tmp_path / "bare.toml").write_text(
        SCENE.replace("[operating]\npinion_torque_Nm = 600\n", ""), encoding="utf-8"
    )
    with pytest.raises(InputError, match=r"\[operating\]"):
        export_table(tmp_path / "bare.toml")
