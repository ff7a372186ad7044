"""Dynamic factor over speed and torque."""

from __future__ import annotations

import math
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from base import Figure
from flankfilm import coupling
from flankfilm.building.film import film_model, lubricant
from flankfilm.building.pair import pinion_speed
from flankfilm.building.shafts import drive_arguments
from flankfilm.figures.reading import Pictures
from flankfilm.output.drives import carrying
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.products.drive import CARRIED, of_a_train
from flankfilm.products.output import Named, in_result, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, ranked, section_of, wanting, when
from flankfilm.report.drive_parts import RPM, carried_table
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent
from flankfilm.scene.sections.dynamics import OSCILLATOR
from flankfilm.scene.sections.section import required
from flankfilm.stages.damping import FILM_DAMPING, damping_ratio
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.mesh import DRY_CYCLE, FILM, MESH, PAIR, PLAN, TEETH, loaded_teeth, with_arcs
from flankfilm.stages.motion import FOURIER

if TYPE_CHECKING:
    import xarray as xr

PICTURES: Pictures = {
    "dynamic_map": "dynamic_map_factor",
    "drive_map": ("dynamic_map_bearings", "dynamic_map_shafts"),
}


@stage(
    "dynamic-map",
    "dynamic factor over speed and torque",
    f"{TEETH} operating dynamics film lubricant roughness shafts",
    DRY_CYCLE,
    FILM,
    FOURIER,
    EXCITATION,
    FILM_DAMPING,
    kept="dynamics flankfilm gears fem meshes ehl",
)
def DYNAMIC_MAP(run: Engine) -> coupling.DynamicMap:
    """Maximum force over the mean one, each torque with its own mesh cycle and the order of the scene's series."""
    scene = run.scene
    section = required(scene.dynamics, "[dynamics]", "the dynamic map")
    operating = required(scene.operating, "[operating]", "the dynamic map")
    asked = required(section.sweep, "dynamics.sweep", "the dynamic map", "add the range")
    arguments = section.si(*OSCILLATOR) | {"damping_ratio": damping_ratio(run)}
    if arguments["error_phase"] == (0.0,):
        arguments["error_phase"] = 0.0
    if section.error_curve is not None and (error := run[EXCITATION]) is not None:
        arguments["error_amplitude"], arguments["error_phase"] = error.amplitude, error.phase
    arguments |= {
        "extra_inertia": section.extra_inertia_kg_m2.each,
        "reference": scene.reference or "body",
    }
    speeds = np.linspace(*asked.ends, asked.points) * math.pi / 30.0
    order = run[FOURIER].order

    ends = float(speeds[0]), float(speeds[-1])
    shafts = None if scene.shafts is None else drive_arguments(scene) | {"speeds": ends}

    def at(torque: float) -> coupling.PairOscillator | coupling.PairDrive:
        cycle = _mesh_at(run, torque)
        series = coupling.mesh_series(cycle, section.stiffness, order)
        if shafts is not None:
            tilting = coupling.tilting_mesh(cycle)
            return coupling.pair_drive(
                run[PAIR], series, torque, float(speeds[0]), **shafts, **arguments, **tilting
            )
        return coupling.pair_oscillator(run[PAIR], series, torque, float(speeds[0]), **arguments)

    return coupling.dynamic_map(at, operating.torques_Nm, speeds, progress=run.rows(DYNAMIC_MAP))


def _mesh_at(run: Engine, torque: float) -> coupling.MeshCycle:
    """Mesh cycle under another torque, with films at the scene's speed where it has them."""
    scene, plan = run.scene, run[PLAN]
    teeth = replace(loaded_teeth(run), torque=torque)
    if torque == loaded_teeth(run).torque:
        return run[MESH]
    dry = with_arcs(teeth.sampled(plan.resolution.sampling, plan.resolution.transmission_error))
    if plan.film.choice == "none":
        return dry
    model = film_model(scene, plan.film.choice)
    return with_arcs(
        coupling.lubricate(teeth, dry, pinion_speed(scene), lubricant(scene), plan.resolution, model)
    )


def section(stage: coupling.DynamicMap, results: xr.Dataset) -> Part:
    """Draw the map, and list the maximum factor at each torque."""
    rows = []
    for torque, resonance, factors, iso, apart in zip(
        stage.torque, stage.resonance, stage.factor, stage.iso, stage.separated, strict=True
    ):
        most = int(np.nanargmax(factors))
        beside = number(float(iso[most])) if np.isfinite(iso[most]) else "-"
        rows.append(
            (
                number(float(torque)),
                f"{RPM * resonance:.0f}",
                number(float(factors[most])),
                f"{RPM * stage.speed[most]:.0f}",
                beside,
                number(100.0 * float(np.nanmax(apart))),
            )
        )
    heads = (
        "torque [N m]",
        "resonance [rpm]",
        "maximum K_v [-]",
        "at [rpm]",
        "ISO 6336-1, B, there [-]",
        "maximum time without contact [%]",
    )
    notes = [said("dynamic_map", error=percent(stage.sampling_error))]
    if stage.truncation is not None:
        notes.append(said("dynamic_map_order", changed=percent(stage.truncation)))
    if not stage.converged:
        notes.append(stage.message)
    carried = carried_table(
        stage,
        ("at [rpm]", "at [N m]"),
        lambda figure: np.asarray(getattr(stage, figure)),
        lambda at: (f"{RPM * stage.speed[at[1]]:.0f}", number(float(stage.torque[at[0]]))),
    )
    drawn = pictures(results, PICTURES)
    tables = (Table(heads, tuple(rows)), *carried)
    return Part(
        "dynamic-map",
        "Dynamic factor over speed and torque",
        figures=drawn,
        tables=tables,
        notes=tuple(notes),
    )


def headlines(stage: coupling.DynamicMap) -> list[Headline]:
    """Maximum factor of the map."""
    row, column = np.unravel_index(int(np.nanargmax(stage.factor)), stage.factor.shape)
    note = f"at {RPM * stage.speed[column]:.0f} rpm and {stage.torque[row]:g} N m"
    off = Uncertainty(float(stage.sampling_error))
    name = "maximum dynamic factor K_v of the map"
    return [Headline(name, f"{stage.greatest:.3g}", note, uncertainty=off)]


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_parts = outputs_from(of_a_train(DYNAMIC_MAP), coupling.DynamicMap, "dynamic-map")
    return (
        output_of(
            "greatest_map_factor",
            Figure("1", "maximum dynamic factor over speeds and torques"),
            "dynamic-map",
            in_result(DYNAMIC_MAP, attrgetter("greatest")),
            error_output="greatest_map_factor_error",
        ),
        output_of(
            "greatest_map_factor_error",
            Figure("1", "estimated relative error of that factor by samples of a period"),
            "dynamic-map",
            in_result(DYNAMIC_MAP, attrgetter("sampling_error")),
        ),
        of_parts(
            "greatest_bearing_force",
            name="greatest_map_bearing_force",
            error_output="greatest_map_factor_error",
        ),
        of_parts(
            "greatest_shaft_torque",
            name="greatest_map_shaft_torque",
            error_output="greatest_map_factor_error",
        ),
    )


PRODUCT = Product(
    name="dynamic-map",
    goals=wanting("dynamic-map", DYNAMIC_MAP),
    variables=when(DYNAMIC_MAP, lambda factors: [carrying("dynamic_map", factors)]),
    solved={"dynamic_map": DYNAMIC_MAP},
    tables={
        "dynamic_map": CurveTable(
            "dynamic_map",
            "factor",
            ("torque", "speed", "factor", "factor_up", "factor_down", "iso", *CARRIED),
        )
    },
    headlines=when(DYNAMIC_MAP, lambda factors: ranked(headlines(factors), 2)),
    pictures=PICTURES,
    sections=section_of(DYNAMIC_MAP, section),
    outputs=outputs,
)
