"""Force of the loaded contact over position and deflection, with and without a base pitch deviation.

An oscillator's stiffness k(t) is that of the mean load. Where teeth deflect by less than a base pitch deviation, which
pairs bear depends on the force of the moment: they come into contact as the motion goes. The law is

    F(x, t) with D(F, t; f_pb) - e(t) = x,    e = D - F/k at the mean load without the deviation,

by loaded contacts at several torques, so that slow teeth stand where the loaded contact has them. Shafts under the
face are held where the mean load has brought them at each position, as in the stiffness of the mesh cycle: what they
give way by more is displacement of the drive train.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import fem
from base import Array, RangeWarning
from dynamics.motion.gridded_motion import GriddedContact
from fem.laws.mesh_setup import MeshSetup
from flankfilm.coupling.mesh.require_converged import believed
from flankfilm.coupling.rating.unequal_pitches import contact_of

if TYPE_CHECKING:
    from flankfilm.coupling.drive.pair_drive import PairDrive
    from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle
    from flankfilm.coupling.vibration.oscillator import PairOscillator

SHARES = (1e-3, 0.01, 0.03, 0.06, *np.linspace(0.1, 1.0, 19).tolist(), *np.linspace(1.2, 3.0, 10).tolist())
"""Forces over the mean one at which the contact is solved; beyond the last the force is a straight line."""

POSITIONS, OF_CELLS, OF_LINES = 240, 120, 24
"""Positions of laws of an even face, of cells of the face, and of lines across it.

Pairs of spur teeth come into contact along lines of position and force, which need more positions than curves do.
"""

LIGHT = 0.01
"""Error of the deflection under a small force, over the deflection of the mean load, up to which it is taken."""

DEPTHS = 600
"""Depths of the grid, which the forces of the contact are put on."""

CURVES = ("even", "early", "late")
"""Laws by the base pitch of the pinion: that of the wheel, shorter, longer."""


@dataclass(frozen=True, eq=False)
class ContactLaws:
    """Deflections of the contact under several forces at equally spaced positions.

    Attributes
    ----------
    deviation : float
        Base pitch of one gear less that of the other, at least 0 [m].
    shares : ndarray, shape (forces,)
        Forces over the mean one, rising.
    even, early, late : ndarray, shape (forces, positions)
        Deflection less the error of the mean load without the deviation [m]; without it, with the pinion's base pitch
        shorter, and with it longer.
    added : ndarray, shape (3, positions)
        What no deviation, the shorter and the longer pitch add to the deflection under the mean load [m].
    secant : ndarray, shape (positions,)
        Stiffness of the mean load without the deviation [N/m].
    mirror : float
        Sum of a position and of that at which back flanks have the law of the front ones.
    """

    deviation: float
    shares: Array
    even: Array
    early: Array
    late: Array
    added: Array
    secant: Array
    mirror: float

    def fewer_forces(self) -> ContactLaws:
        """Every second force, the smallest and the largest among them."""
        kept = slice(None, None, 2)
        curves = {name: getattr(self, name)[kept] for name in CURVES}
        return replace(self, shares=self.shares[kept], **curves)

    def fewer_positions(self) -> ContactLaws:
        """Half as many positions, those that are the nearest to the middle of equal parts."""
        size = self.secant.size
        half = max(size // 2, 1)
        kept = np.floor((np.arange(half) + 0.5) * size / half).astype(np.int64)
        curves = {name: getattr(self, name)[:, kept] for name in CURVES}
        return replace(self, secant=self.secant[kept], added=self.added[:, kept], **curves)


def contact_laws(
    teeth: LoadedTeeth, even: MeshCycle, deviation: float, positions: int | None = None
) -> ContactLaws:
    """Solve the loaded contact under several forces, without a base pitch deviation and with it both ways.

    Parameters
    ----------
    teeth : LoadedTeeth
        The pair of `even`, by coupled finite elements.
    even : MeshCycle
        Under the mean load, measured against what the motion measures it against.
    deviation : float
        f_pb, after running in where the standard takes it so [m].
    positions : int, optional
        Of a base pitch. Left out: 240 of an even face, 120 with cells; of lines of contact 24, and half of the forces.

    Raises
    ------
    InputError
        For a cycle without contacts of finite elements, and a deviation that is none.
    SolverError
        Where a loaded contact did not converge.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import LoadedTeeth
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> teeth = LoadedTeeth(pair, 250.0).meshed(0.02)
    >>> laws = contact_laws(teeth, teeth.cycle(40), 6e-6, 40)
    >>> bool(2e-6 < np.ptp(laws.added[1]) < 4e-6)
    True
    """
    contact = contact_of(even, deviation)
    positions = _usual_positions(contact) if positions is None else positions
    held_under = None if teeth.flanks.shafts in (None, (None, None)) else teeth.torque
    own, shares = teeth.flanks.base_pitch_difference, np.array(SHARES[:: 1 if contact.lines is None else 2])
    torques = (shares * teeth.torque).tolist()

    def cycles(difference: float) -> list[fem.MeshCycle]:
        flanks = replace(teeth.flanks, base_pitch_difference=own + difference)
        loaded = fem.mesh_cycle(
            teeth.pair,
            torques,
            positions=positions,
            shafts_held_under=held_under,
            **replace(teeth, flanks=flanks).setting,
        )
        return [
            _taken(cycle, float(share)).against(even.reference, contact.bore_inertia)
            for cycle, share in zip(loaded, shares, strict=True)
        ]

    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", RangeWarning
        )  # the mean load says it; what is more is the motion's peak
        sides = [cycles(difference) for difference in (0.0, -deviation, deviation)]
    mean = int(np.argmin(np.abs(shares - 1.0)))
    level = sides[0][mean]
    unloaded = level.transmission_error - level.force / level.secant_stiffness
    equal, early, late = (np.array([cycle.transmission_error for cycle in side]) - unloaded for side in sides)
    added = np.array([curve[mean] - equal[mean] for curve in (equal, early, late)])
    mirror = MeshSetup(teeth.pair).mirror
    return ContactLaws(deviation, shares, equal, early, late, added, level.secant_stiffness, mirror)


def _usual_positions(contact: fem.MeshCycle) -> int:
    """Positions of laws."""
    if contact.lines is not None:
        return OF_LINES
    return POSITIONS if contact.face is None else OF_CELLS


def _taken(cycle: fem.MeshCycle, share: float) -> fem.MeshCycle:
    """A cycle that converged, or whose error is small beside the deflection of the mean load."""
    light = share * float(np.max(cycle.error)) <= LIGHT and bool(np.isfinite(cycle.transmission_error).all())
    return cycle if light and share < 1.0 else believed(cycle, "loaded tooth contact")


def gridded(
    laws: ContactLaws, which: str, motion: PairOscillator | PairDrive, depths: int = DEPTHS
) -> GriddedContact:
    """Put a law of the contact on a grid in the units of a motion.

    Films are in series as a spring of the mean load. What shafts of a drive train give way beyond the mean load is no
    part of the law: all of it, that of modes which are not retained too, is in the displacements of the train.

    Parameters
    ----------
    laws : ContactLaws
    which : {"even", "early", "late"}
    motion : PairOscillator or PairDrive
        With physical scales.
    depths : int
        Of the grid.
    """
    scales = motion.scales
    assert scales is not None
    forces = motion.mean_force * laws.shares
    at = getattr(laws, which) / scales.length + np.outer(forces, _in_series(laws, motion))
    start = at[0] - forces[0] * (at[1] - at[0]) / (forces[1] - forces[0])
    lowest = float(start.min())
    grid = np.linspace(lowest, float(at[-1].max()), depths)
    table = np.array([_straight(grid, row, forces) for row in np.vstack([start, at]).T])
    moved = laws.added[CURVES.index(which)] / scales.length
    return GriddedContact(table, lowest, float(grid[1] - grid[0]), moved, laws.mirror % 1.0)


def _straight(grid: Array, depths: Array, forces: Array) -> Array:
    """Force at depths of a grid, from the depth without force on: straight between samples, and beyond the last."""
    inside = np.interp(grid, depths, [0.0, *forces])
    slope = (forces[-1] - forces[-2]) / (depths[-1] - depths[-2])
    return np.asarray(np.where(grid > depths[-1], forces[-1] + slope * (grid - depths[-1]), inside))


def _in_series(laws: ContactLaws, motion: PairOscillator | PairDrive) -> Array:
    """Compliance of a motion's films under the mean load (positions,), in its units; none of dry teeth."""
    scales, cycle = motion.scales, motion.rigid.series.cycle
    assert scales is not None
    place = (np.arange(laws.secant.size) + 0.5) / laws.secant.size
    if cycle is None:
        return np.zeros(place.size)
    return scales.mean_stiffness * np.interp(place, cycle.position, cycle.film_compliance, period=1.0)
