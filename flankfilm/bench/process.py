"""What another process prints, or why it prints nothing."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

LONGEST = 300.0
"""Seconds after which a process is stopped."""


def output_of(command: Sequence[str], longest: float = LONGEST, **how: Any) -> list[str] | str:
    """Lines that a command prints, or the reason why it failed; `how` are further arguments of `subprocess.run`."""
    how |= {"capture_output": True, "text": True, "timeout": longest, "check": False}
    try:
        done: subprocess.CompletedProcess[str] = subprocess.run(command, **how)
    except subprocess.TimeoutExpired:
        return f"took longer than {longest:g} s"
    except OSError as error:
        return f"{Path(command[0]).name} does not run: {error.strerror or error}"
    if done.returncode:
        return (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
    return done.stdout.splitlines()
