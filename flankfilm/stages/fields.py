"""Fields of the loaded gears."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flankfilm.stages.engine import Engine


def fields(engine: Engine) -> Any:
    raise AssertionError
