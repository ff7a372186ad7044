"""What free ends add to the displacement of a gear's solid: a table over places of loads, for pictures.

A prism with free ends less one between walls (``fem.elasticity.free_ends``), here with its whole section instead of the
flank alone. The difference is smooth in the load's place, so that few places suffice, and each of the four prisms of a
gear can be forgotten when its part of the table is taken. Beside a load at the very end it is not quite smooth: between
places of the table the outermost 1/64 of the face is up to a fifth of that part off, the next 1/64 a twentieth.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Array, Integers, record
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.free_ends import HalfFace, half_face
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import Prism, Section, prism
from fem.influence.flank_variable import RootVariable
from fem.influence.gear_shape import MeshedShape
from fem.influence.series import FlankFit, FlankSeries

__all__ = ["EndFields", "end_fields"]

PLACES = 6
"""Of loads, over the root of what rho lacks to the tip corner."""


@record
class EndFields:
    """What free ends add to the displacement of some teeth by loads on tooth 0, in modules and E*.

    Attributes
    ----------
    half : HalfFace
    nodes : (used,) array of int
        Of the section.
    z : (layers,) array
        From mid-face, growing.
    beside : int
        Teeth on either side.
    even, odd : FlankSeries of (psi, teeth, layers, used, 3)
        Over the root, by unit functionals that are equal and opposite on both halves.
    """

    half: HalfFace
    nodes: Integers
    z: Array
    beside: int
    even: FlankSeries
    odd: FlankSeries

    def moved(self, rho: float, forces: Array, edges: Array, teeth: Sequence[int]) -> Array:
        """Displacements (teeth, layers, used, 3) in each tooth's frame by forces on cells, times E*.

        Parameters
        ----------
        rho : float
            Where tooth 0 is loaded.
        forces : (cells,) array
        edges : (cells + 1,) array
            Of the cells, growing, from mid-face.
        teeth : sequence of int
            Counted from the loaded one, at most ``beside`` from it.
        """
        place = self.even.basis(np.array([rho]))[0]
        end = self.half.ends[-1]
        same, opposite = self.half.means(np.clip(edges, -end, end))
        positions = np.asarray(teeth) + self.beside
        parts = (self.even, same @ forces), (self.odd, opposite[1:] @ forces)
        by_parity = [
            np.einsum("a,p,aptlnc->tlnc", place, by, series.coefficients[:, :, positions])
            for series, by in parts
        ]
        return np.asarray(0.5 * (by_parity[0] + by_parity[1]))


def end_fields(
    meshed: MeshedShape, over: Section, width: float, z: Array, beside: int, nodes: Integers
) -> EndFields:
    """Solve a gear with free ends and between walls, and keep how its teeth move.

    Parameters
    ----------
    meshed : MeshedShape
        The gear, in modules.
    over : Section
    width : float
        Of the gear's face.
    z : (layers,) array
        Where the teeth are looked at, from mid-face.
    beside : int
        Teeth that are looked at on either side of the loaded one.
    nodes : (used,) array of int
        Of the section that are looked at.
    """
    profile, half = meshed.shape.profile, half_face(0.5 * width, 1.0)
    rho, end = sample_places(profile, PLACES), profile.flank_rho[1]
    root = RootVariable((float(rho[0]), float(rho[-1])), end)
    at, teeth = flank_points(over.mesh, rho), range(-beside, beside + 1)
    weights = FlankFit(root, root.unit(rho), PLACES - 1).weights

    def series(even: bool) -> FlankSeries:
        added: Array = np.zeros(())
        for free in (True, False):
            solved = prism(over, half.face(even, free))
            by_load = solved.displacements(at, teeth)[:, nodes]
            added = added + (1.0 if free else -1.0) * _at_layers(by_load, solved, half, z, even)
        moved = added.reshape(*added.shape[:-1], len(rho), -1)  # (teeth, layers, used, 3, places, psi)
        return FlankSeries(root, np.einsum("ai,tlncip->aptlnc", weights, moved, optimize=True))

    return EndFields(half, nodes, z, beside, series(True), series(False))


def _at_layers(by_load: Array, solved: Prism, half: HalfFace, z: Array, even: bool) -> Array:
    """Displacements (teeth, layers, used, 3, loads) from factors of the functions over half a face."""
    values, side = half.values(np.abs(z)), np.sign(z)
    first = 0 if even else 1
    psi = values[first : first + solved.psi] * (1.0 if even else side)
    phi = values[1 - first : 1 - first + solved.phi] * (side if even else 1.0)
    teeth, used, _, loads = by_load.shape
    plane = by_load[:, :, : 2 * solved.psi].reshape(teeth, used, solved.psi, 2, loads)
    moved = np.empty((teeth, len(z), used, 3, loads))
    moved[:, :, :, :2] = np.einsum("tnpar,pl->tlnar", plane, psi, optimize=True)
    moved[:, :, :, 2] = np.einsum("tnqr,ql->tlnr", by_load[:, :, 2 * solved.psi :], phi, optimize=True)
    return moved
