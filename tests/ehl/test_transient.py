"""A film over time: steady limits, order in time, answer to a small oscillation, fast ramps, refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from ehl import LineContact, Lubricant, Meniscus, OilLayer, film_response, solve_transient
from tests.ehl.films import quiet
from tests.validation.article import PITCH

OIL = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
CONTACT = LineContact(load=1e5, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=OIL)
UNIT = CONTACT.half_width / CONTACT.entrainment  # b/u
LOAD = CONTACT.load


def smooth(times: float, change: float):
    """Load that changes by a share of itself along half a cosine, in so many b/u."""

    def load(t: float) -> float:
        way = min(max(t / (times * UNIT), 0.0), 1.0)
        return LOAD * (1.0 + change * 0.5 * (1.0 - math.cos(math.pi * way)))

    return load


def test_a_steady_load_leaves_the_film_as_it_is():
    film = solve_transient(CONTACT, lambda _: LOAD, [0.0, UNIT, 5 * UNIT], nodes=65)
    steady = quiet(CONTACT, nodes=65)
    assert film.least == pytest.approx(np.full(3, steady.minimum_thickness), rel=1e-8)
    assert film.separation == pytest.approx(np.full(3, steady.separation), rel=1e-8)
    assert film.thickness[-1] == pytest.approx(steady.thickness, rel=1e-8)
    assert film.time_error < 1e-8


@pytest.mark.parametrize("change", [1.0, -0.6])
def test_after_a_ramp_stands_the_steady_film_of_the_new_load(change):
    film = solve_transient(CONTACT, smooth(2.0, change), [0.0, 2 * UNIT, 20 * UNIT], nodes=65)
    new = quiet(replace(CONTACT, load=(1.0 + change) * LOAD), nodes=65)
    assert film.balance < 1e-7
    for name, value in (
        ("least", new.minimum_thickness),
        ("central", new.central_thickness),
        ("separation", new.separation),
    ):
        assert getattr(film, name)[-1] == pytest.approx(value, rel=1e-4), name


def test_speed_and_radius_may_change_too():
    later = replace(CONTACT, load=1.3 * LOAD, entrainment=1.2, radius=0.017)
    ramp = np.array([0.0, 2 * UNIT, 20 * UNIT])

    def over(first, last):
        return lambda t: first + (last - first) * min(t / (2 * UNIT), 1.0)

    film = solve_transient(
        CONTACT,
        over(LOAD, later.load),
        ramp,
        entrainment=[CONTACT.entrainment, later.entrainment, later.entrainment],
        radius=over(CONTACT.radius, later.radius),
        nodes=65,
    )
    new = quiet(later, nodes=65)
    assert film.least[-1] == pytest.approx(
        new.minimum_thickness, rel=1e-3
    )  # its plan was laid for another film
    assert film.central[-1] == pytest.approx(new.central_thickness, rel=1e-3)


@pytest.mark.slow
def test_steps_of_time_are_of_second_order():
    times = np.linspace(0.0, 3.0, 4) * UNIT
    found = [
        solve_transient(CONTACT, smooth(2.0, 0.5), times, nodes=65, step=UNIT / n) for n in (16, 32, 64, 256)
    ]
    off = [np.abs(one.separation - found[-1].separation)[1:].max() for one in found[:-1]]
    orders = np.log2(np.array(off[:-1]) / np.array(off[1:]))
    assert (orders > 1.7).all(), orders
    assert (orders < 2.6).all(), orders
    # the estimate is of what is there: the film's largest error in time lies below it, not far below
    true = np.abs(found[0].central / found[-1].central - 1.0).max()
    assert 0.1 * found[0].time_error < true < 2.0 * found[0].time_error


@pytest.mark.slow
@pytest.mark.parametrize("rate", [0.3, 1.0, 3.0])
def test_a_small_oscillation_is_that_of_the_linear_answer(rate):
    omega, share = rate / UNIT, 1e-3
    periods = 3 if rate < 1.0 else 6
    turn = 2.0 * math.pi / omega
    times = np.concatenate([[0.0], turn * (periods - 1 + np.arange(32) / 32), [turn * periods]])
    film = solve_transient(
        CONTACT, lambda t: LOAD * (1.0 + share * math.sin(omega * t)), times, nodes=129, step=turn / 128
    )
    wave = np.exp(-1j * omega * times[1:-1])
    answer = film_response(quiet(CONTACT, nodes=129), omega)
    for values, expected in (
        (film.separation, answer.compliance),
        (film.central, answer.central_compliance),
    ):
        found = 2.0 * np.mean((values[1:-1] - values[1:-1].mean()) * wave) / (-1j * share * LOAD)
        assert -found == pytest.approx(complex(expected), rel=0.01)


def test_the_film_waves_and_is_thinner_than_either_steady_film():
    unit = PITCH.half_width / PITCH.entrainment
    lowest = []
    for times in (2.0, 4.0):

        def load(t, times=times):
            return PITCH.load * (0.75 + 0.25 * math.cos(math.pi * min(t / (times * unit), 1.0)))

        with pytest.warns(UserWarning, match="GPa"):
            film = solve_transient(PITCH, load, np.linspace(0.0, 6.0 * unit, 7), nodes=129)
        lowest.append(1.0 - film.lowest / film.least[0])
    assert lowest[0] == pytest.approx(0.07, abs=0.01)
    assert lowest[1] == pytest.approx(0.014, abs=0.005)


def test_a_ramp_faster_than_oil_is_solved():
    # the end of the contact runs ahead of the oil: what stands there is cavity, filled in part
    film = solve_transient(CONTACT, smooth(0.1, 1.0), [0.0, 0.1 * UNIT, 15 * UNIT], nodes=65)
    assert film.converged, film.message
    assert film.balance < 1e-6
    new = quiet(replace(CONTACT, load=2 * LOAD), nodes=65)
    assert film.least[-1] == pytest.approx(new.minimum_thickness, rel=1e-4)
    assert film.central[1] > new.central_thickness


def test_a_meniscus_stays_where_it_is():
    held = Meniscus(-1.6 * CONTACT.half_width)
    film = solve_transient(CONTACT, smooth(2.0, 0.5), [0.0, 2 * UNIT, 20 * UNIT], nodes=65, supply=held)
    new = quiet(replace(CONTACT, load=1.5 * LOAD), nodes=65, supply=held)
    assert film.x[:, 0] == pytest.approx(np.full(3, held.position), rel=1e-9)
    assert film.least[-1] == pytest.approx(new.minimum_thickness, rel=5e-3)


def test_values_at_times_are_linear_between_them():
    times = np.array([0.0, UNIT, 3 * UNIT])
    by_values = solve_transient(CONTACT, [LOAD, 1.2 * LOAD, 1.2 * LOAD], times, nodes=65, step=UNIT / 8)
    by_function = solve_transient(
        CONTACT, lambda t: LOAD * (1 + 0.2 * min(t / UNIT, 1.0)), times, nodes=65, step=UNIT / 8
    )
    assert by_values.least == pytest.approx(by_function.least, rel=1e-9)


@pytest.mark.parametrize("values", [False, True])
def test_a_jump_is_refused_with_the_reason(values):
    def load(t):
        return LOAD if t < UNIT else 2 * LOAD

    times = [0.0, UNIT, UNIT * (1 + 1e-6), 2 * UNIT]
    given = [LOAD, LOAD, 2 * LOAD, 2 * LOAD] if values else load
    with pytest.raises(InputError, match=r"(?s)must not jump.*Ramp it"):
        solve_transient(CONTACT, given, times, nodes=65)


def test_faults_are_named_together():
    with pytest.raises(InputError, match="turns round") as raised:
        solve_transient(
            CONTACT, lambda t: -1.0, [0.0, 1.0], entrainment=[1.0, -1.0], tolerance=2.0, supply=OilLayer(1e-7)
        )
    text = str(raised.value)
    for word in ("load", "tolerance", "entrainment", "supply"):
        assert word in text
    for times in ([0.0], [1.0, 0.0], "soon"):
        with pytest.raises(InputError, match="increasing"):
            solve_transient(CONTACT, lambda t: LOAD, times)
    with pytest.raises(InputError, match="one value for each"):
        solve_transient(CONTACT, [LOAD], [0.0, 1.0])
    with pytest.raises(InputError, match=r"load at t = "):
        solve_transient(CONTACT, lambda t: LOAD * (1 - 2 * (0.2 < t / UNIT < 0.8)), [0.0, UNIT], nodes=65)


def test_an_unmet_tolerance_keeps_the_film_with_its_error():
    film = solve_transient(CONTACT, smooth(1.0, 1.0), [0.0, UNIT], tolerance=1e-5)
    assert film.converged
    assert film.error > 1e-5
    usual = solve_transient(CONTACT, smooth(1.0, 1.0), [0.0, UNIT], tolerance=0.01)
    assert film.least == pytest.approx(usual.least, rel=usual.error)
    assert "above the tolerance of 1e-05" in film.message


def test_the_error_of_the_greatest_pressure_covers_a_spike_narrower_than_its_cells():
    """A load that doubles within b/u: its spike grows with every halving of the cells."""
    contact = LineContact(2e5, 2.0, 0.012, 2.2e11, Lubricant(0.05, 18e-9))
    unit = contact.half_width / contact.entrainment
    times = np.linspace(0.0, 4 * unit, 9)

    def on(nodes, load):
        return solve_transient(contact, load, times, nodes=nodes)

    coarse, fine = (on(n, lambda t: contact.load * (0.5 + 0.5 * min(t / unit, 1))) for n in (65, 257))
    grown = fine.greatest_pressure.max() / coarse.greatest_pressure.max() - 1
    assert 0.1 < grown < coarse.pressure_error
    assert fine.pressure_error > 0.5
    spikeless = LineContact.from_moes(2.0, 1.0)
    still = solve_transient(spikeless, lambda _: spikeless.load, times, nodes=129)
    assert still.pressure_error < 0.01


def test_the_work_on_the_surfaces_is_what_the_oil_dissipates():
    """Over a period of an oscillation: u int h p' dx of rolling and -w ds of squeezing are int h^3 p'^2/(12 eta) dx."""
    oil = Lubricant(viscosity=0.3, pressure_viscosity=12e-9, density=910.0)
    contact = LineContact(load=3e3, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=oil)
    u, b = contact.entrainment, contact.half_width
    period = 2.0 * math.pi * b / u
    times = np.linspace(0.0, 3.0 * period, 145)
    film = solve_transient(
        contact,
        lambda t: 3e3 * (1.0 + 0.6 * math.sin(2.0 * math.pi * t / period)),
        times,
        tolerance=0.003,
        nodes=65,
        supply=Meniscus(-6.0 * b),
    )
    assert film.converged
    powers = []
    for x, p, h in zip(film.x[96:], film.pressure[96:], film.thickness[96:], strict=True):
        slope, middle = np.diff(p) / np.diff(x), 0.5 * (h[1:] + h[:-1])
        cubed = (h[1:] ** 3 + 4.0 * middle**3 + h[:-1] ** 3) / 6.0
        viscosity = oil.viscosity * np.exp(oil.log_viscosity(0.5 * (p[1:] + p[:-1]))[0])
        dissipated = cubed * slope**2 / (12.0 * viscosity)
        powers.append([np.diff(x) @ (u * middle * slope), np.diff(x) @ dissipated])
    rolling, dissipation = np.trapezoid(np.array(powers).T, times[96:])
    load = film.load[96:]
    squeezing = -0.5 * (load[1:] + load[:-1]) @ np.diff(film.separation[96:])
    assert squeezing > 0.08 * dissipation
    assert rolling + squeezing == pytest.approx(dissipation, rel=5e-3)
