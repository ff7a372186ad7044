"""Figures of films over places of the path and line loads, between those at which films were solved."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from base import Array

if TYPE_CHECKING:
    from scipy.interpolate import RectBivariateSpline

__all__ = ["FilmField"]


@dataclass(frozen=True, eq=False)
class FilmField(ABC):
    """Films over place and line load, flooded or starved, with heat or without, of a plane pair or of cells of a face.

    Under a given oil a film is a function of its place on the path, which has radius and speeds, and of its line load.

    Attributes
    ----------
    rho1 : ndarray, shape (places,)
        Curvature radius of the pinion's flank, rising [m].
    load : ndarray, shape (loads,)
        Force per length of face, rising or falling [N/m].
    """

    rho1: Array
    load: Array

    figures: ClassVar[tuple[str, ...]]
    degree_along: ClassVar[int]
    """Degree of the splines over places."""

    @abstractmethod
    def at(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        """Figure at places [m] under line loads [N/m], or its derivative by the load."""

    @abstractmethod
    def grid(self, figure: str) -> Array:
        """Figure of all films, as it is interpolated (places, loads)."""

    @cached_property
    def _splines(self) -> dict[str, RectBivariateSpline]:
        from scipy.interpolate import RectBivariateSpline  # loads half of scipy

        rising = slice(None, None, 1 if self.load[0] < self.load[-1] else -1)
        log, along, over = np.log(self.load[rising]), self.degree_along, min(3, self.load.size - 1)
        return {
            name: RectBivariateSpline(self.rho1, log, self.grid(name)[:, rising], kx=along, ky=over, s=0)
            for name in self.figures
        }

    def within(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        """Figure as it is interpolated, or its slope by the load's logarithm; else that of the nearest."""
        place = np.clip(np.nan_to_num(rho1), self.rho1[0], self.rho1[-1])
        log = np.log(np.clip(load, self.load.min(), self.load.max()))
        return np.asarray(self._splines[figure].ev(place, log, dy=slope))
