"""The commonest mistake with a helix: a transverse module given for the normal one, and what gives it away."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry

__all__ = ["fitting_normal_module", "transverse_module_warning"]

# fmt: off
ISO_54 = (
    1.0, 1.125, 1.25, 1.375, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 8.0, 9.0,
    10.0, 11.0, 12.0, 14.0, 16.0, 18.0, 20.0, 22.0, 25.0, 28.0, 32.0, 36.0, 40.0, 45.0, 50.0,
)
# fmt: on
"""Normal modules of ISO 54:1996, both series [mm]."""

PRINTED = 1e-4
"""Relative rounding of a transverse module as drawings print it."""

FITS = 0.02
"""Backlash [modules] up to which a pair fits its centre distance."""


def _standard(module: float) -> float | None:
    """Module of ISO 54 that a module [m] is but for rounding, in mm."""
    return next((size for size in ISO_54 if abs(1e3 * module - size) <= PRINTED * size), None)


def transverse_module_warning(pair: PairGeometry) -> str | None:
    """Remark on a module that is none of ISO 54 where it is one in the normal section, times cos(beta)."""
    normal = _standard(pair.module * pair.helix.cosine)
    if normal is None or _standard(pair.module) is not None:
        return None
    return (
        f"module: {1e3 * pair.module:.6g} mm is no module of ISO 54, but times cos(helix_angle) it is {normal:g} mm, "
        f"which is one: module is that of the normal section, so give {1e-3 * normal:g} m if this is the transverse one"
    )


def fitting_normal_module(pair: PairGeometry) -> str:
    """Remedy of a pair that jams, but fits its centre distance where its module is taken for the transverse one.

    Empty where it does not: without helix, or where nominal teeth of m_n = m cos(beta) would jam too or have more than
    0.02 modules of backlash.
    """
    normal = pair.module * pair.helix.cosine
    if pair.centre_distance is None or normal == pair.module:
        return ""
    meant = dataclasses.replace(_geometry(pair), module=normal)
    play = pair.centre_distance - meant.centre_distance_of_backlash(0.0)
    if pair.centre_distance <= sum(meant.base_radii) or not abs(play) <= FITS * normal:
        return ""
    return (
        f"; the gears fit if their module is the transverse one: module is that of the normal section, give "
        f"m_t cos(helix_angle) = {normal:.6g} m"
    )


def _geometry(pair: PairGeometry) -> PairGeometry:
    """Sizes of a pair, which need not be able to mesh."""
    from gears.pair.pair_geometry import PairGeometry

    return PairGeometry(**{field.name: getattr(pair, field.name) for field in dataclasses.fields(pair)})
