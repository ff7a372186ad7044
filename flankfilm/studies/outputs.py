"""What a study can ask of a row: one number each, from the stages that it needs and no others.

An output is a figure of a stage's result, or its minimum, maximum or mean value; unit and meaning are the figure's own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import product
from operator import attrgetter, methodcaller
from typing import Any

import numpy as np

import gears
from base import Figure
from base.results import figures
from ehl.discrete.regimes import NUMBERS, regime_number
from flankfilm.building.pair import pinion_speed, pinion_torque
from flankfilm.coupling.films.along_path import FilmAlongPath
from flankfilm.coupling.films.lubricated_record import LubricatedCycle
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.single_pairs import CLOSED_FORMS
from flankfilm.coupling.mesh.verification import Verification
from flankfilm.figures.reading import PER_FACE
from flankfilm.output.drawing_data import SLIDING
from flankfilm.output.variables import sentence
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FILM, HEAT, MESH, PAIR, ROOT_STRESS, VERIFICATION
from flankfilm.studies.face_outputs import FACE_OUTPUTS
from flankfilm.studies.held_errors import HELD
from flankfilm.studies.loss_outputs import LOSS_OUTPUTS
from flankfilm.studies.motion_outputs import MOTION_OUTPUTS
from flankfilm.studies.output import (
    Named,
    Of,
    Output,
    Take,
    error_in,
    in_result,
    model_error_of,
    output_of,
    outputs_from,
    with_errors,
)
from gears import GearPair, WarmPair

OLDER = "older name, kept for one version, of"

UNRESOLVED = "nan where it is narrower than grids resolve"


def _per_face(figure: str, take: Take = float, name: str = "", said: str = "{}") -> Named:
    """Stiffness of the mesh per face width, with the film where the scene has one."""
    about = Figure("N/m", figures(MeshCycle)[figure].meaning, shown=PER_FACE)
    return output_of(
        name or figure,
        about,
        "stiffness",
        lambda engine: take(getattr(engine[MESH], figure)) / engine[PAIR].face_width,
        said,
        error_in(lambda engine: engine[MESH], figure),
    )


_pair = outputs_from(lambda engine: engine[PAIR], GearPair, "geometry")
_heat = outputs_from(lambda engine: engine[HEAT], WarmPair, "geometry")
_mesh = outputs_from(lambda engine: engine[MESH], MeshCycle, "stiffness")
_film = outputs_from(lambda engine: engine[FILM].film, FilmAlongPath, "film")
_lubricated = outputs_from(lambda engine: engine[FILM], LubricatedCycle, "film")


def _ends(engine: Engine) -> Any:
    """Path of contact at A and E."""
    points = engine[PAIR].points
    return engine[PAIR].path_at(np.array([points.A, points.E]))


def _at_point(point: str, figure: str) -> Take:
    """A curve along the path at A, B, C, D or E: of the nearest film, since curves step at B and D.

    B and D count as ends of the single-pair zone.
    """

    def of(engine: Engine) -> float:
        film, points = engine[FILM].film, engine[PAIR].points
        inside = {"B": 1e-6, "D": -1e-6}.get(point, 0.0)
        towards = film.rho1 - (getattr(points, point) + inside)
        nearest = np.abs(towards) if not inside else np.where(towards * inside > 0, np.abs(towards), np.inf)
        return float(getattr(film, figure)[int(np.argmin(nearest))])

    return of


def _at_points() -> Iterator[Named]:
    """Film and pressure at the points of the path."""
    for name, figure in (("least_film", "minimum_thickness"), ("hertz_pressure", "hertz_pressure")):
        about = figures(FilmAlongPath)[figure]
        for point in "ABCDE":
            yield output_of(f"{name}_at_{point}", about, "film", _at_point(point, figure), f"{{}} at {point}")


def _through(name: str, figure: Figure, value: Take, error: Take | None = None) -> Named:
    """Figure of the pressure and film through the contact nearest to C; nan where it has none."""

    def at_c(take: Take) -> Of:
        def of(engine: Engine) -> Any:
            film = engine[FILM].film.profiles.get("C")
            return None if film is None else take(film)

        return of

    return output_of(
        f"{name}_at_C", figure, "film", at_c(value), error=None if error is None else at_c(error)
    )


def _of_spike(value: Callable[[Any, Any], float]) -> Take:
    """Figure of the spike of a film that was solved for it; None where grids do not resolve it."""

    def of(film: Any) -> float | None:
        known = film.spike is not None and np.isfinite(film.spike.error)
        return value(film.spike, film.contact) if known else None

    return of


def _regime(cycle: LubricatedCycle) -> float | None:
    """Regime of the minimum film; None for smooth flanks."""
    ratio = cycle.film.least_film_ratio
    return None if ratio is None else regime_number(ratio)


def _roots() -> Iterator[Named]:
    """Maximum stresses along the fillets."""
    for gear, kind in product(("pinion", "wheel"), ("tension", "compression")):
        meaning = f"maximum {kind} along the fillets of the {gear}"
        about = Figure("Pa", meaning, shown="MPa")
        stress = attrgetter(f"stress.{gear}.greatest_{kind}.stress_Pa")
        yield output_of(f"root_{kind}_{gear}", about, "root-stress", in_result(ROOT_STRESS, stress))


def _differences() -> Iterator[Named]:
    """Differences of the closed forms' mean mesh stiffness from finite elements held to the path."""
    forms = {**{key.replace("-", "_"): label for key, label in CLOSED_FORMS.items()}, "iso6336": "ISO 6336-1"}
    ends = {"": "held to the path", "_like_for_like": "without hub wind-up and coupling"}
    for (end, reference), (name, model) in product(ends.items(), forms.items()):
        meaning = f"mean mesh stiffness by {model}, difference from finite elements {reference}"
        value = in_result(VERIFICATION, methodcaller("difference", model, reference))
        error = in_result(VERIFICATION, partial(_of_difference, model, reference))
        yield output_of(f"{name}{end}", Figure("1", meaning, shown="%"), "closed-forms", value, error=error)


def _of_difference(model: str, reference: str, verification: Verification) -> float | None:
    """Error of a difference from finite elements relative to itself, by theirs."""
    compared = verification.comparison(model, reference)
    away = compared.difference
    return None if away == 0.0 else (1.0 + away) * compared.reference_error / abs(away)


def _harmonic(order: int) -> Named:
    about = Figure("1", f"amplitude of harmonic {order} of the secant stiffness over its mean")
    return output_of(
        f"harmonic_{order}",
        about,
        "stiffness",
        in_result(MESH, lambda cycle: cycle.secant_stiffness_harmonics[order - 1]),
        error=_of_harmonic("secant_stiffness", order),
    )


def _tangent_harmonic(order: int) -> Named:
    about = Figure("1", f"amplitude of harmonic {order} of the tangent stiffness over its mean")
    value = in_result(MESH, lambda cycle: cycle.stiffness_harmonics[order - 1])
    return output_of(
        f"tangent_harmonic_{order}", about, "stiffness", value, error=_of_harmonic("stiffness", order)
    )


def _of_harmonic(curve: str, order: int) -> Of:
    """Error of a harmonic relative to itself; the cycle holds those of ratios to the mean."""

    def error(cycle: MeshCycle) -> float | None:
        errors, values = (getattr(cycle, f"{curve}_{name}") for name in ("harmonics_error", "harmonics"))
        return None if errors is None or values[order - 1] == 0.0 else errors[order - 1] / values[order - 1]

    return in_result(MESH, error)


def _error_of(figure: str, name: str) -> Named:
    about = Figure("1", f"estimated relative error: {sentence(figures(MeshCycle)[figure].meaning)}")
    return output_of(name, about, "stiffness", in_result(MESH, lambda cycle: cycle.errors[figure]))


def _harmonics_error(curve: str, name: str) -> Named:
    about = Figure(
        "1", f"largest estimated error of the harmonics 1 to 5 of the {name} stiffness over its mean"
    )

    def largest(cycle: MeshCycle) -> Any:
        errors = getattr(cycle, f"{curve}_harmonics_error")
        return None if errors is None else np.max(errors[:5])

    return output_of(f"{name}_harmonics_error", about, "stiffness", in_result(MESH, largest))


_OUTPUTS: Mapping[str, Output] = dict(
    (
        _pair("contact_ratio"),
        _heat("cold_backlash"),
        _heat("base_pitch_difference"),
        _pair("working_centre_distance", name="centre_distance"),
        _pair("working_pressure_angle"),
        output_of(
            "specific_sliding",
            Figure("1", "largest specific sliding of both flanks, A to E"),
            "geometry",
            lambda engine: max(np.abs(part).max() for part in _ends(engine).specific_sliding),
        ),
        output_of(
            "sliding_speed",
            SLIDING,
            "geometry",
            lambda engine: np.abs(_ends(engine).sliding(pinion_speed(engine.scene))).max(),
            "largest {}, A to E",
        ),
        _per_face("mean_secant_stiffness"),
        _per_face("mean_stiffness", name="mean_tangent_stiffness"),
        _per_face("mean_stiffness", said=f"{{}}; {OLDER} mean_tangent_stiffness_N_per_mm_um"),
        _per_face("least_secant_stiffness"),
        _per_face("greatest_secant_stiffness", name="largest_secant_stiffness"),
        _mesh("transmission_error_range", name="transmission_error"),
        *(_harmonic(order) for order in range(1, 6)),
        *(_tangent_harmonic(order) for order in range(1, 6)),
        _mesh("mean_error", name="stiffness_error"),
        _error_of("mean_stiffness", "tangent_stiffness_error"),
        _mesh("range_error", name="transmission_error_error"),
        _harmonics_error("secant_stiffness", "secant"),
        _harmonics_error("stiffness", "tangent"),
        *_roots(),
        output_of(
            "root_stress_error",
            Figure("1", "largest estimated relative error of the stresses along the fillets"),
            "root-stress",
            in_result(ROOT_STRESS, attrgetter("stress.error")),
        ),
        output_of(
            "iso_contact_stress",
            Figure("Pa", "nominal contact stress sigma_H0 by ISO 6336-2", shown="MPa"),
            "closed-forms",
            lambda engine: gears.closed_form.iso6336_2(
                engine[PAIR], abs(engine[PAIR].normal_force(pinion_torque(engine.scene)))
            ).stresses[0],
        ),
        output_of(
            "efficiency",
            Figure("1", "power out over power in"),
            "stiffness",
            in_result(MESH, lambda cycle: getattr(cycle.contact, "efficiency", None)),
            "{}, sliding of the dry contacts alone",
        ),
        _film("least_film"),
        _film("central_thickness", np.min, "least_central_film", "minimum {} along the path"),
        output_of(
            "film_at_C",
            figures(FilmAlongPath)["central_thickness"],
            "film",
            lambda engine: np.interp(
                engine[PAIR].points.C, engine[FILM].film.rho1, engine[FILM].film.central_thickness
            ),
            "{} at the pitch point",
        ),
        _film("greatest_pressure", name="hertz_pressure"),
        _lubricated("secant_stiffness_change", name="film_change"),
        *_at_points(),
        _through(
            "spike",
            Figure(
                "Pa",
                f"pressure spike of the contact at C; {UNRESOLVED}",
                shown="GPa",
            ),
            _of_spike(lambda spike, contact: spike.pressure),
            _of_spike(lambda spike, contact: spike.error),
        ),
        _through(
            "spike_over_hertz",
            Figure("1", f"pressure spike of the contact at C over its Hertz pressure; {UNRESOLVED}"),
            _of_spike(lambda spike, contact: spike.pressure / contact.peak_pressure),
            _of_spike(lambda spike, contact: spike.error),
        ),
        _through(
            "spike_position",
            Figure("1", f"place of the pressure spike at C, in half-widths after the middle; {UNRESOLVED}"),
            _of_spike(lambda spike, contact: spike.position / contact.half_width),
        ),
        _through(
            "neck_position",
            Figure("1", "place of the minimum film at C, in half-widths after the middle"),
            lambda film: film.minimum_position / film.contact.half_width,
        ),
        _through(
            "neck_depth",
            Figure("1", "minimum over central film of the contact at C"),
            lambda film: film.minimum_thickness / film.central_thickness,
        ),
        _film("least_film_ratio", name="film_ratio", said="{}; nan if smooth"),
        output_of(
            "regime",
            Figure("1", f"regime at the minimum film ratio: {NUMBERS}; nan if smooth"),
            "film",
            in_result(FILM, _regime),
        ),
        _film("asperity_share", np.max, said="largest {} along the path; nan if smooth"),
        _film("starvation", np.min, said="minimum {} along the path; nan if flooded"),
        output_of(
            "least_film_error",
            Figure("1", "estimated relative error of the minimum film and film ratio; nan where unknown"),
            "film",
            in_result(FILM, attrgetter("film.least_film_error")),
        ),
        *(
            model_error_of(f"{name}_model_error", said, "stiffness", lambda engine: engine[MESH], figure)
            for name, said, figure in (
                ("stiffness", "the mean secant stiffness", "mean_secant_stiffness"),
                ("tangent_stiffness", "the mean tangent stiffness", "mean_stiffness"),
                ("transmission_error", "the peak-to-peak transmission error", "transmission_error_range"),
            )
        ),
        *(
            model_error_of(
                f"root_stress_model_error_{gear}",
                f"the stresses along the fillets of the {gear}",
                "root-stress",
                lambda engine: engine[ROOT_STRESS].stress,
                f"{gear}_tension_Pa",
            )
            for gear in ("pinion", "wheel")
        ),
        output_of(
            "film_error",
            Figure("1", "largest estimated relative error of the films; nan where unknown"),
            "film",
            in_result(FILM, attrgetter("film.error")),
        ),
        *FACE_OUTPUTS,
        *LOSS_OUTPUTS,
        *_differences(),
        *MOTION_OUTPUTS,
    )
)

OUTPUTS: Mapping[str, Output] = with_errors(_OUTPUTS, (name for names in HELD.values() for name in names))
"""Outputs by the name that a study file gives them; the unit is part of it."""
