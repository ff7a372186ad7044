"""Which film a scene may have: what leaving it out or taking it by a formula changes, and what each costs.

What a film changes of the stiffness is seen by running the scene itself with its cheapest models: teeth by the
potential-energy method, films by Dowson's formula, at the coarsest. That takes a twentieth of the films' own time.
How far it may be off was measured over many oils, speeds and torques (by
``python tests/validation/studies/film_scatter.py``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from base import InputError, SolverError
from flankfilm.cache import Cache
from flankfilm.stages.teeth import plain_flanks
from flankfilm.tolerance import CostLaw

if TYPE_CHECKING:
    from flankfilm.scene import Scene
    from flankfilm.stages.engine import Engine

MOST_OF_FORESEEN = 2.5
"""Largest change of the mean stiffness by films solved, secant or tangent, over that foreseen; of 40 scenes."""

FORMULA_OFF = 1.3
"""Largest difference of the changes by films solved and by formula, over that foreseen; of the same scenes."""

RELATIVE = CostLaw("film", coarsest=6e-3, seconds=1.0, power=0.7)
"""Of the films of a mesh cycle, their relative error, solved twice."""

LEAST_CHANGE = 1e-6
"""Change of the stiffness below which no film is resolved for the stiffness' sake."""

ASSUMED = 0.2
"""Change that is assumed where it need not or cannot be foreseen; films of light loads at high speed reach it."""

COARSEST = 0.1
"""Tolerance of the foreseeing run, and the largest that films are solved to."""

FINE = 3e-3
"""Tolerance from which on all stages are at their coarsest, whatever the film changes."""


@dataclass(frozen=True)
class FilmChange:
    """What the cheapest models say that a film changes, relative.

    Attributes
    ----------
    mean : float
        Of the mean secant stiffness; negative.
    transmission_error : float
        Of the transmission error, peak to peak: no sum of errors, but the figure that a film left out changes most.
    """

    mean: float
    transmission_error: float


@dataclass(frozen=True)
class Option:
    """A film model.

    Attributes
    ----------
    name : str
    effect : float or None
        Relative error of the mean stiffness by its simplification, at most; None where the scene asks for it.
    seconds : float
        Cost that no tolerance changes [s].
    law : CostLaw or None
        Of the films' error in the mean stiffness, where they are solved.
    change : float
        Relative change of the mean stiffness by the film that the law assumes.
    """

    name: str
    effect: float | None
    seconds: float
    law: CostLaw | None = None
    change: float = ASSUMED


@dataclass(frozen=True)
class Foreseen:
    """Options of a scene's film, why there are no more, and the change of the mean stiffness that was foreseen."""

    options: tuple[Option, ...]
    why: str
    change: FilmChange | None


def foresee(engine: Engine) -> Foreseen:
    """Film models that a scene may have."""
    scene, asked = engine.scene, engine.scene.film.model
    tolerance = scene.tolerance
    # a scene without [film] has "none", and may still want the film; one that says "none" may not
    if "film" in scene.wants and asked in ("auto", "none"):
        return _only(_solved(ASSUMED, tolerance), "solved; the film itself is wanted")
    if asked == "none":
        return _only(_LEFT_OUT, 'left out; the scene asks for film.model = "none"')
    if asked == "dowson":
        return _only(_BY_FORMULA, 'by formula; the scene asks for film.model = "dowson"')
    unknown = _unknown_to_formulas(scene)
    if asked == "ehl":
        told = 'solved; the scene asks for film.model = "ehl"'
        if "film" in scene.wants or unknown or tolerance >= FINE:
            return _only(_solved(ASSUMED, tolerance if "film" in scene.wants else 1.0), told)
        known: FilmChange | None = engine["film foreseen"]
        if known is None:
            return _only(_solved(ASSUMED), told)
        return Foreseen((_solved(MOST_OF_FORESEEN * abs(known.mean)),), told, known)
    if scene.lubricant is None or scene.operating is None or scene.operating.pinion_speed_rpm is None:
        return _only(_LEFT_OUT, "left out; the scene has no lubricant or no speed")
    if unknown:
        told = f"solved; the formula that would foresee its part does not know {unknown}"
        return _only(_solved(ASSUMED), told)
    change: FilmChange | None = engine["film foreseen"]
    if change is None:
        return _only(
            _solved(ASSUMED), "solved; the cheapest models, which would foresee its part, have no answer"
        )
    left_out = replace(_LEFT_OUT, effect=MOST_OF_FORESEEN * abs(change.mean))
    formula = replace(_BY_FORMULA, effect=FORMULA_OFF * abs(change.mean))
    solved = _solved(MOST_OF_FORESEEN * abs(change.mean))
    # a definition of film stiffness that the formula has not leaves the solver alone
    return Foreseen((left_out, *((formula,) if scene.film.stiffness is None else ()), solved), "", change)


_LEFT_OUT = Option("none", None, 0.0)
_BY_FORMULA = Option("dowson", None, 0.07)


def _only(option: Option, why: str) -> Foreseen:
    return Foreseen((option,), why, None)


def _solved(change: float, tolerance: float = 1.0) -> Option:
    """Films solved: their relative error, at most `tolerance`, counts by what they change of the stiffness."""
    change, coarsest = max(change, LEAST_CHANGE), min(RELATIVE.coarsest, tolerance)
    law = CostLaw(RELATIVE.name, change * coarsest, RELATIVE.cost(coarsest), RELATIVE.power)
    return Option("ehl", 0.0, 0.0, law, change)


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


def foreseen_change(engine: Engine) -> FilmChange | None:
    """What the film changes by the cheapest models; None where these have no answer.

    The flanks are taken as plain: relief decides who carries, and hardly what a film changes of the mean.
    """
    scene = plain_flanks(engine.scene)
    teeth = scene.stiffness.model_copy(update={"model": "potential-energy"})
    film = scene.film.model_copy(update={"model": "dowson", "stiffness": None})
    cheap = scene.model_copy(
        update={"wants": ("stiffness",), "tolerance": COARSEST, "stiffness": teeth, "film": film}
    )
    rough = type(engine)(cheap, engine.stages, Cache(None))
    try:
        film, dry = rough["film"], rough["dry cycle"]
    except (InputError, SolverError):
        return None
    uneven = float(np.ptp(film.cycle.transmission_error) / np.ptp(dry.transmission_error) - 1)
    return FilmChange(float(film.change_secant), uneven)
