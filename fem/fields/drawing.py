"""A gear made ready to be drawn at many positions: what the cuts of any sector do to its nodes.

All sectors are copies, so displacement and stress at the drawn nodes of a sector without contact are one matrix
times the displacements of its cuts. Only sectors with a contact need more.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Array, Integers, record
from fem.elasticity import flamant
from fem.elasticity.line_load import line_loads
from fem.elasticity.recovery import NodalStress, nodal_stress
from fem.elasticity.ring import Ring
from fem.fields.near_field import Contact, near_field
from fem.fields.picture import Picture, picture_of
from fem.fields.tip_sector import carried
from meshes import SectorMesh

__all__ = ["DrawnSector", "GearDrawing", "gear_drawing"]

FOCUS = 0.35
"""Size of the cells at a contact, in half-widths of its pressure."""


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
    stress : (n, 2, 2) array
        In the plane [Pa].
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
    by_cut : (2n, cut) array
        Displacements of all nodes of a sector by those of its cuts (Cartesian).
    moved_by_cut, stress_by_cut : (2p, cut), (3p, cut) arrays
        The same for displacement and stress at the picture's points.
    seam : (3 side, cut) arrays, two
        The same for the stress at the nodes of the right and of the left cut.
    """

    ring: Ring
    recovery: NodalStress
    picture: Picture
    by_cut: Array
    moved_by_cut: Array
    stress_by_cut: Array
    seam: tuple[Array, Array]

    def sectors(self, contacts: Sequence[Contact]) -> list[DrawnSector]:
        """Fields of all sectors, one tooth after the other."""
        ring, z = self.ring, self.ring.mesh.teeth
        cuts, loaded = np.zeros((z, len(ring.cut))), {}
        for contact in contacts:
            loads = line_loads(ring, contact.at)
            force = loads.cut_force[:, 0] * contact.line_load
            cuts += np.roll(ring.all_interfaces(force), contact.tooth, axis=0)
            loaded[contact.tooth % z] = contact, loads.own_inner[:, 0] * contact.line_load
        cuts = cuts @ ring.polar.T
        moved = (cuts @ self.moved_by_cut.T).reshape(z, -1, 2)
        stress = (cuts @ self.stress_by_cut.T).reshape(z, -1, 3)
        nodal = {k: self._loaded(cuts[k], *own) for k, own in loaded.items()}
        jumps = self._jumps(cuts, nodal, {k: own[0] for k, own in loaded.items()})
        coarse = self.picture.interpolate(ring.mesh.points)
        drawn = []
        for k in range(-(z // 2), z - z // 2):
            if k % z in nodal:
                drawn.append(self._with_contact(k, loaded[k % z][0], *nodal[k % z], jumps[k % z]))
                continue
            corrected = stress[k % z] + self._spread(jumps[k % z], self.picture, ring.mesh)
            tensor = corrected[:, [[0, 2], [2, 1]]]
            drawn.append(DrawnSector(k, self.picture, coarse, moved[k % z], tensor, None))
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
    ) -> list[tuple[Array, Array]]:
        """What brings the stress at a sector's right and left cut to the mean of both sides, (z) x (side, 3)."""
        ring, z = self.ring, self.ring.mesh.teeth
        sides = [ring.mesh.side_nodes(side) for side in ("right", "left")]
        there = [(cuts @ matrix.T).reshape(z, -1, 3) for matrix in self.seam]
        for k, (_, stress) in nodal.items():
            for own, nodes, side in zip(there, sides, ("right", "left"), strict=True):
                sector = contacts[k].sector
                if sector is not None:
                    own[k] = carried(stress, sector.mesh, ring.mesh, side)
                    continue
                _, near = near_field(ring.mesh.points[nodes], contacts[k], ring.law, ring.mesh.module)
                own[k] = stress[nodes] + near[:, [0, 1, 0], [0, 1, 1]]
        c, s = np.cos(2 * np.pi / z), np.sin(2 * np.pi / z)
        turn = np.array([[c, -s], [s, c]])  # from a tooth's frame to that of the tooth on its right
        right, left = there[0][:, :, [[0, 2], [2, 1]]], there[1][:, :, [[0, 2], [2, 1]]]
        ahead = turn @ np.roll(right, -1, axis=0) @ turn.T
        half = 0.5 * (ahead - left)
        back = -np.roll(turn.T @ half @ turn, 1, axis=0)
        pick = (slice(None), [0, 1, 0], [0, 1, 1])
        return [(back[k][pick], half[k][pick]) for k in range(z)]

    def _spread(self, jumps: tuple[Array, Array], picture: Picture, mesh: SectorMesh) -> Array:
        """Correction (points, 3) of a picture by corrections at the cuts' nodes, on the ring's mesh or another."""
        own = self.ring.mesh
        values = np.zeros((len(mesh.points), 3))
        for side, jump in zip(("right", "left"), jumps, strict=True):
            known = np.zeros((len(own.points), 3))
            known[own.side_nodes(side)] = jump
            values[mesh.side_nodes(side)] = jump if mesh is own else carried(known, own, mesh, side)
        return picture.interpolate(values)

    def _with_contact(
        self, tooth: int, contact: Contact, moved: Array, stress: Array, jumps: tuple[Array, Array]
    ) -> DrawnSector:
        ring, sector = self.ring.mesh, contact.sector
        mesh = ring if sector is None else sector.mesh
        picture = picture_of(mesh, (contact.at.points[0], FOCUS * contact.half_width))
        points, displacement = picture.interpolate(mesh.points), picture.interpolate(moved)
        components = picture.interpolate(stress) + self._spread(jumps, picture, mesh)
        tensor = components[:, [[0, 2], [2, 1]]]
        if sector is None:
            near_moved, near_stress = near_field(points, contact, self.ring.law, ring.module)
            displacement, tensor = displacement + near_moved, tensor + near_stress
        return DrawnSector(tooth, picture, points, displacement, tensor, contact)


def gear_drawing(ring: Ring) -> GearDrawing:
    """Prepare the drawing of a gear; its cells are those of the coarsest mesh of the family."""
    mesh = ring.mesh
    by_cut = np.zeros((mesh.unknowns, len(ring.cut)))
    by_cut[ring.inner] = -ring.inner_by_cut
    by_cut[ring.cut, np.arange(len(ring.cut))] = 1.0
    recovery = nodal_stress(mesh, ring.law)
    picture = picture_of(mesh)
    cuts = by_cut.shape[1]

    def stress_at(nodes: Integers) -> Array:
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        return np.asarray(recovery.matrix[rows] @ by_cut)

    seam = stress_at(mesh.side_nodes("right")), stress_at(mesh.side_nodes("left"))
    moved = picture.interpolate(by_cut.reshape(-1, 2, cuts)).reshape(-1, cuts)
    stress = picture.interpolate((recovery.matrix @ by_cut).reshape(-1, 3, cuts)).reshape(-1, cuts)
    return GearDrawing(ring, recovery, picture, by_cut, moved, stress, seam)
