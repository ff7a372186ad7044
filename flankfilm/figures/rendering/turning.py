"""The loaded pair over its mesh cycle as numbers for a page that turns it: surfaces, few digits, packed.

A page holds each tooth's surface once, and of every position where the teeth stand, their displacement, their stress
and the loads of the contacts. Values are whole numbers of steps; those of a tooth are differences from the position
before.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from base import Array
from flankfilm.figures.reading import need
from flankfilm.figures.rendering.animation import SHOWN
from flankfilm.figures.rendering.view import colour_steps, round_number, titled

if TYPE_CHECKING:
    import xarray as xr

    from fem.fields.surface_frames import ContactLoads, GearSurface, SurfaceFrame, Surfaces
    from fem.fields.tooth_surfaces import ToothSurface

__all__ = ["Turning", "turning"]

FINE, VALUES = 65535, 4095
"""Steps of places and loads over their range, and of displacements and stresses, which have as many digits in the
files for ParaView."""

LARGEST = 1_500_000
"""Characters of the packed numbers, above which every second position is left out."""

HALF_WIDTH = 0.35, 6.0
"""Half the width of the picture: parts of the face width, and modules."""

Steps = NDArray[np.uint16]


@dataclass(frozen=True)
class Turning:
    """What a page needs to draw the pair.

    Attributes
    ----------
    head : dict
        Sizes, ranges and words; lengths in metres.
    packed : str
        Numbers of the surfaces and positions, 16 bits each, low bytes before high bytes, compressed (deflate), in
        base 64.
    """

    head: dict[str, Any]
    packed: str


def turning(
    places: Sequence[float], frames: Sequence[SurfaceFrame], surfaces: Surfaces, results: xr.Dataset
) -> Turning:
    """Pack the surfaces of a run.

    Parameters
    ----------
    places : sequence of float
        Of the frames in base pitches from A.
    frames : sequence of SurfaceFrame
    surfaces : Surfaces
    results : xarray.Dataset
        Of the run, for its transmission error and the sizes of the pair.

    Returns
    -------
    Turning

    Raises
    ------
    base.InputError
        Results of a run without finite elements.
    """
    need(results, 'run a scene that wants "vtk" with this version', "path_point_place", "pair_module")
    step, shown = 1, _turning(places, frames, surfaces, results)
    while len(shown.packed) > LARGEST and 2 * step < len(frames):
        step *= 2
        shown = _turning(places[::step], frames[::step], surfaces, results)
    return shown


def _turning(
    places: Sequence[float], frames: Sequence[SurfaceFrame], surfaces: Surfaces, results: xr.Dataset
) -> Turning:
    """Pack all of these positions."""
    moved = max(_largest(gear.displacement) for frame in frames for gear in frame.gears)
    stresses = [gear.von_mises for frame in frames for gear in frame.gears if gear.von_mises is not None]
    stress = max(map(_largest, stresses), default=0.0)
    end = float(np.median([frame.fillet_stress for frame in frames])) if stresses else moved
    parts, gears = [], []
    for index, surface in enumerate(surfaces.teeth):
        head, numbers = _surface(surface)
        on_gear = [frame.gears[index] for frame in frames]
        gears.append(head | _standing(on_gear))
        parts += [*numbers, *_differences(on_gear, moved, stress)]
    loads, numbers = _loads([frame.contacts for frame in frames])
    head = {
        "module": float(results["pair_module"]),
        "width": surfaces.face_width,
        "at": [round(place, 6) for place in places],
        "centre": surfaces.wheel_centre.tolist(),
        "moved": moved,
        "stress": stress,
        "gears": gears,
        "loads": loads,
        **_words("von_mises_Pa" if stresses else "displacement_m", end),
        **_seen(results, places, surfaces.face_width),
    }
    return Turning(head, _packed([*parts, *numbers]))


def _surface(surface: ToothSurface) -> tuple[dict[str, Any], list[Steps]]:
    """Ranges and numbers of a tooth's surface."""
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    points = np.rint((surface.points - low) / (high - low) * FINE)
    head = {
        "low": low.tolist(),
        "high": high.tolist(),
        "points": len(points),
        "triangles": len(surface.triangles),
        "values": len(surface.places),
    }
    return head, [_whole(points), _whole(surface.triangles), _whole(surface.value)]


def _standing(frames: Sequence[GearSurface]) -> dict[str, Any]:
    """First tooth of each position, and the angles of its teeth [rad]."""
    angles = [np.round(frame.angles, 7).tolist() for frame in frames]
    return {"first": [frame.first for frame in frames], "angles": angles}


def _differences(frames: Sequence[GearSurface], moved: float, stress: float) -> list[Steps]:
    """Displacement and stress of each tooth of each position, less those of the same tooth at the one before."""
    before: dict[int, Steps] = {}
    differences = []
    for frame in frames:
        known = {}
        for i in range(len(frame.angles)):
            half = VALUES // 2
            values = [_whole(np.rint(frame.displacement[i] / (moved or 1.0) * half) + half).ravel()]
            if frame.von_mises is not None:
                values.append(_whole(np.rint(frame.von_mises[i] / (stress or 1.0) * VALUES)))
            known[frame.first + i] = own = np.concatenate(values)
            differences.append(own - before.get(frame.first + i, np.zeros_like(own)))
        before = known
    return differences


def _loads(contacts: Sequence[ContactLoads]) -> tuple[dict[str, Any], list[Steps]]:
    """Ranges and numbers of the loads: both ends of each piece, their displacement, and the load."""
    each = {
        name: np.concatenate([getattr(one, name).reshape(len(one.load), -1) for one in contacts])
        for name in ("ends", "moved", "load")
    }
    sizes = {name: _largest(values) for name, values in each.items()}
    half = FINE // 2
    numbers = [_whole(np.rint(values / (sizes[name] or 1.0) * half) + half) for name, values in each.items()]
    largest = float(np.linalg.norm(each["load"], axis=1).max(initial=0.0))
    return {"counts": [len(one.load) for one in contacts], "largest": largest, **sizes}, numbers


def _words(field: str, shown: float) -> dict[str, Any]:
    """Name, unit and factor of the field of the colours, and their end and ticks in that unit."""
    words, unit, factor = titled(field)
    step, ticks = colour_steps(factor * (shown or 1.0))
    return {
        "field": words,
        "unit": unit.strip(" []"),
        "factor": factor,
        "ticks": [round(step * tick, 9) for tick in range(ticks + 1)],
    }


def _seen(results: xr.Dataset, places: Sequence[float], width: float) -> dict[str, Any]:
    """Middle and size of the picture, factor of the displacements, and the angles that the pinion is ahead [rad]."""
    prefix = "lubricated" if "lubricated_position" in results else "dry"
    error = results[f"{prefix}_transmission_error"].values
    module = float(results["pair_module"])
    names = results["path_point"].values.tolist()
    ahead = np.interp(places, results[f"{prefix}_position"].values, error) / float(
        results["pair_base_radii"][0]
    )
    largest = float(error.max())
    return {
        "focus": results["path_point_place"].values[names.index("C")].tolist(),
        "reach": HALF_WIDTH[0] * width + HALF_WIDTH[1] * module,
        "scale": round_number(SHOWN * module / largest) if largest > 0.0 else 1.0,
        "ahead": [float(f"{angle:.6g}") for angle in ahead],
    }


def _largest(values: Array) -> float:
    """Largest size of values, 0 where there are none."""
    return float(np.max(np.abs(values), initial=0.0))


def _whole(values: NDArray[Any]) -> Steps:
    return values.astype(np.uint16)


def _packed(parts: Sequence[Steps]) -> str:
    """All numbers one after the other: low bytes, then high bytes, which are alike and pack well."""
    numbers = np.concatenate([part.ravel() for part in parts])
    halves = [(numbers & 0xFF).astype(np.uint8), (numbers >> 8).astype(np.uint8)]
    return base64.b64encode(zlib.compress(np.concatenate(halves).tobytes())).decode("ascii")
