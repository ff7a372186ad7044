"""What README and docs show is run: Python snippets, links, pictures, and the small examples."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

ROOT = Path(__file__).parents[2]
SCRIPT = Path(sys.executable).with_name("flankfilm")
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def snippets(page: Path) -> list[str]:
    return re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)


def test_the_snippets_of_the_readme_run():
    for code in snippets(ROOT / "README.md"):
        subprocess.run([sys.executable, "-c", code], check=True, timeout=200, capture_output=True)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path):
    targets = re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8"))
    missing = [t for t in targets if "://" not in t and not (page.parent / t).exists()]
    assert missing == []


def test_all_examples_are_valid_scenes_and_studies_stand_apart():
    for scene in sorted((ROOT / "examples").glob("*.toml")):
        subprocess.run([str(SCRIPT), "check", str(scene)], check=True, timeout=60, capture_output=True)


def test_the_way_of_many_papers_runs(tmp_path):
    done = subprocess.run(
        [str(SCRIPT), "run", str(ROOT / "examples" / "independent_pairs.toml"), "--out", "out"],
        check=True,
        timeout=120,
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "FLANKFILM_CACHE": str(tmp_path / "cache")},
    )
    assert "error unknown" in done.stdout
    with xr.open_dataset(tmp_path / "out" / "results.nc", engine="h5netcdf") as found:
        assert float(found.dry_secant_stiffness.mean()) / 40e6 == pytest.approx(23.44, rel=0.005)
