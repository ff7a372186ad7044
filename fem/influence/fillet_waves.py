"""Stress along the fillets by line loads that vary along the face, wave by wave.

A wave of line load, cos k (z + b/2), makes sigma_t and sigma_z ~ cos and tau ~ sin along the fillets of a prism between
frictionless walls (``fem.elasticity.prism``). Kept is what a wave does beyond the same load spread evenly, whose stress
is that of ``fem.influence.fillet_influence`` to the last bit; both on one mesh, loads as nodal forces, solved for the
waves of ``fem.influence.gear_face`` and interpolated between them. What nodal forces lack of the exact even stress
falls off with the wave as the whole stress of that tooth does, so that short waves, which the root does not feel, leave
nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.fillet_strain import FilletStrain, fillet_strains
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, section
from fem.influence.flank_variable import FlankVariable, stretched_points
from fem.influence.gear_face import solid_of, solved_waves
from fem.influence.series import FlankFit, FlankSeries

if TYPE_CHECKING:
    from fem.elasticity.plane_elasticity import PlaneElasticity
    from fem.elasticity.prism import Prism
    from fem.influence.fillet_influence import FilletInfluence
    from meshes import SectorMesh

__all__ = ["ACROSS", "ALONG", "SHEAR", "FilletWaves", "even_waves", "fillet_waves", "solid_of"]

ALONG, ACROSS, SHEAR = 0, 1, 2
"""E* eps_t, E* eps_z and tau."""

PLACES = 14
"""Places of loads on the flank."""


@record
class FilletWaves:
    """What waves of line load on a gear's left flank do to its fillets beyond even loads, in modules.

    Attributes
    ----------
    wavenumber : (waves,) array
        Of the solved waves [1/module], falling to that of even loads, 0.
    series : mapping of int to FlankSeries of (waves, 3, 2, samples)
        For each tooth, counted anticlockwise from the loaded one, over the load's rho: E* eps_t, E* eps_z and tau
        [1/module] for the solved waves, on the left (index 0) and the right fillet.
    """

    wavenumber: Array
    series: Mapping[int, FlankSeries]

    def beyond(self, tooth: int, rho: Array) -> Array:
        """What the solved waves do beyond even loads (loads, waves, 3, 2, samples) [1/module], rho in modules."""
        series = self.series[tooth]
        return series.at(series.variable.held(rho), hold=False)


def fillet_waves(mesh: SectorMesh, influence: FilletInfluence) -> FilletWaves:
    """Load the left flank of a gear of module 1 by waves.

    Parameters
    ----------
    mesh : meshes.SectorMesh
        Of module 1.
    influence : FilletInfluence
        Of the same gear in modules, even loads.
    """
    place, unit = FlankVariable(influence.rho_range), stretched_points(PLACES)
    rho = place.rho(unit)
    at, teeth = flank_points(mesh, rho), sorted(influence.series)
    law = solid_of(influence.law.plane_poisson)
    over, strains = section(mesh, law), fillet_strains(mesh, influence.profile, influence.line)
    _, wavenumber = solved_waves()
    stresses = np.array([_stress(prism(over, Face.wave(k)), at, teeth, strains, k, law) for k in wavenumber])
    even = np.array([influence.stress(tooth, rho) for tooth in teeth])
    still = stresses[-1]
    lack = even - still[:, :, ALONG]
    sizes = np.linalg.norm(stresses[:, :, :, ALONG], axis=(-1, -2))
    decay = np.divide(sizes, sizes[-1], out=np.zeros_like(sizes), where=sizes[-1] > 0.0)
    beyond = stresses - still
    beyond[:, :, :, ALONG] += (np.minimum(decay, 1.0) - 1.0)[..., None, None] * lack
    weights = FlankFit(place, unit, 2 * PLACES // 3).weights
    series = {
        tooth: FlankSeries(place, np.einsum("dl,wlcsn->dwcsn", weights, beyond[:, i], optimize=True))
        for i, tooth in enumerate(teeth)
    }
    return FilletWaves(wavenumber, series)


def even_waves(influence: FilletInfluence) -> FilletWaves:
    """Waves of loads that are even along the face: the one without length, which does nothing beyond itself.

    Parameters
    ----------
    influence : FilletInfluence
        Of a gear.
    """
    place = FlankVariable(influence.rho_range).scaled(1.0 / influence.profile.module)
    nothing = np.zeros((1, 1, 3, 2, len(influence.line.arc)))
    return FilletWaves(np.zeros(1), {tooth: FlankSeries(place, nothing) for tooth in influence.series})


def _stress(
    solved: Prism,
    at: FlankPoints,
    teeth: list[int],
    strains: tuple[FilletStrain, ...],
    wavenumber: float,
    law: PlaneElasticity,
) -> Array:
    """E* eps_t, E* eps_z and tau (teeth, loads, 3, 2, samples) by a wave of unit line load at each place."""
    moved = solved.displacements(at, teeth)
    in_plane = moved[:, :, :2].reshape(len(teeth), -1, len(at.rho))
    stress = np.zeros((len(teeth), len(at.rho), 3, len(strains), strains[0].along.shape[0]))
    for number, (plane, all_of_it) in enumerate(zip(in_plane, moved, strict=True)):
        for side, strain in enumerate(strains):
            stress[number, :, ALONG, side] = (strain.along @ plane).T
            if wavenumber:
                w = all_of_it[:, 2]
                stress[number, :, ACROSS, side] = wavenumber * (strain.value @ w).T
                turned = strain.slope @ w - wavenumber * (strain.moved @ plane)
                stress[number, :, SHEAR, side] = law.shear_modulus * turned.T
    return np.asarray(stress * np.array([law.plane_modulus, law.plane_modulus, 1.0])[:, None, None])
