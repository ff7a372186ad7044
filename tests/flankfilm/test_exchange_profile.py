"""Profiles as files: read back by a reader of their own, they are the contour."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from flankfilm.cli import app
from flankfilm.exchange.profile_files import write_drawing, write_points
from flankfilm.processes.exit_status import guarded
from gears import Gear, GearPair
from gears.tooth.contour import contour

EXAMPLES = Path(__file__).parents[2] / "examples"
PROFILE = GearPair(
    pinion=Gear(teeth=21, profile_shift=0.2, tip_chamfer=0.1e-3),
    wheel=Gear(teeth=40),
    module=2e-3,
    face_width=0.04,
).teeth_profiles[0]


def groups(path):
    """Group codes and values of a DXF file, two lines each."""
    lines = path.read_text(encoding="ascii").splitlines()
    assert len(lines) % 2 == 0
    return [(int(code), value) for code, value in zip(lines[::2], lines[1::2], strict=True)]


def entities(path):
    """Entities of a drawing: name and values by group code."""
    found, inside = [], False
    for code, value in groups(path):
        if code == 2:
            inside = value == "ENTITIES"
        elif inside and code == 0:
            found.append((value, {}))
        elif inside:
            found[-1][1][code] = value
    return found


def vertices(path):
    return [
        (float(v[10]), float(v[20]), float(v.get(42, 0.0))) for name, v in entities(path) if name == "VERTEX"
    ]


@pytest.mark.parametrize("teeth", [1, 4, None])
def test_a_drawing_reads_back_as_the_contour(tmp_path, teeth):
    exact = contour(PROFILE, teeth, 1e-6)
    path = tmp_path / "gear.dxf"
    count = write_drawing(path, exact, ("überall",))
    listed = groups(path)
    assert listed[-1] == (0, "EOF")
    assert (1, "AC1009") in listed
    assert any(code == 999 and "1 um" in value for code, value in listed)
    (polyline,) = (v for name, v in entities(path) if name == "POLYLINE")
    assert polyline[70] == "1"  # closed
    points = vertices(path)
    assert len(points) == count
    # the area of the chords and of the circle segments of the bulges, in mm2
    area = 0.0
    for (x, y, bulge), (nx, ny, _) in zip(points, points[1:] + points[:1], strict=True):
        angle = 4.0 * math.atan(bulge)
        chord = math.hypot(nx - x, ny - y)
        assert chord > 1e-6
        area += 0.5 * (x * ny - nx * y)
        if bulge:
            radius = chord / (2.0 * math.sin(0.5 * abs(angle)))
            area += math.copysign(0.5 * radius**2 * (abs(angle) - math.sin(abs(angle))), bulge)
    fine, _ = contour(PROFILE, teeth, 1e-9).polygon()
    x, y = 1e3 * fine.T
    # chords of 1 um cut off at most that along the contour
    length = float(np.sum(np.hypot(np.diff(x), np.diff(y))))
    assert area == pytest.approx(0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]), abs=1e-3 * length)
    circles = [v for name, v in entities(path) if name == "CIRCLE"]
    assert len(circles) == (teeth is None)
    if circles:
        assert float(circles[0][40]) == pytest.approx(1e3 * PROFILE.bore_radius, rel=1e-11)


def test_another_reader_takes_the_drawing(tmp_path):
    import ezdxf

    write_drawing(tmp_path / "gear.dxf", contour(PROFILE, None, 1e-6))
    drawing = ezdxf.readfile(tmp_path / "gear.dxf")
    assert not drawing.audit().errors
    assert drawing.modelspace().query("POLYLINE")[0].is_closed


def test_points_read_back_closed_and_named(tmp_path):
    exact = contour(PROFILE, 2, 1e-6)
    count = write_points(tmp_path / "gear.csv", exact)
    with (tmp_path / "gear.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == count
    points = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in rows])
    assert np.array_equal(points[0], points[-1])
    assert np.allclose(1e-3 * points, exact.polygon()[0], rtol=1e-15)
    assert {row["part"] for row in rows} == {"root", "fillet", "flank", "chamfer", "land", "side", "bore"}
    on_land = np.array([row["part"] == "land" for row in rows])
    assert np.hypot(*points[on_land].T) == pytest.approx(1e3 * PROFILE.tip_radius, rel=1e-12)


def command(*arguments):
    """Exit status of a command run in this process."""
    tokens = ["export-profile", str(EXAMPLES / "article.toml"), *arguments]
    try:
        return guarded(lambda: int(app(tokens) or 0))
    except SystemExit as end:
        return end.code


def test_the_command_states_its_accuracy(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert command("--gear", "wheel", "--teeth", "all", "--tolerance-um", "5") == 0
    assert "at most 5 µm, arcs exact" in capsys.readouterr().out
    assert len(vertices(tmp_path / "article-wheel.dxf")) % 40 == 0
    assert command("--format", "csv", "--out", "teeth.csv") == 0
    assert (tmp_path / "teeth.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--teeth", "0"), "teeth"),
        (("--teeth", "few"), "--teeth"),
        (("--teeth", "99"), "1 to 36"),
        (("--tolerance-um", "0"), "tolerance"),
        (("--tolerance-um", "nan"), "tolerance"),
    ],
)
def test_the_command_refuses_senseless_requests(tmp_path, monkeypatch, capsys, arguments, expected):
    monkeypatch.chdir(tmp_path)
    assert command(*arguments) == 2
    assert expected in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
