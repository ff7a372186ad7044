"""A helical gear as a twisted solid with free ends, under the loads of its lines of contact: displacement of its teeth.

The solid is the section's finite elements times cubics over pieces of the face (``fem.elasticity.prism``), its bore
held and its ends free. Cells of a line of contact are loads along the common normal, each at its place of the flank,
divided among the functions over the face by their means over the cell. Loads stand on the mesh as nodal forces:
within an element of a contact the displacement is the mesh's and not that of Hertz's pressure.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity.lengthened import FacePieces
from fem.elasticity.prism import Prism, prism
from fem.fields.face_waves import drawn_section, on_flank
from fem.influence.gear_face import section_of
from meshes import SectorMesh
from meshes.outline import Sizes

if TYPE_CHECKING:
    from fem.influence.gear_shape import MeshedShape
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["CellLoads", "TwistedGear", "twisted_gears"]

SECTION = Sizes(
    flank=0.45, fillet=0.45, root=0.9, corner=0.45, top=1.5, growth=1.0, rim=2.0, layer_growth=2.0
)
"""Of the section."""

AT_END, BETWEEN, PIECES = 1.0, 4.5, 6
"""Length of the pieces at both ends and about that of those between them [modules], and how many there are at most."""


@record
class CellLoads:
    """Cells of one line of contact as loads of a gear.

    Attributes
    ----------
    rho, z, force : (cells,) arrays
        Curvature radius [m], place along the gear's own face, 0 at its middle [m], and normal force [N].
    length : float
        Of each cell along the axis [m].
    """

    rho: Array
    z: Array
    force: Array
    length: float


@record
class TwistedGear:
    """A helical gear that is ready to be drawn at many positions, in modules and E*.

    Attributes
    ----------
    solid : Prism
    pieces : FacePieces
        Of the gear's own face, 0 in its middle.
    triangles, points : arrays
        What is drawn of a sector (``fem.fields.face_waves.drawn_section``).
    scale : float
        Module times E* [N/m].
    module : float
        [m]
    """

    solid: Prism
    pieces: FacePieces
    triangles: Integers
    points: Array
    scale: float
    module: float

    @property
    def mesh(self) -> SectorMesh:
        """Of a sector."""
        return self.solid.mesh

    def moved(self, lines: Sequence[CellLoads], loaded: Sequence[int], teeth: Sequence[int]) -> Array:
        """Displacement by the functions over the face (teeth, nodes, functions, 3) [m], in each tooth's section.

        Parameters
        ----------
        lines : sequence of CellLoads
        loaded : sequence of int
            Tooth of each line, counted anticlockwise.
        teeth : sequence of int
            Those that are drawn.
        """
        forces = []
        for line in lines:
            means = self.pieces.means(line.z / self.module, line.length / self.module)
            at = on_flank(self.mesh, line.rho / self.module)
            forces.append(self.solid.nodal_forces(at, line.force[:, None] * means))
        moved = self.solid.moved(np.stack(forces, axis=-1), loaded, teeth) / self.scale
        count = 2 * self.pieces.functions
        across = moved[..., :count].reshape(*moved.shape[:2], -1, 2)
        return np.concatenate([across, moved[..., count:, None]], axis=-1)


def twisted_gears(bodies: PairCompliance, slope: float) -> tuple[TwistedGear, TwistedGear]:
    """Factorise both gears of a helical pair, on a coarse mesh.

    Parameters
    ----------
    bodies : PairCompliance
    slope : float
        Change of the pinion's curvature radius along a line of contact, by z.
    """
    first, second = (_twisted(bodies, gear, meshed, slope) for gear, meshed in enumerate(bodies.meshed))
    return first, second


def _twisted(bodies: PairCompliance, gear: int, meshed: MeshedShape, slope: float) -> TwistedGear:
    pair, profile = bodies.pair, meshed.shape.profile
    over = section_of(meshed, SECTION, 0, (1 - 2 * gear) * slope / profile.base_radius)
    pieces = _pieces(pair.face_widths[gear] / pair.module)
    modulus = (bodies.pinion, bodies.wheel)[gear].law.plane_modulus
    return TwistedGear(
        prism(over, pieces.face()),
        pieces,
        *drawn_section(over.mesh, profile.root_radius),
        modulus * pair.module,
        pair.module,
    )


def _pieces(width: float) -> FacePieces:
    """Pieces of a face of some width in modules."""
    end = min(AT_END, 0.25 * width)
    between = int(np.clip(round((width - 2.0 * end) / BETWEEN), 1, PIECES - 2))
    inner = np.linspace(end - 0.5 * width, 0.5 * width - end, between + 1)
    return FacePieces(np.concatenate([[-0.5 * width], inner, [0.5 * width]]))
