"""Motions over time, attractors, basins, exponents and loci of an oscillator in its own units."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import need, text
from flankfilm.figures.style import Style, colours, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

OF_ONE = ("displacement X [-]", "velocity dX/dτ [-]")
"""State of an oscillator of one freedom."""

OF_CONTACT = ("contact coordinate y [-]", "its rate dy/dτ [-]")
"""What a motion of a drive train is drawn by."""

PLANE = ("along the plane's first direction [-]", "along the plane's second direction [-]")
"""Starts of a drive train."""


def trajectory(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw a motion over time and in the plane of its states, with the state that it starts from.

    Parameters
    ----------
    results : xarray.Dataset
        Of a motion of `dynamics`.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "give the dataset of a motion", "motion_tau", "motion_x", "motion_v")
    names = OF_ONE if int(results["motion_freedoms"]) == 1 else OF_CONTACT
    tau, x, v = (results[f"motion_{name}"].values for name in ("tau", "x", "v"))
    with sheet(style, 1, 2, height=3.2, legend=0) as (drawn, (over, plane)):
        over.plot(tau, x)
        over.set(xlabel="time τ [-]", ylabel=names[0])
        plane.plot(x, v)
        plane.plot(x[0], v[0], "o", color=colours(2)[1], label="τ = 0")
        plane.set(xlabel=names[0], ylabel=names[1])
        legend_over(plane, 1)
    return drawn


def attractors(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw every attractor that sweeps from many starts met over the parameter, periodic ones by their period.

    Parameters
    ----------
    results : xarray.Dataset
        Of a `dynamics.MultiSweep`.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "give the dataset of sweeps", "met_value", "met_displacement", "met_periods")
    value, x, periods = (results[f"met_{name}"].values for name in ("value", "displacement", "periods"))
    kinds = list(dict.fromkeys(periods.tolist()))
    with sheet(style, height=3.6, legend=4) as (drawn, (axes,)):
        for kind, colour in zip(kinds, 5 * colours(7), strict=False):
            label = f"period {kind}" if kind else "aperiodic"
            axes.plot(
                value[periods == kind], x[periods == kind], ".", markersize=3, color=colour, label=label
            )
        across = f"{results['met_value'].attrs['long_name']} [-]"
        axes.set(xlabel=across, ylabel="displacement at τ = 0 [-]")
    return drawn


def basins(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Colour the starting states by the attractor that they reach; white where they reach none.

    Parameters
    ----------
    results : xarray.Dataset
        Of a `dynamics.BasinResult`.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    from matplotlib.colors import ListedColormap

    need(results, "give the dataset of basins", "basins_labels", "basins_x", "basins_v")
    shares = results["basins_share"].values if "basins_share" in results else np.empty(0)
    labels = results["basins_labels"].values
    single = "basins_freedoms" not in results or int(results["basins_freedoms"]) == 1
    with sheet(style, width=5.4, height=4.8, legend=2) as (drawn, (axes,)):
        shades = 3 * colours(7)
        axes.pcolormesh(
            results["basins_x"].values,
            results["basins_v"].values,
            np.where(labels < 0, np.nan, labels.astype(float)).T,
            cmap=ListedColormap(shades[: max(len(shares), 1)]),
            vmin=-0.5,
            vmax=max(len(shares), 1) - 0.5,
            shading="nearest",
            rasterized=True,
        )
        for number, (share, shade) in enumerate(zip(shares.tolist(), shades, strict=False)):
            name = f"{results['basins_label'].values[number]}: {100 * share:.3g} %"
            axes.fill([np.nan] * 3, [np.nan] * 3, color=shade, label=name)
        axes.set(**dict(zip(("xlabel", "ylabel"), OF_ONE if single else PLANE, strict=True)))
        axes.grid(visible=False)
    return drawn


def exponents(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the Lyapunov exponents over the parameter, with their standard errors.

    Parameters
    ----------
    results : xarray.Dataset
        Of a `dynamics.LyapunovScan`.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "give the dataset of a scan of exponents", "lyapunov_values", "lyapunov_exponents")
    columns, errors = (results[f"lyapunov_{name}"].values.T for name in ("exponents", "standard_errors"))
    names = ("larger", "smaller") if len(columns) == 2 else [f"{n}." for n in range(1, len(columns) + 1)]
    values = results["lyapunov_values"].values
    with sheet(style, height=3.2, legend=6) as (drawn, (axes,)):
        for name, column, error, colour in zip(names, columns, errors, 3 * colours(7), strict=False):
            axes.errorbar(values, column, error, color=colour, label=name)
        across = text(results, "lyapunov_parameter").replace("_", " ")
        axes.set(xlabel=f"{across} [-]", ylabel="Lyapunov exponent [-]")
    return drawn


def locus(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw a curve of special points in the plane of its two parameters.

    Parameters
    ----------
    results : xarray.Dataset
        Of a `dynamics.Locus`.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "give the dataset of a locus", "locus_values", "locus_parameters", "locus_kind")
    first, second = (str(name).replace("_", " ") for name in results["locus_parameters"].values)
    with sheet(style, height=3.6) as (drawn, (axes,)):
        axes.plot(*results["locus_values"].values.T, color=colours(1)[0], label=text(results, "locus_kind"))
        axes.set(xlabel=f"{first} [-]", ylabel=f"{second} [-]")
    return drawn
