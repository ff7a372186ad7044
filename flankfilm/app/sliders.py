"""Keys that are dragged: their ranges, and what else of the scene must be there for one to count."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from flankfilm.app.document import Document
from flankfilm.app.form import form_keys

__all__ = ["Slider", "beside", "sliders"]

STEPS = 200
"""Steps of a slider."""

RANGES: dict[str, tuple[str, float, float]] = {
    "operating.pinion_torque_Nm": ("torque", 0.0, 2.0),
    "pair.pinion.tip_relief.amount_um": ("tip relief, pinion", 0.0, 40.0),
    "pair.wheel.tip_relief.amount_um": ("tip relief, wheel", 0.0, 40.0),
    "pair.pinion.profile_shift": ("profile shift, pinion", -0.4, 0.8),
    "pair.wheel.profile_shift": ("profile shift, wheel", -0.4, 0.8),
    "pair.centre_distance_mm": ("centre distance", -0.1, 0.5),
    "pair.pinion.crowning_um": ("crowning, pinion", 0.0, 40.0),
    "alignment.in_plane_um": ("misalignment in the plane of action", -60.0, 60.0),
    "pair.helix_angle_deg": ("helix angle", -35.0, 35.0),
}
"""Key to its name, and the ends of its slider: of the torque times that of the scene, of the distance in modules."""

TORQUE, DISTANCE = "operating.pinion_torque_Nm", "pair.centre_distance_mm"

FILM_SLOPE = "film.stiffness"

ALONG_FACE = ("crowning_um", "in_plane_um")
"""Names of keys by which the load varies along the face."""

USUAL = {TORQUE: 100.0, DISTANCE: 0.0}
"""Where a slider stands whose key the scene leaves out; 0 elsewhere."""


@dataclass(frozen=True)
class Slider:
    """A key that is dragged.

    Attributes
    ----------
    path, label, unit : str
    low, high, step : float
        In the key's unit.
    value : float
        Where it stands.
    """

    path: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    value: float


def sliders(document: Document, centre_distance: float | None) -> tuple[Slider, ...]:
    """Sliders of a scene with a pair; none without one.

    Parameters
    ----------
    document : Document
        As it was opened: ranges do not move under a drag.
    centre_distance : float or None
        Of the pair [mm]; None without faultless gears.

    Examples
    --------
    >>> from flankfilm.scene import template
    >>> torque = sliders(Document(template()), 76.0)[0]
    >>> torque.low, torque.high, torque.step, torque.value
    (0.0, 1200.0, 5.0, 600.0)
    """
    return tuple(_sliders(document, centre_distance)) if "pair" in document.raw else ()


def _sliders(document: Document, centre_distance: float | None) -> Iterator[Slider]:
    module = _number(document.shown("pair.module_mm"), 1.0)
    for path, (label, low, high) in RANGES.items():
        value = _number(document.shown(path), USUAL.get(path, 0.0))
        if path == TORQUE:
            if "operating" not in document.raw:
                continue
            low, high = min(low, high * value), max(low, high * value) or 100.0
        elif path == DISTANCE:
            if centre_distance is None:
                continue
            value = _number(document.shown(path), centre_distance)
            low, high = value + low * module, value + high * module
        unit = form_keys()[path].unit
        step = _round(max(high - low, 1e-9) / STEPS)
        low, high = step * math.floor(min(low, value) / step), step * math.ceil(max(high, value) / step)
        yield Slider(path, label, unit, _plain(low), _plain(high), step, value)


def beside(document: Document, path: str) -> dict[str, str]:
    """What else must be typed with a dragged key: a length for a relief, no backlash beside a centre distance.

    Films of cells along the face have slopes of their load: what the scene says of those of even loads goes.

    Parameters
    ----------
    document : Document
    path : str
        The key that is dragged.

    Examples
    --------
    >>> from flankfilm.scene import template
    >>> beside(Document(template()), "pair.centre_distance_mm")
    {'pair.backlash_um': ''}
    """
    if path == DISTANCE:
        return {"pair.backlash_um": ""} if document.shown("pair.backlash_um") else {}
    if form_keys()[path].name in ALONG_FACE:
        return {FILM_SLOPE: ""} if document.shown(FILM_SLOPE) else {}
    length = path.replace("amount_um", "length_mm")
    if path.endswith("tip_relief.amount_um") and not document.shown(length):
        return {length: f"{_number(document.shown('pair.module_mm'), 1.0):.3g}"}
    return {}


def _number(text: str, otherwise: float) -> float:
    try:
        value = float(text)
    except ValueError:
        return otherwise
    return value if math.isfinite(value) else otherwise


def _round(step: float) -> float:
    """The nearest of 1, 2 and 5 times a power of ten that is no larger."""
    power = 10.0 ** math.floor(math.log10(step))
    return _plain(max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= step * (1.0 + 1e-9)))


def _plain(value: float) -> float:
    """Number without the digits that rounding adds."""
    return float(f"{value:.10g}")
