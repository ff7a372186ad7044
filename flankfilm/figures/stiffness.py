"""Stiffness, load share, transmission error and Fourier fit over the mesh cycle; over torque."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.face import DRY_FACE, factor, paint
from flankfilm.figures.panels import curves, over_path, over_two_pitches
from flankfilm.figures.reading import Reading, beside, labelled, need, read, text, travel
from flankfilm.figures.style import MARK, Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STIFFNESS = 'run a scene that wants "stiffness"'

KINDS = {"secant": "secant_stiffness", "tangent": "tangent_stiffness"}
"""Names of the curves of a mesh cycle."""

MOST = 12
"""Harmonics that are drawn."""

POSITION = "position, base pitches from A [-]"

OVER_MEAN = "amplitude over the mean [-]"


def mesh_stiffness(results: xr.Dataset, kind: str = "secant", *, style: Style | None = None) -> Figure:
    """Draw the mesh stiffness of every model over two base pitches on one axis.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``stiffness``.
    kind : str
        ``"secant"`` or ``"tangent"``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    with sheet(style, height=3.8, legend=2) as (drawn, (axes,)):
        _over_the_cycle(axes, results, KINDS[kind])
        from_zero(axes)
    return drawn


def transmission_error(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the deflection along the line of action over two base pitches, every model.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``stiffness``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    with sheet(style, height=3.2, legend=2) as (drawn, (axes,)):
        _over_the_cycle(axes, results, "transmission_error")
    return drawn


def mesh_cycle(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw secant stiffness and transmission error, and above them what the face bears where it has cells.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``stiffness``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    over_face = f"{DRY_FACE}_line_load" in results
    with sheet(style, 4 if over_face else 2, height=8.8 if over_face else 4.8, legend=0, sharex=False) as (
        drawn,
        (*face, upper, lower),
    ):
        if over_face:
            paint(results, DRY_FACE, {"line_load": face[0]})
            factor(face[1], results, DRY_FACE)
        prefix = _final(results)
        _drawn(upper, results, {kind: (prefix, what) for kind, what in KINDS.items()}, "stiffness")
        _drawn(lower, results, {"": (prefix, "transmission_error")}, "transmission error")
        legend_over(upper, 2)
        from_zero(upper)
        for axes in (*face[1:], upper):
            axes.set_xlim(lower.get_xlim())
            axes.tick_params(labelbottom=False)
            axes.set_xlabel("")
    return drawn


def _over_the_cycle(axes: Axes, results: xr.Dataset, what: str) -> None:
    """Draw a curve of the mesh cycle over two base pitches by every model, the one that counts first."""
    prefix = _final(results)
    own = [name for name in dict.fromkeys((prefix, "dry")) if f"{name}_position" in results]
    curves_of = {_label(results, name): (name, what) for name in own}
    _drawn(axes, results, curves_of, what.replace("_", " "), beside(results, f"other_{what}", per_face=True))
    events = results[f"{prefix}_event_position"].values
    marked = np.concatenate([events, events + 1])
    axes.vlines(marked, 0.0, 1.0, MARK, linewidth=0.8, transform=axes.get_xaxis_transform(), zorder=0)


def _drawn(
    axes: Axes,
    results: xr.Dataset,
    own: Mapping[str, tuple[str, str]],
    meaning: str,
    others: Mapping[str, Reading] | None = None,
) -> None:
    """Draw curves of mesh cycles by label, prefix and name, on their arcs where these are known, and other models."""
    ways = {
        label: (f"{prefix}_dense" if results[f"{prefix}_dense_position"].size else prefix, what)
        for label, (prefix, what) in own.items()
    }
    need(results, STIFFNESS, *(f"{way}_{what}" for way, what in ways.values()))
    cycles = {label: read(results, f"{way}_{what}", per_face=True) for label, (way, what) in ways.items()}
    places = {label: results[f"{way}_position"].values for label, (way, _) in ways.items()}
    position = read(results, f"{next(iter(own.values()))[0]}_position")
    over_two_pitches(axes, position, {**cycles, **(others or {})}, meaning, at=places)


def _label(results: xr.Dataset, prefix: str) -> str:
    """What a mesh cycle is of; a loaded contact alone is finite elements."""
    return text(results, f"{prefix}_label") if f"{prefix}_label" in results else "finite elements"


def load_share(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw a pair's share of the force against its own travel through the mesh, with film where there is one.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``stiffness``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    prefix = _final(results)
    at, share = travel(results, f"{prefix}_rho1").ravel(), read(results, f"{prefix}_load_share")
    order = np.argsort(at)[: np.isfinite(at).sum()]
    with sheet(style, height=2.8) as (drawn, (axes,)):
        axes.plot(at[order], share.values.ravel()[order], ".-", color=colours(1)[0], markersize=3)
        axes.set(ylabel=share.label, ylim=(-0.02, 1.05))
        over_path(results, axes)
    return drawn


def fourier(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the stiffness with its Fourier series, and beside it the harmonics over the mean.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``fourier`` and computes its stiffness.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "fourier"', "fourier_kind", "fourier_amplitude")
    kind = text(results, "fourier_kind")
    order = results["fourier_amplitude"].size
    series = {f"{kind}, order {order}": "fourier"}
    if "fourier_other_mean" in results:
        series[f"{'tangent' if kind == 'secant' else 'secant'}, order {order}"] = "fourier_other"
    mean, fine = read(results, "fourier_mean", per_face=True), np.linspace(0, 2, 401)
    harmonics = (results["fourier_amplitude"].values / results["fourier_mean"].values)[:MOST]
    if "fourier_harmonics" in results:
        harmonics = results["fourier_harmonics"].values[:MOST]
    numbers = np.arange(1, harmonics.size + 1)
    with sheet(style, 1, 2, width_ratios=(3, 1)) as (drawn, (left, right)):
        if "fourier_samples" in results:
            dots: dict[str, Any] = {"color": "#777777", "linestyle": "none", "marker": ".", "markersize": 3}
            samples = read(results, "fourier_samples", per_face=True)
            over_two_pitches(left, read(results, "fourier_position"), {kind: samples}, **dots)
        sums = {label: replace(mean, values=_sum(results, name, fine)) for label, name in series.items()}
        curves(left, fine, sums, "stiffness")
        left.set(xlabel=POSITION)
        right.bar(numbers, harmonics, color=colours(1)[0])
        right.set(xlabel="harmonic [-]", ylabel=OVER_MEAN, xticks=numbers[:: max(1, numbers.size // 5)])
    return drawn


def over_torque(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw mean stiffness and transmission error over the pinion's torque, and below them their harmonics.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``torques``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    names = {"secant": "torque_secant_stiffness", "tangent": "torque_tangent_stiffness"}
    wants, first = 'run a scene that wants "torques"', "torque_transmission_error_harmonic_1"
    need(results, wants, *names.values(), first)
    torque, error = read(results, "torque"), read(results, "torque_transmission_error")
    means = {kind: read(results, name, per_face=True) for kind, name in names.items()}
    over_mean = read(results, "torque_harmonic_1")
    with sheet(style, 2, 2, height=5.4) as (drawn, (left, right, lower, stiff)):
        curves(left, torque.values, means, "mean stiffness", marker=".")
        right.plot(torque.values, error.values, ".-", color=colours(1)[0])
        right.set(ylabel=error.named("transmission error,\npeak to peak"))
        curves(
            lower, torque.values, labelled(results, first[:-1]), "transmission error,\nharmonics", marker="."
        )
        legend_over(lower, 5)
        stiff.plot(torque.values, over_mean.values, ".-", color=colours(1)[0])
        stiff.set(ylabel=over_mean.named("secant stiffness, first\nharmonic over mean"))
        from_zero(right, lower, stiff)
        for axes in (lower, stiff):
            axes.set(xlabel=torque.label)
    return drawn


def revolution(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the transmission error tooth by tooth, under load and without.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``revolution``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    names = {
        "under load": "revolution_transmission_error",
        "without load": "revolution_unloaded_transmission_error",
    }
    need(results, 'run a scene that wants "revolution"', *names.values())
    position, errors = read(results, "revolution_position"), {k: read(results, n) for k, n in names.items()}
    with sheet(style, height=2.8) as (drawn, (axes,)):
        curves(axes, position.values, errors, "transmission error", linewidth=0.9)
        axes.set(xlabel=position.label)
    return drawn


def _sum(results: xr.Dataset, name: str, turns: Array) -> Array:
    """Fourier series at `turns` base pitches after A, per face width."""
    mean, amplitude = (
        read(results, f"{name}_{part}", per_face=True).values for part in ("mean", "amplitude")
    )
    phase = results[f"{name}_phase"].values
    angle = 2 * np.pi * turns[:, None] * np.arange(1, amplitude.size + 1) + phase
    return np.asarray(mean + np.cos(angle) @ amplitude)


def _final(results: xr.Dataset) -> str:
    """Which mesh cycle counts: the one with film where there is one."""
    prefix = "lubricated" if "lubricated_position" in results else "dry"
    need(results, STIFFNESS, f"{prefix}_position")
    return prefix
