"""Kernels compiled before a session begins on several workers, each of which would compile them for itself."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.processes import unwatched

PATIENCE = 280.0
"""Seconds that the parts may take together."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes(config: pytest.Config, specs: list[object]) -> None:
    """Compile on all cores what a session of the whole suite needs; one of named tests needs little of it."""
    if len(specs) < 2 or config.args_source is pytest.Config.ArgsSource.ARGS:
        return
    command = [sys.executable, "-m", "flankfilm", "warm-up"]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=PATIENCE, env=unwatched(), check=True
    )
    config.get_terminal_writer().line(done.stdout)
