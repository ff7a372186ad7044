"""Stress along the fillets of a gear by line loads on cells of its face: even loads, waves and free ends put together.

With the loads q(z) of the cells as waves over the gear's own face b_g, z from its middle,

    q_m = (2 - delta_m0)/b_g Int q cos k_m (z + b_g/2) dz,   k_m = m pi/b_g,
    sigma(z) = sum_m q_m sigma(k_m) cos k_m (z + b_g/2) + what free ends add,

sigma(0) that of ``fem.influence.fillet_influence`` and sigma(k) - sigma(0) of ``fem.influence.fillet_waves``. Waves
shorter than those that are solved leave the root without stress. A gear that is wider than the face in contact needs
nothing else.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Array, record
from fem.elasticity.fillet_strain import von_mises
from fem.influence.fillet_ends import TEETH, FilletEnds
from fem.influence.fillet_influence import FilletInfluence
from fem.influence.fillet_waves import ACROSS, ALONG, SHEAR, FilletWaves
from fem.influence.gear_face import SHORTEST, between_waves

__all__ = ["FilletFace", "places_on_face"]


@record
class FilletFace:
    """One gear's fillets under loads on cells of the face.

    Attributes
    ----------
    influence : FilletInfluence
        Of even loads.
    waves : FilletWaves
        In modules.
    ends : FilletEnds or None
        In modules; None between walls.
    width : float
        Of the gear's own face [m].
    edges : (cells + 1,) array
        Of the cells, growing, from the middle of the gear's own face [m].
    """

    influence: FilletInfluence
    waves: FilletWaves
    ends: FilletEnds | None
    width: float
    edges: Array

    @property
    def module(self) -> float:
        """Of the gear [m]."""
        return self.influence.profile.module

    @property
    def nu(self) -> float:
        """Poisson's ratio."""
        return self.influence.law.nu

    def tangential(self, tooth: int, rho: Array, load: Array, z: Array) -> Array:
        """Stress along the fillets (loads, places, 2, samples) [Pa].

        Parameters
        ----------
        tooth : int
            Anticlockwise from the loaded one.
        rho : (loads,) array
            Curvature radius at each load [m].
        load : (loads, cells) array
            Line load on the cells [N/m].
        z : (places,) array
            From the middle of the gear's own face [m].
        """
        if tooth not in self.influence.series:
            return np.zeros((len(rho), len(z), 2, len(self.influence.line.arc)))
        by_wave, (even, _) = self._by_wave(tooth, rho), self._shapes(load, z)
        stress_by_wave = by_wave[:, :, ALONG] + self.nu * by_wave[:, :, ACROSS]
        stress: Array = np.einsum("lwz,lwsn->lzsn", even, stress_by_wave, optimize=True)
        more = self._by_ends(tooth, rho, load, z)
        return stress if more is None else stress + more[0] + self.nu * more[1]

    def components(self, tooth: int, rho: Array, load: Array, z: Array) -> tuple[Array, Array, Array]:
        """E* eps_t, E* eps_z and tau (loads, places, 2, samples) [Pa], arguments as of ``tangential``."""
        if tooth not in self.influence.series:
            none = np.zeros((len(rho), len(z), 2, len(self.influence.line.arc)))
            return none, none, none
        by_wave, (even, odd) = self._by_wave(tooth, rho), self._shapes(load, z)
        along, across, shear = (
            np.einsum("lwz,lwsn->lzsn", shape, by_wave[:, :, kind], optimize=True)
            for kind, shape in ((ALONG, even), (ACROSS, even), (SHEAR, odd))
        )
        more = self._by_ends(tooth, rho, load, z)
        return (along, across, shear) if more is None else (along + more[0], across + more[1], shear)

    def _by_wave(self, tooth: int, rho: Array) -> Array:
        """E* eps_t, E* eps_z and tau by the solved waves (loads, waves, 3, 2, samples) [1/m]."""
        stress = self.waves.beyond(tooth, rho / self.module) / self.module
        stress[:, :, ALONG] += self.influence.stress(tooth, rho)[:, None]
        return stress

    def _shapes(self, load: Array, z: Array) -> tuple[Array, Array]:
        """Solved waves over the places by loads, as cosines and as sines (loads, waves, places) [N/m]."""
        wave, by_load = self._waves()
        weights, turn = between_waves(wave * self.module), wave[:, None] * (z + 0.5 * self.width)
        even, odd = (
            np.einsum("lm,mw,mz->lwz", load @ by_load, weights, f(turn), optimize=True)
            for f in (np.cos, np.sin)
        )
        return even, odd

    def _by_ends(self, tooth: int, rho: Array, load: Array, z: Array) -> tuple[Array, Array] | None:
        """E* eps_t and E* eps_z that free ends add [Pa]; None where they add nothing."""
        if self.ends is None or tooth not in TEETH:
            return None
        m, samples = self.module, len(self.influence.line.arc)
        force = load * np.diff(self.edges) / m**2
        return self.ends.add(tooth, rho / m, force, self.edges / m, z / m, samples)

    def von_mises(self, parts: Sequence[tuple[Array, Array, Array]]) -> Array:
        """Von Mises stress (places, 2, samples) [Pa] of loads that act together, of ``components`` of each."""
        along, across, shear = (sum(part[kind].sum(axis=0) for part in parts) for kind in range(3))
        return von_mises(along + self.nu * across, across + self.nu * along, shear)

    def _waves(self) -> tuple[Array, Array]:
        """Wave numbers (waves,) [1/m], and amplitudes of the line load by those of the cells (cells, waves)."""
        count = 1 + int(SHORTEST / self.module * self.width / np.pi)
        wave: Array = np.arange(count, dtype=float) * (np.pi / self.width)
        at = self.edges + 0.5 * self.width
        integral = np.empty((count, len(at)))
        integral[0] = at
        integral[1:] = np.sin(wave[1:, None] * at) / wave[1:, None]
        scale = np.where(wave > 0.0, 2.0, 1.0) / self.width
        return wave, (np.diff(integral, axis=1) * scale[:, None]).T


def places_on_face(width: float, cell: float) -> Array:
    """Equal steps of about a cell over a face, ends included, from its middle (places,) [m]."""
    return np.asarray(np.linspace(-0.5, 0.5, round(width / cell) + 1) * width)
