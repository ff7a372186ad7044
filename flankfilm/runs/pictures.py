"""Pictures that ``plot()`` of a run and of its records draws: the first of the product that knows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import InputError
from flankfilm import figures
from flankfilm.figures.reading import drawable
from flankfilm.figures.records import dataset
from flankfilm.products.catalogue import PRODUCTS

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from flankfilm.outcome.results import Results

__all__ = ["first", "record", "results"]


def first(data: xr.Dataset) -> str:
    """Name of the first picture of the last product, in the order of the report, that has one of the data.

    Parameters
    ----------
    data : xarray.Dataset
        Of a run, or of one of its records.

    Returns
    -------
    str
        One of `flankfilm.figures`; empty where no product has one.

    Examples
    --------
    >>> import xarray as xr
    >>> first(xr.Dataset({"dry_secant_stiffness": 1.0, "film_central_thickness": 1e-6}))
    'film_along_path'
    """
    shown = (name for product in reversed(PRODUCTS) for name in drawable(product.pictures, data))
    return next(shown, "")


def results(run: Results) -> Figure:
    """Draw what a run went furthest for: stiffness rather than teeth, films rather than stiffness, motion at last."""
    if name := first(run.dataset):
        return _draw(name, run.dataset)
    raise InputError.at(
        "Results.plot", run.title, "has nothing to draw", "The scene's wants decide what is computed"
    )


def record(result: object) -> Figure:
    """Draw a record of a product alone, as a run's report does."""
    data = dataset(result)
    return _draw(first(data), data)


def _draw(name: str, data: xr.Dataset) -> Figure:
    drawn: Figure = getattr(figures, name)(data)
    return drawn
