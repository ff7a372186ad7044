"""What a study can ask of a row whose load varies along the face; nan where it is even."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np

import fem
from base import Figure
from base.results import figures
from fem.stress.root_peaks import RootPeak
from flankfilm.building.face import varies_by
from flankfilm.coupling.mesh.face_models import LABELS, FaceLoadModels
from flankfilm.coupling.mesh.face_tolerance import FaceTolerance
from flankfilm.coupling.mesh.root_stress import RootStresses
from flankfilm.figures.reading import GEARS
from flankfilm.output.uncertainty import uncertainty
from flankfilm.stages.engine import Engine
from flankfilm.stages.face import FACE_MODELS, FACE_TOLERANCE
from flankfilm.stages.mesh import DRY_CYCLE, ROOT_STRESS
from flankfilm.studies.output import Named, Of, Take, holds_error, model_error_of, output_of
from gears.closed_form import Iso6336FaceLoad

EVEN = "{}; nan where the load is even along the face"


def _of_face(name: str, figure: str, take: Take = float, said: str = EVEN) -> Named:
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
    about = figures(fem.FaceLoads)[figure]
    return output_of(name, about, "stiffness", value, said, error if known else None)


def _by_model(name: str, about: Figure, value: Take) -> Named:
    """Figure of the comparison with other models."""

    def of(engine: Engine) -> Any:
        return value(engine[FACE_MODELS]) if varies_by(engine.scene) else None

    return output_of(name, about, "stiffness", of)


def _factor_of(model: str) -> Take:
    """Factor at the pitch point by a model."""
    return lambda models: dict(zip(models.model, models.pitch_point_factor, strict=True))[model]


def _over_tolerance(name: str, about: Figure, figure: str) -> Named:
    """Figure of the face over the tolerance of the alignment."""

    def of(engine: Engine) -> Any:
        return getattr(engine[FACE_TOLERANCE], figure) if varies_by(engine.scene) else None

    return output_of(name, about, "stiffness", of, EVEN)


def _of_root(name: str, about: Figure, value: Take, said: str = EVEN, error: Take | None = None) -> Named:
    """Figure of the root stress over the face."""

    def over_face(take: Take) -> Of:
        return lambda engine: take(engine[ROOT_STRESS]) if varies_by(engine.scene) else None

    known = None if error is None else over_face(error)
    return output_of(name, about, "root-stress", over_face(value), said, known)


def _of_roots() -> Iterator[Named]:
    """Place of the maximum tension along the face, and the stress face-load factor, of both gears."""
    for gear in GEARS:
        yield _of_root(
            f"root_face_position_{gear}",
            figures(RootPeak)["face_position"],
            attrgetter(f"stress.{gear}.greatest_tension.face_position"),
            f"place along the face of the maximum tension at the root of the {gear}; nan where even",
        )
        yield _of_root(
            f"root_face_factor_{gear}",
            figures(fem.FaceRootStress)["face_factor"],
            attrgetter(f"stress.{gear}.face.face_factor"),
            f"maximum tension at the root of the {gear} over its mean over the face; nan where even",
            partial(_error_of_face, gear, "face_factor"),
        )
        yield _of_root(
            f"root_over_even_{gear}",
            figures(fem.FaceRootStress)["over_even"],
            attrgetter(f"stress.{gear}.face.over_even"),
            f"maximum tension at the root of the {gear} over that of the same forces spread evenly; nan where even",
            partial(_error_of_face, gear, "over_even"),
        )
    about = figures(Iso6336FaceLoad)["K_Fbeta"]
    yield _of_root(
        "iso_root_face_factor",
        about,
        lambda root_stress: root_stress.iso_face and root_stress.iso_face.K_Fbeta,
    )


def _error_of_face(gear: str, figure: str, roots: RootStresses) -> float | None:
    """Error of a figure of the root stress over the face of a gear."""
    return uncertainty(getattr(roots.stress, gear).face, figure).numerical


STRAIGHT = "{}; nan where the load is even along the face, or shafts are rigid"


def _of_shafts() -> Iterator[Named]:
    """How far shafts give way under the face, and tilt, at most over the cycle."""
    for gear, name in enumerate(GEARS):

        def at_most(values: np.ndarray, gear: int = gear) -> float:
            return float(np.max(np.abs(values[gear])))

        for figure, what in (
            ("shaft_deflection", "maximum deflection along the line of action of the shaft of the"),
            ("shaft_misalignment", "maximum misalignment over the face by the shaft of the"),
        ):
            yield _of_face(f"{figure}_{name}", figure, at_most, f"{what} {name}; nan where the load is even")
    yield _of_face("mean_tilt_stiffness", "tilt_stiffness", np.mean, STRAIGHT)
    for figure in ("shaft_error", "tilt_error", "matrix_error"):
        yield _of_face("tilt_stiffness_error" if figure == "matrix_error" else figure, figure, said=STRAIGHT)


_AT_C = figures(FaceLoadModels)["pitch_point_factor"].meaning

FACE_OUTPUTS: tuple[Named, ...] = (
    _of_face("face_load_factor", "greatest_face_load_factor"),
    _of_face("greatest_line_load", "greatest_line_load"),
    _of_face(
        "face_pressure",
        "hertz_pressure",
        np.nanmax,
        "maximum Hertz pressure; nan where even",
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
        figures(FaceTolerance)["robust_face_load_factor"],
        "robust_face_load_factor",
    ),
    _over_tolerance(
        "robust_face_load_factor_error",
        Figure("1", "estimated relative error of the maximum face-load factor over the tolerance"),
        "error",
    ),
    _by_model(
        "face_load_factor_at_C",
        Figure("1", f"{_AT_C}, nan where even"),
        lambda face_models: face_models.pitch_point_factor[0],
    ),
    _by_model(
        "slices_face_load_factor",
        Figure("1", f"{_AT_C} by independent slices, nan where even"),
        _factor_of(LABELS["slices"]),
    ),
    _by_model(
        "iso_face_load_factor",
        Figure("1", "face-load factor by ISO 6336-1, method C, nan where even"),
        lambda face_models: face_models.pitch_point_factor[-1],
    ),
    *_of_roots(),
    *_of_shafts(),
)
"""Outputs by name."""
