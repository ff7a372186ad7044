import math
import warnings

import pytest

from base import InputError, RangeWarning
from ehl import (
    DEFINITIONS,
    OilLayer,
    solve,
    stiffness_table,
)
from tests.validation.article import PITCH

TOOTH = 5.6e8


@pytest.fixture(scope="module")
def film():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return solve(PITCH, tolerance=1e-3)


def test_every_definition_with_its_cost_to_the_mesh(film):
    rows = stiffness_table(film, 0.04, TOOTH)
    assert tuple(r.definition for r in rows) == DEFINITIONS
    by_name = {r.definition: r for r in rows}
    for name, row in by_name.items():
        assert row.stiffness == pytest.approx(0.04 * film.stiffness(name))
        # a spring in series: 1/k = 1/k_b + 1/k_f
        both = 1 / (1 / TOOTH + 1 / row.stiffness)
        assert row.loss == pytest.approx(1 - both / TOOTH, rel=1e-9)
        assert row.meaning
    # an independent study: the film costs this mesh 0.26 to 0.31 %
    assert 0.0025 < by_name["tangent"].loss < 0.0032
    assert 0.0025 < by_name["approach"].loss < 0.0032
    assert by_name["approach"].error == film.errors.approach_stiffness
    assert math.isnan(by_name["dowson-central"].error)


def test_without_bodies_there_is_no_loss(film):
    assert all(math.isnan(r.loss) for r in stiffness_table(film))


def test_formulas_do_not_hold_for_starved_contacts():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        starved = solve(PITCH, supply=OilLayer(0.2e-6))
        flooded = solve(PITCH, supply=OilLayer(1e-3))
    assert starved.starved
    assert not flooded.starved
    assert math.isnan(stiffness_table(starved)[3].stiffness)
    assert stiffness_table(flooded)[3].stiffness > 0


def test_bad_arguments(film):
    with pytest.raises(InputError) as caught:
        stiffness_table(film, -1.0, 0.0)
    assert len(caught.value.faults) == 2
