"""From the traces of a measuring machine to the transmission error of a revolution, tooth by tooth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from page import legend_over, picture, sheet

import flankfilm as ff

EXAMPLES = Path(__file__).parents[1]
TRACES = EXAMPLES / "measured" / "pinion_traces.csv"


def draw() -> Figure:
    """Profile traces of the pinion's teeth, transmission error of its revolution, and the orders in it."""
    traces = np.loadtxt(TRACES, delimiter=",", skiprows=2)
    results = ff.run(EXAMPLES / "worn_flanks.toml").dataset
    position = results.revolution_position.values  # base pitches: teeth of the pinion
    loaded, free = (
        1e6 * results[f"revolution_{name}"].values
        for name in ("transmission_error", "unloaded_transmission_error")
    )
    teeth = traces.shape[1] - 1
    orders = {
        "300 N m": 2 * np.abs(np.fft.rfft(loaded)) / loaded.size,
        "without load": 2 * np.abs(np.fft.rfft(free)) / free.size,
    }
    print(f"{teeth} traces, {traces[:, 1:].min():.1f} to {traces[:, 1:].max():.1f} um")
    error = 100 * float(results.revolution_error)
    for name, curve in {"300 N m": loaded, "without load": free}.items():
        print(
            f"{name}: transmission error {np.ptp(curve):.2f} um peak to peak; order 1 {orders[name][1]:.2f} um, "
            f"order {teeth} {orders[name][teeth]:.2f} um"
        )
    print(f"numerical error of stiffness and transmission error ± {error:.1g} %")

    with sheet(rows=3, height=6.6, legend=0, sharex=False) as (drawn, (flanks, revolution, spectrum)):
        flanks.plot(traces[:, 0], traces[:, 1:], color="#999999", linestyle="-", linewidth=0.6)
        flanks.plot(traces[:, 0], traces[:, 1:].mean(axis=1), "k-", label="mean of the teeth")
        flanks.set(xlabel="diameter [mm]", ylabel="material in\nexcess [µm]")
        legend_over(flanks, 1)
        revolution.plot(position, loaded, linewidth=0.9, label="300 N m")
        revolution.plot(position, free, linewidth=0.9, label="without load")
        revolution.set(
            xlabel="turn of the pinion [teeth]", ylabel="transmission\nerror [µm]", xlim=(0, teeth)
        )
        legend_over(revolution, 2)
        for k, (name, size) in enumerate(orders.items()):
            at = np.arange(1, 2 * teeth + 3)
            spectrum.bar(at - 0.2 + 0.4 * k, size[at], 0.4, label=name, color=("#0072B2", "#D55E00")[k])
        spectrum.set(
            xlabel="order of the pinion's turn [-]", ylabel="amplitude [µm]", yscale="log", xlim=(0, 75)
        )
        legend_over(spectrum, 2)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
