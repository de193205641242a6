"""What the laws make of the inputs of a reference value; `i` are its inputs."""

import math

import exact_solutions as solutions
import numpy as np
import pytest
from reference_values import BED, CONSTANTS, GAS, JET

from sdph.laws import (
    drag,
    evaporation,
    exact,
    exchange,
    friction,
    grain_loss,
    granular,
    heat,
    kernels,
    viscosity,
)

RHO_G, MU_G, K_G, CP_G = GAS["rho"], GAS["mu"], GAS["k"], GAS["cp"]
PR = heat.prandtl_number(MU_G, CP_G, K_G)
GRAVITY = CONSTANTS["g"]


# --- drag and heat


def drag_coefficient(i):
    x = i["alpha_g"] * i["Re_p"]
    paper = i["switch"] == "Re_p"
    return (drag.coefficient_times_reynolds_paper(x, i["Re_p"]) if paper else drag.coefficient_times_reynolds(x)) / x


def beta(law, i):
    gas = i.get("rho_g", RHO_G), i.get("mu_g", MU_G)
    return i["alpha_p"] * law(i["alpha_p"], i["slip"], i["d_p"], *gas)


def gunn(i):
    law = {"paper": heat.gunn, "fluent": heat.gunn_interstitial}[i["form"]]
    return law(i["alpha_g"], i["Re_p"], i["Pr"])


def exchange_coefficient(closure, alpha_p, diameter, slip):
    reynolds = drag.particle_reynolds(slip, diameter, RHO_G, MU_G)
    return alpha_p * closure(1.0 - alpha_p, heat.gunn(1.0 - alpha_p, reynolds, PR), K_G, diameter)


# --- the disc of table 1: alpha_p = 0.6, 288 K in gas of 350 K

T_P, T_G = 288.0, 350.0
C_P = exact.volumetric_heat_capacity(0.6, BED["rho"], BED["cp"])
C_G = exact.volumetric_heat_capacity(0.4, RHO_G, CP_G)
CLOSURES = {"paper": heat.exchange_paper, "geom": heat.exchange_geometric}


def disc_eps(form):
    return exchange_coefficient(CLOSURES[form], 0.6, BED["d"], 0.0)


def disc_two_way(form, t):
    return exact.two_way_temperatures(t, T_P, T_G, disc_eps(form), C_P, C_G)


def disc_box(i):
    grains = C_P * i["A_disc"]
    gas = RHO_G * CP_G * (0.25 - i["A_disc"]) + C_G * i["A_disc"]
    return solutions.equilibrium_temperature(T_P, T_G, grains, gas)


def edge_rate_ratio(i):
    def per_grain(alpha_p):
        return exchange_coefficient(heat.exchange_paper, alpha_p, BED["d"], 0.0) / alpha_p

    return per_grain(0.3) / per_grain(0.6)


# --- the jet of table 3: alpha_p = 0.6, 294 K in gas of 350 K


def jet_eps(i):
    return exchange_coefficient(heat.exchange_paper, 0.6, JET["d"], i["slip"])


JET_C_P = exact.volumetric_heat_capacity(0.6, JET["rho"], JET["cp"])


def jet_time_to_evaporation(i):
    t = JET_C_P / jet_eps(i) * math.log(56.0 / 55.7)
    assert exact.one_way_temperature(t, 294.0, 350.0, jet_eps(i), JET_C_P) == pytest.approx(294.3, rel=1e-12)
    return t


# --- granular temperature


def grains(law, i):
    """A law of granular.py in terms of (alpha_p, theta, e, g0, density, diameter)."""
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    return law(i["alpha_p"], i["theta"], i["e"], g0, i["rho_p"], i["d_p"])


def lun_pressure(i):
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    return granular.lun_pressure(i["alpha_p"], i["theta"], i["e"], g0, i["rho_p"])


def isothermal_sound_speed(i):
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    slope = granular.sinclair_jackson_slope(i["alpha_p"], i["alpha_max"])
    pressure_slope = granular.lun_pressure_slope(i["alpha_p"], i["theta"], i["e"], g0, slope, i["rho_p"])
    return math.sqrt(pressure_slope / i["rho_p"])


def isentropic_sound_speed(i):
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    slope = granular.sinclair_jackson_slope(i["alpha_p"], i["alpha_max"])
    return math.sqrt(granular.sound_speed_squared(i["alpha_p"], i["theta"], i["e"], g0, slope, i["rho_p"], 0.0))


def haff_coefficient(i):
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    return granular.cooling_coefficient(i["alpha_p"], i["e"], g0, i["d_p"])


def haff(i):
    exactly = solutions.haff_cooling(i["t"], i["theta0"], haff_coefficient(i))
    assert granular.theta_step(i["theta0"], haff_coefficient(i), 0.0, i["t"]) == pytest.approx(exactly, rel=1e-12)
    return exactly


def haff_with_drag(i):
    damping = granular.damping_rate(i["beta"] / (i["alpha_p"] * i["rho_p"]))
    exactly = solutions.haff_cooling_with_drag(i["t"], i["theta0"], haff_coefficient(i), damping)
    assert granular.theta_step(i["theta0"], haff_coefficient(i), damping, i["t"]) == pytest.approx(exactly, rel=1e-12)
    return exactly


def paper_dissipation(i):
    """gamma = 3/2 alpha_p rho_p K theta^1.5."""
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    cooling = granular.cooling_coefficient_paper(i["alpha_p"], i["e"], g0, i["d_p"])
    return 1.5 * i["alpha_p"] * i["rho_p"] * cooling * i["theta"] ** 1.5


def gas_damping(i):
    """J = -3/2 alpha_p rho_p B theta, of any grains."""
    grains = 0.3 * BED["rho"]
    return -1.5 * grains * granular.damping_rate(i["beta"] / grains) * i["theta"]


def yielding(i):
    """mu_fr of grains whose elastic stress, 2 mu D of a viscosity far above it, is brought down to the yield."""
    stiff = 1e6
    return stiff * friction.yield_share(i["p"], math.sin(math.radians(i["phi_deg"])), 4.0 * stiff**2 * i["I2D"])


def shear(i):
    g0 = granular.sinclair_jackson(i["alpha_p"], i["alpha_max"])
    return solutions.uniform_shear(i["shear"], i["alpha_p"], i["e"], g0, i["rho_p"], i["d_p"])


def friction_law(law, i):
    return law(i["alpha_p"], i["alpha_fr"], i["alpha_max"], i["Fr"], i["eta"], i["p"])


# --- fluidisation


def gas_of(i):
    return i["d_p"], i.get("rho_g", RHO_G), i.get("mu_g", MU_G)


def settling(law, alpha_p, i):
    return solutions.settling_slip(law, alpha_p, i["rho_p"], i.get("g", GRAVITY), *gas_of(i))


# --- evaporation, droplets of table 3

SC = evaporation.schmidt_number(RHO_G, MU_G, JET["D"])
CLAPEYRON = (JET["psat"], 294.3, JET["hfg"], JET["W"])
W_GAS = evaporation.mixture_molar_mass(0.3, 31.9988, 28.0134)  # kg/kmol, O2/N2 by mass


def jet_reynolds(slip):
    return drag.particle_reynolds(slip, JET["d"], RHO_G, MU_G)


def sherwood(slip):
    return evaporation.sherwood_ranz_marshall(jet_reynolds(slip), SC)


def ventilation(slip):
    return grain_loss.ventilation(RHO_G * slip / MU_G, SC)


def gas_exchanged(volume, i):
    """k_c A [m3/s] of droplets of that volume in all."""
    return evaporation.gas_exchanged(volume, i["d_p"], ventilation(i["slip"]), i["D"])


def transfer_coefficient(i):
    return gas_exchanged(i["d_p"] / 6.0, i)  # a surface of 1 m2


def driving_force(i):
    surface = evaporation.vapour_concentration(i["psat"], i["T_p"])
    return evaporation.driving_force_linear(surface, i["C_inf"], i["W"])


def sphere_rate(i):
    """dm/dt [kg/s]."""
    return -gas_exchanged(math.pi / 6.0 * i["d_p"] ** 3, i) * driving_force(i)


def relative_rate(i):
    """(dm/dt)/m [1/s]."""
    return -gas_exchanged(1.0, i) * driving_force(i) / i["rho_p"]


def regression(i):
    return evaporation.regression_rate(driving_force(i), i["D"], i["rho_p"])


def shrinking(i):
    """dd/dt [m/s]."""
    return -0.5 * regression(i) * (1.0 + ventilation(i["slip"]) * math.sqrt(i["d_p"])) / i["d_p"]


def surface_mass_fraction(i):
    return evaporation.vapour_mass_fraction(JET["psat"] / CONSTANTS["p_op"], i["W"], W_GAS)


def spalding_regression(i):
    force = evaporation.driving_force_spalding(surface_mass_fraction({"W": JET["W"]}), 0.0, i["rho_g"])
    return evaporation.regression_rate(force, JET["D"], JET["rho"])


def wet_bulb(gas_temperature, saturation, p, ratio=1.0):
    return exact.wet_bulb_temperature(
        gas_temperature, lambda T: saturation(T, p), JET["D"], JET["W"], JET["hfg"], K_G, ratio
    )


def wet_bulb_in_wind(i):
    ratio = sherwood(i["slip"]) / heat.gunn(1.0, jet_reynolds(i["slip"]), PR)
    return wet_bulb(i["Tg"], evaporation.saturation_constant, (JET["psat"],), ratio)


# --- SPH


def spline(law, i):
    return law(i["q"] * i["h"], i["h"], kernels.normalisation("cubic_spline", 2, i["h"]))


def conducting_pair(i):
    gradient = kernels.cubic_spline_gradient(i["r"], i["h"], kernels.normalisation("cubic_spline", 2, i["h"]))
    r2 = i["r"] ** 2
    k = exchange.harmonic_mean(i["k_i"], i["k_j"])
    pair = exchange.cleary_monaghan(i["m"] * gradient, r2, i["eta2"], k, i["rho"], i["rho"])
    return pair * (i["Ti"] - i["Tj"]) / i["c"]


def artificial_viscosity(i):
    return viscosity.monaghan(i["vr"], i["dx"] ** 2, i["h"], i["c"], i["rho"], i["a"], i["b"])


def cell_exchange(i):
    """One cell and its particles, sdph notes section 3: [v_g', v_1', v_2', ...]."""
    f = np.array([exchange.exponential_fraction(float(lam)) for lam in i["l"]])
    m, v = np.array(i["m"]), np.array(i["v"], dtype=float)
    v_g = (i["mg"] * i["vg"] + np.sum(m * f * v)) / (i["mg"] + np.sum(m * f))
    return [v_g, *((1.0 - f) * v + f * v_g)]


# --- bench problems


def dusty_wave_roots(i):
    roots = solutions.dusty_wave_roots(i["k"], 1.0, 1.0, 1.0, i["K"])
    return [*roots.real, *roots.imag]


BED_DIFFUSIVITY = solutions.thermal_diffusivity(BED["k"], BED["rho"], BED["cp"])
