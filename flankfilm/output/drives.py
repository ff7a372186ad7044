"""Variables of a drive train: its modes, and what its bearings, shafts and couplings carry over the speed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from base.results import figures
from flankfilm.output.variables import of_record

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import DriveSweep, PairDrive


def train(drive: PairDrive | None, swept: DriveSweep | None) -> Iterator[xr.Dataset]:
    """Variables of a drive train and of its sweep; what no part carries has none."""
    if drive is not None:
        yield of_record("drive", drive)
    if swept is not None:
        without = [
            name for name, parts in (("bearing", swept.bearings), ("shaft", swept.shafts)) if not parts
        ]
        kept = [name for name in figures(type(swept)) if not any(part in name for part in without)]
        yield of_record("drive_sweep", swept, kept)
