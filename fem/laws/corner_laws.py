"""Laws of all contacts at and beside tip corners, kept for all positions, torques and meshes of an estimate."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans
from fem.influence.memo import Memo
from fem.laws.contact_candidates import REACHES
from fem.laws.corner_law import CornerSurface
from fem.laws.corner_surface import corner_surfaces, rolling_surface, slid, up_to
from fem.laws.local_law import PairLaws
from gears.tooth.face import STRAIGHT

if TYPE_CHECKING:
    from fem.laws.contact_candidates import ContactCandidates
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["CornerLaws", "forget_laws", "laws_of_corners"]


class CornerLaws:
    """Laws beside the tip corners of a pair.

    Parameters
    ----------
    setup : MeshSetup
        At any positions: what counts is how the gears are set up.
    bodies : PairCompliance
        On one of its meshes; the other one has separate laws (`serving`).
    """

    def __init__(self, setup: MeshSetup, bodies: PairCompliance) -> None:
        self.setup, self.bodies = setup, bodies
        self._kept: dict[tuple[int, bool], tuple[CornerSurface, CornerSurface]] = {}
        self._other: CornerLaws | None = None

    def serving(self, bodies: PairCompliance) -> CornerLaws:
        """Laws of the same pair on a mesh: these, or others that are kept here as well."""
        if bodies.level is self.bodies.level:
            return self
        if self._other is None:
            self._other = CornerLaws(self.setup, bodies)
        return self._other

    def at(
        self, candidates: ContactCandidates, moving: bool = False, tooth_apart: bool = False
    ) -> tuple[PairLaws, Array]:
        """Laws of all contacts, and the largest forces that they cover at tip edges [N].

        What strips slide is given back to contacts that are ``moving`` (``fem.laws.cut_off``). Laws of tip edges hold
        their tooth, unless that is ``tooth_apart``: on lines of contact the bodies' compliance has it.
        """
        edge, pair, bodies = candidates.edge, self.setup.pair, self.bodies
        middle = 0.5 * float(pair.points.A + pair.points.E)
        place, largest, corners = (
            np.where(candidates.touchable, candidates.place, middle),
            np.full(edge.shape, np.inf),
            [],
        )
        for corner, edges in self._corners(candidates):
            gear, line = (bodies.pinion, bodies.wheel)[corner], pair.line_of_action
            end = self.setup.rounds[corner].rho
            nominal = candidates.place if corner == 0 else line - candidates.place
            inside, outside = self._surfaces(corner, moving)
            near = candidates.touchable & ~edge & (nominal - end > inside.first)
            rounded = up_to(candidates.rho[corner][near], gear.rho_range[1], pair.module)[0]
            more = gear.own(rounded) - gear.own(candidates.rho[corner][near])
            apart = gear.own(candidates.rho[corner][edges]) if tooth_apart else gear.hub_windup
            held = gear.own(up_to(nominal[edges], gear.rho_range[1], pair.module)[0]) - apart
            on_flank = inside.held(near, nominal[near] - end, more / pair.face_width)
            corners.append(
                on_flank.with_others(outside.held(edges, nominal[edges] - end, held / pair.face_width))
            )
            largest[edges] = outside.covered(nominal[edges] - end)
            place[edges] = end if corner == 0 else line - end
        return PairLaws(bodies.hertz(place, candidates.curvature), tuple(corners)), largest[edge]

    def _corners(self, candidates: ContactCandidates) -> tuple[tuple[int, Booleans], ...]:
        """Tip edges in the model; lines of contact have theirs by cells (``ContactCandidates.on_cells``)."""
        return candidates.corners() if self.setup.beyond_path and candidates.lines is None else ()

    @cached_property
    def slid(self) -> tuple[float, float]:
        """What strips slide on the teeth of pinion and wheel, for contacts that move."""
        return slid(self.bodies)

    @cached_property
    def surfaces(self) -> tuple[CornerSurface, CornerSurface]:
        """Laws beside the corners of pinion and wheel in turns of the gear that is touched, for contacts that move."""
        first, second = (
            rolling_surface(self.setup, self.bodies, corner, REACHES[0], self.slid[corner])
            for corner in (0, 1)
        )
        return first, second

    def _surfaces(self, corner: int, moving: bool) -> tuple[CornerSurface, CornerSurface]:
        key = corner, moving
        if key not in self._kept:
            given_back = self.slid[corner] if moving else 0.0
            self._kept[key] = corner_surfaces(self.setup, self.bodies, corner, REACHES[-1], given_back)
        return self._kept[key]


_KEPT: Memo[CornerLaws] = Memo(4)


def laws_of_corners(setup: MeshSetup, bodies: PairCompliance) -> CornerLaws:
    """Laws of a pair set up likewise, with what loads before have left in them.

    Parameters
    ----------
    setup : MeshSetup
    bodies : PairCompliance
        Gears are known by their records, which are the very same ones for equal gears (``fem.influence.gear_store``).
    """
    key = setup.beyond_path, setup.rounds, _flanks(setup), _solved(bodies)
    return _KEPT.obtain(key, lambda: CornerLaws(setup, bodies))


def _flanks(setup: MeshSetup) -> tuple[Hashable, ...]:
    """What decides flanks at corners: not their lead, nor their place along the face, nor pitches of single teeth."""
    pair, curves = setup.pair, []
    for deviations in setup.flanks.by_gear:
        curves.append(None if deviations is None else (deviations.profile, deviations.wear))
    gears = (replace(gear, lead=STRAIGHT, face_offset=0.0) for gear in (pair.pinion, pair.wheel))
    sizes = pair.module, pair.face_width, pair.rack, pair.centre_distance, pair.helix_angle
    return (*gears, *sizes, *curves)


def _solved(bodies: PairCompliance) -> tuple[Hashable, ...]:
    """All that was solved of both gears and that laws are made of, on both meshes."""
    flanks = bodies.pinion, bodies.wheel, bodies.coarse_flanks
    beside = bodies.tip_strips, bodies.coarse_tip_strips, bodies.flank_motions
    return (*flanks, *beside, bodies.gain, bodies.level, bodies.doubt, bodies.left_out)


def forget_laws() -> None:
    """Forget all laws that are kept."""
    _KEPT.clear()
