"""Reported against true errors of mesh cycles of helical pairs, over random pairs.

Helix angles of 5 to 32 degrees, overlap ratios of .2 to 4 (faces of at most 120 mm), pinions of 18 to 44 teeth,
profile shifts of -.1 to .5, m_n 2 mm, steel, 30, 100 or 300 N/mm, 64 cells. True: 128 cells, free ends from a
section with edges of two thirds, seven places instead of five and shorter pieces at the end, waves from 16 places
instead of 12.
Figures are those of 16 positions, their reported errors those of the cycle's arcs. Every pair's figures go to a line of
a file as soon as they are known, and solved gears to folders beside it: a study that was cut off goes on where it
stopped. Run from the root with

    PYTHONPATH=. python benchmarks/studies/helix_errors.py FILE [pairs] [seed] [seconds]

until it prints the table: how many ratios of reported and true error are between 0.5 and 5, and how many are or have a
true error below 5e-4, where care costs nothing. A pair takes two to four minutes.
"""

from __future__ import annotations

import hashlib
import pickle
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from math import log, pi, radians, sin
from pathlib import Path
from typing import Any

import numpy as np

import fem
from base import Array
from benchmarks.studies.pair_by_pair import begin, pair_by_pair, quantiles
from fem.influence import helix_ends, helix_waves
from fem.influence.gear_shape import plain
from fem.influence.gear_store import GearStore
from gears import Gear, GearPair

SEED = 2811

MODULE, WIDEST = 2e-3, 0.12
"""Normal module and largest face width [m]."""

LINE_LOADS = 30e3, 100e3, 300e3
"""[N per m of face]"""

GEARS, WIDTHS = 6, 2
"""Pairs of gears that are drawn at once, and face widths of each."""

CELLS, POSITIONS, TOLERANCE = 64, 16, 0.01

HARMONICS = ("first harmonic", "second harmonic", "third harmonic", "fourth harmonic")
"""Of the transmission error."""

SMALL = 5e-4
"""Errors below it are small."""

FINER: dict[str, Any] = {
    "SECTION": replace(helix_ends.SECTION, flank=0.3, fillet=0.35, root=0.6, corner=0.3, top=1.0, rim=1.4),
    "COARSE_SECTION": replace(
        helix_ends.COARSE_SECTION, flank=0.6, fillet=0.4, root=0.9, corner=0.6, top=1.5
    ),
    "PLACES": 7,
    "INWARDS": (0.25, 0.7, 1.5, 3.5),
    "BODY_INWARDS": (1.3, 2.4),
    "OUTWARDS": (0.35, 1.0, 3.0),
    "ACROSS": (0.15, 0.35, 0.35, 0.15),
}
"""Choices of free ends."""

WAVE_PLACES = 16


def drawn(number: int, seed: int) -> tuple[GearPair, float]:
    """A pair and its torque."""
    block, within = divmod(number, GEARS * WIDTHS)
    rng, pairs = np.random.default_rng(seed + block), []
    for _ in range(GEARS):
        angle, first = rng.uniform(5, 32), int(rng.integers(18, 45))
        second, shifts = int(rng.integers(first, 80)), rng.uniform(-0.1, 0.5, 2).round(2).tolist()
        pairs.append((radians(angle), (first, second), shifts))
    for angle, teeth, shifts in pairs:
        for overlap in np.exp(rng.uniform(log(0.2), log(4.0), WIDTHS)).tolist():
            width = min(overlap * pi * MODULE / sin(angle), WIDEST)
            load = float(rng.choice(LINE_LOADS)) * width
            if not within:
                pinion, wheel = (Gear(teeth=z, profile_shift=x) for z, x in zip(teeth, shifts, strict=True))
                pair = GearPair(pinion, wheel, MODULE, width, helix_angle=angle)
                return pair, load * pair.base_radii[0]
            within -= 1
    raise AssertionError


@contextmanager
def kept(folder: Path) -> Iterator[None]:
    """Keep what free ends and waves of gears cost in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    record = GearStore.record

    def on_disk(store: GearStore, name: str, key: tuple[Any, ...], compute: Callable[[], Any]) -> Any:
        digest = hashlib.md5(repr((name, plain(key))).encode(), usedforsecurity=False).hexdigest()
        file = folder / f"{name.replace(' ', '_')}_{digest}"

        def solved() -> Any:
            if file.exists():
                return pickle.loads(file.read_bytes())
            found = compute()
            file.with_suffix(".part").write_bytes(pickle.dumps(found))
            file.with_suffix(".part").rename(file)
            return found

        return record(store, name, key, solved if name.startswith("helix") else compute)

    setattr(GearStore, "record", on_disk)  # noqa: B010
    try:
        yield
    finally:
        setattr(GearStore, "record", record)  # noqa: B010


@contextmanager
def finer() -> Iterator[None]:
    """Free ends and waves of what is taken for the truth."""
    before, places = {name: getattr(helix_ends, name) for name in FINER}, helix_waves.PLACES
    for name, value in FINER.items():
        setattr(helix_ends, name, value)
    helix_waves.PLACES = WAVE_PLACES
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(helix_ends, name, value)
        helix_waves.PLACES = places


def solve(pair: GearPair, torque: float, folder: Path, fine: bool) -> fem.MeshCycle:
    """A cycle, and the one that is taken for the truth."""
    fem.forget_gears()
    with ExitStack() as stack:
        stack.enter_context(kept(folder))
        if fine:
            stack.enter_context(finer())
        cycle = fem.mesh_cycle(
            pair, torque, POSITIONS, tolerance=TOLERANCE, cells=2 * CELLS if fine else CELLS
        )
        if not fine:
            assert reported(cycle)  # while gears are known and choices are the usual ones
    return cycle


def figures(cycle: fem.MeshCycle) -> dict[str, float]:
    """Figures of the positions of a cycle."""
    assert cycle.lines is not None
    moved: Array = cycle.transmission_error
    sizes = np.abs(np.fft.rfft(moved)) * 2.0 / len(moved)
    return {
        "mean tangent": float(cycle.stiffness.mean()),
        "least tangent": float(cycle.stiffness.min()),
        "greatest tangent": float(cycle.stiffness.max()),
        "mean secant": float(cycle.secant_stiffness.mean()),
        "peak to peak": float(np.ptp(moved)),
        **dict(zip(HARMONICS, sizes[1 : len(HARMONICS) + 1].tolist(), strict=True)),
        "line-load factor": cycle.lines.greatest_line_load_factor,
        "line load": cycle.lines.greatest_line_load,
    }


def reported(cycle: fem.MeshCycle) -> dict[str, float]:
    """Errors that a cycle tells of them, relative."""
    assert cycle.lines is not None
    size, off = cycle.transmission_error_harmonics, cycle.transmission_error_harmonics_error
    assert off is not None
    known = cycle.errors
    return {
        "mean tangent": float(known["mean_stiffness"] or 0.0),
        "least tangent": float(known["least_stiffness"] or 0.0),
        "greatest tangent": float(known["greatest_stiffness"] or 0.0),
        "mean secant": float(known["mean_secant_stiffness"] or 0.0),
        "peak to peak": float(known["transmission_error_range"] or 0.0),
        **dict(zip(HARMONICS, (off / size).tolist(), strict=False)),
        "line-load factor": cycle.lines.error,
        "line load": cycle.lines.line_load_error,
        "deflection at a position": cycle.error,
        "load centre": cycle.lines.centre_error,
    }


def one(number: int, seed: int, folder: Path) -> dict[str, Any]:
    """True and reported errors of a pair, as plain numbers."""
    pair, torque = drawn(number, seed)
    began = time.process_time()
    usual = solve(pair, torque, folder / "usual", fine=False)
    middle = time.process_time()
    true = solve(pair, torque, folder / "finer", fine=True)
    assert usual.lines is not None
    assert true.lines is not None
    found, exact = figures(usual), figures(true)
    errors = {name: abs(value / exact[name] - 1.0) for name, value in found.items()}
    moved = usual.transmission_error / true.transmission_error - 1.0
    errors["deflection at a position"] = float(np.sqrt(np.mean(moved**2)))
    apart = usual.lines.load_centre - true.lines.load_centre
    errors["load centre"] = float(np.sqrt(np.mean(apart**2)))
    return {
        "teeth": [pair.pinion.teeth, pair.wheel.teeth],
        "angle": float(np.degrees(pair.helix_angle)),
        "overlap": pair.overlap_ratio,
        "load": torque / pair.base_radii[0] / pair.face_width,
        "true": errors,
        "reported": reported(usual),
        "found": found,
        "seconds": [middle - began, time.process_time() - middle],
    }


def ratios(row: dict[str, Any]) -> dict[str, tuple[float, bool]]:
    """Reported over true errors by figure, and whether the true one is small; that of the centre is in metres."""
    return {
        name: (row["reported"][name] / max(error, 1e-9), name != "load centre" and error < SMALL)
        for name, error in row["true"].items()
    }


def show(rows: list[dict[str, Any]]) -> None:
    """Quantiles of the ratios by figure."""
    whole = [row for row in rows if "true" in row]
    print(f"{len(rows) - len(whole)} of {len(rows)} pairs without a solution")
    print(
        f"{'':25} pairs  median true {'least, 5 %, median, 95 %, largest':^39} within, or small; below, above"
    )
    some = [ratios(row) for row in whole]
    for name in some[0] if some else ():
        values, small = (np.array([one[name][k] for one in some]) for k in (0, 1))
        size = np.median([row["true"][name] for row in whole])
        print(f"{name:25} {len(values):5} {size:12.2g} {quantiles(values, small)}")


def main(file: Path, pairs: int, seed: int, seconds: float) -> None:
    kept = file.parent / f"{file.name}.gears"
    rows = pair_by_pair(
        file,
        pairs,
        seed,
        seconds,
        lambda number, chosen: one(number, chosen, kept),
        lambda row: {name: f"{ratio:.2g}{' small' * small}" for name, (ratio, small) in ratios(row).items()},
    )
    if rows is not None:
        show(rows)


if __name__ == "__main__":
    begin(main, 40, SEED)
