"""Reported over true errors of films over time: random gear contacts against finer grids and shorter steps."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from ehl import LineContact, Lubricant, film_response, solve_transient
from tests.ehl.films import quiet

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::base.RangeWarning")]

MODULUS = 2.2e11


def contacts(seed: int, hardest: float, steepest: float) -> Iterator[tuple[LineContact, np.random.Generator]]:
    rng = np.random.default_rng(seed)
    while True:
        pressure, speed, radius = (
            rng.uniform(0.2, hardest) * 1e9,
            10 ** rng.uniform(-0.3, 1.5),
            10 ** rng.uniform(-2.7, -1.3),
        )
        oil = Lubricant(10 ** rng.uniform(-2.2, -0.4), rng.uniform(12, steepest) * 1e-9, 880.0)
        yield LineContact(2 * math.pi * radius * pressure**2 / MODULUS, speed, radius, MODULUS, oil), rng


@pytest.mark.timeout(600)
def test_errors_of_answers_to_an_oscillation_cover_finer_grids():
    covered = []
    for _, (contact, _) in zip(range(80), contacts(5, 2.0, 24), strict=False):
        at = contact.entrainment / contact.half_width * np.array([0.0, 0.3, 1.0, 2.0, 3.0])
        found, finer = (film_response(quiet(contact, **how), at) for how in ({}, {"nodes": 1025}))
        covered.append(
            np.abs(found.compliance - finer.compliance) <= np.abs(found.compliance) * found.relative_error
        )
    assert np.mean(covered) > 0.98  # 400 of 400 were


@pytest.mark.timeout(600)
def test_errors_of_ramps_cover_finer_grids_and_steps():
    over = []
    for _, (contact, rng) in zip(range(5), contacts(7, 1.6, 22), strict=False):
        unit, times = contact.half_width / contact.entrainment, rng.uniform(0.5, 4)
        first, last = (1.0, 0.5) if rng.random() < 0.5 else (0.5, 1.0)

        def load(t, contact=contact, times=times, unit=unit, first=first, last=last):
            way = 0.5 - 0.5 * math.cos(math.pi * min(t / (times * unit), 1.0))
            return contact.load * (first + (last - first) * way)

        at = np.linspace(0.0, times + 4.0, 12) * unit
        found = solve_transient(contact, load, at, tolerance=0.02)
        finer = solve_transient(contact, load, at, nodes=2 * found.x.shape[1] - 1, step=unit / 50)
        off = max(np.abs(getattr(found, n) / getattr(finer, n) - 1).max() for n in ("least", "central"))
        over.append(off / found.error)
    assert np.max(over) < 1.2  # of 13 the most was .91, the median .54
