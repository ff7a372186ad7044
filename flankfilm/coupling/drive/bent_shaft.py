"""Shaft of a drive train as its gear bends and pulls it: deflections, slopes and axial displacements as matrices.

A spur gear presses along the line of action, in whose plane its shaft bends. The normal of a helical flank leans out of
the transverse section by the base helix angle: its force pulls the shaft along the axis too, and bends it in the plane
across the line of action, with the base radius as its lever. Bearings are alike in both planes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag

import gears
from base import Array
from gears.pair.beams import bending, node_at, rotary, tension


class GearBody(NamedTuple):
    """Gear as a rigid body.

    Attributes
    ----------
    radius : float
        Of the base circle [m].
    mass : float
        [kg]
    inertia : float
        About the axis, with what is fixed to it [kg m2].
    tilting : float
        About a diameter through the middle of the face [kg m2].
    half_face : float
        Half the face width [m]; measures tilts as displacements.
    lean : float
        Tangent of the base helix angle, above 0 of a right-handed pinion and its wheel; 0 of spur gears.
    lever : float
        Place of the pitch point along the line of action towards the wheel, from the axis [m].
    """

    radius: float
    mass: float
    inertia: float
    tilting: float
    half_face: float
    lean: float = 0.0
    lever: float = 0.0


class BentShaft(NamedTuple):
    """Shaft with its gear on bearings, by deflections and slopes of the plane of action.

    With a helical gear those of the plane across it follow, and axial displacements.

    Attributes
    ----------
    stiffness, mass, damping : ndarray, shape (n, n)
        Damping is that of the bearings' dampers.
    spin : ndarray, shape (n, n)
        As of `flankfilm.coupling.drive.drive_side.Side`.
    mesh, tilt : ndarray, shape (n,)
        Approach of the gear's flank in the transverse section at mid-face, and tilt in the plane of action [rad].
    points : dict
        Names to displacements that modes are shown by.
    bearings : tuple of (str, float, float, ndarray)
        Name, stiffness [N/m], damping [N s/m] and displacement under load of every spring.
    """

    stiffness: Array
    mass: Array
    damping: Array
    spin: Array
    mesh: Array
    tilt: Array
    points: dict[str, Array]
    bearings: tuple[tuple[str, float, float, Array], ...]


def bent_shaft(shaft: gears.Shaft, nodes: Array, gear: GearBody, way: float) -> BentShaft:
    r"""Shaft with its gear.

    With deflections v along the line of action and w across it, and axial displacements u, all of the gear, a flank of
    the pinion approaches in the transverse section at mid-face and at the pitch point by

    .. math:: v + l \tan\beta_b\, v' - r_b \tan\beta_b\, w' - u \tan\beta_b ,

    l the lever; the wheel's recedes so with its l and the other sign of r_b.

    Parameters
    ----------
    shaft : Shaft
    nodes : ndarray
        Of its elements [m].
    gear : GearBody
    way : float
        1 of the pinion, -1 of the wheel.
    """
    at, lean = 2 * node_at(nodes, shaft.gear_position), gear.lean
    stiffness, mass, damping = bending(shaft, nodes)
    spin = 2.0 * rotary(shaft, nodes)
    mass[at, at] += gear.mass
    mass[at + 1, at + 1] += gear.tilting
    spin[at + 1, at + 1] += gear.inertia
    planes = [(stiffness, mass, damping)]
    if lean:
        pulled, moved = tension(shaft, nodes)
        moved[at, at] += gear.mass
        planes += [(stiffness, mass, damping), (pulled, moved, np.zeros_like(pulled))]
        none, turning = np.zeros_like(spin), way * spin  # both gears turn, against each other
        spin = block_diag(np.block([[none, turning], [-turning, none]]), np.zeros_like(pulled))
    firm, heavy, damped = (block_diag(*each) for each in zip(*planes, strict=True))
    units = np.eye(len(firm))
    starts = np.cumsum([0, *(len(plane[0]) for plane in planes)])
    along, *beyond = (units[first:] for first in starts[:-1].tolist())
    mesh, tilt = along[at] + lean * gear.lever * along[at + 1], along[at + 1]
    points = {"deflection": along[at], "tilt": gear.half_face * tilt}
    held = _bearings(shaft, nodes, along, "", -way)
    if lean:
        across, axial = beyond
        mesh = mesh - lean * (way * gear.radius * across[at + 1] + axial[at])
        points |= {"deflection across": across[at], "axial": axial[at]}
        held += _bearings(shaft, nodes, across, " across", -way)
        held += _axial_bearings(shaft, nodes, axial, way * float(np.sign(lean)))
    return BentShaft(firm, heavy, damped, spin, mesh, tilt, points, tuple(held))


def _bearings(
    shaft: gears.Shaft, nodes: Array, units: Array, plane: str, sign: float
) -> list[tuple[str, float, float, Array]]:
    """Radial springs of one plane."""
    return [
        (
            f"bearing {i + 1}{plane}",
            one.stiffness,
            one.damping,
            sign * units[2 * node_at(nodes, one.position)],
        )
        for i, one in enumerate(shaft.bearings)
    ]


def _axial_bearings(
    shaft: gears.Shaft, nodes: Array, units: Array, sign: float
) -> list[tuple[str, float, float, Array]]:
    """Axial springs of those that have one."""
    return [
        (f"bearing {i + 1} axial", one.axial_stiffness, 0.0, sign * units[2 * node_at(nodes, one.position)])
        for i, one in enumerate(shaft.bearings)
        if one.axial_stiffness
    ]
