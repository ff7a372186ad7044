r"""Stress along the fillets of a helical gear without ends, by forces on cells of its lines of contact.

A line load cos kz at one place of the flank makes P cos kz + Q sin kz of each stress of the fillet's surface
(``fem.elasticity.helix_fillet``), in coordinates that turn with the section. A unit force on a cell of length h along
the axis, zeta below the place that is looked at, is all waves together,

.. math:: \sigma = \frac{1}{\pi} \int_0^\infty \mathrm{sinc}\frac{kh}{2}
   \left[ P(k) \cos k\zeta + Q(k) \sin k\zeta \right] dk .

The fillet is away from the load, so that P and Q are smooth in the load's place and die off where waves are short: they
are solved for the waves of ``fem.influence.gear_face`` and interpolated. Loads are nodal forces, so that within an edge
of a load nothing is to be believed: there a contact presses its own surroundings, which is no stress of the root.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.fillet import FilletLine, fillet_line
from fem.elasticity.helix_fillet import HelixFillet, helix_fillets
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.prism import Prism, prism
from fem.elasticity.section import Face, section
from fem.influence.flank_variable import FlankVariable, stretched_points
from fem.influence.gear_face import SHORTEST, between_waves, solid_of, solved_waves
from fem.influence.series import FlankFit, FlankSeries

if TYPE_CHECKING:
    from gears import ToothProfile
    from meshes import SectorMesh

__all__ = ["NEAR_LOAD", "Z_REVERSED", "CellLoad", "HelixFilletWaves", "away_from", "helix_fillet_waves"]

PLACES = 18
"""Places of loads on the flank; two thirds as many terms follow the stress."""

POINTS = 8.0
"""Of the quadrature over waves, for every module of the longest distance: stress dies off before the shortest wave."""

LONGEST = 4.0
"""Modules of distance that the quadrature knows in any case."""

NEAR_LOAD = 0.5
"""Modules around a load in which it presses its own surroundings, as of ``fem.influence.root_influence``."""

Z_REVERSED: Array = np.array([1.0, 1.0, -1.0])
"""What sigma_t, sigma_b and tau become where the axis is counted the other way."""


@record
class CellLoad:
    """Forces on the cells of a line of contact of one gear, in modules and E*.

    Attributes
    ----------
    rho, z : (cells,) arrays
        Curvature radii and places along the axis of the cells' middles, z from the middle of the gear's own face.
    length : float
        Of a cell along the axis.
    force : (cells,) array
    """

    rho: Array
    z: Array
    length: float
    force: Array


@record
class HelixFilletWaves:
    """What waves of line load on a helical gear's left flank do to its fillets, in modules.

    Attributes
    ----------
    twist : float
        Turn of the section along the axis [rad/module], positive for a right hand.
    profile : gears.ToothProfile
        Of the transverse section, in modules.
    line : FilletLine
        In modules.
    series : mapping of int to FlankSeries of (2, waves, 3, 2, samples)
        For each tooth, counted anticlockwise from the loaded one, over the load's rho: P and Q of sigma_t, sigma_b and
        tau [1/module] at the solved waves, on the left (index 0) and the right fillet.
    noise : float
        Largest distance of a sample on the loaded tooth from its fit [1/module], beside a load's surroundings.
    """

    twist: float
    profile: ToothProfile
    line: FilletLine
    series: Mapping[int, FlankSeries]
    noise: float

    @property
    def mirrored(self) -> HelixFilletWaves:
        """The same section with the other hand: z is counted the other way, so that waves run back."""
        back = np.stack([Z_REVERSED, -Z_REVERSED])[:, None, :, None, None]
        series = {
            tooth: replace(each, coefficients=each.coefficients * back) for tooth, each in self.series.items()
        }
        return replace(self, twist=-self.twist, series=series)

    def beyond(self, tooth: int, rho: Array) -> Array:
        """P and Q at the solved waves (loads, 2, waves, 3, 2, samples) [1/module], rho in modules."""
        series = self.series[tooth]
        return series.at(series.variable.held(rho), hold=False)

    def felt(self, load: CellLoad, places: Array) -> Array:
        """What all teeth feel of the forces on the cells of a line (places, terms, 2, waves), as ``on`` asks for it.

        Parameters
        ----------
        load : CellLoad
        places : (places,) array
            Along the axis [modules].
        """
        series = self.series[0]
        by_place = series.variable.basis(series.variable.held(load.rho), len(series.coefficients) - 1)
        sums = _sums(places[:, None] - load.z, load.length)  # (places, cells, 2, waves)
        return np.asarray(np.einsum("c,ca,pcxw->paxw", load.force, by_place, sums, optimize=True))

    def on(self, tooth: int, felt: Array) -> Array:
        """Stress sigma_t, sigma_b and tau (places, 3, 2, samples) on a tooth, anticlockwise from the loaded one.

        One that is too far to be felt has no stress.
        """
        if tooth not in self.series:
            return np.zeros((len(felt), 3, 2, len(self.line.arc)))
        return np.asarray(np.tensordot(felt, self.series[tooth].coefficients, 3))


def _sums(zeta: Array, length: float) -> Array:
    """Weights of P and Q at the solved waves in the answer to a unit force on a cell (..., 2, waves)."""
    most = max(float(np.abs(zeta).max(initial=0.0)), LONGEST)
    s, share = np.polynomial.legendre.leggauss(int(np.ceil(POINTS * most)))
    wavenumber = 0.5 * SHORTEST * (s + 1.0)
    share = 0.5 * SHORTEST * share * np.sinc(0.5 * wavenumber * length / np.pi) / np.pi
    waves = between_waves(wavenumber) * share[:, None]
    turns = zeta[..., None] * wavenumber
    return np.stack([np.cos(turns) @ waves, np.sin(turns) @ waves], axis=-2)


def helix_fillet_waves(
    mesh: SectorMesh, profile: ToothProfile, twist: float, poisson: float, reach: int, low: float
) -> HelixFilletWaves:
    """Load the left flank of a gear of module 1 by waves.

    Parameters
    ----------
    mesh : meshes.SectorMesh
        Of the transverse section, module 1.
    profile : gears.ToothProfile
        That the mesh was made of.
    twist : float
        [rad/module]
    poisson : float
        nu*
    reach : int
        Teeth on either side of the loaded one.
    low : float
        Minimum curvature radius of loads [modules], if the flank goes on below it.
    """
    law, line = solid_of(poisson), fillet_line(profile)
    place, unit = (
        FlankVariable((max(low, profile.flank_rho[0]), profile.flank_rho[1])),
        stretched_points(PLACES),
    )
    at, teeth = flank_points(mesh, place.rho(unit)), list(range(-reach, reach + 1))
    over, fillets = section(mesh, law, twist), helix_fillets(mesh, profile, line, law, twist)
    _, wavenumber = solved_waves()
    stress = np.stack(
        [
            _by_wave(prism(over, Face.wave(float(k), twisted=True)), at, teeth, fillets, float(k))
            for k in wavenumber
        ],
        axis=3,
    )  # (teeth, loads, 2, waves, 3, 2, samples)
    fit = FlankFit(place, unit, 2 * PLACES // 3)
    series = {
        tooth: FlankSeries(place, np.tensordot(fit.weights, samples, 1))
        for tooth, samples in zip(teeth, stress, strict=True)
    }
    own = np.tensordot(fit.basis, series[0].coefficients, 1)
    apart = away_from(profile, line, at.rho) >= NEAR_LOAD
    noise = np.where(apart[:, None, None, None, None], np.abs(own - stress[reach]), 0.0)
    return HelixFilletWaves(twist, profile, line, series, float(noise.max()))


def away_from(profile: ToothProfile, line: FilletLine, rho: Array) -> Array:
    """Distance in the section of places of the loaded flank from the samples of the fillet under it (..., samples)."""
    contact = profile.involute(rho.ravel()).reshape(*rho.shape, 2)
    return np.asarray(np.linalg.norm(line.points - contact[..., None, :], axis=-1))


def _by_wave(
    solved: Prism, at: FlankPoints, teeth: list[int], fillets: tuple[HelixFillet, ...], wavenumber: float
) -> Array:
    """P and Q (teeth, loads, 2, 3, 2, samples) by cosines of unit line load at each place."""
    moved = solved.displacements(at, teeth)  # (teeth, nodes, n, loads psi)
    psi, nodes, loads = solved.psi, moved.shape[1], len(at.rho)
    moved = moved.reshape(len(teeth), nodes, -1, loads, psi)[..., 0]  # by the cosine
    in_section = moved[:, :, : 2 * psi].reshape(len(teeth), nodes, psi, 2, loads)
    by_function = np.concatenate([in_section, moved[:, :, 2 * psi :, None]], axis=3)
    functions = [by_function[:, :, f] for f in range(psi)]
    cosine = functions[0]
    sine = functions[1] if psi == 2 else np.zeros_like(cosine)
    parts = (cosine, wavenumber * sine), (sine, -wavenumber * cosine)
    stress = np.array(
        [
            [[fillet.stress(each[tooth], slope[tooth]) for fillet in fillets] for each, slope in parts]
            for tooth in range(len(teeth))
        ]
    )  # (teeth, 2, 2 sides, 3, samples, loads)
    return np.asarray(np.moveaxis(stress, (5, 1, 3, 2, 4), (1, 2, 3, 4, 5)))
