"""Wind-up of a gear's body: the turn of a ring under the torque of its teeth, held at the bore or by its own inertia.

In a ring the part of the tangential displacement that does not change with the angle knows only the torque that
crosses each circle, M(r): r dphi/dr = M/(2 pi G b r^2). What the teeth do beyond the root circle, the plane's state
and Poisson's ratio do not enter. With M = T s(r), the deflection along the line of action times b/F is

    r_b^2/(2 pi G) Int s(r)^2 dr/r^3,   r_h to r_f.

s = 1: all of the torque leaves at the held bore. A ring that turns freely hands the torque to its own inertia
instead, and s(r) is the share of the inertia inside r, since that part is what the torque has still to accelerate.
"""

from __future__ import annotations

import math


def ring_wind_up(root_radius: float, bore_radius: float, base_radius: float, shear_modulus: float) -> float:
    """Deflection along the line of action by the twist of a ring, times b / F.

    r_b^2 / (4 pi G) (1 / r_bore^2 - 1 / r_f^2), the exact solution of a ring between bore and root circle
    under the torque F r_b. It is exact for the mean turn of the root circle of a gear as well.

    Parameters
    ----------
    root_radius, bore_radius, base_radius : float
        r_f, radius of the bore, r_b [m].
    shear_modulus : float
        G [Pa].

    Returns
    -------
    float
        delta b / F [m^2/N].

    Examples
    --------
    >>> ring_wind_up(33.5e-3, 16.75e-3, 33.83e-3, shear_modulus=79.2e9)
    3.0739768...e-12
    """
    return base_radius**2 / (4.0 * math.pi * shear_modulus) * (1.0 / bore_radius**2 - 1.0 / root_radius**2)


def inertial_share(radius_ratio: float, bore_inertia: float = 0.0) -> float:
    """Wind-up of a ring whose torque is balanced by inertia, over that of the same ring held at its bore.

    With h = r_bore/r_f, x = r/r_f and inertias over that of the solid disc, pi rho b r_f^4/2,

        s(x) = (i_s + x^4 - h^4)/(i_s + 1 - h^4),   share = Int s^2 dx/x^3 / Int dx/x^3,   h to 1,

    which is with g = h^2

        [i_s^2 + 2 i_s g (1 - g) + g (1 - g)^2 (1 + 3 g)/3] / (i_s + 1 - g^2)^2.

    It falls to 0 for a small bore, to 1/3 for a thin ring, and rises to 1 with a heavy hub.

    Parameters
    ----------
    radius_ratio : float
        r_bore/r_f, between 0 and 1.
    bore_inertia : float
        i_s, of what turns with the bore: hub, shaft.

    Returns
    -------
    float
        Dimensionless, from 0 to 1.

    Examples
    --------
    >>> [round(inertial_share(h), 4) for h in (0.2, 0.5, 0.7, 0.9)]
    [0.0138, 0.0933, 0.1817, 0.2827]
    """
    g, i = radius_ratio**2, bore_inertia
    of_ring = g * (1.0 - g) ** 2 * (1.0 + 3.0 * g) / 3.0
    return (i**2 + 2.0 * i * g * (1.0 - g) + of_ring) / (i + 1.0 - g**2) ** 2
