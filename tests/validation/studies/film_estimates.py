"""Estimated over true errors of films of random gear contacts, by how they are supplied, with heat or without.

    python tests/validation/studies/film_estimates.py [contacts] [seed] [tolerance ...]

True: the larger error of central and minimum film against grids of two and four times as many cells, extrapolated by
the order that they show (between 1 and 2), with heat followed from 2.5 times as far ahead.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from base import RangeWarning
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


def extrapolated(coarse: float, middle: float, fine: float) -> float:
    """Limit of three grids."""
    before, last = middle - coarse, fine - middle
    falls = min(max(last / before, 0.25), 0.5) if before * last > 0.0 else 0.25
    return fine + last * falls / (1.0 - falls)


def outcome(case: Case, number: int, tolerance: float) -> Outcome | None:
    """Solve a case and its finer grids; None where the film has no solution, or a finer grid has none."""
    film = case.film(tolerance)
    if not film.converged:
        return None
    nodes = (film.film if isinstance(film, RoughFilm) else film).x.size
    finer = [case.film(min(FAR, tolerance), nodes=n) for n in (nodes, 2 * nodes - 1, 4 * nodes - 3)]
    if not all(f.converged for f in finer):
        return None
    true = 0.0
    for name in ("central_thickness", "minimum_thickness"):
        limit = extrapolated(*(float(getattr(f, name)) for f in finer))
        true = max(true, abs(float(getattr(film, name)) / limit - 1.0))
    return Outcome(number, nodes, film.error, true)


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
