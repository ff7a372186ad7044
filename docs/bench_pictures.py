"""Draws the pictures of docs/validation/error_against_cost.md: python docs/bench_pictures.py FOLDER.

FOLDER holds the ``bench.json`` of ``flankfilm bench --out FOLDER``.
"""

from __future__ import annotations

import sys
from pathlib import Path

from runs import save

from flankfilm.bench import pictures as bench
from flankfilm.bench.tables import read_bench

CASES = ("compliance", "contact_free", "root_stress", "film_tolerance", "motion_flow")


def main(folder: Path) -> None:
    """Write docs/images/bench_*.png."""
    measured = read_bench(folder / "bench.json")
    drawn = {"overview": bench.overview(measured.cases), "estimates": bench.estimates(measured.cases)}
    for case in measured.cases:
        if case.key in CASES:
            peers = [peer for peer in measured.peers if peer.case == case.key]
            drawn[case.key] = bench.error_against_cost(case, peers)
    save({f"bench_{name}": figure for name, figure in drawn.items()}, dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
