"""Properties of the gas and its vapour: mass-weighted mixtures, and the equation of state."""

from __future__ import annotations

import numpy as np

from sdph.case.read import CaseError
from sdph.laws.eos import ideal_gas_density
from sdph.laws.evaporation import mixture_molar_mass


class Properties:
    """Mixture properties of a case. Y is the mass fraction of vapour, an array or 0.0 where there is none."""

    def __init__(self, case):
        self.gas, self.vapour = case.gas, case.vapour
        laws = {"constant": self._constant, "operating": self._operating}
        if case.gas.equation_of_state not in laws:
            raise CaseError(
                f"gas.equation_of_state = {case.gas.equation_of_state!r}; the embedded gas solver has "
                f"{' and '.join(laws)}: "
                "choose one of these, or take OpenFOAM (--gas openfoam)"
            )
        self.density = laws[case.gas.equation_of_state]
        self.varies = case.gas.equation_of_state != "constant"

    def mixture(self, name: str, Y):
        """Mass-weighted mean of `name`: "viscosity", "conductivity" or "heat_capacity"."""
        pure = getattr(self.gas, name)
        return pure if self.vapour is None else pure + Y * (getattr(self.vapour, name) - pure)

    def _constant(self, T, Y):
        return np.full(np.shape(T), self.gas.density)

    def _operating(self, T, Y):
        """p_op M/(R T) with 1/M = (1 - Y)/M_g + Y/M_v [kg/m3]."""
        molar_mass = self.gas.molar_mass
        if self.vapour is not None:
            molar_mass = mixture_molar_mass(Y, self.vapour.molar_mass, molar_mass)
        return ideal_gas_density(self.gas.operating_pressure, T, molar_mass)
