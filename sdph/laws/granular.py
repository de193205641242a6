"""Kinetic theory of granular flow: pressure, transport and decay of the granular temperature theta.

Viscosities returned here are TOTAL: stress tau = 2 mu dev(D) + lambda tr(D) I with D = (grad v + grad v^T)/2 and
nothing to multiply by alpha_p. Chen, Qiang & Gao 2014 (section 2.1) write tau = alpha_p mu (...), so their mu_col,
mu_kin, lambda are the values here divided by alpha_p.

Arguments throughout: alpha_p [-], theta [m2/s2] (a third of the mean square fluctuation), restitution e [-],
g0 [-] from a radial-distribution law, density rho_p of the grain material [kg/m3], diameter [m]. Rapid flow of
nearly elastic spheres: e > 0.8, alpha_p < alpha_max. Sources: Lun, Savage, Jeffrey & Chepurniy 1984, J. Fluid Mech.
140, 223; Gidaspow 1994, Multiphase Flow and Fluidization, ch. 9; checked against OpenFOAM's kineticTheoryModels.
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import PACKING_MARGIN

# of `streaming_share`: mu_kin = 10/96 and (2/3) k_kin = 25/96 of rho_p d sqrt(pi theta)/((1 + e) g0) without crowding
STREAMING_MOMENTUM, STREAMING_AGITATION = 10.0, 25.0


@law
def capped_fraction(alpha_p, alpha_max):
    """alpha_p [-] at which closures are evaluated: at most alpha_max - 0.01, short of the pole of g0."""
    return min(alpha_p, alpha_max - PACKING_MARGIN)


@law
def sinclair_jackson(alpha_p, alpha_max):
    """g0 [-] = 1/(1 - (alpha_p/alpha_max)^(1/3)) = (s + d)/s, s the mean gap. alpha_p < alpha_max (pole).

    Sinclair & Jackson 1989, AIChE J. 35, 1473.
    """
    return 1.0 / (1.0 - (alpha_p / alpha_max) ** (1.0 / 3.0))


@law
def sinclair_jackson_slope(alpha_p, alpha_max):
    """dg0/dalpha_p [-] = x/(3 alpha_p (1 - x)^2), x = (alpha_p/alpha_max)^(1/3); alpha_p > 0 (infinite at 0)."""
    x = (alpha_p / alpha_max) ** (1.0 / 3.0)
    return 1.0 / (3.0 * alpha_max * x * x * (1.0 - x) ** 2)


@law
def crowding(alpha_p, alpha_max):
    """g0 [-] at which closures are evaluated."""
    return sinclair_jackson(capped_fraction(alpha_p, alpha_max), alpha_max)


@law
def crowding_slope(alpha_p, g0):
    """dg0/dalpha_p [-] = g0 (g0 - 1)/(3 alpha_p) of Sinclair & Jackson's g0; alpha_p > 0."""
    return g0 * (g0 - 1.0) / (3.0 * alpha_p)


@law
def lun_pressure(alpha_p, theta, restitution, g0, density):
    """p_s [Pa] = alpha_p rho_p theta (1 + 2 (1 + e) alpha_p g0). Lun et al. 1984."""
    return alpha_p * density * theta * (1.0 + 2.0 * (1.0 + restitution) * alpha_p * g0)


@law
def lun_pressure_slope(alpha_p, theta, restitution, g0, g0_slope, density):
    """dp_s/dalpha_p [Pa] at constant theta = rho_p theta (1 + 2 (1 + e) alpha_p (2 g0 + alpha_p g0'))."""
    return density * theta * (1.0 + 2.0 * (1.0 + restitution) * alpha_p * (2.0 * g0 + alpha_p * g0_slope))


@law
def sound_speed_squared(alpha_p, theta, restitution, g0, g0_slope, density, friction_slope):
    """c^2 [m2/s2] of an isentropic sound wave through the grains, dp/d(alpha_p rho_p) at constant fluctuation entropy:

    c^2 = (dp_s/dalpha_p + dp_fr/dalpha_p)/rho_p + (2/3) theta (p_s/theta)^2/(alpha_p rho_p)^2, for alpha_p > 0.
    friction_slope = dp_fr/dalpha_p [Pa]. From d theta = (2/3) p_s/(alpha_p rho_p)^2 d(alpha_p rho_p).
    """
    slope = lun_pressure_slope(alpha_p, theta, restitution, g0, g0_slope, density) + friction_slope
    return slope / density + 2.0 / 3.0 * theta * (1.0 + 2.0 * (1.0 + restitution) * alpha_p * g0) ** 2


@law
def gidaspow_collisional_viscosity(alpha_p, theta, restitution, g0, density, diameter):
    """Total mu_col [Pa s] = 4/5 alpha_p^2 rho_p d g0 (1 + e) sqrt(theta/pi). Gidaspow 1994; = alpha_p * paper's."""
    return 0.8 * alpha_p**2 * density * diameter * g0 * (1.0 + restitution) * math.sqrt(theta / math.pi)


@law
def gidaspow_kinetic_viscosity(alpha_p, theta, restitution, g0, density, diameter):
    """Total mu_kin [Pa s] = 10 rho_p d sqrt(pi theta)/(96 (1 + e) g0) [1 + 4/5 g0 alpha_p (1 + e)]^2.

    Gidaspow 1994; = alpha_p * paper's, whose own 1/alpha_p makes it infinite at alpha_p = 0.
    """
    stretch = (1.0 + 0.8 * g0 * alpha_p * (1.0 + restitution)) ** 2
    return 10.0 * density * diameter * math.sqrt(math.pi * theta) * stretch / (96.0 * (1.0 + restitution) * g0)


@law
def streaming_share(alpha_p, restitution, g0, diameter, factor, h):
    """Share, 1 at most, of a kinetic coefficient that is left where grains stream freely over no more than h [m].

    Between collisions momentum and agitation go sqrt(theta) times a free path, factor sqrt(pi) d/(96 (1 + e) alpha_p
    g0), which grows without bound as alpha_p vanishes. factor: STREAMING_MOMENTUM or STREAMING_AGITATION. No field of a
    smoothing length h tells of longer ones; our choice.
    """
    return min(1.0, 96.0 * (1.0 + restitution) * alpha_p * g0 * h / (factor * math.sqrt(math.pi) * diameter))


@law
def gidaspow_viscosity(alpha_p, theta, restitution, g0, density, diameter, streaming=1.0):
    """Total mu [Pa s] = collisional + `streaming` times kinetic: OpenFOAM's rho*nu of the Gidaspow viscosity model."""
    collisional = gidaspow_collisional_viscosity(alpha_p, theta, restitution, g0, density, diameter)
    return collisional + streaming * gidaspow_kinetic_viscosity(alpha_p, theta, restitution, g0, density, diameter)


@law
def lun_bulk_viscosity(alpha_p, theta, restitution, g0, density, diameter):
    """Total lambda [Pa s] = 4/3 alpha_p^2 rho_p d g0 (1 + e) sqrt(theta/pi). Lun et al. 1984; = alpha_p * paper's."""
    return 4.0 / 3.0 * alpha_p**2 * density * diameter * g0 * (1.0 + restitution) * math.sqrt(theta / math.pi)


@law
def gidaspow_conductivity(alpha_p, theta, restitution, g0, density, diameter, streaming=1.0):
    """k_theta [kg/(m s)], flux of 3/2 alpha_p rho_p theta is -k_theta grad theta, its first part times `streaming`:

    k = 25 rho_p d sqrt(pi theta)/(64 (1 + e) g0) [1 + 6/5 alpha_p g0 (1 + e)]^2
        + 2 rho_p alpha_p^2 d (1 + e) g0 sqrt(theta/pi). Gidaspow 1994; Chen et al. 2014, section 2.1.
    """
    e1 = 1.0 + restitution
    stretch = (1.0 + 1.2 * alpha_p * g0 * e1) ** 2
    kinetic = 25.0 * density * diameter * math.sqrt(math.pi * theta) / (64.0 * e1 * g0) * stretch
    return streaming * kinetic + 2.0 * density * alpha_p**2 * diameter * e1 * g0 * math.sqrt(theta / math.pi)


@law
def lun_dissipation(alpha_p, theta, restitution, g0, density, diameter):
    """gamma [W/m3] = 12 (1 - e^2) g0/(d sqrt(pi)) rho_p alpha_p^2 theta^1.5. Lun et al. 1984."""
    rate = 12.0 * (1.0 - restitution**2) * g0 / (diameter * math.sqrt(math.pi))
    return rate * density * alpha_p**2 * theta**1.5


@law
def cooling_coefficient(alpha_p, restitution, g0, diameter):
    """K [1/m] of d theta/dt = -K theta^1.5, = (2/3) gamma/(alpha_p rho_p theta^1.5) with Lun's gamma.

    Haff 1983, J. Fluid Mech. 134, 401.
    """
    return 8.0 * (1.0 - restitution**2) * alpha_p * g0 / (diameter * math.sqrt(math.pi))


@law
def cooling_coefficient_paper(alpha_p, restitution, g0, diameter):
    """K [1/m] with gamma as Chen et al. 2014 print it, with alpha_p^1: larger than Lun's by 1/alpha_p; alpha_p > 0."""
    return cooling_coefficient(alpha_p, restitution, g0, diameter) / alpha_p


@law
def damping_rate(damping):
    """B [1/s] of d theta/dt = -B theta: fluctuations lost to the gas, J = -3 beta theta [W/m3] over 3/2 alpha_p rho_p.

    damping = beta/(alpha_p rho_p) [1/s]. Gidaspow 1994.
    """
    return 2.0 * damping


@law
def theta_step(theta, cooling, damping, dt):
    """theta [m2/s2] after dt [s] of d theta/dt = -K theta^1.5 - B theta, exactly, for any dt, theta, K, B >= 0:

    sqrt(theta') = 1/[(1/sqrt(theta) + K/B) exp(B dt/2) - K/B], here without the division by B.
    """
    x = 0.5 * damping * dt
    mean_decay = -math.expm1(-x) / x if x > 0.0 else 1.0  # (1 - exp(-x))/x
    root = math.sqrt(theta)
    return (root * math.exp(-x) / (1.0 + 0.5 * cooling * dt * root * mean_decay)) ** 2


@law
def equilibrium_theta(alpha_p, restitution, g0, density, diameter, shear_squared, divergence, beta):
    """theta [m2/s2] at which shear, compression, collisions and drag balance locally:

    tau:D - p_s div v = gamma + 3 beta theta. With r = sqrt(theta): G r^2 + (P div v + 3 beta) r = S,
    S = 4 mu I2D + lambda (div v)^2 per r, P = p_s/theta, G = gamma/theta^1.5; its one root >= 0.
    shear_squared = I2D [1/s2] (`second_invariant` of friction.py), divergence [1/s], beta [kg/(m3 s)]; e < 1, alpha_p >
    0. Syamlal, Rogers & O'Brien 1993, MFIX theory guide (algebraic form), here with Gidaspow's viscosities and drag.
    """
    mu = gidaspow_viscosity(alpha_p, 1.0, restitution, g0, density, diameter)
    bulk = lun_bulk_viscosity(alpha_p, 1.0, restitution, g0, density, diameter)
    source = 4.0 * mu * shear_squared + bulk * divergence**2
    sink = lun_dissipation(alpha_p, 1.0, restitution, g0, density, diameter)
    linear = lun_pressure(alpha_p, 1.0, restitution, g0, density) * divergence + 3.0 * beta
    root = math.sqrt(linear**2 + 4.0 * sink * source)
    if linear > 0.0:  # the same root, written so that nothing cancels
        return (2.0 * source / (linear + root)) ** 2
    return ((root - linear) / (2.0 * sink)) ** 2
