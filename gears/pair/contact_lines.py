"""Lines of contact of a pair in the plane of action: how long they are together, over the mesh cycle, in closed form.

In the plane of action, x along the transverse base tangent from A and z along the face, the lines are straight, a base
pitch p_bt apart in x and inclined by the base helix angle. With the middle of the face at t base pitches from A, line j
is at t + j + eps_beta u at the place u of the face, -1/2 to 1/2, and touches where that is within 0 to eps_alpha. The
part of the face that line j touches is therefore

    f_j(t) = clip(1/2 + (eps_alpha - t - j)/eps_beta) - clip(1/2 - (t + j)/eps_beta),   clip to 0 .. 1,

and all lines together are L(t) = b/cos beta_b Sum_j f_j(t) long. L(t) is the step function of spur gears averaged over
eps_beta, of period 1, with the mean b eps_alpha/cos beta_b and harmonics 2 sinc(n eps_alpha) sinc(n eps_beta) over it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from base import Array, Faults, described, quantity, record
from base.results import EXACT
from gears.tooth.errors import GeometryError

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry

__all__ = ["ContactLines", "contact_lines"]

LEAST_OVERLAP = 1e-300
"""Overlap ratio that stands for none: f_j is then a step."""


@record
class ContactLines:
    """Lines of contact of a pair with even flanks."""

    contact_ratio: float = quantity("1", "transverse contact ratio eps_alpha")
    overlap_ratio: float = quantity("1", "overlap ratio eps_beta")
    across: float = quantity(
        "m", "length of a line of contact over the whole face, b / cos beta_b", shown="mm"
    )

    no_error = EXACT

    def __repr__(self) -> str:
        """One line: mean, minimum and maximum length."""
        lengths = f"{1e3 * self.minimum:.6g} to {1e3 * self.maximum:.6g}"
        return f"ContactLines(mean length {1e3 * self.mean:.6g} mm, {lengths} mm)"

    def length(self, position: npt.ArrayLike) -> Array:
        """Total length of the lines of contact.

        Parameters
        ----------
        position : float or (n,) array
            t, place of the middle of the face on the path of contact, from A [base pitches], as ``position`` of
            ``fem.MeshCycle``.

        Returns
        -------
        array like `position`
            L(t) [m]; where spur gears take up or lose a pair, the mean of before and after.
        """
        first = np.asarray(position, dtype=float) % 1.0
        reach = 0.5 * self.overlap_ratio
        line = np.arange(-math.ceil(reach) - 1, math.ceil(self.contact_ratio + reach) + 1)
        place = first[..., None] + line
        slope = 1.0 / max(self.overlap_ratio, LEAST_OVERLAP)
        started = np.clip(0.5 + place * slope, 0.0, 1.0)
        ended = np.clip(0.5 + (place - self.contact_ratio) * slope, 0.0, 1.0)
        return np.asarray(self.across * (started - ended).sum(axis=-1))

    @described("m", shown="mm")
    def mean(self) -> float:
        """Mean total length of the lines of contact, b eps_alpha / cos beta_b."""
        return self.across * self.contact_ratio

    @described("m", shown="mm")
    def minimum(self) -> float:
        """Minimum total length in the mesh cycle."""
        return float(self.length(self._turns).min())

    @described("m", shown="mm")
    def maximum(self) -> float:
        """Maximum total length in the mesh cycle."""
        return float(self.length(self._turns).max())

    def segments(self, position: float) -> tuple[Array, Array]:
        """Lines that touch at one position, each from end to end.

        Parameters
        ----------
        position : float
            t as of `length`.

        Returns
        -------
        (lines, 2) array, (lines, 2) array
            Place x/p_bt on the path of contact, 0 to eps_alpha, and place z/b along the face, -1/2 to 1/2, at the ends
            of each line, by z; x grows with z, as with a right-handed driver that turns anticlockwise about z:
            mirror z of a left-handed one. Together they are `length` long.
        """
        reach = 0.5 * self.overlap_ratio
        line = np.arange(-math.ceil(reach) - 1, math.ceil(self.contact_ratio + reach) + 1)
        middle = position % 1.0 + line[:, None]
        slope = 1.0 / max(self.overlap_ratio, LEAST_OVERLAP)
        along = np.clip((np.array([0.0, self.contact_ratio]) - middle) * slope, -0.5, 0.5)
        touches = along[:, 1] > along[:, 0]
        place = middle + self.overlap_ratio * along
        return place[touches], along[touches]

    def harmonics(self, number: int) -> Array:
        """Amplitudes of the first harmonics of the total length over its mean.

        Parameters
        ----------
        number : int
            How many, from the mesh frequency on.

        Returns
        -------
        (number,) array
            2 abs(sinc(n eps_alpha) sinc(n eps_beta)), sinc(x) = sin(pi x)/(pi x), for n = 1 to `number`; zero where
            n eps_alpha or n eps_beta is whole.
        """
        with Faults(GeometryError) as faults:
            faults.whole("number", number, 1, 10**6, "ask for one harmonic at least")
        n = np.arange(1, number + 1)
        return np.asarray(2.0 * np.abs(np.sinc(n * self.contact_ratio) * np.sinc(n * self.overlap_ratio)))

    @property
    def _turns(self) -> Array:
        """Positions where L(t) bends, and the middles between them: its extremes, also those of steps."""
        half, end = 0.5 * self.overlap_ratio, self.contact_ratio
        bends = np.sort(np.array([-half, half, end - half, end + half]) % 1.0)
        return np.concatenate([bends, bends + 0.5 * (np.roll(bends, -1) - bends) % 0.5])


def contact_lines(pair: PairGeometry) -> ContactLines:
    """Lines of contact of a pair, over the face that both gears have.

    Parameters
    ----------
    pair : GearPair
        Spur or helical; leads and reliefs are left out.

    Returns
    -------
    ContactLines
        Their total length over the mesh cycle.

    References
    ----------
    ISO 21771:2007, clause 5: transverse contact ratio, overlap ratio, lines of contact.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=math.radians(10.0))
    >>> lines = contact_lines(pair)
    >>> lines
    ContactLines(mean length 67.5766 mm, 64.9973 to 68.8657 mm)
    >>> lines.harmonics(2).round(4)
    array([0.031 , 0.0147])
    """
    return ContactLines(
        pair.contact_ratio, pair.overlap_ratio, float(pair.face_width) / pair.helix.base_cosine
    )
