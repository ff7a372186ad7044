"""Load over the face: line load, pressure and shafts along it, and other models beside it."""

from __future__ import annotations

from collections.abc import Iterator, Set
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

import fem
from base import Figure
from base.results import figures
from flankfilm import coupling
from flankfilm.building.face import varies_by
from flankfilm.coupling.mesh.face_models import LABELS
from flankfilm.figures.reading import GEARS
from flankfilm.output.uncertainty import uncertainty
from flankfilm.output.variables import of_record
from flankfilm.products.output import (
    Held,
    Named,
    Of,
    Take,
    figure_of_kind,
    holds_error,
    model_error_of,
    output_of,
)
from flankfilm.products.product import CurveTable, Product, ranked
from flankfilm.report import face_parts
from flankfilm.report.page import Headline, Part
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage, stage
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, PAIR, TEETH, loaded_teeth
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    import xarray as xr


@stage("load over the face", "load over the face by other models", TEETH, DRY_CYCLE)
def FACE_MODELS(run: Engine) -> coupling.FaceLoadModels:
    """Walls, slices and ISO 6336-1 beside the mesh cycle, of a scene whose load varies along the face."""
    return coupling.face_load_models(loaded_teeth(run), run[DRY_CYCLE])


@stage(
    "face over tolerance",
    "load over the face over a tolerance of the alignment",
    f"{TEETH} alignment",
    COMPLIANCE,
)
def FACE_TOLERANCE(run: Engine) -> coupling.FaceTolerance:
    """Face-load factors with the axes as the scene has them, and by its tolerance more and less out of parallel."""
    section = run.scene.alignment
    tolerance = 0.0 if section is None else section.value("in_plane_tolerance_um")
    return coupling.face_load_tolerance(loaded_teeth(run), tolerance)


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """Other models beside a mesh cycle whose load varies along the face."""
    if wants & {"stiffness", "film"} and scene.stiffness.model != "given" and _across(scene):
        yield FACE_MODELS


def _across(scene: Scene) -> bool:
    """Whether loads vary along contacts that lie along the face, as those of spur gears do."""
    return bool(varies_by(scene)) and not (scene.pair is not None and scene.pair.helical)


def _loads(computed: Computed) -> fem.FaceLoads | None:
    """Line loads over the face of the dry cycle; None where they are even."""
    dry = computed.get(DRY_CYCLE)
    return None if dry is None or dry.contact is None else dry.contact.face


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Line loads of the mesh cycle, and of other models."""
    if (loads := _loads(computed)) is not None:
        yield of_record("dry_face", loads)
    if (models := computed.get(FACE_MODELS)) is not None:
        yield of_record("face_models", models)


def headlines(computed: Computed) -> Iterator[Headline]:
    """Face-load factor and maximum line load."""
    if (loads := _loads(computed)) is not None:
        yield from ranked(face_parts.headlines(loads), 1)


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """Flank maps, and other models beside them."""
    if (loads := _loads(computed)) is not None and computed.get(PAIR) is not None:
        yield face_parts.face(loads, computed.get(FACE_MODELS), results)


EVEN = "{}; nan where the load is even along the face"


def _of_face(name: str, figure: str, take: Take = float, said: str = EVEN, **held: Unpack[Held]) -> Named:
    """Figure of the line loads over the face."""

    def value(engine: Engine) -> Any:
        contact = engine[DRY_CYCLE].contact
        quantity = None if contact is None or contact.face is None else getattr(contact.face, figure)
        return None if quantity is None else take(quantity)

    def error(engine: Engine) -> float | None:
        contact = engine[DRY_CYCLE].contact
        face = None if contact is None else contact.face
        return None if face is None else uncertainty(face, figure).numerical

    known = take is float and holds_error(fem.FaceLoads, figure)
    about = figure_of_kind(fem.FaceLoads, figure)
    return output_of(name, about, "stiffness", value, said, error if known else None, **held)


def _by_model(name: str, about: Figure, value: Take, error: Take | None = None) -> Named:
    """Figure of the comparison with other models."""

    def of(take: Take) -> Of:
        return lambda engine: take(engine[FACE_MODELS]) if _across(engine.scene) else None

    return output_of(name, about, "stiffness", of(value), error=None if error is None else of(error))


def _of_model(model: str, figure: str = "pitch_point_factor") -> Take:
    """Figure by a model, the factor at the pitch point unless another one is asked for."""
    return lambda models: dict(zip(models.model, getattr(models, figure), strict=True))[model]


def _over_tolerance(name: str, about: Figure, figure: str, **held: Unpack[Held]) -> Named:
    """Figure of the face over the tolerance of the alignment."""

    def of(engine: Engine) -> Any:
        return getattr(engine[FACE_TOLERANCE], figure) if _across(engine.scene) else None

    return output_of(name, about, "stiffness", of, EVEN, **held)


STRAIGHT = "{}; nan where the load is even along the face, or shafts are rigid"


def _of_shafts() -> Iterator[Named]:
    """How far shafts give way under the face, and tilt, at most over the cycle."""
    for gear, name in enumerate(GEARS):

        def at_most(values: np.ndarray, gear: int = gear) -> float:
            return float(np.max(np.abs(values[gear])))

        for figure, error, what in (
            (
                "shaft_deflection",
                "shaft_error",
                "maximum deflection along the line of action of the shaft of the",
            ),
            ("shaft_misalignment", "tilt_error", "maximum misalignment over the face by the shaft of the"),
        ):
            meaning = f"{what} {name}; nan where the load is even"
            yield _of_face(f"{figure}_{name}", figure, at_most, meaning, error_output=error)
    yield _of_face(
        "mean_tilt_stiffness", "tilt_stiffness", np.mean, STRAIGHT, error_output="tilt_stiffness_error"
    )
    for figure in ("shaft_error", "tilt_error", "matrix_error"):
        yield _of_face("tilt_stiffness_error" if figure == "matrix_error" else figure, figure, said=STRAIGHT)


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    at_c = figures(coupling.FaceLoadModels)["pitch_point_factor"].meaning
    return (
        _of_face(
            "face_load_factor",
            "greatest_face_load_factor",
            error_output="face_load_factor_error",
            model_output="face_load_factor_model_error",
        ),
        _of_face(
            "greatest_line_load",
            "greatest_line_load",
            error_output="greatest_line_load_error",
            model_output="face_load_factor_model_error",
        ),
        _of_face(
            "face_pressure",
            "greatest_hertz_pressure",
            said="maximum Hertz pressure; nan where even",
        ),
        _of_face("contact_pattern", "contact_pattern"),
        _of_face("face_load_factor_error", "error"),
        _of_face("greatest_line_load_error", "line_load_error"),
        model_error_of(
            "face_load_factor_model_error",
            "face-load factor and maximum line load",
            "stiffness",
            lambda engine: getattr(engine[DRY_CYCLE].contact, "face", None),
            "greatest_face_load_factor",
        ),
        _over_tolerance(
            "robust_face_load_factor",
            figures(coupling.FaceTolerance)["robust_face_load_factor"],
            "robust_face_load_factor",
            error_output="robust_face_load_factor_error",
        ),
        _over_tolerance(
            "robust_face_load_factor_error",
            Figure("1", "estimated relative error of the maximum face-load factor over the tolerance"),
            "error",
        ),
        _by_model(
            "face_load_factor_at_C",
            Figure("1", f"{at_c}, nan where even"),
            lambda face_models: face_models.pitch_point_factor[0],
            lambda face_models: face_models.face_load_factor_error[0],
        ),
        _by_model(
            "slices_face_load_factor",
            Figure("1", f"{at_c} by independent slices, nan where even"),
            _of_model(LABELS["slices"]),
            _of_model(LABELS["slices"], "face_load_factor_error"),
        ),
        _by_model(
            "iso_face_load_factor",
            Figure("1", "face-load factor by ISO 6336-1, method C, nan where even", no_error=STANDARD),
            lambda face_models: face_models.pitch_point_factor[-1],
        ),
        *_of_shafts(),
    )


PRODUCT = Product(
    name="load over the face",
    goals=goals,
    variables=variables,
    tables={
        "face_load_dry": CurveTable(
            "dry_face",
            "line_load",
            ("travel", "face_position", "line_load", "hertz_pressure", "face_load_factor"),
        ),
        "shafts_under_face": CurveTable(
            "dry_face",
            "shaft_deflection",
            (
                "travel",
                "shaft_transmission_error",
                "tilt_transmission_error",
                "shaft_deflection",
                "shaft_misalignment",
                "moment_stiffness",
                "tilt_stiffness",
            ),
        ),
        "face_models": CurveTable("face_models", "line_load", ("face_position", "model", "line_load")),
    },
    headlines=headlines,
    pictures=face_parts.PICTURES,
    sections=sections,
    outputs=outputs,
)
