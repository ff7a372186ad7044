"""Every fault of an input is named, all at once; nothing that is not a number is computed with."""

from __future__ import annotations

import pickle
import subprocess
import sys

import numpy as np
import pytest

from base import InputError, RangeWarning
from dynamics import (
    FourierStiffness,
    GearOscillator,
    Scaling,
    contact_grazing,
    find_orbit,
    period_map,
    sweep,
    trajectory,
)


def where(error) -> set[str]:
    return {fault.where for fault in error.value.faults}


def test_all_faults_of_an_oscillator_at_once():
    with pytest.raises(InputError) as error:
        GearOscillator("stiff", -0.1, np.nan, np.inf, 0.0, -1e-300, "no")
    assert where(error) == {
        "stiffness", "damping_ratio", "mean_force", "error_amplitude", "frequency", "half_backlash",
        "error_phase",
    }  # fmt: skip
    assert len(str(error.value).splitlines()) == 7
    again = pickle.loads(pickle.dumps(error.value))
    assert again.faults == error.value.faults


@pytest.mark.parametrize("frequency", [0.0, -1.0, np.nan, np.inf, True, None, 1e-9])
def test_frequency(frequency):
    with pytest.raises(InputError, match="frequency"):
        GearOscillator(FourierStiffness(1.0), 0.05, 0.1, 0.2, frequency, 0.2)


def test_stiffness_faults():
    with pytest.raises(InputError) as error:
        FourierStiffness(np.nan, (0.1, np.inf), (0.0,))
    assert where(error) == {"stiffness.mean", "stiffness.amplitudes[1]", "stiffness.phases"}
    with pytest.raises(InputError, match="sequence"):
        FourierStiffness(1.0, 0.1, 0.0)
    with pytest.warns(RangeWarning, match="positive mean"):
        FourierStiffness(-1.0)


def test_stiffness_takes_arrays():
    k = FourierStiffness(1, np.array([0.1]), [0])
    assert k.amplitudes == (0.1,)
    assert hash(k) == hash(FourierStiffness(1.0, (0.1,), (0.0,)))


def test_parameter_names(article):
    with pytest.raises(InputError, match="parameter"):
        article().with_parameter("omega", 1.0)
    with pytest.raises(InputError, match="parameter"):
        article().with_parameter("stiffness.amplitudes[1]", 1.0)
    assert article().with_parameter("stiffness.amplitudes[0]", 0.5).get("stiffness.amplitudes[0]") == 0.5
    assert article().with_parameter("stiffness.mean", 2.0).get("stiffness.mean") == 2.0
    assert article().with_parameter("half_backlash", 2.0).get("half_backlash") == 2.0


@pytest.mark.parametrize("state", [(np.nan, 0.0), (0.0,), (0.0, np.inf), 1.0])
def test_states(article, state):
    for function in (period_map, trajectory, find_orbit):
        with pytest.raises(InputError):
            function(article(), state)


def test_arguments(article):
    with pytest.raises(InputError) as error:
        sweep(article(), values=[], direction="sideways", keep=3, max_period=0, transient=-1)
    assert where(error) == {"values", "direction", "max_period", "transient"}
    with pytest.raises(InputError, match="keep"):
        sweep(article(), values=[0.5], keep=31)
    with pytest.raises(InputError, match="bounds"):
        contact_grazing(article(), bounds=(1.0, 0.5))
    with pytest.raises(InputError, match="frequency"):
        sweep(article(), values=[0.5, -0.5])
    with pytest.raises(InputError, match="periods"):
        period_map(article(), (0.1, 0.1), periods=0)
    with pytest.raises(InputError, match="length"):
        Scaling.from_inertias(inertias=(1, 1), base_radii=(1, 1), mean_stiffness=1, cycles_per_revolution=20)


def test_import_loads_no_compiler():
    code = "import sys, dynamics; dynamics.GearOscillator; assert not {'numba', 'scipy'} & sys.modules.keys()"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_public_names_exist():
    import dynamics

    assert all(getattr(dynamics, name) is not None for name in dynamics.__all__)
    with pytest.raises(AttributeError):
        dynamics.nothing  # noqa: B018
