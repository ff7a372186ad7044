"""Other programs on the same work, in an environment of their own.

A peer is a script that an interpreter of that environment runs with nothing of ours in its way: the work goes in as
JSON on standard input, what it found comes back as one line of JSON on standard output: ``peer``, ``version``,
``runs`` (each with ``level``, ``seconds``, ``first`` and ``values``) and perhaps a ``note``, or ``missing`` with what
could not be imported.
"""

from __future__ import annotations

import json
import math
import subprocess
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from flankfilm.bench.case import Case, PeerWork, Value, true_error

__all__ = ["PeerRow", "ask"]

LONGEST = 300.0


@dataclass(frozen=True)
class PeerRow:
    """What a peer did with the work of one case.

    Attributes
    ----------
    case, quantity : str
        Whose work, and which of its quantities the values are.
    peer, version, level : str
        Program and setting.
    cpu, first : float
        Least processor time, and that of its first call [s].
    error : float
        Relative difference from the case's finest solution.
    note : str
        What must be known about the time.
    failure : str
        Why there are no figures; empty where there are.
    """

    case: str
    quantity: str
    peer: str
    version: str
    level: str
    cpu: float
    first: float
    error: float
    note: str = ""
    failure: str = ""


def ask(python: Path, case: Case, repeat: int, longest: float = LONGEST) -> list[PeerRow]:
    """Have every peer of a case do its work.

    Parameters
    ----------
    python : Path
        Interpreter of the peers' environment.
    case : Case
        Its finest solution is computed once more, to compare with.
    repeat : int
        Timed runs of each setting.
    longest : float
        Seconds after which a peer is stopped.

    Returns
    -------
    list of PeerRow
        At least one for each peer: one that is missing or fails has its reason there.
    """
    if not case.peers or case.finest is None:
        return []
    finest = case.finest.answer(case.finest.work()).values
    rows: list[PeerRow] = []
    for work in case.peers:
        reply = _run(python, work, repeat, longest)
        rows += _rows(case.key, work, reply, finest[work.quantity])
    return rows


def _run(python: Path, work: PeerWork, repeat: int, longest: float) -> dict[str, Any] | str:
    """Return what the script printed, or why it printed nothing."""
    script = resources.files("flankfilm.bench").joinpath("peer_scripts", f"{work.script}.py")
    with resources.as_file(script) as path:
        command = [str(python), "-I", "-W", "ignore", str(path)]
        try:
            done = subprocess.run(
                command,
                input=json.dumps({**work.given, "repeat": repeat}),
                capture_output=True,
                text=True,
                timeout=longest,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return f"took longer than {longest:g} s"
        except OSError as error:
            return f"{python.name} does not run: {error.strerror or error}"
    if done.returncode:
        return (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
    # programs print lines of their own
    for line in reversed(done.stdout.splitlines()):
        try:
            reply = json.loads(line)
        except json.JSONDecodeError:
            continue
        if isinstance(reply, dict) and ("runs" in reply or "missing" in reply):
            return reply
    return "printed no result"


def _rows(case: str, work: PeerWork, reply: dict[str, Any] | str, finest: Value) -> list[PeerRow]:
    failed = (math.nan, math.nan, math.nan, "")
    if isinstance(reply, str):
        return [PeerRow(case, work.quantity, work.script, "", "", *failed, reply)]
    if "missing" in reply:
        reason = f"not in that environment: {reply['missing']}"
        return [PeerRow(case, work.quantity, work.script, "", "", *failed, reason)]
    return [
        PeerRow(
            case,
            work.quantity,
            str(reply["peer"]),
            str(reply["version"]),
            str(run["level"]),
            float(run["seconds"]),
            float(run["first"]),
            true_error(Value(np.array(run["values"], dtype=float)), finest),
            str(reply.get("note", "")),
        )
        for run in reply["runs"]
    ]
