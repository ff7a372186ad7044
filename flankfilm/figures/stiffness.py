"""Stiffness, load share, transmission error and Fourier fit over the mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.reading import (
    PATH_LABEL,
    Reading,
    label_of,
    mark_path,
    need,
    read,
    text,
    travel,
    two_pitches,
)
from flankfilm.figures.style import Style, colours, figure, from_zero, legend_above, looks, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

STIFFNESS = 'run a scene that wants "stiffness"'

KINDS = {"secant": "secant_stiffness", "tangent": "stiffness"}
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
    names = [str(n) for n in results.data_vars if str(n).startswith("single_pair_stiffness_")]
    with styled(style):
        drawn = figure()
        axes = drawn.subplots()
        for name, look in zip(names, looks(len(names)), strict=True):
            k = read(results, name, per_face=True)
            axes.plot(travel(results, "single_pair_rho1"), k.values, label=label_of(results, name), **look)
        mark_path(results, (axes,), axes)
        axes.set(xlabel=PATH_LABEL, ylabel=k.label)
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
    """Draw a curve of the mesh cycle over two base pitches by every model, the one that counts first."""
    prefix = _final(results)
    own = list(dict.fromkeys((prefix, "dry")))
    need(results, STIFFNESS, *(f"{name}_{what}" for name in own))
    curves = {
        text(results, f"{name}_label"): read(results, f"{name}_{what}", per_face=per_face) for name in own
    }
    if "other_model" in results:
        others = read(results, f"other_{what}", per_face=per_face)
        for label, values in zip(results["other_model"].values.tolist(), others.values, strict=True):
            curves[label] = Reading(values, others.meaning, others.unit)
    position = read(results, f"{prefix}_position")
    with styled(style):
        drawn = figure(height=height)
        axes = drawn.subplots()
        for (label, curve), look in zip(curves.items(), looks(len(curves)), strict=True):
            axes.plot(*two_pitches(position.values, curve.values), label=label, **look)
        axes.set(xlabel=position.label, ylabel=curve.label)
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
    at, share = travel(results, f"{prefix}_rho1").ravel(), read(results, f"{prefix}_load_share")
    order = np.flatnonzero(np.isfinite(at))
    order = order[np.argsort(at[order])]
    with styled(style):
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        axes.plot(at[order], share.values.ravel()[order], ".-", color=colours(1)[0], markersize=3)
        mark_path(results, (axes,), axes)
        axes.set(xlabel=PATH_LABEL, ylabel=share.label, ylim=(-0.02, 1.05))
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
    need(results, 'run a scene that wants "fourier" and computes its stiffness', "fourier_harmonics")
    prefix, kind = _final(results), text(results, "fourier_kind")
    order = results["fourier_amplitude"].size
    series = {f"{kind}, order {order}": "fourier"}
    if "fourier_other_mean" in results:
        series[f"{'tangent' if kind == 'secant' else 'secant'}, order {order}"] = "fourier_other"
    samples = read(results, f"{prefix}_{KINDS[kind]}", per_face=True)
    position = read(results, f"{prefix}_position")
    with styled(style):
        drawn = figure(height=3.2)
        left, right = drawn.subplots(1, 2, width_ratios=(3, 1))
        curve = two_pitches(position.values, samples.values)
        left.plot(*curve, ".", color="#777777", markersize=3, label=kind)
        fine = np.linspace(0, 2, 401)
        for (label, name), look in zip(series.items(), looks(len(series)), strict=True):
            left.plot(fine, _sum(results, name, fine), label=label, **look)
        left.set(xlabel=position.label, ylabel=samples.named("stiffness"))
        legend_above(drawn, left)
        harmonics = read(results, "fourier_harmonics")
        numbers = np.arange(1, harmonics.values[:12].size + 1)
        right.bar(numbers, harmonics.values[:12], color=colours(1)[0])
        right.set(xlabel="harmonic [-]", ylabel=harmonics.label, xticks=numbers[:: max(1, numbers.size // 5)])
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
