"""What steps of thickness add to a body's wind-up: the torsion of the body of revolution itself.

A plane model hands the torque over the whole face from rim to web, as if the web were softer instead of narrower. In
the rim it has to come together from the whole width to the web's, and the free inside of the rim beside the web carries
none; likewise in the hub. Under an even torque a body of revolution only turns, u = r phi(r, z) about its axis, with

    d/dr (r^3 dphi/dr) + d/dz (r^3 dphi/dz) = 0,   free: no normal slope,   bore: phi = 0

(S. P. Timoshenko and J. N. Goodier, Theory of Elasticity, 1970, article 119), which finite elements in the meridian
plane solve. The torque enters at the root circle, evenly over the width. Since it is the mean turn of the root circle
that it adds to, whatever tooth is loaded, it adds the same to the deflection of all pairs, as the wind-up of the plane
does.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import unclocked
from gears.closed_form import body_wind_up, inertial_wind_up
from gears.tooth.blank import Zone

if TYPE_CHECKING:
    from skfem import MeshQuad

    from gears import ToothProfile

__all__ = ["step_wind_up"]

SMALLEST_STEP = 1e-3
"""Step of the thickness, over the face width, below which nothing is added: a millionth of the wind-up."""

ALONG, IN_WEB, BESIDE = 16, 8, 10
"""Elements along each zone's radius, in half the web's thickness and beside it."""


def step_wind_up(
    profile: ToothProfile, face_width: float, shear_modulus: float, bore_inertia: float | None = None
) -> float:
    """Deflection along the line of action, times b/F, that steps of thickness add to the wind-up of the plane.

    Parameters
    ----------
    profile : gears.ToothProfile
    face_width : float
        b [m].
    shear_modulus : float
        G [Pa].
    bore_inertia : float, optional
        Of what turns with the bore, over pi rho b/2 [m^4]: the torque is balanced by the body's inertia, as of
        `gears.closed_form.inertial_wind_up`. Unless given the bore takes all of it.

    Returns
    -------
    float
        delta b / F [m^2/N]; 0 for a disc. To 0.5 % of what is added.
    """
    zones = profile.zones
    if len(zones) == 1 or 1.0 - zones[1].thickness < SMALLEST_STEP:
        return 0.0
    root = profile.root_radius
    rings = tuple(Zone(zone.inner / root, zone.outer / root, zone.thickness) for zone in zones)
    inertia = None if bore_inertia is None else bore_inertia / root**4
    added = _added(rings, 0.5 * face_width / root, inertia)
    return added * (profile.base_radius / root) ** 2 / (2 * np.pi * shear_modulus)


@lru_cache(maxsize=64)
def _added(zones: tuple[Zone, ...], half: float, bore_inertia: float | None) -> float:
    """The same times 2 pi G/r_b^2, with all lengths over the root radius and half the width."""
    with unclocked():
        from skfem import Basis, BilinearForm, ElementQuad2, LinearForm, condense, solve
        from skfem.helpers import dot, grad

    mesh = _meridian(zones, half)
    basis = Basis(mesh, ElementQuad2())
    stiffness = BilinearForm(lambda u, v, w: w.x[0] ** 3 * dot(grad(u), grad(v))).assemble(basis)
    root, bore = (
        mesh.facets_satisfying(lambda x, radius=radius: np.abs(x[0] - radius) < 1e-9, True)
        for radius in (zones[0].outer, zones[-1].inner)
    )
    # torque 1 on half the width: Simpson's rule on every edge
    ends, load = mesh.facets[:, root], np.zeros(basis.N)
    share = np.abs(np.diff(mesh.p[1, ends], axis=0)[0]) / half
    np.add.at(load, basis.nodal_dofs[0, ends.ravel()], np.tile(share / 6, 2))
    load[basis.facet_dofs[0, root]] = share * 4 / 6
    plane = body_wind_up(zones, 1.0, 1.0)
    if bore_inertia is not None:
        plane = inertial_wind_up(zones, 1.0, 1.0, bore_inertia)
        inside = sum(zone.thickness * (zone.outer**4 - zone.inner**4) for zone in zones)
        body = LinearForm(lambda v, w: 4 * w.x[0] ** 3 * v / half).assemble(basis)
        load = load - body / (bore_inertia + inside)
    turn = solve(*condense(stiffness, load, D=basis.get_dofs(bore)))
    return float(load @ turn * half - plane * 2 * np.pi)


def _meridian(zones: tuple[Zone, ...], half: float) -> MeshQuad:
    """Quadrilaterals (r, z) of half the width, finer towards the steps."""
    from skfem import MeshQuad

    s = np.linspace(0.0, 1.0, ALONG + 1)
    towards_both = 0.5 - 0.5 * np.cos(np.pi * s)
    radii = [zones[-1].inner]
    for zone in reversed(zones):
        radii += (zone.inner + (zone.outer - zone.inner) * towards_both)[1:].tolist()
    web = half * zones[1].thickness
    inside, beside = (
        0.5 - 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, count + 1)) for count in (IN_WEB, BESIDE)
    )
    heights = np.concatenate([web * inside, web + (half - web) * beside[1:]])
    mesh = MeshQuad.init_tensor(np.array(radii), heights)
    r, z = mesh.p[:, mesh.t].mean(axis=1)
    keep = np.zeros(len(r), dtype=bool)
    for zone in zones:
        keep |= (r > zone.inner) & (r < zone.outer) & (z < half * zone.thickness)
    return mesh.restrict(np.flatnonzero(keep))
