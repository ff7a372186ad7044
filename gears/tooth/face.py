"""How flanks differ along the face: lead modifications of each gear, and the alignment of both.

z runs along the face from -b/2 to b/2, the same for both gears.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from base import Array, Fault, Faults, Limit
from gears.tooth.flank_curves import LeadTrace

__all__ = ["ALIGNED", "STRAIGHT", "Alignment", "Lead"]

LEAD_LIMITS = {
    "crowning": Limit(-1e-3, 1e-3, "m", "give the material removed at both ends in metres"),
    "slope": Limit(-1e-3, 1e-3, "m", "give the deviation over the face width in metres"),
    "end_relief": Limit(0.0, 1e-3, "m", "give the material removed at both ends in metres"),
    "end_relief_length": Limit(0.0, 1e3, "m", "give the length from either end in metres"),
}
"""What the numbers of a lead may be."""

ALIGNMENT_LIMITS = {
    "in_plane": Limit(-5e-3, 5e-3, "m", "give the deviation over the face width in metres"),
    "out_of_plane": Limit(-5e-3, 5e-3, "m", "give the deviation over the face width in metres"),
}
"""What the numbers of an alignment may be."""


@dataclass(frozen=True)
class Lead:
    """What is removed from one gear's flanks along the face, the same on every tooth.

    Removed at z, with x = 2 z/b: ``crowning x^2 + slope x/2 + end_relief max(0, 1 - (b/2 - |z|)/length)^2``, less the
    material of a measured trace.

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

    Examples
    --------
    >>> Lead(crowning=10e-6).removed(np.array([-0.02, 0.0, 0.01]), 0.04)
    array([1.0e-05, 0.0e+00, 2.5e-06])
    """

    crowning: float = 0.0  # C_beta, m
    slope: float = 0.0  # f_Hbeta, m
    end_relief: float = 0.0  # C_beta I = C_beta II, m
    end_relief_length: float = 0.0  # L_CI = L_CII, m
    trace: LeadTrace | None = None

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
        return tuple(collector.found)

    def removed(self, z: Array, face_width: float) -> Array:
        """Material lacking at z (n,) [m]."""
        x = 2.0 * z / face_width
        lacking = self.crowning * x**2 + 0.5 * self.slope * x
        if self.end_relief:
            inside = 0.5 * face_width - np.abs(z)
            lacking = lacking + self.end_relief * np.maximum(0.0, 1.0 - inside / self.end_relief_length) ** 2
        if self.trace is not None:
            lacking = lacking - self.trace.at(z)
        return np.asarray(lacking)


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
