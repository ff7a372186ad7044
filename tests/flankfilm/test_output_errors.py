"""Errors of a study's outputs: each once, with a name of its own, and those of the records."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import Figure
from base.units import suffix
from flankfilm.files.cache import Cache
from flankfilm.output.uncertainty import uncertainty
from flankfilm.products.closed_forms import VERIFICATION
from flankfilm.products.output import error_name, output_of, with_errors
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import MESH
from flankfilm.studies.outputs import ERROR_OF, OUTPUTS
from tests.flankfilm.scenes import ARTICLE

SCENE = f"""
wants = ["stiffness", "closed-forms"]
tolerance = 0.005
{ARTICLE}
[film]
model = "none"
"""


@pytest.fixture(scope="module")
def engine():
    return Engine(parse_scene(SCENE), Cache(None))


def number(name, engine):
    return OUTPUTS[name].value(engine)


def test_every_error_is_an_output():
    assert set(ERROR_OF.values()) <= OUTPUTS.keys()
    for error in ERROR_OF.values():
        assert OUTPUTS[error].unit == "1"
        assert error not in ERROR_OF


def test_names_of_errors_have_no_unit():
    for name, output in OUTPUTS.items():
        if output.error is not None:
            end = suffix(output.unit)
            assert error_name(name, output) == (name[: -len(end) - 1] if end else name) + "_error"


def test_an_error_that_is_an_output_already_appears_once():
    held = {name: output.error_output for name, output in OUTPUTS.items() if output.error_output}
    again = {error_name(name, OUTPUTS[name]) for name in held} & (OUTPUTS.keys() - {*held.values()})
    # of these the name says search, samples and damping together
    assert again <= {"greatest_bearing_force_error", "greatest_shaft_torque_error"}
    figure = Figure("Pa", "stress", shown="MPa")
    for held_by, names in (("errors", ["stress_MPa"]), ("", ["stress_MPa", "stress_error"])):
        name, output = output_of(
            "stress", figure, "stiffness", lambda _: 1.0, error=lambda _: 0.5, error_output=held_by
        )
        assert list(with_errors({name: output})) == names


def test_extremes_and_harmonics_have_the_errors_of_the_cycle(engine):
    cycle = engine[MESH]
    for name in ("least_secant_stiffness", "greatest_secant_stiffness"):
        output = name.replace("greatest", "largest")
        assert number(f"{output}_error", engine) == uncertainty(cycle, name).numerical
    for curve, prefix in (("secant_stiffness", ""), ("stiffness", "tangent_")):
        sizes, errors = getattr(cycle, f"{curve}_harmonics"), getattr(cycle, f"{curve}_harmonics_error")
        for order in range(1, 6):
            error = number(f"{prefix}harmonic_{order}_error", engine)
            assert error == pytest.approx(errors[order - 1] / sizes[order - 1], rel=1e-12)


def test_differences_of_closed_forms_move_as_the_reference_does(engine):
    """A reference that is off by its error changes the difference by what its error says, to first order."""
    verification = engine[VERIFICATION]
    for name, model in (("ishikawa", "Ishikawa"), ("iso6336", "ISO 6336-1")):
        compared = verification.comparison(model, "held to the path")
        off = 1e-6
        moved = replace(compared, reference_value=compared.reference_value * (1.0 + off))
        slope = (moved.difference - compared.difference) / off
        error = abs(slope) * compared.reference_error / abs(compared.difference)
        assert number(f"{name}_error", engine) == pytest.approx(error, rel=1e-5)
        assert np.isfinite(number(f"{name}_like_for_like_error", engine))
