"""Diffusion of a vapour in a gas at low pressure."""

from __future__ import annotations

import math

# diffusion volumes [cm3/mol] of molecules, of atoms within one, and what an aromatic ring takes off (Fuller, Ensley &
# Giddings 1969, J. Phys. Chem. 73, 3679; Poling, Prausnitz & O'Connell 2001, table 11-1)
MOLECULES = {
    "Air": 19.7, "Nitrogen": 18.5, "Oxygen": 16.3, "CarbonDioxide": 26.9, "Argon": 16.2, "Helium": 2.67,
    "Hydrogen": 6.12, "Water": 13.1, "Ammonia": 20.7,
}  # fmt: skip
ATOMS = {"C": 15.9, "H": 2.31, "O": 6.11, "N": 4.54, "F": 14.7, "Cl": 21.0, "Br": 21.9, "I": 29.8, "S": 22.9}
RING = 18.3


def fuller(temperature, pressure, masses, volumes):
    """Diffusivity [m2/s] of two gases in each other: 1e-7 T^1.75 sqrt(1/M_1 + 1/M_2)/(p [v_1^(1/3) + v_2^(1/3)]^2), p
    in atmospheres.

    Fuller, Schettler & Giddings 1966, Ind. Eng. Chem. 58, 18: 4 % off measured ones in the mean, below some 10 bar.
    T [K], p [Pa], pairs of molar masses M [kg/kmol] and of diffusion volumes v [cm3/mol].
    """
    apart = sum(volume ** (1.0 / 3.0) for volume in volumes)
    light = math.sqrt(sum(1.0 / mass for mass in masses))
    return 1e-7 * temperature**1.75 * light / (pressure / 101325.0 * apart * apart)
