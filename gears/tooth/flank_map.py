"""A measured map of a flank taken apart: a profile, a lead, and the rest, its twist, that neither has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults
from gears.tooth.flank_curves import LeadTrace, ProfileDeviation, check_finite, numbers
from gears.tooth.topography import Topography

__all__ = ["FlankMap", "flank_map"]


@dataclass(frozen=True)
class FlankMap:
    """Map of a flank in three parts: ``material(rho, z) = profile(rho) + lead(z) + rest(rho, z)``.

    Attributes
    ----------
    profile : ProfileDeviation
        Mean of the map over the face.
    lead : LeadTrace
        Mean over the profile, less the mean of the map.
    twist : float
        Largest deviation of the map from the sum of these two [m].
    rest : Topography
        That deviation: what `Lead` takes beside the lead.
    """

    profile: ProfileDeviation
    lead: LeadTrace
    twist: float
    rest: Topography


def flank_map(rho: ArrayLike, z: ArrayLike, material: ArrayLike, form: str = "smooth") -> FlankMap:
    r"""Take a measured map of a flank apart into a profile, a lead, and what neither has.

    Of all sums of a curve over the profile and one along the face the sum of the means is nearest to the map, by the
    mean square (two-way analysis of variance); means are integrals by trapezoids over rho and z.

    Parameters
    ----------
    rho : (n,) array
        Curvature radii of the flank, growing [m].
    z : (k,) array
        Places along the face, growing, 0 at the middle of the gear's own face [m].
    material : (n, k) array
        Material in excess of the straight involute flank, normal to it [m].
    form : {"smooth", "linear"}
        Of both curves, as of `ProfileDeviation`, and of the rest, as of `Topography`.

    Raises
    ------
    InputError
        With every fault of the map.

    Examples
    --------
    >>> found = flank_map([8e-3, 12e-3], [-0.02, 0.02], [[0.0, 4e-6], [-6e-6, -2e-6]])
    >>> found.profile.material
    (2e-06, -4e-06)
    >>> [f"{1e6 * height:.1f}" for height in found.lead.material]
    ['-2.0', '2.0']
    >>> found.twist < 1e-15
    True
    """
    radii, places = np.array(numbers(rho)), np.array(numbers(z))
    heights: Array = np.asarray(material, dtype=float)
    _check(radii, places, heights)
    over, along = _weights(radii), _weights(places)
    profile, mean = heights @ along, float(over @ heights @ along)
    lead = over @ heights - mean
    rest = heights - profile[:, None] - lead
    return FlankMap(
        ProfileDeviation(numbers(radii), numbers(profile), form),
        LeadTrace(numbers(places), numbers(lead), form),
        float(np.abs(rest).max()),
        Topography(numbers(radii), numbers(places), tuple(map(numbers, rest)), form),
    )


def _weights(places: Array) -> Array:
    """Of the mean by trapezoids."""
    widths = np.diff(places)
    return np.asarray(np.convolve(widths, [0.5, 0.5]) / widths.sum(), dtype=float)


def _check(radii: Array, places: Array, heights: Array) -> None:
    """Refuse a map that has not a value at each of growing places."""
    with Faults() as faults:
        for name, values in (("rho", radii), ("z", places)):
            if len(values) < 2 or not np.all(np.diff(values) > 0.0):
                faults.add(
                    name,
                    f"{len(values)} values",
                    "must be growing, at least 2",
                    "sort them; leave out doubles",
                )
        if heights.shape != (len(radii), len(places)):
            allowed = f"must have a row for each of {len(radii)} rho and a column for each of {len(places)} z"
            faults.add("material", f"{heights.shape}", allowed, "give the map as rows over the profile")
        else:
            check_finite(faults, "material", numbers(heights))
