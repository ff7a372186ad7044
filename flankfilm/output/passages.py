"""Root stress as a tooth of one gear has it: while it passes through the mesh, and along its fillets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, quantity, record

if TYPE_CHECKING:
    from fem.tooth_root import GearRootStress

__all__ = ["FilletStress", "Passage", "fillet_stress", "passage"]


@record
class Passage:
    """One tooth on its way through the mesh: an entry for each instant."""

    travel: Array = quantity("1", "travel since the tooth's pair was at A, in base pitches", "instant")
    tension: Array = quantity(
        "Pa", "largest principal stress along the fillet under the loaded flank", "instant", shown="MPa"
    )
    tension_tangent: Array = quantity(
        "rad", "where: angle of the fillet's tangent to the tooth's centre line", "instant", shown="deg"
    )
    compression: Array = quantity(
        "Pa", "least principal stress along the other fillet", "instant", shown="MPa"
    )
    compression_tangent: Array = quantity(
        "rad", "where: angle of the fillet's tangent to the tooth's centre line", "instant", shown="deg"
    )


@record
class FilletStress:
    """Along the fillets of a tooth: stress at the worst instants, amplitude and mean of a passage."""

    arc: Array = quantity("m", "arc length from the middle of the gap", "arc", shown="mm")
    tangent: Array = quantity(
        "rad", "angle of the fillet's tangent to the tooth's centre line", "arc", shown="deg"
    )
    loaded_side: Array = quantity(
        "Pa", "stress under the loaded flank at the instant of the greatest tension", "arc", shown="MPa"
    )
    other_side: Array = quantity(
        "Pa", "stress on the other side at the instant of the greatest compression", "arc", shown="MPa"
    )
    loaded_side_amplitude: Array = quantity(
        "Pa", "amplitude of the stress under the loaded flank over a passage", "arc", shown="MPa"
    )
    loaded_side_mean: Array = quantity(
        "Pa", "mean of the stress under the loaded flank over a passage", "arc", shown="MPa"
    )


def passage(gear: GearRootStress) -> Passage:
    """Follow one tooth through the mesh."""
    order = np.argsort(gear.tooth_position, axis=None, kind="stable")

    def tangent(arc: Array) -> Array:
        return np.asarray(np.interp(arc.ravel()[order], gear.line.arc, gear.line.tangent_angle))

    return Passage(
        travel=gear.tooth_position.ravel()[order],
        tension=gear.tension_Pa.ravel()[order],
        tension_tangent=tangent(gear.tension_arc),
        compression=gear.compression_Pa.ravel()[order],
        compression_tangent=tangent(gear.compression_arc),
    )


def fillet_stress(gear: GearRootStress) -> FilletStress:
    """Look along the fillets at the worst instants, and over a passage."""
    tension, compression = gear.greatest_tension, gear.greatest_compression
    at = {peak: int(np.flatnonzero(gear.tooth == peak.tooth)[0]) for peak in (tension, compression)}
    amplitude, mean = gear.fatigue()
    return FilletStress(
        arc=gear.line.arc,
        tangent=gear.line.tangent_angle,
        loaded_side=gear.tangential_Pa[tension.row, at[tension], 0],
        other_side=gear.tangential_Pa[compression.row, at[compression], 1],
        loaded_side_amplitude=amplitude[0],
        loaded_side_mean=mean[0],
    )
