"""Pairs of teeth that know each other only through the force they share: their cycle, and their curves anywhere."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import fem
import gears
from base import Array, Cost, Stopwatch
from fem.laws.local_law import film_yielding
from fem.laws.mesh_setup import MeshSetup
from flankfilm.coupling.mesh.deflection_law import DeflectionLaw, PathLaw, Placed
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.single_pairs import MODELS, single_pair_stiffness
from gears.sharing.events import Sampled, arcs_alike, arcs_between_events
from gears.sharing.mesh_arcs import CURVES, Compared, MeshArcs, compared_later

SAMPLING = 0.1
"""Part of a tolerance that what the arcs leave out may be."""


@dataclass(frozen=True)
class SharingPairs:
    """Pairs under one torque, each by its own stiffness; finite elements know coupled bodies, these do not.

    Attributes
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m], negative where the wheel drives.
    model : str
        Of one pair's stiffness, as of `single_pair_stiffness`.
    pairs : {"coupled", "independent"}
        As of `LoadedTeeth`.
    compliance : fem.PairCompliance or None
        For finite elements.
    film : DeflectionLaw or None
        Films in series.
    tolerance : float
        Relative, of the figures.
    varied : tuple of (DeflectionLaw, float)
        Other films, and how much of what they change is error.
    """

    pair: gears.GearPair
    torque: float
    model: str
    pairs: str
    compliance: fem.PairCompliance | None = None
    film: DeflectionLaw | None = None
    tolerance: float = 1e-3
    varied: tuple[tuple[DeflectionLaw, float], ...] = ()

    @property
    def force(self) -> float:
        """Normal force of all pairs together [N]."""
        return abs(self.pair.normal_force(self.torque))

    @property
    def error(self) -> float | None:
        """Relative error of a pair's stiffness; None of a closed form, whose model error is unknown."""
        return self.compliance.error if self.model == "fem" and self.compliance is not None else None

    def cycle(self, positions: int) -> MeshCycle:
        """Mesh cycle at the midpoints of so many equal intervals of one base pitch."""
        watch = Stopwatch()
        position, _ = contact_places(self.pair, positions)
        rho1 = self._places(position)
        share, secant = self.shared(rho1)
        return MeshCycle(
            label=f"{MODELS[self.model]}, {self.pairs} pairs",
            position=position,
            rho1=rho1,
            forces=share.forces,
            load_share=share.forces / self.force,
            secant_stiffness=secant,
            stiffness=np.asarray(share.stiffness),
            transmission_error=self._lag(np.asarray(share.transmission_error)),
            error=self.error,
            cost=Cost(watch.seconds),
            reference="bore" if self.model == "fem" else "teeth",
            by_pairs=self,
        )

    def _on_path(self, position: Array) -> Array:
        """Positions at which the loaded flanks stand on the path of contact: back flanks in the mirror."""
        return position if self.torque > 0.0 else (MeshSetup(self.pair).mirror - position) % 1.0

    def _lag(self, approach: Array) -> Array:
        """Transmission error [m] of an approach of the loaded flanks; beyond the backlash on back flanks."""
        return approach if self.torque > 0.0 else -(self.pair.backlash + approach)

    def _places(self, position: Array) -> Array:
        return places_of(self.pair, self._on_path(position))

    def arcs(self) -> MeshArcs:
        """Curves between events."""
        pair = self.pair
        ends = [pair.points.A, pair.points.E]
        for gear, profile in enumerate(pair.teeth_profiles):
            if profile.tip_relief is not None:
                start = profile.flank_rho[1] - profile.tip_relief.length
                ends.append(start if gear == 0 else pair.line_of_action - start)
        corners = self._on_path((np.array(ends) - pair.points.A) / pair.base_pitch)
        if self.film is not None:
            corners = np.concatenate([corners, self._on_path(self.film.corners(pair))])
        tolerance = SAMPLING * self.tolerance
        division = arcs_between_events(self._sample, CURVES, corners, tolerance=tolerance)

        def compared() -> Compared:
            varied = []
            for film, share in self.varied:
                sample = replace(self, film=film)._sample
                arcs = arcs_alike(sample, CURVES, division)
                if arcs is None:
                    arcs = arcs_between_events(sample, CURVES, corners, tolerance=tolerance).arcs
                varied.append((arcs, share))
            return Compared(varied=tuple(varied))

        return MeshArcs(division, compared_later(compared), 1.0, self.error)

    def _sample(self, position: Array) -> Sampled:
        rho1 = self._places(position)
        share, secant = self.shared(rho1)
        moved, tangent = np.asarray(share.transmission_error), np.asarray(share.stiffness)
        if self.pairs == "independent":
            return Sampled(
                np.stack([self._lag(moved), tangent, secant]),
                np.zeros((position.size, 0)),
                self._each(rho1, share),
            )
        clear = np.where(np.isfinite(rho1), _relief(self.pair, rho1), np.inf) - moved[:, None]
        if self.film is not None:
            clear = clear - self.film(rho1, np.zeros_like(rho1))[0]
            added = film_yielding(self.film, rho1, share.forces, share.forces / self.force)
            secant = secant * moved / (moved + added)
        reserve = np.minimum(-clear / moved.mean(), -1e-300)
        return Sampled(
            np.stack([self._lag(moved), tangent, secant]),
            np.where(share.forces > 0.0, share.forces / self.force, reserve),
            self._each(rho1, share),
        )

    def _each(self, rho1: Array, share: gears.LoadShare) -> Array:
        """Share, force and places of every pair (positions, pairs, 4)."""
        pair = self.pair
        rho = np.where(np.isfinite(rho1), rho1, pair.points.C)
        kinds = [share.forces / self.force, share.forces, rho, pair.line_of_action - rho]
        return np.stack(kinds, axis=-1)

    def shared(self, rho1: Array) -> tuple[gears.LoadShare, Array]:
        """Load share and secant stiffness [N/m] with pairs at curvature radii (positions, pairs) [m]."""
        force, film = self.force, self.film
        touching = np.isfinite(rho1)
        k = single_pair_stiffness(self.pair, force, rho1, self.model, self.compliance)
        k = np.where(touching, k, 0.0)
        if self.pairs == "independent":
            assert film is None or isinstance(film, PathLaw)  # whose forces are those of these pairs
            share = gears.independent_pairs(force, k, None if film is None else film.stiffness(rho1))
            return share, np.asarray(share.stiffness)
        compliance = 1.0 / np.where(touching, k, 1.0)
        bulk = compliance[..., None] * np.eye(k.shape[1])
        gaps = np.where(touching, _relief(self.pair, rho1), np.inf)
        placed = None if film is None else Placed(film, rho1)
        share = gears.share_load(force, bulk, Placed(_no_hertz, rho1), gaps, placed)
        return share, force / np.asarray(share.transmission_error)


def contact_places(pair: gears.GearPair, positions: int) -> tuple[Array, Array]:
    """Place the pairs of teeth on the path.

    Parameters
    ----------
    pair : gears.GearPair
    positions : int
        Number of equal intervals of one base pitch.

    Returns
    -------
    position : ndarray, shape (positions,)
        Travel after a pair is at A, in base pitches, at the intervals' midpoints.
    rho1 : ndarray, shape (positions, pairs)
        Curvature radius of the pinion's flank [m]; nan beyond E.
    """
    position = (np.arange(positions) + 0.5) / positions
    return position, places_of(pair, position)


def places_of(pair: gears.GearPair, position: Array) -> Array:
    """Curvature radii of the pinion's flank with a pair so many base pitches after A (positions, pairs) [m]."""
    pairs = int(np.ceil(pair.contact_ratio))
    rho1 = pair.points.A + pair.base_pitch * (position[:, None] + np.arange(pairs))
    return np.where(rho1 <= pair.points.E, rho1, np.nan)


def _no_hertz(rho1: Array, force: Array) -> tuple[Array, Array]:
    """Local deflection of closed forms: already in the single pair's stiffness at the full force."""
    return np.zeros_like(force), np.zeros_like(force)


def _relief(pair: gears.GearPair, rho1: Array) -> Array:
    """Clearance that tip relief of both gears leaves [m], nan where it was, with a minimum of zero at each position."""
    pinion, wheel = pair.teeth_profiles
    gap = pinion.relief(rho1) + wheel.relief(pair.line_of_action - rho1)
    return np.asarray(gap - np.nanmin(gap, axis=1, keepdims=True))
