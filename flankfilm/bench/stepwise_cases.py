"""Case of the stepwise flow: forces that are not piecewise linear."""

from __future__ import annotations

from typing import Any

import numpy as np

from flankfilm.bench.case import Answer, Case, Levels, Series, case, level, value
from flankfilm.bench.examples import PERIODS, START, oscillator

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
    return tuple(
        motion_stepwise(name.split()[-1].replace("/", "_"), name, law) for name, law in laws().items()
    )


@case("Stepwise flow, {name}", "evaluations of the force a period", "motion_stepwise_{short}")
def motion_stepwise(short: str, name: str, law: Any) -> Levels:
    """Stepwise flow by tolerance.

    Time of {MANY} excitation periods by steps of order 8 with all switchings; error of the state after {PERIODS}
    periods, over its largest component. The oscillator of the exact flow, its contact with {name}.
    """
    from dynamics import SmoothOscillator, period_map
    from dynamics.flow.stepwise_flow import StepwiseFlow

    exact, start = oscillator(), np.array(START)
    osc = SmoothOscillator(law, exact.damping_ratio, exact.mean_force, exact.error_amplitude, exact.frequency)

    def run(flow: StepwiseFlow, derivatives: bool) -> StepwiseFlow:
        flow.follow(start, MANY, derivatives=derivatives)
        return flow

    def of_state(evaluations: float, state: Any) -> Answer:
        return Answer(evaluations / PERIODS, {"state": value(state, None, over_largest=True)})

    def stepped(flow: StepwiseFlow) -> Answer:
        image = flow.follow(start, PERIODS, derivatives=False)
        return of_state(image.cost.counts["evaluations of the law"], image.state)

    def by_exact_flow(_: object) -> Answer:
        return of_state(0.0, period_map(exact, START, PERIODS).state)

    def series(words: str, derivatives: bool) -> Series:
        flows = {t: StepwiseFlow(osc, t, ("frequency",)) for t in TOLERANCES}
        levels = (level(f"{t:g}", run, stepped, flow, derivatives) for t, flow in flows.items())
        return Series(words, tuple(levels))

    finest = (
        level("exact flow", lambda: None, by_exact_flow)
        if name == "exponent 1"
        else level("tolerance 3e-15", StepwiseFlow, stepped, osc, 3e-15)
    )
    return Levels((series("states alone", False), series("with derivatives", True)), finest)
