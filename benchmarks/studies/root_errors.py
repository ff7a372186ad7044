"""Reported against true errors of greatest root stresses, the fillets' mesh included, over random pairs.

Pairs of `figure_errors.py`, every second one; true: fillets of 0.01 modules before their refinement under the same
forces. Run from the root with ``PYTHONPATH=. python benchmarks/studies/root_errors.py [pairs] [seed ...]``.
"""

from __future__ import annotations

import sys
import warnings
from collections import defaultdict

import numpy as np

import fem
from base import InputError
from benchmarks.studies import figure_errors
from fem.pair.pair_fillets import fillets
from fem.stress.tooth_root import root_stress

FINEST = 0.01


def main(count: int, seeds: list[int]) -> None:
    """Print the errors of each pair, and the quantiles of the ratios."""
    found, missing = defaultdict(list), 0
    for seed in seeds:
        for number in range(0, count, 2):
            pair, torque, options = figure_errors.drawn(np.random.default_rng([seed, number]))
            bodies = fem.compliance(pair, figure_errors.TOLERANCE, tip_edges=True)
            cycle = figure_errors.solved(pair, torque, options, bodies, figure_errors.TOLERANCE)
            try:
                usual, best = (
                    root_stress(pair, cycle, fillets(pair, **how)) for how in ({}, {"fillet_edge": FINEST})
                )
            except InputError as fault:
                missing += 1
                print(f"{seed}/{number} {fault}", flush=True)
                continue
            for gear in ("pinion", "wheel"):
                one, true = getattr(usual, gear), getattr(best, gear)
                for name, error in one.errors.items():
                    off = abs(getattr(one, name) / getattr(true, name) - 1)
                    found[f"{name.removesuffix('_Pa')}, {gear}"].append(error / max(off, figure_errors.FLOOR))
            print(
                f"{seed}/{number} z {pair.pinion.teeth}/{pair.wheel.teeth}, error {usual.error:.1e}",
                flush=True,
            )
    figure_errors.show(found, missing)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    given = [int(word) for word in sys.argv[1:]]
    main(given[0] if given else 40, given[1:] or [1])
