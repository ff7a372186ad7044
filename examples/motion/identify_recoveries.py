"""How often `identify` finds parameters back from eight of their special points, up to two of them misprinted.

Damping, stiffness and force are drawn at random (equal ratios, seeds 0, 1, ...), eight special points of the motion in
contact and of its doubled branches are chosen at random and printed with six decimals; a misprint changes the second,
third or fourth. A case counts as found if every parameter is within a thousandth.

    python examples/motion/identify_recoveries.py            # ten oscillators, five minutes
    python examples/motion/identify_recoveries.py --cases 1
"""

from __future__ import annotations

import argparse
import dataclasses
import time

import numpy as np

from dynamics import FourierStiffness, GearOscillator, continue_branch, doubled_orbit, find_orbit
from dynamics.branches.grazing import contact_orbit
from dynamics.inverse import Event, Identification, Ranged, identify

BOUNDS = (0.3, 1.3)
DECIMALS = 6
RANGES = {
    "damping_ratio": Ranged(0.02, 0.1),
    "stiffness.amplitudes[0]": Ranged(0.05, 0.35),
    "mean_force": Ranged(0.03, 0.3),
}


def drawn(seed: int) -> tuple[GearOscillator, list[Event], np.random.Generator]:
    """Oscillator and eight of its points as printed."""
    rng = np.random.default_rng(seed)
    while True:
        zeta, kappa, force = (
            float(r.low * (r.high / r.low) ** rng.uniform(0.1, 0.9)) for r in RANGES.values()
        )
        here = GearOscillator(FourierStiffness(1.0, (kappa,), (0.0,)), zeta, force, 0.2, BOUNDS[0], 0.4)
        start = find_orbit(here, contact_orbit(here).state)
        if not start.converged:
            continue
        branch = continue_branch(start, "frequency", BOUNDS)
        points = list(branch.points)
        for point in branch.special("period-doubling"):
            orbit = doubled_orbit(here, "frequency", point, BOUNDS)
            if orbit is not None:
                points += continue_branch(orbit, "frequency", BOUNDS).points
        values, first = np.unique([round(p.parameter, DECIMALS) for p in points], return_index=True)
        if len(values) >= 8:
            break
    chosen = sorted(rng.choice(first, 8, replace=False))
    return here, [_printed(points[i].kind, points[i].label, points[i].parameter) for i in chosen], rng


def misprinted(events: list[Event], number: int, rng: np.random.Generator) -> list[Event]:
    """The same with one digit wrong in some of them."""
    events = list(events)
    for i in rng.choice(len(events), number, replace=False):
        digits = f"{events[i].value:.{DECIMALS}f}"
        at = digits.index(".") + int(rng.integers(2, 5))
        wrong = str((int(digits[at]) + int(rng.integers(1, 10))) % 10)
        events[i] = dataclasses.replace(events[i], value=float(digits[:at] + wrong + digits[at + 1 :]))
    return events


def off(identification: Identification, here: GearOscillator) -> float:
    """Largest relative error of a parameter."""
    if identification.best is None:
        return float("nan")
    return max(abs(identification.best.values[name] / here.get(name) - 1.0) for name in RANGES)


def _printed(kind: str, label: str, value: float) -> Event:
    return Event(kind, label.removeprefix("U"), round(value, DECIMALS), DECIMALS)


def main() -> None:
    """Print one line for each case and the sums."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cases", type=int, default=10, help="number of oscillators")
    cases = parser.parse_args().cases
    good = {0: 0, 1: 0, 2: 0}
    claimed = {0: 0, 1: 0, 2: 0}
    print("case misprints   zeta      kappa     F_m       error     by chance  claimed  trials  seconds")
    for seed in range(cases):
        for number in good:
            here, events, rng = drawn(seed)
            began = time.process_time()
            identification = identify(here, "frequency", misprinted(events, number, rng), RANGES, BOUNDS)
            error = off(identification, here)
            good[number] += error < 1e-3
            claimed[number] += identification.converged and not error < 1e-3
            values = "".join(f"{here.get(name):<10.6f}" for name in RANGES)
            print(
                f"{seed:4d} {number:9d}   {values}{error:<10.1e}"
                f"{identification.by_chance:<11.1e}{identification.converged!s:8s}"
                f"{identification.trials:7d} {time.process_time() - began:8.1f}",
                flush=True,
            )
    for number in good:
        print(f"{number} misprints: {good[number]} of {cases} found, {claimed[number]} wrong ones claimed")


if __name__ == "__main__":
    main()
