"""Pictures of single records of motions, sweeps, branches and basins, for `result.plot()`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.reading import read_figure
from flankfilm.figures.style import DASHES, colours, sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    import dynamics
    from flankfilm.coupling import SpeedDiagram, SpeedSweep

OF_ONE = ("displacement X [-]", "velocity dX/dτ [-]")
"""State of an oscillator of one freedom."""

OF_CONTACT = ("contact coordinate y [-]", "its rate dy/dτ [-]")
"""What a motion of a drive train is drawn by."""

FIRST = "displacement $q_1$ [-]"
"""First coordinate of a drive train's state, of which a sweep or a branch knows no contact coordinate."""

PLANE = ("along the plane's first direction [-]", "along the plane's second direction [-]")
"""Starts of a drive train."""


def _first(states: Array) -> str:
    """What the first column of states is."""
    return OF_ONE[0] if np.shape(states)[-1] == 2 else FIRST


def portrait(motion: dynamics.Trajectory) -> Figure:
    """Draw a motion over time and in the plane of its states."""
    names = OF_ONE if motion.states.shape[1] == 2 else OF_CONTACT
    with sheet(None, 1, 2, height=3.2, legend=0) as (drawn, (over, plane)):
        over.plot(motion.tau, motion.x)
        over.set(xlabel="time τ [-]", ylabel=names[0])
        plane.plot(motion.x, motion.v)
        plane.plot(motion.x[0], motion.v[0], "o", color=colours(2)[1])
        plane.set(xlabel=names[0], ylabel=names[1])
    return drawn


def orbit(motion: dynamics.Orbit) -> Figure:
    """Draw one turn of a periodic motion."""
    from dynamics import trajectory

    return portrait(trajectory(motion.oscillator, motion.state, periods=motion.periods))


def branch(curve: dynamics.Branch) -> Figure:
    """Draw the motions of a branch over its parameter, unstable ones dashed, with its special points.

    Of orbits of several periods, all points at the start of a period.
    """
    from dynamics.attraction.returns import branch_returns

    further = None
    if curve.oscillator is not None and curve.oscillator.is_exact:
        rows = branch_returns(curve, curve.oscillator)
        further = np.column_stack([np.zeros(len(rows)), rows])
    return _branches((curve,), curve.parameter, further=further)


def branches(diagram: dynamics.Diagram) -> Figure:
    """Draw all branches of a diagram, orbits of several periods at the start of each."""
    return _branches(diagram.branches, diagram.parameter, further=_returns(diagram))


def _returns(diagram: dynamics.Diagram) -> Array:
    """Points of orbits of several periods after each; none for trains, whose states are drawn."""
    from dynamics.attraction.returns import returns

    return returns(diagram) if diagram.oscillator.is_exact else np.empty((0, 6))


def _branches(
    curves: Sequence[dynamics.Branch],
    parameter: str,
    mark: Callable[[Axes], None] = lambda axes: None,
    further: Array | None = None,
) -> Figure:
    with sheet(None, height=3.6, legend=4) as (drawn, (axes,)):
        kinds: dict[str, list[tuple[float, float]]] = {}
        pieces = [(curve.values, curve.states[:, 0], np.asarray(curve.stable)) for curve in curves]
        if further is not None and len(further):
            for which in np.unique(further[:, :2], axis=0):
                rows = further[np.all(further[:, :2] == which, axis=1)]
                pieces.append((rows[:, 2], rows[:, 3], rows[:, 5].astype(bool)))
        for x, y, settled in pieces:
            for stable, dash in ((True, "-"), (False, "--")):
                # a point of the other kind ends each piece
                axes.plot(x, np.where(settled == stable, y, np.nan), linestyle=dash, color=colours(1)[0])
        for curve in curves:
            for point in curve.points:
                kinds.setdefault(point.kind, []).append((point.parameter, float(point.state[0])))
        for (kind, places), colour, marker in zip(
            kinds.items(), colours(6)[1:], ("o", "s", "^", "D", "v"), strict=False
        ):
            axes.plot(*np.array(places).T, marker, color=colour, markersize=4, label=kind)
        axes.plot([], [], linestyle="-", color=colours(1)[0], label="stable")
        axes.plot([], [], linestyle="--", color=colours(1)[0], label="unstable")
        mark(axes)
        place = _first(curves[0].states) if curves else OF_ONE[0]
        axes.set(xlabel=f"{parameter.replace('_', ' ')} [-]", ylabel=f"{place}, at τ = 0")
    return drawn


def sweep(swept: dynamics.SweepResult) -> Figure:
    """Draw the states that a sweep ended with at every value."""
    with sheet(None, height=3.4) as (drawn, (axes,)):
        states = swept.states[..., 0]
        x = np.broadcast_to(swept.values[:, None], states.shape).ravel()
        axes.plot(x, states.ravel(), ".", markersize=3, color=colours(1)[0], label=swept.direction)
        place = f"{_first(swept.states)}, at τ = 0"
        axes.set(xlabel=f"{swept.parameter.replace('_', ' ')} [-]", ylabel=place)
    return drawn


def multi_sweep(sweeps: dynamics.MultiSweep) -> Figure:
    """Draw every attractor that the sweeps met, periodic ones by their period."""
    kinds: dict[str, list[Array]] = {}
    for motion in (attractor for met in sweeps.motions for attractor in met):
        name = f"period {motion.periods}" if motion.periods else "aperiodic"
        states = motion.states[:, 0]
        kinds.setdefault(name, []).append(np.column_stack([np.full(states.size, motion.value), states]))
    with sheet(None, height=3.6, legend=4) as (drawn, (axes,)):
        for (name, pieces), colour in zip(kinds.items(), 5 * colours(7), strict=False):
            axes.plot(*np.concatenate(pieces).T, ".", markersize=3, color=colour, label=name)
        axes.set(xlabel=f"{sweeps.parameter.replace('_', ' ')} [-]", ylabel=f"{OF_ONE[0]}, at τ = 0")
    return drawn


def basins(basin_map: dynamics.BasinResult) -> Figure:
    """Colour the starting states by the attractor that they reach; white where they reach none."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    count = len(basin_map.attractors)
    labels = np.where(basin_map.labels < 0, np.nan, basin_map.labels.astype(float))
    with sheet(None, width=5.4, height=4.8, legend=0) as (drawn, (axes,)):
        shades = 3 * colours(7)
        axes.pcolormesh(
            basin_map.x,
            basin_map.v,
            labels.T,
            cmap=ListedColormap(shades[: max(count, 1)]),
            vmin=-0.5,
            vmax=max(count, 1) - 0.5,
            shading="nearest",
            rasterized=True,
        )
        handles = [
            Patch(color=shade, label=f"{attractor.label}: {100 * attractor.share:.3g} %")
            for attractor, shade in zip(basin_map.attractors, shades, strict=False)
        ]
        single = count == 0 or np.shape(basin_map.attractors[0].states)[-1] == 2
        axes.set(**dict(zip(("xlabel", "ylabel"), OF_ONE if single else PLANE, strict=True)))
        drawn.legend(handles=handles, loc="outside upper left", ncols=3)
    return drawn


def exponents(spectrum: Any) -> Figure:
    """Draw the Lyapunov exponents over the parameter, with their standard errors."""
    count = spectrum.exponents.shape[1]
    names = ("larger", "smaller") if count == 2 else [f"{number}." for number in range(1, count + 1)]
    with sheet(None, height=3.2, legend=6) as (drawn, (axes,)):
        for column, (name, colour) in enumerate(zip(names, 3 * colours(7), strict=False)):
            axes.errorbar(
                spectrum.values,
                spectrum.exponents[:, column],
                spectrum.standard_errors[:, column],
                color=colour,
                label=name,
            )
        axes.set(xlabel=f"{spectrum.parameter.replace('_', ' ')} [-]", ylabel="Lyapunov exponent [-]")
    return drawn


def locus(curve: Any) -> Figure:
    """Draw a curve of special points in the plane of its two parameters, with its points of codimension two."""
    with sheet(None, height=3.6) as (drawn, (axes,)):
        axes.plot(*curve.values.T, color=colours(1)[0], label=curve.kind)
        first, second = (name.replace("_", " ") for name in curve.parameters)
        axes.set(xlabel=f"{first} [-]", ylabel=f"{second} [-]")
    return drawn


def speed_sweep(sweeps: SpeedSweep) -> Figure:
    """Draw maximum force and time without contact over the speed, up and down."""
    x = read_figure(sweeps, "frequency" if sweeps.speed is None else "speed")
    with sheet(None, 2, height=4.4) as (drawn, panels):
        for axes, name, scale, label in zip(
            panels,
            ("force_factor", "separated"),
            (1.0, 100.0),
            ("maximum over mean force [-]", "time without contact [%]"),
            strict=True,
        ):
            for (way, values), colour, dash in zip(
                getattr(sweeps, name).items(), colours(2), DASHES, strict=False
            ):
                axes.plot(x.values, scale * values, color=colour, linestyle=dash, label=f"sweep {way}")
            axes.set_ylabel(label)
        panels[-1].set_xlabel(x.label)
    return drawn


def speed_diagram(diagram: SpeedDiagram) -> Figure:
    """Draw all branches over the frequency, and where a stable motion ends with its error."""

    def jumps(axes: Axes) -> None:
        for number, (at, error) in enumerate(zip(diagram.jump_frequency, diagram.jump_error, strict=True)):
            axes.axvline(at, color="#999999", linewidth=1.0, label=None if number else "jump, with its error")
            if np.isfinite(error):
                axes.axvspan(at * (1.0 - error), at * (1.0 + error), color="#dddddd")

    return _branches(diagram.diagram.branches, diagram.diagram.parameter, jumps, _returns(diagram.diagram))
