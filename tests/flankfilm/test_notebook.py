"""Notebook views of runs and studies, and the scripts that complete commands in a shell."""

from __future__ import annotations

import shutil
import subprocess
from xml.etree import ElementTree as ET

import pytest

from flankfilm.cli import app, completion
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from flankfilm.studies.plan import plan_of
from flankfilm.studies.row import RowResult
from flankfilm.studies.run import StudyResults
from flankfilm.studies.study_file import StudyFile
from tests.flankfilm.scenes import ishikawa

SCENE = ishikawa("<script>alert(1)</script>", "closed-forms", "stiffness")


def text_of(html):
    assert "<script" not in html
    return " ".join(ET.fromstring(f"<div>{html}</div>").itertext())


def test_a_run_shows_its_headlines_and_files(tmp_path):
    results = run_scene(parse_scene(SCENE), tmp_path, use_cache=False)
    shown = text_of(results._repr_html_())
    assert "alert(1)" in shown
    assert "mean" in shown
    assert "results.nc" in shown


def test_a_study_shows_its_first_rows_and_faults(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    raw = {
        "title": "<script>b</script>",
        "scene": "scene.toml",
        "outputs": ["contact_ratio"],
        "vary": {"pair.module_mm": {"from": 1.0, "to": 3.0, "steps": 30}},
    }
    plan = plan_of(StudyFile.model_validate(raw), tmp_path)
    rows = tuple(RowResult(i, (1.7 + i,), 0.1, "<i>bad</i>" if i == 3 else "") for i in range(30))
    shown = text_of(StudyResults(plan, rows, 30, 3.0)._repr_html_())
    assert "30 rows, 1 failed" in shown
    assert "<i>bad</i>" in shown  # as text
    assert "12.7" in shown
    assert "13.7" not in shown


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_completion_script_knows_the_commands(shell, tmp_path, capsys):
    assert completion(shell) == 0
    script = capsys.readouterr().out
    for name in ("run", "study", "import", "export-profile", "tolerance-um"):
        assert name in script
    if shutil.which(shell):  # where the shell is at hand it parses the script
        (tmp_path / "script").write_text(script)
        subprocess.run([shell, "-n", str(tmp_path / "script")], check=True, capture_output=True)


def test_every_command_says_what_it_does():
    names = [name for name in app if not name.startswith("-")]
    assert {"run", "check", "import", "export-rexs", "export-profile", "completion"} <= set(names)
    assert all(app[name].help for name in names)
