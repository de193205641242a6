"""Drag between gas and grains.

Every law has one signature, `law(alpha_p, slip, diameter, gas_density, gas_viscosity)`, and returns
beta/alpha_p [kg/(m3 s)], finite for alpha_p -> 0 and for slip -> 0, so that laws are interchangeable:

    R = beta (v_g - v_p) [N/m3] pulls the grains (and -R the gas),   beta = alpha_p * law(...)
    acceleration of a grain = law(...)/rho_p (v_g - v_p),            momentum time of a grain = rho_p/law(...)

alpha_p solid volume fraction [-] (below 1), slip = |v_g - v_p| of interstitial velocities [m/s], diameter [m],
gas_density [kg/m3], gas_viscosity [Pa s]. beta belongs to "model A": the grains also feel -alpha_p grad P.
Names ending in `_paper` switch the drag coefficient on Re_p, as Chen, Qiang & Gao 2014 print it, not on alpha_g Re_p.
"""

import math

import scipy

from sdph.laws.compiled import law

NEWTON_REYNOLDS = 1000.0  # -, Reynolds number from which the drag coefficient is constant (Rowe 1961)
NEWTON_COEFFICIENT = 0.44  # -, its value there
PUTNAM_COEFFICIENT = 0.424  # -, of a sphere above Re = 1000: Putnam 1961
WEN_YU_EXPONENT = -2.65  # -, of the gas fraction (Wen & Yu 1966)
CLUSTERS_END = 0.59  # -, volume fraction from which on no clusters are lost to a filter (Igci & Sundaresan 2011)
DENSE_GAS_FRACTION = 0.8  # -, below it Ergun holds (Gidaspow 1994)


@law
def particle_reynolds(slip, diameter, gas_density, gas_viscosity):
    """Re_p = rho_g d s/mu_g [-], of the interstitial slip."""
    return gas_density * diameter * slip / gas_viscosity


@law
def _viscous_coefficient(x):
    """C_D x [-] of Schiller & Naumann 1935 below x = 1000: 24 (1 + 0.15 x^0.687). Finite at x = 0."""
    return 24.0 * (1.0 + 0.15 * x**0.687)


@law
def coefficient_times_reynolds(x):
    """C_D x [-]: C_D = 24/x (1 + 0.15 x^0.687) for x < 1000, else 0.44 (there it jumps by +0.4 %). Finite at x = 0.

    Schiller & Naumann 1935, VDI-Z. 77, 318; x = alpha_g Re_p in crowds, as Gidaspow 1994, MFIX and OpenFOAM.
    """
    return _viscous_coefficient(x) if x < NEWTON_REYNOLDS else NEWTON_COEFFICIENT * x


@law
def coefficient_times_reynolds_paper(x, reynolds):
    """C_D x [-] of x = alpha_g Re_p, but switched on Re_p = 1000: C_D jumps by 5.5 % at alpha_g = 0.85.

    Chen et al. 2014, section 2.1.
    """
    return _viscous_coefficient(x) if reynolds < NEWTON_REYNOLDS else NEWTON_COEFFICIENT * x


@law
def stokes(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 18 mu_g/d^2. A lone sphere at Re_p << 1. Stokes 1851, Trans. Camb. Phil. Soc. 9, 8."""
    return 18.0 * gas_viscosity / diameter**2


@law
def schiller_naumann(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 3/4 C_D rho_g s/d, C_D(Re_p). A lone sphere, no crowding: alpha_p < 0.01, Re_p < 2e5.

    Schiller & Naumann 1935, VDI-Z. 77, 318.
    """
    reynolds = particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    return 0.75 * coefficient_times_reynolds(reynolds) * gas_viscosity / diameter**2


@law
def putnam(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 3/4 C_D rho_g s/d, C_D Re_p = 24 (1 + Re_p^(2/3)/6), 0.424 Re_p above 1000. A lone sphere.

    Putnam 1961, ARS J. 31, 1467; the `sphereDrag` of OpenFOAM.
    """
    x = particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    drag = 24.0 * (1.0 + x ** (2.0 / 3.0) / 6.0) if x <= NEWTON_REYNOLDS else PUTNAM_COEFFICIENT * x
    return 0.75 * drag * gas_viscosity / diameter**2


@law
def ergun(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 150 alpha_p mu_g/(alpha_g d^2) + 1.75 rho_g s/d. Packed grains, alpha_p > 0.2.

    Ergun 1952, Chem. Eng. Prog. 48, 89; as beta: Gidaspow 1994; Chen et al. 2014, section 2.1.
    """
    viscous = 150.0 * alpha_p * gas_viscosity / ((1.0 - alpha_p) * diameter**2)
    return viscous + 1.75 * gas_density * slip / diameter


@law
def wen_yu(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 3/4 C_D alpha_g rho_g s/d alpha_g^-2.65, C_D(alpha_g Re_p). Dilute, alpha_p < 0.2.

    Wen & Yu 1966, Chem. Eng. Prog. Symp. Ser. 62, 100; Gidaspow 1994; Chen et al. 2014, section 2.1.
    """
    alpha_g = 1.0 - alpha_p
    x = alpha_g * particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    return 0.75 * coefficient_times_reynolds(x) * gas_viscosity / diameter**2 * alpha_g**WEN_YU_EXPONENT


@law
def wen_yu_paper(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """Wen & Yu with the drag coefficient switched on Re_p. Chen et al. 2014, section 2.1."""
    alpha_g = 1.0 - alpha_p
    reynolds = particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    drag = coefficient_times_reynolds_paper(alpha_g * reynolds, reynolds)
    return 0.75 * drag * gas_viscosity / diameter**2 * alpha_g**WEN_YU_EXPONENT


@law
def dilute_weight(alpha_p):
    """Weight of Wen-Yu [-] = atan(150*1.75 (0.2 - alpha_p))/pi + 1/2: 0.994 dilute, 1/2 at 0.2, 0.003 packed.

    Huilin & Gidaspow 2003, Chem. Eng. Sci. 58, 3777; MFIX; Chen et al. 2014, section 2.1.
    """
    return math.atan(150.0 * 1.75 * (1.0 - DENSE_GAS_FRACTION - alpha_p)) / math.pi + 0.5


@law
def gidaspow(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = (1 - phi) Ergun + phi Wen-Yu, phi = `dilute_weight`: smooth over all alpha_p.

    Huilin & Gidaspow 2003, Chem. Eng. Sci. 58, 3777; Chen et al. 2014, section 2.1.
    """
    phi = dilute_weight(alpha_p)
    dense = ergun(alpha_p, slip, diameter, gas_density, gas_viscosity)
    return (1.0 - phi) * dense + phi * wen_yu(alpha_p, slip, diameter, gas_density, gas_viscosity)


@law
def gidaspow_paper(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """`gidaspow` with the drag coefficient switched on Re_p. Chen et al. 2014, section 2.1."""
    phi = dilute_weight(alpha_p)
    dense = ergun(alpha_p, slip, diameter, gas_density, gas_viscosity)
    return (1.0 - phi) * dense + phi * wen_yu_paper(alpha_p, slip, diameter, gas_density, gas_viscosity)


@law
def gidaspow_switch(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """Ergun for alpha_g < 0.8, else Wen-Yu: jumps at 0.8. Gidaspow 1994, Multiphase Flow and Fluidization, ch. 2."""
    if 1.0 - alpha_p < DENSE_GAS_FRACTION:
        return ergun(alpha_p, slip, diameter, gas_density, gas_viscosity)
    return wen_yu(alpha_p, slip, diameter, gas_density, gas_viscosity)


@law
def _terminal_velocity_ratio(alpha_g, reynolds):
    """v_r [-], terminal velocity of the suspension over that of a lone sphere.

    Garside & Al-Dibouni 1977, Ind. Eng. Chem. Proc. Des. Dev. 16, 206; exponents of Syamlal & O'Brien 1987.
    """
    a = alpha_g**4.14
    b = 0.8 * alpha_g**1.28 if alpha_g <= 0.85 else alpha_g**2.65
    x = 0.06 * reynolds
    return 0.5 * (a - x + math.sqrt(x * x + 2.0 * x * (2.0 * b - a) + a * a))


@law
def syamlal_obrien(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 3/4 C_D alpha_g rho_g s/(v_r^2 d), C_D = (0.63 + 4.8 sqrt(v_r/Re_p))^2 (Dalla Valle).

    Fluidised beds of all densities. Syamlal & O'Brien 1987 (as in the MFIX and Fluent theory guides).
    Its dilute Stokes limit is 17.28 mu/d^2; it jumps by 0.1 % at alpha_g = 0.85.
    """
    reynolds = particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    v_r = _terminal_velocity_ratio(1.0 - alpha_p, reynolds)
    drag = (0.63 * math.sqrt(reynolds) + 4.8 * math.sqrt(v_r)) ** 2  # C_D Re_p
    return 0.75 * (1.0 - alpha_p) * drag * gas_viscosity / (v_r * diameter) ** 2


@law
def di_felice(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 3/4 C_D rho_g s/d alpha_g^(2-chi), C_D = (0.63 + 4.8/sqrt x)^2, x = alpha_g Re_p,
    chi = 3.7 - 0.65 exp(-(1.5 - log10 x)^2/2). All alpha_p and Re_p.

    Di Felice 1994, Int. J. Multiphase Flow 20, 153; in model A: Zhou et al. 2010, J. Fluid Mech. 661, 482.
    """
    alpha_g = 1.0 - alpha_p
    x = alpha_g * particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    chi = 3.7 - 0.65 * math.exp(-0.5 * (1.5 - math.log10(x)) ** 2) if x > 0.0 else 3.7
    drag = (0.63 * math.sqrt(x) + 4.8) ** 2  # C_D x
    return 0.75 * drag * gas_viscosity / diameter**2 * alpha_g ** (1.0 - chi)


@law
def beetstra(alpha_p, slip, diameter, gas_density, gas_viscosity):
    """beta/alpha_p = 18 mu_g alpha_g F/d^2, x = alpha_g Re_p, n = (1 + 4 alpha_p)/2,

    F = 10 alpha_p/alpha_g^2 + alpha_g^2 (1 + 1.5 sqrt(alpha_p))
        + 0.413 x/(24 alpha_g^2) (1/alpha_g + 3 alpha_p alpha_g + 8.4 x^-0.343)/(1 + 10^(3 alpha_p) x^-n).

    Equal spheres, 0.1 <= alpha_p <= 0.6, x <= 1000: a fit to lattice-Boltzmann simulations, not to lone spheres (over
    Schiller & Naumann by 16 % at Re_p = 100, 68 % at 1000). Slow and dilute it is Stokes', slow and dense Carman &
    Kozeny's 180 alpha_p mu_g/(alpha_g d^2), to 0.9 % at alpha_p = 0.6.

    Beetstra, van der Hoef & Kuipers 2007, AIChE J. 53, 489; as beta: the `Beetstra` of OpenFOAM.
    """
    alpha_g = 1.0 - alpha_p
    x = alpha_g * particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    power = x ** (0.5 + 2.0 * alpha_p)  # both sides of the quotient times it: finite at x = 0
    crowd = x * (1.0 / alpha_g + 3.0 * alpha_p * alpha_g) + 8.4 * x**0.657
    inertial = 0.413 / 24.0 * power * crowd / (power + 10.0 ** (3.0 * alpha_p))
    viscous = 10.0 * alpha_p + alpha_g**4 * (1.0 + 1.5 * math.sqrt(alpha_p))
    return 18.0 * gas_viscosity * (viscous + inertial) / (alpha_g * diameter**2)


def terminal_velocity(diameter, density_difference, gas_density, gas_viscosity, gravity):
    """Speed [m/s] at which a lone grain falls, by Schiller & Naumann: its weight less the gas's, difference of
    densities [kg/m3] by gravity [m/s2], is its drag."""
    heaviest = density_difference * gravity / stokes(0.0, 0.0, diameter, gas_density, gas_viscosity)

    def spare(v):
        return density_difference * gravity - schiller_naumann(0.0, v, diameter, gas_density, gas_viscosity) * v

    return scipy.optimize.brentq(spare, 0.0, heaviest, xtol=1e-12 * heaviest) if heaviest > 0.0 else 0.0


def igci_filter(width):
    """Share f [-] of the effect of clusters that a filter takes out, x^1.6/(x^1.6 + 0.4) of its width x = g Delta/v_t^2
    [-]: 0 where all is resolved, 1 where nothing is. v_t is that of a lone grain.

    Igci & Sundaresan 2011, Ind. Eng. Chem. Res. 50, 13190; as in MFIX, which takes Stokes' v_t.
    """
    return width**1.6 / (width**1.6 + 0.4)


@law
def igci_clusters(alpha_p):
    """Share [-] of the drag that is lost to clusters no finer than any filter resolves, h(alpha_p) g(alpha_p): the
    filtered drag is (1 - f h g) times that of the law. 0 from alpha_p = 0.59 on.

    Fits of resolved flow of 75 um grains of 1500 kg/m3 in air with Wen & Yu's drag, in periodic boxes, of
    g Delta/v_t^2 = 2 to 16; g makes those in two dimensions three-dimensional. Igci & Sundaresan 2011, Ind. Eng. Chem.
    Res. 50, 13190; as in MFIX.
    """
    if alpha_p >= CLUSTERS_END:
        return 0.0
    return _igci_planar(alpha_p) * (alpha_p**0.24 * (1.48 + math.exp(-18.0 * alpha_p)) if alpha_p < 0.18 else 1.0)


@law
def _igci_planar(alpha_p):
    """h(alpha_p) [-] of `igci_clusters`; its pieces meet within 0.003."""
    if alpha_p < 0.0012:
        return 2.7 * alpha_p**0.234
    if alpha_p < 0.014:
        return 0.963 - 0.019 * alpha_p**-0.455
    if alpha_p < 0.25:
        return 0.868 * math.exp(-0.38 * alpha_p) - 0.176 * math.exp(-119.2 * alpha_p)
    if alpha_p < 0.455:
        return 0.852 * math.exp(-0.268 * alpha_p) - 4.59e-5 * math.exp(19.75 * alpha_p)
    return (alpha_p - CLUSTERS_END) * (((2203.0 - 1501.0 * alpha_p) * alpha_p - 1054.0) * alpha_p + 162.0)
