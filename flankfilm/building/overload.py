"""Loads that no gear bears: stresses from closed forms of a line, far above the strength of any steel."""

from __future__ import annotations

import warnings

import gears
from base import RangeWarning
from flankfilm.building.pair import pinion_torque
from flankfilm.scene import Scene
from gears.pair.hertz import peak_pressure

PRESSURE = 8e9
"""Hertzian pressure [Pa]: twice what ISO 76 allows hardened bearing steel at rest."""

BENDING = 5e9
"""Bending stress of a tooth [Pa]: twice the tensile strength of the strongest steels for gears."""

BENDING_PER_LOAD = 2.0
"""Bending stress over tangential force per face width and module, one pair in contact: the Lewis form has 2 to 4."""


def warn_of_overload(scene: Scene, pair: gears.GearPair) -> None:
    """Warn of a torque under which no steel would last for a single mesh.

    Parameters
    ----------
    scene : Scene
        With an operating point.
    pair : gears.GearPair
    """
    if scene.operating is None:
        return
    torque = pinion_torque(scene)
    load = abs(float(pair.normal_force(torque))) / pair.face_width
    radius = float(pair.path_at(pair.points.C).radius[0])
    pressure = float(peak_pressure(load / pair.contact_ratio, radius, pair.reduced_modulus))
    bending = BENDING_PER_LOAD * load / pair.module / pair.contact_ratio
    if pressure <= PRESSURE and bending <= BENDING:
        return
    key = "pinion_torque_Nm" if scene.operating.power_kW is None else "power_kW"
    value = getattr(scene.operating, key)
    warnings.warn(
        f"operating.{key} = {value:g} loads the teeth far beyond the strength of any steel: about "
        f"{1e-9 * pressure:.2g} GPa contact pressure at the pitch point and {1e-9 * bending:.2g} GPa bending stress; "
        "check the unit of the torque, the module and the face width",
        RangeWarning,
        stacklevel=2,
    )
