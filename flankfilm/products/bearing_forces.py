"""Bearing forces of a helical pair over the speed: gears that move and tilt in space on their bearings."""

from __future__ import annotations

import math
from collections.abc import Iterator
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Figure
from base.results import ITSELF
from flankfilm import coupling
from flankfilm.figures.reading import Pictures
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.products.output import Named, in_result, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, ranked, record_of, section_of, wanting
from flankfilm.report.drive_parts import RPM
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent
from flankfilm.scene.sections.section import required
from flankfilm.stages.computed import Computed
from flankfilm.stages.damping import FILM_DAMPING, damping_ratio
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.mesh import MESH
from flankfilm.stages.motion import FOURIER, SCALING, dynamics_of, of_the_pair

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import BearingSweep

PICTURES: Pictures = {"bearing_sweep": "in_space_bearing_force"}


@stage(
    "bearing forces",
    "bearing forces over the speed",
    "operating dynamics pair material heat bearings",
    MESH,
    FOURIER,
    SCALING,
    EXCITATION,
    FILM_DAMPING,
    kept="dynamics flankfilm gears",
)
def BEARING_FORCES(run: Engine) -> coupling.BearingSweep:
    """Periodic motions of both gears in space, linear about the loaded state."""
    section = required(run.scene.bearings, "[bearings]", "bearing forces")
    asked = required(dynamics_of(run).bearing_forces, "dynamics.bearing_forces", "bearing forces")
    inertia = dynamics_of(run).extra_inertia_kg_m2.each
    contact = run[MESH].against("body", inertia).contact
    assert contact is not None
    mesh, each = coupling.spatial_mesh(contact), section.each
    held, damped = (
        tuple(sum((getattr(one, what) for one in bearings), np.zeros((6, 6))) for bearings in each)
        for what in ("stiffness", "damping")
    )
    pair = coupling.spatial_pair(
        mesh,
        (held[0], held[1]),
        damping_ratio=damping_ratio(run),
        bearing_damping=(damped[0], damped[1]),
        extra_mass=section.masses,
        extra_inertia=inertia,
    )
    speeds = np.linspace(*asked.ends, asked.points) * math.pi / 30.0
    if asked.frequency is not None:
        scales = run[SCALING].scales
        assert scales is not None
        speeds *= scales.rpm(1.0)
    return coupling.bearing_sweep(
        pair,
        each,
        speeds,
        harmonics=asked.harmonics,
        mesh_error=contact.error,
        transmission_error=_transmission_error(run, len(mesh.turn)),
    )


def _transmission_error(run: Engine, positions: int) -> Array | None:
    """Unloaded error of the scene over a base pitch (positions,) [m]; that of its flanks is in the loaded contact."""
    if dynamics_of(run).error_curve == "unloaded":
        return None
    _, arguments = of_the_pair(run, run[FOURIER])
    amplitude = np.atleast_1d(np.asarray(arguments.get("error_amplitude", 0.0), dtype=np.float64))
    phase = np.broadcast_to(np.asarray(arguments.get("error_phase", 0.0)), amplitude.shape)
    angle = 2.0 * math.pi * np.outer((np.arange(positions) + 0.5) / positions, 1 + np.arange(amplitude.size))
    return np.asarray(np.cos(angle + phase) @ amplitude)


def section(swept: BearingSweep, results: xr.Dataset) -> Part:
    """Largest forces of all bearings, and natural frequencies with the speeds of their resonance."""
    rows = []
    for column, name in enumerate(swept.bearings):
        swing = swept.bearing_swing[:, column]
        at = RPM * swept.speed[int(np.nanargmax(swing))]
        most, axial = (
            float(np.nanmax(values[:, column])) for values in (swept.bearing_force, swept.axial_force)
        )
        mean = float(swept.mean_force[column])
        rows.append((name, *map(number, (mean, most, axial, float(np.nanmax(swing)))), f"{at:.0f}"))
    about_mean = "root mean square about the mean [N]"
    heads = ("bearing", "mean force [N]", "maximum [N]", "maximum axial [N]", about_mean, "at [rpm]")
    modes = tuple(
        (str(row), number(float(frequency), 5), f"{RPM * speed:.0f}", number(100.0 * float(share)))
        for row, (frequency, speed, share) in enumerate(
            zip(swept.natural_frequencies, swept.resonance_speeds, swept.mesh_share, strict=True), start=1
        )
    )
    mode_heads = ("mode", "frequency [Hz]", "mesh resonance at [rpm]", "elastic energy in the mesh [%]")
    caption = f"Natural frequencies err by {percent(swept.frequency_error)} at most, by the mesh."
    notes = [said("bearing_forces", error=percent(swept.error))]
    if swept.message:
        notes.append(f"{swept.message[:1].upper()}{swept.message[1:]}.")
    return Part(
        "bearing-forces",
        "Bearing forces in space",
        figures=pictures(results, PICTURES),
        tables=(Table(heads, tuple(rows)), Table(mode_heads, modes, caption)),
        notes=tuple(notes),
    )


def headlines(computed: Computed) -> Iterator[Headline]:
    """Maximum swing of a bearing's force, and the axial motion."""
    if (swept := computed.get(BEARING_FORCES)) is None:
        return
    off = Uncertainty(float(swept.error))
    at = f"at {RPM * swept.greatest_swing_speed:.0f} rpm"
    swing = number(swept.greatest_swing)
    motion = number(1e6 * swept.greatest_axial_motion)
    name = "largest swing of a bearing force, root mean square"
    yield from ranked([Headline(name, swing, at, "N", off)], 2)
    yield Headline("largest axial motion of a gear, peak to peak", motion, "", "µm", off)


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_bearings = outputs_from(lambda engine: engine[BEARING_FORCES], coupling.BearingSweep, "bearing-forces")
    held = {"error_output": "bearing_forces_error"}
    return (
        of_bearings("greatest_force", name="greatest_force_in_space", **held),
        of_bearings("greatest_swing", name="greatest_swing_in_space", **held),
        of_bearings("greatest_swing_speed", name="greatest_swing_speed_in_space"),
        of_bearings("greatest_axial_motion", name="greatest_axial_motion", **held),
        of_bearings("greatest_tilt", name="greatest_tilt", **held),
        of_bearings(
            "natural_frequencies",
            take=lambda values: float(values[0]),
            name="lowest_frequency_in_space",
            said="lowest of the {}",
            error_output="frequency_in_space_error",
        ),
        of_bearings("frequency_error", name="frequency_in_space_error"),
        output_of(
            "bearing_forces_error",
            Figure(
                "1",
                "estimated relative error of forces, axial motion and tilt in space, that of the largest swing: by "
                "harmonics, cells and the error of the mesh",
                no_error=ITSELF,
            ),
            "bearing-forces",
            in_result(BEARING_FORCES, attrgetter("error")),
        ),
    )


PRODUCT = Product(
    name="bearing-forces",
    goals=wanting("bearing-forces", BEARING_FORCES),
    variables=record_of("in_space", BEARING_FORCES),
    solved={"in_space": BEARING_FORCES},
    tables={
        "bearing_forces": CurveTable("in_space", "bearing_force", axis="speed"),
        "modes_in_space": CurveTable(
            "in_space", "natural_frequencies", ("natural_frequencies", "resonance_speeds", "mesh_share")
        ),
    },
    headlines=headlines,
    pictures=PICTURES,
    sections=section_of(BEARING_FORCES, section),
    outputs=outputs,
)
