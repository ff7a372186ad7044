"""What the package raises and warns with, so that callers can distinguish it from the faults of others."""

from __future__ import annotations

from base import FlankfilmWarning, InputError


class GeometryError(InputError):
    """Gears that cannot exist or cannot run together, or values that no gear has."""


class LoadSharingError(InputError):
    """A load-sharing problem that is ill posed or whose iteration found no solution."""


class GeometryWarning(FlankfilmWarning):
    """A geometry that can be computed but that practice avoids."""
