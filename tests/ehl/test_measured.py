"""Oils by tables: Roelands' oil from its own table, slopes, ranges, files, faults."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from base import InputError, RangeWarning
from ehl import LineContact, Lubricant, MeasuredViscosity, solve, solve_thermal

OIL = Lubricant(0.02, 17e-9, 860.0, temperature=353.15, viscosity_slope=0.036, eyring_stress=6e6)
PRESSURES = (0.0, 1e8, 3e8, 6e8, 1e9, 1.5e9)
TEMPERATURES = (313.15, 333.15, 353.15, 393.15, 453.15)


def table_of(
    oil: Lubricant, bend: float = 0.0, pressures=PRESSURES, temperatures=TEMPERATURES
) -> MeasuredViscosity:
    """Table of an oil, bent off Roelands' law under pressure."""
    p, T = np.array(pressures)[:, None], np.array(temperatures)[None, :]
    ln = oil.hot_log_viscosity(p, T)[0] * (1.0 + bend * p / 1e9)
    rows = oil.viscosity * np.exp(ln)
    return MeasuredViscosity(pressures, temperatures, tuple(map(tuple, rows.tolist())), at=353.15)


@pytest.mark.parametrize(
    ("pressures", "temperatures"),
    [
        (PRESSURES, TEMPERATURES),
        ((0.0, 1.5e9), (313.15, 453.15)),
        (PRESSURES[:3], TEMPERATURES[1:4]),
    ],
)
def test_a_table_of_roelands_law_is_roelands_law(pressures, temperatures):
    oil = Lubricant.measured(table_of(OIL, pressures=pressures, temperatures=temperatures))
    assert oil.viscosity == pytest.approx(OIL.viscosity, rel=1e-12)
    assert oil.pressure_viscosity == pytest.approx(OIL.pressure_viscosity, rel=1e-9)
    assert oil.viscosity_slope == pytest.approx(OIL.viscosity_slope, rel=1e-9)
    p, T = np.array([[0.0], [2.5e8], [2.9e8]]), np.array([[335.0, 353.15, 390.0]])
    for ours, exact in zip(oil.hot_log_viscosity(p, T), OIL.hot_log_viscosity(p, T), strict=True):
        np.testing.assert_allclose(ours, exact, rtol=1e-9, atol=1e-9)


def test_values_are_met_and_slopes_are_those_of_the_values():
    table = table_of(OIL, bend=0.1)
    for p, row in zip(table.pressure, table.viscosity, strict=True):
        for T, value in zip(table.temperature, row, strict=True):
            assert table.viscosity_at(p, T) == pytest.approx(value, rel=1e-10)
    p, T = np.array([1e7, 4.5e8, 1.2e9, 1.8e9]), np.array([320.0, 360.0, 440.0, 470.0])  # the last outside
    found = table.read(p, T)
    for step, slope, name in ((1e3, found.by_pressure, "p"), (1e-4, found.by_temperature, "T")):
        low, high = (
            table.read(p + s * (name == "p"), T + s * (name == "T")).ln_viscosity for s in (-step, step)
        )
        np.testing.assert_allclose(slope, (high - low) / (2 * step), rtol=1e-5)


def test_films_of_a_table_are_those_of_its_law():
    contact = LineContact(2e5, 2.5, 0.012, 2.26e11, OIL, sliding=0.5)
    measured = LineContact(
        2e5, 2.5, 0.012, 2.26e11, Lubricant.measured(table_of(OIL), 860.0, eyring_stress=6e6), sliding=0.5
    )
    for method in (solve, solve_thermal):
        film, other = method(contact), method(measured)
        assert other.central_thickness == pytest.approx(film.central_thickness, rel=film.error)
    assert other.traction_coefficient == pytest.approx(film.traction_coefficient, rel=film.traction_error)
    warm, same = (solve_thermal(one, bulk_temperatures=(373.15, 363.15)) for one in (contact, measured))
    assert same.minimum_thickness == pytest.approx(warm.minimum_thickness, rel=warm.error)


def test_what_lies_outside_the_table_is_refused_or_warned_of():
    oil = Lubricant.measured(
        table_of(OIL, pressures=PRESSURES[:4], temperatures=TEMPERATURES[:4]), 860.0, eyring_stress=6e6
    )
    heavy = LineContact(4e5, 2.5, 0.012, 2.26e11, oil)
    for method in (solve, solve_thermal):
        with pytest.raises(InputError, match="where the oil's table ends"):
            method(heavy)
    light = LineContact(5e4, 2.5, 0.012, 2.26e11, oil, sliding=1.0)
    with pytest.raises(InputError, match="must lie in the oil's table"):
        solve_thermal(light, bulk_temperatures=(420.0, 353.15))
    with pytest.raises(InputError, match="must lie in the table"):
        oil.at_temperature(300.0)
    hot = LineContact(1e5, 2.5, 0.012, 2.26e11, oil, sliding=4.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        solve_thermal(hot, bulk_temperatures=(392.0, 392.0))
    assert any("leaves its table" in str(one.message) for one in caught if one.category is RangeWarning)


def test_files(tmp_path):
    table = table_of(OIL, bend=0.1)
    lines = [
        f"{p / 1e6!r},{T - 273.15!r},{value!r}"
        for p, row in zip(table.pressure, table.viscosity, strict=True)
        for T, value in zip(table.temperature, row, strict=True)
    ]
    file = tmp_path / "oil.csv"
    file.write_text("\n".join(["pressure_MPa,temperature_C,viscosity_Pa_s", *lines[::-1]]), encoding="utf-8")
    read = MeasuredViscosity.from_csv(file, at=353.15)
    assert read.viscosity_at(4e8, 350.0) == pytest.approx(table.viscosity_at(4e8, 350.0), rel=1e-9)
    file.write_text("\n".join(["pressure_MPa,temperature_C,viscosity_Pa_s", *lines[1:]]), encoding="utf-8")
    with pytest.raises(InputError, match="a line for each pressure at each temperature"):
        MeasuredViscosity.from_csv(file)


def test_faults_of_a_table():
    rows = ((0.1, 0.02), (20.0, 1.5))
    for pressures, temperatures, values, words in (
        ((0.0, 0.0), (313.15, 353.15), rows, "increasing"),
        ((0.0, 5e8), (313.15,), rows, "two or more"),
        ((0.0, 5e8), (313.15, 353.15), (*rows, (1.0, 2.0)), "2 rows"),
        ((0.0, 5e8), (313.15, 353.15), rows[::-1], "must rise with every pressure"),
        ((1e8, 5e8), (313.15, 353.15), rows, "ambient"),
        ((0.0, 5e8), (313.15, 353.15), ((0.1, -1.0), (20.0, 1.5)), "viscosity"),
    ):
        with pytest.raises(InputError, match=words):
            MeasuredViscosity(pressures, temperatures, values)
    with pytest.raises(InputError, match="must lie in the table"):
        MeasuredViscosity((0.0, 5e8), (313.15, 353.15), rows, at=400.0)
