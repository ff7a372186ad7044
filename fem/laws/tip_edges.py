"""Contacts of tip edges beyond the path, in a section: where, with which gap and lever; tables for lines of contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.laws.edges_of_lines import EdgesOfLines
from fem.laws.tip_geometry import chamfer_gap, lever_ratio, opening, tangent_arm, unloaded_gap

if TYPE_CHECKING:
    from fem.laws.flank_forms import FlankForms

__all__ = ["EdgesAt", "edges_at", "edges_of_lines"]

STEPS = 256
"""Steps of the tables beyond either end: gaps grow as squares, so that straight lines err by 4e-6 of the last one."""


@record
class EdgesAt:
    """Contacts of one gear's tip: where the other flank is touched; lever, arm and leaning of the force, gap."""

    touched_rho: Array
    lever: Array
    arm: Array
    leaning: Array
    gap: Array
    chamfered: Booleans


def edges_at(flanks: FlankForms, corner: int, place: Array) -> EdgesAt:
    """Contacts of a gear's tip edge, without load.

    Parameters
    ----------
    flanks : FlankForms
    corner : {0, 1}
        The gear with the edge: the wheel (1) before A, the pinion (0) after E.
    place : (n,) array
        rho1 of the unlimited involutes [m].
    """
    from fem.laws.tip_contact import nearest_gap  # which loads finite elements: a check has no use for them

    pair, rounding = flanks.pair, flanks.rounds[corner]
    radii = pair.base_radii if corner == 1 else pair.base_radii[::-1]
    touched = place if corner == 1 else pair.line_of_action - place
    _, touched_rho = unloaded_gap(radii, pair.line_of_action, touched, np.array([rounding.rho]))
    place_of_tip = touched_rho[:, 0]
    lever = lever_ratio(pair, place_of_tip, place, corner)
    arm = tangent_arm(radii[1], np.asarray(rounding.rho), lever)
    angle = opening(radii, pair.line_of_action, touched, touched_rho, np.array([rounding.rho]))[:, 0]
    plain = nearest_gap(pair, corner, place, rounding)
    removed = flanks.removed
    gap = plain if removed is None else nearest_gap(pair, corner, place, rounding, removed)
    # turns of the pinion close the gap by the pinion's lever: r_b1 for its own flank
    gap = gap / lever if corner == 0 else gap
    reaches = (place_of_tip <= flanks.rounds[1 - corner].rho) & (lever > 0)
    beyond = chamfer_gap(pair, corner, touched, rounding.start)
    chamfered = np.isfinite(beyond) & (beyond < plain)
    return EdgesAt(place_of_tip, lever, arm, angle, np.where(reaches, gap, np.inf), chamfered)


def edges_of_lines(flanks: FlankForms, ends: tuple[float, float], reach: float) -> EdgesOfLines:
    """Tip edges of a helical pair as far beyond the path as lines are looked for.

    Parameters
    ----------
    flanks : FlankForms
        Of a helical pair; its roundings are those of the section.
    ends : (float, float)
        Places at which flanks give way to edges [m]: those of the path but for relief.
    reach : float
        Base pitches beyond these.
    """
    (start, end), removed = ends, flanks.removed
    away = np.linspace(0.0, reach * flanks.pair.base_pitch, STEPS + 1)
    tables = []
    for corner, place in ((1, start - away), (0, end + away)):
        at = edges_at(flanks, corner, place)
        gap = at.gap
        if removed is not None:
            gap = gap - removed[corner](np.array([flanks.rounds[corner].rho]))
            gap = gap - removed[1 - corner](at.touched_rho)
        # where the tip passes over the other one, nothing is touched
        last = int(np.argmin(np.append(np.isfinite(gap), False))) - 1
        known, number = np.linspace(0.0, last, STEPS + 1), np.arange(STEPS + 1.0)
        columns = away, np.where(np.isfinite(gap), gap, 0.0), at.touched_rho, at.lever
        tables.append([np.interp(known, number, values) for values in columns])
    return EdgesOfLines(flanks.ends, ends, *(np.stack(values) for values in zip(*tables, strict=True)))
