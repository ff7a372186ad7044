"""What a command gives, in one form, and the one way into its folder."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeAlias, TypeVar, Union

from base import plot
from flankfilm.files.manifest import conclude
from flankfilm.output.files import write_netcdf

if TYPE_CHECKING:
    from typing import Self

    import xarray as xr
    from matplotlib.figure import Figure
    from rich.table import Table

R = TypeVar("R")
O = TypeVar("O", bound="Outcome[Any]")

Line: TypeAlias = Union[str, "Table"]
"""What the terminal shows: a sentence, or a table that takes the width there is."""

Picture: TypeAlias = Callable[["xr.Dataset"], "Figure"]
"""Draws a dataset."""


@dataclass(frozen=True, eq=False)
class Outcome(ABC, Generic[R]):
    """What a run, a study, an optimisation or a verification gave.

    Attributes
    ----------
    result : R
        The record for Python.
    folder : Path or None
        Where the files are; None where none were written.
    files : tuple of Path
        What was written.
    others : tuple of str
        Files in the folder that are not of this outcome.
    """

    data: ClassVar[str]
    """Name of the file of data, one of `flankfilm.files.folder.REPORTS`."""

    result: R
    folder: Path | None = None
    files: tuple[Path, ...] = ()
    others: tuple[str, ...] = ()

    @property
    @abstractmethod
    def dataset(self) -> xr.Dataset:
        """What the file of data holds; pages and pictures are drawn from it."""

    @property
    @abstractmethod
    def lines(self) -> Sequence[Line]:
        """What the terminal shows."""

    @abstractmethod
    def tables(self, folder: Path) -> list[Path]:
        """Write what stands beside the file of data, each as a whole; name what is there already too."""

    @property
    def pictures(self) -> Mapping[str, Picture]:
        """Pictures that are files, by their names."""
        return {}

    @abstractmethod
    def page(self, folder: Path) -> Path:
        """Write ``report.html``."""

    def written(self, folder: Path) -> Self:
        """Write tables, data, pictures and page into a folder that is claimed and locked."""
        from flankfilm.figures.style import save

        files = [*self.tables(folder), folder / self.data]
        write_netcdf(files[-1], self.dataset)
        for name, draw in self.pictures.items():
            files.append(folder / f"{name}.svg")
            save(draw(self.dataset), files[-1])
        return replace(self, folder=folder, files=(*files, self.page(folder)))

    @property
    def faults(self) -> Sequence[str]:
        """What could not be computed, a line each."""
        return ()

    @property
    def status(self) -> int:
        """Exit status of the command."""
        return 0

    def plot(self) -> Figure:
        """Picture of the result."""
        return plot(self.result)


def concluded(outcome: O, folder: Path | None) -> O:
    """Write all of an outcome, list its files, and remove what an earlier one left.

    Parameters
    ----------
    outcome : Outcome
        As computed.
    folder : Path or None
        Where `flankfilm.files.folder.occupied` holds; None writes nothing.
    """
    if folder is None:
        return outcome
    outcome = outcome.written(folder)
    return replace(outcome, others=conclude(folder, outcome.files))
