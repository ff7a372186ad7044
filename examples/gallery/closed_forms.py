"""Closed forms of mesh stiffness against finite elements, the same pair under the same torque."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from page import legend_over, looks, picture, sheet

import flankfilm as ff
from gears import STEEL, Gear, GearPair

TORQUE, WIDTH = 600.0, 40e-3  # N m, m
PER_MM_UM = 1e-9 / WIDTH  # N/m to N/(mm um)


def draw() -> Figure:
    """Mesh stiffness over a base pitch, and how far the mean of each closed form is off."""
    pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=WIDTH, material=STEEL)
    comparison = ff.compare_closed_forms(pair, TORQUE, tolerance=0.002)
    # all of it, and the parts that closed forms have
    whole, like = comparison.references[0], comparison.like_for_like
    for name, reference in {"with all parts": whole, like.label: like}.items():
        mean = reference.figures["mesh, mean"]
        print(f"finite elements {name}: {mean.value:.2f} N/(mm um) ± {100 * mean.relative:.1g} %")
    off = {
        model.label: [
            100 * comparison.difference(model.label, reference.label) for reference in (whole, like)
        ]
        for model in comparison.models
    }
    for label, (all_in, alike) in off.items():
        print(f"{label}: {all_in:+.1f} %, against the same parts {alike:+.1f} %")

    with sheet(columns=2, height=3.8, legend=2, width_ratios=(1.5, 1)) as (drawn, (mesh, bars)):
        at = comparison.position
        mesh.plot(at, PER_MM_UM * whole.secant_stiffness, "k-", label="finite elements")
        mesh.plot(
            at, PER_MM_UM * like.secant_stiffness, "k--", linewidth=1.0, label=f"finite elements {like.label}"
        )
        models = [model for model in comparison.models if model.single_stiffness.size]  # ISO has a mean alone
        for model, look in zip(models, looks(len(models)), strict=True):
            mesh.plot(at, PER_MM_UM * model.secant_stiffness, label=model.label, **look)
        mesh.set(xlabel="position after A [base pitches]", ylabel="mesh stiffness [N/(mm µm)]")
        rows = np.arange(len(off))[::-1]
        for k, (name, colour) in enumerate({"all parts": "#000000", "the same parts": "#999999"}.items()):
            values = [pair[k] for pair in off.values()]
            drawn_bars = bars.barh(rows + 0.2 - 0.4 * k, values, 0.36, color=colour, label=name)
            bars.bar_label(drawn_bars, fmt="%+.1f", padding=2, fontsize=8)
        bars.axvline(0.0, color="#000000", linewidth=0.8)
        bars.set_yticks(rows, [label.replace(", ", ",\n") for label in off])
        bars.grid(False, axis="y")
        bars.set(xlabel="mean, against finite elements with ... [%]", xlim=(-38.0, 50.0))
        legend_over(bars, 2)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
