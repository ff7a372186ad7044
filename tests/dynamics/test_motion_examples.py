"""The scans of the article's section 6 run as examples."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "motion"


def example(name: str):
    sys.path.insert(0, str(FOLDER))
    try:
        spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
        return module
    finally:
        sys.path.remove(str(FOLDER))


def ran(scan: str, folder: Path, *more: str) -> str:
    files = example("article").main([scan, "--out", str(folder), *more])
    assert {f.stem.split("_")[0] for f in files} == {"diagram", "exponents", "portraits", "basins", "summary"}
    assert all(f.stat().st_size > 100 for f in files)
    return files[-1].read_text()


def test_lubricated_frequency_scan_small(tmp_path: Path):
    told = ran("6.1", tmp_path, "--small")
    assert "basins at 0.6: 1-0-0" in told
    assert "unstable: U1-1-0" in told


@pytest.mark.slow
@pytest.mark.parametrize("scan", ["6.2", "6.3", "6.4"])
def test_other_scans_small(scan: str, tmp_path: Path):
    assert "branches" in ran(scan, tmp_path, "--small")


@pytest.mark.slow
def test_lubricated_frequency_scan_in_full(tmp_path: Path):
    told = ran("6.1", tmp_path)
    assert "6-4-4: no stable stretch" not in told
    assert "4-3-0: no stable stretch" not in told


def test_table_of_the_error_scan():
    told = "\n".join(example("table").main(["6.3", "6.4"]))
    assert told.count("| reproduced") == 3
    assert "printed late by 7.1e-04" in told
    assert told.count("not identified") == 8


@pytest.mark.slow
def test_table_of_all_scans():
    told = "\n".join(example("table").main([]))
    assert told.count("| reproduced") == 14
    assert told.count("printed late") == 4
