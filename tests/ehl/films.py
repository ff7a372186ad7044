"""Films for tests: solved without the warnings of contacts beyond their oil's range, and what each must fulfil."""

from __future__ import annotations

import warnings
from typing import Any

from base import RangeWarning
from ehl import Film, LineContact, solve


def quiet(contact: LineContact, **options: Any) -> Film:
    """Solve a contact whatever its pressure."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return solve(contact, **options)


def sound(film: Film) -> Film:
    """Hold a film to what every solution has to fulfil, whatever the contact."""
    assert film.converged, f"{film.contact} with {film.supply}: {film.message}"
    assert film.load_error < 1e-12, film.contact
    assert film.flux_error < 1e-8, film.contact
    assert (film.pressure >= 0).all()
    assert (film.thickness > 0).all()
    assert film.minimum_thickness > 0
    return film
