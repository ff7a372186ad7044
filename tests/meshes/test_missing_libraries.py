"""Without its shared libraries gmsh cannot load: the message names them and the remedy."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.flankfilm.scenes import ARTICLE


def test_the_message_names_the_library_and_the_remedy(tmp_path: Path):
    (tmp_path / "gmsh.py").write_text("raise OSError('libGLU.so.1: cannot open shared object file')\n")
    scene = tmp_path / "scene.toml"
    scene.write_text(f'title = "X"\nwants = ["geometry", "stiffness"]\n{ARTICLE}', encoding="utf-8")
    code = (
        "import sys; sys.path.insert(0, sys.argv.pop(1)); from flankfilm.cli import main; "
        "sys.argv[0] = 'flankfilm'; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, tmp_path, "run", scene, "--out", tmp_path / "out", "--no-cache"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 4, done.stderr  # the geometry needs none
    assert "libGLU.so.1" in done.stderr
    assert "apt-get install" in done.stderr
    assert "Traceback" not in done.stderr
