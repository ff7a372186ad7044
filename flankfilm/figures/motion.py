"""Bifurcation sweeps, phase portraits with Poincaré points, bifurcation diagram and dynamic factor."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.panels import beside
from flankfilm.figures.reading import Reading, need, read
from flankfilm.figures.style import COLOURS, MARK, Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMOOTH = 5000
"""Most points of a curve that is drawn as a curve; longer ones become pixels, so that files stay small."""

MARKS = {
    "saddle-node": ("o", COLOURS[5]),
    "period-doubling": ("s", COLOURS[1]),
    "grazing": ("x", "#555555"),
    "neimark-sacker": ("D", COLOURS[2]),
}
"""Mark and colour of each kind of special point."""

SWEEP = 'run a scene that wants "sweep"'


def sweep(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the states at tau = 0 of the sweeps up and down, and under them the label of each motion.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``sweep``; over rpm where the scene has a scale, else over the frequency.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    ways = [way for way in ("up", "down") if f"sweep_{way}" in results] or ["up", "down"]
    need(results, SWEEP, "sweep_frequency", *(f"sweep_{way}" for way in ways))
    parameter = over_speed(results, "sweep")
    rows = {d: [str(n) for n in results[f"sweep_{d}_label"].values] for d in ways}
    names = _most_frequent([label for row in rows.values() for label in row], 8)
    rest = ["other"] if any(label not in names for row in rows.values() for label in row) else []
    below = 0.19 * max(4, len(names) + len(rest))
    with sheet(style, 2, height=3.8 + below, height_ratios=(2.6, below)) as (drawn, (upper, lower)):
        pair = colours(6)[5], colours(1)[0]
        # the larger dots lie below, so that both show where the sweeps agree
        length = scale(results, "length")
        for direction, colour, size in zip(rows, pair, (3.4, 1.3), strict=False):
            points = results[f"sweep_{direction}"].values
            x, y = np.repeat(parameter.values, points.shape[1]), length.values * points[:, :, 0].ravel()
            upper.plot(x, y, ".", color=colour, markersize=size, rasterized=True)
            upper.plot([], [], ".", color=colour, markersize=8, label=direction)
        upper.set(ylabel=length.named("displacement at tau = 0"))
        if length.unit != "-":
            beside(upper, float(length.values), "over the length scale [-]")
            beside(upper, rpm_of_one(results), "mesh over natural frequency [-]", "top")
        for row, colour, shift in zip(rows.values(), pair, (0.12, -0.12), strict=False):
            height = np.array([names.index(label) if label in names else len(names) for label in row])
            lower.plot(parameter.values, height + shift, ".", color=colour, markersize=2, rasterized=True)
        lower.set_yticks(range(len(names) + len(rest)), [*names, *rest])
        lower.margins(y=0.15)
        lower.set(xlabel=parameter.label, ylabel="motion n-p-q")
        lower.invert_yaxis()
    return drawn


def portraits(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw phase portraits with their Poincaré points and the edges of the backlash.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``sweep``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        results, SWEEP, "portrait_motion", "portrait_displacement", "portrait_section", "sweep_half_backlash"
    )
    count, edge = results["portrait_motion"].size, float(results["sweep_half_backlash"])
    columns = max(2, min(3, count))
    rows = -(-count // columns)
    of_sample, of_point = results["portrait_of_sample"].values, results["portrait_of_point"].values
    x, v = (read(results, f"portrait_{name}") for name in ("displacement", "velocity"))
    length, speed = scale(results, "length"), scale(results, "speed")
    far, fast = float(length.values), float(speed.values)
    with sheet(style, rows, columns, height=2.8 * rows + 0.3) as (drawn, panels):
        for axes in panels[count:]:
            axes.set_axis_off()
        first, second = colours(2)
        for i, axes in enumerate(panels[:count]):
            mine = of_sample == i
            many = int(mine.sum()) > SMOOTH
            axes.plot(
                far * x.values[mine], fast * v.values[mine], color=first, linewidth=0.8, rasterized=many
            )
            section = results["portrait_section"].values[of_point == i]
            axes.plot(far * section[:, 0], fast * section[:, 1], "o", color=second, markersize=3.5)
            for at in (-far * edge, far * edge):
                axes.axvline(at, color=MARK, linewidth=0.8, linestyle=":")
            motion, direction, frequency = (
                results[f"portrait_{name}"].values[i] for name in ("motion", "direction", "frequency")
            )
            speed_text = f"ω = {frequency:.4g}"
            if length.unit != "-":
                speed_text = f"{rpm_of_one(results) * frequency:.0f} rpm, {speed_text}"
            axes.set_title(f"{motion}, {direction}\nat {speed_text}", fontsize=8.5)
            axes.set(
                xlabel=length.named("displacement X"),
                ylabel=speed.named("velocity dX/dτ" if speed.unit == "-" else "velocity"),
            )
    return drawn


def resonance(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw maximum force, time without contact and vibration of the sweeps up and down over the speed.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``sweep``; in N, um and rpm where the scene has scales, with the dimensionless figures
        beside them.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, SWEEP, "sweep_force_factor_up", "sweep_separated_up", "sweep_spread_up")
    length, force, at = scale(results, "length"), scale(results, "force"), over_speed(results, "sweep")
    shown = {"force_factor": force, "separated": None, "spread": length}
    labels = {
        "force_factor": "maximum force" if force.unit == "N" else "maximum force\nover mean",
        "separated": "time without\ncontact",
        "spread": "displacement,\nroot mean square",
    }
    with sheet(style, 3, height=6.0, legend=2) as (drawn, panels):
        for axes, (name, unit) in zip(panels, shown.items(), strict=True):
            for direction, colour, wide in zip(
                ("up", "down"), (colours(6)[5], colours(1)[0]), (2.6, 1.1), strict=True
            ):
                curve = read(results, f"sweep_{name}_{direction}")
                values = curve.values if unit is None else float(unit.values) * curve.values
                axes.plot(
                    at.values,
                    values,
                    ".-",
                    color=colour,
                    linewidth=wide,
                    markersize=2 * wide,
                    label=direction,
                )
            axes.set(ylabel=(curve if unit is None else unit).named(labels[name]))
            if unit is not None and unit.unit != "-":
                over = "over the mean\nforce [-]" if unit is force else "over the\nlength scale [-]"
                beside(axes, float(unit.values), over)
        from_zero(*panels)
        if length.unit != "-":
            beside(panels[0], rpm_of_one(results), "mesh over natural frequency [-]", "top")
        panels[-1].set(xlabel=at.label)
    return drawn


def scale(results: xr.Dataset, of: str) -> Reading:
    """What 1 is of ``"length"``, ``"speed"`` or ``"force"``, the mean one; 1 for an oscillator in its own units."""
    name = "oscillator_force" if of == "force" else f"oscillator_{of}_scale"
    return read(results, name) if name in results else Reading(np.array(1.0), of, "-")


def rpm_text(results: xr.Dataset) -> str:
    """Speed of a spectrum, and its frequency."""
    frequency = f"ω = {float(results['spectrum_frequency']):.4g}"
    if "spectrum_speed" not in results:
        return frequency
    return f"{float(read(results, 'spectrum_speed').values):.0f} rpm, {frequency}"


def rpm_of_one(results: xr.Dataset) -> float:
    """Pinion speed of the mesh frequency that is the natural one [rpm]."""
    return float(read(results, "sweep_speed").values[0] / results["sweep_frequency"].values[0])


def diagram(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw branches, stable solid and unstable dashed, with their special points; under them the forces.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``diagram``; over rpm where there is a scale, else over the frequency.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        results, 'run a scene that wants "diagram"', "diagram_branch", "special_kind", "special_displacement"
    )
    forces = "force_frequency" in results and results["force_frequency"].size > 0
    with sheet(style, 1 + forces, height=5.6 if forces else 3.6, legend=4) as (drawn, panels):
        _jumps(panels[0], results)
        _branches(panels[0], results)
        if forces:
            _forces(panels[1], results)
        panels[-1].set(xlabel=over_speed(results, "diagram").label)
    return drawn


def _jumps(axes: Axes, results: xr.Dataset) -> None:
    """Draw where a stable motion ends, with the error of the place."""
    if "jump_error" not in results:
        return
    places = over_speed(results, "jump").values.tolist()
    for number, (at, error) in enumerate(zip(places, results["jump_error"].values.tolist(), strict=True)):
        if np.isfinite(error):
            axes.axvspan(at * (1.0 - error), at * (1.0 + error), color="#dddddd", zorder=0)
        label = None if number else "jump, with its error"
        axes.axvline(at, color=MARK, linestyle="-", linewidth=0.8, zorder=0, label=label)


def _branches(axes: Axes, results: xr.Dataset) -> None:
    colour = colours(1)[0]
    x, length = read(results, "diagram_displacement"), scale(results, "length")
    for values, heights, stable in _curves_of_branches(results):
        for wanted, dash, width in ((True, "-", 1.4), (False, "--", 0.6)):
            keep = stable == wanted
            keep[1:] |= keep[:-1].copy()
            height = np.where(keep, float(length.values) * heights, np.nan)
            axes.plot(values, height, dash, color=colour, linewidth=width)
    for label, dash, width in (("stable", "-", 1.4), ("unstable", "--", 0.6)):
        axes.plot([], [], dash, color=colour, linewidth=width, label=label)
    kinds = results["special_kind"].values
    for kind, (mark, shade) in MARKS.items():
        mine = kinds == kind
        if not mine.any():
            continue
        at = over_speed(results, "special").values[mine]
        height = float(length.values) * results["special_displacement"].values[mine]
        axes.plot(at, height, mark, color=shade, markersize=3.5, linestyle="none", label=kind)
    axes.set(ylabel=length.named(x.meaning))
    if length.unit != "-":
        beside(axes, float(length.values), "over the length scale [-]")


def _curves_of_branches(results: xr.Dataset) -> Iterator[tuple[Array, Array, Array]]:
    """Place, displacement and stability along every branch, and again at each further period of its orbits."""
    for prefix, further in (("diagram", ()), ("return", ("periods",))):
        if f"{prefix}_displacement" not in results or results[f"{prefix}_displacement"].size == 0:
            continue
        values, x = over_speed(results, prefix).values, read(results, f"{prefix}_displacement").values
        stable = results[f"{prefix}_stable"].values.astype(bool)
        which = np.array([results[f"{prefix}_{name}"].values for name in ("branch", *further)])
        for curve in np.unique(which, axis=1).T:
            mine = np.all(which == curve[:, None], axis=0)
            yield values[mine], x[mine], stable[mine]


def _forces(axes: Axes, results: xr.Dataset) -> None:
    at, factor = over_speed(results, "force").values, read(results, "force_factor")
    first, second = colours(2)
    label = "stable motions, periods 1 and 2"
    axes.plot(at, factor.values, ".", markersize=2.5, color=first, label=label)
    standard = results["force_factor_iso6336"].values
    if np.any(np.isfinite(standard)):
        order = np.argsort(at)
        axes.plot(at[order], standard[order], color=second, label="K_v of ISO 6336-1, method B")
    axes.set(ylabel=factor.label)
    mean = scale(results, "force")
    if mean.unit == "N":
        beside(axes, 1.0 / float(mean.values), mean.named("maximum force"))
    legend_over(axes, 2)


def over_speed(results: xr.Dataset, prefix: str) -> Reading:
    """Places of motions: the pinion's speed where the scene has one, else the frequency."""
    return read(results, f"{prefix}_{'speed' if f'{prefix}_speed' in results else 'frequency'}")


def _most_frequent(labels: Sequence[str], limit: int) -> list[str]:
    names, counts = np.unique(np.asarray(labels), return_counts=True)
    return sorted(str(n) for n in names[np.argsort(-counts, kind="stable")][:limit])
