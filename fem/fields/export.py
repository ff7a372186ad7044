"""Loaded gears as input of other programs: Abaqus or CalculiX decks with loads, meshes in many formats.

Each gear is a separate problem: its bore held, and the forces of the contacts, as the load sharing found them at
one mesh position, put on its flanks (``fem.fields.loaded_gears``). Both stand in the common frame, so that their files
fit together. SI units throughout.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base import Fault, Faults, InputError, Limit, replacing
from fem.cycle.mesh_cycle import mesh_cycle
from fem.fields.loaded_gears import LoadedGear, loaded_gears, placed_gears
from fem.pair.pair_compliance import PairCompliance
from meshes.abaqus import mesh_text, number
from meshes.exchange import FORMATS as OF_MESHIO
from meshes.exchange import write_blocks, write_by_meshio
from meshes.msh import write_msh

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["FORMATS", "export_pair", "export_position", "write_abaqus", "write_mesh"]

FORMATS = {
    "abaqus": ".inp",
    "gmsh": ".msh",
    "vtm": ".vtm",
    **{name: form.suffix for name, form in OF_MESHIO.items()},
}
"""Suffixes of the files by the name of their format; a suffix without its dot names the format too."""

SLICE = 1e-4
"""Part of the face width that stands for the whole in plane stress."""

PLACES = 500
"""Positions of a base pitch to choose from."""

POSITION = Limit(0.0, 1.0, "base pitches after A", "0.5 is half a pitch")


def write_mesh(
    gears: GearPair | LoadedGear | Sequence[LoadedGear], path: str | Path, format: str | None = None
) -> Path:
    """Write meshes of gears in the format of another program.

    Parameters
    ----------
    gears : gears.GearPair, LoadedGear or sequence of LoadedGear
        A pair is meshed without loads, as it stands with a pair of teeth at the pitch point. Several gears share one
        file, where the names of their boundaries begin with their own.
    path : str or Path
        Of the file.
    format : str, optional
        Name of the format, one of ``FORMATS``; from the path's suffix unless given.

    Returns
    -------
    Path
        The file written. Named boundaries are sets in an Abaqus deck (`write_abaqus`, with the loads), physical
        groups for gmsh, named blocks for VTK (``vtm``), groups in MED, fields of the nodes in VTK's, XDMF and HMF
        files, and numbers of the edges in their order elsewhere. Forces on nodes ``force_N`` are fields.

    Raises
    ------
    base.InputError
        A format that is not known, or several gears in one file of gmsh.

    Examples
    --------
    >>> import meshio
    >>> from fem import write_mesh
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=18), Gear(teeth=20), module=2e-3, face_width=40e-3)
    >>> back = meshio.read(write_mesh(pair, "pair.vtu"))
    >>> back.points[:, 2].max() == 0.0 and "pinion_flank_left" in back.point_data
    True
    """
    path = Path(path)
    form = _format(format or path.suffix.lstrip("."))
    if isinstance(gears, LoadedGear):
        loaded: tuple[LoadedGear, ...] = (gears,)
    else:
        loaded = tuple(gears) if isinstance(gears, Sequence) else placed_gears(gears)
    if form == "abaqus":
        return write_abaqus(path, *loaded)
    if form == "gmsh":
        if len(loaded) != 1:
            allowed = "must be one gear for gmsh, whose names hold for all of a file"
            raise InputError([Fault("gears", f"{len(loaded)}", allowed, "write each to a separate file")])
        return write_msh(path, loaded[0].mesh)
    fields = {
        gear.name: {"force_N": np.column_stack([gear.forces, 0.0 * gear.forces[:, 0]])} for gear in loaded
    }
    if form == "vtm":
        return write_blocks(path, {gear.name: gear.mesh for gear in loaded}, fields)
    prefix = {gear.name: f"{gear.name}_" if len(loaded) > 1 else "" for gear in loaded}
    return write_by_meshio(
        path,
        {prefix[gear.name]: gear.mesh for gear in loaded},
        form,
        {prefix[name]: values for name, values in fields.items()},
    )


def _format(name: str) -> str:
    """Name of the format by its name or the suffix of its files."""
    by_suffix = {suffix.lstrip("."): form for form, suffix in FORMATS.items()}
    form = name if name in FORMATS else by_suffix.get(name, "")
    if not form:
        known = ", ".join(sorted({*FORMATS, "inp", "msh"}))
        raise InputError([Fault("format", repr(name), f"must be one of {known}", "inp holds the loads too")])
    return form


def write_abaqus(path: Path, *gears: LoadedGear) -> Path:
    """Write gears as an input file of Abaqus or CalculiX that runs as it stands.

    Elements CPE6 or CPS6, the bore held, the forces as ``*CLOAD``, one static step that prints all displacements
    and the sum of the bore's reactions. The thickness is the face width in plane strain, that of the web in the web.
    In plane stress it is a
    slice of it, with the forces in proportion: CalculiX makes solids of plane elements, and a solid in plane stress
    has to be thin against its edges. Nodes, elements and sets are written by meshio.

    Parameters
    ----------
    path : Path
        Ends in ``.inp``.
    *gears : LoadedGear
        Names of sets begin with ``PINION_`` and ``WHEEL_`` where there are several.

    Returns
    -------
    Path
        The file written.
    """
    plane = gears[0].law.plane
    prefixes = ["" if len(gears) == 1 else f"{gear.name.upper()}_" for gear in gears]
    names = " and ".join(gear.name for gear in gears)
    head = ["*HEADING", f"{names}, plane {plane}, units m N Pa, z axis along the face width", ""]
    part = 1.0 if plane == "strain" else SLICE
    model, held, loads, printed = [], ["*BOUNDARY"], ["*CLOAD"], []
    first = 1
    for prefix, gear in zip(prefixes, gears, strict=True):
        model += [f"*MATERIAL, NAME={prefix}MATERIAL", "*ELASTIC"]
        model += [f"{number(gear.law.E)}, {number(gear.law.nu)}"]
        web = float(gear.mesh.thickness.min())
        sections = {"GEAR": 1.0} if web == 1.0 else {"RIM_AND_HUB": 1.0, "WEB": web}
        for name, thickness in sections.items():
            model += [f"*SOLID SECTION, ELSET={prefix}{name}, MATERIAL={prefix}MATERIAL"]
            model += [number(part * thickness * gear.face_width)]
        held.append(f"{prefix}BORE, 1, 2")
        forces = part * gear.forces
        for node in np.flatnonzero(np.any(forces != 0, axis=1)):
            loads += [f"{node + first}, {i + 1}, {number(forces[node, i])}" for i in (0, 1)]
        printed += [
            f"*NODE PRINT, NSET={prefix}GEAR",
            "U",
            f"*NODE PRINT, NSET={prefix}BORE, TOTALS=ONLY",
            "RF",
        ]
        first += len(gear.mesh.points)
    cards = [*model, *held, "*STEP", "*STATIC", *(loads if len(loads) > 1 else ()), *printed]
    cards += ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""]
    element = "CPE6" if plane == "strain" else "CPS6"
    meshes = {prefix: gear.mesh for prefix, gear in zip(prefixes, gears, strict=True)}
    path = Path(path)
    with replacing(path) as beside:
        text = "\n".join(head) + mesh_text(meshes, element) + "\n".join(cards)
        beside.write_text(text, encoding="ascii")
    return path


def export_pair(folder: Path, gears: Sequence[LoadedGear], form: str = "inp") -> tuple[Path, ...]:
    """Write ``pinion`` and ``wheel`` into a folder, each to a separate file.

    Parameters
    ----------
    folder : Path
    gears : sequence of LoadedGear
    form : str
        One of ``FORMATS``, or a suffix of theirs.

    Returns
    -------
    tuple of Path
        The files written.

    Raises
    ------
    base.InputError
        Another format.
    """
    suffix = FORMATS[_format(form)]
    return tuple(write_mesh(gear, Path(folder) / f"{gear.name}{suffix}", form) for gear in gears)


def export_position(
    folder: Path,
    pair: GearPair,
    torque: float,
    position: float,
    form: str = "inp",
    compliance: PairCompliance | None = None,
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
    form : str
        As of `export_pair`.
    compliance : PairCompliance, optional
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
    faults = Faults()
    faults.number("position", position, POSITION)
    faults.raise_if_any()
    _format(form)
    cycle = mesh_cycle(pair, torque, PLACES, compliance, plane=plane)
    row = int(np.argmin(np.abs(cycle.position - position)))
    return export_pair(folder, loaded_gears(pair, cycle, row, refinements=refinements), form)
