"""Traction curves of a scene's oil, and their tables: a row for each slide-roll ratio."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from base import InputError
from flankfilm.output.files import write_csv
from flankfilm.output.tables import columns
from flankfilm.output.variables import of_record

if TYPE_CHECKING:
    from ehl import TractionCurve
    from flankfilm.scene import Scene

COLUMNS = (
    "slide_roll",
    "traction_coefficient",
    "traction_error",
    "central_thickness",
    "minimum_thickness",
    "film_error",
    "oil_temperature_rise",
    "surface_temperature_rise",
    "temperature_error",
    "hertz_pressure",
    "entrainment",
    "temperature",
)


def traction_of(
    scene: Scene,
    ratios: Sequence[float],
    pressure: float | None = None,
    entrainment: float | None = None,
    temperature: float | None = None,
    *,
    tolerance: float = 0.01,
) -> TractionCurve:
    """Friction of a scene's oil over slide-roll ratios [-], on discs of the radius and modulus of its pair at C.

    An oil without Eyring's stress has the usual one, 5 MPa, as in the losses of a mesh.

    Parameters
    ----------
    scene : Scene
        With pair, material, operating point and oil.
    ratios : sequence of float
        (u1 - u2)/u.
    pressure, entrainment, temperature : float, optional
        Hertz pressure [Pa], mean speed [m/s] and bulk temperature [K]; those at C and of the oil unless given.
    tolerance : float
        Relative, of films and friction.
    """
    import ehl
    from flankfilm.building.heat import shearing_oil
    from flankfilm.building.pair import gear_pair
    from flankfilm.scene.needs_of_helix import refuse_helix
    from flankfilm.scene.sections.section import required
    from gears.pair.hertz import peak_pressure

    for name in ("pair", "material"):
        required(getattr(scene, name), f"[{name}]", "a traction curve")
    running = required(scene.operating, "[operating]", "a traction curve")
    required(scene.lubricant, "[lubricant]", "a traction curve")
    refuse_helix(scene, "a traction curve of its contacts")
    pair, oil = gear_pair(scene), shearing_oil(scene)
    at_pitch = pair.path_at(pair.points.C)
    radius = at_pitch.radius.item()
    if pressure is None:
        torque = required(
            running.value("pinion_torque_Nm"), "operating.pinion_torque_Nm", "the pressure at C"
        )
        load = pair.normal_force(torque) / pair.face_width
        pressure = float(peak_pressure(load, radius, pair.reduced_modulus))
    if entrainment is None:
        speed = required(running.value("pinion_speed_rpm"), "operating.pinion_speed_rpm", "the speed at C")
        entrainment = at_pitch.entrainment(speed).item()
    return ehl.traction_curve(
        oil,
        pressure,
        entrainment,
        ratios,
        radius=radius,
        reduced_modulus=pair.reduced_modulus,
        temperature=temperature,
        tolerance=tolerance,
    )


def write_traction(path: Path, curve: TractionCurve) -> None:
    """Write a traction curve as CSV, units in the names of the columns, constants in every row.

    Raises
    ------
    InputError
        Where the name ends otherwise.
    """
    if path.suffix != ".csv":
        raise InputError.at("--out", str(path), "must end in .csv")
    write_csv(path, columns(of_record("point", curve), "point", COLUMNS))
