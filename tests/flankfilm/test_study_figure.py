"""The figure of a study: which varied keys make a family of curves, and in which order."""

from __future__ import annotations

import numpy as np
import xarray as xr

from flankfilm import figures

SHIFT, FOLLOWS, TORQUE = (
    "pair.pinion.profile_shift",
    "pair.wheel.profile_shift",
    "operating.pinion_torque_Nm",
)


def found(**coords: np.ndarray) -> xr.Dataset:
    named = {SHIFT: coords["shift"], **{k: v for k, v in coords.items() if k != "shift"}}
    rows = np.arange(len(coords["shift"]), dtype=float)
    return xr.Dataset(
        {"contact_ratio": ("row", rows, {"units": "1"})}, coords={k: ("row", v) for k, v in named.items()}
    )


def curves(dataset: xr.Dataset) -> list[tuple[str, int]]:
    """Label and points of each curve of the first panel."""
    (axes, *_) = figures.study(dataset).axes
    return [(str(line.get_label()), line.get_xdata().size) for line in axes.lines]


def test_a_key_that_follows_makes_no_family():
    shift = np.linspace(-0.3, 0.6, 10)
    ((_, points),) = curves(found(shift=shift, **{FOLLOWS: -shift}))
    assert points == 10


def test_a_family_stands_in_the_order_of_its_numbers():
    shift, torque = (a.ravel() for a in np.meshgrid([0.0, 0.2, 0.4], [8.0, 12.0, 100.0]))
    assert curves(found(shift=shift, **{TORQUE: torque})) == [("8", 3), ("12", 3), ("100", 3)]
