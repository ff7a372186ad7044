"""Loaded gears as input of other programs: Abaqus or CalculiX decks, gmsh meshes.

Each gear is a problem of its own: its bore held, and the forces of the contacts, as the load sharing found them at
one mesh position, put on its flanks (``fem.loaded_gears``). Both stand in the common frame, so that their files fit
together. SI units throughout.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base import Fault, InputError, replacing
from fem.contact import mesh_cycle
from fem.loaded_gears import LoadedGear, loaded_gears
from fem.pair_compliance import Compliance
from meshes.abaqus import mesh_text, number
from meshes.msh import write_msh

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["FORMATS", "export_pair", "export_position", "write_abaqus"]

FORMATS = ("inp", "msh")
SLICE = 1e-4
"""Part of the face width that stands for the whole in plane stress."""
PLACES = 500
"""Positions of a base pitch to choose from."""


def write_abaqus(path: Path, gear: LoadedGear) -> Path:
    """Write a gear as an input file of Abaqus or CalculiX that runs as it stands.

    Elements CPE6 or CPS6, the bore held, the forces as ``*CLOAD``, one static step that prints all displacements
    and the sum of the bore's reactions. The thickness is the face width in plane strain. In plane stress it is a
    slice of it, with the forces in proportion: CalculiX makes solids of plane elements, and a solid in plane stress
    has to be thin against its edges.

    Parameters
    ----------
    path : Path
        Ends in ``.inp``.
    gear : LoadedGear

    Returns
    -------
    Path
        The file written.
    """
    element = "CPE6" if gear.law.plane == "strain" else "CPS6"
    head = ["*HEADING", f"{gear.name}, plane {gear.law.plane}, units m N Pa, z axis along the face width"]
    part = 1.0 if gear.law.plane == "strain" else SLICE
    forces = part * gear.forces
    model = [
        "*MATERIAL, NAME=MATERIAL",
        "*ELASTIC",
        f"{number(gear.law.E)}, {number(gear.law.nu)}",
        "*SOLID SECTION, ELSET=GEAR, MATERIAL=MATERIAL",
        number(part * gear.face_width),
        "*BOUNDARY",
        "BORE, 1, 2",
        "*STEP",
        "*STATIC",
        "*CLOAD",
    ]
    for node in np.flatnonzero(np.any(forces != 0, axis=1)):
        model += [f"{node + 1}, {i + 1}, {number(forces[node, i])}" for i in (0, 1)]
    model += ["*NODE PRINT, NSET=GEAR", "U", "*NODE PRINT, NSET=BORE, TOTALS=ONLY", "RF"]
    model += ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""]
    path = Path(path)
    with replacing(path) as beside:
        text = "\n".join(head) + "\n" + mesh_text(gear.mesh, element) + "\n".join(model)
        beside.write_text(text, encoding="ascii")
    return path


def export_pair(folder: Path, gears: Sequence[LoadedGear], form: str = "inp") -> tuple[Path, ...]:
    """Write ``pinion`` and ``wheel`` into a folder.

    Parameters
    ----------
    folder : Path
    gears : sequence of LoadedGear
    form : {"inp", "msh"}
        Abaqus or CalculiX input with loads, or gmsh mesh (no loads).

    Returns
    -------
    tuple of Path
        The files written.

    Raises
    ------
    base.InputError
        Another format.
    """
    _check_format(form)
    folder = Path(folder)
    if form == "inp":
        return tuple(write_abaqus(folder / f"{gear.name}.inp", gear) for gear in gears)
    return tuple(write_msh(folder / f"{gear.name}.msh", gear.mesh) for gear in gears)


def _check_format(form: str) -> None:
    if form not in FORMATS:
        raise InputError(
            [Fault("format", repr(form), f"must be {' or '.join(FORMATS)}", "inp holds the loads too")]
        )


def export_position(
    folder: Path,
    pair: GearPair,
    torque: float,
    position: float,
    form: str = "inp",
    compliance: Compliance | None = None,
    plane: str = "strain",
    refinements: int = 1,
) -> tuple[Path, ...]:
    """Share the load at one position and write both gears with their forces.

    Parameters
    ----------
    folder : Path
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    position : float
        Base pitches from A, 0 to 1, of the pair that entered last; the nearest of 500 midpoints is taken.
    form : {"inp", "msh"}
    compliance : Compliance, optional
        Of this pair; computed in ``plane`` unless given.
    plane : {"strain", "stress"}
    refinements : int
        Of the mesh that is written.

    Returns
    -------
    tuple of Path
        The files written.

    Raises
    ------
    base.InputError
        Torque, position or format that make no sense.
    """
    if not 0 <= position <= 1:
        raise InputError(
            [Fault("position", f"{position!r}", "must be 0 to 1 base pitches after A", "0.5 is half a pitch")]
        )
    _check_format(form)
    cycle = mesh_cycle(pair, torque, PLACES, compliance, plane=plane)
    row = int(np.argmin(np.abs(cycle.position - position)))
    return export_pair(folder, loaded_gears(pair, cycle, row, refinements=refinements), form)
