"""Which models a scene gets, and how its tolerance is split: the cheapest of all combinations that meet it.

The error of the mean stiffness is at most the sum of what the models' simplifications change and of what meshes,
positions, films and a cut series leave. Each pair of a stiffness and a film model leaves another part of the
tolerance to the stages it has, which split it for the lowest cost (`flankfilm.coupling.mesh.tolerance`); the
cheapest pair is taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import gears
from base import SolverError
from flankfilm.coupling.mesh.resolution import COARSEST_FILMS, Resolution, film_tolerance
from flankfilm.coupling.mesh.tolerance import CostLaw, split
from flankfilm.plan.decisions import Candidate, Decision, per_cent, signed, stands
from flankfilm.plan.film_choice import films
from flankfilm.plan.options import FilmChange, Option, Options
from flankfilm.plan.stiffness_choice import teeth
from flankfilm.scene.wants import WANTS

if TYPE_CHECKING:
    from flankfilm.scene import Scene

SERIES = CostLaw("Fourier series", coarsest=0.05, seconds=0.1, power=2 / 3)
"""Root mean square that a series of order n leaves, about n^-3/2, against the time of a sweep, about n."""


@dataclass(frozen=True)
class Plan:
    """Models of a run and the shares of its tolerance.

    Attributes
    ----------
    tolerance : float
        Of the scene.
    stiffness, film : Decision
    shares, costs : mapping
        Of the stages' numerical errors in the mean stiffness, and the seconds that these are foreseen to cost, by name.
    film_change : float
        What the film is assumed to change of it, relative; 0 without films that are solved.
    film_tolerance : float
        Relative, of the film thickness.
    """

    tolerance: float
    stiffness: Decision
    film: Decision
    shares: Mapping[str, float]
    costs: Mapping[str, float]
    film_change: float
    film_tolerance: float

    @property
    def resolution(self) -> Resolution:
        """What meshes, positions and films may err by."""
        return Resolution.from_shares(self.tolerance, self.shares, self.film_tolerance)

    @property
    def series(self) -> float | None:
        """What a Fourier series may leave out; None unless its order is to be found."""
        return self.shares.get(SERIES.name)

    @property
    def decisions(self) -> tuple[Decision, ...]:
        """All decisions."""
        return self.stiffness, self.film

    @property
    def line(self) -> str:
        """The split in one line."""
        simple = [
            (f"{d.subject} by a simpler model", d.effect)
            for d in self.decisions
            if d.effect is not None and d.effect > 0
        ]
        parts = [f"{per_cent(e)} {name}" for name, e in (*simple, *self.shares.items())]
        return f"tolerance of {per_cent(self.tolerance)}, split by cost: {', '.join(parts)}"


@dataclass(frozen=True)
class _Both:
    """A model of the teeth and one of the film, with the shares that they leave to their stages."""

    teeth: Option
    film: Option
    shares: Mapping[str, float]

    @property
    def costs(self) -> dict[str, float]:
        """Seconds that each stage is foreseen to cost."""
        laws = (*self.teeth.laws, *self.film.laws, SERIES)
        return {law.name: law.cost(self.shares[law.name]) for law in laws if law.name in self.shares}

    @property
    def seconds(self) -> float:
        """Cost of all that is foreseen [s]."""
        return math.fsum(self.costs.values()) + self.film.seconds


def decide(scene: Scene, pair: gears.GearPair, foreseen: Callable[[], FilmChange | None]) -> Plan:
    """Choose the models and split the tolerance.

    Parameters
    ----------
    scene : Scene
    pair : gears.GearPair
    foreseen : callable
        What the cheapest models foresee of the film's change; called where it decides.
    """
    bodies, oil, tolerance = teeth(scene, pair), films(scene, foreseen), scene.tolerance
    further = (SERIES,) if _series_to_find(scene) else ()
    weighed = []
    for tooth, film in product(bodies.models, oil.models):
        remaining = tolerance - (tooth.effect or 0.0) - (film.effect or 0.0)
        shares = split(remaining, (*tooth.laws, *film.laws, *further)) if remaining > 0 else None
        if shares is not None:
            weighed.append(_Both(tooth, film, shares))
    if not weighed:
        raise SolverError(f"no resolution meets a tolerance of {tolerance:g}; raise it")
    best = min(weighed, key=lambda choice: choice.seconds)
    why_teeth = _why_teeth(tolerance, best.teeth, bodies)
    why_film = _why_film(tolerance, best.film, oil, weighed)
    remaining = tolerance - (best.teeth.effect or 0.0)
    wanted = tolerance if "film" in scene.wants else COARSEST_FILMS
    asks = {
        name: getattr(scene, name).model != "auto" and stands(scene, name, "model")
        for name in ("stiffness", "film")
    }
    return Plan(
        tolerance,
        _decision("stiffness", asks["stiffness"], best.teeth, bodies, weighed, tolerance, why_teeth),
        _decision("film", asks["film"], best.film, oil, weighed, remaining, why_film),
        best.shares,
        best.costs,
        best.film.change,
        film_tolerance(best.shares, best.film.change, wanted) if best.film.laws else COARSEST_FILMS,
    )


def _series_to_find(scene: Scene) -> bool:
    asked = scene.dynamics is None or scene.dynamics.fourier_order == "auto"
    return asked and any(WANTS[want].series for want in scene.wants)


def _decision(
    subject: str, asked: bool, taken: Option, among: Options, weighed: Sequence[_Both], share: float, why: str
) -> Decision:
    """Decision for a model, each with the cost of the cheapest pair of models that it is part of."""
    costs = {
        option.name: [choice.seconds for choice in weighed if option in (choice.teeth, choice.film)]
        for option in among.models
    }
    return Decision(
        subject,
        taken.name,
        asked,
        among.why or why,
        taken.effect,
        None if among.why else share,
        min(choice.seconds for choice in weighed),
        tuple(Candidate(o.name, o.effect, min(costs[o.name], default=None)) for o in among.models),
    )


def _why_teeth(tolerance: float, taken: Option, among: Options) -> str:
    """Why a model of the teeth was taken of several."""
    if taken.name != "fem":
        return (
            f"{taken.text}, at most {per_cent(taken.effect or 0.0)} off over ordinary pairs, within the tolerance of "
            f"{per_cent(tolerance)}, finite elements cost more"
        )
    nearest = min(among.models[:-1], key=lambda option: option.effect or 0.0, default=taken)
    return (
        f"finite elements; the nearest {nearest.text} is up to {per_cent(nearest.effect or 0.0)} off over ordinary "
        f"pairs, above what the tolerance of {per_cent(tolerance)} leaves"
    )


def _why_film(tolerance: float, taken: Option, among: Options, weighed: Sequence[_Both]) -> str:
    """Why a model of the film was taken of several."""
    if (foreseen := among.foreseen) is None:
        return among.why
    change, limit = f"{signed(foreseen.mean)} foreseen", f"the tolerance of {per_cent(tolerance)}"
    most = per_cent(taken.effect or 0.0)
    if taken.name == "none":
        uneven = f"the transmission error, peak to peak, would change by about {signed(foreseen.transmission_error)}"
        return f"{change} (at most {most}), below {limit}, left out; {uneven}"
    if taken.name == "dowson":
        return f"{change}, by Dowson's formula, which is at most {most} off, below {limit}"
    out = among.models[0]
    above = "" if any(choice.film == out for choice in weighed) else f"above what {limit} leaves, "
    return f"{change} (up to {per_cent(out.effect or 0.0)}), {above}solved"
