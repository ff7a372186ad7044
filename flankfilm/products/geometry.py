"""Geometry of the pair, its growth by heat, and measured and worn flanks."""

from __future__ import annotations

from collections.abc import Iterator, Set
from typing import TYPE_CHECKING, Any

import numpy as np

import gears
from base import Figure
from base.results import EXACT
from flankfilm.building.flanks import deviations
from flankfilm.building.pair import pinion_speed, pinion_speed_if_any, pinion_torque
from flankfilm.figures.reading import Pictures
from flankfilm.output import drawing_data as drawn
from flankfilm.output.flanks import measured_flanks
from flankfilm.output.geometry import pair_figures
from flankfilm.output.variables import of_quantities, of_record
from flankfilm.products.output import Named, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product
from flankfilm.report import pair_parts
from flankfilm.report.page import Part, pictures
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.mesh import HEAT, PAIR

if TYPE_CHECKING:
    import xarray as xr

GEARS = ("pinion", "wheel")

FLANKS: Pictures = {
    "flanks": tuple(f"flank_{gear}_{along}" for gear in GEARS for along in ("diameter", "face_place"))
}


LENGTHS = ("across", "mean", "minimum", "maximum")
"""Figures of the lines of contact that the pair has not."""


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The pair, and its growth wherever the scene has temperatures."""
    if "geometry" in wants:
        yield PAIR
    if scene.heat is not None and scene.pair is not None:
        yield HEAT


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Sizes, outlines of teeth, the path of contact, deviations of flanks, and growth."""
    scene = computed.scene
    if (pair := computed.get(PAIR)) is not None:
        yield pair_figures("pair", pair)
        yield of_record("dimensions", gears.dimensions(pair))
        yield of_quantities("outline", drawn.outlines(pair))
        yield of_quantities("path", drawn.path(pair, pinion_speed_if_any(scene)))
        yield from measured_flanks(pair, deviations(scene, pair, every_tooth=True))
        if pair.helix_angle:
            yield from _of_helix(pair, scene)
    if (warm := computed.get(HEAT)) is not None:
        yield of_record("heat", warm)


def _of_helix(pair: gears.GearPair, scene: Scene) -> Iterator[xr.Dataset]:
    """Lines of contact, and the forces of the mesh where the scene has a torque."""
    yield of_record("contact_lines", gears.contact_lines(pair), LENGTHS)
    yield of_quantities("contact_lines", drawn.lines_of_contact(pair))
    if scene.operating is not None:
        yield of_record("mesh_force", gears.mesh_forces(pair, pinion_torque(scene)))


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """Sizes, growth, and flanks."""
    if (pair := computed.get(PAIR)) is None:
        return
    yield pair_parts.geometry(pair, results)
    if (warm := computed.get(HEAT)) is not None:
        yield pair_parts.heat(warm)
    if flanks := pictures(results, FLANKS):
        yield Part("flanks", "Flanks", figures=flanks)


def _ends(engine: Engine) -> Any:
    """Path of contact at A and E."""
    points = engine[PAIR].points
    return engine[PAIR].path_at(np.array([points.A, points.E]))


def _forces(engine: Engine) -> gears.MeshForces:
    """Forces of the mesh at the scene's torque."""
    return gears.mesh_forces(engine[PAIR], pinion_torque(engine.scene))


def _length_harmonic(order: int) -> Named:
    """Output of a harmonic of the total length of the lines of contact."""
    about = Figure(
        "1",
        f"amplitude of harmonic {order} of the total length of the lines of contact over its mean",
        no_error=EXACT,
    )
    return output_of(
        f"contact_length_harmonic_{order}",
        about,
        "geometry",
        lambda engine: gears.contact_lines(engine[PAIR]).harmonics(order)[-1],
    )


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_lines = outputs_from(lambda engine: gears.contact_lines(engine[PAIR]), gears.ContactLines, "geometry")
    of_pair = outputs_from(lambda engine: engine[PAIR], gears.GearPair, "geometry")
    of_heat = outputs_from(lambda engine: engine[HEAT], gears.WarmPair, "geometry")
    return (
        of_pair("contact_ratio"),
        of_heat("cold_backlash"),
        of_heat("base_pitch_difference"),
        of_pair("working_centre_distance", name="centre_distance"),
        of_pair("working_pressure_angle"),
        of_pair("base_helix_angle"),
        of_pair("transverse_module"),
        of_pair("transverse_pressure_angle"),
        of_pair("overlap_ratio"),
        of_pair("total_contact_ratio"),
        *(of_lines(which, name=f"{which}_contact_length") for which in ("mean", "minimum", "maximum")),
        *(_length_harmonic(order) for order in range(1, drawn.ORDERS + 1)),
        outputs_from(_forces, gears.MeshForces, "geometry")("axial", name="axial_force"),
        output_of(
            "specific_sliding",
            Figure("1", "largest specific sliding of both flanks, A to E", no_error=EXACT),
            "geometry",
            lambda engine: max(np.abs(part).max() for part in _ends(engine).specific_sliding),
        ),
        output_of(
            "sliding_speed",
            drawn.SLIDING,
            "geometry",
            lambda engine: np.abs(_ends(engine).sliding(pinion_speed(engine.scene))).max(),
            "largest {}, A to E",
        ),
    )


PRODUCT = Product(
    name="geometry",
    goals=goals,
    variables=variables,
    tables={
        "path_of_contact": CurveTable(
            "path", "rho1", ("rho1", "rho2", "radius", "entrainment", "sliding", "specific_sliding")
        ),
        **{
            f"flank_{gear}": CurveTable(
                f"flank_{gear}",
                "diameter",
                ("tooth", "diameter", "material", "mean_material", "wear", "mean_wear"),
            )
            for gear in GEARS
        },
        **{
            f"lead_{gear}": CurveTable(f"flank_{gear}", "face_place", ("face_place", "lead"))
            for gear in GEARS
        },
        "contact_lines": CurveTable("contact_lines", "length", ("position", "length")),
        "contact_line_harmonics": CurveTable("contact_lines", "harmonics", ("harmonic", "harmonics")),
    },
    pictures={**pair_parts.IN_MESH, **pair_parts.PATH, **pair_parts.LINES, **FLANKS},
    sections=sections,
    outputs=outputs,
)
