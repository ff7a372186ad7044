"""Stiffness, load share, transmission error and Fourier fit over the mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import (
    CYCLE_LABEL,
    PATH_LABEL,
    Array,
    label_of,
    mark_path,
    need,
    per_face,
    text,
    travel,
    two_pitches,
)
from flankfilm.figures.style import Style, colours, figure, from_zero, legend_above, looks, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

STIFFNESS = 'run a scene that wants "stiffness"'


def single_pairs(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the stiffness of one pair of teeth along the path of contact, one curve a model.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``closed-forms``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "closed-forms"', "path_rho1", "face_width")
    names = [str(n) for n in results.data_vars if str(n).startswith("single_pair_")]
    with styled(style):
        drawn = figure()
        axes = drawn.subplots()
        for name, look in zip(names, looks(len(names)), strict=True):
            k = per_face(results) * results[name].values
            axes.plot(travel(results, "path_rho1"), k, label=label_of(results, name), **look)
        mark_path(results, (axes,), axes)
        axes.set(xlabel=PATH_LABEL, ylabel="one pair [N/(mm µm)]")
        from_zero(axes)
        legend_above(drawn, axes, columns=4)
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
    cycles = _cycles(results, f"{kind}_stiffness")
    with styled(style):
        drawn = figure(height=3.8)
        axes = drawn.subplots()
        for (label, (phase, k)), look in zip(cycles.items(), looks(len(cycles)), strict=True):
            axes.plot(*two_pitches(phase, per_face(results) * k), label=label, **look)
        axes.set(xlabel=CYCLE_LABEL, ylabel=f"mesh, {kind} [N/(mm µm)]")
        from_zero(axes)
        legend_above(drawn, axes, columns=2)
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
    cycles = _cycles(results, "transmission_error")
    with styled(style):
        drawn = figure(height=3.2)
        axes = drawn.subplots()
        for (label, (phase, error)), look in zip(cycles.items(), looks(len(cycles)), strict=True):
            axes.plot(*two_pitches(phase, 1e6 * error), label=label, **look)
        axes.set(xlabel=CYCLE_LABEL, ylabel="loaded transmission error [µm]")
        legend_above(drawn, axes, columns=2)
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
    rho = results[f"{prefix}_rho1"].values.ravel()
    order = np.flatnonzero(np.isfinite(rho))
    order = order[np.argsort(rho[order])]
    share = results[f"{prefix}_load_share"].values.ravel()[order]
    with styled(style):
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        at = 1e3 * (rho[order] - float(results["path_point_rho1"][0]))
        axes.plot(at, share, ".-", color=colours(1)[0], markersize=3)
        mark_path(results, (axes,), axes)
        axes.set(xlabel=PATH_LABEL, ylabel="share of the force [-]", ylim=(-0.02, 1.05))
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
    need(results, 'run a scene that wants "fourier" and computes its stiffness', "sampled_harmonic")
    prefix, scale = _final(results), per_face(results)
    kind = text(results, "fourier_kind")
    order = results["fourier_amplitude"].size
    series = {f"{kind}, order {order}": "fourier"}
    if "fourier_other_mean" in results:
        series[f"{'tangent' if kind == 'secant' else 'secant'}, order {order}"] = "fourier_other"
    with styled(style):
        drawn = figure(height=3.2)
        left, right = drawn.subplots(1, 2, width_ratios=(3, 1))
        samples = results[f"{prefix}_{kind}_stiffness"].values
        phase, k = two_pitches(results[f"{prefix}_phase"].values, scale * samples)
        left.plot(phase, k, ".", color="#777777", markersize=3, label=kind)
        fine = np.linspace(0, 2, 401)
        for (label, name), look in zip(series.items(), looks(len(series)), strict=True):
            left.plot(fine, scale * _sum(results, name, fine), label=label, **look)
        left.set(xlabel=CYCLE_LABEL, ylabel="stiffness [N/(mm µm)]")
        legend_above(drawn, left)
        harmonics = results["sampled_harmonic"].values[:12]
        numbers = np.arange(1, harmonics.size + 1)
        right.bar(numbers, harmonics, color=colours(1)[0])
        right.set(
            xlabel="harmonic [-]",
            ylabel="amplitude over the mean [-]",
            xticks=numbers[:: max(1, numbers.size // 5)],
        )
    return drawn


def _sum(results: xr.Dataset, name: str, turns: Array) -> Array:
    """Fourier series at `turns` base pitches after A."""
    amplitude, phase = results[f"{name}_amplitude"].values, results[f"{name}_phase"].values
    angle = 2 * np.pi * turns[:, None] * np.arange(1, amplitude.size + 1) + phase
    return np.asarray(float(results[f"{name}_mean"]) + np.cos(angle) @ amplitude)


def _final(results: xr.Dataset) -> str:
    """Which mesh cycle counts: the one with film where there is one."""
    prefix = "lubricated" if "lubricated_phase" in results else "dry"
    need(results, STIFFNESS, f"{prefix}_phase", "face_width")
    return prefix


def _cycles(results: xr.Dataset, what: str) -> dict[str, tuple[Array, Array]]:
    """Label of each model to phase and one curve; the one that counts first."""
    prefix = _final(results)
    found = {}
    for name in dict.fromkeys((prefix, "dry")):
        need(results, STIFFNESS, f"{name}_{what}", f"{name}_model")
        label = text(results, f"{name}_model")
        found[label] = results[f"{name}_phase"].values, results[f"{name}_{what}"].values
    if "other_model" in results:
        curves = zip(results["other_phase"].values, results[f"other_{what}"].values, strict=True)
        found |= dict(zip(results["other_model"].values.tolist(), curves, strict=True))
    return found
