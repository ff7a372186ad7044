"""Wind-up of a gear's body: rotation of a ring under the torque of its teeth, held at the bore or by its own inertia.

In a ring the part of the tangential displacement that does not change with the angle knows only the torque that
crosses each circle, M(r): r dphi/dr = M/(2 pi G b r^2). What the teeth do beyond the root circle, the plane's state
and Poisson's ratio do not enter. With M = T s(r), the deflection along the line of action times b/F is

    r_b^2/(2 pi G) Int s(r)^2 dr/r^3,   r_h to r_f.

Where rings of different thickness t b follow each other, as hub, web and rim do, each has its own t b and the turns add
up.

s = 1: all of the torque leaves at the held bore. A ring that turns freely hands the torque to its own inertia
instead, and s(r) is the share of the inertia inside r, since that part is what the torque has still to accelerate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gears.tooth.blank import Zone


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


def body_wind_up(zones: Sequence[Zone], base_radius: float, shear_modulus: float) -> float:
    """Deflection along the line of action by the twist of a gear's body, held at its bore, times b / F.

    Sum over the zones of `ring_wind_up` over their thickness t: the torque crosses all of them.

    Parameters
    ----------
    zones : sequence of Zone
        `ToothProfile.zones`.
    base_radius : float
        r_b [m].
    shear_modulus : float
        G [Pa].

    Returns
    -------
    float
        delta b / F [m^2/N].

    Examples
    --------
    >>> from gears.tooth.blank import Zone
    >>> body_wind_up((Zone(30e-3, 33.5e-3, 1.0), Zone(16.75e-3, 30e-3, 0.3)), 33.83e-3, shear_modulus=79.2e9)
    9.656...e-12
    """
    return sum(
        ring_wind_up(zone.outer, zone.inner, base_radius, shear_modulus) / zone.thickness for zone in zones
    )


def inertial_wind_up(
    zones: Sequence[Zone], base_radius: float, shear_modulus: float, bore_inertia: float = 0.0
) -> float:
    """Deflection as of `body_wind_up` of a body whose torque is balanced by its own inertia.

    With the inertias J(r) inside a circle over pi rho b/2, the share of the torque that crosses a zone's outer circle
    is J(r_o)/J, and inside the zone the torque falls as in a ring of thickness t whose bore carries J(r_i)/t:

        Sum ring_wind_up(r_o, r_i)/t inertial_share(r_i/r_o, J(r_i)/(t r_o^4)) [J(r_o)/J]^2 .

    Parameters
    ----------
    zones, base_radius, shear_modulus : Sequence of Zone, float, float
        As of `body_wind_up`.
    bore_inertia : float
        Of what turns with the bore, over pi rho b/2 [m^4].

    Returns
    -------
    float
        delta b / F [m^2/N].

    Examples
    --------
    >>> from gears.tooth.blank import Zone
    >>> solid = (Zone(16.75e-3, 33.5e-3, 1.0),)
    >>> inertial_wind_up(solid, 33.83e-3, 79.2e9) / body_wind_up(solid, 33.83e-3, 79.2e9)
    0.0933...
    """
    inside, parts = bore_inertia, []
    for zone in reversed(zones):
        twist = ring_wind_up(zone.outer, zone.inner, base_radius, shear_modulus) / zone.thickness
        share = inertial_share(zone.inner / zone.outer, inside / (zone.thickness * zone.outer**4))
        inside += zone.thickness * (zone.outer**4 - zone.inner**4)
        parts.append(twist * share * inside**2)
    return sum(parts) / inside**2
