"""What the stages of the motion refer to: the mesh cycle that it uses, and the range of frequencies that it covers."""

from __future__ import annotations

import math

from flankfilm import coupling
from flankfilm.building.pair import pinion_torque
from flankfilm.scene.sections.dynamics import DynamicsSection
from flankfilm.scene.sections.section import required
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import MESH, PAIR


def frequency_range(run: Engine, section: DynamicsSection) -> tuple[float, float] | None:
    """Range of the mesh frequency over the natural one that sweep and diagram cover; None without either."""
    asked = [ranged for ranged in (section.sweep, section.diagram) if ranged is not None]
    if not asked or not {"sweep", "diagram"} & set(run.scene.wants):
        return None
    ends = [end for ranged in asked for end in ranged.frequency or ()]
    if not section.dimensionless:
        mean = run[MESH].mean(section.stiffness)
        extra, length = section.extra_inertia_kg_m2.each, section.value("length_scale_um")
        scales = coupling.pair_scales(run[PAIR], pinion_torque(run.scene), mean, extra, length)
        ends += [scales.frequency_from_rpm(end) for ranged in asked for end in ranged.speed_rpm or ()]
    return min(ends), max(ends)


def speeds_looked_at(run: Engine, series: coupling.MeshSeries, speed: float) -> tuple[float, float] | None:
    """Lowest and highest pinion speed of all ranges and of operation [rad/s]; None without a range."""
    section = required(run.scene.dynamics, "[dynamics]", "a range of speed")
    asked = [*section.ranges.values()]
    if not asked:
        return None
    extra, length = section.extra_inertia_kg_m2.each, section.value("length_scale_um")
    mean = series.stiffness.mean
    scales = coupling.pair_scales(run[PAIR], pinion_torque(run.scene), mean, extra, length)
    ends = [scales.speed(end) for span in asked for end in span.frequency or ()]
    ends += [end * math.pi / 30.0 for span in asked for end in span.speed_rpm or ()]
    return min(*ends, speed), max(*ends, speed)


def deflection(run: Engine, section: DynamicsSection) -> float:
    """Deflection of the mesh under the scene's torque by its mean stiffness [m]."""
    force = abs(run[PAIR].base_tangent_force(pinion_torque(run.scene)))
    return force / run[MESH].mean(section.stiffness)
