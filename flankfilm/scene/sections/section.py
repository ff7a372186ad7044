"""What all sections of a scene have in common."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, TypeVar

from pydantic import BaseModel, ConfigDict

from base import InputError, Limit
from flankfilm.scene.sections.key import key_of

__all__ = ["Limits", "Section", "refused", "required"]

T = TypeVar("T")

Limits = Mapping[str, Limit]


class Section(BaseModel):
    """Common rules: unknown keys refused, no silent conversion, no NaN or infinity, frozen."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False, defer_build=True)

    called: ClassVar[str] = "the scene"
    """What faults call the file of which this is the whole."""

    ground: ClassVar[Limits] = {}
    """What the ground allows for the quantities that the section's keys give, in SI."""

    def given_keys(self, *names: str) -> list[str]:
        """Those of the keys that were given."""
        return [name for name in names if getattr(self, name) is not None]

    def si(self, *names: str) -> dict[str, Any]:
        """Keyword arguments for the ground: its names, in SI; what was not given is left to the ground's default.

        Parameters
        ----------
        *names : str
            Keys to give, all if there are none; keys that the ground does not know, those of a part (`si_of`) and
            sections are left out.
        """
        arguments = {}
        for name in names or type(self).model_fields:
            attribute, value = key_of(type(self).model_fields[name]).of, self.value(name)
            if attribute and "." not in attribute and value is not None and not isinstance(value, Section):
                arguments[attribute] = value
        return arguments

    def si_of(self, part: str) -> dict[str, Any]:
        """Keyword arguments for a part of the ground's object whose quantities are keys of this section.

        Parameters
        ----------
        part : str
            The ground's name of it: ``lead`` of keys that are of ``lead.crowning`` and the like.
        """
        arguments = {}
        for name, field in type(self).model_fields.items():
            whole, _, attribute = (key_of(field).of or "").partition(".")
            if whole == part and attribute and (value := self.value(name)) is not None:
                arguments[attribute] = value
        return arguments

    def value(self, name: str) -> Any:
        """Value of a key in SI; None where it was not given."""
        user_value = getattr(self, name)
        convert = not (user_value is None or isinstance(user_value, Section))
        return key_of(type(self).model_fields[name]).si(user_value) if convert else user_value


def refused(allowed: str, remedy: str = "", *, key: str = "", value: str = "") -> InputError:
    """Error of a single fault, such as of keys that do not go together.

    Parameters
    ----------
    allowed, remedy, value : str
        See `base.Fault`.
    key : str
        The key or file at fault; empty for the section whose validator raises it.
    """
    return InputError.at(key, value, allowed, remedy)


def required(value: T | None, key: str, by: str = "", remedy: str = "") -> T:
    """Value that a scene must have given.

    Parameters
    ----------
    value : any or None
    key : str
        Its section or key: ``[pair]``.
    by : str
        What needs it.
    remedy : str
        To add the section unless given.

    Raises
    ------
    InputError
        Where it is None.
    """
    if value is None:
        allowed = f"is required by {by}" if by else "is required"
        raise InputError.at(key, "", allowed, remedy or f"Add the section {key}")
    return value
