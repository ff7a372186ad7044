"""Measured and worn flanks as variables: deviations over the profile, of each tooth and in the mean, and leads."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Quantity
from base.results import EXACT
from flankfilm.output.variables import figure_of, of_quantities
from gears.tooth.flank_curves import FlankCurve

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.building.flanks import Both
    from gears import GearDeviations, GearPair, LeadTrace

__all__ = ["measured_flanks"]

PLACES = 121
"""Places over the active profile, both ends included."""


def measured_flanks(pair: GearPair, deviations: Both | None) -> Iterator[xr.Dataset]:
    """Variables ``flank_pinion_...`` and ``flank_wheel_...`` of gears with measured or worn flanks."""
    ends = np.array([pair.points.A, pair.points.E])
    active = (ends, pair.line_of_action - ends[::-1])
    for name, radius, span, gear_deviations in zip(
        ("pinion", "wheel"), pair.base_radii, active, deviations or (None, None), strict=True
    ):
        if gear_deviations is not None and gear_deviations.curved:
            yield of_quantities(
                f"flank_{name}", _curves(gear_deviations, radius, np.linspace(span[0], span[1], PLACES))
            )
    for name, gear, width in zip(
        ("pinion", "wheel"), (pair.pinion, pair.wheel), pair.face_widths, strict=True
    ):
        if gear.lead.trace is not None:
            yield of_quantities(
                f"flank_{name}", _lead(gear.lead.trace, np.linspace(-0.5, 0.5, PLACES) * width)
            )


def _lead(trace: LeadTrace, z: Array) -> Iterator[Quantity]:
    yield figure_of(
        "face_place", "m", "place along the face, from its middle", "face", z, shown="mm", no_error=EXACT
    )
    yield figure_of(
        "lead", "m", "deviation from the straight lead", "face", trace.at(z), shown="um", no_error=EXACT
    )


def _curves(deviations: GearDeviations, base_radius: float, rho: Array) -> Iterator[Quantity]:
    yield figure_of(
        "diameter", "m", "diameter", "place", 2 * np.hypot(base_radius, rho), shown="mm", no_error=EXACT
    )
    mean = deviations.mean
    for name, meaning, curve, each in (
        ("material", "deviation from the involute", mean.profile, deviations.profile),
        ("wear", "depth of wear", mean.wear, deviations.wear),
    ):
        if not isinstance(curve, FlankCurve):
            continue
        yield figure_of(
            f"mean_{name}",
            "m",
            f"{meaning}, mean of all teeth",
            "place",
            curve.at(rho),
            shown="um",
            no_error=EXACT,
        )
        if isinstance(each, tuple):
            values = np.stack([tooth.at(rho) for tooth in each])
            yield figure_of(
                name, "m", f"{meaning}, of each tooth", "tooth place", values, shown="um", no_error=EXACT
            )
            yield figure_of(
                "tooth", "1", "tooth, in the order of meshing", "tooth", np.arange(len(each)), no_error=EXACT
            )
