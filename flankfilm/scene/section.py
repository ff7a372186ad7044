"""What all sections of a scene have in common."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict

from base import InputError, Limit
from flankfilm.scene.key import key_of

__all__ = ["Limits", "Section", "refused"]

Limits = Mapping[str, Limit]


class Section(BaseModel):
    """Common rules: unknown keys refused, no silent conversion, no NaN or infinity, frozen."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    ground: ClassVar[Limits] = {}
    """What the ground allows for the quantities that the section's keys give, in SI."""

    def si(self, *names: str) -> dict[str, Any]:
        """Keyword arguments for the ground: its names, in SI; what was not given is left to the ground's default.

        Parameters
        ----------
        *names : str
            Keys to give, all if there are none; keys that the ground does not know and sections are left out.
        """
        found = {}
        for name in names or type(self).model_fields:
            attribute, value = key_of(type(self).model_fields[name]).of, self.value(name)
            if attribute and value is not None and not isinstance(value, Section):
                found[attribute] = value
        return found

    def value(self, name: str) -> Any:
        """Value of a key in SI; None where it was not given."""
        given = getattr(self, name)
        convert = not (given is None or isinstance(given, Section))
        return key_of(type(self).model_fields[name]).si(given) if convert else given


def refused(allowed: str, remedy: str = "", *, key: str = "", value: str = "") -> InputError:
    """Fault of keys that do not go together, to be raised by a section's validator.

    Parameters
    ----------
    allowed, remedy, value : str
        See `base.Fault`.
    key : str
        The key at fault; empty for the section.
    """
    return InputError.at(key, value, allowed, remedy)
