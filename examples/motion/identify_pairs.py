"""Enumerate what meets the first grazing and the first period doubling of the article's 6.4, and how round it is.

Run it with:   python examples/motion/identify_pairs.py
About a minute. With 6.3 the scan whose parameters are known.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

from dynamics import FourierStiffness, GearOscillator
from dynamics.inverse import Event, OneOf, PairScan, by_two_events

OSCILLATOR = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.4, 0.4, half_backlash=0.4)
EVENTS = {
    "6.3": (Event("grazing", "1-0-0", 0.55869, 5), Event("period-doubling", "1-2-0", 0.63434, 5)),
    "6.4": (Event("grazing", "1-0-0", 0.78525136, 8), Event("period-doubling", "1-1-0", 1.14019254, 8)),
}
FREQUENCIES = {
    "6.3": OneOf((0.36, 0.38, 0.39, 0.405, 0.43)),
    "6.4": OneOf(tuple(0.2 + 0.025 * k for k in range(32))),
}
UNKNOWNS = {
    "6.3": {"damping_ratio": OneOf((0.05, 0.06, 0.07)), "stiffness.amplitudes[0]": OneOf((0.4, 0.5))},
    "6.4": {
        "damping_ratio": OneOf((0.01, 0.02, 0.03, 0.05, 0.06, 0.08, 0.1)),
        "stiffness.amplitudes[0]": OneOf((0.05, 0.1, 0.15, 0.18, 0.2, 0.25, 0.3, 0.4, 0.5)),
        "stiffness.phases[0]": OneOf((0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)),
    },
}


def main(arguments: Sequence[str] | None = None) -> PairScan:
    """Print what was found, the round ones by name."""
    sections = list(sys.argv[1:] if arguments is None else arguments) or ["6.4"]
    section = sections[0]
    scan = by_two_events(OSCILLATOR, EVENTS[section], FREQUENCIES[section], UNKNOWNS[section])
    print(scan.message)
    for row in scan.values[scan.rounded]:
        print(", ".join(f"{name} {value:.7g}" for name, value in zip(scan.names, row, strict=True)))
    return scan


if __name__ == "__main__":
    main()
