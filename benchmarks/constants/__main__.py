"""Command line: ``python -m benchmarks.constants PACKAGE ...``; a line for each constant, and a count at the end."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence

from benchmarks.constants.laws import LAWS, SHAPES
from benchmarks.constants.moving import moved, readers
from benchmarks.constants.scanned import PACKAGES, Constant, compiled, constants, scaled, usable


def verdict(constant: Constant) -> tuple[str, str]:
    """What a constant does to the answers that read it, and the largest move."""
    if not usable(constant.value) or str(constant) in SHAPES:
        return "no size", ""
    if compiled(constant):
        return "known to kernels", ""
    names = readers(constant)
    if not names:
        return "read by no answer", ""
    changes = [twice for twice in (True, False) if scaled(constant.value, twice) != constant.value]
    moves = [moved(constant, twice, name) for twice in changes for name in names]
    if not moves:
        return "no size", ""
    largest = max(moves, key=lambda move: move.worst)
    if largest.worst <= 1.0:
        return "within the errors", str(largest)
    return ("law with a test" if str(constant) in LAWS else "decides"), str(largest)


def main(command_line: Sequence[str] | None = None) -> int:
    """Study the constants of packages."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.constants", description="Double and halve numeric constants."
    )
    parser.add_argument("packages", nargs="+", choices=PACKAGES, metavar="PACKAGE")
    for package in parser.parse_args(command_line).packages:
        counts: Counter[str] = Counter()
        for constant in constants(package):
            kind, move = verdict(constant)
            counts[kind] += 1
            print(f"{kind:18} {constant}" if not move else f"{kind:18} {move}", flush=True)
        print(f"{package}: " + ", ".join(f"{count} {kind}" for kind, count in counts.most_common()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
