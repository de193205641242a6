"""Vapour that is no ideal gas, and its saturation: cubic equations of state, Antoine's curve, heat of vaporisation.

Both equations are p = R T/(V - b) - A(T)/[V (V + b)], V [m3/kmol], with A(T) [Pa m6/kmol2] of

    srk                  a [1 + m (1 - sqrt(T/Tc))]^2        Soave 1972, Chem. Eng. Sci. 27, 1197
    redlich_kwong_paper  a/sqrt(T)                           Redlich & Kwong 1949, Chem. Rev. 44, 233

Qiang et al. 2017 (Chin. J. Energ. Mater. 25, 372, Eq. 4) print the second under the name of the first, with rho for p.
With their a and b the critical point is 346 K and 5.1 MPa, that of no kerosene: it is kept for comparison alone.
"""

import math
from typing import NamedTuple

from sdph.laws import evaporation
from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT

A_CRITICAL, B_CRITICAL = 0.42748, 0.08664  # of R^2 Tc^2/pc and R Tc/pc: Redlich & Kwong 1949
PAPER = 12.95e6, 4.9e-2  # a [Pa m6 K^0.5/kmol2], b [m3/kmol]: Qiang et al. 2017, read in SI


class Vapour(NamedTuple):
    """One substance: paper (1 of `redlich_kwong_paper`, else 0), a, b, Tc [K], m; Antoine's A [log10 Pa], B, C [K];
    molar mass W [kg/kmol], heat of vaporisation L [J/kg], heat along the saturation curve c_sat [J/(kg K)], ratio of
    heats gamma."""

    paper: int
    attraction: float
    covolume: float
    critical_temperature: float
    slope: float
    antoine_a: float
    antoine_b: float
    antoine_c: float
    molar_mass: float
    latent_heat: float
    heat_capacity: float
    heat_ratio: float


@law
def srk(critical_temperature, critical_pressure, acentric):
    """a [Pa m6/kmol2], b [m3/kmol], m [-] from the critical point [K], [Pa] and Pitzer's acentric factor. Soave
    1972."""
    thermal = GAS_CONSTANT * critical_temperature
    a, b = A_CRITICAL * thermal * thermal / critical_pressure, B_CRITICAL * thermal / critical_pressure
    return a, b, 0.480 + 1.574 * acentric - 0.176 * acentric * acentric


@law
def attraction(v, temperature):
    """A(T) [Pa m6/kmol2], as above."""
    if v.paper == 1:
        return v.attraction / math.sqrt(temperature)
    bent = 1.0 + v.slope * (1.0 - math.sqrt(temperature / v.critical_temperature))
    return v.attraction * bent * bent


@law
def pressure(v, volume, temperature):
    """p [Pa] of a molar volume [m3/kmol] at T [K], as above."""
    repulsion = GAS_CONSTANT * temperature / (volume - v.covolume)
    return repulsion - attraction(v, temperature) / (volume * (volume + v.covolume))


@law
def compressibility(v, pressure, temperature):
    """Z [-] of the vapour: the largest root of Z^3 - Z^2 + (A - B - B^2) Z - A B, A = A(T) p/(R T)^2, B = b p/(R T).

    By Cardano and Viete; one Newton step takes off the round-off of the closed form.
    """
    thermal = GAS_CONSTANT * temperature
    a, b = attraction(v, temperature) * pressure / (thermal * thermal), v.covolume * pressure / thermal
    linear, constant = a - b - b * b, -a * b
    p, q = linear - 1.0 / 3.0, linear / 3.0 - 2.0 / 27.0 + constant
    inside = 0.25 * q * q + p * p * p / 27.0
    if inside > 0.0:
        both = -0.5 * q + math.copysign(math.sqrt(inside), -q)
        root = math.copysign(abs(both) ** (1.0 / 3.0), both)
        z = root - p / (3.0 * root) + 1.0 / 3.0
    else:
        spread = math.sqrt(-p / 3.0)
        z = 2.0 * spread * math.cos(math.acos(-0.5 * q / spread**3) / 3.0) + 1.0 / 3.0
    return z - (((z - 1.0) * z + linear) * z + constant) / ((3.0 * z - 2.0) * z + linear)


@law
def density(v, pressure, temperature):
    """rho_v [kg/m3] = p W/(Z R T) of the vapour."""
    return pressure * v.molar_mass / (compressibility(v, pressure, temperature) * GAS_CONSTANT * temperature)


@law
def saturation_pressure(v, temperature):
    """p_sat [Pa] by Antoine's curve."""
    return evaporation.saturation_antoine(temperature, (v.antoine_a, v.antoine_b, v.antoine_c))


@law
def saturation_temperature(v, pressure):
    """T_sat [K] by Antoine's curve."""
    return evaporation.boiling_temperature_antoine(pressure, (v.antoine_a, v.antoine_b, v.antoine_c))


@law
def saturated_density(v, temperature):
    """Density of the saturated vapour [kg/m3]."""
    return density(v, saturation_pressure(v, temperature), temperature)


@law
def latent_heat_of_curve(v, temperature, liquid_density):
    """L [J/kg] = T dp_sat/dT (1/rho_v - 1/rho_l), of the curve's slope ln(10) B p/(T + C)^2. Clapeyron 1834."""
    p = saturation_pressure(v, temperature)
    slope = math.log(10.0) * v.antoine_b * p / (temperature + v.antoine_c) ** 2
    return temperature * slope * (1.0 / density(v, p, temperature) - 1.0 / liquid_density)
