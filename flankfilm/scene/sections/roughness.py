"""Keys of rough flanks, and the roughness that they make."""

from __future__ import annotations

from typing import Annotated, Literal, TypedDict

from pydantic import Field, model_validator

import ehl
from base import Limit
from ehl.discrete.asperities import LIMITS as ROUGHNESS
from ehl.discrete.regimes import BOUNDARY, BOUNDARY_FRICTION
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Section, refused

_DRAWN = Limit(1e-9, 1e-4, "m")
_ROUGHNESS = {
    "deviation": Limit(1e-10, 1e-4, "m"),
    "mean": _DRAWN,
    "peaks": _DRAWN,
    "density": Limit(1e6, 1e15, "1/m2"),
    "tip_radius": Limit(1e-9, 0.1, "m"),
    "boundary_friction": BOUNDARY,
}
_Two = Annotated[tuple[float, float], Field(strict=False)]


class Rubbing(TypedDict, total=False):
    """Friction of the asperities and its band."""

    boundary_friction: float
    boundary_band: tuple[float, float] | None


class RoughnessSection(Section):
    """Roughness of the flanks, as drawings have it or as a standard deviation: makes the film mixed."""

    ground = ROUGHNESS | _ROUGHNESS

    Ra_um: float | None = key(
        "mean roughness Ra of each flank; of the pinion's alone beside wheel_Ra_um",
        None,
        of="mean",
        example=0.4,
    )
    wheel_Ra_um: float | None = key(
        "mean roughness Ra of the wheel's flanks, if different", None, of="mean", such_as=0.8
    )
    Rz_um: float | None = key(
        "mean peak-to-valley height Rz of each flank, instead of Ra; of the pinion's alone beside wheel_Rz_um",
        None,
        of="peaks",
        such_as=2.4,
    )
    wheel_Rz_um: float | None = key(
        "the same of the wheel's flanks, if different", None, of="peaks", such_as=4.8
    )
    sigma_um: float | None = key(
        "standard deviation of heights, both flanks together, instead of Ra and Rz",
        None,
        of="deviation",
        such_as=0.7,
    )
    density_per_mm2: float | None = key(
        "asperities per area; if left out such that density, tip radius and sigma multiply to 0.04",
        None,
        such_as=80,
    )
    tip_radius_um: float | None = key(
        "radius of the asperities' tips; a thousand times sigma if left out", None, such_as=700
    )
    law: Literal["greenwood-tripp", "greenwood-williamson", "zhou-hoeprich"] | None = key(
        "rule that shares the load: elastic asperities of two rough flanks or of one, or the film ratio; "
        "zhou-hoeprich unless given, greenwood-tripp beside density_per_mm2 or tip_radius_um",
        None,
        such_as="greenwood-tripp",
    )
    mean_plane_offset: float = key(
        "from the mean plane of heights to that of the asperities, times sigma", 1.15, of="offset"
    )
    boundary_friction: float = key(
        "coefficient of friction of what the asperities carry: 0.08 to 0.12 is usual of steel in oils for gears, and "
        "measured values are better; losses and friction of rough flanks hang on it",
        BOUNDARY_FRICTION,
        shown=True,
    )
    boundary_friction_band: _Two | None = key(
        "lowest and highest that it may be, whose effect is in the model error of friction and losses; if left out a "
        "fifth below and above",
        None,
        of=None,
        such_as=(0.08, 0.12),
    )

    @model_validator(mode="after")
    def _friction_within_its_band(self) -> RoughnessSection:
        if self.boundary_friction_band is None:
            return self
        low, high = self.boundary_friction_band
        if not (BOUNDARY.holds(low) and BOUNDARY.holds(high) and low <= self.boundary_friction <= high):
            allowed = (
                f"must be two numbers from {BOUNDARY.low:g} to {BOUNDARY.high:g}, the lower first, that have "
                f"boundary_friction = {self.boundary_friction:g} between them"
            )
            band = f"[{low:g}, {high:g}]"
            raise refused(allowed, "[0.08, 0.12] is usual", key="boundary_friction_band", value=band)
        return self

    @model_validator(mode="after")
    def _one_measure_of_height(self) -> RoughnessSection:
        measures = self.given_keys("Ra_um", "Rz_um", "sigma_um")
        if len(measures) != 1:
            raise refused(
                f"must have one of Ra_um, Rz_um and sigma_um, not {' and '.join(measures) or 'none'}"
            )
        for name in ("Ra_um", "Rz_um"):
            if self.given_keys(f"wheel_{name}") and not self.given_keys(name):
                raise refused(f"must have {name} of the pinion beside wheel_{name}")
        return self

    def roughness(self) -> ehl.Roughness:
        """Roughness of both flanks together, in SI; faults are those of its laws."""
        asperities = self.si("density_per_mm2", "tip_radius_um", "law", "mean_plane_offset")
        if self.sigma_um is not None:
            return ehl.Roughness.of_deviation(self.value("sigma_um"), **asperities)
        mean, peaks = (self._of_flanks(name) for name in ("Ra_um", "Rz_um"))
        return ehl.Roughness.from_drawing(mean, peaks, **asperities)

    @property
    def means(self) -> tuple[float | None, float | None]:
        """Rz and Ra as drawings have them, the mean of both flanks [m]; None of one that was not given."""
        peaks, mean = (self._of_flanks(name) for name in ("Rz_um", "Ra_um"))
        return (None if peaks is None else 0.5 * sum(peaks)), (None if mean is None else 0.5 * sum(mean))

    def _of_flanks(self, name: str) -> tuple[float, float] | None:
        """Roughness of pinion and wheel by the name of its key [m]; None where it was not given."""
        pinion, wheel = self.value(name), self.value(f"wheel_{name}")
        return None if pinion is None else (pinion, pinion if wheel is None else wheel)

    @property
    def rubbing(self) -> Rubbing:
        """Friction of the asperities and its band, as losses take them."""
        return {"boundary_friction": self.boundary_friction, "boundary_band": self.boundary_friction_band}
