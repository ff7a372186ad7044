"""Records that numpy turns into arrays."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
import numpy.typing as npt

from base import Array, Integers


class AsArray(ABC):
    """What `numpy.asarray` makes a table of: the columns that a plot needs."""

    @abstractmethod
    def columns(self) -> Array | Integers:
        """The table."""

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """The table as an array of numpy."""
        return np.array(self.columns(), dtype=dtype)
