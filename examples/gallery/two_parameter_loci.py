"""Where a pair jumps, loses contact and doubles its period, over speed and load."""

from __future__ import annotations

from matplotlib.figure import Figure
from page import MARK, looks, picture, sheet

from dynamics import FourierStiffness, GearOscillator, continue_branch, continue_locus, find_orbits

BOUNDS = ((0.4, 1.2), (0.02, 0.4))  # of mesh frequency and mean force
NAMES = {
    "saddle-node": "jump (saddle node)",
    "grazing": "touch (grazing)",
    "period-doubling": "period doubling",
}


def draw() -> Figure:
    """Loci of all special points of the motions of period one, in mesh frequency and mean force."""
    pair = GearOscillator(
        stiffness=FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)),
        damping_ratio=0.05,
        mean_force=0.1,
        error_amplitude=0.2,
        frequency=0.64,
        half_backlash=0.2,
    )
    start = next(orbit for orbit in find_orbits(pair, (1,)).orbits if orbit.stable)
    branch = continue_branch(start, "frequency", BOUNDS[0])
    with sheet(height=4.4, legend=3) as (drawn, (axes,)):
        style, cusps = dict(zip(NAMES, looks(3), strict=True)), set()
        for kind, name in NAMES.items():
            for k, point in enumerate(branch.special(kind)):
                locus = continue_locus(pair, point, ("frequency", "mean_force"), BOUNDS)
                axes.plot(*locus.values.T, label=None if k else name, **style[kind])
                cusps |= {tuple(cusp_point.values.round(9)) for cusp_point in locus.special("cusp")}
                print(
                    f"{kind} of {point.label}, at mean force {pair.mean_force:g}: frequency {point.parameter:.6f}"
                )
        for k, cusp in enumerate(cusps):
            print(f"cusp at frequency {cusp[0]:.6f}, mean force {cusp[1]:.6f}")
            axes.plot(*cusp, "ko", markersize=5, label=None if k else "cusp")
        axes.axhline(pair.mean_force, color=MARK, linewidth=0.9, label="where they were found")
        axes.set(xlim=BOUNDS[0], ylim=(0.0, BOUNDS[1][1]))
        axes.set(xlabel="mesh frequency over the natural one [-]", ylabel="mean force [-]")
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
