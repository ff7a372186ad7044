"""A whole overlap ratio: what it leaves of the transmission error, by coupled solids and by slices of the teeth."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from page import from_zero, legend_over, looks, picture, sheet

import flankfilm as ff
from flankfilm.studies.execution import Execution
from gears import STEEL, Gear, GearPair, contact_lines

STUDY = Path(__file__).parents[1] / "studies" / "whole_overlap.toml"
PAIR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=radians(20.0), material=STEEL)
PER_WIDTH = 15.0  # N m for each mm of face
POSITIONS = (np.arange(200) + 0.5) / 200  # base pitches


def of_slices(width: float, mean: float) -> float:
    """Peak to peak of slices that do not know each other: as stiff as the lines are long, with the same mean."""
    length = contact_lines(replace(PAIR, face_width=width)).length(POSITIONS)
    return float(mean * np.ptp(length.mean() / length))


def draw() -> Figure:
    """Peak-to-peak transmission error over the overlap ratio, the torque in proportion to the face width."""
    with tempfile.TemporaryDirectory() as folder:
        ff.study(STUDY, folder, Execution(workers=1))
        with xr.open_dataset(Path(folder) / "study.nc", engine="h5netcdf") as study:
            study.load()
    width, overlap, error, uncertain, secant = (
        study[name].values.ravel()
        for name in (
            "pair.face_width_mm",
            "overlap_ratio",
            "transmission_error_um",
            "transmission_error_error",
            "mean_secant_stiffness_N_per_mm_um",
        )
    )
    deflection = PER_WIDTH / PAIR.base_radii[0] / secant  # um
    shown = np.linspace(0.45, 2.05, 161)
    slices = [
        of_slices(1e-3 * part, float(np.interp(part, width, deflection)))
        for part in (shown * 18.3708).tolist()
    ]
    for k in (0, 2, 4, 6):
        own = of_slices(1e-3 * width[k], deflection[k])
        print(
            f"overlap {overlap[k]:.1f}: {error[k]:.2f} um ± {100 * uncertain[k]:.2g} %, slices {own:.2f} um, "
            f"mean deflection {deflection[k]:.1f} um"
        )
    with sheet(height=3.6, legend=0) as (drawn, (axes,)):
        solids, sliced = looks(2)
        axes.plot(overlap, error, label="coupled solids with free ends", marker="o", **solids)
        axes.plot(shown, slices, label="slices", **sliced)
        axes.set(xlabel="overlap ratio [-]", ylabel="transmission error,\npeak to peak [µm]")
        from_zero(axes)
        legend_over(axes, 2)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
