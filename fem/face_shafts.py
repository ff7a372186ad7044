"""What the shafts of both gears give way over the cells of the face, and what of it is no deflection of the teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.face_setting import FaceSetting

if TYPE_CHECKING:
    from gears import GearPair, LoadShare

__all__ = ["ShaftsUnderFace", "shafts_under_face"]


@record
class ShaftsUnderFace:
    """Flexibility of both shafts along the line of action.

    Attributes
    ----------
    between : (2, cells, cells) array
        Of pinion's and wheel's shaft, between middles of cells [m/N]; zero of rigid ones.
    middle : (2, cells) array
        At mid-face by forces on cells [m/N].
    """

    between: Array
    middle: Array

    def measured_between(self, share: LoadShare, loads: Array, slopes: Array) -> LoadShare:
        """Measure the deflection between the gears' mid-faces, so that it counts the teeth and bodies alone.

        D falls by the shafts' deflection at mid-face, dF/dD grows by what of dD that is. No force changes.

        Parameters
        ----------
        share : LoadShare
            Of pairs, with D that holds the shafts too.
        loads, slopes : (..., cells) arrays
            Forces on the cells of all pairs together [N], and their slopes by D [N/m].
        """
        from gears.load_sharing import LoadShare

        middle = self.middle.sum(axis=0)
        left = 1.0 - slopes @ middle
        return LoadShare(
            share.forces,
            share.transmission_error - loads @ middle,
            share.stiffness / left,
            share.pair_stiffness / left[..., None],
            share.iterations,
        )

    def misalignment(self, loads: Array) -> Array:
        """Slope of each shaft's deflection over the cells, by least squares, times the face width (2, ...) [m]."""
        cells = loads.shape[-1]
        x = (np.arange(cells) + 0.5) / cells - 0.5
        return np.asarray(np.einsum("gcd,...d,c->g...", self.between, loads, x / (x @ x), optimize=True))


def shafts_under_face(face: FaceSetting, pair: GearPair) -> ShaftsUnderFace | None:
    """Bend and twist the shafts of a face; None where both are rigid."""
    from gears.shaft_face import shaft_over_face

    if all(shaft is None for shaft in face.shafts):
        return None
    between, middle = np.zeros((2, face.cells, face.cells)), np.zeros((2, face.cells))
    z = face.middles(pair.face_width)
    for gear, shaft in enumerate(face.shafts):
        if shaft is not None:
            found = shaft_over_face(shaft, z, pair.base_radii[gear], pair.face_offsets[gear])
            between[gear], middle[gear] = found.between, found.middle
    return ShaftsUnderFace(between, middle)
