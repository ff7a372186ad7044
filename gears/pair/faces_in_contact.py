"""Guards of faces that are unequally wide or set off against each other: what is in contact is what both have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import rounded_down, rounded_up

if TYPE_CHECKING:
    from gears.pair.mesh_checks import Findings
    from gears.pair.pair_geometry import PairGeometry

__all__ = ["check_faces"]

ROUNDING = 1e-9
"""Part of the face width by which faces may miss each other by rounding."""


def check_faces(findings: Findings, pair: PairGeometry) -> None:
    """Note a gear that does not cover the face in contact, and a face in contact that is less than both gears have."""
    half, rounding = 0.5 * pair.face_width, ROUNDING * pair.face_width
    names, widths, offsets = ("pinion", "wheel"), pair.face_widths, pair.face_offsets
    sound = True
    for name, width, offset in zip(names, widths, offsets, strict=True):
        least = 2.0 * (half + abs(offset))
        if width < least - rounding:
            sound = False
            remedy = "every gear covers the face in contact, the pair's face_width"
            if offset:
                remedy += ": set it off less, or make the gear wider"
            findings.add(
                f"{name}.face_width",
                f"{width:g}",
                f"must be at least {rounded_up(least * (1.0 - ROUNDING))} m",
                remedy,
            )
    if not sound:
        return
    low = max(offset - 0.5 * width for width, offset in zip(widths, offsets, strict=True))
    high = min(offset + 0.5 * width for width, offset in zip(widths, offsets, strict=True))
    if low < -half - rounding or high > half + rounding:
        allowed = f"must be {rounded_down((high - low) * (1.0 + ROUNDING))} m, the face that both gears have"
        middle = 0.5 * (low + high)
        remedy = "give that"
        if abs(middle) > rounding:
            away = " and ".join(
                f"{offset - middle:.6g} m of the {n}" for n, offset in zip(names, offsets, strict=True)
            )
            remedy += f" and face_offset from its middle, {away}"
        findings.add("face_width", f"{pair.face_width:g}", allowed, remedy)
