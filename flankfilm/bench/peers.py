"""Other programs on the same work, in a separate environment.

A peer is a file of ``benchmarks/peers``, which no wheel holds. ``main.py`` there runs it with an interpreter of that
environment and nothing of ours in its way: the work goes in as JSON on standard input, what it found comes back as one
line of JSON on standard output: ``peer``, ``version``, ``runs`` (each with ``level``, ``seconds``, ``first`` and
``values``) and perhaps a ``note``, or ``missing`` with what could not be imported.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flankfilm.bench.case import Case, PeerWork, Value, true_error, value
from flankfilm.bench.first_call import LONGEST, output_of

MAIN = Path(__file__).parents[2] / "benchmarks" / "peers" / "main.py"
"""Runs a peer; in a checkout alone."""


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
        Lowest processor time, and that of its first call [s].
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
    # neither variables nor packages of the user reach the peer; the scripts find each other
    command = [str(python), "-E", "-s", "-W", "ignore", str(MAIN), work.script, str(os.getpid())]
    printed = output_of(command, longest, input=json.dumps({**work.inputs, "repeat": repeat}))
    if isinstance(printed, str):
        return printed
    # programs print other lines too
    for line in reversed(printed):
        try:
            reply = json.loads(line)
        except json.JSONDecodeError:
            continue
        if isinstance(reply, dict) and ("runs" in reply or "missing" in reply):
            return reply
    return "printed no result"


def _rows(case: str, work: PeerWork, reply: dict[str, Any] | str, finest: Value) -> list[PeerRow]:
    if isinstance(reply, dict) and "missing" in reply:
        reply = f"not in that environment: {reply['missing']}"
    if isinstance(reply, str):
        nothing = (math.nan, math.nan, math.nan)
        return [PeerRow(case, work.quantity, work.script, "", "", *nothing, failure=reply)]
    return [
        PeerRow(
            case,
            work.quantity,
            str(reply["peer"]),
            str(reply["version"]),
            str(run["level"]),
            float(run["seconds"]),
            float(run["first"]),
            true_error(value(run["values"]), finest),
            str(reply.get("note", "")),
        )
        for run in reply["runs"]
    ]
