"""Records as variables: a record's own figures say what its variables are called, along what, in which unit.

The variable of a figure is called ``<prefix>_<figure>``, by the name that the figure has in files. Its axes are the
record's own, ``<prefix>_<axis>``, but for those that mean the same in every record. Attributes: ``units`` (SI),
``long_name``, ``display_units`` where people read another unit; ``alias_of``, the variable of which this is the older
name, kept for one version; ``error``, where the relative error is known, ``error_variable``, the variable that holds
those of its entries, or ``error_note``, why there is none; ``model_error``, what the model leaves open, where it is
estimated, with ``model_error_source``, the page of the documentation that says so; ``tolerance_met`` beside an
``error``. A figure of which nothing says so has none of them, which a test
finds.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base.results import Figure, Quantity, figures, quantities, why_no_error
from flankfilm.output.model_errors import entry
from flankfilm.output.uncertainty import held_error, held_model_error, met

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


NAME, PLACE = "a name", "a place"
OPEN = "not known: the estimate has no bound in this result"
"""Why variables that are no results have no error."""

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
    ...     deflection: object = quantity("m", "deflection", "position", shown="um", error="error")
    ...     error: float = 0.01
    >>> data = of_record("dry", Curve([0.25, 0.75], [2e-6, 3e-6]))
    >>> data.dry_deflection.dims, data.dry_deflection.attrs
    (('dry_position',), {'units': 'm', 'long_name': 'deflection', 'display_units': 'um', 'error': 0.01})
    """
    known = quantities(record)
    wanted = (
        replace(quantity, figure=replace(quantity.figure, no_error=why_no_error(record, name)))
        for name, quantity in known.items()
        if names is None or name in names
    )
    data = of_quantities(prefix, wanted, _errors(record, known))
    for name, quantity in known.items():
        model = held_model_error(record, name, quantity.figure)
        source = entry(record, name)
        for variable in {joined(prefix, quantity.figure.called or name), joined(prefix, name)}:
            if _finite(model) and variable in data:
                data[variable].attrs["model_error"] = float(model)
                if source is not None:
                    data[variable].attrs["model_error_source"] = source.source
    return data


Errors = Mapping[str, "float | str | Mapping[str, float]"]
"""Of figures by name: a relative error, the name of the figure with those of the entries, or errors by key."""


def of_quantities(prefix: str, quantities: Iterable[Quantity], errors: Errors | None = None) -> xr.Dataset:
    """Variables of figures of a record, or of ones that stand in none.

    Parameters
    ----------
    prefix : str
    quantities : iterable of Quantity
    errors : mapping, optional
        Where they are known.
    """
    import xarray as xr

    errors, variables = errors or {}, {}
    for quantity in quantities:
        for name, key, figure, value in _entries(quantity.name, quantity.figure, quantity.value):
            known = errors.get(quantity.name)
            error = _error(prefix, name, figure, known.get(key) if isinstance(known, Mapping) else known)
            attributes = {**_attributes(figure), **error}
            variable = joined(prefix, figure.called or name)
            variables[variable] = (_dims(prefix, figure.dims), _plain(value), attributes)
            if figure.called:
                older = {**attributes, "alias_of": variable}
                variables[joined(prefix, name)] = (*variables[variable][:2], older)
    data = xr.Dataset(variables)
    places = {joined(prefix, place) for place in PLACES}
    return data.set_coords([name for name in map(str, data.data_vars) if name in places])


def figure_of(
    name: str, unit: str, meaning: str, dims: str, value: Any, *, shown: str = "", no_error: str = ""
) -> Quantity:
    """Give a figure that stands in no record; arguments as of `base.quantity`."""
    return Quantity(name, Figure(unit, meaning, tuple(dims.split()), shown, no_error=no_error), value)


def of_list(prefix: str, axis: str, records: Sequence[object]) -> xr.Dataset:
    """Variables of single numbers of equal records, one entry a record, along a separate axis.

    Parameters
    ----------
    prefix, axis : str
    records : sequence of object
        At least one.
    """
    first = records[0]
    return of_quantities(
        prefix,
        (
            Quantity(
                name,
                replace(figure, dims=(axis,), no_error=why_no_error(first, name)),
                [getattr(record, name) for record in records],
            )
            for name, figure in figures(type(first)).items()
            if not figure.dims
        ),
    )


def of_models(
    prefix: str,
    records: Mapping[str, object],
    meaning: str,
    axis: str = "model",
    *,
    errors: Mapping[str, str] | None = None,
    no_error: str = "",
) -> xr.Dataset:
    """Variables of equal records beside each other, along an axis that names them.

    Parameters
    ----------
    prefix : str
    records : mapping
        Label to record; all have the same places.
    meaning : str
        Of the labels.
    axis : str
    errors : mapping, optional
        Figures to those that hold their errors, one for each record.
    no_error : str
        Why those have none that do not have it in all records.
    """
    import xarray as xr

    about = {"units": "", "long_name": meaning, "error_note": NAME}
    labels = xr.Variable((joined(prefix, axis),), np.array(list(records)), about)
    # arcs and events are as many as a model has
    own = [joined(prefix, axis) for axis in OWN]
    each = [of_record(prefix, record).drop_dims(own, errors="ignore") for record in records.values()]
    whole = xr.concat(each, dim=labels, data_vars="all", coords="minimal", compat="override", join="override")
    held = {joined(prefix, name): joined(prefix, error) for name, error in (errors or {}).items()}
    for name, variable in whole.data_vars.items():  # what the first one says is not what all say
        known = [
            dataset[name].attrs["error"]
            for dataset in each
            if name in dataset and "error" in dataset[name].attrs
        ]
        notes = {dataset[name].attrs.get("error_note") if name in dataset else None for dataset in each}
        for attribute in ("error", "error_variable", "error_note", "model_error"):
            variable.attrs.pop(attribute, None)
        if held.get(str(name)) in whole:
            variable.attrs["error_variable"] = held[str(name)]
        elif len(known) == len(each):
            variable.attrs["error"] = max(known)
        else:
            variable.attrs["error_note"] = (notes.pop() if len(notes) == 1 else None) or no_error
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
            about = {"units": "", "long_name": axis, "error_note": NAME}
            whole = whole.assign_coords({axis: (axis, np.array(labels), about)})
    return whole.assign_attrs(attributes)


def with_tolerance(data: xr.Dataset, tolerance: float) -> xr.Dataset:
    """Say of every variable that has an error whether this meets the tolerance, and of the dataset which one."""
    for name in map(str, data.variables):
        if (error := data.variables[name].attrs.get("error")) is not None:
            data.variables[name].attrs["tolerance_met"] = int(met(error, tolerance))
    return data.assign_attrs(tolerance=tolerance)


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


def _entries(name: str, figure: Figure, value: Any) -> Iterator[tuple[str, str, Figure, Any]]:
    """A figure, or each one of a mapping of them by its key, which stands after a colon in the meaning."""
    if not isinstance(value, Mapping):
        yield name, "", figure, value
        return
    for key, part in value.items():
        yield f"{name}_{identifier(key)}", key, replace(figure, meaning=f"{figure.meaning}: {key}"), part


def _errors(record: object, known: Mapping[str, Quantity]) -> dict[str, Any]:
    """Errors of a record's figures, where they are known."""
    errors: dict[str, Any] = {}
    for name, quantity in known.items():
        holds, error = held_error(record, name, quantity.figure)
        if isinstance(error, Mapping) and any(map(np.ndim, error.values())) and holds in known:
            error = {key: f"{holds}_{identifier(key)}" for key in error}
        if np.ndim(error) and holds in known:
            error = holds
        if isinstance(error, str) and error in known:
            error = known[error].figure.called or error
        if isinstance(error, str | Mapping | float):
            errors[name] = error
    return errors


def _finite(error: Any) -> bool:
    return isinstance(error, float | np.floating) and bool(np.isfinite(error))


def _error(prefix: str, name: str, figure: Figure, known: float | str | None) -> dict[str, float | str]:
    """What a variable says of its error."""
    if figure.unit == "":
        return {"error_note": NAME}
    if isinstance(known, str):
        return {"error_variable": joined(prefix, known)}
    if known is not None and _finite(known):
        return {"error": float(known)}
    why = PLACE if name in PLACES else figure.no_error or ("" if known is None else OPEN)
    return {"error_note": why} if why else {}


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
