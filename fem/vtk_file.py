"""VTK's XML files of plane grids: appended binary, compressed, single precision; time series of named parts."""

from __future__ import annotations

import os
import zlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from base import Array, Integers, replacing

__all__ = ["VERTEX", "Grid", "write_grid", "write_series"]

Values = NDArray[np.generic]

VERTEX, TRIANGLE6 = 1, 22
"""VTK's numbers of the cells."""

LEVEL = 1
"""zlib's fastest: more effort saves no more than some per cent of digits that are nearly random."""

DROPPED = 12
"""Bits of the mantissa that fields named in ``Grid.rounded`` lose: 12 significant ones stay (2.5e-4 of the value),
which is finer than the fields are exact and packs far better."""

_TYPES = {"f4": "Float32", "i4": "Int32", "u1": "UInt8"}


@dataclass(frozen=True, eq=False)
class Grid:
    """One piece of an unstructured grid in the plane, all cells of one type.

    Attributes
    ----------
    points : (n, 2) array
        [m]
    cells : (m, k) array
        Points of each cell.
    cell_type : int
        VTK's number: 22 for second-order triangles, 1 for points.
    point_data, cell_data : mapping of str to array
        Named fields, unit in the name; (n, 2) vectors without named components get a zero third one.
    components : mapping of str to sequence of str
        Names of the components of a field with several.
    rounded : collection of str
        Fields that are stored with 12 significant bits, to 2.5e-4.
    scalars, vectors : str or None
        Fields that a viewer shows first.
    """

    points: Array
    cells: Integers
    cell_type: int = TRIANGLE6
    point_data: Mapping[str, Values] = field(default_factory=dict)
    cell_data: Mapping[str, Values] = field(default_factory=dict)
    components: Mapping[str, Sequence[str]] = field(default_factory=dict)
    rounded: Collection[str] = ()
    scalars: str | None = None
    vectors: str | None = None


class _Appended:
    """Binary part of the file, array by array."""

    def __init__(self) -> None:
        self.blocks: list[bytes] = []
        self.length = 0

    def add(self, name: str, values: Values, names: Sequence[str] = ()) -> str:
        """Append an array; return the element that describes it."""
        raw = np.ascontiguousarray(values).tobytes()
        packed = zlib.compress(raw, LEVEL)
        # one block: their number, its size, size of a last partial block (none), compressed size
        head = np.array([1, len(raw), 0, len(packed)] if raw else [0, 0, 0], dtype="<u4").tobytes()
        kind = _TYPES[values.dtype.str[1:]]
        labels = "".join(f" ComponentName{i}={quoteattr(label)}" for i, label in enumerate(names))
        width = values.shape[1] if values.ndim == 2 else 1
        line = (
            f"<DataArray type={quoteattr(kind)} Name={quoteattr(name)} "
            f'NumberOfComponents="{width}"{labels} format="appended" offset="{self.length}"/>'
        )
        self.blocks.append(head + (packed if raw else b""))
        self.length += len(self.blocks[-1])
        return line


def _stored(values: Values, flat: bool = False, rounded: bool = False) -> Values:
    """Numbers as the file holds them; vectors of the plane get a third component unless ``flat``."""
    if not np.issubdtype(values.dtype, np.floating):
        return values.astype("<i4")
    if values.ndim == 2 and values.shape[1] == 2 and not flat:
        values = np.column_stack([values, np.zeros(len(values))])
    single = values.astype("<f4")
    if rounded:
        bits = single.view("<u4")
        finite = np.isfinite(single)
        bits[finite] = (bits[finite] + (1 << (DROPPED - 1))) & ~np.uint32((1 << DROPPED) - 1)
    return single


def write_grid(path: Path, grid: Grid) -> Path:
    """Write a ``.vtu``; floating-point fields and points are stored in single precision.

    Parameters
    ----------
    path : Path
        Ends in ``.vtu``.
    grid : Grid

    Returns
    -------
    Path
        The file written.
    """
    appended = _Appended()
    count, width = grid.cells.shape

    def fields(data: Mapping[str, Values]) -> str:
        return "".join(
            appended.add(
                name,
                _stored(values, name in grid.components, name in grid.rounded),
                grid.components.get(name, ()),
            )
            for name, values in data.items()
        )

    active = "".join(
        f" {kind}={quoteattr(name)}"
        for kind, name in (("Scalars", grid.scalars), ("Vectors", grid.vectors))
        if name is not None
    )
    offsets = width * np.arange(1, count + 1)
    body = "".join(
        (
            f'<Piece NumberOfPoints="{len(grid.points)}" NumberOfCells="{count}">',
            f"<PointData{active}>{fields(grid.point_data)}</PointData>",
            f"<CellData>{fields(grid.cell_data)}</CellData>",
            f"<Points>{appended.add('Points', _stored(grid.points))}</Points><Cells>",
            appended.add("connectivity", grid.cells.ravel().astype("<i4")),
            appended.add("offsets", offsets.astype("<i4")),
            appended.add("types", np.full(count, grid.cell_type, dtype="u1")),
            "</Cells></Piece>",
        )
    )
    head = (
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt32" compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>'
        f'{body}</UnstructuredGrid>\n<AppendedData encoding="raw">_'
    )
    path = Path(path)
    with replacing(path) as beside, beside.open("wb") as file:
        file.write(head.encode())
        file.writelines(appended.blocks)
        file.write(b"</AppendedData>\n</VTKFile>\n")
    return path


def write_series(path: Path, steps: Sequence[tuple[float, Mapping[str, Path]]]) -> Path:
    """Write a time series: for each time, the named parts that belong to it.

    Parameters
    ----------
    path : Path
        Ends in ``.pvd``; the files are named relative to its folder.
    steps : sequence of (float, mapping of str to Path)
        Time, and the file of each part.
    """
    path = Path(path)
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">']
    lines.append("  <Collection>")
    for time, parts in steps:
        for number, (name, file) in enumerate(parts.items()):
            relative = quoteattr(os.path.relpath(file, path.parent))
            lines.append(
                f'    <DataSet timestep="{time:.9g}" group="" part="{number}" name={quoteattr(name)} file={relative}/>'
            )
    lines += ["  </Collection>", "</VTKFile>", ""]
    with replacing(path) as beside:
        beside.write_text("\n".join(lines), encoding="utf-8")
    return path
