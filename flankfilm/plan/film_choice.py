"""Which film a scene may have: what leaving it out or taking it by a formula changes, and what each costs.

What a film changes of the stiffness is seen by computing the cycle with the cheapest models: teeth by the
potential-energy method, films by Dowson's formula, at the coarsest. That takes a twentieth of the films' own time.
How far it may be off was measured over many oils, speeds and torques (by
``python benchmarks/studies/film_scatter.py``).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

from base import InputError, RangeWarning, SolverError
from flankfilm import coupling
from flankfilm.building.film import lubricant
from flankfilm.building.pair import gear_pair, pinion_speed, pinion_torque
from flankfilm.coupling.mesh.resolution import ASSUMED_CHANGE, COARSEST_FILMS, LEAST_CHANGE, film_law_of_cost
from flankfilm.plan.decisions import said
from flankfilm.plan.options import FilmChange, Option, Options
from flankfilm.scene import Scene
from flankfilm.scene.plain_gears import plain_flanks

MOST_OF_FORESEEN = 2.5
"""Largest change of the mean stiffness by films solved, secant or tangent, over that foreseen; of 40 scenes."""

FORMULA_OFF = 1.3
"""Largest difference of the changes by films solved and by formula, over that foreseen; of the same scenes."""

FINE = 3e-3
"""Tolerance from which on all stages are at their coarsest, whatever the film changes."""


_LEFT_OUT = Option("none", None)
_BY_FORMULA = Option("dowson", None, seconds=0.07)


def films(scene: Scene, foreseen: Callable[[], FilmChange | None]) -> Options:
    """Film models that a scene may have; what the cheapest models foresee is asked for where it decides."""
    asked, tolerance, wanted = scene.film.model, scene.tolerance, "film" in scene.wants
    # a scene without [film] has "none", and may still want the film; one that says "none" may not
    if wanted and asked in ("auto", "none"):
        return Options((_solved(tolerance=tolerance),), "solved; the film itself is wanted")
    if asked == "none":
        return Options((_LEFT_OUT,), f"left out; {said(scene, 'film', 'model')}")
    if asked == "dowson":
        return Options((_BY_FORMULA,), f"by formula; {said(scene, 'film', 'model')}")
    unknown = _unknown_to_formulas(scene)
    if asked == "ehl":
        reason = f"solved; {said(scene, 'film', 'model')}"
        if wanted or unknown or tolerance >= FINE or (known := foreseen()) is None:
            return Options((_solved(tolerance=tolerance if wanted else 1.0),), reason)
        return Options((_solved(MOST_OF_FORESEEN * abs(known.mean)),), reason, known)
    if scene.lubricant is None or scene.rpm is None:
        return Options((_LEFT_OUT,), "left out; the scene has no lubricant or no speed")
    if unknown:
        return Options(
            (_solved(),), f"solved; the formula that would foresee its part does not know {unknown}"
        )
    if (change := foreseen()) is None:
        return Options(
            (_solved(),), "solved; the cheapest models, which would foresee its part, have no answer"
        )
    most, off = MOST_OF_FORESEEN * abs(change.mean), FORMULA_OFF * abs(change.mean)
    # a definition of film stiffness that the formula has not leaves the solver alone
    formula = (replace(_BY_FORMULA, effect=off),) if scene.film.stiffness is None else ()
    return Options((replace(_LEFT_OUT, effect=most), *formula, _solved(most)), foreseen=change)


def _solved(change: float = ASSUMED_CHANGE, tolerance: float = 1.0) -> Option:
    """Films solved: their relative error, at most `tolerance`, counts by their change of the stiffness."""
    change = max(change, LEAST_CHANGE)
    return Option("ehl", 0.0, (film_law_of_cost(change, tolerance),), change=change)


def _unknown_to_formulas(scene: Scene) -> str:
    if scene.film.starved:
        return f'film.supply = "{scene.film.supply}"'
    if scene.roughness is not None:
        return "[roughness]"
    if scene.film.grid != "graded":
        return f'film.grid = "{scene.film.grid}"'
    if scene.lubricant is not None and scene.lubricant.constant_viscosity:
        return "a constant viscosity"
    if scene.film.stiffness in ("tangent", "nodal-sum"):
        return f'film.stiffness = "{scene.film.stiffness}"'
    return ""


def foreseen_change(scene: Scene) -> FilmChange | None:
    """What the film changes by the cheapest models; None where these have no answer.

    The flanks are taken as plain: relief decides who carries, and hardly what a film changes of the mean.
    """
    try:
        with warnings.catch_warnings():
            # of films that no output shows: those that are taken warn by themselves
            warnings.simplefilter("ignore", RangeWarning)
            cycle = coupling.lubricated_cycle(
                gear_pair(plain_flanks(scene)),
                pinion_torque(scene),
                pinion_speed(scene),
                lubricant(scene),
                tolerance=COARSEST_FILMS,
                model="potential-energy",
                pairs=scene.stiffness.pairs,
                film=coupling.FilmModel("dowson"),
            )
    except (InputError, SolverError):
        return None
    uneven = cycle.transmission_error_range / cycle.dry.transmission_error_range - 1
    return FilmChange(cycle.secant_stiffness_change, uneven)
