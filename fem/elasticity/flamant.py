"""Line load on the edge of an elastic half-plane: displacement and stress in closed form.

The load is 1 N per metre of face width, along the inward normal unless it leans. With r the distance from the
load, theta measured from the load's direction and lengths taken in units of ``length``:

    u_r     = -2/(pi E*) [ln(r/length) cos(theta) + (1 - nu*)/2 theta sin(theta)]
    u_theta =  2/(pi E*) [ln(r/length) sin(theta) + (1 + nu*)/2 sin(theta) - (1 - nu*)/2 theta cos(theta)]
    sigma_rr = -2 cos(theta)/(pi r), all other components zero

(Flamant 1892; K. L. Johnson, Contact Mechanics, 1985, section 2.2). It stays a solution of elasticity beyond
the half-plane, up to the cut theta = +-pi along the outward normal, which must not meet material.

A force that leans from the inward normal by some angle has the same field about its own direction. The bare
theta (not those in sine and cosine) is then still counted from the inward normal, so that the cut stays where
it is; that moves the whole body across the force, which the zero of displacement leaves open.
"""

from __future__ import annotations

import numpy as np

from base import Array
from fem.elasticity.plane_elasticity import PlaneElasticity

__all__ = [
    "displacement",
    "hertz_half_width",
    "hertz_indentation",
    "hertz_stress",
    "leaning",
    "stress",
    "strips_stress",
    "traction",
]


def _frame(points: Array, load: Array, inward: Array) -> tuple[Array, Array, Array]:
    """Components along the load and across it, and the distance."""
    away = points - load
    along = np.einsum("...a,...a->...", away, inward)
    across = np.einsum("...a,...a->...", away, _turned(inward))
    return along, across, np.hypot(along, across)


def _turned(direction: Array) -> Array:
    """Directions (..., 2) a quarter turn anticlockwise."""
    return np.stack([-direction[..., 1], direction[..., 0]], axis=-1)


def leaning(inward: Array, lean: float | Array) -> Array:
    """Directions (..., 2) turned anticlockwise by an angle, or by one (...) for each [rad]."""
    if not np.any(lean):
        return inward
    turn = np.asarray(lean)[..., None]
    return np.asarray(np.cos(turn) * inward + np.sin(turn) * _turned(inward))


def displacement(
    points: Array,
    load: Array,
    inward: Array,
    law: PlaneElasticity,
    length: float,
    lean: float | Array = 0.0,
) -> Array:
    """Displacement (..., 2) per unit line load [m per N/m] at points (..., 2), none of them the load itself.

    One load for all points, or a load and its inward normal (..., 2) for each; the shapes are broadcast. The force
    leans from the normal by the angle ``lean`` [rad], anticlockwise.

    With theta in the second place of both equations above, the components along and across the force are
    -2/(pi E*) [ln(r/length) + (1 + nu*)/2 sin^2] and 2/(pi E*) [(1 + nu*)/2 sin cos - (1 - nu*)/2 theta].
    """
    x, y = (points[..., axis] - load[..., axis] for axis in (0, 1))
    n_x, n_y = inward[..., 0], inward[..., 1]
    along, across = x * n_x + y * n_y, y * n_x - x * n_y
    theta = np.arctan2(across, along)
    if np.any(lean):
        c, s = np.cos(lean), np.sin(lean)
        n_x, n_y = c * n_x - s * n_y, c * n_y + s * n_x
        along, across = c * along + s * across, c * across - s * along
    factor = 2 / (np.pi * law.plane_modulus)
    half_minus, half_plus = 0.5 * (1 - law.plane_poisson), 0.5 * (1 + law.plane_poisson)
    r2 = along**2 + across**2
    sine = across / r2
    u_along = -factor * (0.5 * np.log(r2 / length**2) + half_plus * across * sine)
    u_across = factor * (half_plus * along * sine - half_minus * theta)
    return np.stack([u_along * n_x - u_across * n_y, u_along * n_y + u_across * n_x], axis=-1)


def stress(points: Array, load: Array, inward: Array) -> Array:
    """In-plane stresses (n, 2, 2) per unit line load [1/m]; zero at the load itself (never used there)."""
    along, _, r = _frame(points, load, inward)
    away = points - load
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.where(r > 0, -2 * along / (np.pi * r**4), 0.0)
    return size[:, None, None] * away[:, :, None] * away[:, None, :]


def traction(points: Array, normal: Array, load: Array, inward: Array) -> Array:
    """Traction sigma . n (n, 2) per unit line load [1/m] on facets with outward normals (n, 2)."""
    along, _, r = _frame(points, load, inward)
    away = points - load
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.where(r > 0, -2 * along * np.einsum("ni,ni->n", away, normal) / (np.pi * r**4), 0.0)
    return size[:, None] * away


def hertz_half_width(line_load: float | Array, radius: Array, reduced_modulus: float) -> Array:
    """Half-width of a Hertzian line contact a = sqrt(8 w R/(pi E')) [m].

    Parameters
    ----------
    line_load : array
        w [N/m]
    radius : array
        R = R1 R2/(R1 + R2) [m]
    reduced_modulus : float
        E' = 2/(1/E1* + 1/E2*) [Pa]
    """
    width: Array = np.sqrt(8 * line_load * radius / (np.pi * reduced_modulus))
    return width


def hertz_indentation(half_width: float | Array, law: PlaneElasticity, length: float) -> Array:
    """Displace one surface under the middle of a Hertz pressure, per unit line load [m per N/m].

    The Flamant displacement of the edge averaged over the pressure,
    2/(pi E*) [ln(2 length/a) + 1/2 - (1 + nu*)/2]: it is relative to the same zero as ``displacement``.
    """
    factor = 2 / (np.pi * law.plane_modulus)
    indentation: Array = factor * (np.log(2 * length / half_width) + 0.5 - 0.5 * (1 + law.plane_poisson))
    return indentation


def hertz_stress(points: Array, centre: Array, inward: Array, half_width: float, peak: float) -> Array:
    """In-plane stresses (n, 2, 2) [Pa] under a Hertz pressure of the given peak on a half-plane.

    McEwen's closed form (K. L. Johnson, Contact Mechanics, 1985, equations 4.49):
    with x along the edge and z into the body, a the half-width,
    m^2 = (sqrt(q) + s)/2 and n^2 = (sqrt(q) - s)/2, s = a^2 - x^2 + z^2, q = s^2 + 4 x^2 z^2,
    sigma_x = -(p/a)[m (1 + (z^2 + n^2)/(m^2 + n^2)) - 2 z],
    sigma_z = -(p/a) m (1 - (z^2 + n^2)/(m^2 + n^2)), tau_xz = (p/a) n (m^2 - z^2)/(m^2 + n^2),
    m with the sign of z and n with the sign of x (the sign of tau follows from the force balance of a half).

    Parameters
    ----------
    points : (n, 2) array
        [m]
    centre, inward : (2,) arrays
        Middle of the contact and the unit normal into the body.
    half_width : float
        a [m]
    peak : float
        p [Pa]
    """
    z, x, _ = _frame(points, centre, inward)
    z = np.maximum(z, 0.0)
    a = half_width
    s = a**2 - x**2 + z**2
    root = np.sqrt(s**2 + 4 * x**2 * z**2)
    m = np.sqrt(np.maximum(0.5 * (root + s), 0.0))
    n = np.sqrt(np.maximum(0.5 * (root - s), 0.0)) * np.sign(x)
    total = np.maximum(root, 1e-300)  # m^2 + n^2
    share = (z**2 + n**2) / total
    sigma_x = -peak / a * (m * (1 + share) - 2 * z)
    sigma_z = -peak / a * m * (1 - share)
    tau = -peak / a * n * (m**2 - z**2) / total
    return _in_plane(sigma_x, sigma_z, tau, inward)


def strips_stress(points: Array, centre: Array, inward: Array, strips: Array) -> Array:
    """In-plane stresses (n, 2, 2) [Pa] under uniform pressures on strips of a half-plane's edge.

    With theta_1 and theta_2 the angles from the edge to the point, seen from the strip's two ends, and p its pressure:
    sigma_x = -(p/2 pi)[2 (theta_1 - theta_2) + sin 2 theta_1 - sin 2 theta_2], sigma_z with the sines' signs turned,
    tau_xz = (p/2 pi)(cos 2 theta_1 - cos 2 theta_2) (K. L. Johnson, Contact Mechanics, 1985, equations 2.31).

    Parameters
    ----------
    points : (n, 2) array
        [m]
    centre, inward : (2,) arrays
        Origin of the strips' middles, and the unit normal into the body.
    strips : (3, k) array
        Middles [m], towards the left seen along the normal, widths [m] and line loads [N/m].
    """
    z, x, _ = _frame(points, centre, inward)
    z = np.maximum(z, 0.0)
    sigma_x, sigma_z, tau = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    for middle, width, force in strips.T:
        first, second = (np.arctan2(z, x - middle + end * width) for end in (-0.5, 0.5))
        part = force / (2 * np.pi * width)
        turn, sines = 2 * (first - second), np.sin(2 * first) - np.sin(2 * second)
        sigma_x -= part * (turn + sines)
        sigma_z -= part * (turn - sines)
        tau += part * (np.cos(2 * first) - np.cos(2 * second))
    return _in_plane(sigma_x, sigma_z, tau, inward)


def _in_plane(along: Array, normal: Array, shear: Array, inward: Array) -> Array:
    """Stresses (n, 2, 2) of components along a half-plane's edge and its normal into the body."""
    side = np.array([-inward[1], inward[0]])
    tensor: Array = (
        np.multiply.outer(along, np.outer(side, side))
        + np.multiply.outer(normal, np.outer(inward, inward))
        + np.multiply.outer(shear, np.outer(side, inward) + np.outer(inward, side))
    )
    return tensor
