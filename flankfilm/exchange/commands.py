"""Commands that bring gear data in and out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Literal

from base import InputError, printable


def import_gears(
    file: Path,
    /,
    *,
    out: Path | None = None,
    stage: str | None = None,
    rack: Literal["A", "B", "C", "D"] | None = None,
) -> int:
    """Write a scene from the gear data in FILE (REXS as XML, JSON or an archive of either).

    What the scene needs and FILE lacks is left open in the scene and listed.

    Parameters
    ----------
    file : Path
        A REXS file, versions 1.0 to 2.0.
    out : Path, optional
        The scene to write; FILE.toml beside you if left out.
    stage : str, optional
        Id of the stage, where the file holds several.
    rack : {"A", "B", "C", "D"}, optional
        Basic rack of ISO 53, where the file names no tool.
    """
    from flankfilm.exchange.bring_in import imported
    from flankfilm.files.folder import write_new

    target = out if out is not None else Path(f"{file.stem}.toml")
    brought = imported(file, stage=stage, rack=rack)
    write_new(target, brought.text, "Name another: --out")
    for note in brought.notes:
        print(printable(note))
    print(f"{target} is written.")
    if brought.faults:
        raise InputError(replace(fault, where=f"{target}: {fault.where}") for fault in brought.faults)
    print(f"Next: flankfilm check {target}")
    return 0


def export_rexs(scene: Path, /, *, out: Path | None = None) -> int:
    """Write the pair of SCENE as a REXS file.

    Parameters
    ----------
    scene : Path
        The scene file (TOML); its sections pair and material count.
    out : Path, optional
        The file, as XML (.rexs), JSON (.rexsj) or XML in an archive (.rexsz); SCENE.rexs beside you if left out.
    """
    from flankfilm.building.pair import gear_pair
    from flankfilm.exchange.rexs_write import rexs_file
    from flankfilm.output.files import write_bytes
    from flankfilm.scene import read_scene

    wanted = read_scene(scene)
    target = out if out is not None else Path(f"{scene.stem}.rexs")
    content, left_out = rexs_file(gear_pair(wanted), wanted.title or scene.stem, target)
    write_bytes(target, content)
    for omission in left_out:
        print(printable(omission))
    print(f"{target} is written.")
    return 0


def export_profile(
    scene: Path,
    /,
    *,
    gear: Literal["pinion", "wheel"] = "pinion",
    format: Literal["dxf", "csv"] = "dxf",
    teeth: str = "1",
    tolerance_um: float = 1.0,
    out: Path | None = None,
) -> int:
    """Write the exact tooth profile of a gear of SCENE, tip relief included, in millimetres.

    Parameters
    ----------
    scene : Path
        The scene file (TOML); its section pair counts.
    gear : {"pinion", "wheel"}
        Which gear.
    format : {"dxf", "csv"}
        A drawing (release 12, arcs exact), or points.
    teeth : str
        How many teeth about +y, with the body below; or all.
    tolerance_um : float
        Largest distance of a chord from its curve.
    out : Path, optional
        The file; SCENE-GEAR.FORMAT beside you if left out.
    """
    from flankfilm.building.pair import gear_pair
    from flankfilm.exchange.profile_files import write_drawing, write_points
    from flankfilm.scene import read_scene
    from gears.tooth.contour import contour

    if teeth != "all" and not (teeth.isdecimal() and len(teeth) < 6):
        raise InputError.at("--teeth", teeth, "must be a whole number, or all", "Such as --teeth 3")
    pair = gear_pair(read_scene(scene))
    profile = pair.teeth_profiles[("pinion", "wheel").index(gear)]
    drawn = contour(profile, None if teeth == "all" else int(teeth), 1e-6 * tolerance_um)
    target = out if out is not None else Path(f"{scene.stem}-{gear}.{format}")
    if format == "dxf":
        count = write_drawing(target, drawn, (f"{gear}, {profile.teeth} teeth",))
    else:
        count = write_points(target, drawn)
    arcs = ", arcs exact" if format == "dxf" else ""
    print(f"{target}: {count:,} points, chord error at most {tolerance_um:g} µm{arcs}")
    return 0


def export_mesh(
    scene: Path,
    /,
    *,
    out: Path,
    format: str = "inp",
    position: float = 0.5,
    refinements: int = 1,
) -> int:
    """Write both gears of SCENE, meshed whole and loaded as they mesh at one position, for other programs.

    Parameters
    ----------
    scene : Path
        The scene file (TOML); its sections pair, material and operating count.
    out : Path
        Folder for pinion and wheel.
    format : str
        inp: CalculiX and Abaqus with loads; msh: gmsh; vtm: named blocks of VTK; or another format of meshio (med,
        vtu, xdmf, ...).
    position : float
        Travel after a pair is at A, over the base pitch, 0 to 1.
    refinements : int
        How often every element is split in four, 0 to 4.
    """
    from fem.fields.export import export_position
    from flankfilm.building.pair import pinion_torque
    from flankfilm.files.cache import results_cache
    from flankfilm.files.folder import claim
    from flankfilm.output.reproduce import scene_in
    from flankfilm.scene.needs_of_helix import refuse_helix
    from flankfilm.stages.engine import Engine
    from flankfilm.stages.mesh import COMPLIANCE, PAIR

    wanted, _ = scene_in(scene)
    refuse_helix(wanted, "plane meshes of loaded gears")
    claim(out)
    if not 0 <= refinements <= 4:
        raise InputError.at("--refinements", refinements, "must be 0 to 4", "1 suits most checks")
    engine = Engine(wanted, results_cache())
    files = export_position(
        out,
        engine[PAIR],
        pinion_torque(wanted),
        position,
        format,
        engine[COMPLIANCE],
        wanted.stiffness.plane,
        refinements,
    )
    for path in files:
        print(f"{path} is written.")
    return 0


def export_table(scene: Path, /, *, out: Path | None = None) -> int:
    """Write the mesh of SCENE as a table over angle, for programs that vibrate shafts.

    Parameters
    ----------
    scene : Path
        The scene file (TOML), or a results.nc; the mesh cycle is computed with its film where there is one.
    out : Path, optional
        A table (.csv), or arrays in SI (.npz); SCENE-mesh.csv beside you if left out.
    """
    from flankfilm.coupling import mesh_table
    from flankfilm.exchange.mesh_files import refuse_others, write_table
    from flankfilm.files.cache import results_cache
    from flankfilm.output.reproduce import scene_in
    from flankfilm.scene.sections.section import required
    from flankfilm.stages.engine import Engine
    from flankfilm.stages.mesh import MESH, PAIR

    wanted, _ = scene_in(scene)
    target = out if out is not None else Path(f"{scene.stem}-mesh.csv")
    refuse_others(target)
    for name in ("pair", "material", "operating"):
        required(getattr(wanted, name), f"[{name}]", "the mesh")
    engine = Engine(wanted, results_cache())
    motion = wanted.dynamics
    extra = (0.0, 0.0) if motion is None else motion.extra_inertia_kg_m2.each
    table = mesh_table(engine[PAIR], engine[MESH], extra)
    write_table(target, table)
    print(
        f"{target} is written: {table.angle.size} positions of one mesh, measured against {table.reference}."
    )
    return 0


def export_traction(
    scene: Path,
    /,
    *,
    pressure_gpa: float | None = None,
    speed_m_per_s: float | None = None,
    temperature_C: float | None = None,
    ratios: str = "0,0.005,0.01,0.02,0.05,0.1,0.2,0.5,1",
    tolerance: float = 0.01,
    out: Path | None = None,
) -> int:
    """Write friction over the slide-roll ratio of the oil of SCENE, as a disc machine measures it.

    Parameters
    ----------
    scene : Path
        The scene file (TOML); its sections pair, material, operating and lubricant count.
    pressure_gpa : float, optional
        Hertz pressure; that at the pitch point if left out.
    speed_m_per_s : float, optional
        Mean speed of both surfaces; that at the pitch point if left out.
    temperature_C : float, optional
        Of the bulk; that of the oil's numbers if left out.
    ratios : str
        Slide-roll ratios (u1 - u2)/u, with commas between.
    tolerance : float
        Relative, of films and friction.
    out : Path, optional
        The table (.csv); SCENE-traction.csv beside you if left out.
    """
    from flankfilm.exchange.traction_files import traction_of, write_traction
    from flankfilm.scene import read_scene

    try:
        places = [float(ratio) for ratio in ratios.split(",")]
    except ValueError:
        raise InputError.at(
            "--ratios", ratios, "must be numbers with commas between", "Such as 0,0.01,0.1"
        ) from None
    conditions = (
        None if pressure_gpa is None else 1e9 * pressure_gpa,
        speed_m_per_s,
        None if temperature_C is None else temperature_C + 273.15,
    )
    curve = traction_of(read_scene(scene), places, *conditions, tolerance=tolerance)
    target = out if out is not None else Path(f"{scene.stem}-traction.csv")
    write_traction(target, curve)
    print(f"{target} is written: {printable(repr(curve))}")
    return 0 if curve.converged else 1
