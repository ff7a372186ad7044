"""Stress along the fillets by a line load anywhere on the flank of the same or of a neighbouring tooth.

The stress is linear in the loads. On the loaded tooth it is the sum of the half-plane's stress, in closed form
(``fem.elasticity.flamant``), and of the regular part u_r of the finite elements, which varies smoothly with the load's
place and is kept as a Chebyshev series in the curvature radius rho; on the other teeth the finite elements
give all of it. With the free edge's normal stress zero, sigma_t = E* eps_t(u_r) + sigma_s,tt - nu* sigma_s,nn.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity import flamant
from fem.elasticity.fillet import FilletLine, fillet_line, fillet_stress_matrix
from fem.elasticity.fillet_strain import SIDES
from fem.elasticity.flank_samples import CORNER_CLEARANCE
from fem.elasticity.line_load import LineLoads, flank_points, line_loads
from fem.elasticity.plane_elasticity import MIRROR, PlaneElasticity
from fem.elasticity.ring import Ring
from fem.influence.flank_variable import FlankVariable, stretched_points
from fem.influence.series import FlankFit, FlankSeries

if TYPE_CHECKING:
    from gears import ToothProfile

__all__ = ["FilletInfluence", "fillet_influence"]

LOADS = 24
"""Loads along a flank; three fifths as many terms follow the stress."""

ON_SAMPLE = 1e-4
"""Of the samples' distance: a load nearer to a sample stands on it, where rounding would grow beyond bounds."""


@record
class FilletInfluence:
    """Tangential stress on the fillets of one gear per unit line load on its left flank.

    Attributes
    ----------
    profile : gears.ToothProfile
    law : PlaneElasticity
    line : FilletLine
        Sample points of a fillet.
    series : mapping of int to FlankSeries of (2, n)
        For each tooth, counted anticlockwise from the loaded one: the stress [1/m] at the samples of its left
        (index 0) and right fillet over the load's rho; without the half-plane's part on tooth 0.
    noise : float
        Largest distance of a sample from its fit [1/m].
    """

    profile: ToothProfile
    law: PlaneElasticity
    line: FilletLine
    series: Mapping[int, FlankSeries]
    noise: float

    @property
    def rho_range(self) -> tuple[float, float]:
        """Curvature radii of loads [m]."""
        return self.series[0].variable.span

    def scaled(self, profile: ToothProfile, law: PlaneElasticity) -> FilletInfluence:
        """Give a gear in modules its size; the stress per line load does not depend on the modulus."""
        module = profile.module
        series = {tooth: of_tooth.scaled(module, module) for tooth, of_tooth in self.series.items()}
        return FilletInfluence(profile, law, fillet_line(profile), series, self.noise / module)

    def stress(self, tooth: int, rho: Array) -> Array:
        """Tangential stress (loads, 2, n) [Pa per N/m] on a tooth's left and right fillet.

        Parameters
        ----------
        tooth : int
            Anticlockwise from the loaded one.
        rho : (loads,) array
            Curvature radius at each load [m]; beyond the range it is moved to its end.
        """
        if tooth not in self.series:
            return np.zeros((len(rho), 2, len(self.line.arc)))
        series = self.series[tooth]
        rho = series.variable.held(rho)
        stress = series.at(rho, hold=False)
        return stress + self._half_plane(rho) if tooth == 0 else stress

    def _half_plane(self, rho: Array) -> Array:
        """Flamant's part E* eps_t on the loaded tooth, (loads, 2, n)."""
        loads, inward = self.profile.involute(rho) * MIRROR, -self.profile.normal(rho) * MIRROR
        parts = [
            flamant_along(loads, inward, *self.line.side(side == "left"), self.law.plane_poisson)
            for side in SIDES
        ]
        return np.stack(parts, axis=1)


def flamant_along(
    loads: Array, inward: Array, points: Array, tangents: Array, normals: Array, poisson: float
) -> Array:
    """sigma_tt - nu* sigma_nn of unit line loads on half-planes at points of a curve, (loads, points) [1/m]."""
    away = points[None] - loads[:, None]
    along = np.einsum("lpa,la->lp", away, inward)
    r2 = np.sum(away**2, axis=2)
    t2 = np.einsum("lpa,pa->lp", away, tangents) ** 2
    n2 = np.einsum("lpa,pa->lp", away, normals) ** 2
    # a load on the sample itself, at the foot of an involute that begins there, acts on the flank only
    apart = r2 > (ON_SAMPLE * np.linalg.norm(points[1] - points[0])) ** 2
    safe = np.where(apart, r2, 1.0)
    return np.asarray(np.where(apart, -2 * along * (t2 - poisson * n2) / (np.pi * safe**2), 0.0))


def fillet_influence(ring: Ring, profile: ToothProfile, reach: int, rho_low: float = 0.0) -> FilletInfluence:
    """Load the left flank at Chebyshev places, all with the ring's factorisation, and fit.

    Parameters
    ----------
    ring : Ring
    profile : gears.ToothProfile
        That the ring's mesh was made of.
    reach : int
        Teeth on either side of the loaded one.
    rho_low : float
        Minimum curvature radius of loads [m], if the flank goes on below it.
    """
    low, high = max(rho_low, profile.flank_rho[0]), profile.flank_rho[1] - CORNER_CLEARANCE * profile.module
    place, unit = FlankVariable((low, high)), stretched_points(LOADS)
    loads = line_loads(ring, flank_points(ring.mesh, place.rho(unit)))
    line = fillet_line(profile)
    recover = [fillet_stress_matrix(ring.mesh, profile, line, ring.law, side) for side in SIDES]
    touched = np.unique(np.concatenate([matrix.indices for matrix in recover]))
    fit = FlankFit(place, unit, 3 * LOADS // 5)
    noise, series = 0.0, {}
    for tooth in range(-reach, reach + 1):
        moved = _displacements(ring, loads, tooth, touched)
        stress = np.stack([(matrix[:, touched] @ moved).T for matrix in recover], axis=1)
        series[tooth] = FlankSeries(place, np.einsum("dl,lsn->dsn", fit.weights, stress))
        noise = max(noise, float(np.max(fit.error(series[tooth], stress))))
    return FilletInfluence(profile, ring.law, line, series, noise)


def _displacements(ring: Ring, loads: LineLoads, tooth: int, unknowns: Integers) -> Array:
    """Displacements (unknowns, loads) of a tooth's sector, without the half-plane's part on tooth 0."""
    cuts = np.asarray(ring.polar @ ring.interfaces(loads.cut_force, tooth))
    moved = np.empty((len(unknowns), cuts.shape[1]))
    place = np.full(ring.mesh.unknowns, -1)
    place[ring.inner] = np.arange(len(ring.inner))
    inside = place[unknowns] >= 0
    rows = place[unknowns[inside]]
    moved[inside] = -ring.inner_by_cut[rows] @ cuts + (loads.own_inner[rows] if tooth == 0 else 0.0)
    place[ring.cut] = np.arange(len(ring.cut))
    border = unknowns[~inside]
    moved[~inside] = cuts[place[border]]
    if tooth == 0 and len(border):
        nodes = ring.mesh.points[border // 2]
        for i, (load, inward) in enumerate(zip(loads.at.points, loads.at.inward, strict=True)):
            u = flamant.displacement(nodes, load, inward, ring.law, ring.mesh.module)
            moved[~inside, i] -= u[np.arange(len(border)), border % 2]
    return moved
