"""How kernels are compiled: the shorter way where numba's insides were tried, numba's own way elsewhere."""

import json
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import dynamics

NOT_TRIED = "import sys, numba; numba.__version__ = '0.0'; sys.modules['dynamics.kernels.pipeline'] = None;"
ORBITS = (
    "import json, dynamics; import numpy as np;"
    "law = dynamics.FourierStiffness(1.0, (0.18, 0.05, 0.02), (0.0, 0.3, 1.0));"
    "pair = dynamics.GearOscillator(law, 0.05, 0.1, (0.2, 0.03), 0.6, 0.2, error_phase=(0.0, 0.4));"
    "kept = np.asarray(dynamics.sweep(pair, 'frequency', (0.55, 0.6))).tolist();"
    "branch = dynamics.continue_branch(dynamics.find_orbit(pair, (0.5, 0.2)), 'frequency', (0.5, 1.2));"
    "print(json.dumps([kept, branch.values.tolist(), branch.states.tolist()]))"
)


def printed(code: str, cache: Path, *arguments: str) -> str:
    """What a fresh process prints that keeps its kernels in a folder."""
    env = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
    run = [sys.executable, "-W", "ignore", "-c", code, *arguments]
    return subprocess.run(run, capture_output=True, text=True, check=True, env=env).stdout


@pytest.mark.parametrize("before", ["", NOT_TRIED], ids=["tried", "not tried"])
def test_another_numba_takes_its_own_way(tmp_path, before):
    """A version whose insides were not tried needs none of them: kernels, helpers and pieces work, and are kept."""
    package = tmp_path / "dynamics" / "kernels"
    package.mkdir(parents=True)
    for source in ("compiling.py", "pipeline.py"):
        shutil.copy(Path(dynamics.__file__).parent / "kernels" / source, package)
    for folder in (package.parent, package):
        (folder / "__init__.py").touch()
    (package / "work.py").write_text(
        "from dynamics.kernels.compiling import helper, kernel, shared\n"
        "@helper\ndef last(a):\n    return a[len(a) - 1]\n"
        "@shared('f8(f8[::1], i8)')\ndef piece(a, n):\n    total = 0.0\n    for k in range(n):\n"
        "        total += a[k] * a[-1]\n    return total\n"
        "@kernel\ndef work(a):\n    b, (c, d) = piece(a, len(a)), (last(a), a[0])\n    a[1:2] = 0.0\n"
        "    return max(b, c) + d + a[1]\n"
    )
    code = (
        f"{before}import sys; sys.path.insert(0, sys.argv[1]); import numpy as np;"
        "from dynamics.kernels import compiling; from dynamics.kernels.work import work;"
        "print(work(np.array([1.0, 2.0, 3.0])), sum(work.stats.cache_hits.values()), bool(compiling.LINKED))"
    )
    for hits in (0, 1):
        assert printed(code, tmp_path / "kept", str(tmp_path)).split() == ["19.0", str(hits), str(not before)]


@pytest.mark.slow
def test_what_a_process_compiled_or_loaded_changes_no_digit(tmp_path):
    """Every kernel runs its own helpers, whatever other kernels of the process were linked with.

    Before, a branch's last digits were others in a process that compiled than in one that loaded what it had kept.
    """
    first, again = (printed(ORBITS, tmp_path) for _ in range(2))
    assert first == again


@pytest.mark.long
@pytest.mark.slow
def test_numbers_in_numbas_own_way(tmp_path):
    """Sweep and branch by both ways of compiling: the same to rounding, which Newton's method leaves in an orbit."""
    short, plain = (
        json.loads(printed(before + ORBITS, tmp_path / name))
        for name, before in (("short", ""), ("plain", NOT_TRIED))
    )
    for one, other in zip(short, plain, strict=True):
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-11)


def test_no_numba_is_installed_whose_insides_were_not_tried():
    """The dependency ends before the minor version after the last one tried."""
    from dynamics.kernels.compiling import TRIED

    text = (Path(dynamics.__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    (numba,) = (line for line in tomllib.loads(text)["project"]["dependencies"] if line.startswith("numba"))
    major, minor = max(tuple(map(int, version.strip(".").split("."))) for version in TRIED)
    assert numba.endswith(f",<{major}.{minor + 1}")
