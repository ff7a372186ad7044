"""The oscillator of the pair: its numbers, the damping of its films, and the unloaded transmission error."""

from __future__ import annotations

from collections.abc import Iterator, Set
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Figure
from flankfilm import coupling
from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.coupling.vibration.excitation import peak_to_peak
from flankfilm.figures.reading import Pictures
from flankfilm.output.variables import of_record
from flankfilm.products.output import Named, in_result, model_error_of, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, section_of, together
from flankfilm.report.page import Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent
from flankfilm.scene import Scene
from flankfilm.scene.needs import MOTIONS
from flankfilm.scene.sections.dynamics import BY_FILM
from flankfilm.stages.computed import Computed
from flankfilm.stages.damping import FILM_DAMPING
from flankfilm.stages.engine import Stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.motion import SCALING

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import ErrorSeries, FilmDamping

DIMENSIONLESS = ("mean_force", "half_backlash", "frequency")
"""Figures of an oscillator in its own units."""

LISTED = 12
"""Harmonics that a table lists; the data files hold all."""

OF_ERROR = 6
"""Harmonics of the error that the table of the oscillator lists."""

PICTURES: Pictures = {"excitation": "excitation_amplitude"}


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The oscillator of every motion, with what damps and drives it."""
    section = scene.dynamics
    if section is None or not wants & {*MOTIONS}:
        return
    if section.damping_ratio == BY_FILM:
        yield FILM_DAMPING
    if section.error_curve is not None:
        yield EXCITATION
    yield SCALING


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Damping of the films, the oscillator, and the unloaded transmission error."""
    if (damping := computed.get(FILM_DAMPING)) is not None:
        yield of_record("damping", damping)
    if (motion := computed.get(SCALING)) is not None:
        yield of_record("oscillator", motion, None if motion.scales is not None else DIMENSIONLESS)
    if (excitation := computed.get(EXCITATION)) is not None:
        yield of_record("excitation", excitation)


def excitation(stage: ErrorSeries, results: xr.Dataset) -> Part:
    """Harmonics of the unloaded transmission error."""
    rows = tuple(
        (str(j), number(1e6 * e), f"{np.degrees(phase):.2f}")
        for j, (e, phase) in enumerate(zip(stage.amplitude[:LISTED], stage.phase, strict=False), start=1)
    )
    table = Table(("harmonic", "amplitude [µm]", "phase [deg]"), rows)
    omitted = stage.motion_left
    motion = "" if omitted is None else said("excitation_motion", left=percent(omitted))
    meshes = counted(stage.meshes, "base pitch", "base pitches")
    notes = [
        said("excitation", order=stage.order, meshes=meshes, left=percent(stage.remainder), motion=motion),
        said("phases"),
        *([] if stage.converged else [stage.message]),
    ]
    text = f"{stage.source[:1].upper()}{stage.source[1:]}, peak to peak {number(1e6 * stage.range)} µm."
    drawn = pictures(results, PICTURES)
    return Part("excitation", "Unloaded transmission error", (text,), drawn, (table,), tuple(notes))


def film_damping(stage: FilmDamping, _: xr.Dataset) -> Part:
    """Damping of the films, its frequency, and other damping."""
    rows = (
        ("damping ratio of the films", number(stage.damping_ratio), f"± {percent(stage.error)}"),
        ("damping of the mesh by the films [N s/m]", number(stage.damping), f"± {percent(stage.error)}"),
        ("change of the mean tangent stiffness by the films [%]", number(100.0 * stage.stiffness_change), ""),
        (
            "natural frequency, at which the damping is taken [Hz]",
            number(stage.natural_frequency / (2.0 * np.pi)),
            "",
        ),
    )
    notes = (said("film_damping"), f"{stage.message[:1].upper()}{stage.message[1:]}.")
    return Part(
        "film-damping",
        "Damping by the films",
        tables=(Table(("quantity", "value", "error"), rows),),
        notes=notes,
    )


def scaling(stage: coupling.PairOscillator, _: xr.Dataset) -> Part:
    """Physical and dimensionless quantities side by side; dimensionless ones alone where there are no scales."""
    if stage.scales is None:
        table = Table(
            ("quantity", "dimensionless"), tuple((name, value) for name, _, value in oscillator_rows(stage))
        )
        return Part("scaling", "Oscillator", tables=(table,))
    table = Table(("quantity", "physical", "dimensionless"), oscillator_rows(stage))
    notes = [said("measured_against", what=MEANINGS[stage.reference])] if stage.reference else []
    return Part("scaling", "Physical and dimensionless", tables=(table,), notes=tuple(notes))


def oscillator_rows(stage: coupling.PairOscillator) -> tuple[tuple[str, str, str], ...]:
    """Quantities, physical and dimensionless, as text for tables."""
    osc, scales = stage.oscillator, stage.scales
    damping = "" if scales is None else f"{scales.damping(osc.damping_ratio):.4g} N s/m"
    rpm = "" if scales is None else f"{scales.rpm(osc.frequency):.6g} rpm of the pinion"
    own = [
        ("mean force F_m", f"{stage.force:.6g} N", f"{osc.mean_force:.6g}"),
        *_error_rows(stage),
        ("half backlash D", f"{1e6 * stage.backlash / 2:.4g} µm", f"{osc.half_backlash:.6g}"),
        ("damping ratio zeta", damping, f"{osc.damping_ratio:.6g}"),
        *_free_rows(stage),
        ("mesh frequency omega", rpm, f"{osc.frequency:.6g}"),
    ]
    if scales is None:
        return tuple((name, "", value) for name, _, value in own)
    return (
        *own,
        ("length scale b_c", f"{1e6 * scales.length:.5g} µm", "1"),
        ("mean stiffness k_m", f"{scales.mean_stiffness:.5g} N/m", "1"),
        ("equivalent mass m_e", f"{scales.equivalent_mass:.5g} kg", "1"),
        ("natural frequency", f"{scales.natural_frequency:.5g} Hz", "1"),
        ("resonance speed n_E1", f"{scales.rpm(1.0):.5g} rpm of the pinion", "1"),
        ("inertias J1, J2", ", ".join(f"{j:.4g}" for j in stage.inertias) + " kg m²", ""),
    )


def _free_rows(stage: coupling.PairOscillator) -> list[tuple[str, str, str]]:
    """Damping in the backlash, where it is another one."""
    free = stage.oscillator.free_damping_ratio
    if free is None:
        return []
    damping = "" if stage.scales is None else f"{stage.scales.damping(free):.4g} N s/m"
    return [("damping ratio in the backlash zeta_0", damping, f"{free:.6g}")]


def _error_rows(stage: coupling.PairOscillator) -> list[tuple[str, str, str]]:
    """Amplitudes of the error, the first of many, and its range where there are several."""
    own = stage.oscillator.error_series[0]
    physical = np.resize(stage.error_amplitude, len(own)) if stage.scales else np.zeros(len(own))
    if len(own) == 1:
        return [("error amplitude epsilon", f"{1e6 * physical[0]:.4g} µm", f"{own[0]:.6g}")]
    rows = [
        (f"error amplitude epsilon_{j}", f"{1e6 * e:.4g} µm", f"{x:.6g}")
        for j, (e, x) in enumerate(zip(physical[:OF_ERROR], own[:OF_ERROR], strict=True), start=1)
    ]
    rest = f", {len(own)} harmonics" if len(own) > OF_ERROR else ""
    whole = peak_to_peak(*stage.oscillator.error_series)
    return [*rows, (f"error, peak to peak{rest}", f"{1e6 * stage.error_range:.4g} µm", f"{whole:.6g}")]


def _resonance(motion: coupling.PairOscillator) -> float | None:
    """Pinion speed at which the mesh frequency is the natural one."""
    return None if motion.scales is None else motion.scales.speed(1.0)


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_oscillator = outputs_from(lambda engine: engine[SCALING], coupling.PairOscillator, "fourier")
    return (
        of_oscillator(
            "natural_frequency",
            error_output="natural_frequency_error",
            model_output="natural_frequency_model_error",
        ),
        output_of(
            "resonance_speed",
            Figure("rad/s", "pinion speed at which the mesh frequency is the natural one", shown="rpm"),
            "fourier",
            in_result(SCALING, _resonance),
            error_output="natural_frequency_error",
            model_output="natural_frequency_model_error",
        ),
        output_of(
            "natural_frequency_error",
            Figure(
                "1",
                "estimated relative error of natural frequency and resonance speed, by the mean stiffness",
            ),
            "fourier",
            in_result(SCALING, attrgetter("frequency_error")),
        ),
        model_error_of(
            "natural_frequency_model_error",
            "natural frequency and resonance speed",
            "fourier",
            lambda engine: engine[SCALING],
            "natural_frequency",
        ),
        of_oscillator("error_range"),
    )


PRODUCT = Product(
    name="oscillator",
    goals=goals,
    variables=variables,
    solved={"oscillator": SCALING, "excitation": EXCITATION},
    tables={"excitation": CurveTable("excitation", "amplitude", axis="harmonic")},
    pictures=PICTURES,
    sections=together(
        section_of(EXCITATION, excitation),
        section_of(FILM_DAMPING, film_damping),
        section_of(SCALING, scaling),
    ),
    outputs=outputs,
)
