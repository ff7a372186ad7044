"""Linear elastic, isotropic material of a gear."""

from __future__ import annotations

from dataclasses import dataclass

from base import Fault, Faults, Limit

LIMITS = {
    "youngs_modulus": Limit(1e6, 1e13, "Pa", "give the modulus in pascals (steel 206e9)"),
    "poisson_ratio": Limit(0.0, 0.4999, remedy="give Poisson's ratio of a compressible solid (steel 0.3)"),
    "density": Limit(1.0, 1e5, "kg/m3", "give the density in kg/m3 (steel 7850)"),
    "thermal_expansion": Limit(0.0, 1e-3, "1/K", "give the coefficient per kelvin (steel 11.5e-6)"),
    "conductivity": Limit(1e-3, 1e5, "W/(m K)", "give the thermal conductivity in W/(m K) (steel 46)"),
    "heat_capacity": Limit(10.0, 1e5, "J/(kg K)", "give the heat capacity in J/(kg K) (steel 470)"),
}
"""What the numbers of a material may be."""


@dataclass(frozen=True)
class Material:
    """Linear elastic, isotropic material.

    The values are checked by the `gears.GearPair` that uses them, so that all faults of a pair come at
    once; `faults` checks a material on its own.

    Parameters
    ----------
    youngs_modulus : float
        E [Pa].
    poisson_ratio : float
        nu [-].
    density : float
        Mass density [kg/m3].
    thermal_expansion : float
        Coefficient of linear expansion alpha [1/K]; of steel unless given.
    conductivity : float
        Of heat, k [W/(m K)]; of steel unless given.
    heat_capacity : float
        c per mass [J/(kg K)]; of steel unless given.

    Examples
    --------
    >>> polyamide = Material(youngs_modulus=3e9, poisson_ratio=0.4, density=1140.0)
    >>> polyamide.shear_modulus / 1e9
    1.0714285714285714
    """

    youngs_modulus: float  # E, Pa
    poisson_ratio: float  # nu, -
    density: float  # kg/m3
    thermal_expansion: float = 11.5e-6  # alpha, 1/K
    conductivity: float = 46.0  # k, W/(m K)
    heat_capacity: float = 470.0  # c, J/(kg K)

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def plane_strain_modulus(self) -> float:
        """E* = E / (1 - nu^2) [Pa]."""
        return self.youngs_modulus / (1.0 - self.poisson_ratio**2)

    def faults(self, path: str = "material") -> tuple[Fault, ...]:
        """All faults of the values, empty when there are none."""
        return tuple(Faults.of(self, LIMITS, f"{path}.").found)


STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
"""Steel with the modulus on which ISO 6336-1 bases its tooth stiffness."""


def reduced_modulus(first: Material, second: Material) -> float:
    """Reduced modulus of two bodies in line contact.

    E' = 2 / [(1 - nu1^2)/E1 + (1 - nu2^2)/E2], which is twice the contact modulus E* of Johnson.

    Parameters
    ----------
    first, second : Material
        The two bodies.

    Returns
    -------
    float
        E' [Pa].

    Examples
    --------
    >>> reduced_modulus(STEEL, STEEL) / 1e9
    226.37...
    """
    return 2.0 / (1.0 / first.plane_strain_modulus + 1.0 / second.plane_strain_modulus)
