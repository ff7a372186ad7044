"""Stress along the fillets of a gear by line loads on cells of its face: even loads, waves and free ends put together.

With the loads q(z) of the cells as waves over the gear's own face b_g, z from its middle,

    q_m = (2 - delta_m0)/b_g Int q cos k_m (z + b_g/2) dz,   k_m = m pi/b_g,
    sigma(z) = sum_m q_m sigma(k_m) cos k_m (z + b_g/2) + what free ends add,

sigma(0) that of ``fem.fillet_influence`` and sigma(k) - sigma(0) of ``fem.fillet_waves``. Waves shorter than those that
are solved leave the root without stress. A gear that is wider than the face in contact needs nothing else.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Array, record
from fem.fillet_ends import TEETH, FilletEnds
from fem.fillet_influence import FilletInfluence
from fem.fillet_strain import von_mises
from fem.fillet_waves import ACROSS, ALONG, SHEAR, FilletWaves
from fem.gear_face import SHORTEST, between_waves

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
        along, across, _ = self.components(tooth, rho, load, z)
        return along + self.nu * across

    def components(self, tooth: int, rho: Array, load: Array, z: Array) -> tuple[Array, Array, Array]:
        """E* eps_t, E* eps_z and tau (loads, places, 2, samples) [Pa], arguments as of ``tangential``."""
        samples = len(self.influence.line.arc)
        if tooth not in self.influence.series:
            none = np.zeros((len(rho), len(z), 2, samples))
            return none, none, none
        wave, by_load = self._waves()
        modes = load @ by_load
        by_wave = self.waves.beyond(tooth, rho / self.module) / self.module
        by_wave[:, :, ALONG] += self.influence.stress(tooth, rho)[:, None]
        turn = wave[:, None] * (z + 0.5 * self.width)
        weights = between_waves(wave * self.module)
        even, odd = (
            np.einsum("lm,mw,mz->lwz", modes, weights, f(turn), optimize=True) for f in (np.cos, np.sin)
        )
        along, across, shear = (
            np.einsum("lwz,lwsn->lzsn", shape, by_wave[:, :, kind], optimize=True)
            for kind, shape in ((ALONG, even), (ACROSS, even), (SHEAR, odd))
        )
        if self.ends is not None and tooth in TEETH:
            m = self.module
            force = load * np.diff(self.edges) / m**2
            more = self.ends.add(tooth, rho / m, force, self.edges / m, z / m, samples)
            along, across = along + more[0], across + more[1]
        return along, across, shear

    def von_mises(self, parts: Sequence[tuple[Array, Array, Array]]) -> Array:
        """Von Mises stress (places, 2, samples) [Pa] of loads that act together, of ``components`` of each."""
        along, across, shear = (sum(one[kind].sum(axis=0) for one in parts) for kind in range(3))
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
