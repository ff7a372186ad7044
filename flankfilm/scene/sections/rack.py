"""Keys of the basic rack and of the tool, and the rack that they make."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import ClassVar

import gears
from base import InputError, Limit
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section
from gears.tooth.rack import LIMITS as RACK

ISO_53 = {"A": (1.0, 1.25, 0.38), "B": (1.0, 1.25, 0.3), "C": (1.0, 1.25, 0.25), "D": (1.0, 1.4, 0.39)}
"""Profiles of ISO 53:1998, annex A: addendum, dedendum and tip radius, times the module."""


class RackSection(Section):
    """Basic rack in modules, for racks outside ISO 53."""

    ground = RACK

    h_aP: float = key("addendum, times the module", example=1.0)
    h_fP: float = key("dedendum, times the module", example=1.25)
    rho_fP: float = key("radius of the fillet, times the module", example=0.38)
    alpha_deg: float = key("pressure angle", 20.0)

    def rack(self) -> gears.BasicRack:
        """Rack in SI."""
        return gears.BasicRack(**self.si())


class ToolSection(Section):
    """Rack-shaped tool that cuts both gears, in place of dedendum and fillet radius of the rack."""

    ground: ClassVar[Limits] = {**RACK, "protuberance": Limit(-1.0, 1.0, "m")}

    h_aP0: float = key(
        "addendum of the tool, times the module: the rack's dedendum h_fP", of="h_fP", example=1.25
    )
    rho_aP0: float = key("radius of the tool's tip, times the module", of="rho_fP", example=0.38)
    protuberance_um: float = key(
        "protuberance of the tool; only 0, since fillets are those of a tool with straight flanks", 0.0
    )

    def cut(self, rack: gears.BasicRack) -> gears.BasicRack:
        """A rack with dedendum and fillet radius by the tool."""
        h_aP0, rho_aP0, bulge = (self.value(name) for name in ("h_aP0", "rho_aP0", "protuberance_um"))
        return gears.BasicRack.of_tool(h_aP0, rho_aP0, rack.h_aP, rack.alpha, bulge)


def basic_rack(rack: str | RackSection, tool: ToolSection | None) -> gears.BasicRack:
    """Rack of both gears, by its name in ISO 53 or by its dimensions, with what follows from a tool."""
    plain = rack.rack() if isinstance(rack, RackSection) else gears.BasicRack(*ISO_53[rack[-1]])
    return plain if tool is None else tool.cut(plain)


@contextmanager
def under_tool(tool: ToolSection | None) -> Iterator[None]:
    """Give the faults of what a tool's keys say to the tool."""
    try:
        yield
    except InputError as error:
        if tool is None:
            raise
        of_tool = {
            "rack.h_fP": "tool.h_fP",
            "rack.rho_fP": "tool.rho_fP",
            "protuberance": "tool.protuberance",
        }
        raise InputError(
            replace(fault, where=of_tool[fault.where], remedy=fault.remedy.replace("h_fP", "h_aP0"))
            if fault.where in of_tool
            else fault
            for fault in error.faults
        ) from error
