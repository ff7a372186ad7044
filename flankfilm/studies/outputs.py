"""What a study can ask of a row: one number each, from the stages that it needs and no others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.build import pinion_speed
from flankfilm.stages.catalogue import FILM, MESH, PAIR, ROOT_STRESS, VERIFICATION
from flankfilm.stages.engine import Engine

if TYPE_CHECKING:
    from flankfilm.coupling import MeshCycle


@dataclass(frozen=True)
class Output:
    """One number of a row.

    Attributes
    ----------
    unit, meaning : str
    wants : tuple of str
        The scene's wants that stand for it: they decide which sections a scene must have.
    value : callable
        Gives the number from a row's engine.
    """

    unit: str
    meaning: str
    wants: tuple[str, ...]
    value: Callable[[Engine], float]


def _stiffness(unit: str, meaning: str, value: Callable[[MeshCycle, float], Any]) -> Output:
    """Figure of the mesh cycle, with the film where the scene has one; the scale is to N/(mm um)."""

    def of(engine: Engine) -> float:
        return float(value(engine[MESH], 1e-9 / engine[PAIR].face_width))

    return Output(unit, meaning, ("stiffness",), of)


def _harmonic(order: int) -> Output:
    def share(cycle: MeshCycle, scale: float) -> float:
        return cycle.harmonic(order)

    return _stiffness("1", f"amplitude of harmonic {order} of the secant stiffness over its mean", share)


def _geometry(unit: str, meaning: str, value: Callable[[Any], Any]) -> Output:
    return Output(unit, meaning, ("geometry",), lambda engine: float(value(engine[PAIR])))


def _film(unit: str, meaning: str, value: Callable[[Any], Any]) -> Output:
    return Output(unit, meaning, ("film",), lambda engine: float(value(engine[FILM].film)))


def _difference(model: str, reference: str) -> Output:
    """Difference of a closed form's mean mesh stiffness from finite elements held to the path."""

    def of(engine: Engine) -> float:
        return 100.0 * engine[VERIFICATION].difference(model, reference)

    meaning = f"mean mesh stiffness by {model}, difference from finite elements {reference}"
    return Output("%", meaning, ("closed-forms",), of)


def _sliding(pair: Any) -> float:
    ends = pair.path_at(np.array([pair.points.A, pair.points.E]))
    return float(max(np.abs(part).max() for part in ends.specific_sliding))


def _sliding_speed(engine: Engine) -> float:
    pair = engine[PAIR]
    ends = pair.path_at(np.array([pair.points.A, pair.points.E]))
    return float(np.abs(ends.sliding(pinion_speed(engine.scene))).max())


def _at_point(point: str, name: str) -> Callable[[Engine], float]:
    """A curve along the path at A, B, C, D or E: of the nearest film, since curves step at B and D.

    B and D count as ends of the single-pair zone.
    """

    def of(engine: Engine) -> float:
        film, points = engine[FILM].film, engine[PAIR].points
        inside = {"B": 1e-6, "D": -1e-6}.get(point, 0.0)
        towards = film.rho1 - (getattr(points, point) + inside)
        nearest = np.abs(towards) if not inside else np.where(towards * inside > 0, np.abs(towards), np.inf)
        return float(getattr(film, name)[int(np.argmin(nearest))])

    return of


def _film_at(point: str, name: str, scale: float) -> Callable[[Engine], float]:
    of = _at_point(point, name)
    return lambda engine: scale * of(engine)


def _through(value: Callable[[Any], float | None]) -> Callable[[Engine], float]:
    """Figure of the pressure and film through the contact nearest to C; nan where it has none."""

    def of(engine: Engine) -> float:
        film = engine[FILM].film.profiles.get("C")
        found = None if film is None else value(film)
        return float("nan") if found is None else float(found)

    return of


def _spike(film: Any) -> Any:
    """Spike of a film that was solved for it; None where grids do not resolve it."""
    return film.spike if film.spike is not None and np.isfinite(film.spike.error) else None


def _mixed(name: str, worst: Callable[[Any], Any]) -> Callable[[Any], float]:
    def of(film: Any) -> float:
        values = getattr(film, name)
        return float("nan") if values is None else float(worst(values))

    return of


def _at_pitch_point(film: Any, pair: Any) -> float:
    return float(np.interp(pair.points.C, film.rho1, film.central_thickness))


def _root(meaning: str, peak: str, gear: str) -> Output:
    def of(engine: Engine) -> float:
        found = getattr(engine[ROOT_STRESS].stress, gear)
        return 1e-6 * float(getattr(found, peak).stress_Pa)

    return Output("MPa", f"{meaning} of the {gear}", ("root-stress",), of)


_FORMS = {
    "ishikawa": "Ishikawa",
    "weber_banaschek": "Weber-Banaschek",
    "potential_energy": "potential energy, Sainsot body",
    "iso6336": "ISO 6336-1",
}

_LIKE = "without hub wind-up and coupling"

OUTPUTS: Mapping[str, Output] = {
    "contact_ratio": _geometry("1", "transverse contact ratio", lambda pair: pair.contact_ratio),
    "axis_distance_mm": _geometry(
        "mm", "distance of the axes", lambda pair: 1e3 * pair.working_centre_distance
    ),
    "working_pressure_angle_deg": _geometry(
        "deg", "working pressure angle", lambda pair: np.degrees(pair.working_pressure_angle)
    ),
    "specific_sliding": _geometry("1", "largest specific sliding of both flanks, A to E", _sliding),
    "sliding_speed_m_per_s": Output("m/s", "largest sliding speed, A to E", ("geometry",), _sliding_speed),
    "mean_secant_N_per_mm_um": _stiffness(
        "N/(mm um)",
        "mean secant stiffness of the mesh",
        lambda cycle, scale: scale * cycle.mean_secant_stiffness,
    ),
    "mean_tangent_N_per_mm_um": _stiffness(
        "N/(mm um)", "mean tangent stiffness of the mesh", lambda cycle, scale: scale * cycle.mean_stiffness
    ),
    "least_secant_N_per_mm_um": _stiffness(
        "N/(mm um)",
        "least secant stiffness of the mesh",
        lambda cycle, scale: scale * cycle.secant_stiffness.min(),
    ),
    "largest_secant_N_per_mm_um": _stiffness(
        "N/(mm um)",
        "largest secant stiffness of the mesh",
        lambda cycle, scale: scale * cycle.secant_stiffness.max(),
    ),
    "transmission_error_um": _stiffness(
        "um",
        "loaded transmission error, peak to peak",
        lambda cycle, _: 1e6 * cycle.transmission_error_range,
    ),
    **{f"harmonic_{order}": _harmonic(order) for order in range(1, 6)},
    "stiffness_error": _stiffness(
        "1",
        "estimated relative numerical error of the mean secant stiffness; nan where unknown",
        lambda cycle, _: np.nan if cycle.mean_error is None else cycle.mean_error,
    ),
    **{
        f"root_{kind}_{gear}_MPa": _root(meaning, f"greatest_{kind}", gear)
        for gear in ("pinion", "wheel")
        for kind, meaning in (
            ("tension", "greatest tension along the fillets"),
            ("compression", "greatest compression along the fillets"),
        )
    },
    "efficiency": _stiffness(
        "1",
        "power out over power in, sliding of the dry contacts alone",
        lambda cycle, _: np.nan if cycle.contact is None else cycle.contact.efficiency,
    ),
    "least_film_um": _film("um", "least film along the path", lambda film: 1e6 * film.least_film),
    "least_central_film_um": _film(
        "um",
        "least film on the line of centres along the path",
        lambda film: 1e6 * film.central_thickness.min(),
    ),
    "film_at_C_um": Output(
        "um",
        "film on the line of centres at the pitch point",
        ("film",),
        lambda engine: 1e6 * _at_pitch_point(engine[FILM].film, engine[PAIR]),
    ),
    "hertz_pressure_GPa": _film(
        "GPa", "largest Hertz pressure along the path", lambda film: 1e-9 * film.greatest_pressure
    ),
    "film_change_percent": Output(
        "%",
        "what the film changes the mean secant stiffness by",
        ("film",),
        lambda engine: 100 * engine[FILM].secant_stiffness_change,
    ),
    **{
        f"{kind}_at_{point}_{unit}": Output(
            unit, f"{meaning} at {point}", ("film",), _film_at(point, name, scale)
        )
        for kind, name, unit, scale, meaning in (
            ("least_film", "minimum_thickness", "um", 1e6, "least film in the contact"),
            ("hertz_pressure", "hertz_pressure", "GPa", 1e-9, "Hertz pressure"),
        )
        for point in "ABCDE"
    },
    "spike_at_C_GPa": Output(
        "GPa",
        "pressure spike of the contact at C; nan where it is narrower than grids resolve",
        ("film",),
        _through(lambda film: None if _spike(film) is None else 1e-9 * _spike(film).pressure),
    ),
    "spike_over_hertz_at_C": Output(
        "1",
        "pressure spike of the contact at C over its Hertz pressure",
        ("film",),
        _through(
            lambda film: None if _spike(film) is None else _spike(film).pressure / film.contact.peak_pressure
        ),
    ),
    "spike_position_at_C": Output(
        "1",
        "place of the pressure spike at C, in half-widths after the middle",
        ("film",),
        _through(
            lambda film: None if _spike(film) is None else _spike(film).position / film.contact.half_width
        ),
    ),
    "neck_position_at_C": Output(
        "1",
        "place of the least film at C, in half-widths after the middle",
        ("film",),
        _through(lambda film: film.minimum_position / film.contact.half_width),
    ),
    "neck_depth_at_C": Output(
        "1",
        "least over central film of the contact at C",
        ("film",),
        _through(lambda film: film.minimum_thickness / film.central_thickness),
    ),
    "film_ratio": _film(
        "1", "least film ratio Lambda along the path; nan if smooth", _mixed("film_ratio", np.min)
    ),
    "asperity_share": _film(
        "1", "largest asperity share along the path; nan if smooth", _mixed("asperity_share", np.max)
    ),
    "starvation": _film(
        "1",
        "least central film over the flooded one along the path; nan if flooded",
        _mixed("starvation", np.min),
    ),
    "film_error": _film(
        "1",
        "largest estimated relative error of the films; nan where unknown",
        lambda film: np.nan if film.error is None else film.error,
    ),
    **{f"{name}_percent": _difference(label, "held to the path") for name, label in _FORMS.items()},
    **{f"{name}_like_for_like_percent": _difference(label, _LIKE) for name, label in _FORMS.items()},
}
"""Outputs by the name that a study file gives them; the unit is part of it."""
