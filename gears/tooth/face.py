"""How flanks differ along the face: lead modifications of each gear, and the alignment of both.

z runs along the face from -b/2 to b/2, the same for both gears. Twist and topography differ over the profile too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from base import Array, Fault, Faults, Limit
from gears.tooth.flank_curves import LeadTrace
from gears.tooth.topography import Topography

__all__ = ["ALIGNED", "STRAIGHT", "Alignment", "Lead"]

LEAD_LIMITS = {
    "crowning": Limit(-1e-3, 1e-3, "m", "give the material removed at both ends in metres"),
    "slope": Limit(-1e-3, 1e-3, "m", "give the deviation over the face width in metres"),
    "end_relief": Limit(0.0, 1e-3, "m", "give the material removed at both ends in metres"),
    "end_relief_length": Limit(0.0, 1e3, "m", "give the length from either end in metres"),
    "twist": Limit(-1e-3, 1e-3, "m", "give by how much the slopes at both ends differ, in metres"),
}
"""What the numbers of a lead may be."""

ALIGNMENT_LIMITS = {
    "in_plane": Limit(-5e-3, 5e-3, "m", "give the deviation over the face width in metres"),
    "out_of_plane": Limit(-5e-3, 5e-3, "m", "give the deviation over the face width in metres"),
}
"""What the numbers of an alignment may be."""


@dataclass(frozen=True)
class Lead:
    r"""What is removed from one gear's flanks along the face, the same on every tooth.

    Removed at z, with x = 2 z/b: ``crowning x^2 + slope x/2 + end_relief max(0, 1 - (b/2 - |z|)/length)^2``, less the
    material of a measured trace. Removed at z and at the curvature radius rho, besides, with s from -1 at the start of
    the active profile to 1 at its end at the tip, linear in rho (the roll length): ``twist x s/4``, less the material
    of a topography. All amounts count in the transverse plane, normal to the involute.

    Parameters
    ----------
    crowning : float
        Material removed at both ends by a parabola over the whole face [m].
    slope : float
        Deviation over the face width, zero at mid-face; material is lacking where z > 0 [m].
    end_relief : float
        Material removed at both ends by a parabola over a part of the face [m].
    end_relief_length : float
        Length of that part, from either end [m].
    trace : LeadTrace, optional
        Measured lead, on top of these.
    twist : float
        Flank twist (bias) [m]: by how much the slope of the profile at the end z = b/2 exceeds that at z = -b/2,
        S_alpha, and as well the slope of the lead at the tip that at the start of the active profile, S_beta. ISO
        21771 has these two twists; over the whole face and the whole active profile, as here, they are equal, and
        corners of the flank lack a quarter of it. Slopes are those of material removed, as `slope` is: above 0 it
        lacks at the tip where z > 0, and at the start of the profile where z < 0. Slope deviations of ISO 1328-1 count
        material in excess, so that a twist by them has the other sign.
    topography : Topography, optional
        Table over profile and face, measured or prescribed, on top of these.

    Examples
    --------
    >>> Lead(crowning=10e-6).removed(np.array([-0.02, 0.0, 0.01]), 0.04)
    array([1.0e-05, 0.0e+00, 2.5e-06])

    Lead slopes at start, middle and tip of the active profile, 16 um from first to last:

    >>> rho = np.array([8e-3, 13e-3, 18e-3])
    >>> ends = [Lead(twist=16e-6).removed_at(z, rho, 0.04, (8e-3, 18e-3)) for z in (-0.02, 0.02)]
    >>> (1e6 * (ends[1] - ends[0])).round(9) + 0.0
    array([-8.,  0.,  8.])
    """

    crowning: float = 0.0  # C_beta, m
    slope: float = 0.0  # f_Hbeta, m
    end_relief: float = 0.0  # C_beta I = C_beta II, m
    end_relief_length: float = 0.0  # L_CI = L_CII, m
    trace: LeadTrace | None = None
    twist: float = 0.0  # S_alpha = S_beta, m
    topography: Topography | None = None

    @property
    def topographic(self) -> bool:
        """Whether what is removed along the face depends on the place on the profile too."""
        return bool(self.twist) or self.topography is not None

    def faults(self, path: str) -> tuple[Fault, ...]:
        """All faults of the values by themselves, empty when there are none."""
        collector = Faults.of(self, LEAD_LIMITS, f"{path}.")
        if self.end_relief and not self.end_relief_length > 0.0:
            allowed = "must be more than 0 m with end_relief"
            collector.add(
                f"{path}.end_relief_length", self.end_relief_length, allowed, "give its length in metres"
            )
        if self.trace is not None:
            collector.extend(self.trace.faults(f"{path}.trace"))
        table = self.topography
        if collector.instance(f"{path}.topography", table, Topography, optional=True) and table is not None:
            collector.extend(table.faults(f"{path}.topography"))
        return tuple(collector.found)

    def removed(self, z: Array, face_width: float) -> Array:
        """Material lacking at z (n,), but for twist and topography [m]."""
        x = 2.0 * z / face_width
        lacking = self.crowning * x**2 + 0.5 * self.slope * x
        if self.end_relief:
            inside = 0.5 * face_width - np.abs(z)
            lacking = lacking + self.end_relief * np.maximum(0.0, 1.0 - inside / self.end_relief_length) ** 2
        if self.trace is not None:
            lacking = lacking - self.trace.at(z)
        return np.asarray(lacking)

    def removed_at(
        self, z: float | Array, rho: float | Array, face_width: float, span: tuple[float, float]
    ) -> Array:
        """All material that the flank lacks by its lead, at places along the face and on the profile [m].

        Tip relief and profile deviations, which depend on rho alone, are not in it.

        Parameters
        ----------
        z : (...) array
            From the middle of this gear's face [m].
        rho : (...) array
            Curvature radii of its flank [m]; arrays broadcast. Beyond the active profile the twist goes on, and the
            topography keeps the value of its edge.
        face_width : float
            b of this gear [m].
        span : (float, float)
            Curvature radii at start and end of its active profile (``GearPair.active_profiles``) [m].
        """
        z, rho = np.asarray(z, dtype=float), np.asarray(rho, dtype=float)
        lacking = self.removed(z, face_width)
        if self.twist:
            low, high = span
            up = (2.0 * rho - low - high) / (high - low)
            lacking = lacking + 0.25 * self.twist * (2.0 * z / face_width) * up
        if self.topography is not None:
            lacking = lacking - self.topography.at(rho, z)
        return np.asarray(np.broadcast_to(lacking, np.broadcast_shapes(z.shape, rho.shape)))


STRAIGHT = Lead()


@dataclass(frozen=True)
class Alignment:
    """How the axes of both gears are out of parallel, as deviations over the face width.

    Parameters
    ----------
    in_plane : float
        In the plane of action: opens the gap of the loaded flanks by ``in_plane z/b`` [m].
    out_of_plane : float
        Across the plane of action, positive where it brings the axes apart at z > 0 [m]; the sign counts where flanks
        on both sides of the teeth bear. Involutes keep touching along their line of action when they are shifted
        across it, so that the gap grows by its square alone, ``(out_of_plane z/b)^2/(2 R)`` with R the radius of
        relative curvature.

    Examples
    --------
    >>> Alignment(in_plane=20e-6).gap(np.array([-0.02, 0.02]), 0.04, 6e-3)
    array([-1.e-05,  1.e-05])
    """

    in_plane: float = 0.0  # f_Sigma beta projected, m
    out_of_plane: float = 0.0  # f_Sigma delta projected, m

    def opposite(self, working_pressure_angle: float) -> Alignment:
        r"""The same axes as the flanks on the other side of the teeth see them.

        Both lines of action stand at the working pressure angle from the normal of the line of centres, on either side
        of it. With :math:`2\alpha_w` between their directions

        .. math:: f'_{in} = -f_{in}\cos 2\alpha_w + f_{out}\sin 2\alpha_w, \qquad
            f'_{out} = f_{in}\sin 2\alpha_w + f_{out}\cos 2\alpha_w .

        Parameters
        ----------
        working_pressure_angle : float
            alpha_w [rad].

        Examples
        --------
        Axes that are only further apart at one end open both sides alike:

        >>> import numpy as np
        >>> alpha = np.radians(20.0)
        >>> apart = Alignment(20e-6 * np.sin(alpha), 20e-6 * np.cos(alpha))
        >>> other = apart.opposite(alpha)
        >>> bool(np.allclose([other.in_plane, other.out_of_plane], [apart.in_plane, apart.out_of_plane]))
        True
        """
        cosine, sine = np.cos(2.0 * working_pressure_angle), np.sin(2.0 * working_pressure_angle)
        return Alignment(
            float(-self.in_plane * cosine + self.out_of_plane * sine),
            float(self.in_plane * sine + self.out_of_plane * cosine),
        )

    def faults(self, path: str) -> tuple[Fault, ...]:
        """All faults of the values, empty when there are none."""
        return tuple(Faults.of(self, ALIGNMENT_LIMITS, f"{path}.").found)

    def gap(self, z: Array, face_width: float, radius: Array | float) -> Array:
        """Gap at z [m], less that at mid-face; arrays broadcast."""
        x = z / face_width
        return np.asarray(self.in_plane * x + (self.out_of_plane * x) ** 2 / (2.0 * radius))


ALIGNED = Alignment()
