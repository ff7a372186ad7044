"""Case of the stepwise flow: forces that are not piecewise linear."""

from __future__ import annotations

from typing import Any

import numpy as np

from flankfilm.bench.case import Answer, Case, Series, Value, level
from flankfilm.bench.examples import PERIODS, START, oscillator

__all__ = ["laws", "stepwise"]

MANY = 200
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14)


def laws() -> dict[str, Any]:
    """Contacts with exponent 1, where the exact flow is the truth, with 10/9, and as a table of eight harmonics."""
    from dynamics import PowerContact, TabulatedContact

    series = oscillator().stiffness
    depths = np.linspace(0.0, 1.0, 33) ** 2 * 1.5
    forces = series(2 * np.pi * np.arange(20) / 20)[:, None] * depths ** (10 / 9)
    return {
        "exponent 1": PowerContact(stiffness=series, half_backlash=0.2, exponent=1.0),
        "exponent 10/9": PowerContact(stiffness=series, half_backlash=0.2),
        "table": TabulatedContact.from_forces(depths, forces, half_backlash=0.2, order=8),
    }


def stepwise() -> tuple[Case, ...]:
    """Stepwise flow by tolerance, a law each."""
    from dynamics import SmoothOscillator

    exact = oscillator()
    return tuple(
        _case(
            name,
            SmoothOscillator(
                law, exact.damping_ratio, exact.mean_force, exact.error_amplitude, exact.frequency
            ),
        )
        for name, law in laws().items()
    )


def _case(name: str, osc: Any) -> Case:
    from dynamics import period_map
    from dynamics.stepwise.flow import StepwiseFlow

    quantity, start = "state", np.array(START)

    def run(flow: StepwiseFlow, derivatives: bool) -> StepwiseFlow:
        flow.follow(start, MANY, derivatives=derivatives)
        return flow

    def answer(flow: StepwiseFlow) -> Answer:
        found = flow.follow(start, PERIODS, derivatives=False)
        evaluations = found.cost.counts["evaluations of the law"]
        return Answer(evaluations / PERIODS, {quantity: Value(found.state, None, over_largest=True)})

    def exact(_: object) -> Answer:
        state = period_map(oscillator(), START, PERIODS).state
        return Answer(0.0, {quantity: Value(state, None, over_largest=True)})

    finest = (
        level("exact flow", lambda: None, exact)
        if name == "exponent 1"
        else level("tolerance 3e-15", StepwiseFlow, answer, osc, 3e-15)
    )
    return Case(
        f"motion_stepwise_{name.split()[-1].replace('/', '_')}",
        f"Stepwise flow, {name}",
        f"Time of {MANY} excitation periods by steps of order 8 with all switchings; error of the state after "
        f"{PERIODS} periods, over its largest component. The oscillator of the exact flow, its contact with {name}.",
        "evaluations of the force a period",
        tuple(
            Series(
                words,
                tuple(
                    level(f"{t:g}", run, answer, StepwiseFlow(osc, t, ("frequency",)), derivatives)
                    for t in TOLERANCES
                ),
            )
            for words, derivatives in (("states alone", False), ("with derivatives", True))
        ),
        finest,
    )
