"""Sweep of the speed up and down: settled motions, loss of contact, the largest force."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from base import Array, Figure, InputError
from flankfilm import coupling
from flankfilm.figures.reading import Pictures, read_figure
from flankfilm.output import drawing_data as drawn
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.output.variables import of_quantities, of_record
from flankfilm.products.output import Held, Named, Of, Take, output_of
from flankfilm.products.product import CurveTable, Product, ranked, section_of, when
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.run_parts import Work
from flankfilm.report.text import counted, number, percent
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.drives import DRIVE_SWEEP
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.motion import SWEEP

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import SpeedSweep

COEXISTS = 1.1
"""Ratio of forces above which the sweeps have another motion than the one from rest, or a resonance near it."""

NEGLIGIBLE = 0.01
"""Part of an error below which its source is not named."""

RESONANCE = (
    "speed",
    "frequency",
    *(f"{what}_{way}" for way in ("up", "down") for what in ("force_factor", "separated", "spread")),
)

PICTURES: Pictures = {
    "resonance": "sweep_force_factor_up",
    "sweep": "sweep_up",
    "portraits": "portrait_displacement",
}


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The sweep of a pair on rigid shafts; a drive train has a sweep with forces of bearings."""
    if "sweep" in wants and scene.shafts is None:
        yield SWEEP


def variables(sweep: SpeedSweep) -> Iterator[xr.Dataset]:
    """States and labels by direction, and portraits."""
    names = {f"sweep_states_{up}": f"sweep_{up}" for up in sweep.states}
    names |= {f"sweep_labels_{up}": f"sweep_{up}_label" for up in sweep.labels}
    yield of_record("sweep", sweep).rename(names)
    if sweep.portraits:
        motion = dict.fromkeys(("displacement", "velocity", "section"), sweep.error)
        yield of_quantities("portrait", drawn.portraits(sweep.portraits), motion)


def section(stage: SpeedSweep, results: xr.Dataset) -> Part:
    """Draw the sweeps and portraits."""
    drawn = pictures(results, PICTURES)
    notes = []
    if stage.grazings.size:
        at = "omega = " + ", ".join(f"{g:.6g}" for g in stage.grazings)
        if (rpm := _speed(stage)) is not None:
            at = ", ".join(f"{rpm * g:.0f}" for g in stage.grazings) + f" rpm ({at})"
        notes.append(said("grazing", at=at))
    periods = counted(stage.cost.periods, "period")
    notes += [said("exact", stage=stage, periods=periods), *_swept(stage), said("same_law"), *stage.messages]
    return Part("motion", "Motion", figures=drawn, tables=(_worst(stage, results),), notes=tuple(notes))


def _worst(stage: SpeedSweep, results: xr.Dataset) -> Table:
    """Maximum force, vibration and time without contact of either sweep, each with its speed."""
    from flankfilm.figures.motion import scale  # which loads matplotlib

    force, length, rpm = scale(results, "force"), scale(results, "length"), _speed(stage)

    def cells(values: Array, unit: float) -> tuple[str, str]:
        if not np.isfinite(values).any():
            return "-", "-"
        most = int(np.nanargmax(values))
        at = float(stage.frequency[most]) * (rpm or 1.0)
        return number(unit * float(values[most])), number(at, 5)

    rows = tuple(
        (
            direction,
            *cells(stage.force_factor[direction], float(force.values)),
            *cells(stage.spread[direction], float(length.values)),
            *cells(stage.separated[direction], 100.0),
        )
        for direction in stage.force_factor
    )
    at = "at ω" if rpm is None else "at [rpm]"
    named = force.named("maximum force" if force.unit == "N" else "maximum force over the mean")
    vibration = length.named("displacement, root mean square")
    heads = ("sweep", named, at, vibration, at, "maximum time without contact [%]", at)
    error = percent(stage.sampling_error)
    return Table(
        heads, rows, f"At the speeds swept; force and displacement ± {error} by the samples of a period."
    )


def _swept(stage: SpeedSweep) -> list[str]:
    """Effect of the omitted harmonics on the sweep; nothing for a given series."""
    if stage.longer_order is None or stage.force_change is None or stage.spread_change is None:
        return []
    force, spread = (
        np.concatenate(list(change.values())) for change in (stage.force_change, stage.spread_change)
    )
    same, repeating = np.isfinite(spread), ~np.isnan(spread)
    other, rest = int(np.sum(repeating & ~same)), int(np.sum(~repeating))
    notes = [
        said(
            "truncated_motions",
            order=stage.longer_order,
            count=int(same.sum()),
            all=len(spread),
            force=percent(_largest(force[same])),
            spread=percent(_largest(spread[same])),
            unknown=said("truncated_unknown", other=other, rest=rest) if other + rest else "",
        )
    ]
    if stage.grazing_error is not None and stage.grazing_error.size:
        worst = percent(float(stage.grazing_error.max()))
        notes.append(said("truncated_grazing", order=stage.longer_order, worst=worst))
    return notes


def _largest(changes: Array) -> float | None:
    known = changes[np.isfinite(changes)]
    return float(known.max()) if known.size else None


def headlines(computed: Computed) -> Iterator[Headline]:
    """Loss of contact, maximum force, and the dynamic factor at the operating speed."""
    if (stage := computed.get(SWEEP)) is None:
        return
    yield from ranked(_of_range(stage), 2, 2)
    if computed.scene.rpm is not None:
        yield from ranked(_of_operation(stage), 1)


def _of_range(stage: SpeedSweep) -> list[Headline]:
    """Lowest speed at which contact is lost, and the maximum force of the sweeps."""
    rpm = _speed(stage)
    name, unit = "contact first lost at", "" if rpm is None else "rpm"
    if stage.least_grazing is None:
        return [Headline(name, "none in range", "for the orbit that never leaves contact"), *_greatest(stage)]
    budget = stage.grazing_budget
    exact = set(budget) == {"flow"}
    note = "exact to rounding for the stiffness as given" if exact else ""
    off = None if exact else Uncertainty(finite(stage.least_grazing_error))
    if budget.get("truncation", 0.0) > NEGLIGIBLE * (stage.least_grazing_error or 0.0):
        note = f"{percent(budget['truncation'])} of it by harmonics that the series omits"
    value = number((rpm or 1.0) * stage.least_grazing, 5 if rpm else 6)
    return [Headline(name if rpm else f"{name} ω", value, note, unit, off), *_greatest(stage)]


def _greatest(stage: SpeedSweep) -> list[Headline]:
    """Maximum force of the sweeps over the mean one."""
    factors = np.array([*stage.force_factor.values()])
    if not np.isfinite(factors).any():
        return []
    at = float(stage.frequency[int(np.nanargmax(np.nanmax(factors, axis=0)))])
    rpm = _speed(stage)
    speed = f"ω = {at:.4g}" if rpm is None else f"{rpm * at:.0f} rpm"
    note, error = f"at {speed}, of the speeds swept", stage.greatest_factor_error
    if stage.force_change is not None and error is not None:
        omitted = percent(error - stage.sampling_error)
        note += f"; {omitted} of the error by harmonics that the series omits"
    off = Uncertainty(finite(error))
    return [Headline("maximum force over the mean force", f"{np.nanmax(factors):.3g}", note, "", off)]


def finite(error: float | None) -> float | None:
    """Error where it is known."""
    return None if error is None or not np.isfinite(error) else float(error)


def _of_operation(stage: SpeedSweep) -> list[Headline]:
    """Dynamic factor at the operating speed, and that of the sweeps near it where motions coexist."""
    factor, at, rpm = stage.operating_force_factor, stage.operating_frequency, _speed(stage)
    if rpm is None or not np.isfinite(factor):
        return []
    note = f"at {rpm * at:.0f} rpm, settled from rest"
    name, beside = "dynamic factor at the operating speed", np.searchsorted(stage.frequency, at)
    if 0 < beside < len(stage.frequency):
        met = np.array([*stage.force_factor.values()])[:, beside - 1 : beside + 1]
        if np.nanmax(met, initial=0.0) > COEXISTS * factor:
            note += f"; the sweeps reach {np.nanmax(met):.3g} near that speed"
    return [Headline(name, f"{factor:.4g}", note, "", Uncertainty(stage.sampling_error))]


def _speed(stage: SpeedSweep) -> float | None:
    """Pinion speed at the frequency 1 [rpm]; None for an oscillator in its own units."""
    if stage.speed is None:
        return None
    return float(read_figure(stage, "speed").values[0] / stage.frequency[0])


def _of_sweep(sweep: SpeedSweep, _: Computed) -> Work:
    return Work("settled motions", None, sweep.error, counted(sweep.cost.periods, "period"))


def greatest_of(values: Mapping[str, Array] | None) -> float | None:
    """Largest of both directions of a sweep, of the motions that are known; None without any."""
    known = [curve[~np.isnan(curve)] for curve in (values or {}).values()]
    joined = np.concatenate(known) if known else np.zeros(0)
    return float(joined.max()) if joined.size else None


def _of_pair(name: str, figure: Figure, value: Callable[[SpeedSweep], Any], **held: Unpack[Held]) -> Named:
    """Output of the pair's sweep on rigid shafts."""

    def of(engine: Engine) -> Any:
        if engine.scene.shafts is not None:
            allowed = "is of a pair on rigid shafts: the sweep of a drive train does not know it"
            raise InputError.at(f"outputs.{name}", "", allowed, "Leave it out, or leave [shafts] out")
        return value(engine[SWEEP])

    return output_of(name, figure, "sweep", of, **held)


def _moved(
    name: str,
    figure: Figure,
    value: Callable[[SpeedSweep | coupling.DriveSweep], Any],
    error: Take | None = None,
    **held: Unpack[Held],
) -> Named:
    """Output of the sweep, of a drive train's where the scene has shafts."""

    def of(take: Take) -> Of:
        return lambda engine: take(engine[SWEEP] if engine.scene.shafts is None else engine[DRIVE_SWEEP])

    return output_of(name, figure, "sweep", of(value), error=None if error is None else of(error), **held)


def _loss_speed(sweep: SpeedSweep) -> float | None:
    """Lowest pinion speed at which contact is lost, by the sweep's own speed over frequency."""
    least = sweep.least_grazing
    if least is None or sweep.speed is None:
        return None
    return float(sweep.speed[0] / sweep.frequency[0]) * least


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    return (
        _moved(
            "greatest_force_factor",
            Figure("1", "maximum force over the mean force, of all motions of the sweep"),
            lambda sweep: greatest_of(sweep.force_factor),
            error_output="greatest_force_factor_error",
        ),
        _moved(
            "greatest_force_factor_error",
            Figure("1", "its estimated relative error by samples and the series' order"),
            attrgetter("greatest_factor_error"),
        ),
        _moved(
            "separated",
            Figure("1", "largest part of the time without contact, of all motions of the sweep", shown="%"),
            lambda sweep: greatest_of(sweep.separated),
            attrgetter("greatest_separated_error"),
        ),
        _of_pair(
            "contact_loss_speed",
            Figure(
                "rad/s", "lowest pinion speed at which contact is lost; nan where it never is", shown="rpm"
            ),
            _loss_speed,
            error_output="contact_loss_error",
        ),
        _of_pair(
            "contact_loss_error",
            Figure("1", "estimated relative error of that speed; nan where unknown"),
            attrgetter("least_grazing_error"),
        ),
    )


PRODUCT = Product(
    name="sweep",
    goals=goals,
    variables=when(SWEEP, variables),
    solved={"sweep": SWEEP, "portrait": SWEEP},
    tables={
        **{
            f"sweep_{way}": CurveTable("sweep", way, ("speed", "frequency", way, f"{way}_label"))
            for way in ("up", "down")
        },
        "resonance": CurveTable("sweep", "force_factor_up", RESONANCE),
    },
    headlines=headlines,
    pictures=PICTURES,
    sections=section_of(SWEEP, section),
    work={SWEEP.name: _of_sweep},
    outputs=outputs,
)
