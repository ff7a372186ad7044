"""Pictures of single records of geometry, stiffness and film for `result.plot()`; labels are those of figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import PER_FACE, Reading, read_figure, unit_text
from flankfilm.figures.style import DASHES, colours, films_from_zero, from_zero, legend_over, sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    import gears
    from ehl import FilmResponse, MixedFilm, MixedThermalFilm
    from fem import RootStress
    from flankfilm.coupling import (
        LossesAlongPath,
        MeshLosses,
        MeshSeries,
        PairOscillator,
        RootStresses,
        Verification,
    )

CURVES: Mapping[str, tuple[str, tuple[tuple[str, ...], ...]]] = {
    "MeshCycle": ("position", (("secant_stiffness", "stiffness"), ("transmission_error",))),
    "LubricatedCycle": ("position", (("secant_stiffness", "stiffness"), ("transmission_error",))),
    "TorqueCurves": ("torque", (("secant_stiffness", "stiffness"), ("transmission_error",))),
    "FilmAlongPath": ("rho1", (("central_thickness", "minimum_thickness"), ("hertz_pressure",))),
    "Film": ("x", (("pressure",), ("thickness",))),
    "TransientFilm": ("time", (("load",), ("central", "least"), ("greatest_pressure",))),
    "TractionCurve": (
        "slide_roll",
        (("traction_coefficient",), ("oil_temperature_rise", "surface_temperature_rise")),
    ),
    "PassageFilm": ("rho1", (("load",), ("least", "steady_least"), ("central", "steady_central"))),
    "FaceTolerance": ("in_plane", (("face_load_factor",),)),
    "FilmDamping": ("position", (("damping_curve",),)),
    "PathOfContact": ("rho1", (("rho1", "rho2", "radius"),)),
}
"""Class of a record to the figure along the axis, and those of each panel."""

WIDEST = 75
"""Characters of a legend's line; longer ones stand below each other."""

WORDS = {
    "stiffness": "tangent stiffness",
    "rho1": "radius of the pinion's flank",
    "rho2": "radius of the wheel's flank",
    "central": "central film",
    "least": "minimum film",
    "steady_central": "central film, steady",
    "steady_least": "minimum film, steady",
}
"""Names of curves that are not their field's."""


def curves(result: object) -> Figure:
    """Draw the curves of a record against their place, those of one unit together."""
    kind = next(cls.__name__ for cls in type(result).__mro__ if cls.__name__ in CURVES)
    across, panels = CURVES[kind]
    x = read_figure(result, across)
    with sheet(None, len(panels), height=1.2 + 1.9 * len(panels), legend=0) as (drawn, all_axes):
        for axes, names in zip(all_axes, panels, strict=True):
            known = [_read(result, name) for name in names if getattr(result, name) is not None]
            for reading, colour, dash in zip(known, colours(len(known)), DASHES, strict=False):
                axes.plot(x.values, reading.values, color=colour, linestyle=dash, label=reading.meaning)
            _titled(axes, known)
            if "minimum_thickness" in names:
                films_from_zero(axes)
            if kind == "Film" and names == ("thickness",):  # beyond the outlet the gap hides what counts
                axes.set_ylim(0.0, 4.0 * float(known[0].values[np.argmin(np.abs(x.values))]))
        all_axes[-1].set_xlabel(x.label)
    return drawn


def _read(result: object, name: str) -> Reading:
    """Curve by its name, without the definition that its meaning holds; stiffness in N/um."""
    reading = replace(read_figure(result, name), meaning=WORDS.get(name, name.replace("_", " ")))
    if reading.unit == "N/m":
        return replace(reading, values=1e-6 * reading.values, unit=unit_text("N/um"))
    return reading


def _titled(axes: Axes, readings: Sequence[Reading]) -> None:
    """Label of one curve, or the unit of several that a legend names."""
    if len(readings) == 1:
        axes.set_ylabel(readings[0].label)
        return
    axes.set_ylabel(f"[{readings[0].unit}]")
    long = sum(len(reading.meaning) for reading in readings) > WIDEST
    legend_over(axes, 1 if long else len(readings))


def mesh_losses(losses: MeshLosses) -> Figure:
    """Draw friction, losses and temperatures along the path."""
    return losses_along_path(losses.path)


def losses_along_path(losses: LossesAlongPath) -> Figure:
    """Draw friction, power, temperatures, pressure times sliding and film at the contacts along the path."""
    x = read_figure(losses, "rho1")
    powers = {"sliding": losses.sliding_loss, "rolling": losses.rolling_loss}
    rises = {
        "oil": losses.oil_temperature_rise,
        "pinion's flank": losses.surface_temperature_rise[0],
        "wheel's flank": losses.surface_temperature_rise[1],
        "flash, Blok": losses.flash_temperature,
    }
    with sheet(None, 5, height=8.4, legend=0) as (drawn, panels):
        friction, power, warmth, pressed, film = panels
        _curve(friction, x, read_figure(losses, "friction_coefficient"), "coefficient of\nfriction [-]")
        for axes, curves_, label in ((power, powers, "power lost [W]"), (warmth, rises, "rise [K]")):
            for (name, values), colour, dash in zip(
                curves_.items(), colours(len(curves_)), DASHES, strict=False
            ):
                axes.plot(x.values, values, color=colour, linestyle=dash, label=name)
            axes.set_ylabel(label)
            legend_over(axes, len(curves_))
        times = 1e-6 * losses.pressure_times_sliding
        pressed.plot(x.values, times, color=colours(1)[0])
        pressed.set_ylabel("pressure times\nsliding [MPa m/s]")
        if losses.film_ratio is None:
            _curve(film, x, read_figure(losses, "minimum_thickness"), "minimum film [µm]")
        else:
            _curve(film, x, read_figure(losses, "film_ratio"), "film ratio Λ [-]")
        from_zero(friction, power, warmth, pressed)
        films_from_zero(film)
        film.set_xlabel(x.label)
    return drawn


def _curve(axes: Axes, x: Reading, y: Reading, label: str) -> None:
    axes.plot(x.values, y.values, color=colours(1)[0])
    axes.set_ylabel(label)


def pair(gear_pair: gears.GearPair) -> Figure:
    """Draw both gears about the pitch point, with the path of contact."""
    from gears.tooth.polygon import outline

    placed = gear_pair.placement(gear_pair.points.C)
    middle, reach = placed.contact_point, 3.5 * gear_pair.module
    path = np.array([gear_pair.placement(getattr(gear_pair.points, name)).contact_point for name in "AE"])
    with sheet(None, width=5.0, height=4.6, legend=3) as (drawn, (axes,)):
        for place, tooth, colour, name in zip(
            (placed.pinion, placed.wheel),
            gear_pair.teeth_profiles,
            colours(2),
            ("pinion", "wheel"),
            strict=True,
        ):
            axes.fill(*(1e3 * place(outline(tooth))).T, facecolor=f"{colour}40", edgecolor=colour, label=name)
        axes.plot(*(1e3 * path).T, color=colours(3)[2], label="path of contact")
        (left, right), (low, high) = (1e3 * (m + np.array([-reach, reach])) for m in middle)
        axes.set(aspect="equal", xlim=(left, right), ylim=(low, high), xlabel="x [mm]", ylabel="y [mm]")
    return drawn


def closed_form(form: gears.closed_form.ClosedForm) -> Figure:
    """Draw the parts of the deflection per force at each point, stacked."""
    points = np.arange(1, np.atleast_1d(form.compliance).size + 1)
    parts = [1e9 * np.broadcast_to(np.atleast_1d(part), points.shape) for part in form.parts.values()]
    marker = "o" if points.size == 1 else ""
    with sheet(None, height=3.4, legend=3) as (drawn, (axes,)):
        axes.stackplot(
            points,
            parts,
            labels=[name.replace("_", " ") for name in form.parts],
            colors=colours(len(parts)),
            alpha=0.7,
        )
        axes.plot(points, np.sum(parts, axis=0), color="#000000", marker=marker, label="whole")
        axes.set(xlabel="point [-]", ylabel="deflection per force [nm/N]")
    return drawn


def mixed_film(film: MixedFilm | MixedThermalFilm) -> Figure:
    """Draw the film that carries its share of the load."""
    return curves(film.film)


def film_response(response: FilmResponse) -> Figure:
    """Draw yielding per load, in phase and a quarter behind, and damping over the frequency."""
    order = np.argsort(response.frequency, axis=None)
    at = response.frequency.ravel()[order] / (2e3 * np.pi)
    yielding = 1e12 * response.compliance.ravel()[order]
    with sheet(None, 2, height=4.6, legend=2) as (drawn, panels):
        for values, colour, dash, label in zip(
            (yielding.real, -yielding.imag),
            colours(2),
            DASHES,
            ("in phase with the load", "a quarter of a period behind"),
            strict=False,
        ):
            panels[0].plot(at, values, color=colour, linestyle=dash, label=label)
        panels[0].set_ylabel("yielding per load\n[µm per kN/mm]")
        panels[1].plot(at, 1e-9 * response.damping.ravel()[order], color=colours(1)[0])
        panels[1].set_ylabel("damping [N s/(mm µm)]")
        panels[1].set_xlabel("frequency [kHz]")
        if at[0] > 0.0 and at[-1] > 30.0 * at[0]:
            panels[1].set_xscale("log")
    return drawn


def root_stress(roots: RootStress) -> Figure:
    """Follow one tooth of each gear through its mesh: maximum tension and minimum stress of its fillets."""
    with sheet(None, 2, height=4.6) as (drawn, panels):
        for axes, gear, name in zip(panels, (roots.pinion, roots.wheel), ("pinion", "wheel"), strict=True):
            order = np.argsort(gear.tooth_position, axis=None, kind="stable")
            at = gear.tooth_position.ravel()[order]
            for stress, colour, label in zip(
                (gear.tension_Pa, gear.compression_Pa),
                colours(2),
                ("maximum, under the loaded flank", "minimum, on the other side"),
                strict=True,
            ):
                axes.plot(at, 1e-6 * stress.ravel()[order], color=colour, label=label)
            axes.set_ylabel(f"fillets, {name} [MPa]")
        panels[-1].set_xlabel("base pitches since the tooth's pair passed A [-]")
    return drawn


def root_stresses(stresses: RootStresses) -> Figure:
    """Draw the stress by finite elements."""
    return root_stress(stresses.stress)


def series_of(oscillator: PairOscillator) -> Figure:
    """Draw the stiffness that drives the oscillator."""
    return series(oscillator.series)


def series(mesh_series: MeshSeries) -> Figure:
    """Draw the series over one mesh period, with the samples that it was fitted to."""
    turn = np.linspace(0.0, 1.0, 401)
    shown, scale = ("N/m", 1.0) if mesh_series.kind == "given" else ("N/µm", 1e-6)
    with sheet(None, height=3.2) as (drawn, (axes,)):
        name = f"series of order {mesh_series.order}"
        stiffness = np.asarray(mesh_series.stiffness(2.0 * np.pi * turn))
        if mesh_series.samples is not None and mesh_series.position is not None:
            axes.plot(
                mesh_series.position,
                scale * mesh_series.samples,
                ".",
                markersize=3,
                color="#555555",
                label="mesh cycle",
            )
        axes.plot(turn, scale * stiffness, color=colours(1)[0], label=name)
        axes.set(
            xlabel="position, base pitches from A [-]", ylabel=f"mesh stiffness, {mesh_series.kind} [{shown}]"
        )
    return drawn


def verification(comparison: Verification) -> Figure:
    """Draw one pair of teeth along the path by every closed form and by finite elements, with the latter's error."""
    width = comparison.pair.face_width
    x = read_figure(comparison, "rho1")
    with sheet(None, height=3.6, legend=2) as (drawn, (axes,)):
        like = comparison.like_for_like
        for elements, colour in ((comparison.references[0], "#000000"), (like, "#777777")):
            axes.plot(x.values, 1e-9 / width * elements.single_stiffness, color=colour, label=elements.label)
        if like.error is not None:
            base = 1e-9 / width * like.single_stiffness
            axes.fill_between(
                x.values, base * (1 - like.error), base * (1 + like.error), color="#bbbbbb", linewidth=0.0
            )
        drawn_models = [model for model in comparison.models if model.single_stiffness.size]
        for form, colour, dash in zip(drawn_models, colours(len(drawn_models)), DASHES, strict=False):
            axes.plot(
                x.values, 1e-9 / width * form.single_stiffness, color=colour, linestyle=dash, label=form.label
            )
        axes.set(xlabel=x.label, ylabel=f"stiffness of one pair [{unit_text(PER_FACE)}]")
    return drawn
