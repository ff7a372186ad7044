"""Materials of gears by name, each with the sources of its constants and how far single melts and parts scatter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from gears.tooth.errors import GeometryError
from gears.tooth.material import STEEL, Material

_ISO = "E and nu: ISO 6336-2:2006, table of the elasticity factor"
_STEEL = (
    f"{_ISO}; density: EN 1991-1-1:2002, table A.4; expansion: within 5 % of EN 1993-1-1:2005, 3.2.6; conductivity and "
    "heat capacity: as commonly quoted of low-alloy gear steels, 41 to 50 W/(m K) and 460 to 480 J/(kg K)"
)
_DUCTILE = "EN 1563:2018, annex of further properties"
_NYLON = (
    "E: ISO 527, manufacturer's data of Zytel 103HSL at 23 degC; density, nu and expansion: manufacturer's data of "
    "the unfilled resin; conductivity and heat capacity: R. J. Crawford, Plastics Engineering, table 1.8"
)
_ACETAL = (
    "E, density and expansion: data sheet of Hostaform C 9021 (copolymer; ISO 527, ISO 1183, ISO 11359 at 23 degC); "
    "nu, conductivity and heat capacity: as commonly quoted"
)
_PEEK = (
    "E, density and expansion below the glass transition: manufacturer's data of Victrex PEEK 450G (ISO 527, ISO 1183, "
    "ISO 11359 at 23 degC); nu, conductivity and heat capacity: as commonly quoted"
)


@dataclass(frozen=True)
class NamedMaterial:
    """A material of the list.

    Parameters
    ----------
    material : Material
        Its constants at room temperature.
    source : str
        Where they stand.
    scatter : float
        By which the modulus of parts differs from it, relative.
    note : str
        What to bear in mind.
    """

    material: Material
    source: str
    scatter: float
    note: str = ""


_GRADES = ("16MnCr5", "20MnCr5", "18CrNiMo7-6", "42CrMo4", "34CrNiMo6", "31CrMoV9", "C45")
_ANY_STEEL = NamedMaterial(
    STEEL,
    _STEEL,
    0.03,
    "elastic constants of unalloyed and low-alloy steels do not depend on grade or hardening",
)

MATERIALS: Mapping[str, NamedMaterial] = MappingProxyType(
    {
        "steel": _ANY_STEEL,
        **{f"steel {grade}": _ANY_STEEL for grade in _GRADES},
        "cast steel": NamedMaterial(replace(STEEL, youngs_modulus=202e9), _STEEL, 0.03),
        "EN-GJS-400": NamedMaterial(Material(169e9, 0.275, 7100.0, 12.5e-6, 36.2, 515.0), _DUCTILE, 0.05),
        "EN-GJS-600": NamedMaterial(Material(174e9, 0.275, 7200.0, 12.5e-6, 32.5, 515.0), _DUCTILE, 0.05),
        "EN-GJS-700": NamedMaterial(Material(176e9, 0.275, 7200.0, 12.5e-6, 31.1, 515.0), _DUCTILE, 0.05),
        "EN-GJL-250": NamedMaterial(
            Material(110e9, 0.26, 7200.0, 11.7e-6, 48.5, 460.0),
            "EN 1561:2011, annex of further properties; E is the middle of 103 to 118 GPa",
            0.1,
            "the modulus falls with the stress",
        ),
        "PA66 dry": NamedMaterial(
            Material(3.1e9, 0.41, 1140.0, 100e-6, 0.24, 1700.0),
            _NYLON,
            0.1,
            "falls to a half at 60 degC; creeps",
        ),
        "PA66 conditioned": NamedMaterial(
            Material(1.4e9, 0.41, 1140.0, 100e-6, 0.24, 1700.0),
            _NYLON,
            0.3,
            "at 50 % relative humidity; softens with temperature; creeps",
        ),
        "POM": NamedMaterial(
            Material(2.85e9, 0.37, 1410.0, 110e-6, 0.31, 1470.0),
            _ACETAL,
            0.1,
            "softens with temperature; creep modulus 2.5 GPa after an hour, 1.3 GPa after 1000 hours at 23 degC",
        ),
        "PEEK": NamedMaterial(
            Material(4.0e9, 0.4, 1300.0, 55e-6, 0.29, 1100.0),
            _PEEK,
            0.1,
            "softens little up to the glass transition at 143 degC, much above it; creeps",
        ),
    }
)
"""Materials by name."""


def named_material(name: str) -> Material:
    """Material by its name in `MATERIALS`.

    Parameters
    ----------
    name : str

    Raises
    ------
    GeometryError
        For a name that is not in the list.

    Examples
    --------
    >>> named_material("steel 16MnCr5").youngs_modulus / 1e9
    206.0
    """
    if name not in MATERIALS:
        raise GeometryError.at(
            "name", repr(name), "must be a name of the list", f"such as {', '.join(MATERIALS)}"
        )
    return MATERIALS[name].material
