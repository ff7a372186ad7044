"""Meshes for other programs by command, and gears on rigid hubs, from a scene."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest

from base import InputError
from flankfilm.files.cache import Cache
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE
from tests.flankfilm.program import EXAMPLES, command

EXAMPLE = EXAMPLES / "article.toml"


def export(*arguments, status=0):
    return command("export", EXAMPLE, *arguments, cwd=Path.cwd(), status=status)


@pytest.mark.slow
def test_both_gears_are_written_with_forces_that_balance_the_torque(tmp_path):
    export("--out", tmp_path, "--refinements", "0")
    text = (tmp_path / "pinion.inp").read_text(encoding="ascii")
    nodes = {
        int(cells[0]): np.array(cells[1:3], dtype=float)
        for cells in (line.split(",") for line in _block(text, "*NODE"))
    }
    moment = 0.0
    for line in _block(text, "*CLOAD"):
        node, axis, value = line.split(",")
        x, y = nodes[int(node)]
        moment += float(value) * (x if int(axis) == 2 else -y)
    # with a tip edge in contact at this position the unloaded gears' lever is off by its first order
    assert moment == pytest.approx(-600.0, rel=5e-4)
    assert (tmp_path / "wheel.inp").exists()


def _block(text, keyword):
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if line.split(",")[0] == keyword) + 1
    end = next(i for i in range(start, len(lines)) if lines[i].startswith("*"))
    return lines[start:end]


@pytest.mark.slow
def test_meshes_for_gmsh(tmp_path):
    export("--out", tmp_path, "--format", "msh", "--refinements", "0", "--position", "0.1")
    assert (tmp_path / "pinion.msh").read_bytes().startswith(b"$MeshFormat\n4.1")


def test_meshes_in_formats_of_meshio(tmp_path):
    export("--out", tmp_path, "--format", "vtu", "--refinements", "0")
    back = meshio.read(tmp_path / "wheel.vtu")
    assert {"flank_left", "bore", "force_N"} <= back.point_data.keys()


@pytest.mark.parametrize(
    ("option", "value"), [("--position", "1.5"), ("--refinements", "9"), ("--format", "step")]
)
def test_senseless_options_are_refused(tmp_path, option, value):
    output = export("--out", tmp_path, option, value, status=2).stderr
    assert option.strip("-") in output


def compliance(**hub):
    text = EXAMPLE.read_text(encoding="utf-8")
    keys = ", ".join(f"{key} = {value}" for key, value in hub.items())
    text = text.replace("bore_mm = 33.5 }", f"bore_mm = 33.5, hub = {{ {keys} }} }}") if hub else text
    return Engine(parse_scene(text), Cache(None))[COMPLIANCE]


def test_a_shaft_that_yields_adds_its_springs():
    rigid, yielding = (
        compliance(),
        compliance(radial_stiffness_N_per_m=5e8, torsional_stiffness_Nm_per_rad=1e6),
    )
    rho1 = np.array([rigid.pair.points.C])
    springs = 1 / 5e8 + rigid.pair.base_radii[0] ** 2 / 1e6
    assert yielding.own(rho1) - rigid.own(rho1) == pytest.approx(springs, rel=1e-9)


def test_a_larger_hub_is_stiffer():
    rho1 = np.array([compliance().pair.points.C])
    assert compliance(hub_mm=50.0).own(rho1) < 0.97 * compliance().own(rho1)


def test_a_hub_outside_the_rim_is_refused_under_its_key():
    with pytest.raises(
        InputError, match=r"^pair\.pinion\.hub\.hub_mm = 80: must be 33\.5 mm \(bore\) to 66\.\d+ mm"
    ):
        compliance(hub_mm=80.0)


def test_hubs_belong_to_finite_elements():
    text = EXAMPLE.read_text(encoding="utf-8").replace(
        "bore_mm = 33.5 }", "bore_mm = 33.5, hub = { hub_mm = 50.0 } }"
    )
    with pytest.raises(InputError, match=r"pair\.pinion\.hub"):
        parse_scene(text.replace('model = "fem"', 'model = "ishikawa"'))
