"""Friction on lines of contact: it acts across the line, in the section, and turns round where the line crosses C.

Flanks slide in the section alone, u1 - u2 = w1 a1 - w2 a2, with a_g the distance from the foot of either axis on the
common normal to the contact: rho_g of involutes. Friction is mu N there, with the lever a_g about either gear, beside
cos(beta_b) r_bg l_g of the normal force N. It has no part along the axes. Tip edges and relief turn the normal, which
changes a_g and l_g together, while sliding stays that of the involutes to the first order.
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


def rubbed_arms(pair: GearPair, place: Array, width: Array, arms: Array) -> Array:
    """Arms about both gears of an even friction on cells, above 0 after C and below it before (2, ...) [m].

    Means over each cell of sign(place - C) times the arm, which changes over it as that of involutes does.

    Parameters
    ----------
    pair : GearPair
    place : (...) array
        rho1 of the unlimited involutes in the middles of the cells [m].
    width : (...) array
        Of each cell along the path [m], above 0.
    arms : (2, ...) array
        In the middles, as of ``ContactLines.arms`` [m].
    """
    low, high = place - 0.5 * width, place + 0.5 * width
    turn = np.clip(pair.points.C, low, high)
    before = (turn - low) / width
    after = 1.0 - before
    first = 0.5 * (after * (turn + high) - before * (low + turn))
    of_involutes = np.stack([first, (after - before) * pair.line_of_action - first])
    turned = arms - np.stack([place, pair.line_of_action - place])
    return np.asarray(of_involutes + (after - before) * turned)


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
    place = lines.places(parts)
    width = abs(lines.slope) * parts.length[..., None]
    first, _ = rubbed_arms(pair, place, width, lines.arms(place, pair.base_radii))
    turning = -setup.friction if setup.back else setup.friction
    rubbing = np.asarray(turning * first / pair.base_radii[0])
    if lines.edges is None and lines.relieved is None:
        return rubbing
    return np.asarray(rubbing + pair.helix.base_cosine * (lines.levers(place)[0] - 1.0))
