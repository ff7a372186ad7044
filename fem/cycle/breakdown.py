"""What the deflection of a mesh cycle is made of, part by part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from base import Array

if TYPE_CHECKING:
    from fem.cycle.result import MeshCycle
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["deflection_parts"]


def deflection_parts(cycle: MeshCycle, bodies: PairCompliance) -> Mapping[str, Array]:
    """Parts of the deflection against the bores at every position, which add up to it (n,) [m].

    For every loaded pair D = sum_j B_ij F_j + Hertz(F_i) + gap_i; weighted by the shares of the load these are as
    many parts of one D. Pinion and wheel: teeth, and bodies under them. Coupling: what the load of other teeth moves
    a tooth beyond the body's rotation, which is the wind-up. The rest holds gaps, tip edges, contacts that move and a
    film.

    Parameters
    ----------
    cycle : MeshCycle
    bodies : PairCompliance
        That it was computed with.

    Returns
    -------
    mapping of str to (n,) array
        ``hertz``, ``pinion``, ``wheel``, ``coupling``, ``windup``, ``support``, ``rest``.
    """
    pair, width = cycle.pair, bodies.pair.face_width
    whole = replace(bodies, left_out=frozenset())
    flanks = np.isfinite(cycle.rho1) & (cycle.forces > 0)
    moment = np.where(cycle.forces > 0, cycle.candidates.lever, 0.0) * cycle.forces
    weight = np.where(flanks, moment[0] / moment[0].sum(axis=-1, keepdims=True), 0.0)
    force = np.where(flanks, cycle.forces, 0.0)
    place = np.where(flanks, cycle.rho1, 0.5 * (pair.points.A + pair.points.E))
    turn, hubs = np.array(whole.hub_windup), sum(whole.support)
    apart = 1.0 - np.eye(force.shape[-1])
    cross = (whole.bulk(place) - turn.sum() - hubs) * apart
    own = (
        whole.pinion.own(place) / width - whole.plane_windup[0],
        whole.wheel.own(pair.line_of_action - place) / width - whole.plane_windup[1],
    )
    parts = {
        "hertz": np.sum(weight * whole.hertz(place).approach(force), axis=-1),
        "pinion": np.sum(weight * own[0] * force, axis=-1),
        "wheel": np.sum(weight * own[1] * force, axis=-1),
        "coupling": np.einsum("ni,nij,nj->n", weight, cross, force),
        "windup": turn @ moment.sum(axis=-1),
        "support": hubs * cycle.forces.sum(axis=-1),
    }
    whole_deflection = cycle.against("bore").transmission_error
    if cycle.flank == "back":
        whole_deflection = -(whole_deflection + pair.backlash)
    return MappingProxyType({**parts, "rest": whole_deflection - sum(parts.values())})
