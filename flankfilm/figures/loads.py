"""Root stress of a passing tooth, mesh stiffness over torque, transmission error over a revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flankfilm.figures.reading import need, per_face
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
    need(results, 'run a scene that wants "root-stress"', "root_tension_Pa_pinion")
    with styled(style):
        drawn = figure(height=3.6)
        axes = drawn.subplots()
        for name, colour in zip(("pinion", "wheel"), colours(2), strict=True):
            way = results[f"root_way_base_pitches_{name}"].values
            for what, dash in (("tension", "-"), ("compression", "--")):
                stress = 1e-6 * results[f"root_{what}_Pa_{name}"].values
                axes.plot(way, stress, color=colour, linestyle=dash, label=f"{name}, {what}")
            if f"iso6336_3_sigma_F0_{name}" in results:
                nominal = 1e-6 * float(results[f"iso6336_3_sigma_F0_{name}"])
                axes.axhline(nominal, color=colour, linestyle=":", label=f"{name}, ISO 6336-3 at D")
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set(
            xlabel="travel since the tooth's pair was at A [base pitches]",
            ylabel="stress along the fillet [MPa]",
        )
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
    need(results, 'run a scene that wants "torques"', "torque_secant_stiffness", "face_width")
    torque, scale = results["torque"].values, per_face(results)
    with styled(style):
        drawn = figure(height=2.8)
        left, right = drawn.subplots(1, 2)
        for kind, look in zip(("secant", "tangent"), looks(2), strict=True):
            k = scale * results[f"torque_{kind}_stiffness"].values
            left.plot(torque, k, marker=".", label=kind, **look)
        left.set(xlabel="torque of the pinion [N m]", ylabel="mean stiffness [N/(mm µm)]")
        error = 1e6 * results["torque_transmission_error"].values
        right.plot(torque, error, ".-", color=colours(1)[0])
        right.set(
            xlabel="torque of the pinion [N m]",
            ylabel="transmission error,\npeak to peak [µm]",
        )
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
    need(results, 'run a scene that wants "revolution"', "revolution_transmission_error")
    with styled(style):
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        travel = results["revolution_travel"].values
        for (name, label), colour in zip(
            (("", "under load"), ("unloaded_", "without load")), colours(2), strict=True
        ):
            error = 1e6 * results[f"revolution_{name}transmission_error"].values
            axes.plot(travel, error, color=colour, linewidth=0.9, label=label)
        axes.set(
            xlabel="travel after the first pair is at A [base pitches]", ylabel="transmission error [µm]"
        )
        legend_above(drawn, axes)
    return drawn
