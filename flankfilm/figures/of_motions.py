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


def portrait(found: dynamics.Trajectory) -> Figure:
    """Draw a motion over time and in the plane of its states."""
    names = OF_ONE if found.states.shape[1] == 2 else OF_CONTACT
    with sheet(None, 1, 2, height=3.2, legend=0) as (drawn, (over, plane)):
        over.plot(found.tau, found.x)
        over.set(xlabel="time τ [-]", ylabel=names[0])
        plane.plot(found.x, found.v)
        plane.plot(found.x[0], found.v[0], "o", color=colours(2)[1])
        plane.set(xlabel=names[0], ylabel=names[1])
    return drawn


def orbit(found: dynamics.Orbit) -> Figure:
    """Draw one turn of a periodic motion."""
    from dynamics import trajectory

    return portrait(trajectory(found.oscillator, found.state, periods=found.periods))


def branch(found: dynamics.Branch) -> Figure:
    """Draw the motions of a branch over its parameter, unstable ones dashed, with its special points.

    Of orbits of several periods, all points at the start of a period.
    """
    from dynamics.attraction.returns import branch_returns

    further = None
    if found.oscillator is not None and found.oscillator.is_exact:
        rows = branch_returns(found, found.oscillator)
        further = np.column_stack([np.zeros(len(rows)), rows])
    return _branches((found,), found.parameter, further=further)


def branches(found: dynamics.Diagram) -> Figure:
    """Draw all branches of a diagram, orbits of several periods at the start of each."""
    return _branches(found.branches, found.parameter, further=_returns(found))


def _returns(found: dynamics.Diagram) -> Array:
    """Points of orbits of several periods after each; none for trains, whose states are drawn."""
    from dynamics.attraction.returns import returns

    return returns(found) if found.oscillator.is_exact else np.empty((0, 6))


def _branches(
    found: Sequence[dynamics.Branch],
    parameter: str,
    mark: Callable[[Axes], None] = lambda axes: None,
    further: Array | None = None,
) -> Figure:
    with sheet(None, height=3.6, legend=4) as (drawn, (axes,)):
        kinds: dict[str, list[tuple[float, float]]] = {}
        pieces = [(one.values, one.states[:, 0], np.asarray(one.stable)) for one in found]
        if further is not None and len(further):
            for which in np.unique(further[:, :2], axis=0):
                rows = further[np.all(further[:, :2] == which, axis=1)]
                pieces.append((rows[:, 2], rows[:, 3], rows[:, 5].astype(bool)))
        for x, y, settled in pieces:
            for stable, dash in ((True, "-"), (False, "--")):
                # a point of the other kind ends each piece
                axes.plot(x, np.where(settled == stable, y, np.nan), linestyle=dash, color=colours(1)[0])
        for one in found:
            for point in one.points:
                kinds.setdefault(point.kind, []).append((point.parameter, float(point.state[0])))
        for (kind, places), colour, marker in zip(
            kinds.items(), colours(6)[1:], ("o", "s", "^", "D", "v"), strict=False
        ):
            axes.plot(*np.array(places).T, marker, color=colour, markersize=4, label=kind)
        axes.plot([], [], linestyle="-", color=colours(1)[0], label="stable")
        axes.plot([], [], linestyle="--", color=colours(1)[0], label="unstable")
        mark(axes)
        place = _first(found[0].states) if found else OF_ONE[0]
        axes.set(xlabel=f"{parameter.replace('_', ' ')} [-]", ylabel=f"{place}, at τ = 0")
    return drawn


def sweep(found: dynamics.SweepResult) -> Figure:
    """Draw the states that a sweep ended with at every value."""
    with sheet(None, height=3.4) as (drawn, (axes,)):
        states = found.states[..., 0]
        x = np.broadcast_to(found.values[:, None], states.shape).ravel()
        axes.plot(x, states.ravel(), ".", markersize=3, color=colours(1)[0], label=found.direction)
        place = f"{_first(found.states)}, at τ = 0"
        axes.set(xlabel=f"{found.parameter.replace('_', ' ')} [-]", ylabel=place)
    return drawn


def multi_sweep(found: dynamics.MultiSweep) -> Figure:
    """Draw every attractor that the sweeps met, periodic ones by their period."""
    kinds: dict[str, list[Array]] = {}
    for motion in (one for met in found.motions for one in met):
        name = f"period {motion.periods}" if motion.periods else "aperiodic"
        states = motion.states[:, 0]
        kinds.setdefault(name, []).append(np.column_stack([np.full(states.size, motion.value), states]))
    with sheet(None, height=3.6, legend=4) as (drawn, (axes,)):
        for (name, pieces), colour in zip(kinds.items(), 5 * colours(7), strict=False):
            axes.plot(*np.concatenate(pieces).T, ".", markersize=3, color=colour, label=name)
        axes.set(xlabel=f"{found.parameter.replace('_', ' ')} [-]", ylabel=f"{OF_ONE[0]}, at τ = 0")
    return drawn


def basins(found: dynamics.BasinResult) -> Figure:
    """Colour the starting states by the attractor that they reach; white where they reach none."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    count = len(found.attractors)
    labels = np.where(found.labels < 0, np.nan, found.labels.astype(float))
    with sheet(None, width=5.4, height=4.8, legend=0) as (drawn, (axes,)):
        shades = 3 * colours(7)
        axes.pcolormesh(
            found.x,
            found.v,
            labels.T,
            cmap=ListedColormap(shades[: max(count, 1)]),
            vmin=-0.5,
            vmax=max(count, 1) - 0.5,
            shading="nearest",
            rasterized=True,
        )
        handles = [
            Patch(color=shade, label=f"{one.label}: {100 * one.share:.3g} %")
            for one, shade in zip(found.attractors, shades, strict=False)
        ]
        one = count == 0 or np.shape(found.attractors[0].states)[-1] == 2
        axes.set(**dict(zip(("xlabel", "ylabel"), OF_ONE if one else PLANE, strict=True)))
        drawn.legend(handles=handles, loc="outside upper left", ncols=3)
    return drawn


def exponents(found: Any) -> Figure:
    """Draw the Lyapunov exponents over the parameter, with their standard errors."""
    count = found.exponents.shape[1]
    names = ("larger", "smaller") if count == 2 else [f"{number}." for number in range(1, count + 1)]
    with sheet(None, height=3.2, legend=6) as (drawn, (axes,)):
        for column, (name, colour) in enumerate(zip(names, 3 * colours(7), strict=False)):
            axes.errorbar(
                found.values,
                found.exponents[:, column],
                found.standard_errors[:, column],
                color=colour,
                label=name,
            )
        axes.set(xlabel=f"{found.parameter.replace('_', ' ')} [-]", ylabel="Lyapunov exponent [-]")
    return drawn


def locus(found: Any) -> Figure:
    """Draw a curve of special points in the plane of its two parameters, with its points of codimension two."""
    with sheet(None, height=3.6) as (drawn, (axes,)):
        axes.plot(*found.values.T, color=colours(1)[0], label=found.kind)
        first, second = (name.replace("_", " ") for name in found.parameters)
        axes.set(xlabel=f"{first} [-]", ylabel=f"{second} [-]")
    return drawn


def speed_sweep(found: SpeedSweep) -> Figure:
    """Draw maximum force and time without contact over the speed, up and down."""
    x = read_figure(found, "frequency" if found.speed is None else "speed")
    with sheet(None, 2, height=4.4) as (drawn, panels):
        for axes, name, scale, label in zip(
            panels,
            ("force_factor", "separated"),
            (1.0, 100.0),
            ("maximum over mean force [-]", "time without contact [%]"),
            strict=True,
        ):
            for (way, values), colour, dash in zip(
                getattr(found, name).items(), colours(2), DASHES, strict=False
            ):
                axes.plot(x.values, scale * values, color=colour, linestyle=dash, label=f"sweep {way}")
            axes.set_ylabel(label)
        panels[-1].set_xlabel(x.label)
    return drawn


def speed_diagram(found: SpeedDiagram) -> Figure:
    """Draw all branches over the frequency, and where a stable motion ends with its error."""

    def jumps(axes: Axes) -> None:
        for number, (at, error) in enumerate(zip(found.jump_frequency, found.jump_error, strict=True)):
            axes.axvline(at, color="#999999", linewidth=1.0, label=None if number else "jump, with its error")
            if np.isfinite(error):
                axes.axvspan(at * (1.0 - error), at * (1.0 + error), color="#dddddd")

    return _branches(found.diagram.branches, found.diagram.parameter, jumps, _returns(found.diagram))
