"""Friction on lines of contact: it acts across the line, in the section, and turns round where the line crosses C.

Flanks slide in the section alone, u1 - u2 = w1 rho1 - w2 rho2, so that friction is mu N there, with the lever rho_g
about either gear, beside cos(beta_b) r_bg of the normal force N. It has no part along the axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array

if TYPE_CHECKING:
    from fem.laws.line_candidates import ContactLines
    from fem.laws.mesh_setup import MeshSetup
    from gears import GearPair

__all__ = ["further_levers", "rubbed_arms"]


def rubbed_arms(pair: GearPair, rho1: Array, width: Array) -> Array:
    """Arms about both gears of an even friction on cells, above 0 after C and below it before (2, ...) [m].

    Means of sign(rho1 - C) rho_g over each cell.

    Parameters
    ----------
    pair : GearPair
    rho1 : (...) array
        Middles of the cells [m].
    width : (...) array
        Of each cell along the path [m], above 0.
    """
    low, high = rho1 - 0.5 * width, rho1 + 0.5 * width
    turn = np.clip(pair.points.C, low, high)
    before = (turn - low) / width
    after = 1.0 - before
    first = 0.5 * (after * (turn + high) - before * (low + turn))
    return np.stack([first, (after - before) * pair.line_of_action - first])


def further_levers(setup: MeshSetup, lines: ContactLines, cells: int) -> Array:
    """What friction, tip edges and relief add to levers about the pinion, over r_b1 (positions, pairs, cells).

    Parameters
    ----------
    setup : MeshSetup
        With its friction; on back flanks all surfaces move the other way.
    lines : ContactLines
    cells : int
        Of a line as long as the face.
    """
    parts, pair = lines.divided(cells), setup.pair
    first, _ = rubbed_arms(pair, parts.rho[0], abs(lines.slope) * parts.length[..., None])
    turning = -setup.friction if setup.back else setup.friction
    rubbing = np.asarray(turning * first / pair.base_radii[0])
    if lines.edges is None and lines.relieved is None:
        return rubbing
    return np.asarray(rubbing + pair.helix.base_cosine * (lines.levers(lines.places(parts))[0] - 1.0))
