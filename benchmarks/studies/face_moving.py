"""What contacts that move change over the face: the article's pair at C and beside E, and a plastic wheel.

Run with ``python benchmarks/studies/face_moving.py`` (half a minute, between walls). Each row: contacts that
stay, those that move, and by how much deflection and tangent change; then the same with other ways for tilt and motion
to follow the load along the face (by each cell alone as slices do, by the mean over the face), and with the corners of
the tips met by all cells as by the one that touches first; nan where cells that tilt by themselves yield less than
nothing to short waves of load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import fem
from base import Array
from fem.contact import moved_side
from fem.contact.cell_laws import face_load_factors
from fem.contact.contact_state import ContactState
from fem.contact.moving_contacts import MovingContacts
from fem.contact.solver import solve_contact
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from gears import Alignment, Gear, GearPair, Lead, Material

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
ARTICLE = GearPair(Gear(36), Gear(40), 2e-3, 40e-3)
PLASTIC = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66)).with_backlash(600e-6)
BEFORE_E = 0.01
"""Base pitches."""


def solved(
    bodies: fem.PairCompliance, position: float, torque: float, face: dict, moving: bool
) -> ContactState:
    """One position, its contacts staying or moving, whether it is to be believed or not."""
    pair = bodies.pair
    over = face_setting(pair, face.get("alignment"), face.get("cells", 64), face.get("model", "walls"))
    given = MeshSetup(pair, 1, moving_contact=moving, face=over).at(np.array([position]))
    force = np.array([torque / pair.base_radii[0]])
    return solve_contact(given, bodies, force, None, CornerLaws(given, bodies))


def deflection(found: ContactState) -> float:
    """Deflection from where the gears touch [um]; nan where there is no solution."""
    return float("nan") if found.refusal(0) else figures(found)[0]


def figures(found: ContactState) -> tuple[float, float, float, float]:
    """Deflection from where the gears touch [um], tangent [N/um], face-load factor, greatest force on a cell."""
    assert not found.refusal(0), found.refusal(0)
    forces = found.cell_forces(0)[0, 0]
    return (
        1e6 * float(found.share.transmission_error[0, 0, 0]),
        1e-6 * float(found.share.stiffness[0, 0, 0]),
        float(face_load_factors(forces)),
        float(forces.max()),
    )


def following(how: Callable[[int], Array]) -> Callable[..., Array]:
    """Smoothing by the same matrix for all pairs."""

    def smoothing(face: object, bodies: object, where: fem.MeshCycle) -> Array:
        n = face.cells
        return np.broadcast_to(how(n), (*where.touchable.shape, n, n)).copy()

    return smoothing


def rows(name: str, bodies: fem.PairCompliance, position: float, torque: float, **face: object) -> None:
    """Print a line."""
    stays, moves = (figures(solved(bodies, position, torque, face, moving)) for moving in (False, True))
    change = [100 * (b / a - 1) for a, b in zip(stays, moves, strict=True)]
    others, smoothing = [], moved_side.tooth_smoothing
    for how in (np.eye, lambda n: np.full((n, n), 1 / n)):
        moved_side.tooth_smoothing = following(how)
        others.append(100 * (deflection(solved(bodies, position, torque, face, True)) / stays[0] - 1))
    moved_side.tooth_smoothing = smoothing
    own_contacts = moved_side.MovedSide.contacts

    def together(*args: object) -> MovingContacts:
        contacts = own_contacts(*args)
        return replace(contacts, along=np.zeros_like(contacts.along))

    moved_side.MovedSide.contacts = together
    others.append(100 * (deflection(solved(bodies, position, torque, face, True)) / stays[0] - 1))
    moved_side.MovedSide.contacts = own_contacts
    print(
        f"{name:42s} D {stays[0]:8.3f} {change[0]:+.3f} %  tangent {stays[1]:8.2f} {change[1]:+.3f} %  "
        f"K {stays[2]:.4f} {moves[2]:.4f}  slices, mean, corners together {others[0]:+.3f} {others[1]:+.3f} "
        f"{others[2]:+.3f} %"
    )


def main() -> None:
    """Print all."""
    for name, pair, torques, model in (
        ("article", ARTICLE, (600.0, 60.0), "walls"),
        ("PA66", PLASTIC, (20.0, 5.0), "walls"),
    ):
        bodies, points, pitch = fem.compliance(pair, tolerance=0.002), pair.points, pair.base_pitch
        places = (
            ("at C", (points.C - points.A) / pitch),
            ("beside E", (points.E - points.A) / pitch - BEFORE_E),
        )
        for torque in torques:
            for place, position in places:
                for slope in (0.0, 20e-6, 60e-6):
                    title = f"{name} {torque:g} N m {place}, {1e6 * slope:g} um"
                    rows(title, bodies, position, torque, alignment=Alignment(slope), model=model)
        crowned = replace(pair, pinion=replace(pair.pinion, lead=Lead(crowning=60e-6)))
        title = f"{name} {torques[0]:g} N m at C, crowned by 60 um"
        rows(title, replace(bodies, pair=crowned), places[0][1], torques[0], model=model)


if __name__ == "__main__":
    main()
