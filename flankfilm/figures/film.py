"""Film thickness and pressure, along the path of contact and through the contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.style import COLOURS, DASHES, figure, legend_above, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ehl import Film
    from flankfilm.mesh_stiffness import MeshStiffness
    from flankfilm.stages.film import FilmStage

Array = NDArray[np.float64]


def film_along_path(
    position: Array, central: Array, minimum: Array, pressure: Array, marks: Mapping[str, float]
) -> Figure:
    """Draw central and minimum film and the Hertz pressure against the travel of a pair from A.

    Parameters
    ----------
    position : ndarray, shape (n,)
        Travel from A [m], rising.
    central, minimum : ndarray, shape (n,)
        Film thickness [m].
    pressure : ndarray, shape (n,)
        Peak Hertz pressure [Pa].
    marks : mapping
        Name of a point of the path to its travel from A [m].
    """
    with styled():
        drawn = figure(height=4.2)
        upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        upper.plot(1e3 * position, 1e6 * central, color=COLOURS[0], label="central film")
        upper.plot(1e3 * position, 1e6 * minimum, color=COLOURS[1], linestyle="--", label="minimum film")
        upper.set(ylabel="film thickness [µm]", ylim=(0, None))
        legend_above(drawn, upper)
        lower.plot(1e3 * position, 1e-9 * pressure, color=COLOURS[2])
        lower.set(
            xlabel="travel along the path of contact from A [mm]",
            ylabel="Hertz pressure [GPa]",
            ylim=(0, None),
        )
        _mark((upper, lower), marks)
    return drawn


def families(stages: Mapping[str, FilmStage], start: float) -> Figure:
    """Draw films of several scenes: through the contact at C on the left, along the path on the right.

    Parameters
    ----------
    stages : mapping
        Label to the films of a scene.
    start : float
        Curvature radius of the pinion's flank at A [m].
    """
    with styled():
        drawn = figure(7.6, 4.4)
        (pressure, hertz), (thickness, along) = drawn.subplots(2, 2)
        for (label, stage), colour, dash in zip(stages.items(), COLOURS, DASHES, strict=False):
            look = {"color": colour, "linestyle": dash}
            film = stage.profiles["C"]
            x = film.x / film.contact.half_width
            pressure.plot(x, 1e-9 * film.pressure, label=label, **look)
            thickness.plot(x, 1e6 * film.thickness, **look)
            travel = 1e3 * (stage.rho1 - start)
            hertz.plot(travel, 1e-9 * stage.hertz_pressure, **look)
            along.plot(travel, 1e6 * stage.minimum, **look)
        legend_above(drawn, pressure)
        thickest = max(stage.profiles["C"].central_thickness for stage in stages.values())
        pressure.set(ylabel="pressure at C [GPa]", xlim=(-1.5, 1.2), ylim=(0, None))
        thickness.set(ylabel="film at C [µm]", xlim=(-1.5, 1.2), ylim=(0, 2e6 * thickest))
        thickness.set(xlabel="distance from the middle [half-widths]")
        hertz.set(ylabel="Hertz pressure [GPa]", ylim=(0, None))
        along.set(xlabel="travel along the path from A [mm]", ylabel="least film [µm]", ylim=(0, None))
    return drawn


def shares_along_path(position: Array, shares: Mapping[str, Array], marks: Mapping[str, float]) -> Figure:
    """Draw numbers without unit against the travel of a pair from A, one panel each.

    Parameters
    ----------
    position : ndarray, shape (n,)
        Travel from A [m], rising.
    shares : mapping
        What a panel shows to its values, shape (n,).
    marks : mapping
        Name of a point of the path to its travel from A [m].
    """
    with styled():
        drawn = figure(height=0.6 + 1.5 * len(shares))
        panels = drawn.subplots(len(shares), 1, sharex=True, squeeze=False).ravel().tolist()
        for axes, (name, values), colour in zip(panels, shares.items(), COLOURS, strict=False):
            axes.plot(1e3 * position, values, color=colour)
            axes.set(ylabel=name.replace(" over ", "\nover ").replace(" of ", "\nof "), ylim=(0, None))
        panels[-1].set(xlabel="travel along the path of contact from A [mm]")
        _mark(panels, marks)
    return drawn


def stiffness_changes(cycles: Sequence[MeshStiffness], dry: MeshStiffness) -> Figure:
    """Draw the tangent stiffness of a mesh with films, and below what each changes the dry one by."""
    with styled():
        drawn = figure(height=4.4)
        upper, lower = drawn.subplots(2, 1, sharex=True)
        for cycle, colour, dash in zip((*cycles, dry), COLOURS, DASHES, strict=False):
            upper.plot(cycle.phase, 1e-9 * cycle.tangent, color=colour, linestyle=dash, label=cycle.label)
            if cycle is not dry:
                change = 100 * (cycle.tangent / dry.tangent - 1)
                lower.plot(cycle.phase, change, color=colour, linestyle=dash)
        upper.set(ylabel="tangent stiffness [N/nm]", ylim=(0, None))
        lower.set(xlabel="travel after a pair is at A [base pitches]", ylabel="change by the film [%]")
        legend_above(drawn, upper, columns=2)
    return drawn


def _mark(panels: Sequence[Axes], marks: Mapping[str, float]) -> None:
    """Mark points of the path in all panels, named in the last."""
    for axes in panels:
        for at in marks.values():
            axes.axvline(1e3 * at, color="#999999", linewidth=0.8)
    for name, at in marks.items():
        panels[-1].annotate(
            name,
            (1e3 * at, 0.04),
            xycoords=("data", "axes fraction"),
            xytext=(3, 0),
            textcoords="offset points",
        )


def film_profiles(films: Mapping[str, Film]) -> Figure:
    """Draw pressure and film thickness through the contact, one curve for each labelled film."""
    with styled():
        drawn = figure(height=4.4)
        upper, lower = drawn.subplots(2, 1, sharex=True)
        for (label, film), colour, dash in zip(films.items(), COLOURS, DASHES, strict=False):
            x = film.x / film.contact.half_width
            upper.plot(x, 1e-9 * film.pressure, color=colour, linestyle=dash, label=label)
            lower.plot(x, 1e6 * film.thickness, color=colour, linestyle=dash)
        upper.set(ylabel="pressure [GPa]")
        legend_above(drawn, upper, columns=5)
        thickest = max(film.central_thickness for film in films.values())
        lower.set(xlabel="distance from the line of centres [half-widths]", ylabel="film thickness [µm]")
        lower.set(xlim=(-2.0, 1.5), ylim=(0, 3e6 * thickest))
    return drawn
