import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import InputError, RangeWarning
from ehl import Meniscus, OilLayer, solve, solve_path
from tests.ehl.films import quiet, sound
from tests.validation.article import OIL, PITCH

B = PITCH.half_width


FLOODED = quiet(PITCH)


def test_a_far_meniscus_and_a_thick_layer_leave_the_contact_flooded():
    far = sound(quiet(PITCH, supply=Meniscus(-200 * B), nodes=257))
    open_inlet = sound(quiet(PITCH, nodes=257))
    assert far.central_thickness == pytest.approx(open_inlet.central_thickness, rel=1e-4)
    assert far.minimum_thickness == pytest.approx(open_inlet.minimum_thickness, rel=far.error)
    thick = sound(quiet(PITCH, supply=OilLayer(1e-3)))
    assert thick.central_thickness == FLOODED.central_thickness
    assert thick.stiffness() == FLOODED.stiffness()
    # no step where the layer begins to starve the contact
    share = 1.0 - 1.1 * FLOODED.error
    nearly = sound(quiet(PITCH, supply=OilLayer(share * FLOODED.flow)))
    assert nearly.central_thickness == pytest.approx(share * FLOODED.central_thickness, rel=2e-3)


@pytest.mark.parametrize("share", [0.99, 0.8, 0.5, 0.14, 0.02])
def test_the_film_carries_what_the_layer_brings(share):
    layer = share * FLOODED.flow
    film = sound(quiet(PITCH, supply=OilLayer(layer)))
    assert film.flow == pytest.approx(layer, rel=1e-9)
    density = OIL.density_ratio(np.interp(0.0, film.x, film.pressure))[0]
    # inside the contact hardly any oil flows under pressure: rho h = h_oil
    assert film.central_thickness * density == pytest.approx(layer, rel=2e-3)
    assert film.inlet < -B
    # the same contact with that meniscus held is the same film
    held = sound(quiet(PITCH, supply=Meniscus(film.inlet)))
    # a meniscus close to the edge sits on an error of the grid that the films do not feel
    loose = 5e-3 if share > 0.1 else 3e-2
    assert held.flow == pytest.approx(layer, rel=loose)
    assert held.central_thickness == pytest.approx(film.central_thickness, rel=loose)


@pytest.mark.parametrize("nodes", [65, 129, 257])
def test_thin_films_of_the_middle_are_those_of_the_nodes(nodes):
    """Between the nodes straight pressures leave bumps that a film of 3e-4 of the flattening would drown in."""
    film = quiet(PITCH, supply=OilLayer(0.01 * FLOODED.flow), nodes=nodes)
    fine = quiet(PITCH, supply=OilLayer(0.01 * FLOODED.flow), nodes=513)
    assert film.central_thickness == pytest.approx(fine.central_thickness, rel=1e-4)
    assert film.central_thickness > (1.0 - 1e-5) * film.minimum_thickness


def test_film_and_meniscus_rise_with_the_supply():
    films = [sound(quiet(PITCH, supply=Meniscus(X * B))) for X in (-1.01, -1.03, -1.1, -1.3, -2.0, -4.0)]
    assert (np.diff([f.central_thickness for f in films]) > 0).all()
    films = [sound(quiet(PITCH, supply=OilLayer(s * FLOODED.flow))) for s in (0.05, 0.2, 0.5, 0.9)]
    assert (np.diff([f.inlet for f in films]) < 0).all()


@pytest.mark.parametrize("load", [PITCH.load, 0.1 * PITCH.load])
@pytest.mark.parametrize("X", [-1.03, -1.2, -2.0])
def test_stiffness_with_the_meniscus_held(X, load):
    contact = replace(PITCH, load=load)
    supply, step = Meniscus(X * contact.half_width), 2e-3
    film = quiet(contact, nodes=257, supply=supply)
    light, heavy = (
        quiet(replace(contact, load=load * f), nodes=257, supply=supply) for f in (1 - step, 1 + step)
    )
    change = 2 * step * load
    by_difference = -change / (heavy.separation - light.separation)
    assert film.stiffness("approach") == pytest.approx(by_difference, rel=5e-3)
    by_difference = -change / (heavy.central_thickness - light.central_thickness)
    assert film.stiffness("tangent") == pytest.approx(by_difference, rel=5e-3)


@pytest.mark.parametrize("share", [0.05, 0.2, 0.5])
def test_stiffness_with_the_layer_held(share):
    supply, step = OilLayer(share * FLOODED.flow), 0.05
    film = quiet(PITCH, nodes=513, supply=supply)
    light, heavy = (
        quiet(replace(PITCH, load=PITCH.load * f), nodes=513, supply=supply) for f in (1 - step, 1 + step)
    )
    change = 2 * step * PITCH.load
    # the film hardly yields, hundredths of a flooded one: errors of the grid count as much more of it
    by_difference = -change / (heavy.separation - light.separation)
    assert film.stiffness("approach") == pytest.approx(by_difference, rel=1e-2)
    by_difference = -change / (heavy.central_thickness - light.central_thickness)
    assert film.stiffness("tangent") == pytest.approx(by_difference, rel=5e-3)


def test_a_held_layer_is_stiff_and_a_held_meniscus_is_soft():
    share = 0.14
    layer = quiet(PITCH, supply=OilLayer(share * FLOODED.flow))
    meniscus = quiet(PITCH, supply=Meniscus(layer.inlet))
    assert meniscus.central_thickness == pytest.approx(layer.central_thickness, rel=5e-3)
    for definition in ("approach", "tangent"):
        assert meniscus.stiffness(definition) < 0.1 * FLOODED.stiffness(definition)
        assert layer.stiffness(definition) > 20 * FLOODED.stiffness(definition)
    # a layer leaves only the oil's compressibility to yield: -d ln h/d ln w = d ln rho/d ln w, p ~ w^1/2
    p = np.interp(0.0, layer.x, layer.pressure)
    density, slope = OIL.density_ratio(p)
    expected = PITCH.load / (layer.central_thickness * 0.5 * p * slope / density)
    assert layer.stiffness("tangent") == pytest.approx(expected, rel=0.05)


def test_a_path_with_a_supply():
    loads = PITCH.load * np.array([0.5, 0.5, 1.0, 1.0, 0.5])
    contacts = [replace(PITCH, load=w) for w in loads]
    for supply in (Meniscus(-1.3 * B), OilLayer(0.3e-6)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            films = solve_path(contacts, supply=supply)
        for film, contact in zip(films, contacts, strict=True):
            alone = quiet(contact, supply=supply)
            assert sound(film).central_thickness == pytest.approx(alone.central_thickness, rel=5e-3)
            assert film.supply == supply


def test_a_starved_neighbour_saves_the_flooded_film():
    """The flooded film tells whether a layer is thick enough; where a neighbour's says so no other is solved."""
    layer = OilLayer(0.3 * FLOODED.flow)
    before = quiet(replace(PITCH, load=0.97 * PITCH.load), supply=layer)
    near, alone = quiet(PITCH, supply=layer, start=before), quiet(PITCH, supply=layer)
    assert near.cost.iterations < alone.cost.iterations - FLOODED.cost.iterations
    assert near.flow == pytest.approx(layer.thickness, rel=1e-9)
    assert near.central_thickness == pytest.approx(alone.central_thickness, rel=alone.error)
    meniscus = Meniscus(-1.1 * B)
    near = quiet(PITCH, supply=meniscus, start=quiet(PITCH, supply=Meniscus(-1.11 * B)))
    assert near.cost.iterations < FLOODED.cost.iterations


def test_a_layer_as_thick_as_wanted_is_flooded_whatever_the_start_was(monkeypatch):
    before = quiet(PITCH, supply=OilLayer(0.3 * FLOODED.flow))
    thick = OilLayer(1.02 * FLOODED.flow)
    assert "flooded" in quiet(PITCH, supply=thick, start=before).message
    # even where the flow expected from the neighbour's is far too large
    monkeypatch.setattr("ehl.films.supplied._SURELY", 2.0)
    film = sound(quiet(PITCH, supply=thick, start=before))
    assert "flooded" in film.message
    assert film.central_thickness == pytest.approx(FLOODED.central_thickness, rel=2 * FLOODED.error)


def test_fill():
    film = quiet(PITCH, supply=OilLayer(0.3e-6))
    assert (film.fill > 0).all()
    assert (film.fill <= 1).all()
    assert (film.fill[film.pressure > 0] == 1).all()
    assert film.fill[-1] < 0.5


def test_bad_supplies():
    for make in (lambda: Meniscus(0.1), lambda: OilLayer(-1e-6), lambda: OilLayer(float("nan"))):
        with pytest.raises(InputError, match="supply"):
            make()
    with pytest.raises(InputError, match="edge of the dry contact"):
        solve(PITCH, supply=Meniscus(-0.9 * B))
    with pytest.raises(InputError, match="without domain"):
        solve(PITCH, supply=OilLayer(1e-7), domain=(-4, 1.5))
    with pytest.raises(InputError, match="what is held"):
        solve(PITCH, supply=1e-7)
