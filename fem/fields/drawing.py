"""A gear made ready to be drawn at many positions: what the cuts of any sector do to its nodes.

All sectors are copies, so displacement and stress at the drawn nodes of a sector without contact are one matrix
times the displacements of its cuts. Only sectors with a contact need more.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Array, Integers, record
from fem.elasticity import flamant
from fem.elasticity.line_load import joined, line_loads
from fem.elasticity.recovery import NodalStress, nodal_stress
from fem.elasticity.ring import Ring
from fem.fields.near_field import Contact, near_field
from fem.fields.picture import Picture, picture_of
from fem.fields.tip_sector import carried
from fem.fields.turn import Turn
from meshes import SectorMesh

__all__ = ["DrawnSector", "GearDrawing", "gear_drawing"]

FOCUS = 0.35
"""Size of the cells at a contact, in half-widths of its pressure."""

SIDES = "right", "left"
"""Of a sector: its cuts."""


@record
class DrawnSector:
    """Fields of a sector in its tooth's frame.

    Attributes
    ----------
    tooth : int
    picture : Picture
    points : (n, 2) array
        [m]
    displacement : (n, 2) array
        [m]
    stress : (n, 3) array
        sigma_xx, sigma_yy, tau_xy [Pa].
    contact : Contact or None
    """

    tooth: int
    picture: Picture
    points: Array
    displacement: Array
    stress: Array
    contact: Contact | None


@record
class GearDrawing:
    """A factorised gear with what its drawing needs.

    Attributes
    ----------
    ring : Ring
    recovery : NodalStress
    picture : Picture
        Of a sector without contact: coarse.
    points : (p, 2) array
        Of that picture [m].
    by_cut : (2n, cut) array
        Displacements of all nodes of a sector by those of its cuts (Cartesian).
    moved_by_cut, stress_by_cut : (2p, cut), (3p, cut) arrays
        The same for displacement and stress at the picture's points.
    seam : (3 side, cut) arrays, two
        The same for the stress at the nodes of the right and of the left cut.
    from_seam : (p, side) arrays, two
        Values at the picture's points by those at the nodes of the right and of the left cut.
    """

    ring: Ring
    recovery: NodalStress
    picture: Picture
    points: Array
    by_cut: Array
    moved_by_cut: Array
    stress_by_cut: Array
    seam: tuple[Array, Array]
    from_seam: tuple[Array, Array]

    def sectors(self, contacts: Sequence[Contact]) -> list[DrawnSector]:
        """Fields of all sectors, one tooth after the other."""
        ring, z = self.ring, self.ring.mesh.teeth
        size = np.array([contact.line_load for contact in contacts])
        loads = line_loads(ring, joined(*(contact.at for contact in contacts)))
        forces, own = loads.cut_force * size, loads.own_inner * size
        cuts, loaded = np.zeros((z, len(ring.cut))), {}
        for number, contact in enumerate(contacts):
            cuts += np.roll(ring.all_interfaces(forces[:, number]), contact.tooth, axis=0)
            loaded[contact.tooth % z] = contact, own[:, number]
        cuts = cuts @ ring.polar.T
        nodal = {k: self._loaded(cuts[k], *on_it) for k, on_it in loaded.items()}
        jumps = self._jumps(cuts, nodal, {k: on_it[0] for k, on_it in loaded.items()})
        moved = (cuts @ self.moved_by_cut.T).reshape(z, -1, 2)
        stress = (cuts @ self.stress_by_cut.T).reshape(z, -1, 3)
        stress += sum(spread @ jump for spread, jump in zip(self.from_seam, jumps, strict=True))
        drawn = []
        for k in range(-(z // 2), z - z // 2):
            i = k % z
            if i in nodal:
                jump = jumps[0][i], jumps[1][i]
                drawn.append(self._with_contact(k, loaded[i][0], *nodal[i], jump))
            else:
                drawn.append(DrawnSector(k, self.picture, self.points, moved[i], stress[i], None))
        return drawn

    def _loaded(self, cuts: Array, contact: Contact, own_inner: Array) -> tuple[Array, Array]:
        """Displacement (n, 2) and stress (n, 3) at the nodes of a loaded sector: all of it, or the regular part."""
        ring = self.ring
        nodal = self.by_cut @ cuts
        if contact.sector is not None:
            return contact.sector.solved(ring.law, ring.mesh, nodal.reshape(-1, 2))
        nodal[ring.inner] += own_inner
        load = contact.at.points[0], contact.at.inward[0]
        for unknowns in (ring.cut, ring.hub):  # there the unknown was u, and u_r = u - u_s
            points = ring.mesh.points[unknowns[::2] // 2]
            singular = flamant.displacement(points, *load, ring.law, ring.mesh.module)
            nodal[unknowns] -= contact.line_load * singular.ravel()
        stress = (self.recovery.matrix @ nodal).reshape(-1, 3)
        stress += contact.line_load * self.recovery.from_tractions(ring.mesh, *load, ring.law)
        return nodal.reshape(-1, 2), stress

    def _jumps(
        self, cuts: Array, nodal: dict[int, tuple[Array, Array]], contacts: dict[int, Contact]
    ) -> tuple[Array, Array]:
        """What brings the stress at the sectors' right and left cuts to the mean of both sides, (z, side, 3) each."""
        ring, z = self.ring, self.ring.mesh.teeth
        right, left = there = [(cuts @ matrix.T).reshape(z, -1, 3) for matrix in self.seam]
        for k, (_, stress) in nodal.items():
            sector = contacts[k].sector
            if sector is not None:
                for own, side in zip(there, SIDES, strict=True):
                    own[k] = carried(stress, sector.mesh, ring.mesh, side)
                continue
            nodes = np.concatenate([ring.mesh.side_nodes(side) for side in SIDES])
            _, near = near_field(ring.mesh.points[nodes], contacts[k], ring.law, ring.mesh.module)
            right[k], left[k] = np.split(stress[nodes] + near, 2)
        turn = Turn.by(2 * np.pi / z)  # from a tooth's frame to that of the tooth on its right
        half = 0.5 * (turn.stresses(np.roll(right, -1, axis=0)) - left)
        return -np.roll(turn.back().stresses(half), 1, axis=0), half

    def _with_contact(
        self, tooth: int, contact: Contact, moved: Array, stress: Array, jumps: tuple[Array, Array]
    ) -> DrawnSector:
        ring, sector = self.ring.mesh, contact.sector
        mesh = ring if sector is None else sector.mesh
        picture = picture_of(mesh, (contact.at.points[0], FOCUS * contact.half_width))
        at_nodes = np.column_stack([mesh.points, moved, stress + _along_the_cuts(jumps, ring, mesh)])
        points, displacement, stress = np.split(picture.interpolate(at_nodes), [2, 4], axis=1)
        if sector is None:
            near_moved, near_stress = near_field(points, contact, self.ring.law, ring.module)
            displacement, stress = displacement + near_moved, stress + near_stress
        return DrawnSector(tooth, picture, points, displacement, stress, contact)


def _along_the_cuts(jumps: tuple[Array, Array], known: SectorMesh, asked: SectorMesh) -> Array:
    """Corrections (n, 3) at all nodes of a mesh by those at the cuts' nodes of the same one or another."""
    values = np.zeros((len(asked.points), 3))
    for side, jump in zip(SIDES, jumps, strict=True):
        there = np.zeros((len(known.points), 3))
        there[known.side_nodes(side)] = jump
        values[asked.side_nodes(side)] = jump if asked is known else carried(there, known, asked, side)
    return values


def gear_drawing(ring: Ring) -> GearDrawing:
    """Prepare the drawing of a gear; its cells are those of the coarsest mesh of the family."""
    mesh = ring.mesh
    by_cut = np.zeros((mesh.unknowns, len(ring.cut)))
    by_cut[ring.inner] = -ring.inner_by_cut
    by_cut[ring.cut, np.arange(len(ring.cut))] = 1.0
    recovery = nodal_stress(mesh, ring.law)
    picture = picture_of(mesh)
    cuts = by_cut.shape[1]
    stress_by_cut = (recovery.matrix @ by_cut).reshape(-1, 3, cuts)
    right, left = (mesh.side_nodes(side) for side in SIDES)

    def from_nodes(nodes: Integers) -> Array:
        return picture.interpolate((np.arange(len(mesh.points))[:, None] == nodes).astype(float))

    return GearDrawing(
        ring,
        recovery,
        picture,
        picture.interpolate(mesh.points),
        by_cut,
        picture.interpolate(by_cut.reshape(-1, 2, cuts)).reshape(-1, cuts),
        picture.interpolate(stress_by_cut).reshape(-1, cuts),
        (stress_by_cut[right].reshape(-1, cuts), stress_by_cut[left].reshape(-1, cuts)),
        (from_nodes(right), from_nodes(left)),
    )
