"""What the stages of the motion refer to: the mesh cycle that it uses, and the range of frequencies that it covers."""

from __future__ import annotations

from flankfilm import coupling
from flankfilm.build import pinion_torque
from flankfilm.scene.dynamics import DynamicsSection
from flankfilm.stages.catalogue import MESH, PAIR
from flankfilm.stages.engine import Engine


def moving_mesh(run: Engine) -> coupling.MeshCycle:
    """Mesh cycle that the motion uses, its deflection measured against what the scene asks for: the bodies."""
    cycle, section = run[MESH], run.scene.dynamics
    if cycle.contact is None:
        return cycle
    if section is None:
        return cycle.against("body")
    return cycle.against(section.stiffness_reference or "body", section.extra_inertia_kg_m2.each)


def frequency_range(run: Engine, section: DynamicsSection) -> tuple[float, float] | None:
    """Range of the mesh frequency over the natural one that sweep and diagram cover; None without either."""
    asked = [ranged for ranged in (section.sweep, section.diagram) if ranged is not None]
    if not asked or not {"sweep", "diagram"} & set(run.scene.wants):
        return None
    ends = [end for ranged in asked for end in ranged.frequency or ()]
    if not section.dimensionless:
        mean = moving_mesh(run).mean(section.stiffness)
        extra, length = section.extra_inertia_kg_m2.each, section.value("length_scale_um")
        scales = coupling.pair_scales(run[PAIR], pinion_torque(run.scene), mean, extra, length)
        ends += [scales.frequency_from_rpm(end) for ranged in asked for end in ranged.speed_rpm or ()]
    return min(ends), max(ends)


def deflection(run: Engine, section: DynamicsSection) -> float:
    """Deflection of the mesh under the scene's torque by its mean stiffness [m]."""
    force = abs(run[PAIR].normal_force(pinion_torque(run.scene)))
    return force / moving_mesh(run).mean(section.stiffness)
