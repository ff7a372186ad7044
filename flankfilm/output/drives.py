"""Variables of a drive train: its modes, and what its bearings, shafts and couplings carry over the speed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from base.results import figures
from flankfilm.coupling.vibration.part_loads import PARTS, Carrying
from flankfilm.output.variables import of_record

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import DriveSweep, PairDrive


def train(drive: PairDrive | None, swept: DriveSweep | None) -> Iterator[xr.Dataset]:
    """Variables of a drive train and of its sweep; what no part carries has none."""
    if drive is not None:
        yield of_record("drive", drive)
    if swept is not None:
        yield carrying("drive_sweep", swept)


def carrying(prefix: str, record: Carrying) -> xr.Dataset:
    """Variables of a record without those of bearings or of shafts where it has none."""
    without = [part for part in PARTS if not getattr(record, f"{part}s")]
    kept = [name for name in figures(type(record)) if not any(part in name for part in without)]
    return of_record(prefix, record, kept)
