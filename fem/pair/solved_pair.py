"""Both gears of a pair as they have been solved, and what is solved when it is first asked for."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeVar

import numpy as np

from base import Cost, part, quantity, record
from base.results import ITSELF
from fem.elasticity.ring import Ring
from fem.elasticity.support import FIXED, Support, held_profiles
from fem.influence.back_compliance import BackCompliance
from fem.influence.flank_motion import FIT, FlankMotion
from fem.influence.gear_compliance import GearCompliance
from fem.influence.gear_shape import COARSE, FINE, MeshedShape, MeshLevel, shapes
from fem.influence.gear_store import GearStore, InModules, sized
from fem.influence.tip_strips import TipStrips

if TYPE_CHECKING:
    from collections.abc import Callable

    from gears import GearPair
    from meshes import Sizes

__all__ = ["SolvedPair"]

PLACES = 60
"""Places of a flank at which its smallest compliance is looked for."""

S = TypeVar("S")


@record
class SolvedPair:
    """Flanks, tip edges, motions and back flanks of both gears, on the mesh in use and on the one before."""

    no_error = "not estimated: what a deflection is made of, whose error is `error`"

    headline: ClassVar[tuple[str, ...]] = ("plane", "refinements")

    pair: GearPair = part("the gears")
    plane: str = part('"strain" or "stress"')
    pinion: GearCompliance = part("of the pinion, held at the bore or hub")
    wheel: GearCompliance = part("of the wheel, likewise")
    refinements: int = quantity("1", "refinements of the mesh in use")
    sizes: Sizes = part("of the mesh before it was refined")
    reach: int = quantity("1", "neighbours with cross terms on either side of a tooth")
    coarse_flanks: tuple[GearCompliance, GearCompliance] = part(
        "of pinion and wheel on the mesh before the last refinement"
    )
    coarse_backs: tuple[BackCompliance, BackCompliance] = part(
        "what loads on front flanks do to back flanks, on the mesh before the last refinement"
    )
    error: float = quantity("1", "estimated relative error of a pair's deflection, largest along the path")
    cost: Cost
    converged: bool
    message: str
    supports: tuple[Support, Support] = part("how the bores of both are held", default=(FIXED, FIXED))
    tip_strips: tuple[TipStrips, TipStrips] | None = part(
        "tip edges of both gears, where they have been solved already", default=None
    )
    coarse_tip_strips: tuple[TipStrips, TipStrips] | None = part(
        "the same on the mesh before the last refinement", default=None
    )
    flank_motions: tuple[FlankMotion, FlankMotion] | None = part(
        "how the flanks of both gears move, where that has been solved already", default=None
    )
    fit_error: float = quantity(
        "1", "part of the error by the fit along the flanks", no_error=ITSELF, default=0.0
    )
    gain: float = quantity(
        "1", "by how much the last refinement reduced the mesh's error", no_error=ITSELF, default=1.0
    )
    doubt: str = part(
        'what the flanks\' motion and the back flanks are off by: "fit", what their series leave out, or "width", what '
        "the pressure's decides of the motion; empty where they are as solved",
        default="",
    )
    level: MeshLevel = part('mesh that flanks and tip edges are of: "fine" or "coarse"', default=FINE)

    def __getstate__(self) -> dict[str, Any]:
        """Leave the factorised gears behind: they are large, and a factorisation cannot travel."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def meshed(self) -> tuple[MeshedShape, MeshedShape]:
        """Shapes of both gears in modules, and their meshes: what solved gears are kept by."""
        profiles = held_profiles(self.pair, self.supports)
        first, second = shapes(self.pair, profiles, self.plane)
        return (
            MeshedShape(first, self.sizes, self.refinements),
            MeshedShape(second, self.sizes, self.refinements),
        )

    @cached_property
    def tips(self) -> tuple[TipStrips, TipStrips]:
        """Tip edges of both gears, for contact outside the path; solved where they were not.

        Those of the coarser mesh are what `coarser` needs: far from the corner over the length of the element there
        they are as solved, for loads on the flank and on the edge are the same tooth's, and what is wrong of both evens
        out where the load goes from one to the other. Nearer, a refinement gains less than ``gain``, and the difference
        is enlarged by as much.
        """
        fine_tips = self.tip_strips or self.tips_of(GearStore(), FINE)
        if self.level == FINE:
            return fine_tips
        coarse_tips = self.coarse_tip_strips or self.tips_of(GearStore(), COARSE)
        edge = self.sizes.corner * 0.5**self.refinements * self.pair.module
        first, second = (
            fine.towards(coarse, edge, self.gain) for fine, coarse in zip(fine_tips, coarse_tips, strict=True)
        )
        return first, second

    def tips_of(self, gears: GearStore, level: MeshLevel) -> tuple[TipStrips, TipStrips]:
        """Tip edges of both gears on one of the meshes, from where solved gears are."""
        return self._sized(lambda meshed: gears.tips(meshed, level))

    @cached_property
    def motions(self) -> tuple[FlankMotion, FlankMotion]:
        """How the flanks of both gears move beyond yielding along their normals; solved where it was not."""
        first, second = self.flank_motions or self.motions_of(GearStore())
        return (first.off_by(self.doubt), second.off_by(self.doubt)) if self.doubt else (first, second)

    def motions_of(self, gears: GearStore) -> tuple[FlankMotion, FlankMotion]:
        """How the flanks of both gears move, from where solved gears are."""
        return self._sized(gears.motion)

    @cached_property
    def back_flanks(self) -> tuple[BackCompliance, BackCompliance]:
        """What loads on the front flanks of both gears do to their back flanks; solved when it is first asked for."""
        if self.level == COARSE:
            return self.coarse_backs
        first, second = self._sized(GearStore().backs)
        return (first.off(), second.off()) if self.doubt == FIT else (first, second)

    @property
    def back_error(self) -> float:
        """What their fits leave out, relative to the smallest deflection of a pair without the local indentation."""
        least = sum(
            float(np.min(gear.own(np.linspace(*gear.rho_range, PLACES))))
            for gear in (self.pinion, self.wheel)
        )
        return sum(backs.error for backs in self.back_flanks) / least

    def rings(self) -> tuple[Ring, Ring]:
        """Meshed and factorised gears: those that this process still has, or computed anew from the same sizes."""
        return self._rings

    @cached_property
    def _rings(self) -> tuple[Ring, Ring]:
        first, second = (
            GearStore().rings(meshed)[FINE].scaled(self.pair.module, flexible.law)  # too large to be kept
            for meshed, flexible in zip(self.meshed, (self.pinion, self.wheel), strict=True)
        )
        return first, second

    def _sized(self, solved: Callable[[MeshedShape], InModules[S]]) -> tuple[S, S]:
        """Give what was solved of both gears in modules and E* their size and moduli."""
        first, second = (
            sized(solved(meshed), self.pair.module, flexible.law)
            for meshed, flexible in zip(self.meshed, (self.pinion, self.wheel), strict=True)
        )
        return first, second

    def doubtful(self, doubt: str) -> Self:
        """The same gears, motion or back flanks off by a doubt of them: what answers are compared with."""
        return replace(self, doubt=doubt)

    @cached_property
    def coarser(self) -> Self:
        """The same gears, off by their errors times the gain of the last refinement: what answers are compared with.

        By the mesh they differ as the one before that refinement does, by the fits as these leave out. Motion does not
        change: it is known on that mesh alone.
        """
        pinion, wheel = (
            coarse.off_by(fine, self.gain)
            for fine, coarse in zip((self.pinion, self.wheel), self.coarse_flanks, strict=True)
        )
        return replace(self, pinion=pinion, wheel=wheel, level=COARSE)
