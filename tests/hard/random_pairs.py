"""Random pairs of gears over everything that gears accepts: teeth, shifts, racks, fillets, bores, rims."""

from __future__ import annotations

import warnings

import numpy as np

from base import InputError
from gears import BasicRack, Gear, GearPair

LARGEST_FILLET = {14.5: 0.4, 20.0: 0.38, 25.0: 0.3}


def random_pair(rng: np.random.Generator) -> GearPair | None:
    """One draw; None where no such pair exists."""
    module = 2e-3
    teeth = np.exp(rng.uniform(np.log(8), np.log(200), 2)).astype(int)
    angle = float(rng.choice([14.5, 20.0, 20.0, 20.0, 25.0]))
    high = angle < 25 and rng.random() < 0.25
    h_aP = rng.uniform(1.15, 1.35) if high else rng.uniform(0.8, 1.0)
    fillet = rng.uniform(0.1, 0.25) if high else rng.uniform(0.05, LARGEST_FILLET[angle])
    shifts = rng.uniform(-0.8, 1.5, 2) if rng.random() < 0.4 else rng.uniform(-0.3, 0.7, 2)
    roots = module * (0.5 * teeth - h_aP - 0.25 + shifts)
    rims = np.where(rng.random(2) < 0.25, rng.uniform(0.2, 1.0, 2) * module, roots * rng.uniform(0.1, 0.8, 2))
    tips = rng.choice([0.0, -0.1], 2)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            gears = [
                Gear(int(z), profile_shift=float(x), bore_radius=float(r - rim), tip_alteration=float(k))
                for z, x, r, rim, k in zip(teeth, shifts, roots, rims, tips, strict=True)
            ]
            rack = BasicRack(float(h_aP), float(h_aP) + 0.25, float(fillet), float(np.radians(angle)))
            return GearPair(*gears, module, 0.04, rack)
    except InputError:
        return None


def random_pairs(seed: int, count: int) -> list[GearPair]:
    """``count`` pairs that exist."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        pair = random_pair(rng)
        if pair is not None:
            found.append(pair)
    return found
