"""Time that a run still takes: foreseen costs of its stages, corrected by the measured ones of those that ended."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from flankfilm.files.cache import Cache
from flankfilm.plan.decide import SERIES, Plan
from flankfilm.runs.begin import begin
from flankfilm.runs.check import needed
from flankfilm.scene import Scene
from flankfilm.scene.sections.dynamics import BY_FILM
from flankfilm.stages.damping import FILM_DAMPING
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.mesh import BODIES, FACE_GEARS, FILM, PLAN, along_the_face
from flankfilm.stages.motion import BRANCHES, CURVE_SERIES, by_jumps

__all__ = ["Clock", "foreseen"]

PLANNED = {
    "bodies": "tooth compliance",
    "dry cycle": "sampling of the mesh cycle",
    "film": "film",
    "sweep": SERIES.name,
}
"""Stages whose cost the plan foresees from its shares of the tolerance, with the names of their shares."""

MEASURED = {
    "pair": 0.01,
    "plan": 0.01,
    "film foreseen": 0.05,
    "compliance": 0.01,
    "closed forms": 0.1,
    "standards": 0.05,
    "rating": 0.05,
    "references": 0.2,
    "other cycles": 0.1,
    "mesh": 0.01,
    "fields": 0.5,
    "fourier": 0.5,
    "scaling": 0.01,
}
"""Stages that take nearly the same time for all pairs, measured on one core for the article's scene [s]."""

BESIDE = {"dry cycle": 0.3}
"""What the plan does not count: events between positions, measured like the stages [s]."""

WITHOUT_FILMS = {"none": 0.0, "dowson": 0.1}
"""Seconds of the film where none is solved, by its model [s]."""

FILES = {
    "report": ("writing the report", 3.0),
    "": ("netCDF and CSV files", 2.0),
    "vtk": ("fields for ParaView", 0.7),
}
"""Files by the want that asks for them; what is said meanwhile, and seconds, measured like the stages."""

TRUST = 1.0
"""Seconds of measured work that the foreseen pace is worth: what takes less says little of the machine [s]."""


def foreseen(scene: Scene) -> dict[str, float | None]:
    """Seconds that each stage of a run is foreseen to cost, by title, in the order in which stages begin.

    Parameters
    ----------
    scene : Scene
        Without faults.

    Returns
    -------
    dict
        None where nothing foresees the cost.

    Raises
    ------
    InputError, SolverError
        Where the scene has no plan.
    """
    engine, wanted = begin(scene, Cache(None))
    stages = list(dict.fromkeys(one for goal in wanted for one in _in_order(goal)))
    has_plan = scene.stiffness.model != "given" and any(PLAN in needed(goal) for goal in wanted)
    plan = engine[PLAN] if has_plan else None
    costs = {stage.title: _cost(stage, engine, plan) for stage in stages}
    files = {title: seconds for want, (title, seconds) in FILES.items() if not want or want in scene.wants}
    return {**costs, **files}


def _in_order(stage: Stage[Any]) -> Iterator[Stage[Any]]:
    """A stage, which begins before it asks for what it needs, and all that it may ask for."""
    yield stage
    for need in stage.needs:
        yield from _in_order(need)


def _cost(stage: Stage[Any], engine: Engine, plan: Plan | None) -> float | None:
    """Seconds of a stage alone; 0 where it will not be asked for."""
    if stage.name in IDLE and IDLE[stage.name](engine):
        return 0.0
    if plan is None or stage.name not in PLANNED:
        return MEASURED.get(stage.name)
    if stage.name == FILM.name and plan.film.choice in WITHOUT_FILMS:
        return WITHOUT_FILMS[plan.film.choice]
    if stage.name == BODIES.name and plan.stiffness.choice != "fem":
        return 0.0
    planned = plan.costs.get(PLANNED[stage.name])
    return None if planned is None else planned + BESIDE.get(stage.name, 0.0)


def _gives_damping(engine: Engine) -> bool:
    dynamics = engine.scene.dynamics
    return dynamics is None or dynamics.damping_ratio != BY_FILM


def _gives_harmonics(engine: Engine) -> bool:
    dynamics = engine.scene.dynamics
    return dynamics is None or dynamics.error_curve is None


IDLE: dict[str, Callable[[Engine], bool]] = {
    FACE_GEARS.name: lambda engine: not along_the_face(engine.scene),
    CURVE_SERIES.name: lambda engine: not by_jumps(engine),
    BRANCHES.name: lambda engine: not by_jumps(engine),
    FILM_DAMPING.name: _gives_damping,
    EXCITATION.name: _gives_harmonics,
}
"""Stages that others may ask for, and when none does."""


@dataclass
class Clock:
    """Follows the stages of a run; each one that ends corrects the time left.

    Attributes
    ----------
    foreseen : mapping
        Seconds of each stage by title, in the order in which they begin; None where they are unknown.
    spent : dict
        Seconds of the stages that ended.
    """

    foreseen: Mapping[str, float | None] = field(default_factory=dict)
    spent: dict[str, float] = field(default_factory=dict)
    _title: str = ""
    _since: float = 0.0
    _place: int = -1
    _rows: float | None = None

    def begins(self, what: str, done: int, total: int, now: float, there: int = 0) -> None:
        """Note what is at work.

        Parameters
        ----------
        what : str
            Title of a stage, with its rows after a colon where it counts them, or something else, such as that code
            is compiled: the stage before it does not count for the pace then.
        done, total : int
            Rows, where they are counted.
        now : float
            [s].
        there : int
            Rows that were there before.
        """
        title = what.partition(": ")[0]
        if title == self._title:
            if done > there and title != what:
                self._rows = (now - self._since) / (done - there) * (total - done)
            return
        if self._title in self.foreseen and title in self.foreseen:
            self.spent[self._title] = now - self._since
        self._title, self._since, self._rows = title, now, None
        if title in self.foreseen:
            self._place = max(self._place, list(self.foreseen).index(title))

    def left(self, now: float) -> tuple[float, float] | None:
        r"""Seconds left of the run and of its stage; None where a cost is unknown, or is exceeded.

        What was foreseen is taken times the pace of the stages that ended, :math:`(t_0 + \sum t)/(t_0 + \sum f)` of
        measured and foreseen times, where t_0 is `TRUST`.

        Parameters
        ----------
        now : float
            [s].
        """
        later = [
            cost for title, cost in list(self.foreseen.items())[self._place + 1 :] if title not in self.spent
        ]
        here = self.foreseen.get(self._title)
        if self._rows is None and (here is None or self._title not in self.foreseen):
            return None
        if any(cost is None for cost in later):
            return None
        known = [(self.spent[t], f) for t, f in self.foreseen.items() if f is not None and t in self.spent]
        pace = (TRUST + sum(spent for spent, _ in known)) / (TRUST + sum(cost for _, cost in known))
        stage = self._rows if self._rows is not None else pace * (here or 0.0) - (now - self._since)
        if stage < 0.0:
            return None
        return stage + pace * sum(cost for cost in later if cost is not None), stage
