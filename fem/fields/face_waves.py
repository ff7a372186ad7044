"""A gear's solid under loads that vary along the face: displacement of whole sectors, wave by wave.

Line loads along the face are sums of waves, q(z) = sum q_m cos k_m (z + b/2), k_m = m pi/b, and a gear answers each
wave as a prism between frictionless walls (``fem.elasticity.prism``), here with its whole section instead of the flank
alone:

    u(x, y, z) = sum_m q_m cos k_m (z + b/2) U(x, y; k_m),   w likewise by sines.

U is solved for the waves of ``fem.influence.gear_face`` and interpolated between them. Loads stand on the mesh as nodal
forces: within an element of a contact the displacement is the mesh's and not that of Hertz's pressure. Free ends
of the face are left out: beside a loaded end they add 3 to 7 % to the displacement, and a motion along the axis of an
eighth of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.cycle.result import MeshCycle
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.prism import Prism, prism
from fem.elasticity.section import Face
from fem.influence.gear_face import between_waves, section_of, solved_waves
from meshes import SectorMesh

if TYPE_CHECKING:
    from fem.influence.gear_shape import MeshedShape
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = ["BESIDE", "FaceWaves", "GearPrisms", "drawn_section", "gear_prisms", "layers_of", "on_flank"]

DEPTH = 2.0
"""Depth below the root circle down to which the body is drawn, in modules."""

SLIVER = 1e-6
"""Twice the area of a triangle that is left out where the body is cut off, in square modules."""

BESIDE = 1
"""Teeth that are drawn on either side of the loaded ones."""

LAYERS = 12
"""Layers of the solid along the face, or as many as there are cells if these are fewer."""


@record
class GearPrisms:
    """A gear that is ready to be drawn at many positions, in modules and E*.

    Attributes
    ----------
    mesh : SectorMesh
    prisms : tuple of Prism
        For the waves of ``fem.influence.gear_face.solved_waves``.
    triangles : (t, 3) array of int
        What is drawn of a sector: second-order triangles in four.
    points : (nodes, 2) array
        Where its nodes are drawn: those below a depth on the circle there, which cuts the body off.
    """

    mesh: SectorMesh
    prisms: tuple[Prism, ...]
    triangles: Integers
    points: Array

    def displacements(self, at: FlankPoints, teeth: Sequence[int]) -> Array:
        """Displacements (waves, teeth, nodes, 3, loads) in each tooth's frame by unit line loads on tooth 0."""
        moved = np.zeros((len(self.prisms), len(teeth), len(self.mesh.points), 3, len(at.rho)))
        for wave, solved in zip(moved, self.prisms, strict=True):
            n = 2 * solved.psi + solved.phi
            wave[:, :, :n] = solved.displacements(at, teeth)
        return moved


def gear_prisms(bodies: PairCompliance) -> tuple[GearPrisms, GearPrisms]:
    """Factorise both gears for waves along the face, on a coarse mesh.

    Parameters
    ----------
    bodies : PairCompliance
    """
    pinion, wheel = bodies.meshed
    return _gear_prisms(pinion), _gear_prisms(wheel)


def layers_of(pair: GearPair, cells: int) -> Array:
    """Layers of the solid along the face in contact (layers,) [m], 0 at mid-face."""
    return np.asarray(np.linspace(-0.5, 0.5, min(LAYERS, cells) + 1) * pair.face_width)


def _gear_prisms(meshed: MeshedShape) -> GearPrisms:
    over, (_, waves) = section_of(meshed, meshed.sizes, 0), solved_waves()
    prisms = tuple(prism(over, Face.wave(float(k))) for k in waves)
    return GearPrisms(over.mesh, prisms, *drawn_section(over.mesh, meshed.shape.profile.root_radius))


def drawn_section(mesh: SectorMesh, root_radius: float) -> tuple[Integers, Array]:
    """What is drawn of a sector: triangles (t, 3), and where its nodes are drawn (nodes, 2) [modules].

    Second-order triangles are divided in four; nodes below a depth are on the circle there, which cuts the body off.
    """
    a, b, c, ab, bc, ca = mesh.triangles.T
    quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    triangles = np.concatenate([np.column_stack(part) for part in quarters])
    depth = root_radius - DEPTH
    points = mesh.points * np.maximum(1.0, depth / np.linalg.norm(mesh.points, axis=1))[:, None]
    p, q, r = (points[triangles[:, k]] for k in range(3))
    (ux, uy), (vx, vy) = (q - p).T, (r - p).T
    shown = (ux * vy - uy * vx > SLIVER) & np.any(
        np.linalg.norm(mesh.points[triangles], axis=2) > depth, axis=1
    )
    return triangles[shown], points


@record
class FaceWaves:
    """What waves of each load do at layers of the face.

    Attributes
    ----------
    layers : (layers,) array
        [m], 0 at mid-face.
    even, odd : (loads, layers, waves) arrays
        Weights of the solved waves in u and v, and in w [N/m].
    """

    layers: Array
    even: Array
    odd: Array

    @classmethod
    def of(cls, pair: GearPair, cycle: MeshCycle, row: int, loaded: Integers) -> FaceWaves:
        """Divide the line loads of some pairs, columns of the cycle, into waves."""
        assert cycle.face is not None
        width, load = pair.face_width, cycle.face.line_load[row, loaded]
        cells = load.shape[-1]
        m = np.arange(cells)
        cosines = np.cos(np.pi * m[:, None] * (np.arange(cells) + 0.5) / cells)
        modes = load @ cosines.T * np.where(m, 2.0, 1.0) / cells
        layers = layers_of(pair, cells)
        turn = np.pi * m * (layers[:, None] / width + 0.5)
        by_wave = between_waves(np.pi * m * pair.module / width)
        even, odd = (np.einsum("km,lm,mw->klw", modes, f(turn), by_wave) for f in (np.cos, np.sin))
        return cls(layers, even, odd)

    def moved(self, ready: GearPrisms, at: Sequence[FlankPoints], teeth: Sequence[Sequence[int]]) -> Array:
        """Displacements (teeth, layers, nodes, 3) in each tooth's frame, times E* [N/m].

        Parameters
        ----------
        ready : GearPrisms
        at : sequence of FlankPoints
            Place of each load [modules].
        teeth : sequence of sequences of int
            Teeth that are drawn, counted from that of each load.
        """
        displacements = np.zeros((len(teeth[0]), len(self.layers), len(ready.mesh.points), 3))
        for even, odd, place, drawn in zip(self.even, self.odd, at, teeth, strict=True):
            by_wave = ready.displacements(place, drawn)[..., 0]
            displacements[..., :2] += np.einsum("lw,wtna->tlna", even, by_wave[..., :2], optimize=True)
            displacements[..., 2] += np.einsum("lw,wtn->tln", odd, by_wave[..., 2], optimize=True)
        return displacements


def on_flank(mesh: SectorMesh, rho: float | Array) -> FlankPoints:
    """Points of the loaded flank, those beyond its ends on them [modules]."""
    low, high = (np.sqrt(2 * mesh.base_radius * f(mesh.parameters["flank_left"])) for f in (np.min, np.max))
    return flank_points(mesh, np.clip(rho, low, high))
