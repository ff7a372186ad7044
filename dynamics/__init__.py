"""Piecewise-linear oscillators with periodic stiffness and backlash, by their exact flow.

Knows no gears: a Fourier series of stiffness goes in, motions come out. Public names are loaded when first
used, so that importing the package costs next to nothing and compiles nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dynamics.attraction import Attractor as Attractor
    from dynamics.attraction import BasinResult as BasinResult
    from dynamics.attraction import basins as basins
    from dynamics.boundary import BasinBoundary as BasinBoundary
    from dynamics.boundary import basin_boundary as basin_boundary
    from dynamics.boundary import share_interval as share_interval
    from dynamics.branch import Branch as Branch
    from dynamics.continuation import continue_branch as continue_branch
    from dynamics.crises import Crisis as Crisis
    from dynamics.crises import boundary_crises as boundary_crises
    from dynamics.crises import boundary_crisis as boundary_crisis
    from dynamics.diagrams import Diagram as Diagram
    from dynamics.diagrams import diagram as diagram
    from dynamics.edges import edge_saddles as edge_saddles
    from dynamics.exponents import LyapunovResult as LyapunovResult
    from dynamics.exponents import LyapunovScan as LyapunovScan
    from dynamics.exponents import lyapunov_exponents as lyapunov_exponents
    from dynamics.exponents import lyapunov_scan as lyapunov_scan
    from dynamics.finding import OrbitSet as OrbitSet
    from dynamics.finding import find_orbits as find_orbits
    from dynamics.flow import Trajectory as Trajectory
    from dynamics.flow import period_map as period_map
    from dynamics.flow import trajectory as trajectory
    from dynamics.flow import turning_points as turning_points
    from dynamics.fourier import FourierFit as FourierFit
    from dynamics.fourier import fit_fourier as fit_fourier
    from dynamics.grazing import ContactGrazing as ContactGrazing
    from dynamics.grazing import contact_grazing as contact_grazing
    from dynamics.grazing import contact_orbit as contact_orbit
    from dynamics.inverse import Event as Event
    from dynamics.inverse import Identification as Identification
    from dynamics.inverse import OneOf as OneOf
    from dynamics.inverse import Ranged as Ranged
    from dynamics.inverse import identify as identify
    from dynamics.labelling import Stretch as Stretch
    from dynamics.labelling import stretches as stretches
    from dynamics.loci import Locus as Locus
    from dynamics.loci import continue_locus as continue_locus
    from dynamics.locus_tracing import DoublePoint as DoublePoint
    from dynamics.manifolds import Manifold as Manifold
    from dynamics.manifolds import manifold as manifold
    from dynamics.multi_sweeps import Motion as Motion
    from dynamics.multi_sweeps import MultiSweep as MultiSweep
    from dynamics.multi_sweeps import multi_sweep as multi_sweep
    from dynamics.oscillator import GearOscillator as GearOscillator
    from dynamics.robustness import ForceRange as ForceRange
    from dynamics.robustness import force_range as force_range
    from dynamics.robustness import special_sensitivities as special_sensitivities
    from dynamics.scaling import Scaling as Scaling
    from dynamics.sensitivity import MapDerivatives as MapDerivatives
    from dynamics.sensitivity import map_derivatives as map_derivatives
    from dynamics.shooting import Orbit as Orbit
    from dynamics.shooting import find_orbit as find_orbit
    from dynamics.smooth.compiled import CompiledLaw as CompiledLaw
    from dynamics.smooth.laws import PowerContact as PowerContact
    from dynamics.smooth.laws import SmoothedBacklash as SmoothedBacklash
    from dynamics.smooth.laws import SqueezeFilm as SqueezeFilm
    from dynamics.smooth.oscillator import SmoothOscillator as SmoothOscillator
    from dynamics.smooth.tabulated import TabulatedContact as TabulatedContact
    from dynamics.special import SpecialPoint as SpecialPoint
    from dynamics.stiffness import FourierStiffness as FourierStiffness
    from dynamics.sweeps import SweepResult as SweepResult
    from dynamics.sweeps import sweep as sweep
    from dynamics.switching import doubled_orbit as doubled_orbit

_HOMES = {
    "DoublePoint": "locus_tracing",
    "Locus": "loci",
    "continue_locus": "loci",
    "Diagram": "diagrams",
    "diagram": "diagrams",
    "doubled_orbit": "switching",
    "OrbitSet": "finding",
    "find_orbits": "finding",
    "Attractor": "attraction",
    "BasinResult": "attraction",
    "Branch": "branch",
    "LyapunovResult": "exponents",
    "basins": "attraction",
    "continue_branch": "continuation",
    "LyapunovScan": "exponents",
    "lyapunov_exponents": "exponents",
    "lyapunov_scan": "exponents",
    "ContactGrazing": "grazing",
    "edge_saddles": "edges",
    "FourierFit": "fourier",
    "FourierStiffness": "stiffness",
    "GearOscillator": "oscillator",
    "ForceRange": "robustness",
    "force_range": "robustness",
    "special_sensitivities": "robustness",
    "Event": "inverse",
    "Identification": "inverse",
    "OneOf": "inverse",
    "Ranged": "inverse",
    "identify": "inverse",
    "BasinBoundary": "boundary",
    "basin_boundary": "boundary",
    "share_interval": "boundary",
    "Crisis": "crises",
    "boundary_crises": "crises",
    "boundary_crisis": "crises",
    "Motion": "multi_sweeps",
    "MultiSweep": "multi_sweeps",
    "multi_sweep": "multi_sweeps",
    "Manifold": "manifolds",
    "manifold": "manifolds",
    "Stretch": "labelling",
    "stretches": "labelling",
    "MapDerivatives": "sensitivity",
    "Orbit": "shooting",
    "Scaling": "scaling",
    "CompiledLaw": "smooth.compiled",
    "PowerContact": "smooth.laws",
    "SmoothOscillator": "smooth.oscillator",
    "SmoothedBacklash": "smooth.laws",
    "SqueezeFilm": "smooth.laws",
    "TabulatedContact": "smooth.tabulated",
    "SpecialPoint": "special",
    "SweepResult": "sweeps",
    "Trajectory": "flow",
    "contact_grazing": "grazing",
    "contact_orbit": "grazing",
    "find_orbit": "shooting",
    "fit_fourier": "fourier",
    "map_derivatives": "sensitivity",
    "period_map": "flow",
    "sweep": "sweeps",
    "trajectory": "flow",
    "turning_points": "flow",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> object:
    """Load a public name from its module."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """Public names, loaded or not."""
    return list(__all__)
