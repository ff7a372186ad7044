"""Error against cost of the closed forms, of generating a pair, of rolling it and of sharing a load.

The error of a closed form is its difference from finite elements for the article's pair (one pair of teeth,
nine equal steps from A to E, plane strain, bore of half the root radius; independent program). Run with
``python benchmarks/gears_closed_forms.py``.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from gears import Gear, GearPair, check_meshing, closed_form, share_load

FINITE_ELEMENTS = np.array([10.26, 12.39, 13.70, 14.53, 14.83, 14.56, 13.75, 12.45, 10.31])
FORCE = 17736.3


class LineContact:
    """A logarithmic local law with the slope of the article's pair."""

    def approach(self, force):
        """Deflection [m]."""
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 2.8e-11 * safe * (np.log(1e9 / safe) + 1.0), 0.0)

    def slope(self, force):
        """Its derivative [m/N]."""
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 2.8e-11 * np.log(1e9 / safe), np.inf)


def seconds(call: Callable[[], object]) -> float:
    """Best of five timings, each repeated until it takes 20 ms."""
    call()
    repeat = 1
    while True:
        start = time.perf_counter()
        for _ in range(repeat):
            call()
        if time.perf_counter() - start > 0.02:
            break
        repeat *= 4
    times = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(repeat):
            call()
        times.append((time.perf_counter() - start) / repeat)
    return min(times)


def article_pair() -> GearPair:
    pair = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 40e-3)
    assert pair.contact_ratio > 1
    return pair


def main() -> None:
    pair = article_pair()
    path = pair.path_at(np.linspace(pair.points.A + 2e-5, pair.points.E - 2e-5, 9))
    forms = {
        "Ishikawa": lambda: closed_form.ishikawa(pair, path),
        "Weber-Banaschek": lambda: closed_form.weber_banaschek(pair, path, FORCE),
        "potential energy": lambda: closed_form.potential_energy(pair, path),
        "potential energy, Hertz": lambda: closed_form.potential_energy(pair, path, FORCE),
    }
    print(f"{'nine points of the path':32}{'rms off FE':>12}{'largest':>10}{'time':>12}")
    for name, call in forms.items():
        off = np.asarray(call()) / 40e6 / FINITE_ELEMENTS - 1
        rms, largest = np.sqrt(np.mean(off**2)), off[np.argmax(np.abs(off))]
        print(f"{name:32}{100 * rms:>10.1f} %{100 * largest:>8.1f} %{1e6 * seconds(call):>9.0f} us")
    print(f"\n{'geometry':32}{'error':>12}{'time':>22}")
    print(f"{'generate the pair, with guards':32}{'exact':>12}{1e3 * seconds(article_pair):>19.2f} ms")
    rolled = check_meshing(pair)
    took = seconds(lambda: check_meshing(pair))
    print(f"{'roll it through a mesh cycle':32}{rolled.angle_deviation:>12.0e}{1e3 * took:>19.0f} ms")
    print(f"\n{'load sharing, three pairs':32}{'sum of F off':>12}{'time per position':>22}")
    one, three = 2.4e-9 * np.eye(3) + 4e-10, np.array([0.0, 5e-6, 2e-5])
    for positions in (1, 40, 400):
        bulk = np.broadcast_to(one, (positions, 3, 3))
        gaps = np.broadcast_to(three, (positions, 3))
        share = share_load(FORCE, bulk, LineContact(), gaps)
        off = float(np.max(np.abs(share.forces.sum(axis=-1) / FORCE - 1)))
        took = seconds(lambda b=bulk, g=gaps: share_load(FORCE, b, LineContact(), g))
        print(f"{f'{positions} at once':32}{off:>12.0e}{1e6 * took / positions:>19.1f} us")


if __name__ == "__main__":
    main()
