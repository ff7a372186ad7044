"""Steels of gears as ISO 6336 classes them, with the strengths that it rates them by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from base import Faults, Limit
from gears.pair.gear_pair import GearPair

KINDS: Mapping[str, str] = MappingProxyType(
    {
        "St": "wrought normalized low carbon steel",
        "V": "through-hardened wrought steel",
        "Eh": "case-hardened wrought steel",
        "IF": "flame or induction hardened wrought steel",
        "NT": "nitriding steel, nitrided",
        "NV nitr": "through-hardening or case-hardening steel, nitrided",
        "NV nitrocar": "through-hardening or case-hardening steel, nitrocarburized",
    }
)
"""Steels of ISO 6336-5 by their symbols."""

UNHARDENED = ("St", "V")
"""Steels without a hardened layer, which run in by their strength."""

NITRIDED = ("NT", "NV nitr", "NV nitrocar")
"""Steels that nitrogen hardens."""

_STRENGTH = Limit(100e6, 3e9, "Pa", "give the strength in pascals, 1500e6 of case-hardened flanks")
LIMITS = {
    "contact_strength": _STRENGTH,
    "bending_strength": Limit(50e6, 2e9, "Pa", "give the strength in pascals, 430e6 of case-hardened roots"),
    "proof_stress": Limit(200e6, 1200e6, "Pa", "give the yield strength or 0.2 % proof stress in pascals"),
}
"""What strengths may be."""
_STIFF = (190e9, 220e9)


@dataclass(frozen=True)
class RatedSteel:
    """Steel of one gear with its allowable stress numbers.

    The strengths are given: ISO 6336-5 has them over hardness and quality (ML, MQ, ME), which no source confirms here.

    Parameters
    ----------
    kind : str
        Class of the steel, a symbol in `KINDS`.
    contact_strength : float
        sigma_Hlim, allowable stress number for contact [Pa].
    bending_strength : float
        sigma_Flim, nominal stress number for bending of the standard test gear [Pa].
    proof_stress : float or None
        Yield strength of St, 0.2 % proof stress of V [Pa]: only the notch sensitivity of these two needs it.

    Examples
    --------
    >>> RatedSteel("Eh", contact_strength=1500e6, bending_strength=430e6).hardened
    True
    """

    kind: str
    contact_strength: float  # sigma_Hlim, Pa
    bending_strength: float  # sigma_Flim, Pa
    proof_stress: float | None = None  # sigma_S or sigma_0.2, Pa

    @property
    def hardened(self) -> bool:
        """Whether the steel has a hardened layer."""
        return self.kind not in UNHARDENED


Steels = tuple[RatedSteel, RatedSteel]
"""Steels of pinion and wheel."""


def check_steels(faults: Faults, pair: GearPair, steels: Steels) -> None:
    """Note what is wrong with the steels of a pair: no such kind, no strength, gears that are not of steel.

    Parameters
    ----------
    faults : Faults
    pair : GearPair
    steels : tuple of RatedSteel
        Of pinion and wheel.
    """
    for name, steel, material in zip(("pinion", "wheel"), steels, pair.materials, strict=True):
        path = f"{name}.steel"
        faults.fields(steel, LIMITS, f"{path}.")
        faults.choice(f"{path}.kind", steel.kind, tuple(KINDS), "symbols of ISO 6336-5; irons are left out")
        low, high = _STIFF
        if not low <= material.youngs_modulus <= high:
            modulus = f"{1e-9 * material.youngs_modulus:.4g} GPa"
            allowed = f"must be {1e-9 * low:g} to {1e-9 * high:g} GPa: the factors of ISO 6336 are of steel"
            faults.add(
                f"{name}.material.youngs_modulus", modulus, allowed, "VDI 2736 has ratings of plastic gears"
            )
