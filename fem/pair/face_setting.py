"""How the face is looked at: its cells, and gaps along it by leads and alignment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Booleans, Faults, Limit, record, shorten
from gears import Shaft
from gears.tooth.face import ALIGNED, STRAIGHT, Alignment, Lead

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["EVEN", "PLACES", "FaceSetting", "face_setting"]

USUAL = 64
"""Cells of the face unless they are given."""

FREE_ENDS, WALLS, SLICES = "free-ends", "walls", "slices"
"""What couples the cells of the face; slices are there to compare with, their factor is 7 to 13 % low."""

PLACES = 2049
"""Along the face at which its minimum gap is looked for."""

CELLS = Limit(4, 512, remedy="64 resolve what a face does", whole=True)


@record
class FaceSetting:
    """How the face is looked at.

    Attributes
    ----------
    cells : int
        Equal cells of the face, even.
    alignment : Alignment
    leads : (Lead, Lead)
        Of pinion and wheel.
    model : {"free-ends", "walls", "slices"}
        What couples the cells: bodies with free ends, or between frictionless walls; nothing but the approach.
    strip : float
        Half-width of strips of pressure over a cell's length, where cells are narrow (``wide_contact``); else 0.
    shafts : (Shaft or None, Shaft or None)
        Of pinion and wheel, which bend and twist; None is rigid.
    held_under : float or None
        Force that has brought the shafts where they are held under all others [N]; None where each load bends them.
    """

    cells: int
    alignment: Alignment = ALIGNED
    leads: tuple[Lead, Lead] = (STRAIGHT, STRAIGHT)
    model: str = FREE_ENDS
    shafts: tuple[Shaft | None, Shaft | None] = (None, None)
    strip: float = 0.0
    held_under: float | None = None

    @property
    def even_load(self) -> bool:
        """Whether loads are even along the face: a single cell, which is the plane.

        Cells start from the plane's solution; that of a single one equals it to rounding, and is left out.
        """
        return self.cells == 1

    @property
    def on_shafts(self) -> bool:
        """Whether shafts give way under the face."""
        return self.shafts != (None, None)

    @property
    def coupled(self) -> tuple[Any, ...]:
        """What decides how bodies couple cells, whatever stands between the flanks and under the gears."""
        return self.cells, self.model, self.strip

    def opposite(self, working_pressure_angle: float) -> FaceSetting:
        """The face of the flanks on the other side of the teeth: leads are those of both, axes tilt another way."""
        return replace(self, alignment=self.alignment.opposite(working_pressure_angle))

    @property
    def slope(self) -> float:
        """Slopes of leads and alignment in the plane of action together, over the face [m]."""
        return sum(lead.slope for lead in self.leads) + self.alignment.in_plane

    def edges(self, pair: GearPair) -> Array:
        """Edges of the cells (cells + 1,) [m], 0 at mid-face."""
        return np.asarray(np.linspace(-0.5, 0.5, self.cells + 1) * pair.face_width)

    def middles(self, face_width: float) -> Array:
        """Middles of the cells (cells,) [m], 0 at mid-face."""
        return np.asarray(((np.arange(self.cells) + 0.5) / self.cells - 0.5) * face_width)

    def check(self, faults: Faults, pair: GearPair, positions: int) -> None:
        """Note everything that is wrong, and what takes more memory at a number of positions than there is."""
        from fem.pair.face_memory import check_memory

        faults.number("cells", self.cells, CELLS)
        faults.choice("face_model", self.model, (FREE_ENDS, WALLS, SLICES), "slices alone bear too evenly")
        if isinstance(self.cells, int) and self.cells % 2:
            faults.add("cells", self.cells, "must be even", "mid-face lies between two cells")
        if faults.instance("alignment", self.alignment, Alignment, optional=True):
            faults.extend(self.alignment.faults("alignment"))
        if not isinstance(self.shafts, Sequence) or len(self.shafts) != 2:
            faults.add(
                "shafts", shorten(self.shafts), "must be of pinion and wheel", "give None for a stiff one"
            )
            return
        self._check_leads(faults, pair)
        if not faults.found:
            check_memory(faults, pair, self.cells, positions, self.model)
        for k, shaft in enumerate(self.shafts):
            if faults.instance(f"shafts[{k}]", shaft, Shaft, optional=True) and shaft is not None:
                _check_shaft(faults, f"shafts[{k}]", shaft, pair.face_width, pair.face_offsets[k])

    def _check_leads(self, faults: Faults, pair: GearPair) -> None:
        """Note leads that do not fit their gears, and what is not known with them."""
        for k, (name, lead) in enumerate(zip(("pinion", "wheel"), self.leads, strict=True)):
            path, width = f"{name}.lead", pair.face_widths[k]
            if lead.end_relief and lead.end_relief_length > 0.5 * width:
                allowed = f"must be at most {0.5 * width:g} m, half the face"
                faults.add(f"{path}.end_relief_length", lead.end_relief_length, allowed, "relieve less of it")
            if lead.topography is not None:
                span = pair.active_profiles[k]
                faults.extend(lead.topography.apart(f"{path}.topography", span, width))
            if lead.topographic and self.on_shafts and not pair.helix_angle:
                key, value = ("topography", lead.topography) if lead.topography else ("twist", lead.twist)
                allowed = "must be left out where shafts give way under the face of a spur pair"
                faults.add(f"{path}.{key}", shorten(value), allowed, "leave it out, or take rigid shafts")

    @property
    def topographic(self) -> bool:
        """Whether gaps along the face depend on the place on the profiles too."""
        return any(lead.topographic for lead in self.leads)

    def least_gap(self, pair: GearPair, rho: Array | None = None) -> Array | float:
        """Smallest of the gaps along the face by leads and what lies in the plane of action [m].

        One of all pairs, 0 or less; of each (positions, pairs), by its radii rho (2, positions, pairs), where twist or
        topography count.
        """
        if rho is None or not self.topographic:
            return float(np.min(self.gaps_along(pair)))
        z, far = self._places(pair), np.array(np.inf)
        rows = (self._gaps(pair, z, far, row[..., None]) for row in np.moveaxis(rho, 1, 0))
        return np.stack([row.min(axis=-1) for row in rows])

    def first_gap(self, pair: GearPair, rho: Array, touchable: Booleans) -> Array | float:
        """Smallest of `least_gap` of the pairs that can touch: of all positions, or of each (positions,) [m]."""
        least = self.least_gap(pair, rho)
        if isinstance(least, float):
            return least
        return np.asarray(np.where(touchable, least, np.inf).min(axis=-1))

    def gaps_along(self, pair: GearPair) -> Array:
        """Gaps at PLACES along the face by straight leads and what lies in the plane of action (PLACES,) [m]."""
        return self._gaps(pair, self._places(pair), np.array(np.inf))

    def gaps(self, pair: GearPair, rho: Array) -> Array:
        """Mean gaps of the cells (..., cells) [m], less those at mid-face of straight aligned gears.

        Parameters
        ----------
        pair : GearPair
        rho : (2, ...) array
            Curvature radii where pinion and wheel are touched, the same all along the face [m].
        """
        sampled = self.gaps_within(pair, rho, 2)
        return np.asarray((sampled[..., :-1:2] + 4.0 * sampled[..., 1::2] + sampled[..., 2::2]) / 6.0)

    def gaps_within(self, pair: GearPair, rho: Array, parts: int) -> Array:
        """Gaps at the ends of equal parts of every cell (..., parts cells + 1) [m]; rho as of `gaps`."""
        z = np.linspace(-0.5, 0.5, parts * self.cells + 1) * pair.face_width
        return self.gaps_at(pair, z, rho[..., None])

    def gaps_at(self, pair: GearPair, z: Array, rho: Array) -> Array:
        """Gaps along the transverse line of action at places of the face (...) [m]; 0 of straight aligned gears.

        Parameters
        ----------
        pair : GearPair
        z : (...) array
            Places, from the middle of the face in contact [m].
        rho : (2, ...) array
            Curvature radii of the transverse section where pinion and wheel are touched there [m]; broadcasts with z.
            Lines of contact that are oblique have another pair of them at every place.
        """
        rho1, rho2 = rho
        return self._gaps(pair, z, np.asarray(rho1 * rho2 / (rho1 + rho2)), rho)

    def _places(self, pair: GearPair) -> Array:
        return np.asarray(np.linspace(-0.5, 0.5, PLACES) * pair.face_width)

    def _gaps(self, pair: GearPair, z: Array, radius: Array, rho: Array | None = None) -> Array:
        """Gaps by alignment and leads; without radii rho (2, ...) those that depend on z alone."""
        own = zip(self.leads, pair.face_widths, pair.face_offsets, strict=True)
        if rho is None or not self.topographic:
            removed = sum(lead.removed(z - offset, width) for lead, width, offset in own)
        else:
            removed = sum(
                lead.removed_at(z - offset, radii, width, span)
                for (lead, width, offset), radii, span in zip(own, rho, pair.active_profiles, strict=True)
            )
        return np.asarray(self.alignment.gap(z, pair.face_width, radius) + removed)


EVEN = FaceSetting(1, model=SLICES)
"""The face of a mesh in the plane: one slice, which nothing couples to others."""


def face_setting(
    pair: GearPair,
    alignment: Alignment | None,
    cells: int | None,
    model: str,
    shafts: tuple[Shaft | None, Shaft | None] | None = None,
) -> FaceSetting | None:
    """How the face of a pair is looked at; None where nothing differs along it and no cells are asked for."""
    leads, pair_shafts = (pair.pinion.lead, pair.wheel.lead), shafts or (None, None)
    alike = leads == (STRAIGHT, STRAIGHT) and pair.face_widths == (pair.face_width, pair.face_width)
    even = alignment is None and cells is None and pair_shafts == (None, None)
    if alike and even and pair.helix_angle == 0.0:
        return None
    return FaceSetting(USUAL if cells is None else cells, alignment or ALIGNED, leads, model, pair_shafts)


def _check_shaft(faults: Faults, name: str, shaft: Shaft, face_width: float, offset: float) -> None:
    """Note a face in contact that is not all on its shaft."""
    half = 0.5 * face_width
    within = Limit(
        half + offset,
        shaft.length - half + offset,
        "m",
        "the whole face must be on the shaft: make its end longer",
    )
    if within.low <= within.high:
        faults.number(f"{name}.gear_position", shaft.gear_position, within)
    else:
        allowed = f"must be at least the face width, {face_width:g} m"
        faults.add(f"{name}.segments", f"{shaft.length:g} m long", allowed, "give the steps of the shaft")
