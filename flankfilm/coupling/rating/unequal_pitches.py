"""Loaded contact of a pair whose base pitches differ by a deviation, shorter and longer, beside that of equal ones.

The pattern is that of ISO 6336-1: every pair of teeth takes over from the one before it with the same deviation, so
that contact and motion repeat after one base pitch. Neither a single pitch that is off (once in a revolution) nor
alternating ones (once in two base pitches) are meant.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from base import Array, Faults, InputError, Limit

if TYPE_CHECKING:
    import fem
    from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

DEVIATION = Limit(0.0, 1e-3, "m", "give the base pitch deviation in metres")
"""What a base pitch deviation may be."""


@dataclass(frozen=True, eq=False)
class UnequalPitches:
    """Mesh cycles at the same positions, of equal base pitches and of those that differ by a deviation.

    Attributes
    ----------
    deviation : float
        Base pitch of one gear less that of the other, at least 0 [m].
    even : MeshCycle
        Of equal base pitches.
    early, late : MeshCycle
        With the pinion's base pitch shorter by the deviation, so that pairs take over early; with the longer one late.
    """

    deviation: float
    even: MeshCycle
    early: MeshCycle
    late: MeshCycle

    @property
    def unequal(self) -> tuple[MeshCycle, MeshCycle]:
        """Cycles of shorter and longer base pitches."""
        return self.early, self.late

    def added_error(self, cycle: MeshCycle) -> Array:
        """What the deviation adds to the loaded transmission error (positions,) [m].

        Without load it is the sawtooth of the deviation; under load pairs share the force before one takes over, which
        rounds it.
        """
        return cycle.transmission_error - self.even.transmission_error


def contact_of(even: MeshCycle, deviation: float) -> fem.MeshCycle:
    """Loaded contact of a mesh cycle to which a base pitch deviation can be added.

    Raises
    ------
    InputError
        For a cycle without contacts of finite elements, and a deviation that is none.
    """
    with Faults() as faults:
        faults.number("deviation", deviation, DEVIATION)
    if even.contact is None:
        allowed = "must be of coupled finite elements for base pitches that differ"
        raise InputError.at("even", "", allowed, 'take model = "fem" with pairs = "coupled"')
    return even.contact


def unequal_pitches(teeth: LoadedTeeth, even: MeshCycle, deviation: float) -> UnequalPitches:
    """Mesh cycles of a pair whose base pitches differ by a deviation, both ways.

    Parameters
    ----------
    teeth : LoadedTeeth
        The pair of `even`, by coupled finite elements.
    even : MeshCycle
        Of equal base pitches.
    deviation : float
        f_pb, after running in where the standard takes it so [m].

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
    >>> found = unequal_pitches(teeth, teeth.cycle(40), 6e-6)
    >>> added = found.added_error(found.early)
    >>> bool(2e-6 < added.max() - added.min() < 4e-6)
    True
    """
    contact = contact_of(even, deviation)
    own = teeth.flanks.base_pitch_difference

    def cycle(difference: float) -> MeshCycle:
        flanks = replace(teeth.flanks, base_pitch_difference=own + difference)
        bearing = replace(teeth, flanks=flanks).cycle(even.position.size)
        return bearing.against(even.reference, contact.bore_inertia)  # as the motion measures it

    return UnequalPitches(deviation, even, cycle(-deviation), cycle(deviation))
