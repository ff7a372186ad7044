import math
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from base import InputError
from ehl import LineContact, Lubricant
from tests.validation.article import SECTION_2


def test_hertz_figures():
    assert SECTION_2.peak_pressure == pytest.approx(
        SECTION_2.reduced_modulus * SECTION_2.half_width / (4 * SECTION_2.radius), rel=1e-14
    )
    assert SECTION_2.peak_pressure == pytest.approx(0.483e9, rel=2e-3)


def test_moes_numbers_of_the_example():
    assert SECTION_2.moes_M == pytest.approx(5.025, rel=1e-3)
    assert SECTION_2.moes_L == pytest.approx(12.21, rel=1e-3)


@given(st.floats(0.01, 5000), st.floats(0.1, 25), st.floats(0.3, 1.0), st.floats(1e-3, 1.0))
def test_from_moes_returns_what_was_asked(M, L, z, radius):
    contact = LineContact.from_moes(M, L, roelands_z=z, radius=radius)
    assert contact.moes_M == pytest.approx(M, rel=1e-12)
    assert contact.moes_L == pytest.approx(L, rel=1e-12)
    alpha_p = contact.lubricant.pressure_viscosity * contact.peak_pressure
    assert alpha_p == pytest.approx(L * math.sqrt(M / (2 * math.pi)), rel=1e-12)
    derived = Lubricant(contact.lubricant.viscosity, contact.lubricant.pressure_viscosity)
    assert derived.z == pytest.approx(z, rel=1e-12)


def test_without_piezoviscosity():
    contact = LineContact.from_moes(10.0, 0.0)
    assert contact.moes_L == 0.0
    assert contact.moes_M == pytest.approx(10.0, rel=1e-12)


def test_all_faults_are_listed_at_once_and_survive_a_process_boundary():
    with pytest.raises(InputError) as caught:
        LineContact(load=0.0, entrainment=0.0, radius=-1.0, reduced_modulus=math.inf, lubricant="oil")
    error = pickle.loads(pickle.dumps(caught.value))
    assert [f.where for f in error.faults] == [
        "load",
        "entrainment",
        "radius",
        "reduced_modulus",
        "lubricant",
    ]
    assert "dry" in error.faults[1].remedy


def test_from_moes_lists_its_faults():
    with pytest.raises(InputError) as caught:
        LineContact.from_moes(M=-1.0, L=float("nan"), roelands_z=0.0)
    assert [f.where for f in caught.value.faults] == ["M", "L", "roelands_z"]
    with pytest.raises(InputError, match="constant viscosity"):
        LineContact.from_moes(M=1.0, L=1e-300)
