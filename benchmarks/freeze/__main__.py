"""Command line: ``python -m benchmarks.freeze COMMIT [COMMIT]``."""

from __future__ import annotations

import argparse
import signal
import sys
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from fnmatch import fnmatch
from pathlib import Path
from types import FrameType

from .case import Case
from .comparing import within
from .running import Outcome, run_cases
from .trees import CommitError, checked_out, described
from .worker import all_cases

SHOWN = 6
"""Changes of a case that are listed unless all are asked for."""


def arguments(command_line: Sequence[str] | None = None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.freeze", description="Compare two commits bit by bit on this machine."
    )
    add = parser.add_argument
    add("first", metavar="COMMIT", help="commit that the other is compared with")
    add("second", metavar="COMMIT", nargs="?", help="the working tree unless given")
    add("--only", metavar="PATTERN", action="append", help="cases by name, such as 'fem/*'; may be repeated")
    add("--quick", action="store_true", help="a subset of the cases that takes minutes")
    add("--processes", type=int, default=1, metavar="N", help="cases at once (default 1)")
    add("--tolerance", type=float, default=0.0, metavar="T",
        help="accept, but list, differences up to T of the array's maximum")  # fmt: skip
    add("--all", action="store_true", help=f"list every changed array, not the first {SHOWN} of a case")
    add("--keep", type=Path, metavar="FOLDER", help="keep the arrays of both commits there, as .npz")
    add("--list", action="store_true", help="list the cases and stop")
    return parser.parse_args(command_line)


def chosen(cases: Sequence[Case], only: Sequence[str] | None, quick: bool) -> list[Case]:
    """Cases by name and length."""
    kept = [case for case in cases if case.quick or not quick]
    return [case for case in kept if not only or any(fnmatch(case.name, pattern) for pattern in only)]


def line(outcome: Outcome, tolerance: float, all_changes: bool) -> str:
    """What a case did, on one line, and below it the changes."""
    took = f"[{outcome.seconds[0]:.0f} + {outcome.seconds[1]:.0f} s]"
    name = f"{outcome.case.name:32}"
    first, second = outcome.faults
    if first or second:
        if first == second:
            return f"{name} FAILS in both commits: {first} {took}"
        said = [f"{which}: {fault}" for which, fault in (("first", first), ("second", second)) if fault]
        return f"{name} FAILS in the {'; in the '.join(said)} {took}"
    if not outcome.changes:
        return f"{name} bitwise ({outcome.arrays} arrays) {took}"
    accepted = "within the tolerance" if within(outcome.changes, tolerance) else "CHANGED"
    head = f"{name} {accepted}: {len(outcome.changes)} of {outcome.arrays} arrays {took}"
    shown = outcome.changes if all_changes else outcome.changes[:SHOWN]
    rest = len(outcome.changes) - len(shown)
    more = [f"    and {rest} more (--all)"] if rest else []
    return "\n".join([head, *(f"    {change}" for change in shown), *more])


def summary(outcomes: Sequence[Outcome], tolerance: float) -> str:
    """How many cases are the same, accepted, changed and failed."""
    failed = [outcome for outcome in outcomes if any(outcome.faults)]
    changed = [outcome for outcome in outcomes if outcome.changes and not within(outcome.changes, tolerance)]
    accepted = [outcome for outcome in outcomes if outcome.changes and within(outcome.changes, tolerance)]
    same = len(outcomes) - len(failed) - len(changed) - len(accepted)
    parts = [f"{same} of {len(outcomes)} cases bitwise"]
    for cases, word in ((accepted, "within the tolerance"), (changed, "changed"), (failed, "failed")):
        if cases:
            parts.append(f"{len(cases)} {word} ({', '.join(outcome.case.name for outcome in cases)})")
    return "; ".join(parts)


def passed(outcomes: Sequence[Outcome], tolerance: float) -> bool:
    """Whether every case ran in both commits and changed no more than the tolerance."""
    return all(not any(outcome.faults) and within(outcome.changes, tolerance) for outcome in outcomes)


def main(command_line: Sequence[str] | None = None) -> int:
    """Compare; 0 where nothing changed, 1 where something did or failed, 2 where nothing could be compared."""
    asked = arguments(command_line)
    cases = chosen(all_cases(), asked.only, asked.quick)
    if asked.list or not cases:
        print("\n".join(case.name for case in cases) or "no case has such a name: --list shows all")
        return 0 if asked.list else 2
    try:
        names = described(asked.first), described(asked.second)
    except CommitError as fault:
        print(fault, file=sys.stderr)
        return 2
    print(f"first:  {names[0]}\nsecond: {names[1]}", flush=True)
    outcomes = []
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="freeze-"))).resolve()
        files = asked.keep.resolve() if asked.keep else folder / "arrays"
        files.mkdir(parents=True, exist_ok=True)
        first, second = (
            stack.enter_context(checked_out(commit, folder / name))
            for commit, name in ((asked.first, "first"), (asked.second, "second"))
        )
        for outcome in run_cases(cases, (first, second), folder, files, max(1, asked.processes)):
            print(line(outcome, asked.tolerance, asked.all), flush=True)
            outcomes.append(outcome)
    print(summary(outcomes, asked.tolerance))
    return 0 if passed(outcomes, asked.tolerance) else 1


def _ended(number: int, frame: FrameType | None) -> None:
    """End as from the keyboard, so that worktrees are removed."""
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _ended)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("interrupted: the temporary trees are removed")
