"""Heat between gas and grains: Nusselt numbers, and the exchange coefficient they make.

Every Nusselt law has one signature, `law(alpha_g, reynolds, prandtl)`, with reynolds = Re_p = rho_g d s/mu_g of the
interstitial slip; every closure has one, `closure(alpha_g, nusselt, gas_conductivity, diameter)`, and returns
eps/alpha_p [W/(m3 K)], finite for alpha_p -> 0:

    Q = eps (T_g - T_p) [W/m3] heats the grains (and -Q the gas),   eps = alpha_p * closure(...)
"""

import math

from sdph.laws.compiled import law


@law
def prandtl_number(viscosity, heat_capacity, conductivity):
    """Pr = mu c_p/k [-]. viscosity [Pa s], heat_capacity [J/(kg K)], conductivity [W/(m K)]."""
    return viscosity * heat_capacity / conductivity


@law
def gunn_interstitial(alpha_g, reynolds, prandtl):
    """Gunn's Nusselt number with x = Re_p, as Fluent and OpenFOAM evaluate it.

    Larger than `gunn` by 53 % at alpha_g = 0.4, Re_p = 195.
    """
    a, root = alpha_g, prandtl ** (1.0 / 3.0)
    film = (7.0 - 10.0 * a + 5.0 * a * a) * (1.0 + 0.7 * reynolds**0.2 * root)
    return film + (1.33 - 2.4 * a + 1.2 * a * a) * reynolds**0.7 * root


@law
def gunn(alpha_g, reynolds, prandtl):
    """Nu [-] = (7 - 10a + 5a^2)(1 + 0.7 x^0.2 Pr^1/3) + (1.33 - 2.4a + 1.2a^2) x^0.7 Pr^1/3, a = alpha_g,
    x = alpha_g Re_p (superficial). 0.35 < alpha_g <= 1, x < 1e5.

    Gunn 1978, Int. J. Heat Mass Transfer 21, 467, doi 10.1016/0017-9310(78)90080-7; Chen et al. 2014, Eq. (5).
    """
    return gunn_interstitial(alpha_g, alpha_g * reynolds, prandtl)


@law
def ranz_marshall(alpha_g, reynolds, prandtl):
    """Nu [-] = 2 + 0.6 Re_p^1/2 Pr^1/3. A lone sphere (alpha_g near 1, not used), Re_p < 200, 0.6 < Pr < 380.

    Ranz & Marshall 1952, Chem. Eng. Prog. 48, 141 and 173.
    """
    return 2.0 + 0.6 * math.sqrt(reynolds) * prandtl ** (1.0 / 3.0)


@law
def exchange_geometric(alpha_g, nusselt, gas_conductivity, diameter):
    """eps/alpha_p [W/(m3 K)] = (6/d) h, h = Nu k_g/d: the surface of spheres per volume of spheres."""
    return 6.0 * nusselt * gas_conductivity / diameter**2


@law
def exchange_paper(alpha_g, nusselt, gas_conductivity, diameter):
    """eps/alpha_p [W/(m3 K)] = alpha_g (6/d) h. Chen et al. 2014, Eq. (4); Fluent 12 Theory Guide, Eq. (16.5-103)."""
    return alpha_g * exchange_geometric(alpha_g, nusselt, gas_conductivity, diameter)


LAWS = {"gunn": gunn, "gunn_interstitial": gunn_interstitial, "ranz_marshall": ranz_marshall}
CLOSURES = {"geometric": exchange_geometric, "paper": exchange_paper}
