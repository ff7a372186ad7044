"""Models that a scene may have, as `decide` weighs them."""

from __future__ import annotations

from dataclasses import dataclass

from flankfilm.coupling.mesh.tolerance import CostLaw


@dataclass(frozen=True)
class Option:
    """A model of the teeth or of the film.

    Attributes
    ----------
    name : str
        As the scene names it.
    effect : float or None
        Relative error of the mean stiffness by its simplification, at most; None where it is unknown, or the scene
        asks for the model: then it is not counted.
    laws : tuple of CostLaw
        Of what it has to resolve, by the error that is left in the mean stiffness.
    seconds : float
        Cost that no tolerance changes [s].
    text : str
        How a sentence calls it.
    change : float
        Relative change of the mean stiffness that the law of solved films assumes; 0 for all else.
    """

    name: str
    effect: float | None
    laws: tuple[CostLaw, ...] = ()
    seconds: float = 0.0
    text: str = ""
    change: float = 0.0


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
class Options:
    """Models to choose from, why there are no more (empty where their cost decides), what a film was foreseen to do."""

    models: tuple[Option, ...]
    why: str = ""
    foreseen: FilmChange | None = None
