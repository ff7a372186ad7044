"""Root stress of a passing tooth, mesh stiffness over torque, transmission error over a revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flankfilm.figures.reading import need, read
from flankfilm.figures.style import Style, colours, figure, from_zero, legend_above, looks, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def root_stress(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw tension and compression at the roots of one tooth of each gear while it passes through the mesh.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``root-stress``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "root-stress"', "root_pinion_tension", "root_wheel_tension")
    with styled(style):
        drawn = figure(height=3.6)
        axes = drawn.subplots()
        for i, (name, colour) in enumerate(zip(("pinion", "wheel"), colours(2), strict=True)):
            travel = read(results, f"root_{name}_travel")
            for what, dash in (("tension", "-"), ("compression", "--")):
                stress = read(results, f"root_{name}_{what}")
                axes.plot(travel.values, stress.values, color=colour, linestyle=dash, label=f"{name}, {what}")
            if "iso6336_3_stresses" in results:
                nominal = float(read(results, "iso6336_3_stresses").values[i])
                axes.axhline(nominal, color=colour, linestyle=":", label=f"{name}, ISO 6336-3 at D")
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set(xlabel=travel.label, ylabel=stress.named("stress along the fillet"))
        legend_above(drawn, axes)
    return drawn


def over_torque(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw mean stiffness, and transmission error, over the pinion's torque.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``torques``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    names = {"secant": "torque_secant_stiffness", "tangent": "torque_stiffness"}
    need(results, 'run a scene that wants "torques"', *names.values(), "pair_face_width")
    torque, error = read(results, "torque"), read(results, "torque_transmission_error")
    with styled(style):
        drawn = figure(height=2.8)
        left, right = drawn.subplots(1, 2)
        for (kind, name), look in zip(names.items(), looks(2), strict=True):
            k = read(results, name, per_face=True)
            left.plot(torque.values, k.values, marker=".", label=kind, **look)
        left.set(xlabel=torque.label, ylabel=k.named("mean stiffness"))
        right.plot(torque.values, error.values, ".-", color=colours(1)[0])
        right.set(xlabel=torque.label, ylabel=error.label)
        from_zero(right)
        legend_above(drawn, left)
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
    curves = {
        "under load": "revolution_transmission_error",
        "without load": "revolution_unloaded_transmission_error",
    }
    need(results, 'run a scene that wants "revolution"', *curves.values())
    position = read(results, "revolution_position")
    with styled(style):
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        for (label, name), colour in zip(curves.items(), colours(2), strict=True):
            error = read(results, name)
            axes.plot(position.values, error.values, color=colour, linewidth=0.9, label=label)
        axes.set(xlabel=position.label, ylabel=error.named("transmission error"))
        legend_above(drawn, axes)
    return drawn
