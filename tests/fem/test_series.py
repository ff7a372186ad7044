"""Series over a flank: polynomials and their derivatives are reproduced, units scale, roots follow the tip corner."""

from __future__ import annotations

import numpy as np
import pytest

from fem.influence.flank_variable import FlankVariable, RootVariable, stretched_points
from fem.influence.series import CrossSeries, FlankFit, FlankSeries, left_out

SPAN, END = (2.0, 4.7), 4.71
PLACE, ROOT = FlankVariable(SPAN), RootVariable(SPAN, END)
RHO = np.linspace(*SPAN, 8).reshape(2, 4)
POWERS = np.random.default_rng(5).normal(size=(6, 2, 3))
"""Coefficients of six powers, of a table (2, 3)."""


def value_of(variable, rho, derivative=0, powers=POWERS):
    """Polynomial in rho or in the root r of the distance from the corner (..., *value), differentiated by hand."""
    if variable is PLACE:
        for _ in range(derivative):
            powers = np.moveaxis(np.arange(1, len(powers)) * np.moveaxis(powers[1:], 0, -1), -1, 0)
        return np.tensordot(rho[..., None] ** np.arange(len(powers)), powers, 1)
    k, r = np.arange(len(powers)), np.sqrt(END - rho)[..., None]
    # r^k = d^(k/2), with d growing against rho
    factor = (1, -k / 2, k / 2 * (k / 2 - 1))[derivative]
    return np.tensordot(factor * r ** (k - 2 * derivative), powers, 1)


def series_of(variable, samples=6, degree=5, powers=POWERS):
    unit = stretched_points(samples)
    fit = FlankFit(variable, unit, degree)
    return FlankSeries(
        variable, np.tensordot(fit.weights, value_of(variable, variable.rho(unit), 0, powers), 1)
    )


@pytest.mark.parametrize("variable", [PLACE, ROOT])
@pytest.mark.parametrize(("samples", "degree"), [(6, 5), (9, 5), (9, 8), (14, 9)])
@pytest.mark.parametrize("derivative", [0, 1, 2])
@pytest.mark.parametrize("value", [np.s_[:, 0, 0], np.s_[:, 0], np.s_[:]])
def test_polynomials_and_their_derivatives_are_reproduced(variable, samples, degree, derivative, value):
    """By interpolation and by least squares; of scalars, vectors and tables."""
    powers = POWERS[value]
    series = series_of(variable, samples, degree, powers)
    wanted = value_of(variable, RHO, derivative, powers)
    computed = series.at(RHO, derivative)
    assert computed.shape == RHO.shape + powers.shape[1:]
    np.testing.assert_allclose(computed, wanted, rtol=0, atol=3e-11 * np.abs(wanted).max())
    alone = series.at(RHO[1, 2:3], derivative)
    np.testing.assert_allclose(alone, wanted[1, 2:3], rtol=0, atol=3e-11 * np.abs(wanted).max())


@pytest.mark.parametrize("variable", [PLACE, ROOT])
@pytest.mark.parametrize("samples", [6, 9])
def test_a_scalar_fit_passes_through_polynomials_and_leaves_out_the_rest(variable, samples):
    unit = stretched_points(samples)
    rho = variable.rho(unit)
    fit = FlankFit(variable, unit, 5)
    values = value_of(variable, rho, 0, POWERS[:, 0, 0])
    series = fit.series(values)
    assert fit.interpolates == (samples == 6)
    np.testing.assert_allclose(series.at(rho), values, rtol=1e-12)
    assert series.remainder(unit, values) < 1e-12 * np.abs(values).max()
    assert series.remainder(unit, values + np.eye(samples)[2]) == pytest.approx(1.0)


@pytest.mark.parametrize("variable", [PLACE, ROOT])
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_places_beyond_the_span_are_moved_to_its_end(variable, derivative):
    series = series_of(variable)
    low, high = SPAN
    beyond = series.at(np.array([low - 1.0, high + 0.005, END + 0.1]), derivative)
    np.testing.assert_allclose(beyond, series.at(np.array([low, high, high]), derivative), rtol=1e-9)
    np.testing.assert_array_equal(variable.held(np.array([0.0, 3.0, 9.0])), [low, 3.0, high])


@pytest.mark.parametrize("variable", [PLACE, ROOT])
def test_arguments_run_from_end_to_end_and_back(variable):
    unit = stretched_points(7)
    assert (unit[0], unit[-1]) == pytest.approx((1.0, -1.0), abs=1e-15)
    np.testing.assert_allclose(variable.unit(variable.rho(unit)), unit, rtol=0, atol=1e-13)
    ends = variable.unit(np.array(SPAN))
    np.testing.assert_allclose(ends, [-1.0, 1.0] if variable is PLACE else [1.0, -1.0], rtol=0, atol=1e-14)


@pytest.mark.parametrize("variable", [PLACE, ROOT])
@pytest.mark.parametrize("divisor", [206e9, np.array([1.0, 3.0, 7.0])])
def test_size_and_modulus_scale_values_and_derivatives(variable, divisor):
    """Values by the divisor alone, derivatives by the length too."""
    length, series = 3.3e-3, series_of(variable)
    scaled = series.scaled(length, divisor)
    assert scaled.variable.span == (length * SPAN[0], length * SPAN[1])
    for derivative in range(3):
        wanted = series.at(RHO, derivative) / (divisor * length**derivative)
        np.testing.assert_allclose(scaled.at(length * RHO, derivative), wanted, rtol=1e-9)


def cross_of(powers):
    """Series of the polynomial sum p_kl rho^k rho'^l from its samples."""
    unit = stretched_points(9)
    rho = PLACE.rho(unit)
    fit, samples = FlankFit(PLACE, unit, 5), cross_value(powers, rho[:, None], rho)
    return fit.cross(samples), unit, samples


def cross_value(powers, load, point):
    return np.polynomial.polynomial.polyval2d(*np.broadcast_arrays(load, point), powers)


def test_cross_series_reproduce_polynomials_of_load_and_point():
    """The load's place first; their slope is that as both move on together."""
    powers = np.random.default_rng(8).normal(size=(4, 5))
    series, unit, samples = cross_of(powers)
    assert series.remainder(unit, samples) < 1e-12 * np.abs(samples).max()
    load, point = RHO, SPAN[0] + (RHO - SPAN[0]) ** 2 / 3
    np.testing.assert_allclose(series.at(load, point), cross_value(powers, load, point), rtol=1e-10)
    by_load = np.polynomial.polynomial.polyder(powers, axis=0)
    by_point = np.polynomial.polynomial.polyder(powers, axis=1)
    slope = cross_value(by_load, load, point) + cross_value(by_point, load, point)
    np.testing.assert_allclose(series.slope(load, point), slope, rtol=1e-9)
    scaled = series.scaled(2e-3, 70e9)
    np.testing.assert_allclose(scaled.slope(2e-3 * load, 2e-3 * point) * 2e-3 * 70e9, slope, rtol=1e-9)


def test_a_table_in_two_places_is_each_of_its_entries():
    tables = np.random.default_rng(2).normal(size=(5, 5, 3, 2))
    table = CrossSeries(PLACE, tables).at(RHO, RHO[::-1])
    assert table.shape == (*RHO.shape, 3, 2)
    for i, j in np.ndindex(3, 2):
        alone = CrossSeries(PLACE, tables[:, :, i, j]).at(RHO, RHO[::-1])
        np.testing.assert_allclose(table[..., i, j], alone, rtol=0, atol=1e-13 * np.abs(tables).max() * 25)


def test_the_root_follows_what_begins_at_the_corner():
    """d ln d close beyond the span: 18 terms in the root leave out a hundredth of what they do in rho."""
    rho = np.linspace(*SPAN, 400)
    off = []
    for variable in (PLACE, ROOT):
        unit = stretched_points(18)
        places = variable.rho(unit)
        series = FlankFit(variable, unit, 17).series((END - places) * np.log(END - places))
        off.append(np.abs(series.at(rho) - (END - rho) * np.log(END - rho)).max())
        assert series.tail() > 0.3 * off[-1]
    assert off[1] < 0.01 * off[0]


def test_tail_and_size_of_known_series():
    falling = FlankSeries(PLACE, 0.5 ** np.arange(15))
    assert falling.size() == pytest.approx(2.0 - 0.5**14)  # all terms are largest at x = 1
    assert falling.tail() == pytest.approx(2 * 0.5**12)
    upper = falling.upper_half().coefficients
    np.testing.assert_array_equal(upper, np.where(np.arange(15) > 7.5, falling.coefficients, 0.0))
    both = CrossSeries(PLACE, np.ones((4, 4)))
    np.testing.assert_array_equal(both.upper_half().coefficients, np.maximum(*np.indices((4, 4))) > 2)
    assert both.size() == pytest.approx(16.0)
    assert both.plus(np.full((4, 4), 2.0)).size() == pytest.approx(48.0)


@pytest.mark.parametrize(("samples", "most"), [(12, 40.0), (18, 3.0)])
def test_a_fit_tells_what_it_leaves_out_of_every_value(samples, most):
    """By the decay of its terms where it passes through all samples, else by their distance."""
    unit, rho = stretched_points(samples), np.linspace(*SPAN, 300)
    fit, place = FlankFit(PLACE, unit, 11), PLACE.unit(rho)
    samples_of = np.stack([1.0 / (unit + 2.5), 3.0 / (unit + 1.7)], axis=1)
    series = FlankSeries(PLACE, fit.weights @ samples_of)
    off = np.abs(series.at(rho) - np.stack([1.0 / (place + 2.5), 3.0 / (place + 1.7)], axis=1)).max(axis=0)
    error = fit.error(series, samples_of)
    assert error.shape == (2,)
    assert np.all(error > 0.7 * off)
    assert np.all(error < most * off)


def test_what_fits_leave_out_has_the_largest_size_of_all_teeth_and_the_shape_of_the_upper_half():
    falling = FlankSeries(PLACE, np.stack([0.5 ** np.arange(15), 0.3 ** np.arange(15)], axis=1))
    out = left_out({0: falling, 1: falling.scaled(1.0, 4.0)}, np.array([1.0, 2.0]))
    np.testing.assert_allclose(out[0].size(), [1.0, 2.0])
    np.testing.assert_allclose(out[1].size(), [0.25, 0.5])
    assert not out[0].coefficients[:8].any()
    assert not left_out({0: FlankSeries(PLACE, np.ones(1))}, 1.0)[0].coefficients.any()
