"""Stiffness, load share, transmission error and Fourier fit over the mesh cycle; over torque; beside closed forms."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.panels import curves, over_path, over_two_pitches
from flankfilm.figures.reading import Reading, beside, labelled, need, read, text, travel
from flankfilm.figures.style import MARK, Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

STIFFNESS = 'run a scene that wants "stiffness"'

KINDS = {"secant": "secant_stiffness", "tangent": "tangent_stiffness"}
"""Names of the curves of a mesh cycle."""


def single_pairs(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the stiffness of one pair of teeth along the path of contact, one curve a model.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``closed-forms``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "closed-forms"', "single_pair_rho1", "pair_face_width")
    models = labelled(results, "single_pair_stiffness_", per_face=True)
    with sheet(style, legend=4) as (drawn, (axes,)):
        curves(axes, travel(results, "single_pair_rho1"), models)
        from_zero(axes)
        over_path(results, axes)
    return drawn


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
    drawn = _over_the_cycle(results, KINDS[kind], 3.8, style, per_face=True)
    from_zero(drawn.axes[0])
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
    return _over_the_cycle(results, "transmission_error", 3.2, style)


def _over_the_cycle(
    results: xr.Dataset, what: str, height: float, style: Style | None, *, per_face: bool = False
) -> Figure:
    """Draw a curve of the mesh cycle over two base pitches by every model, the one that counts first.

    On the arcs between events, with its steps; the events of the one that counts are marked.
    """
    prefix = _final(results)
    own = list(dict.fromkeys((prefix, "dry")))
    need(results, STIFFNESS, *(f"{name}_dense_{what}" for name in own))
    labels = {text(results, f"{name}_label"): name for name in own}
    cycles = {
        label: read(results, f"{name}_dense_{what}", per_face=per_face) for label, name in labels.items()
    }
    cycles |= beside(results, f"other_{what}", per_face=per_face)
    places = {label: results[f"{name}_dense_position"].values for label, name in labels.items()}
    with sheet(style, height=height, legend=2) as (drawn, (axes,)):
        over_two_pitches(axes, read(results, f"{prefix}_position"), cycles, at=places)
        events = results[f"{prefix}_event_position"].values
        marked = np.concatenate([events, events + 1])
        axes.vlines(marked, 0.0, 1.0, MARK, linewidth=0.8, transform=axes.get_xaxis_transform(), zorder=0)
    return drawn


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
    need(results, 'run a scene that wants "fourier" and computes its stiffness', "fourier_samples")
    kind = text(results, "fourier_kind")
    order = results["fourier_amplitude"].size
    series = {f"{kind}, order {order}": "fourier"}
    if "fourier_other_mean" in results:
        series[f"{'tangent' if kind == 'secant' else 'secant'}, order {order}"] = "fourier_other"
    samples, position = read(results, "fourier_samples", per_face=True), read(results, "fourier_position")
    fine, harmonics = np.linspace(0, 2, 401), read(results, "fourier_harmonics")
    numbers = np.arange(1, harmonics.values[:12].size + 1)
    with sheet(style, 1, 2, width_ratios=(3, 1)) as (drawn, (left, right)):
        dots: dict[str, Any] = {"color": "#777777", "linestyle": "none", "marker": ".", "markersize": 3}
        over_two_pitches(left, position, {kind: samples}, **dots)
        sums = {label: replace(samples, values=_sum(results, name, fine)) for label, name in series.items()}
        curves(left, fine, sums, "stiffness")
        right.bar(numbers, harmonics.values[:12], color=colours(1)[0])
        right.set(xlabel="harmonic [-]", ylabel=harmonics.label, xticks=numbers[:: max(1, numbers.size // 5)])
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
    need(results, wants, *names.values(), first, "pair_face_width")
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


def verification(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw one pair along the path, the mesh cycle, and each model's difference from finite elements.

    Black lines are finite elements: with all parts, and without what closed forms lack (hub wind-up and
    coupling of neighbouring teeth). The grey band about zero is the numerical error of the latter.

    Parameters
    ----------
    results : xarray.Dataset
        What ``verify.nc`` holds.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    singles, secants = (
        {of: f"{of}_{what}" for of in ("reference", "model")}
        for what in ("single_stiffness", "secant_stiffness")
    )
    need(results, "give the verify.nc of a verification", "model", "reference", *singles.values())
    single, secant = (
        {of: beside(results, name, per_face=True) for of, name in names.items()}
        for names in (singles, secants)
    )
    at, position, like = (
        travel(results, "path_rho1"),
        read(results, "mesh_position"),
        int(results["like_for_like"]),
    )
    whole, lacking = (list(single["reference"])[i] for i in (0, like))
    base, error = single["reference"][lacking].values, 100 * float(results["reference_error"][like])
    differences = {
        name: Reading(100 * (curve.values / base - 1), "", "%") for name, curve in single["model"].items()
    }
    with sheet(style, 3, height=7.4, legend=2, sharex=False) as (drawn, (pair, mesh, off)):
        for name, label, dash in ((whole, whole, "-"), (lacking, f"finite elements {lacking}", "--")):
            curves(pair, at, {label: single["reference"][name]}, color="#000000", linestyle=dash)
            over_two_pitches(
                mesh, position, {label: secant["reference"][name]}, color="#000000", linestyle=dash
            )
        curves(pair, at, single["model"])
        over_two_pitches(mesh, position, secant["model"])
        curves(off, at, differences)
        off.axhspan(-error, error, color="#bbbbbb", linewidth=0)
        off.axhline(0.0, color="#000000", linewidth=0.8, linestyle="--")
        off.set(ylabel="one pair, difference\nfrom dashed black line [%]")
        from_zero(pair, mesh)
        for axes in (pair, off):
            over_path(results, axes)
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
    need(results, STIFFNESS, f"{prefix}_position", f"{prefix}_label", "pair_face_width")
    return prefix
