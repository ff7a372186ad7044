"""Between the physical pair and the dimensionless oscillator."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from base import Array, Faults
from dynamics.model.limits import NUMBER, POSITIVE
from dynamics.model.oscillator import GearOscillator
from dynamics.model.stiffness import FourierStiffness


@dataclass(frozen=True)
class Scaling:
    r"""Scales of mass, stiffness and length along the line of action, and conversions both ways.

    With :math:`\omega_n = \sqrt{k_m / m_e}`: :math:`\omega = \omega_{mesh} / \omega_n`,
    :math:`\zeta = c / (2 m_e \omega_n)`, :math:`F_m = F / (k_m b_c)`, :math:`\varepsilon = e / b_c`,
    :math:`D = b / b_c`, :math:`\tau = \omega_n t`, :math:`X = x / b_c`.

    Parameters
    ----------
    equivalent_mass : float
        :math:`m_e` [kg], > 0.
    mean_stiffness : float
        :math:`k_m` [N/m], > 0, of the face width, not per metre of it.
    length : float
        :math:`b_c` [m], > 0; a free choice, which changes no physical result.
    cycles_per_revolution : int
        Mesh cycles per revolution of the shaft whose speed is meant: the number of teeth of the pinion.

    Raises
    ------
    InputError
        With every fault found.

    Notes
    -----
    Displacements are along the line of action, so that b is half the backlash along that line,
    and an error e is the amplitude of the *unloaded* transmission error.
    """

    equivalent_mass: float
    mean_stiffness: float
    length: float
    cycles_per_revolution: int

    def __post_init__(self) -> None:
        """Check; every fault is listed."""
        with Faults() as faults:
            for name, unit in (("equivalent_mass", "kg"), ("mean_stiffness", "N/m"), ("length", "m")):
                number = faults.number(f"scaling.{name}", getattr(self, name), POSITIVE.in_unit(1.0, unit))
                object.__setattr__(self, name, number)
            teeth = faults.whole(
                "scaling.cycles_per_revolution",
                self.cycles_per_revolution,
                1,
                10**9,
                "give the number of teeth",
            )
            object.__setattr__(self, "cycles_per_revolution", teeth)

    @classmethod
    def from_inertias(
        cls,
        *,
        inertias: tuple[float, float],
        base_radii: tuple[float, float],
        mean_stiffness: float,
        cycles_per_revolution: int,
        length: float | None = None,
        force: float | None = None,
        mean_force: float | None = None,
    ) -> Scaling:
        r"""Scales of two shafts, :math:`m_e = J_1 J_2 / (J_1 r_{b2}^2 + J_2 r_{b1}^2)`.

        Parameters
        ----------
        inertias : tuple of float
            Moments of inertia :math:`J_1, J_2` [kg m2].
        base_radii : tuple of float
            Base circle radii :math:`r_{b1}, r_{b2}` [m].
        mean_stiffness : float
            Mean mesh stiffness [N/m].
        cycles_per_revolution : int
            Number of teeth of the pinion.
        length : float, optional
            :math:`b_c` [m].
        force, mean_force : float, optional
            Instead of the length: the normal force [N] and the value of :math:`F_m` it shall have.

        Raises
        ------
        InputError
            With every fault found.
        """
        with Faults() as faults:
            pairs = {"inertias": (inertias, "kg m2"), "base_radii": (base_radii, "m")}
            values: list[float] = []
            for name, (pair, unit) in pairs.items():
                for i in range(2):
                    values.append(faults.number(f"{name}[{i}]", pair[i], POSITIVE.in_unit(1.0, unit)))
            k = faults.number("mean_stiffness", mean_stiffness, POSITIVE.in_unit(1.0, "N/m"))
            if length is not None and force is None and mean_force is None:
                b_c = faults.number("length", length, POSITIVE.in_unit(1.0, "m"))
            elif length is None and force is not None and mean_force is not None:
                load = faults.number("force", force, NUMBER)
                level = faults.number("mean_force", mean_force, NUMBER)
                b_c = load / (k * level) if level else math.nan
                if load == 0.0:
                    faults.add("force", load, "must not be 0 N", "a pair without load has no scale")
                elif load * level <= 0.0:
                    faults.add("mean_force", level, "must have the sign of force", "usual is 0.1")
            else:
                b_c = math.nan
                faults.add(
                    "length", length, "must be given, or else force and mean_force", "give one of the two"
                )
        j1, j2, r1, r2 = values
        return cls(j1 * j2 / (j1 * r2**2 + j2 * r1**2), k, b_c, cycles_per_revolution)

    @property
    def omega_n(self) -> float:
        """Natural angular frequency sqrt(k_m / m_e) [rad/s]."""
        return math.sqrt(self.mean_stiffness / self.equivalent_mass)

    @property
    def natural_frequency(self) -> float:
        """Natural frequency [Hz]."""
        return self.omega_n / (2.0 * math.pi)

    def frequency(self, speed: float) -> float:
        """Dimensionless frequency of a pinion speed [rad/s]."""
        return speed * self.cycles_per_revolution / self.omega_n

    def speed(self, frequency: float) -> float:
        """Pinion speed [rad/s] of a dimensionless frequency."""
        return frequency * self.omega_n / self.cycles_per_revolution

    def frequency_from_rpm(self, rpm: float) -> float:
        """Dimensionless frequency of a pinion speed in revolutions per minute."""
        return self.frequency(rpm * math.pi / 30.0)

    def rpm(self, frequency: float) -> float:
        """Pinion speed in revolutions per minute of a dimensionless frequency."""
        return self.speed(frequency) * 30.0 / math.pi

    def mean_force(self, force: float) -> float:
        """F_m of a normal force [N]."""
        return force / (self.mean_stiffness * self.length)

    def force(self, mean_force: float) -> float:
        """Force normal to the flanks [N] of a dimensionless force."""
        return mean_force * self.mean_stiffness * self.length

    def scaled(self, displacement: float) -> float:
        """X, epsilon or D of a displacement, error amplitude or half backlash [m]."""
        return displacement / self.length

    def displacement(self, scaled: float) -> float:
        """Displacement, error amplitude or half backlash [m] of X, epsilon or D."""
        return scaled * self.length

    def velocity(self, scaled: float) -> float:
        """Speed along the line of action [m/s] of dX/dtau."""
        return scaled * self.length * self.omega_n

    def time(self, tau: float) -> float:
        """Time [s] of the dimensionless time."""
        return tau / self.omega_n

    def damping_ratio(self, damping: float) -> float:
        """Damping ratio of a damping coefficient [N s/m]."""
        return damping / (2.0 * self.equivalent_mass * self.omega_n)

    def damping(self, damping_ratio: float) -> float:
        """Damping coefficient [N s/m] of a damping ratio."""
        return damping_ratio * 2.0 * self.equivalent_mass * self.omega_n

    def oscillator(
        self,
        *,
        stiffness: FourierStiffness,
        damping_ratio: float,
        force: float,
        error_amplitude: float | Sequence[float] | Array,
        half_backlash: float,
        speed: float,
        error_phase: float | Sequence[float] | Array = 0.0,
    ) -> GearOscillator:
        """Dimensionless oscillator of physical quantities.

        Parameters
        ----------
        stiffness : FourierStiffness
            Mesh stiffness [N/m]; it is divided by `mean_stiffness`.
        damping_ratio : float
            Dimensionless.
        force : float
            Normal force [N].
        error_amplitude : float or sequence of float
            Of the error's first harmonic, or of each, along the line of action [m].
        half_backlash : float
            Along the line of action [m].
        speed : float
            Pinion speed [rad/s].
        error_phase : float or sequence of float
            [rad].

        Raises
        ------
        InputError
            With every fault found.
        """
        k = self.mean_stiffness
        scaled = np.asarray(error_amplitude, dtype=np.float64) / self.length
        turned = np.asarray(error_phase, dtype=np.float64)
        return GearOscillator(
            stiffness=FourierStiffness(
                stiffness.mean / k, tuple(a / k for a in stiffness.amplitudes), stiffness.phases
            ),
            damping_ratio=damping_ratio,
            mean_force=self.mean_force(force),
            error_amplitude=tuple(scaled.tolist()) if scaled.ndim else float(scaled),
            frequency=self.frequency(speed),
            half_backlash=self.scaled(half_backlash),
            error_phase=tuple(turned.tolist()) if turned.ndim else float(turned),
        )
