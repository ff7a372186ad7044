"""Life factors of ISO 6336-2 and -3: strength over the number of load cycles, and cycles over strength."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from base import Array, Faults, Limit
from gears.tooth.errors import GeometryError

ENDURANCE = 0.85
"""Life factors at 1e10 cycles and beyond; the standard has up to 1 for optimum lubrication, material and experience."""

_CYCLES = Limit.above(0.0, 1e15, remedy="give the number of load cycles")


@dataclass(frozen=True)
class LifeCurve:
    """Life factor over cycles: straight in logarithms between points, constant outside.

    Parameters
    ----------
    cycles : tuple of float
        Load cycles N_L of the points, rising; the last ones are 1e10.
    factors : tuple of float
        Z_NT or Y_NT there, falling.

    Examples
    --------
    >>> curve = LifeCurve((1e5, 5e7, 1e10), (1.6, 1.0, 0.85))
    >>> round(curve.factor(1.08e9), 3), curve.factor(1e3), curve.factor(1e12)
    (0.91, 1.6, 0.85)
    >>> f"{curve.life(0.91):.3g}"
    '1.08e+09'
    """

    cycles: tuple[float, ...]
    factors: tuple[float, ...]

    def factor(self, cycles: float) -> float:
        """Life factor at a number of cycles.

        Raises
        ------
        GeometryError
            If the number is not positive and finite.
        """
        with Faults(GeometryError) as faults:
            faults.number("cycles", cycles, _CYCLES)
        if cycles <= self.cycles[0]:
            return self.factors[0]
        for place in range(1, len(self.cycles)):
            if cycles <= self.cycles[place]:
                before, after = self.cycles[place - 1], self.cycles[place]
                share = math.log(cycles / before) / math.log(after / before)
                return float(
                    self.factors[place - 1] * (self.factors[place] / self.factors[place - 1]) ** share
                )
        return self.factors[-1]

    def life(self, factor: float) -> float:
        """Cycles that a stress survives which needs this life factor; 0 above the curve, infinite below its end."""
        if factor > self.factors[0]:
            return 0.0
        if factor < self.factors[-1]:
            return math.inf
        for place in range(1, len(self.factors)):
            high, low = self.factors[place - 1], self.factors[place]
            if factor >= low and high > low:
                share = math.log(factor / high) / math.log(low / high)
                return float(self.cycles[place - 1] * (self.cycles[place] / self.cycles[place - 1]) ** share)
        return math.inf

    def lives(self, factors: Array) -> Array:
        """Cycles that stresses survive which need these life factors; as of `life`, of an array."""
        points, cycles = np.log(self.factors[::-1]), np.log(self.cycles[::-1])
        tiny = float(np.finfo(np.float64).tiny)
        endured = np.exp(np.interp(np.log(np.maximum(factors, tiny)), points, cycles))
        endured = np.where(factors > self.factors[0], 0.0, endured)
        return np.asarray(np.where(factors < self.factors[-1], math.inf, endured))


_PITTED = (6e5, 1e7, 1e9, 1e10), (1.6, 1.3, 1.0, ENDURANCE)
_UNPITTED = (1e5, 5e7, 1e10), (1.6, 1.0, ENDURANCE)
_NITRIDED = (1e5, 2e6, 1e10), (1.3, 1.0, ENDURANCE)
_NITROCARBURIZED = (1e5, 2e6, 1e10), (1.1, 1.0, ENDURANCE)
_CONTACT = {
    **dict.fromkeys(("St", "V", "Eh", "IF"), LifeCurve(*_UNPITTED)),
    **dict.fromkeys(("NT", "NV nitr"), LifeCurve(*_NITRIDED)),
    "NV nitrocar": LifeCurve(*_NITROCARBURIZED),
}
_BENDING = {
    **dict.fromkeys(("St", "V"), LifeCurve((1e4, 3e6, 1e10), (2.5, 1.0, ENDURANCE))),
    **dict.fromkeys(("Eh", "IF"), LifeCurve((1e3, 3e6, 1e10), (2.5, 1.0, ENDURANCE))),
    **dict.fromkeys(("NT", "NV nitr"), LifeCurve((1e3, 3e6, 1e10), (1.6, 1.0, ENDURANCE))),
    "NV nitrocar": LifeCurve((1e3, 3e6, 1e10), (1.1, 1.0, ENDURANCE)),
}

CONTACT: Mapping[str, LifeCurve] = MappingProxyType(_CONTACT)
"""Z_NT by the kind of steel, no pitting permitted: ISO 6336-2:2006, table 2."""

BENDING: Mapping[str, LifeCurve] = MappingProxyType(_BENDING)
"""Y_NT by the kind of steel: ISO 6336-3:2006, table 1."""

WITH_PITTING = LifeCurve(*_PITTED)
"""Z_NT of St, V, Eh and IF where limited pitting is permitted: ISO 6336-2:2006, table 2."""


def contact_curve(kind: str, pitting_permitted: bool = False) -> LifeCurve:
    """Z_NT of a kind of steel.

    Parameters
    ----------
    kind : str
        A symbol in `KINDS`.
    pitting_permitted : bool
        Whether limited pitting is permitted; nitrided steels have one curve.

    Notes
    -----
    Points are those of two open programs, which agree. A published listing confirms those of case-hardened steels
    (0.850 and 0.881), ISO/TR 6336-30 example 1 too (0.91 and 0.962).
    """
    return WITH_PITTING if pitting_permitted and kind in ("St", "V", "Eh", "IF") else CONTACT[kind]
