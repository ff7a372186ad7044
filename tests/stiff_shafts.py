"""Shafts of tests that hardly give way: all over, or under their gears alone."""

from __future__ import annotations

from gears import Bearing, Material, Shaft, ShaftSegment

__all__ = ["ENDS", "STIFF", "stiffest_shafts", "tilting_shaft"]

ENDS = Bearing(0.005, 5e8), Bearing(0.195, 5e8)
"""Near the ends of a shaft that is 0.2 m long."""

STIFF = 10.0
"""Diameter of a step that does not bend by itself [m]."""


def stiffest_shafts() -> tuple[Shaft, Shaft]:
    """The stiffest shaft that there may be, and one of half that stiffness, by which its own give is known."""
    stiff, half = (
        Shaft(
            (ShaftSegment(0.2, STIFF),),
            (Bearing(0.0, size), Bearing(0.2, size)),
            0.1,
            0.0,
            Material(size, 0.3, 7850.0),
        )
        for size in (1e13, 5e12)
    )
    return stiff, half


def tilting_shaft(at: float, diameter: float = 0.025) -> Shaft:
    """Shaft that bends beside its gear but not under it.

    Parameters
    ----------
    at : float
        Place of the gear [m].
    diameter : float
        Beside it [m].
    """
    parts = (at - 0.015, diameter), (0.03, STIFF), (0.185 - at, diameter)
    return Shaft(tuple(ShaftSegment(*part) for part in parts), ENDS, at, 0.0)
