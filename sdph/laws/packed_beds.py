"""Conduction of heat in beds of grains that touch in points, with gas at rest among them.

A bed of conductivity k_bed has gas and grains at one temperature. The gas is solved for apart and conducts alpha_g k_g
(docs/theory/gas.md), so that the grains have what is left: K = k_bed - alpha_g k_g. Both together are the bed, and a
cloud of few grains conducts as the gas: K/alpha_p -> k_g. Syamlal & Gidaspow 1985, AIChE J. 31, 127, and Kuipers,
Prins & van Swaaij 1992, AIChE J. 38, 1079, give the gas (1 - sqrt(alpha_p)) k_g: that needs a gas that conducts so, and
their K/alpha_p has no limit. All for 0 < alpha_p < 1 and grains that conduct no less than the gas.
"""

import math

from sdph.laws.compiled import law

SPHERES = 1.25  # C of B = C (alpha_p/alpha_g)^(10/9): Zehner & Schluender 1970
NEAR = 0.03  # of N = 1 - B k_g/k_p, below which the closed form loses more digits than its series; our choice
TERMS = 8  # of that series: NEAR^8 is 7e-13


@law
def zehner_schluender_core(alpha_p, ratio):
    """Conductivity of the inner part of Zehner & Schluender's cell over that of the gas [-], ratio = k_p/k_g [-].

    2/N [(B/N^2)(1 - 1/ratio) ln(ratio/B) - (B + 1)/2 - (B - 1)/N], N = 1 - B/ratio, B = 1.25 (alpha_p/alpha_g)^(10/9);
    its series in N about N = 0, where it is 0/0. Contact areas, radiation and narrow gaps (Knudsen) are left out.
    """
    B = SPHERES * (alpha_p / (1.0 - alpha_p)) ** (10.0 / 9.0)
    N, found = 1.0 - B / ratio, 0.0
    if abs(N) < NEAR:
        for k in range(TERMS, 0, -1):
            found = found * N + 2.0 * ((B - 1.0) / (k + 2.0) + 1.0 / (k + 1.0))
        return found
    return 2.0 / N * (B / N**2 * (1.0 - 1.0 / ratio) * math.log(ratio / B) - 0.5 * (B + 1.0) - (B - 1.0) / N)


@law
def zehner_schluender(alpha_p, grains, gas):
    """k_bed [W/(m K)] = k_g [1 - sqrt(alpha_p) + sqrt(alpha_p) core], k_p of `grains` and k_g of `gas` [W/(m K)].

    Zehner & Schluender 1970, Chem.-Ing.-Tech. 42, 933.
    """
    root = math.sqrt(alpha_p)
    return gas * (1.0 - root + root * zehner_schluender_core(alpha_p, grains / gas))


@law
def beside_gas(alpha_p, grains, gas):
    """K [W/(m K)] = k_bed - alpha_g k_g = k_g sqrt(alpha_p) [sqrt(alpha_p) + core - 1]: what the grains have of it."""
    root = math.sqrt(alpha_p)
    return gas * root * (root + zehner_schluender_core(alpha_p, grains / gas) - 1.0)
