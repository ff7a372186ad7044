"""What a REXS file may say of the transverse section, and what it must be by the normal section and the helix.

Programs that take one section for the other write a transverse module as `normal_module`: figures that a file gives of
both sections must agree.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from flankfilm.exchange import rexs_attributes as rexs
from flankfilm.exchange.rexs_attributes import Attribute
from gears.tooth.helix import Helix

__all__ = ["Sections"]

Follows = tuple[Attribute, float, str]
"""An attribute, its value in the scene's unit, and the law by which it follows."""


@dataclass(frozen=True)
class Sections:
    """Both sections of a pair, in the scene's units.

    Parameters
    ----------
    module, alpha, beta : float
        m_n [mm], alpha_n and beta of the pinion [deg]; nan where the file does not say them.

    Examples
    --------
    >>> pair = Sections(module=2.0, alpha=20.0, beta=20.0)
    >>> [(attribute.name, round(value, 4)) for attribute, value, _ in pair.of_gear(36)][:2]
    [('transverse_module', 2.1284), ('reference_circle_diameter', 76.6208)]
    """

    module: float
    alpha: float
    beta: float

    @property
    def helix(self) -> Helix:
        """Helix of the pinion."""
        return Helix(math.radians(self.beta), math.radians(self.alpha))

    @property
    def transverse_module(self) -> float:
        """Transverse module, m_t = m_n / cos(beta) [mm]."""
        return self.module / self.helix.cosine

    def of_gear(self, teeth: float) -> Iterator[Follows]:
        """What follows for attributes of a gear; the base helix angle but for its sign, which early versions lack."""
        yield rexs.TRANSVERSE_MODULE, self.transverse_module, "m_n / cos(beta)"
        yield rexs.REFERENCE_DIAMETER, teeth * self.transverse_module, "z m_n / cos(beta)"
        for attribute in rexs.BASE_HELIX_ANGLE:
            angle = abs(math.degrees(self.helix.base_angle))
            yield attribute, angle, "sin(beta_b) = sin(beta) cos(alpha_n)"

    def of_flank(self) -> Follows:
        """What follows for the pressure angle of a flank."""
        angle = math.degrees(self.helix.transverse_pressure_angle)
        return rexs.TRANSVERSE_PRESSURE_ANGLE, angle, "tan(alpha_t) = tan(alpha_n) / cos(beta)"
