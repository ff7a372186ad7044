"""Measured traces and wear that cannot be: gaps, wrong counts, positions and units; each refused with its remedy."""

from __future__ import annotations

import pytest

from base import InputError
from flankfilm.runs.check import check_scene
from flankfilm.scene import parse_scene, read_scene
from tests.flankfilm.program import EXAMPLES, flankfilm

EXAMPLE = (EXAMPLES / "worn_flanks.toml").read_text(encoding="utf-8")
TRACES = (EXAMPLES / "measured" / "pinion_traces.csv").read_text(encoding="utf-8")
AT = "pair.pinion.deviations.traces.file"


def faults(folder, csv=TRACES, scene=EXAMPLE, name="pinion_traces.csv"):
    """Faults of the example with another file of traces, or with other keys."""
    (folder / "measured").mkdir(exist_ok=True)
    (folder / "measured" / name).write_text(csv, encoding="utf-8")
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        check_scene(read_scene(folder / "scene.toml"))
    # keys with plain bounds have them alone
    bounded = ("pair.module_mm", "pair.wheel.wear.factor")
    assert all(fault.remedy or fault.where in bounded for fault in caught.value.faults)
    return {fault.where: f"{fault.value}: {fault.allowed}. {fault.remedy}" for fault in caught.value.faults}


def cells(csv=TRACES):
    return [line.split(",") for line in csv.splitlines() if not line.startswith("#")]


def joined(rows, mark=","):
    return "\n".join(mark.join(row) for row in rows) + "\n"


def below_one_another(rows, first=0):
    """The same file with columns tooth, position and value."""
    long = [[str(k + first), row[0], row[k + 1]] for k in range(len(rows[0]) - 1) for row in rows[1:]]
    return [["tooth", rows[0][0], "deviation_um"], *long]


def test_gaps_are_named_by_tooth_and_line(tmp_path):
    rows = cells()
    rows[4][8] = ""
    rows[9][8] = "nan"
    rows[5][12] = "---"
    found = faults(tmp_path, joined(rows))
    assert list(found) == [AT]
    with pytest.raises(InputError) as caught:
        read_scene(tmp_path / "scene.toml")
    values = [fault.value for fault in caught.value.faults]
    assert values == ["pinion_traces.csv, tooth 7: line 5 and 1 more", "pinion_traces.csv, tooth 11: line 6"]
    everywhere = [[row[0], *[""] * 36] if n == 3 else row for n, row in enumerate(cells())]
    (tmp_path / "measured" / "pinion_traces.csv").write_text(joined(everywhere))
    with pytest.raises(InputError) as caught:
        read_scene(tmp_path / "scene.toml")
    assert len(caught.value.faults) == 11
    assert caught.value.faults[-1].value == "pinion_traces.csv: 26 more teeth"


def test_the_wrong_number_of_teeth(tmp_path):
    rows = cells()
    found = faults(tmp_path, joined([row[:-1] for row in rows]))
    assert "35 curves: must have one curve for each of 36 teeth" in found[AT]
    found = faults(tmp_path, joined([row[:6] + row[7:] for row in rows]))
    assert "no tooth 5: must have every tooth" in found[AT]
    found = faults(tmp_path, joined([[row[0], row[1]] for row in rows]))
    assert "1 curves: must have one curve for each of 36 teeth" in found[AT]
    long = below_one_another(rows)
    assert "no tooth 5" in faults(tmp_path, joined([row for row in long if row[0] != "5"]))[AT]
    assert "a row without a tooth" in faults(tmp_path, joined([*long, ["", "70.0", "1.0"]]))[AT]
    assert "a row without a tooth" in faults(tmp_path, joined([*long, ["1.5", "70.0", "1.0"]]))[AT]
    # a tooth more than there are, and pitches that do not fit either, at once
    found = faults(tmp_path, TRACES, EXAMPLE.replace("teeth = 36", "teeth = 35"))
    assert set(found) == {AT, "pair.pinion.deviations.cumulative_pitch_um"}


def test_traces_that_leave_out_a_part_of_the_active_profile(tmp_path):
    rows = cells()
    found = faults(tmp_path, joined([rows[0], *rows[6:]]))
    assert (
        "tooth 0: 70.66 to 75.9 mm, and 35 more teeth: must cover the active profile, 69.196 to 76 mm"
        in found[AT]
    )
    long = [row for row in below_one_another(rows) if row[0] != "3" or float(row[1]) < 74.0]
    assert "tooth 3: 69.2 to 73.86 mm: must cover the active profile" in faults(tmp_path, joined(long))[AT]
    held = EXAMPLE.replace('pinion_traces.csv" }', 'pinion_traces.csv", beyond = "hold" }')
    (tmp_path / "scene.toml").write_text(held)
    assert check_scene(read_scene(tmp_path / "scene.toml"))  # solved, with the ends held


@pytest.mark.parametrize(
    ("head", "factor", "value"),
    [
        ("diameter_mm", 0.5, "34.6 to 37.95 mm"),  # radii
        ("roll_deg", 1.0, "69.2 to 75.9 deg"),
        ("roll_length_mm", 1.0, "69.2 to 75.9 mm"),
    ],
)
def test_positions_in_another_unit(tmp_path, head, factor, value):
    rows = cells()
    changed = [[head, *rows[0][1:]], *([f"{factor * float(row[0]):g}", *row[1:]] for row in rows[1:])]
    for scene in (EXAMPLE, EXAMPLE.replace('traces.csv" }', 'traces.csv", beyond = "hold" }')):
        assert (
            f"tooth 0: {value}, and 35 more teeth: must lie on"
            in faults(tmp_path, joined(changed), scene)[AT]
        )


def test_positions_that_do_not_rise_and_values_of_another_unit(tmp_path):
    rows = cells()
    rows[5][0], rows[6][0] = rows[6][0], rows[5][0]
    found = faults(tmp_path, joined(rows))
    assert len(found) == 36
    assert "must rise from point to point" in found["pair.pinion.deviations.traces.teeth.35.diameter_mm"]
    rows = [[row[0], *(f"{1e3 * float(cell):g}" for cell in row[1:])] for row in cells()[1:]]
    found = faults(tmp_path, joined([cells()[0], *rows]))
    assert "at least -2000 and at most 2000 um. Check the unit" in found[
        "pair.pinion.deviations.traces.teeth.11.material_um"
    ].replace("check", "Check")


@pytest.mark.parametrize(
    ("csv", "said"),
    [
        ("", "is empty"),
        ("# nothing\n\n", "is empty"),
        ("diameter_mm,tooth_0\n", "must have points"),
        ("x_mm,tooth_0\n1,2\n", "must have the columns roll_deg or diameter_mm or roll_length_mm"),
        ("diameter_mm,roll_deg,tooth_0\n1,2,3\n", "must have the columns"),
        ("diameter_mm,depth_um\n1,2\n", "must have the columns"),
        ("diameter_mm,tooth,tooth_1\n1,2,3\n", "must have the columns"),
        ("diameter_mm,tooth_1,1\n1,2,3\n", "must have the columns"),
        ("diameter_mm\n1\n", "must have the columns"),
        ("\x00\x01", "must have the columns"),
    ],
)
def test_files_that_are_no_traces(tmp_path, csv, said):
    assert said in faults(tmp_path, csv)[AT]


def test_files_that_cannot_be_read(tmp_path):
    found = faults(tmp_path, scene=EXAMPLE.replace("pinion_traces.csv", "nowhere.csv"))
    assert "does not exist" in found[AT]
    found = faults(tmp_path, scene=EXAMPLE.replace("measured/pinion_traces.csv", "measured"))
    assert "is a folder" in found[AT]
    (tmp_path / "measured" / "other.csv").write_bytes(b"diameter_mm,1\n\xff\xfe,2\n")
    found = faults(tmp_path, scene=EXAMPLE.replace("pinion_traces.csv", "other.csv"))
    assert "must be a CSV file in UTF-8" in found[AT]


def test_negative_wear_and_all_else_at_once(tmp_path):
    scene = (
        EXAMPLE.replace("[14.0, 12.0", "[14.0, -12.0")
        .replace("factor = 1.0", "factor = -1.0")
        .replace('"measured/pinion_traces.csv"', '"measured/gone.csv"')
        .replace("module_mm = 2.0", "module_mm = -2.0")
    )
    found = faults(tmp_path, scene=scene)
    assert set(found) >= {AT, "pair.module_mm", "pair.wheel.wear.factor"}
    found = faults(tmp_path, scene=EXAMPLE.replace("[14.0, 12.0", "[14.0, -12.0"))
    assert (
        "-12 (point 2): must be at least 0 and at most 2000 um. wear removes material"
        in found["pair.wheel.wear.depth_um"]
    )
    found = faults(tmp_path, scene=EXAMPLE.replace("[14.0, 12.0", "[14.0"))
    assert "as many diameter_mm as depth_um, not 7 and 6" in found["pair.wheel.wear"]
    found = faults(tmp_path, scene=EXAMPLE.replace("82.5, 83.9]", "82.0, 82.5]"))
    assert "77.2 to 82.5 mm: must cover the active profile, 77.156 to 84 mm" in found["pair.wheel.wear"]
    ends = EXAMPLE.replace("82.5, 83.9]", "82.0, 82.5]").replace("7.0, 9.0]", "7.0, 0.0]")
    (tmp_path / "scene.toml").write_text(ends)
    assert check_scene(read_scene(tmp_path / "scene.toml"))  # ends at nothing, which is held


def test_files_and_points_exclude_each_other():
    scene = EXAMPLE.replace("[pair.wheel.wear]", '[pair.wheel.wear]\nfile = "wear.csv"')
    with pytest.raises(InputError) as caught:
        parse_scene(scene, folder=EXAMPLES)
    assert [fault.where for fault in caught.value.faults] == ["pair.wheel.wear.file"]
    assert "excludes depth_um and diameter_mm" in str(caught.value)
    scene = EXAMPLE.replace(
        "[pair.pinion.deviations]",
        "[pair.pinion.deviations]\nprofile = { roll_deg = [10, 20], material_um = [0, 0] }",
    )
    with pytest.raises(InputError, match="profile or traces, not both"):
        parse_scene(scene, folder=EXAMPLES)


def test_the_command_line_ends_with_two_and_no_traceback(tmp_path):
    rows = cells()
    rows[4][8] = ""
    faults(tmp_path, joined(rows))
    done = flankfilm("run", tmp_path / "scene.toml", "--out", tmp_path / "out", status=2)
    assert f"{AT} = pinion_traces.csv, tooth 7: line 5" in done.stderr
