"""Compliance of both gears of a helical pair between cells of its lines of contact, put together.

Each gear is a solid without ends that lines of contact cross (``fem.influence.helix_lines``), and what its free ends
add (``fem.influence.helix_ends``). Line loads and displacements are along the common normal; a cell of length h along
the axis has the line load F/h.
"""

from __future__ import annotations

from functools import partial
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.influence.gear_shape import MeshedShape, rounded
from fem.influence.gear_store import GearStore
from fem.influence.helix_ends import OF_ENDS, HelixEnds, helix_ends
from fem.influence.helix_lines import ContactLine, along_line, between_lines
from fem.influence.helix_waves import HelixHarmonics, helix_harmonics
from fem.pair.face_setting import FREE_ENDS

if TYPE_CHECKING:
    from fem.influence.gear_compliance import GearCompliance
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["FeltLine", "GearLines", "gear_lines"]


@record
class FeltLine:
    """Cells of a line of contact on one gear, and how its ends feel them."""

    line: ContactLine
    ends: tuple[Array, ...]


@record
class GearLines:
    """One gear of a helical pair as its lines of contact feel it.

    Attributes
    ----------
    flexible : GearCompliance
        Of the spur gear with the transverse section.
    poisson : float
        nu*
    waves : HelixHarmonics
    ends : HelixEnds or None
        None where ends are left out.
    side : int
        1 of the pinion, -1 of the wheel, whose teeth ahead have smaller curvature radii.
    offset : float
        Middle of the gear's own face [m].
    """

    flexible: GearCompliance
    poisson: float
    waves: HelixHarmonics
    ends: HelixEnds | None
    side: int
    offset: float

    def line(self, tooth: int, z: Array, rho: Array, length: float) -> FeltLine:
        """A line of contact in modules, with places and lengths in metres."""
        module = self.flexible.module
        line = ContactLine(self.side * tooth, (z - self.offset) / module, rho / module, length / module)
        return FeltLine(line, () if self.ends is None else self.ends.on(line))

    def between(self, load: FeltLine, point: FeltLine, half_width: float) -> Array:
        """Mean displacements of cells by unit forces on cells (loads, points) [m/N], but for the local law.

        Parameters
        ----------
        load, point : FeltLine
        half_width : float
            Of the pressure, in modules.
        """
        module, modulus, line = self.flexible.module, self.flexible.law.plane_modulus, load.line
        if load is point:
            in_plane = self.flexible.own(line.rho * module) * modulus
            moved = along_line(self.waves, self.poisson, line, in_plane, half_width)
        else:
            moved = between_lines(self.waves, line, point.line)
        moved = moved / line.length
        if self.ends is not None:
            moved = moved + self.ends.joining(load.ends, point.ends, point.line.tooth - line.tooth)
        return np.asarray(moved / (modulus * module))

    def by_ends(self, load: FeltLine, point: FeltLine) -> Array:
        """What of `between` free ends add (loads, points) [m/N]; 0 where they are left out."""
        if self.ends is None:
            return np.zeros((len(load.line.z), len(point.line.z)))
        moved = self.ends.joining(load.ends, point.ends, point.line.tooth - load.line.tooth)
        return np.asarray(moved / (self.flexible.law.plane_modulus * self.flexible.module))


def gear_lines(
    bodies: PairCompliance, slope: float, model: str = FREE_ENDS, store: GearStore | None = None
) -> tuple[GearLines, GearLines]:
    """Both gears of a helical pair, solved where they are kept nowhere.

    Parameters
    ----------
    bodies : PairCompliance
    slope : float
        d rho1/dz along a line of contact.
    model : str
        Free ends are left out with any other one than "free-ends".
    store : GearStore, optional
        Where solved gears are kept.
    """
    pair, store = bodies.pair, store or GearStore()
    lines = ceil(pair.total_contact_ratio)
    solved = []
    for gear, side in enumerate((1, -1)):
        meshed, width = bodies.meshed[gear], rounded(pair.face_widths[gear] / pair.module)
        twist = side * slope * pair.module / pair.base_radii[gear]
        reach = max(meshed.shape.reach, lines)
        ends = helix_ends(meshed, twist, width, store) if model == FREE_ENDS else None
        if ends is not None and bodies.doubt in OF_ENDS:
            ends = ends.off_by(bodies.doubt)
        solved.append(
            GearLines(
                (bodies.pinion, bodies.wheel)[gear],
                meshed.shape.poisson,
                _waves(meshed, twist, reach, store),
                ends,
                side,
                pair.face_offsets[gear],
            )
        )
    return solved[0], solved[1]


def _waves(meshed: MeshedShape, twist: float, reach: int, store: GearStore) -> HelixHarmonics:
    """Waves of a gear of either hand, by those of the right hand."""
    size = rounded(abs(twist))
    right = store.record("helix waves", (meshed, size, reach), partial(helix_harmonics, meshed, size, reach))
    return right if twist > 0.0 else right.mirrored
