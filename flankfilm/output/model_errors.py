"""What the models behind figures leave open: one table, which every display asks.

An entry gives the model error of a figure from its record, with the page of the documentation where it was measured. A
figure without an entry, and a record for which an entry gives None, says "model not estimated". Errors are relative to
the figure, but for harmonics, whose errors are in their own unit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from flankfilm.output.line_model_errors import (
    deflection_of_lines,
    mean_of_lines,
    over_mean_of_lines,
    range_of_lines,
)

__all__ = ["MODEL_ERRORS", "ModelError", "entry", "first_harmonic"]

DISC, WEB = 0.021, 0.057
"""Deflection that three dimensions have beyond the plane with an even load: of a disc, of a thin rim on a web."""

FREE_ENDS = 0.002
"""The same with cells of the face and free ends: displacement along the loaded flank."""

NARROW = (1.0, 5.0, 10.0), (0.91, 0.58, 0.21)
"""Face widths in modules, and how far a disc is on the way from plane strain to plane stress; DISC is the last."""

TEETH = (18, 36, 120), (0.015, 0.005, 0.001)
"""Numbers of teeth, and what the inertia of the teeth, left out of the bodies, takes from the deflection of a mesh."""

FACTOR, FACTOR_UNCOUPLED = 0.005, 0.13
"""Face-load factor against three dimensions: with free ends; between walls, or of slices."""

ROOT, ROOT_WEB = 0.015, 0.13
"""Root stress against three dimensions: of a disc; of a thin rim on a web."""


@dataclass(frozen=True)
class ModelError:
    """Entry of the table.

    Attributes
    ----------
    of : callable
        Record to its model error; None where it is not estimated.
    source : str
        Page of the documentation, relative to its root.
    """

    of: Callable[[Any], float | None]
    source: str


def _solid(pair: Any) -> bool:
    return pair.pinion.blank is None and pair.wheel.blank is None


def _plane(contact: Any) -> float:
    """Part of the deflection that the plane leaves out of three dimensions."""
    pair, face = contact.pair, contact.face
    if face is not None and face.setting.model == "free-ends":
        return FREE_ENDS if _solid(pair) else WEB
    if not _solid(pair):
        return WEB
    if contact.plane == "strain" and pair.face_width >= NARROW[0][-1] * pair.module:
        return DISC
    poisson = max(material.poisson_ratio for material in pair.materials)
    way = 1.0  # narrower than any that was measured, or the other end
    if contact.plane == "strain" and pair.face_width >= NARROW[0][0] * pair.module:
        way = float(np.interp(np.log(pair.face_width / pair.module), np.log(NARROW[0]), NARROW[1]))
    return way * float(poisson**2 / (1.0 - poisson**2))


def _teeth(contact: Any) -> float:
    """Part of the deflection that the teeth's own inertia takes, of bodies that turn freely."""
    if contact.reference != "body":
        return 0.0
    pair = contact.pair
    numbers, parts = (np.log(column) for column in TEETH)
    slope = (parts[1] - parts[0]) / (numbers[1] - numbers[0])

    def of(teeth: int) -> float:
        at = np.log(teeth)
        part = parts[0] + slope * (at - numbers[0]) if at < numbers[0] else np.interp(at, numbers, parts)
        return float(np.exp(part))

    return of(pair.pinion.teeth) + of(pair.wheel.teeth)


def _contact(cycle: Any) -> Any:
    """Loaded contact of a mesh cycle by finite elements of coupled pairs; None of other models."""
    contact = getattr(cycle, "contact", cycle)
    return contact if hasattr(contact, "beyond_path") else None


def _stiffness(law: float) -> Callable[[Any], float | None]:
    """Of a mean stiffness, with so many times the error by the contacts' law."""

    def of(cycle: Any) -> float | None:
        contact = _contact(cycle)
        if contact is None:
            return None
        if contact.lines is not None:
            return mean_of_lines(contact, law) + _teeth(contact)
        return float(law * contact.model_error + _plane(contact) + _teeth(contact))

    return of


def _deflection(cycle: Any) -> float | None:
    """How far the contacts' law may move the transmission error at one position [m]."""
    contact = _contact(cycle)
    if contact is None:
        return None
    if contact.lines is not None:
        return 0.5 * deflection_of_lines(contact)
    return float(contact.model_error * abs(contact.force) / np.min(cycle.secant_stiffness))


def _range(cycle: Any) -> float | None:
    """Of the peak-to-peak transmission error: the law's part at one position, not at another; the plane's at all."""
    contact, whole = _contact(cycle), cycle.transmission_error_range
    if contact is not None and contact.lines is not None:
        return range_of_lines(contact, float(whole)) if whole else None
    moved = _deflection(cycle)
    return None if moved is None or not whole else moved / whole + _plane(_contact(cycle))


def _over_mean(law: float) -> Callable[[Any], float | None]:
    """Of harmonics of a stiffness over its mean: of the contacts' law alone, as the rest is in the mean too."""

    def of(cycle: Any) -> float | None:
        contact = _contact(cycle)
        if contact is not None and contact.lines is not None:
            return over_mean_of_lines(contact, law)
        return None if contact is None else law * contact.model_error

    return of


LAW = {"secant": 1.0, "tangent": 2.0}
"""The contacts' law changes the deflection by a part that grows with the load: the tangent by twice that part."""


def first_harmonic(series: Any) -> float | None:
    """Of the amplitudes of a series over its mean; None of a given one and of other models."""
    return None if series.cycle is None else _over_mean(LAW[series.kind])(series.cycle)


def _of_series(series: Any) -> float | None:
    return None if series.cycle is None else _stiffness(LAW[series.kind])(series.cycle)


def _half(motion: Any) -> float | None:
    error = _of_series(motion.series)
    return None if error is None else 0.5 * error


def _face(face: Any) -> float | None:
    if not _solid(face.pair):
        return None
    return FACTOR if face.setting.model == "free-ends" else FACTOR_UNCOUPLED


def _root(gear: Any) -> float | None:
    """Of the root stress of a gear; its contact decides that of a helical one, whose model error is not estimated."""
    if gear.helical:
        return None
    return ROOT_WEB if gear.webbed else ROOT


def _band(whole: str) -> Callable[[Any], float | None]:
    """What the band of the damping and the search leave of a peak beside its samples."""

    def of(swept: Any) -> float | None:
        error = getattr(swept, whole)
        return None if error is None or not np.isfinite(error) else max(error - swept.sampling_error, 0.0)

    return of


def _held(figure: str) -> Callable[[Any], float | None]:
    return lambda record: record.model_errors[figure]


_MESH = "validation/blanks.md"
_LOSSES = "validation/losses.md"
_FACE = "validation/face_width.md"

MODEL_ERRORS: Mapping[tuple[str, str], ModelError] = {
    **{
        ("MeshFigures", name): ModelError(_stiffness(LAW[law]), _MESH)
        for law, names in {
            "secant": ("mean_secant_stiffness", "least_secant_stiffness", "greatest_secant_stiffness"),
            "tangent": ("mean_stiffness", "least_stiffness", "greatest_stiffness"),
        }.items()
        for name in names
    },
    ("MeshFigures", "transmission_error_range"): ModelError(_range, "validation/local_law.md"),
    ("MeshFigures", "transmission_error_harmonics"): ModelError(_deflection, "validation/local_law.md"),
    ("MeshFigures", "secant_stiffness_harmonics"): ModelError(_over_mean(1.0), "validation/local_law.md"),
    ("MeshFigures", "stiffness_harmonics"): ModelError(_over_mean(2.0), "validation/moving_contact.md"),
    ("MeshSeries", "mean"): ModelError(_of_series, _MESH),
    ("PairOscillator", "mean_stiffness"): ModelError(lambda motion: _of_series(motion.series), _MESH),
    ("PairOscillator", "natural_frequency"): ModelError(_half, "validation/fem.md"),
    ("FaceLoads", "greatest_face_load_factor"): ModelError(_face, _FACE),
    ("FaceLoads", "greatest_line_load"): ModelError(_face, _FACE),
    **{
        ("GearRootStress", name): ModelError(_root, page)
        for name, page in (("greatest_tension_Pa", _FACE), ("greatest_compression_Pa", _FACE))
    },
    ("RootStress", "pinion_tension_Pa"): ModelError(lambda stress: _root(stress.pinion), _FACE),
    ("RootStress", "wheel_tension_Pa"): ModelError(lambda stress: _root(stress.wheel), _FACE),
    **{
        ("MeshLosses", name): ModelError(_held(name), _LOSSES)
        for name in ("mean_friction", "sliding_loss", "mesh_loss", "efficiency")
    },
    ("DriveSweep", "greatest_bearing_force"): ModelError(
        _band("greatest_bearing_error"), "theory/dynamics.md"
    ),
    ("DriveSweep", "greatest_shaft_torque"): ModelError(_band("greatest_shaft_error"), "theory/dynamics.md"),
}
"""Class of a record, or one that it is a kind of, and figure."""


def entry(record: object, name: str) -> ModelError | None:
    """Entry of a figure of a record; None where the table has none."""
    entries = (MODEL_ERRORS.get((kind.__name__, name)) for kind in type(record).__mro__)
    return next((candidate for candidate in entries if candidate is not None), None)
