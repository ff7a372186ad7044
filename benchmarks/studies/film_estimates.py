"""Estimated over true errors of films of random gear contacts, by how they are supplied, with heat or without.

    python benchmarks/studies/film_estimates.py [contacts] [seed] [tolerance ...]

True: the largest error of central film, minimum film and film between them (root mean square over the dry contact's
width), which a tolerance asks for, against grids of two and four times as many cells, extrapolated by the order that
they show (between 1 and 2), with heat followed from 2.5 times as far ahead.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from base import Array, RangeWarning
from ehl import (
    Film,
    LineContact,
    Meniscus,
    OilLayer,
    Roughness,
    solve,
    solve_mixed,
    solve_mixed_thermal,
    solve_thermal,
)
from ehl.films.mixed_film import RoughFilm
from tests.hard.random_contacts import random_gear_contact

SUPPLIES = ("flooded", "meniscus", "layer", "rough")
FAR = 1e-3  # tolerance of the true films: heat is followed from as far as it asks for


@dataclass(frozen=True)
class Case:
    """A contact, its supply and roughness, with heat or without."""

    contact: LineContact
    supply: Meniscus | OilLayer | None
    roughness: Roughness | None
    hot: bool

    def film(self, tolerance: float, nodes: int | None = None) -> Film | RoughFilm:
        """Solve it."""
        asked = {"tolerance": tolerance, "nodes": nodes, "supply": self.supply}
        if self.roughness is not None:
            rough = solve_mixed_thermal if self.hot else solve_mixed
            return rough(self.contact, self.roughness, **asked)
        return (solve_thermal if self.hot else solve)(self.contact, **asked)


@dataclass(frozen=True)
class Outcome:
    """What a film estimates, and what it is off by."""

    number: int
    nodes: int
    estimate: float
    true: float

    @property
    def ratio(self) -> float:
        """Estimate over truth."""
        return self.estimate / self.true


def drawn(supply: str, hot: bool, seed: int, number: int) -> Case:
    """Draw the contact of a number: a meniscus .01 to 2 b ahead, a layer of 5 to 90 % of the flooded flow."""
    rng = np.random.default_rng([seed, number])
    contact = random_gear_contact(rng)
    distance, share, ratio = (
        10 ** rng.uniform(-2.0, 0.3),
        10 ** rng.uniform(-1.3, -0.05),
        rng.uniform(0.3, 3.0),
    )
    if supply == "meniscus":
        return Case(contact, Meniscus(-(1.0 + distance) * contact.half_width), None, hot)
    full = solve(contact, tolerance=0.02)
    if supply == "layer":
        return Case(contact, OilLayer(share * full.flow), None, hot)
    rough = Roughness.of_deviation(full.minimum_thickness / ratio) if supply == "rough" else None
    return Case(contact, None, rough, hot)


def extrapolated(coarse: Array, middle: Array, fine: Array) -> Array:
    """Limit of three grids."""
    before, last = middle - coarse, fine - middle
    steady = before * last > 0.0
    falls = np.clip(last / np.where(steady, before, np.inf), 0.25, 0.5)
    return np.asarray(fine + last * falls / (1.0 - falls))


def inside(film: Film | RoughFilm) -> Film:
    """Film that oil carries."""
    return film.film if isinstance(film, RoughFilm) else film


def profile(film: Film, places: Array) -> Array:
    """Central film, minimum film, and film at places."""
    named = [film.central_thickness, film.minimum_thickness]
    return np.concatenate([named, np.interp(places, film.x, film.thickness)])


def outcome(case: Case, number: int, tolerance: float) -> Outcome | None:
    """Solve a case and its finer grids; None where the film has no solution, or a finer grid has none."""
    film = case.film(tolerance)
    if not film.converged:
        return None
    x = inside(film).x
    nodes = x.size
    finer = [case.film(min(FAR, tolerance), nodes=n) for n in (nodes, 2 * nodes - 1, 4 * nodes - 3)]
    if not all(f.converged for f in finer):
        return None
    limit = extrapolated(*(profile(inside(f), x) for f in finer))
    off = profile(inside(film), x) / limit - 1.0
    weights = np.where(np.abs(x) <= case.contact.half_width, np.gradient(x), 0.0)
    between = math.sqrt(float(weights @ off[2:] ** 2 / weights.sum()))
    return Outcome(number, nodes, film.error, max(*np.abs(off[:2]).tolist(), between))


def outcomes(supply: str, hot: bool, seed: int, numbers: range, tolerance: float) -> Iterator[Outcome]:
    """Outcomes of numbered contacts that are solved."""
    for number in numbers:
        held = outcome(drawn(supply, hot, seed, number), number, tolerance)
        if held is not None:
            yield held


def main(contacts: int, seed: int, *tolerances: float) -> None:
    """Print a row for each supply and tolerance."""
    print("films | tolerance | solved, within it | in .5 to 5 | smallest | median | largest | nodes | s")
    for hot in (False, True):
        for supply in SUPPLIES:
            for tolerance in tolerances:
                began = time.process_time()
                rows = list(outcomes(supply, hot, seed, range(contacts), tolerance))
                ratios = np.array([row.ratio for row in rows])
                within = sum(row.estimate <= tolerance for row in rows)
                columns = (
                    f"{'heat, ' if hot else ''}{supply} | {tolerance:g}",
                    f"{len(rows)}, {within} of {contacts}",
                    f"{np.mean((ratios >= 0.5) & (ratios <= 5.0)):.0%}",
                    f"{ratios.min():.2f} | {np.median(ratios):.1f} | {ratios.max():.0f}",
                    f"{np.median([row.nodes for row in rows]):.0f} | {time.process_time() - began:.0f}",
                )
                print(" | ".join(columns), flush=True)
                for row in rows:
                    if row.ratio < 0.5:
                        print(
                            f"    {row.number}, {row.nodes} nodes: estimate {row.estimate:.1e}, true {row.true:.1e}"
                        )


if __name__ == "__main__":
    warnings.simplefilter("ignore", RangeWarning)
    number, seed, *tolerances = [*sys.argv[1:], *("20", "1", "0.01", "0.002")[len(sys.argv) - 1 :]]
    main(int(number), int(seed), *(float(word) for word in tolerances))
