"""The scans of the article's section 6 run as examples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dynamics import SmoothOscillator, restoring_force
from tests.example_scripts import example


def ran(scan: str, folder: Path, *more: str) -> str:
    files = example("article").main([scan, "--out", str(folder), *more])
    assert {f.stem.split("_")[0] for f in files} == {
        "diagram",
        "zoom",
        "exponents",
        "portraits",
        "basins",
        "summary",
    } - ({"zoom"} if scan == "6.4" else set())
    assert all(f.stat().st_size > 100 for f in files)
    return files[-1].read_text()


@pytest.mark.slow
def test_lubricated_frequency_scan_small(tmp_path: Path):
    lines = ran("6.1", tmp_path, "--small")
    assert "basins at 0.6: 1-0-0" in lines
    assert "unstable: U1-1-0" in lines


@pytest.mark.slow
@pytest.mark.parametrize("scan", ["6.2", "6.3", "6.4"])
def test_other_scans_small(scan: str, tmp_path: Path):
    assert "branches" in ran(scan, tmp_path, "--small")


@pytest.mark.slow
def test_lubricated_frequency_scan_with_all_branches(tmp_path: Path):
    """As in full but for the fineness of sweeps and basins."""
    article = example("article")
    size = article.Size(101, 100, 16, 9, 8, 1, 16, 2)
    _, lines = article.draw(example("scans").SCANS["6.1"], tmp_path, size, "svg")
    assert not any("6-4-4: no stable" in line or "4-3-0: no stable" in line for line in lines)
    assert any("dimension" in line for line in lines)


@pytest.mark.long
@pytest.mark.slow
def test_ends_of_chaos():
    lines = example("crises").main([])
    middle = lines.index("")
    crises, ends = lines[2:middle], lines[middle + 3 :]
    assert all("| aperiodic |" in line for line in crises)
    assert "0.90883842" in crises[0]
    assert "1.119740782" in crises[1]
    # the chaos of 4-3-0 ends by escapes alone
    assert [line.split(" | ")[3] for line in ends] == [
        "U18-18-0", "U24-24-0", "U24-12-12", "U36-12-12", "none that parts the two",
    ]  # fmt: skip
    assert not any("not seen" in line for line in lines)


def test_table_of_the_lubricated_frequency_scan():
    lines = "\n".join(example("table").main(["6.1", "6.4"]))
    assert lines.count("| reproduced") == 5
    assert lines.count("not identified") == 8


@pytest.mark.long
@pytest.mark.slow
def test_table_of_all_scans():
    lines = "\n".join(example("table").main([]))
    assert lines.count("| reproduced") == 14
    assert lines.count("printed late") == 4
    assert "| 6.3 | boundary crisis | 0.68 | 0.77990" in lines


@pytest.mark.slow
def test_loaded_law_gives_back_the_finite_elements():
    """At every position of the sweep the law has the force that gave the deflection."""
    study = example("loaded_law")
    here = study.setting(held=False)
    law = study.law(here, 19)
    osc = SmoothOscillator(law, 0.05, 0.1, 0.1, 0.5)
    angles = 2 * np.pi * (np.arange(40) + 0.5) / 40
    for k in (4, 7, 10):
        x = law.half_backlash + here.deflection[:, k] / here.scales.length
        force = here.scales.force(restoring_force(osc, angles, x)[:, 0])
        assert force == pytest.approx(here.force[k], rel=2e-3)


@pytest.mark.slow
def test_loaded_law_lies_between_secant_and_tangent(tmp_path: Path):
    """So do the first and the last fold of the motion in contact."""
    files = example("loaded_law").main(["--out", str(tmp_path), "--order", "1"])
    assert all(f.stat().st_size > 100 for f in files)
    rows = [line for line in files[-1].read_text().splitlines() if "jumps at" in line]
    folds = [[int(v) for v in row.split("jumps at ")[1].split(" rpm")[0].split(", ")] for row in rows]
    secant, tangent, loaded = (np.array(f)[:2] for f in folds)  # the way up ends, the way down ends
    assert np.all(secant < loaded)
    assert np.all(loaded < tangent)
