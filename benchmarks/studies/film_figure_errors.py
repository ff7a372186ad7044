"""Reported against true errors of every figure of a lubricated mesh cycle, over random pairs, oils and speeds.

Pairs of `tests/hard/random_pairs.py`, of steel, some with tip relief, at 2 to 100 % of 440 N/mm, pitch lines of 1 to
30 m/s, oils of 0.01 to 0.3 Pa s. Twice: what films alone may err by (the mesh being the same), and all of it. True:
films at three times as many positions to a tenth of the tolerance; then one refinement more of the mesh as well, and so
many loads along the flanks and nodes on the arcs that their errors are none (`figure_errors.py`). Errors below a
thousandth of the tolerance count as that. Run from the root with
``PYTHONPATH=. python benchmarks/studies/film_figure_errors.py [pairs] [seed]``.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections import defaultdict
from dataclasses import replace
from unittest.mock import patch

import numpy as np

import ehl
import fem
from base import InputError, SolverError
from benchmarks.studies import figure_errors
from flankfilm.coupling import LoadedTeeth, resolution_of
from flankfilm.coupling.films import films as path_films
from flankfilm.coupling.films.lubricated import lubricate
from gears import LoadSharingError
from gears.sharing.mesh_arcs import MeshArcs

TOLERANCE = 5e-3

POSITIONS, FINER = 3 * path_films.FILM_POSITIONS, 10.0


def drawn(rng: np.random.Generator):
    """A pair, its torque, speed of the pinion [rad/s] and oil."""
    while True:
        pair, torque, _ = figure_errors.drawn(rng)
        if {one.youngs_modulus for one in pair.materials} == {figure_errors.STEEL.youngs_modulus}:
            break
    speed = np.exp(rng.uniform(np.log(1.0), np.log(30.0))) / pair.base_radii[0]
    viscosity = np.exp(rng.uniform(np.log(0.01), np.log(0.3)))
    oil = ehl.Lubricant(float(viscosity), float(rng.uniform(15e-9, 25e-9)), 910.0)
    return pair, torque, float(speed), oil


def arcs_of(teeth: LoadedTeeth, speed: float, oil: ehl.Lubricant, positions: int, finer: float) -> MeshArcs:
    """Arcs of the cycle with so many films, to a part of their tolerance."""
    asked = resolution_of(TOLERANCE, teeth.model)
    asked = replace(asked, films=asked.films / finer, agreement=asked.agreement / finer)
    if finer > 1.0:
        asked = replace(
            asked, sampling=asked.sampling / finer, transmission_error=asked.transmission_error / finer
        )
    with patch.object(path_films, "FILM_POSITIONS", positions):
        dry = teeth.sampled(asked.sampling, asked.transmission_error)
        found = lubricate(teeth, dry, speed, oil, asked, profiles=False).arcs
    assert isinstance(found, MeshArcs)
    return found


def one(pair, torque: float, speed: float, oil: ehl.Lubricant) -> tuple[str, dict[str, dict[str, float]]]:
    """What was computed, and the ratios of the films' share and of the whole."""
    began = time.process_time()
    asked = resolution_of(TOLERANCE)
    bodies = fem.compliance(pair, asked.compliance, tip_edges=True)
    dry = figure_errors.solved(pair, torque, {}, bodies, asked.compliance)
    if dry is None:
        return "no dry contact", {}
    torque = dry.torque  # or the part of it that the teeth bear
    teeth = LoadedTeeth(pair, torque, compliance=bodies)
    usual = arcs_of(teeth, speed, oil, path_films.FILM_POSITIONS, 1.0)
    middle = time.process_time()
    with figure_errors.long_series():
        films = arcs_of(teeth, speed, oil, POSITIONS, FINER)
        finer = fem.compliance(
            pair, 1e-5, sizes=bodies.sizes, refinements=bodies.refinements + 1, tip_edges=True
        )
        whole = arcs_of(replace(teeth, compliance=finer), speed, oil, POSITIONS, FINER)
    alone = replace(usual, before=None, other=0.0)
    found = {"films": figure_errors.ratios(alone, films), "all": figure_errors.ratios(usual, whole)}
    spent = f"{middle - began:.1f} and {time.process_time() - middle:.1f} s"
    return f"{torque:.3g} N m, {speed:.4g} rad/s, {oil.viscosity:.3g} Pa s; {spent}", found


def main(count: int, seed: int) -> None:
    found: dict[str, dict[str, list[float]]] = {"films": defaultdict(list), "all": defaultdict(list)}
    for number in range(count):
        given = drawn(np.random.default_rng([seed, number]))
        try:
            said, here = one(*given)
        except (InputError, SolverError, LoadSharingError) as fault:
            said, here = f"{type(fault).__name__}, {str(fault)[:150]}", {}
        print(f"{number} z {given[0].pinion.teeth}/{given[0].wheel.teeth}, {said}", flush=True)
        for kind, every in here.items():
            for name, ratio in every.items():
                found[kind][name].append(ratio)
    for kind, every in found.items():
        print(kind)
        figure_errors.show(every, count - len(next(iter(every.values()), [])))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    figure_errors.FLOOR = 1e-3 * TOLERANCE
    given = [int(word) for word in sys.argv[1:]]
    main(*(given + [10, 1][len(given) :]))
