"""A key of a scene: unit, bounds, default, meaning and example in one field.

Reading, conversion to SI, faults in the user's unit, the template and the documentation's tables follow from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from pydantic import Field
from pydantic.fields import FieldInfo

from base import Limit
from base.units import factor, suffix, unit_of

__all__ = ["BY_ELEMENTS", "Key", "Traits", "key", "key_of", "within"]


@dataclass(frozen=True)
class Traits:
    """What rules between sections ask of a key, whatever its name.

    Attributes
    ----------
    finite_elements : bool
        Whether finite elements alone know it: no closed form and no given stiffness does.
    along_face : bool
        Whether the load varies along the face by it.
    meshed : bool
        Whether a mesh of the teeth shows it.
    beside_shafts, beside_segments : str
        Why it cannot stand beside [shafts], or beside steps of a shaft (its gear's, or any for a key of no gear); empty
        for a key that can.
    """

    finite_elements: bool = False
    along_face: bool = False
    meshed: bool = True
    beside_shafts: str = ""
    beside_segments: str = ""


BY_ELEMENTS = Traits(finite_elements=True)
"""Of keys that finite elements alone know."""


@dataclass(frozen=True)
class Key:
    """What a field says of its key; written by `key`, completed with the name under which it stands in a section.

    Attributes
    ----------
    meaning : str
        In an engineer's words, with what holds where the key is left out.
    default : Any
        What stands there if it is left out; an ellipsis makes it required.
    unit : str
        As users write it: ``mm``; empty for the one in which the key's name ends.
    of : str or None
        The ground's name of the quantity; empty for the key's name without its unit, None where the ground has none.
    scale, offset : float
        SI value of a number x: scale x + offset.
    limit : Limit or None
        What the ground allows, in SI; None for what the section's `ground` says of the quantity.
    note : str
        Said beside bounds: "a diameter".
    example : Any
        Value in the template; None shows the default.
    commented : bool
        Whether the template shows the key behind a comment sign.
    constraints : mapping
        Of pydantic: lengths.
    traits : Traits
        What rules between sections ask of it.
    """

    meaning: str
    default: Any = ...
    unit: str = "1"
    of: str | None = ""
    scale: float = 1.0
    offset: float = 0.0
    limit: Limit | None = None
    note: str = ""
    example: Any = None
    commented: bool = False
    constraints: Mapping[str, Any] = field(default_factory=dict)
    traits: Traits = Traits()

    def __set_name__(self, owner: type, name: str) -> None:
        """Take unit, name and bounds in the ground from where the key stands, and become pydantic's field."""
        unit = self.unit or unit_of(name)
        end = suffix(unit)
        of = (name.removesuffix(f"_{end}") if end else name) if self.of == "" else self.of
        scale = self.scale if self.unit else self.scale * factor(unit)
        limit = self.limit or getattr(owner, "ground", {}).get(of)
        about = replace(self, unit=unit, of=of, scale=scale, limit=limit)
        setattr(owner, name, about.field())

    def field(self) -> Any:
        """Field of pydantic, with the bounds in the user's unit."""
        return Field(
            default=self.default,
            description=self.meaning,
            json_schema_extra=self,
            **_bounds(self.bounds),
            **self.constraints,
        )

    def __call__(self, schema: dict[str, Any]) -> None:
        """Add the unit to the key's JSON schema; pydantic calls this."""
        if self.unit != "1":
            schema["unit"] = self.unit

    def si(self, value: Any) -> Any:
        """Value in SI; what is no number, or needs no conversion, as it is."""
        if isinstance(value, tuple):
            return tuple(map(self.si, value))
        if isinstance(value, str | bool) or (self.scale == 1.0 and self.offset == 0.0):
            return value
        return self.scale * value + self.offset

    def user(self, value: float) -> float:
        """Value in the user's unit, without the digits that the conversion adds."""
        return float(f"{(value - self.offset) / self.scale:.12g}")

    @property
    def bounds(self) -> Limit | None:
        """What is allowed, in the user's unit."""
        if self.limit is None:
            return None
        unit = self.limit.unit if self.unit == "1" else self.unit
        low, high = self.user(self.limit.low), self.user(self.limit.high)
        return replace(self.limit, low=low, high=high, unit=unit)

    @property
    def allowed(self) -> str:
        """What must hold, in the user's unit; empty where anything may stand."""
        return f"{self.bounds}{self.remark}" if self.bounds else ""

    @property
    def remark(self) -> str:
        """The note as it follows bounds."""
        return f" ({self.note})" if self.note else ""


def key(
    meaning: str,
    default: Any = ...,
    *,
    example: Any = None,
    such_as: Any = None,
    shown: bool = False,
    of: str | None = "",
    diameter: str = "",
    celsius: str = "",
    limit: Limit | None = None,
    traits: Traits = Traits(),
    **constraints: Any,
) -> Any:
    """Key of a section; its unit is the one in which its name ends, its bounds are the ground's.

    Parameters
    ----------
    meaning, default : str, Any
        See `Key`.
    example, such_as : Any
        Value in the template; `such_as` behind a comment sign, as is a key with a default and no example.
    shown : bool
        Shows the default in the template without a comment sign.
    of, diameter, celsius : str, optional
        The ground's name where it is another: of the same quantity, of the radius, of the absolute temperature.
    limit : Limit, optional
        Bounds that the section's `ground` does not hold, in SI; of a list's entries see `within`.
    traits : Traits
        What rules between sections ask of the key.
    **constraints
        Of pydantic: lengths.
    """
    commented = such_as is not None or not (default is ... or shown or example is not None)
    written = Key(
        meaning,
        default,
        unit="",
        of=of,
        limit=limit,
        example=such_as if example is None else example,
        commented=commented,
        constraints=constraints,
        traits=traits,
    )
    if diameter:
        return replace(written, of=diameter, scale=0.5, note="a diameter")
    return replace(written, of=celsius, unit="degC", offset=ZERO_CELSIUS) if celsius else written


ZERO_CELSIUS = 273.15


def within(limit: Limit) -> FieldInfo:
    """Bounds of the entries of a list, for ``Annotated``; `limit` is in the user's unit."""
    bounds: FieldInfo = Field(**_bounds(limit))
    return bounds


def key_of(field: FieldInfo) -> Key:
    """What a field says of its key; nothing for one that was not written by `key`."""
    about = field.json_schema_extra
    return about if isinstance(about, Key) else Key(field.description or "")


def _bounds(limit: Limit | None) -> Mapping[str, Any]:
    """Bounds in pydantic's words."""
    if limit is None:
        return {}
    kind = int if limit.whole else float
    low, high = ("gt" if limit.low_open else "ge"), ("lt" if limit.high_open else "le")
    return {
        name: kind(value)
        for name, value in ((low, limit.low), (high, limit.high))
        if abs(value) != float("inf")
    }
