"""How kernels are compiled and kept, with documented options of numba."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ORBITS = (
    "import json, dynamics; import numpy as np;"
    "law = dynamics.FourierStiffness(1.0, (0.18, 0.05, 0.02), (0.0, 0.3, 1.0));"
    "pair = dynamics.GearOscillator(law, 0.05, 0.1, (0.2, 0.03), 0.6, 0.2, error_phase=(0.0, 0.4));"
    "kept = np.asarray(dynamics.sweep(pair, 'frequency', (0.55, 0.6))).tolist();"
    "branch = dynamics.continue_branch(dynamics.find_orbit(pair, (0.5, 0.2)), 'frequency', (0.5, 1.2));"
    "print(json.dumps([kept, branch.values.tolist(), branch.states.tolist()]))"
)
AID = "from dynamics.kernels.compiling import helper\n@helper\ndef twice(x):\n    return 2.0 * x\n"
WORK = (
    "from dynamics.kernels.compiling import kernel\nfrom dynamics.kernels.aid import twice\n"
    "@kernel\ndef more(x):\n    return twice(x) + 1.0\n"
)
MORE = (
    "import sys; sys.path.insert(0, sys.argv[1]);"
    "from flankfilm.files.cache import keep_compiled_code; keep_compiled_code();"
    "from dynamics.kernels.work import more; print(more(3.0), sum(more.stats.cache_hits.values()))"
)


def printed(code: str, *arguments: str, **variables: str) -> str:
    """What a fresh process prints, with these variables and no other place for compiled code."""
    env = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    run = [sys.executable, "-W", "ignore", "-c", code, *arguments]
    return subprocess.run(
        run, capture_output=True, text=True, check=True, env={**env, "PYTHONPATH": str(ROOT), **variables}
    ).stdout


def test_a_changed_helper_is_compiled_again(tmp_path):
    """Numba looks at the kernel's own file alone; the program and the tests keep kernels by all sources."""
    package = tmp_path / "dynamics" / "kernels"
    package.mkdir(parents=True)
    for folder in (package.parent, package):
        (folder / "__init__.py").touch()
    (package / "compiling.py").write_bytes((ROOT / "dynamics/kernels/compiling.py").read_bytes())
    (package / "aid.py").write_text(AID)
    (package / "work.py").write_text(WORK)

    def run() -> list[str]:
        return printed(MORE, str(tmp_path), FLANKFILM_CACHE=str(tmp_path / "cache")).split()

    assert run() == ["7.0", "0"]
    assert run() == ["7.0", "1"]
    # of another length: Python takes a source of the same size and second for the one that it compiled
    (package / "aid.py").write_text(AID.replace("2.0", "3.00"))
    assert run() == ["10.0", "0"]


@pytest.mark.slow
def test_what_a_process_compiled_or_loaded_changes_no_digit(tmp_path):
    """Every kernel runs its own helpers, whatever other kernels of the process were linked with."""
    first, again = (printed(ORBITS, NUMBA_CACHE_DIR=str(tmp_path)) for _ in range(2))
    assert first == again


def test_kernels_need_nothing_of_numbas_insides():
    """Another version of numba compiles the same sources: what they import is the first level of its names."""
    met = set()
    for source in (*(ROOT / "dynamics").rglob("*.py"), *(ROOT / "ehl").rglob("*.py")):
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                met.add(str(node.module))
            elif isinstance(node, ast.Import):
                met.update(alias.name for alias in node.names)
    assert {name for name in met if name.partition(".")[0] in ("numba", "llvmlite")} == {"numba"}
