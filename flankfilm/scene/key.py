"""A key of a scene: unit, bounds, default, meaning and example in one field.

Reading, conversion to SI, faults in the user's unit, the template and the documentation's tables follow from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from pydantic import Field
from pydantic.fields import FieldInfo

from base import Limit
from base.units import factor, suffix

__all__ = ["Key", "key", "key_of", "within"]


@dataclass(frozen=True)
class Key:
    """What a field says of its key beyond pydantic's own.

    Attributes
    ----------
    unit : str
        As users write it: ``mm``.
    of : str or None
        The ground's name of the quantity; empty for the key's name without its unit, None where the ground has none.
    scale, offset : float
        SI value of a number x: scale x + offset.
    ground : Limit or None
        What the ground allows, in SI.
    note : str
        Said beside bounds: "a diameter".
    example : Any
        Value in the template; None shows the default.
    commented : bool
        Whether the template shows the key behind a comment sign.
    """

    unit: str = "1"
    of: str | None = ""
    scale: float = 1.0
    offset: float = 0.0
    ground: Limit | None = None
    note: str = ""
    example: Any = None
    commented: bool = False

    def __call__(self, schema: dict[str, Any]) -> None:
        """Add the unit to the key's JSON schema; pydantic calls this."""
        if self.unit != "1":
            schema["unit"] = self.unit

    def attribute(self, name: str) -> str | None:
        """Name of the quantity in the ground for the key `name`."""
        if self.of != "":
            return self.of
        end = suffix(self.unit)
        return name.removesuffix(f"_{end}") if end else name

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
        if self.ground is None:
            return None
        unit = self.ground.unit if self.unit == "1" else self.unit
        return replace(
            self.ground, low=self.user(self.ground.low), high=self.user(self.ground.high), unit=unit
        )

    @property
    def allowed(self) -> str:
        """What must hold, in the user's unit; empty where anything may stand."""
        return f"{self.bounds}{self.remark}" if self.bounds else ""

    @property
    def remark(self) -> str:
        """The note as it stands behind bounds."""
        return f" ({self.note})" if self.note else ""


def key(
    meaning: str,
    default: Any = ...,
    *,
    unit: str = "1",
    limit: Limit | None = None,
    of: str | None = "",
    scale: float | None = None,
    offset: float = 0.0,
    note: str = "",
    example: Any = None,
    commented: bool | None = None,
    **constraints: Any,
) -> Any:
    """Field of a section.

    Parameters
    ----------
    meaning : str
        In an engineer's words, with what holds where the key is left out.
    default : Any
        What stands there if it is left out; none makes it required.
    unit : str
        Unit of the user's number, of `base.units`; the key's name ends in it.
    limit : Limit, optional
        What the ground allows, in SI; of a list's entries see `within`.
    of, scale, offset, note, example, commented
        See `Key`; `scale` follows from the unit unless given, and a key with a default and no example of its own is
        commented unless said otherwise.
    **constraints
        Of pydantic: lengths, strictness.
    """
    if scale is None:
        scale = factor(unit)
    if commented is None:
        commented = default is not ... and example is None
    about = Key(unit, of, scale, offset, limit, note, example, commented)
    return Field(
        default=default,
        description=meaning,
        json_schema_extra=about,
        **_bounds(about.bounds),
        **constraints,
    )


def within(limit: Limit) -> FieldInfo:
    """Bounds of the entries of a list, for ``Annotated``; `limit` is in the user's unit."""
    found: FieldInfo = Field(**_bounds(limit))
    return found


def key_of(field: FieldInfo) -> Key:
    """What a field says of its key."""
    about = field.json_schema_extra
    return about if isinstance(about, Key) else Key()


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
