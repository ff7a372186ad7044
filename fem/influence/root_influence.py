"""Stress along the fillets of a gear by line loads on cells of its face: even loads, waves and free ends put together.

With the loads q(z) of the cells as waves over the gear's own face b_g, z from its middle,

    q_m = (2 - delta_m0)/b_g Int q cos k_m (z + b_g/2) dz,   k_m = m pi/b_g,
    sigma(z) = sum_m q_m sigma(k_m) cos k_m (z + b_g/2) + what free ends add,

sigma(0) that of ``fem.influence.fillet_influence`` and sigma(k) - sigma(0) of ``fem.influence.fillet_waves``. Waves
shorter than those that are solved leave the root without stress. A gear that is wider than the face in contact needs
nothing else. The plane is a face of a single cell: its load is one wave, that without length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from base import Array, record
from fem.elasticity.fillet_strain import von_mises
from fem.influence.fillet_ends import TEETH, FilletEnds
from fem.influence.fillet_influence import FilletInfluence
from fem.influence.fillet_waves import ACROSS, ALONG, SHEAR, FilletWaves
from fem.influence.gear_face import between_waves

__all__ = ["RootInfluence"]

OWN = 0.5
"""Modules around a contact that no root stress is looked for in.

A load P on a short length of the face draws the free surface at a distance r by (1 - 2 nu) P/(2 pi r^2), as a force on
a half-space does: without end where r is small, and no bending. A load that is even along the face does not.
"""


@record
class RootInfluence:
    """One gear's fillets under line loads on equal cells of the face in contact.

    Attributes
    ----------
    influence : FilletInfluence
        Of even loads.
    waves : FilletWaves
        In modules.
    ends : FilletEnds or None
        In modules; None between walls.
    waves_error : float
        Estimated relative error of the mesh that the waves were solved on.
    width, contact_width : float
        Of the gear's own face and of the face in contact [m].
    offset : float
        Middle of the gear's own face from that of the face in contact [m].
    """

    influence: FilletInfluence
    waves: FilletWaves
    ends: FilletEnds | None
    waves_error: float
    width: float
    contact_width: float
    offset: float

    @property
    def module(self) -> float:
        """Of the gear [m]."""
        return self.influence.profile.module

    @property
    def nu(self) -> float:
        """Part of the stress along the fillet that acts along the face where that keeps its length."""
        law = self.influence.law
        return law.nu if law.plane == "strain" else 0.0

    @property
    def disturbed(self) -> float:
        """How far from a contact what it does next to itself is no root stress [m]; 0 of even loads."""
        return OWN * self.module if self.waves.wavenumber.any() else 0.0

    def edges(self, cells: int) -> Array:
        """Edges of equal cells from the middle of the gear's own face (cells + 1,) [m]."""
        return np.asarray(np.linspace(-0.5, 0.5, cells + 1) * self.contact_width - self.offset)

    def places(self, cells: int) -> Array:
        """Equal steps of about a cell over the gear's own face, ends included, from mid-face (places,) [m]."""
        count = round(self.width / (self.contact_width / cells)) + 1
        return np.asarray(np.linspace(-0.5, 0.5, count) * self.width + self.offset)

    def tangential(self, tooth: int, rho: Array, line_load: Array, z: Array) -> Array:
        """Stress along the fillets (loads, places, 2, samples) [Pa].

        Parameters
        ----------
        tooth : int
            Anticlockwise from the loaded one, one of ``influence.series``.
        rho : (loads,) array
            Curvature radius at each load [m].
        line_load : (loads, cells) array
            On the cells [N/m].
        z : (places,) array
            From the middle of the face in contact [m].
        """
        by_wave, even = self._by_wave(tooth, rho), self._shapes(line_load, z, np.cos)
        along, across = self._by_ends(tooth, rho, line_load, z)
        stress = _at_places(even, by_wave[:, :, ALONG] + self.nu * by_wave[:, :, ACROSS])
        return stress + along + self.nu * across

    def components(self, tooth: int, rho: Array, line_load: Array, z: Array) -> tuple[Array, Array, Array]:
        """E* eps_t, E* eps_z and tau (loads, places, 2, samples) [Pa], arguments as of ``tangential``."""
        by_wave = self._by_wave(tooth, rho)
        even, odd = (self._shapes(line_load, z, wave) for wave in (np.cos, np.sin))
        along, across = self._by_ends(tooth, rho, line_load, z)
        eps_t, eps_z, shear = (
            _at_places(shape, by_wave[:, :, kind])
            for kind, shape in ((ALONG, even), (ACROSS, even), (SHEAR, odd))
        )
        return eps_t + along, eps_z + across, shear

    def von_mises(self, parts: Sequence[tuple[Array, Array, Array]]) -> Array:
        """Von Mises stress (places, 2, samples) [Pa] of loads that act together, of ``components`` of each."""
        along, across, shear = (sum(part[kind].sum(axis=0) for part in parts) for kind in range(3))
        return von_mises(along + self.nu * across, across + self.nu * along, shear)

    def _by_wave(self, tooth: int, rho: Array) -> Array:
        """E* eps_t, E* eps_z and tau by the solved waves (loads, waves, 3, 2, samples) [1/m]."""
        stress = self.waves.beyond(tooth, rho / self.module) / self.module
        stress[:, :, ALONG] += self.influence.stress(tooth, rho)[:, None]
        return stress

    def _shapes(self, line_load: Array, z: Array, of_turn: Callable[[Array], Array]) -> Array:
        """Solved waves over the places by loads, as cosines or sines of their turn (loads, waves, places) [N/m]."""
        wave, by_load = self._amplitudes(line_load.shape[-1])
        weights = between_waves(wave * self.module, len(self.waves.wavenumber))
        turn = wave[:, None] * (z - self.offset + 0.5 * self.width)
        return np.tensordot(line_load @ by_load, weights[:, :, None] * of_turn(turn)[:, None], 1)

    def _by_ends(self, tooth: int, rho: Array, line_load: Array, z: Array) -> tuple[Array, Array]:
        """E* eps_t and E* eps_z that free ends add [Pa], zero where they add nothing."""
        if self.ends is None or tooth not in TEETH:
            return np.zeros(1), np.zeros(1)
        m, samples, edges = self.module, len(self.influence.line.arc), self.edges(line_load.shape[-1])
        force = line_load * np.diff(edges) / m**2
        return self.ends.add(tooth, rho / m, force, edges / m, (z - self.offset) / m, samples)

    def _amplitudes(self, cells: int) -> tuple[Array, Array]:
        """Wave numbers (waves,) [1/m], and amplitudes of the line load by those of the cells (cells, waves)."""
        count = 1 + int(self.waves.wavenumber.max() / self.module * self.width / np.pi)
        wave: Array = np.arange(count, dtype=float) * (np.pi / self.width)
        at = self.edges(cells) + 0.5 * self.width
        integral = np.empty((count, len(at)))
        integral[0] = at
        integral[1:] = np.sin(wave[1:, None] * at) / wave[1:, None]
        twice = np.where(wave > 0.0, 2.0, 1.0)
        return wave, (twice[:, None] * np.diff(integral, axis=1) / self.width).T


def _at_places(shapes: Array, by_wave: Array) -> Array:
    """Sum over waves of their shapes (loads, waves, places) and stress: (loads, places, 2, samples)."""
    stress = np.matmul(shapes.swapaxes(1, 2)[:, None], by_wave.swapaxes(1, 2))
    return np.asarray(stress.swapaxes(1, 2))
