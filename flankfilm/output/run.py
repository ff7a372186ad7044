"""What a run writes as data: one netCDF file with everything, one CSV for each curve."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import gears
from base import Quantity
from base.results import EXACT, figures, why_no_error
from flankfilm.building.flanks import deviations
from flankfilm.building.pair import pinion_speed
from flankfilm.coupling.vibration.part_loads import PARTS
from flankfilm.output import drawing_data as drawn
from flankfilm.output import drives, heat
from flankfilm.output.branches import branch_tables
from flankfilm.output.convergence import with_convergence
from flankfilm.output.files import provenance, write_csv, write_netcdf
from flankfilm.output.flanks import measured_flanks
from flankfilm.output.geometry import geometry_columns
from flankfilm.output.model_errors import entry
from flankfilm.output.passages import fillet_stress, passage
from flankfilm.output.tables import columns, uncertainties
from flankfilm.output.variables import (
    figure_of,
    joined,
    merged,
    of_list,
    of_models,
    of_quantities,
    of_record,
    with_tolerance,
)
from flankfilm.plan.decisions import decisions
from gears.sharing.mesh_figures import MeshFigures

if TYPE_CHECKING:
    import xarray as xr

    import ehl
    import fem
    from flankfilm.coupling import LubricatedCycle, MeshSeries, RootStresses, SpeedSweep
    from flankfilm.scene import Scene
    from flankfilm.stages.failures import Failure

CONTACTS = ("unloaded_transmission_error", "hertz_pressure", "half_width")
"""Figures of a loaded contact by finite elements that stand beside those which every model has."""

THROUGH = ("x", "pressure", "thickness", "central_thickness", "minimum_thickness")
"""Figures of whole films."""

GEARS = ("pinion", "wheel")

DIMENSIONLESS = ("mean_force", "half_backlash", "frequency")
"""Figures of an oscillator in its own units."""

OTHERS = "unknown: closed forms, or pairs without a common body; other_mean_error and other_range_error are numerical"

MEANS = {"mean_secant_stiffness": "mean_error", "transmission_error_range": "range_error"}
"""Figures of mesh cycles to those that hold their errors."""

HERTZ = "not estimated: Hertz's law of the contact's force, whose error is not known in single positions"

STRESSES = ("eyring_stress", "mean_friction", "sliding_loss", "rolling_loss", "mesh_loss", "efficiency")
"""Figures of a mesh's losses by Eyring's stress."""

CYCLE = ("position", "secant_stiffness", "tangent_stiffness", "transmission_error", "load_share")


RESONANCE = (
    "speed",
    "frequency",
    *(f"{what}_{way}" for way in ("up", "down") for what in ("force_factor", "separated", "spread")),
)


CARRIED = tuple(f"{figure}{end}" for figure, _ in PARTS.values() for end in ("", "_swing"))
"""What bearings, shafts and couplings carry, where there are any."""


@dataclass(frozen=True)
class Table:
    """A CSV file: columns of the record with a prefix, named, or all along an axis; without the figure `about` none."""

    prefix: str
    about: str
    names: tuple[str, ...] = ()
    axis: str = ""


RECORDS = {
    "single_pair": "closed forms",
    "dry": "dry cycle",
    "reference": "references",
    "face_models": "load over the face",
    "damping": "film damping",
    "torque": "torques",
    "pair": "pair",
    "heat": "heat",
}
"""Prefix of the variables of each stage whose result is one record."""

TABLES: Mapping[str, Table] = {
    "path_of_contact": Table(
        "path", "rho1", ("rho1", "rho2", "radius", "entrainment", "sliding", "specific_sliding")
    ),
    "single_pair_stiffness": Table("single_pair", "rho1", axis="path"),
    "mesh_cycle_dry": Table("dry", "position", CYCLE),
    "contacts_dry": Table(
        "dry", "hertz_pressure", ("position", "forces", "hertz_pressure", "half_width", "sliding")
    ),
    "face_load_dry": Table(
        "dry_face",
        "line_load",
        ("travel", "face_position", "line_load", "hertz_pressure", "face_load_factor"),
    ),
    "shafts_under_face": Table(
        "dry_face",
        "shaft_deflection",
        (
            "travel",
            *(
                "shaft_transmission_error",
                "tilt_transmission_error",
                "shaft_deflection",
                "shaft_misalignment",
            ),
            *("moment_stiffness", "tilt_stiffness"),
        ),
    ),
    "face_models": Table("face_models", "line_load", ("face_position", "model", "line_load")),
    **{
        f"root_face_{gear}": Table(
            f"root_face_{gear}",
            "cycle_tension",
            ("face_position", "cycle_tension", "cycle_compression"),
        )
        for gear in GEARS
    },
    "torques": Table("torque", "torque", axis="torque"),
    "revolution": Table(
        "revolution",
        "position",
        ("position", "transmission_error", "unloaded_transmission_error", "secant_stiffness"),
    ),
    **{
        f"flank_{gear}": Table(
            f"flank_{gear}",
            "diameter",
            ("tooth", "diameter", "material", "mean_material", "wear", "mean_wear"),
        )
        for gear in GEARS
    },
    **{f"lead_{gear}": Table(f"flank_{gear}", "face_place", ("face_place", "lead")) for gear in GEARS},
    **{f"root_stress_{gear}": Table(f"root_{gear}", "travel", axis="instant") for gear in GEARS},
    **{f"fillet_stress_{gear}": Table(f"fillet_{gear}", "arc", axis="arc") for gear in GEARS},
    "mesh_cycle_lubricated": Table("lubricated", "position", CYCLE),
    "film_along_path": Table("film", "rho1", axis="point"),
    "losses_along_path": Table("losses_path", "rho1", axis="point"),
    "losses_by_eyring_stress": Table("losses_band", "eyring_stress", STRESSES),
    **{f"sweep_{d}": Table("sweep", d, ("speed", "frequency", d, f"{d}_label")) for d in ("up", "down")},
    "drive_modes": Table(
        "drive", "natural_frequencies", ("natural_frequencies", "frequency_error", "retained", "mesh_share")
    ),
    **{
        f"drive_peaks_{part}s": Table(
            "drive_sweep",
            f"{figure}_peak",
            (f"{part}s", *(f"{figure}_peak{end}" for end in ("", "_speed", "_error"))),
        )
        for part, (figure, _) in PARTS.items()
    },
    "drive_sweep": Table("drive_sweep", "force_factor_up", axis="frequency"),
    "excitation": Table("excitation", "amplitude", axis="harmonic"),
    "spectrum": Table("spectrum", "force", axis="line"),
    "run_up": Table("run_up", "force_factor_up", axis="block"),
    "dynamic_map": Table(
        "dynamic_map",
        "factor",
        ("torque", "speed", "factor", "factor_up", "factor_down", "iso", *CARRIED),
    ),
    "resonance": Table("sweep", "force_factor_up", RESONANCE),
    "diagram": Table("diagram", "frequency", axis="point"),
    "diagram_returns": Table("return", "frequency", axis="point"),
    "special_points": Table("special", "frequency", axis="point"),
    "jumps": Table("jump", "frequency", axis="jump"),
    "missed_jumps": Table("missed", "frequency", axis="jump"),
    "stable_motions": Table("stable", "motion", axis="range"),
    "force_over_speed": Table("force", "factor", axis="force"),
}
"""CSV files by name."""


def not_computed(failures: Sequence[Failure]) -> dict[str, str]:
    """Attribute that says which parts of a scene could not be computed, and why."""
    return {"not_computed_json": json.dumps([failure.plain() for failure in failures])}


def results_dataset(scene: Scene, values: Mapping[str, Any], failures: Sequence[Failure] = ()) -> xr.Dataset:
    """Give everything that a run found as one dataset: what ``results.nc`` holds and figures are drawn from.

    Parameters
    ----------
    scene : Scene
        What was asked for.
    values : mapping
        Stage name to result.
    failures : sequence of Failure
        Parts that could not be computed; they have no variables, and the dataset says why.
    """
    decided = {"decisions_json": json.dumps([decision.plain() for decision in decisions(values)])}
    attributes = {
        "title": scene.title,
        **decided,
        **not_computed(failures),
        **provenance(scene.model_dump_json()),
    }
    parts = list(_records(values, _speed(scene)))
    if (pair := values.get("pair")) is not None:
        parts += measured_flanks(pair, deviations(scene, pair, every_tooth=True))
    return with_tolerance(with_convergence(merged(parts, attributes), values), scene.tolerance)


def results_tables(data: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Columns of the CSV files by name: one table for each curve."""
    tables = {
        file: columns(data, table.prefix, table.names, table.axis)
        for file, table in TABLES.items()
        if joined(table.prefix, table.about) in data.variables
    }
    errors: dict[str, Any] = uncertainties(data)
    if errors["variable"].size:
        tables["uncertainties"] = errors
    return {"geometry": geometry_columns(data), **tables} if "dimensions_span" in data else tables


def write_data(folder: Path, data: xr.Dataset) -> list[Path]:
    """Write ``results.nc`` and the CSV files; return what was written."""
    write_netcdf(folder / "results.nc", data)
    files = [folder / "results.nc"]
    for name, table in results_tables(data).items():
        files.append(folder / "csv" / f"{name}.csv")
        write_csv(files[-1], table)
    return files


def _records(values: Mapping[str, Any], speed: float | None) -> Iterator[xr.Dataset]:
    """Variables of all records that a run gave, in the order of the stages."""
    for prefix, name in RECORDS.items():
        if (record := values.get(name)) is not None:
            yield of_record(prefix, record)
    if (closed := values.get("closed forms")) is not None:
        yield of_record("iso6336_2", closed.contact)
    if (pair := values.get("pair")) is not None:
        yield of_record("dimensions", gears.dimensions(pair))
        yield of_quantities("outline", drawn.outlines(pair))
        yield of_quantities("path", drawn.path(pair, speed))
    if (dry := values.get("dry cycle")) is not None and dry.contact is not None:
        yield of_record("dry", dry.contact, CONTACTS)
        yield of_quantities("dry", _sliding(dry.contact, speed))
        if dry.contact.face is not None:
            yield of_record("dry_face", dry.contact.face)
    if (revolution := values.get("revolution")) is not None:
        # curves alone: what follows from arcs is not looked for over a revolution
        known = [name for name in figures(type(revolution)) if name not in vars(MeshFigures)]
        yield of_record("revolution", revolution, known)
    if others := values.get("other cycles"):
        labelled = {cycle.label: cycle for cycle in others}
        yield of_models("other", labelled, "model of the mesh cycle", errors=MEANS, no_error=OTHERS)
    if (lubricated := values.get("film")) is not None:
        yield from _lubricated(lubricated, values["pair"].reduced_modulus)
    if (lost := values.get("losses")) is not None:
        yield from heat.losses(lost)
    if (hot := values.get("hot contact")) is not None and hot.converged:
        yield from heat.hot_contact(hot, values["losses"].bulk_temperatures)
    if (roots := values.get("root stress")) is not None:
        yield from _roots(roots)
    if (series := values.get("fourier")) is not None:
        yield _fourier(series)
    if (motion := values.get("scaling")) is not None:
        yield of_record("oscillator", motion, None if motion.scales is not None else DIMENSIONLESS)
    if (excitation := values.get("excitation")) is not None:
        yield of_record("excitation", excitation)
    if (sweep := values.get("sweep")) is not None:
        yield from _sweep(sweep)
    yield from drives.train(values.get("drive"), values.get("drive sweep"))
    if (spectrum := values.get("spectrum")) is not None:
        yield drives.carrying("spectrum", spectrum)
    if (ramps := values.get("run-up")) is not None:
        yield drives.carrying("run_up", ramps)
    if (over := values.get("dynamic-map")) is not None:
        yield drives.carrying("dynamic_map", over)
    if (diagram := values.get("diagram")) is not None:
        yield from branch_tables(diagram)
    if (fields := values.get("fields")) is not None and pair is not None:
        yield of_quantities("field", drawn.near_mesh(pair, (fields.pinion, fields.wheel)))


def _sliding(contact: fem.MeshCycle, speed: float | None) -> Iterator[Quantity]:
    """Sliding of a loaded contact, at a speed of the pinion [rad/s] where there is one; nan where nothing touches."""
    touching = contact.forces > 0
    specific = np.where(touching, contact.specific_sliding, np.nan)
    yield figure_of(
        "specific_sliding",
        "1",
        "sliding over the flank's own speed",
        "gear position pair",
        specific,
        no_error=EXACT,
    )
    if speed is not None:
        sliding = np.where(touching, contact.sliding(speed), np.nan)
        yield figure_of(
            "sliding",
            "m/s",
            "sliding speed u1 - u2, negative before C",
            "position pair",
            sliding,
            no_error=EXACT,
        )


def held_as_it_is(cycle: LubricatedCycle) -> str:
    """Label of a starved film beside others in which something else is held."""
    return f"this film, {cycle.film.supply.replace('-', ' ')} held"


def _lubricated(cycle: LubricatedCycle, modulus: float) -> Iterator[xr.Dataset]:
    """Mesh cycle with film, the film along the path, whole films and starved ones otherwise; `modulus` E' [Pa]."""
    yield of_record("lubricated", cycle)
    yield of_record("film", cycle.film)
    if cycle.over_face is not None:
        yield of_record("film_face", cycle.over_face)
    for name, film in cycle.film.profiles.items():
        prefix = f"film_profile_{name.replace(' ', '_')}"
        yield of_record(prefix, film, THROUGH)
        yield of_record(prefix, film.contact, ("half_width",))
        yield of_quantities(prefix, _whole_pressure(film, modulus, cycle.film.film_ratio is not None))
    if cycle.otherwise:
        held = {held_as_it_is(cycle): cycle, **cycle.otherwise}
        meaning = "mesh cycle with films that differ in what is held"
        yield of_models("held", held, meaning, no_error="not estimated for each of them")


def _whole_pressure(film: ehl.Film, modulus: float, rough: bool) -> Iterator[Quantity]:
    """Hertz pressure of a dry contact, and with rough flanks the pressure of film and asperities together.

    Both carry their share of the load at every point alike: the film's contact has this part of the modulus.
    """
    part = film.contact.reduced_modulus / modulus
    greatest = film.contact.peak_pressure / part
    yield figure_of(
        "hertz_pressure",
        "Pa",
        "Hertz pressure, the largest of the dry contact",
        "",
        greatest,
        shown="GPa",
        no_error=HERTZ,
    )
    if rough:
        whole = film.pressure / part
        meaning = "pressure of film and asperities together"
        about = why_no_error(film, "pressure")
        yield figure_of("total_pressure", "Pa", meaning, "node", whole, shown="GPa", no_error=about)


def _fourier(series: MeshSeries) -> xr.Dataset:
    """Series of the stiffness; a given one may be over its mean."""
    variables = of_record("fourier", series)
    if series.kind == "given" and series.mean == 1.0:
        for name in ("fourier_mean", "fourier_amplitude"):
            variables[name].attrs["units"] = "1"
    return variables


def _roots(roots: RootStresses) -> Iterator[xr.Dataset]:
    """Root stress of a passing tooth and along the fillets of both gears, and nominal stress."""
    for name in GEARS:
        gear = getattr(roots.stress, name)
        for prefix, quantities in ((f"root_{name}", passage(gear)), (f"fillet_{name}", fillet_stress(gear))):
            stresses = [quantity.name for quantity in quantities if quantity.figure.unit == "Pa"]
            data = of_quantities(prefix, quantities, dict.fromkeys(stresses, roots.stress.error))
            known = entry(gear, "greatest_tension_Pa")
            if known is not None:
                for name_of in stresses:
                    about = {"model_error": known.of(gear), "model_error_source": known.source}
                    data[joined(prefix, name_of)].attrs.update(about)
            yield data
        if gear.face is not None:
            yield of_record(f"root_face_{name}", gear.face)
    if roots.iso_face is not None:
        yield of_record("iso6336_face", roots.iso_face)
    if roots.iso is not None:
        yield of_record("iso6336_3", roots.iso)
        yield of_list("iso6336_3", "gear", roots.iso.sections)


def _sweep(sweep: SpeedSweep) -> Iterator[xr.Dataset]:
    """States and labels by direction, and portraits."""
    names = {f"sweep_states_{up}": f"sweep_{up}" for up in sweep.states}
    names |= {f"sweep_labels_{up}": f"sweep_{up}_label" for up in sweep.labels}
    yield of_record("sweep", sweep).rename(names)
    if sweep.portraits:
        motion = dict.fromkeys(("displacement", "velocity", "section"), sweep.error)
        yield of_quantities("portrait", drawn.portraits(sweep.portraits), motion)


def _speed(scene: Scene) -> float | None:
    """Pinion speed [rad/s], where the scene has one."""
    operating = scene.operating
    return None if operating is None or operating.pinion_speed_rpm is None else pinion_speed(scene)
