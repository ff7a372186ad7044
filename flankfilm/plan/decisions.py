"""What a run decided by itself, in one form: choice, what it changes, what was allowed, what it costs, and why."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

from flankfilm.coupling.vibration.series import MOST_HARMONICS

if TYPE_CHECKING:
    from flankfilm.coupling.films.lubricated_record import LubricatedCycle
    from flankfilm.coupling.speeds.jumps import SpeedDiagram
    from flankfilm.coupling.vibration.series import LeftOut, MeshSeries
    from flankfilm.scene import Scene


@dataclass(frozen=True)
class Candidate:
    """A model that might do.

    Attributes
    ----------
    name : str
        As the scene names it.
    effect : float or None
        Relative error of the stiffness by its simplification, at most; None where it is unknown.
    seconds : float or None
        Cost that is foreseen, of it and of all stages in the shares that it leaves them [s]; None where it leaves
        them nothing.
    """

    name: str
    effect: float | None
    seconds: float | None


@dataclass(frozen=True)
class Decision:
    """One choice of a run.

    Attributes
    ----------
    subject : str
        ``"stiffness"``, ``"film"``, ``"heat in the film"`` or ``"Fourier order"``.
    choice : str
        As the scene would name it.
    asked : bool
        Whether the scene named it itself.
    effect : float or None
        Relative change of the figure by the choice; None where it is unknown.
    share : float or None
        What it may be at most; None where nothing had to be decided.
    seconds : float or None
        Cost that is foreseen [s].
    reason : str
        Why, with its numbers.
    candidates : tuple of Candidate
        All that were weighed.
    """

    subject: str
    choice: str
    asked: bool
    reason: str
    effect: float | None = None
    share: float | None = None
    seconds: float | None = None
    candidates: tuple[Candidate, ...] = ()

    @property
    def line(self) -> str:
        """The decision in one line."""
        return f"{self.subject}: {self.reason}"

    def plain(self) -> dict[str, Any]:
        """Plain values, for files."""
        return asdict(self)


def per_cent(value: float) -> str:
    """Write a relative value in per cent with two digits."""
    return f"{float(f'{100 * value:.2g}'):g} %"


def signed(value: float) -> str:
    """Write a relative change in per cent with its sign."""
    return f"{'-' if value < 0 else '+'}{per_cent(abs(value))}"


def said(scene: Scene, section: str, key: str) -> str:
    """Where a value comes from: the scene says it, or it is the default of a key that was left out."""
    keys = getattr(scene, section)
    value = f'{section}.{key} = "{getattr(keys, key)}"'
    return f"the scene asks for {value}" if stands(scene, section, key) else f"{value} is the default"


def stands(scene: Scene, section: str, key: str) -> bool:
    """Whether a key stands in the scene itself, not filled in by its default."""
    return section in scene.model_fields_set and key in getattr(scene, section).model_fields_set


def decisions(values: Mapping[str, Any]) -> tuple[Decision, ...]:
    """Decisions among the results of stages, in the order in which they were made."""
    plan, series = values.get("plan"), values.get("fourier")
    train = values.get("drive") is not None
    order = None if series is None else order_decision(series, values.get("diagram"), train)
    later = (values.get("heat in the film"), order)
    models = () if plan is None else (plan.stiffness, _with_change(plan.film, values.get("film")))
    return (*models, *(decision for decision in later if decision is not None))


def _with_change(decision: Decision, film: LubricatedCycle | None) -> Decision:
    """Decision on the film with what the film was found to change of the stiffness."""
    if film is None:
        return decision
    change = film.secant_stiffness_change
    reason = f"{decision.reason}; it changes the mean secant stiffness by {signed(change)}"
    effect = abs(change) if decision.effect is None or decision.asked else decision.effect
    return replace(decision, reason=reason, effect=effect)


def order_decision(
    series: MeshSeries, diagram: SpeedDiagram | None = None, train: bool = False
) -> Decision | None:
    """Order of a Fourier series, what it leaves out, and what its jump speeds err by; None for a given series.

    An order that was to be found counts the motion of the pair on rigid shafts, also for a drive `train`: that is said.
    """
    if (left_out := series.left_out) is None:
        return None
    order, share = series.order, series.share
    effect, jumps = float(left_out.largest[order]), "" if diagram is None else _jumps(series, diagram)
    if share is None:
        why = f"{order}; the scene asks for dynamics.fourier_order = {order}; "
        why += f"leaves out {_left_out(left_out, order)}{jumps}"
        return Decision("Fourier order", str(order), True, why, effect)
    most = min(MOST_HARMONICS, left_out.curve.size - 1)
    why = f"{order}, leaves out {_left_out(left_out, order)}"
    if effect > share:
        why += f": above its share of {per_cent(share)}, which no series of up to {most} harmonics meets"
    else:
        why += f", below its share of {per_cent(share)}"
        if order > 1 and not series.tried:
            why += f"; order {order - 1} would leave {_left_out(left_out, order - 1)}"
    if train:
        why += "; that is of the pair on rigid shafts: the drive train's own jumps did not choose it"
    tried = tuple(
        Candidate(str(n), float(left_out.largest[n]), None)
        for n in range(max(1, order - 1), min(order + 1, most) + 1)
    )
    return Decision("Fourier order", str(order), False, why + jumps, effect, share, None, tried)


def _jumps(series: MeshSeries, diagram: SpeedDiagram) -> str:
    """What jump speeds err by with the series, and with the lower orders that they ruled out."""
    ruled_out = "".join(f", with order {order} by {_up_to(worst)}" for order, worst in series.tried)
    worst_of_all = max((jump.error for jump in diagram.jumps), default=0.0)
    text = f"; jump speeds err by {_up_to(worst_of_all)}" if diagram.jumps else "; no jumps"
    if (missed := diagram.missed) and diagram.longer_order is not None:
        widest = max(jump.width for jump in missed)
        text += (
            f", {len(missed)} more with {diagram.longer_order} harmonics, over {_up_to(widest)} of the speed"
        )
    return text + ruled_out


def _up_to(error: float) -> str:
    return f"up to {per_cent(error)}" if math.isfinite(error) else "an unknown amount"


def _left_out(left_out: LeftOut, order: int) -> str:
    text = f"{per_cent(left_out.curve[order])} of the curve"
    return (
        text
        if left_out.motion is None
        else f"{text} and up to {per_cent(left_out.motion[order])} of the motion"
    )
