"""Mean displacement of a helix of a flank, at one curvature radius, by an even load along it: in modules and E*.

The neighbourhood of the load is that of the half-space, where the local law begins (``fem.influence.helix_lines``), or
that of nodal forces on the mesh of a section.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from base import Array
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.prism import prism
from fem.elasticity.ring import ring_of
from fem.elasticity.section import Face, Section, section
from fem.influence.gear_shape import GearShape, MeshedShape
from fem.influence.gear_store import GearStore
from fem.influence.helix_ends import HelixEnds
from fem.influence.helix_lines import ContactLine
from fem.influence.helix_waves import HelixHarmonics, helix_harmonics


@cache
def waves_of(meshed: MeshedShape, twist: float) -> HelixHarmonics:
    """Waves on a gear, solved once for all tests that ask for them: a few seconds each."""
    return helix_harmonics(meshed, twist)


def in_plane(meshed: MeshedShape, rho: Array) -> Array:
    """u_r of an even load in the plane, at curvature radii in modules."""
    return GearStore().flanks(meshed, 32).fine.own(rho)


def even_answer(waves: HelixHarmonics, meshed: MeshedShape, rho: Array) -> Array:
    """c(a, a; 0) without the load's neighbourhood."""
    return np.asarray(waves.even_own.at(rho) + in_plane(meshed, rho) / waves.helix(rho, rho))


def without_ends(waves: HelixHarmonics, meshed: MeshedShape, rho: float, width: float) -> float:
    """Of a body without ends, over a width that is loaded."""
    k, place = np.linspace(0.0, 100.0, 40001), np.array([rho])
    answer = waves.own_at(place, place, k)[0].real * width * np.sinc(0.5 * k * width / np.pi) ** 2 / np.pi
    even = even_answer(waves, meshed, place)[0]
    return float(even + np.sum(0.5 * (answer[1:] + answer[:-1]) * np.diff(k)))


def by_ends(ends: HelixEnds, rho: float, width: float) -> float:
    """What free ends add, over the whole face."""
    z = width * ((np.arange(40) + 0.5) / 40 - 0.5)
    line = ContactLine(0, z, np.full(40, rho), width / 40)
    return float(ends.between(line, line).sum(axis=0).mean())


def of_half_space(over: Section, shape: GearShape, rho: float) -> float:
    """What nodal forces lack: as in the plane on the same mesh, for lengths that the helix leaves."""
    at, twist = flank_points(over.mesh, np.array([rho])), over.twist
    regular = float(line_loads(ring_of(over.mesh, shape.law), at).regular_at_load()[0])
    straight = float(prism(section(over.mesh, over.law), Face.wave(0.0)).influence(at, 0)[0][0, 0, 0])
    radius = over.mesh.base_radius
    helix = np.sqrt(1.0 + twist**2 * (radius**2 + rho**2))
    shorter = np.sqrt(1.0 + (twist * radius) ** 2) / helix**2
    return float((regular - straight + 2.0 / np.pi * np.log(shorter)) / helix)
