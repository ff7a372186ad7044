"""Which models a scene gets, and how its tolerance is split: the cheapest of all combinations that meet it.

The error of the mean stiffness is at most the sum of what the models' simplifications change and of what meshes,
positions, films and a cut series leave. Each pair of a stiffness and a film model leaves another part of the
tolerance to the stages it has, which split it for the least cost (`flankfilm.coupling.tolerance`); the
cheapest pair is taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from base import SolverError
from flankfilm.coupling.resolution import COARSEST_FILMS, Resolution, film_tolerance
from flankfilm.coupling.tolerance import CostLaw, Shares, split
from flankfilm.stages import film_choice, stiffness_choice
from flankfilm.stages.decisions import Candidate, Decision, per_cent, signed

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from flankfilm.scene import Scene
    from gears import GearPair

SERIES = CostLaw("Fourier series", coarsest=0.05, seconds=0.1, power=2 / 3)
"""Root mean square that a series of order n leaves, about n^-3/2, against the time of a sweep, about n."""

MOTION = {"fourier", "sweep", "diagram"}


@dataclass(frozen=True)
class Plan:
    """Models of a run and the shares of its tolerance.

    Attributes
    ----------
    tolerance : float
        Of the scene.
    stiffness, film : Decision
    shares : Shares
        Of the stages' numerical errors in the mean stiffness, by name.
    film_change : float
        What the film is assumed to change of it, relative; 0 without films that are solved.
    film_tolerance : float
        Relative, of the film thickness.
    """

    tolerance: float
    stiffness: Decision
    film: Decision
    shares: Shares
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


def decide(scene: Scene, pair: GearPair, foreseen: Callable[[], film_choice.FilmChange | None]) -> Plan:
    """Choose the models and split the tolerance.

    Parameters
    ----------
    scene : Scene
    pair : gears.GearPair
    foreseen : callable
        What the cheapest models foresee of the film's change; called where it decides.
    """
    teeth, why = stiffness_choice.options(scene, pair)
    oil = film_choice.foresee(scene, foreseen)
    further = (SERIES,) if _series_to_find(scene) else ()
    weighed = [
        w
        for both in product(teeth, oil.options)
        if (w := _weigh(scene.tolerance, *both, further)) is not None
    ]
    if not weighed:
        raise SolverError(f"no resolution meets a tolerance of {scene.tolerance:g}; raise it")
    best = min(weighed, key=lambda w: w.seconds)
    return Plan(
        scene.tolerance,
        _stiffness_decision(scene, best, weighed, teeth, why),
        _film_decision(scene, best, weighed, oil),
        best.shares,
        best.film.change if best.film.law is not None else 0.0,
        _film_tolerance(scene, best),
    )


@dataclass(frozen=True)
class _Weighed:
    """A pair of models with the shares that they leave to their stages."""

    teeth: stiffness_choice.Option
    film: film_choice.Option
    shares: Shares
    seconds: float


def _series_to_find(scene: Scene) -> bool:
    asked = scene.dynamics is not None and scene.dynamics.fourier_order == "auto"
    return asked and bool(MOTION & set(scene.wants))


def _weigh(
    tolerance: float, teeth: stiffness_choice.Option, film: film_choice.Option, further: Sequence[CostLaw]
) -> _Weighed | None:
    """Shares of a pair of models; None where their simplifications leave nothing."""
    left = tolerance - (teeth.effect or 0.0) - (film.effect or 0.0)
    laws = (*teeth.laws, *((film.law,) if film.law else ()), *further)
    shares = split(left, laws) if left > 0 else None
    return None if shares is None else _Weighed(teeth, film, shares, shares.seconds + film.seconds)


def _film_tolerance(scene: Scene, best: _Weighed) -> float:
    if best.film.law is None:
        return COARSEST_FILMS
    wanted = scene.tolerance if "film" in scene.wants else COARSEST_FILMS
    return film_tolerance(best.shares, best.film.change, wanted)


def _stiffness_decision(
    scene: Scene,
    best: _Weighed,
    weighed: Sequence[_Weighed],
    teeth: Sequence[stiffness_choice.Option],
    why: str,
) -> Decision:
    name, effect = best.teeth.name, best.teeth.effect
    candidates = tuple(_candidate(option, [w for w in weighed if w.teeth is option]) for option in teeth)
    known = [o for o in teeth if o.effect is not None and o.name != "fem"]
    if not why and name != "fem":
        others = ", finite elements cost more" if name != "fem" else ""
        why = (
            f"{best.teeth.text}, at most {per_cent(effect or 0.0)} off over ordinary pairs, within the tolerance of "
            f"{per_cent(scene.tolerance)}{others}"
        )
    elif not why:
        nearest = min(known, key=lambda option: option.effect or 0.0)
        why = (
            f"finite elements; the nearest {nearest.text} is up to {per_cent(nearest.effect or 0.0)} off over ordinary "
            f"pairs, above what the tolerance of {per_cent(scene.tolerance)} leaves"
        )
    share = scene.tolerance if known else None
    asked = scene.stiffness.model != "auto"
    return Decision("stiffness", name, asked, why, effect, share, best.seconds, candidates)


def _film_decision(
    scene: Scene, best: _Weighed, weighed: Sequence[_Weighed], oil: film_choice.Foreseen
) -> Decision:
    name, asked = best.film.name, scene.film.model != "auto"
    candidates = tuple(_candidate(option, [w for w in weighed if w.film is option]) for option in oil.options)
    if oil.why or oil.change is None:
        return Decision("film", name, asked, oil.why, best.film.effect, None, best.seconds, candidates)
    change = f"{signed(oil.change.mean)} foreseen"
    limit = f"the tolerance of {per_cent(scene.tolerance)}"
    if name == "none":
        why = f"{change} (at most {per_cent(best.film.effect or 0.0)}), below {limit}, left out"
        why += f"; the transmission error, peak to peak, would change by about {signed(oil.change.transmission_error)}"
    elif name == "dowson":
        why = f"{change}, by Dowson's formula, which is at most {per_cent(best.film.effect or 0.0)} off, below {limit}"
    else:
        out = oil.options[0]
        above = "" if any(w.film is out for w in weighed) else f"above what {limit} leaves, "
        why = f"{change} (up to {per_cent(out.effect or 0.0)}), {above}solved"
    share = scene.tolerance - (best.teeth.effect or 0.0)
    return Decision("film", name, asked, why, best.film.effect, share, best.seconds, candidates)


def _candidate(option: stiffness_choice.Option | film_choice.Option, found: Sequence[_Weighed]) -> Candidate:
    """Describe an option, with the cost of the cheapest pair of models that it is part of."""
    return Candidate(option.name, option.effect, min((w.seconds for w in found), default=None))
