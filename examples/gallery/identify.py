"""From a measured response to the parameters: events read off two speed sweeps, and the pair that has them.

The measurement is one of a simulated pair, so that it is known what should be found; its parameters are used nowhere
else.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from page import legend_over, looks, picture, sheet

from dynamics import FourierStiffness, GearOscillator, SweepResult, continue_branch, find_orbits, sweep
from dynamics.inverse import Event, Ranged, identify

BOUNDS = (0.4, 1.0)
UNKNOWN = {
    "damping_ratio": Ranged(0.02, 0.1),
    "stiffness.amplitudes[0]": Ranged(0.05, 0.4),
    "mean_force": Ranged(0.03, 0.3),
}


def oscillator(damping_ratio: float, amplitude: float, mean_force: float) -> GearOscillator:
    """Error amplitude and backlash are known, in units of one length; the natural frequency is 1."""
    stiffness = FourierStiffness(mean=1.0, amplitudes=(amplitude,), phases=(0.0,))
    return GearOscillator(stiffness, damping_ratio, mean_force, 0.2, BOUNDS[0], 0.2)


def change(measured: SweepResult, before: str, after: str = "") -> float:
    """Frequency at which one motion becomes another one as the frequency grows, read to three decimals."""
    pairs = list(zip(measured.labels[:-1], measured.labels[1:], strict=True))
    k = next(k for k, (label, other) in enumerate(pairs) if label == before != other and after in ("", other))
    return round(float(measured.values[k : k + 2].mean()), 3)


def draw() -> Figure:
    """Both sweeps, the events read off them, and the branch of the pair identified from these."""
    rig = oscillator(damping_ratio=0.0537, amplitude=0.173, mean_force=0.0921)
    rising, falling = (
        sweep(rig, "frequency", np.arange(*BOUNDS, 0.0005), direction=way) for way in ("up", "down")
    )
    events = [
        Event("grazing", "1-0-0", change(rising, "1-0-0", "1-1-0"), digits=3),
        Event("period-doubling", "1-1-0", change(rising, "1-1-0", "2-2-0"), digits=3),
        Event("period-doubling", "1-1-0", change(rising, "2-2-0", "1-1-0"), digits=3),
        Event("saddle-node", "1-1-0", change(rising, "1-1-0", "1-1-1"), digits=3),
        Event("saddle-node", "1-1-1", change(rising, "1-1-1"), digits=3),
        Event("saddle-node", "1-1-1", change(falling, "1-0-0", "1-1-1"), digits=3),
    ]
    identification = identify(oscillator(0.03, 0.1, 0.06), "frequency", events, UNKNOWN, BOUNDS)
    best = identification.best
    print(
        f"{len(best.matched)} of {len(events)} events matched, {identification.by_chance:.1g} such trials by chance"
    )
    for name, value in best.values.items():
        print(f"{name}: {value:.4f} ± {best.spread[name]:.1g}, of the rig {rig.get(name):.4f}")

    start = next(orbit for orbit in find_orbits(best.oscillator, (1,)).orbits if orbit.stable)
    branch = continue_branch(start, "frequency", BOUNDS)
    with sheet(height=4.0, legend=0) as (drawn, (axes,)):
        for measured, size, look in zip((rising, falling), (4, 2), looks(2), strict=True):
            frequency = np.repeat(measured.values, measured.states.shape[1])
            way = {"markersize": size, "color": look["color"], "rasterized": True}
            axes.plot(
                frequency,
                measured.states[..., 0].ravel(),
                ".",
                label=f"measured, {measured.direction}",
                **way,
            )
        axes.plot(branch.values, branch.states[:, 0], "k-", linewidth=0.8, label="identified pair")
        for event in events:
            axes.axvline(event.value, color="#999999", linewidth=0.8)
        axes.set(
            xlabel="mesh frequency over the natural one [-]",
            ylabel="X at tau = 0 [-]",
            xlim=(0.5, 1.0),
            ylim=(-0.7, 1.0),
        )
        legend_over(axes, 3)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
