"""Records describe their figures once; their line, their dataset's names and their documentation follow."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from base import Array, Cost, Result, Stopwatch, described, quantities, quantity, record, show_with, unclocked
from base.units import FACTORS, factor, suffix


@record
class Shaft:
    """A shaft."""

    headline = ("torque", "mean_stress")

    torque: float = quantity("N m", "torque on the shaft")
    radius: Array = quantity("m", "radius of each section", "section", shown="mm")
    note: str
    error: float | None = 1e-3
    cost: Cost = Cost(0.5)
    converged: bool = True
    message: str = "converged"
    bend: Array | None = quantity("rad", "slope", "section", default=None)

    @described("Pa", "section", kept=True)
    def stress(self) -> Array:
        """Largest shear stress of each section."""
        return np.asarray(2 * self.torque / (np.pi * self.radius**3))

    @described("Pa")
    def mean_stress(self) -> float:
        """Mean of the largest stress."""
        return float(self.stress.mean())


SHAFT = Shaft(100.0, np.full(1000, 0.01), "steel")


def test_a_record_is_shown_in_one_short_line():
    assert repr(SHAFT) == "Shaft(torque 100 N m, mean_stress 6.3662e+07 Pa, error 1.0e-03, converged, 0.5 s)"
    assert len(repr(replace(SHAFT, message="x" * 999))) <= 200
    assert isinstance(SHAFT, Result)


def test_figures_are_found_with_unit_axes_and_meaning_and_absent_ones_left_out():
    found = quantities(SHAFT)
    assert list(found) == ["torque", "radius", "stress", "mean_stress"]
    assert found["stress"].figure.dims == ("section",)
    assert found["stress"].figure.meaning == "Largest shear stress of each section"
    assert found["radius"].figure.in_shown(found["radius"].value)[0] == 10.0
    assert list(quantities(replace(SHAFT, bend=np.zeros(1000))))[2] == "bend"


def test_the_class_documents_what_its_fields_say():
    assert "    radius : Array, (section)\n        radius of each section [m].\n" in str(Shaft.__doc__)


def test_a_view_is_registered_from_outside():
    shown = SHAFT._repr_html_()  # type: ignore[attr-defined]
    assert shown is None or "100 N m" in shown  # what is installed above shows any record
    show_with({f"{__name__}:Shaft": "html:escape_shaft"})
    show_with({f"{__name__}:Shaft": "builtins:repr"})
    assert SHAFT._repr_html_() == repr(SHAFT)  # type: ignore[attr-defined]


def test_a_stopwatch_leaves_out_what_is_unclocked_once():
    watch = Stopwatch()
    with unclocked(), unclocked():
        time.sleep(0.2)
    assert watch.seconds < 0.1


def test_costs_add_up():
    both = Cost(1.0, 10, 2, parts={"mesh": 0.5}) + Cost(2.0, 30, 1, 7, parts={"mesh": 0.5, "solve": 1.0})
    assert (both.seconds, both.unknowns, both.iterations, both.periods) == (3.0, 30, 3, 7)
    assert both.parts == {"mesh": 1.0, "solve": 1.0}


def test_every_unit_has_a_spelling_of_its_own():
    assert len({suffix(unit) for unit in FACTORS}) == len(FACTORS)
    assert factor("GPa") == 1e9
