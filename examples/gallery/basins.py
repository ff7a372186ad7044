"""Which of the motions possible at one speed a pair reaches, by where it starts."""

from __future__ import annotations

from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from page import picture, sheet

from dynamics import FourierStiffness, GearOscillator, basins, find_orbits, manifold

SHADES = ("#9ecae1", "#fdd0a2", "#a1d99b", "#dadaeb")
BOX = ((-1.0, 1.0), (-1.0, 1.0))


def draw() -> Figure:
    """Basins of attraction, their attractors, and the stable manifold of the saddle that divides them."""
    pair = GearOscillator(
        stiffness=FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)),
        damping_ratio=0.05,
        mean_force=0.1,
        error_amplitude=0.2,
        frequency=0.64,
        half_backlash=0.2,
    )
    basin_map = basins(pair, x=(*BOX[0], 240), v=(*BOX[1], 240))
    saddles = [orbit for orbit in find_orbits(pair, (1,)).orbits if not orbit.stable]
    for attractor in basin_map.attractors:
        print(
            f"{attractor.label}: {100 * attractor.share:.1f} % ± {100 * attractor.share_error:.1g} % of the starts"
        )
    for saddle in saddles:
        print(f"saddle {saddle.label}: X = {saddle.state[0]:.5f}, V = {saddle.state[1]:.5f}")
    with sheet(width=6.0, height=4.6, legend=2) as (drawn, (axes,)):
        colours = ListedColormap(SHADES[: len(basin_map.attractors)])
        axes.pcolormesh(basin_map.x, basin_map.v, basin_map.labels.T, cmap=colours, rasterized=True)
        for attractor, shade in zip(basin_map.attractors, SHADES, strict=False):
            axes.plot(
                *attractor.states.T,
                "o",
                color=shade,
                markeredgecolor="k",
                markersize=7,
                label=attractor.label,
            )
        for saddle in saddles:
            border = manifold(saddle, "stable", BOX, length=60.0, max_points=6000)
            for k, curve in enumerate(border.curves):
                label = None if k else f"stable manifold of {saddle.label}"
                axes.plot(*curve.T, "k-", linewidth=0.6, label=label)
            axes.plot(*saddle.state, "kx", markersize=6, label=f"saddle {saddle.label}")
        axes.grid(False)
        axes.set(xlim=BOX[0], ylim=BOX[1], xlabel="X at tau = 0 [-]", ylabel="V at tau = 0 [-]")
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
