"""Records as variables: a record's own figures say what its variables are called, along what, in which unit.

The variable of a figure is called ``<prefix>_<figure>``. Its axes are the record's own, ``<prefix>_<axis>``, but for
those that mean the same in every record. Attributes: ``units`` (SI), ``long_name``, ``display_units`` where people
read another unit, ``error`` where the relative error is known.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base.results import Figure, Quantity, figures, quantities

if TYPE_CHECKING:
    import xarray as xr

COMMON: Mapping[str, tuple[str, ...]] = {
    "gear": ("pinion", "wheel"),
    "axis": ("x", "y"),
    "state": ("displacement", "velocity"),
}
"""Axes that mean the same in every record, with what their entries are."""

OWN = ("dense", "event", "harmonic")
"""Axes that are not the same in equal records."""

PLACES = (
    "position",
    "dense_position",
    "travel",
    "rho1",
    "frequency",
    "speed",
    "torque",
    "face_position",
    "arc",
    "x",
)
"""Figures that say where others hold: coordinates of the dataset."""


NAMES = ("Dowson", "Fourier", "Hertz", "Ishikawa", "Lambda", "Moes", "Poisson")
"""Words that begin with a capital wherever they stand."""


def of_record(prefix: str, record: object, names: Container[str] | None = None) -> xr.Dataset:
    """Variables of a record; a mapping becomes a variable for each of its keys.

    Parameters
    ----------
    prefix : str
        Which record it is, such as ``dry``.
    record : object
        With figures; what is None is left out.
    names : container of str, optional
        Figures that are wanted; all unless given.

    Examples
    --------
    >>> from base import quantity, record
    >>> @record
    ... class Curve:
    ...     position: object = quantity("1", "base pitches from A", "position")
    ...     deflection: object = quantity("m", "deflection", "position", shown="um")
    >>> data = of_record("dry", Curve([0.25, 0.75], [2e-6, 3e-6]))
    >>> data.dry_deflection.dims, data.dry_deflection.attrs
    (('dry_position',), {'units': 'm', 'long_name': 'deflection', 'display_units': 'um'})
    """
    known = quantities(record).values()
    wanted = (one for one in known if names is None or one.name in names)
    return of_quantities(prefix, wanted, _errors(record, known))


def of_quantities(
    prefix: str, quantities: Iterable[Quantity], errors: Mapping[str, float] | None = None
) -> xr.Dataset:
    """Variables of figures of a record, or of ones that stand in none.

    Parameters
    ----------
    prefix : str
    quantities : iterable of Quantity
    errors : mapping, optional
        Name to relative error, where it is known.
    """
    import xarray as xr

    known, found = errors or {}, {}
    for quantity in quantities:
        for name, figure, value in _entries(quantity.name, quantity.figure, quantity.value):
            error = {"error": known[quantity.name]} if quantity.name in known else {}
            attributes = {**_attributes(figure), **error}
            found[joined(prefix, name)] = (_dims(prefix, figure.dims), _plain(value), attributes)
    data = xr.Dataset(found)
    places = {joined(prefix, place) for place in PLACES}
    return data.set_coords([name for name in map(str, data.data_vars) if name in places])


def figure_of(name: str, unit: str, meaning: str, dims: str, value: Any, *, shown: str = "") -> Quantity:
    """Give a figure that stands in no record; arguments as of `base.quantity`."""
    return Quantity(name, Figure(unit, meaning, tuple(dims.split()), shown), value)


def of_list(prefix: str, axis: str, records: Sequence[object]) -> xr.Dataset:
    """Variables of single numbers of equal records, one entry a record, along an axis of their own.

    Parameters
    ----------
    prefix, axis : str
    records : sequence of object
        At least one.
    """
    return of_quantities(
        prefix,
        (
            Quantity(name, replace(figure, dims=(axis,)), [getattr(record, name) for record in records])
            for name, figure in figures(type(records[0])).items()
            if not figure.dims
        ),
    )


def of_models(prefix: str, records: Mapping[str, object], meaning: str, axis: str = "model") -> xr.Dataset:
    """Variables of equal records beside each other, along an axis that names them.

    Parameters
    ----------
    prefix : str
    records : mapping
        Label to record; all have the same places.
    meaning : str
        Of the labels.
    axis : str
    """
    import xarray as xr

    about = {"units": "", "long_name": meaning}
    labels = xr.Variable((joined(prefix, axis),), np.array(list(records)), about)
    # arcs and events are as many as a model has
    own = [joined(prefix, axis) for axis in OWN]
    each = [of_record(prefix, record).drop_dims(own, errors="ignore") for record in records.values()]
    whole = xr.concat(each, dim=labels, data_vars="all", coords="minimal", compat="override", join="override")
    for name, variable in whole.data_vars.items():  # the first one's error is not that of all
        known = [one[name].attrs["error"] for one in each if name in one and "error" in one[name].attrs]
        variable.attrs.pop("error", None)
        if len(known) == len(each):
            variable.attrs["error"] = max(known)
    return whole


def merged(parts: Iterable[xr.Dataset], attributes: Mapping[str, str | float]) -> xr.Dataset:
    """Gather the variables of all records.

    Parameters
    ----------
    parts : iterable of xarray.Dataset
    attributes : mapping
        Of the whole file: text and numbers alone, since netCDF holds nothing else.
    """
    import xarray as xr

    whole = xr.merge(parts, join="exact", compat="no_conflicts", combine_attrs="override")
    for axis, labels in COMMON.items():
        if axis in whole.dims:
            whole = whole.assign_coords({axis: (axis, np.array(labels), {"units": "", "long_name": axis})})
    return whole.assign_attrs(attributes)


def joined(prefix: str, name: str) -> str:
    """Name of a variable or an axis; one that begins with the prefix has it already.

    Examples
    --------
    >>> joined("dry", "position"), joined("film", "film_ratio"), joined("torque", "torque")
    ('dry_position', 'film_ratio', 'torque')
    """
    return name if f"{name}_".startswith(f"{prefix}_") else f"{prefix}_{name}"


def sentence(meaning: str) -> str:
    """Meaning as the middle of a sentence: beginning small, but for names and symbols.

    Examples
    --------
    >>> sentence("Base pitch, p_b = pi m cos alpha"), sentence("Hertz pressure"), sentence("K_v by method B")
    ('base pitch, p_b = pi m cos alpha', 'Hertz pressure', 'K_v by method B')
    """
    first = meaning.split(" ", 1)[0].rstrip(",;:")
    named = first in NAMES or not first.isalpha() or len(first) < 2 or not first[1:].islower()
    return meaning if named else meaning[:1].lower() + meaning[1:]


def identifier(label: str) -> str:
    """Words of a label as part of a name.

    Examples
    --------
    >>> identifier("potential energy, Sainsot body")
    'potential_energy_sainsot_body'
    """
    return "_".join("".join(c if c.isalnum() else " " for c in label.lower()).split())


def _entries(name: str, figure: Figure, value: Any) -> Iterator[tuple[str, Figure, Any]]:
    """A figure, or each one of a mapping of them; the key stands after a colon in the meaning."""
    if not isinstance(value, Mapping):
        yield name, figure, value
        return
    for key, one in value.items():
        yield f"{name}_{identifier(key)}", replace(figure, meaning=f"{figure.meaning}: {key}"), one


def _errors(record: object, known: Iterable[Quantity]) -> dict[str, float]:
    """Relative errors of a record's figures, where they are known."""
    whole = getattr(record, "error", None)
    found = dict.fromkeys(getattr(type(record), "headline", ()), whole)
    for one in known:
        if one.figure.error:
            error = getattr(record, one.figure.error)
            found[one.name] = error[one.name] if isinstance(error, Mapping) else error
    return {
        name: float(error)
        for name, error in found.items()
        if isinstance(error, float | np.floating) and np.isfinite(error)
    }


def _attributes(figure: Figure) -> dict[str, Any]:
    about: dict[str, Any] = {"units": figure.unit, "long_name": sentence(figure.meaning)}
    return about | ({"display_units": figure.read_in} if figure.read_in != figure.unit else {})


def _dims(prefix: str, dims: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(dim if dim in COMMON else joined(prefix, dim) for dim in dims)


def _plain(value: Any) -> Any:
    """Value as netCDF holds it: no booleans, text of fixed length."""
    values = np.asarray(value)
    if values.dtype == np.bool_:
        return values.astype(np.int8)
    return values.astype(str) if values.dtype == object else values
