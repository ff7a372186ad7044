"""Form of a pair's flanks in the section: rounded tips, and the material that relief and deviations take away."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.laws.tip_geometry import TipRound, tip_round
from fem.pair.options import Options

if TYPE_CHECKING:
    from fem.laws.tip_contact import Removed
    from gears import GearDeviations, GearPair

__all__ = ["Deviations", "FlankForms"]

Deviations = Sequence["GearDeviations | None"]


@dataclass(frozen=True, eq=False)
class FlankForms:
    """Flanks of pinion and wheel in the section, wherever the gears stand.

    Nothing is checked here (``MeshSetup.check``).
    """

    pair: GearPair
    deviations: Deviations | None
    tip_rounding: float | tuple[float, float]
    options: Options

    def same(self, other: FlankForms) -> bool:
        """Whether both are of the very same records."""
        own, others = (
            (each.pair, each.deviations, each.tip_rounding, each.options) for each in (self, other)
        )
        return all(mine is theirs for mine, theirs in zip(own, others, strict=True))

    @property
    def by_gear(self) -> tuple[GearDeviations | None, ...]:
        """Deviations, as many as were given."""
        if self.deviations is None:
            return (None, None)
        return tuple(self.deviations) if isinstance(self.deviations, Sequence) else ()

    @property
    def radii(self) -> tuple[float, ...]:
        """Of the rounded tip edges, as many as were given [m]."""
        radii = self.tip_rounding
        return tuple(radii) if isinstance(radii, Sequence) else (radii, radii)

    @cached_property
    def rounds(self) -> tuple[TipRound, TipRound]:
        """Roundings of pinion's and wheel's tip edges."""
        first, second = (
            tip_round(profile, float(r))
            for profile, r in zip(self.pair.teeth_profiles, self.radii, strict=True)
        )
        return first, second

    @property
    def ends(self) -> tuple[float, float]:
        """rho1 at which contact of the two involutes starts and ends [m]: A and E but for roundings."""
        first, second = self.rounds
        return self.pair.line_of_action - second.rho, first.rho

    @property
    def even(self) -> bool:
        """Whether the flanks of all teeth are true involutes at equal pitches."""
        plain = all(deviations is None or deviations.every_tooth_alike for deviations in self.by_gear)
        return plain and self.removed is None

    @property
    def teeth_alike(self) -> bool:
        """Whether all teeth of a gear have one profile."""
        return all(deviations is None or deviations.profiles_alike for deviations in self.by_gear)

    def kinks(self, gear: int) -> Array:
        """Curvature radii at which the slope of what a gear's flank lacks changes at once."""
        deviations, most = self.by_gear[gear], self.options.measured_points
        starts = self.starts_of_relief(gear)
        return np.concatenate([starts, [] if deviations is None else deviations.kinks(most)])

    def corners(self, gear: int) -> list[float]:
        """Curvature radii at which a gear's flank has corners: starts of relief, and of few measured points these."""
        deviations, most = self.by_gear[gear], self.options.measured_points
        starts = self.starts_of_relief(gear)
        return starts if deviations is None else starts + deviations.corners(most).tolist()

    def starts_of_relief(self, gear: int) -> list[float]:
        """Curvature radius at which a gear's tip relief starts; none without relief."""
        profile = self.pair.teeth_profiles[gear]
        return [] if profile.tip_relief is None else [profile.flank_rho[1] - profile.tip_relief.length]

    @property
    def removed(self) -> tuple[Removed, Removed] | None:
        """Material missing from pinion's and wheel's flank at curvature radii, mean of their teeth; None if none is."""
        profiles = self.pair.teeth_profiles
        curves = [deviations is not None and deviations.curved for deviations in self.by_gear]
        if not any(curves) and all(profile.tip_relief is None for profile in profiles):
            return None

        def missing(gear: int) -> Removed:
            deviations, relief = self.by_gear[gear], profiles[gear].relief
            if deviations is None or not curves[gear]:
                return relief
            return lambda rho: np.asarray(relief(rho) - deviations.excess(rho))

        return missing(0), missing(1)
