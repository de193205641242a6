"""Every reference value, computed by the laws. A check is a pattern of ids and what the code makes of their inputs."""

import math
import re

import exact_solutions as solutions
import numpy as np
import pytest
from reference_laws import (
    BED_DIFFUSIVITY,
    C_G,
    C_P,
    CLAPEYRON,
    CP_G,
    GRAVITY,
    JET_C_P,
    K_G,
    MU_G,
    PR,
    RHO_G,
    T_G,
    T_P,
    W_GAS,
    artificial_viscosity,
    beta,
    cell_exchange,
    conducting_pair,
    disc_box,
    disc_eps,
    disc_two_way,
    drag_coefficient,
    driving_force,
    dusty_wave_roots,
    edge_rate_ratio,
    friction_law,
    gas_damping,
    gas_of,
    grains,
    gunn,
    haff,
    haff_coefficient,
    haff_with_drag,
    isentropic_sound_speed,
    isothermal_sound_speed,
    jet_eps,
    jet_reynolds,
    jet_time_to_evaporation,
    lun_pressure,
    paper_dissipation,
    regression,
    relative_rate,
    settling,
    shear,
    sherwood,
    shrinking,
    spalding_regression,
    sphere_rate,
    spline,
    surface_mass_fraction,
    transfer_coefficient,
    wet_bulb,
    wet_bulb_in_wind,
    yielding,
)
from reference_values import BED, CONSTANTS, JET, VALUES

from sdph.laws import (
    drag,
    eos,
    evaporation,
    exact,
    friction,
    grain_loss,
    granular,
    heat,
    kernels,
)
from sdph.laws.constants import GAS_CONSTANT

CHECKS = {
    r"phi_gp_a[\d.]+": lambda i: drag.dilute_weight(i["alpha_p"]),
    r"CD_.*": drag_coefficient,
    r"betaErgun_.*": lambda i: beta(drag.ergun, i),
    r"betaWenYu_.*": lambda i: (beta(drag.wen_yu, i), beta(drag.wen_yu_paper, i)),
    r"betaBlend_.*(?<!_lit)": lambda i: beta(drag.gidaspow_paper, i),
    r"betaBlend_.*_lit": lambda i: beta(drag.gidaspow, i),
    r"betaSwitch_.*": lambda i: beta(drag.gidaspow_switch, i),
    r"Re_jet_u10": lambda i: drag.particle_reynolds(i["slip"], i["d_p"], RHO_G, MU_G),
    r"Gunn_.*": gunn,
    r"RanzMarshall_.*": lambda i: heat.ranz_marshall(1.0, i["Re"], i["Pr"]),
    r"disc_eps_paper": lambda i: disc_eps("paper"),
    r"disc_Cg": lambda i: C_G,
    r"disc_dTdt0_paper": lambda i: i["eps"] * (T_G - T_P) / C_P,
    r"disc_oneway_Tp_(paper|geom)_.*": lambda i, form: exact.one_way_temperature(
        i["t"], i["Tp0"], i["Tg"], disc_eps(form), C_P
    ),
    r"disc_twoway_rate_(paper)": lambda i, form: exact.exchange_rate(disc_eps(form), C_P, C_G),
    r"disc_twoway_Tp_(paper|geom)_.*": lambda i, form: disc_two_way(form, i["t"])[0],
    r"disc_twoway_Tg_(paper|geom)_.*": lambda i, form: disc_two_way(form, i["t"])[1],
    r"disc_twoway_dTp_(paper|geom)_.*": lambda i, form: exact.two_way_rise(i["t"], T_P, T_G, disc_eps(form), C_P, C_G),
    r"disc_Teq": lambda i: solutions.equilibrium_temperature(T_P, T_G, C_P, C_G),
    r"disc_box_Tinf": disc_box,
    r"alphaDiff_g": lambda i: solutions.thermal_diffusivity(K_G, RHO_G, CP_G),
    r"edge_rate_ratio_.*": edge_rate_ratio,
    r"g0_.*": lambda i: granular.sinclair_jackson(i["alpha_p"], i["alpha_max"]),
    r"dg0_.*": lambda i: granular.sinclair_jackson_slope(i["alpha_p"], i["alpha_max"]),
    r"ps_.*": lun_pressure,
    r"muCol_paper_.*": lambda i: grains(granular.gidaspow_collisional_viscosity, i) / i["alpha_p"],
    r"muKin_paper_.*": lambda i: grains(granular.gidaspow_kinetic_viscosity, i) / i["alpha_p"],
    r"muColKin_full_.*": lambda i: grains(granular.gidaspow_viscosity, i),
    r"lambda_paper_.*": lambda i: grains(granular.lun_bulk_viscosity, i) / i["alpha_p"],
    r"lambda_full_.*": lambda i: grains(granular.lun_bulk_viscosity, i),
    r"ktheta_.*": lambda i: grains(granular.gidaspow_conductivity, i),
    r"gamma_lun_.*": lambda i: grains(granular.lun_dissipation, i),
    r"gamma_asprinted_.*": paper_dissipation,
    r"c_iso_.*": isothermal_sound_speed,
    r"c_isentropic_.*": isentropic_sound_speed,
    r"phi_gp_theta": gas_damping,
    r"haff_K_.*": haff_coefficient,
    r"haff_theta_.*": haff,
    r"haff_drag_theta": haff_with_drag,
    r"shear_theta_.*": lambda i: shear(i).theta,
    r"shear_tau_a.*": lambda i: shear(i).stress,
    r"shear_tau_over_p_.*": lambda i: shear(i).stress / shear(i).pressure,
    r"pfJJ_.*": lambda i: friction_law(friction.johnson_jackson_pressure, i),
    r"dpfJJ_.*": lambda i: friction_law(friction.johnson_jackson_slope, i),
    r"I2D": lambda i: friction.second_invariant(i["D11"], i["D22"], 0.0, i["D12"], 0.0, 0.0),
    r"mu_fr": yielding,
    r"umf_ergun_.*": lambda i: exact.minimum_fluidisation(i["alpha_p"], i["rho_p"], i["g"], *gas_of(i)),
    r"ergun_dpdl_.*": lambda i: exact.ergun_gradient(i["alpha_p"], i["U"], *gas_of(i)),
    r"bed_dp_total": lambda i: i["H"] * exact.buoyant_weight(i["alpha_p"], i["rho_p"], i["rho_g"], i["g"]),
    r"vt_jet": lambda i: settling(drag.schiller_naumann, 0.0, i),
    r"tau_stokes_bed": lambda i: i["rho_p"] / drag.stokes(0.0, 0.0, *gas_of(i)),
    r"evap_rhovs": lambda i: (
        i["W"] * evaporation.vapour_concentration(i["psat"], i["T_p"]),
        eos.ideal_gas_density(i["psat"], i["T_p"], i["W"]),
    ),
    r"kc_.*": transfer_coefficient,
    r"Sh_u1": lambda i: (sherwood(i["slip"]), evaporation.sherwood_ranz_marshall(i["Re"], i["Sc"])),
    r"N_u10": lambda i: transfer_coefficient(i) * driving_force(i) / i["W"],
    r"mdot_sphere_.*": sphere_rate,
    r"mfracrate_sphere_.*": relative_rate,
    r"ddot_.*": shrinking,
    r"Gamma_.*": lambda i: -i["alpha_p"] * i["rho_p"] * relative_rate(i),
    r"d2law_life": lambda i: i["d_p"] ** 2 / regression(i),
    r"d2law_d_t100": lambda i: math.sqrt(grain_loss.square_after(i["d_p"] ** 2, i["t"] * regression(i), 0.0)),
    r"d2law_K_spalding": spalding_regression,
    r"Wg_mass30_70": lambda i: W_GAS,
    r"X_s": lambda i: evaporation.vapour_mole_fraction(surface_mass_fraction({"W": JET["W"]}), JET["W"], W_GAS),
    r"Y_s": surface_mass_fraction,
    r"wetbulb_Re0_psatconst": lambda i: wet_bulb(i["Tg"], evaporation.saturation_constant, (i["psat"],)),
    r"wetbulb_u10_.*": wet_bulb_in_wind,
    r"wetbulb_Re0_CC": lambda i: wet_bulb(i["Tg"], evaporation.saturation_clausius_clapeyron, CLAPEYRON),
    r"psat_CC_350": lambda i: evaporation.saturation_clausius_clapeyron(i["T"], CLAPEYRON),
    r"jet_Nu_.*": lambda i: heat.gunn(0.4, jet_reynolds(i["slip"]), PR),
    r"jet_eps_.*": jet_eps,
    r"jet_dTdt_.*": lambda i: jet_eps(i) * (350.0 - 294.0) / JET_C_P,
    r"jet_time_to_Tvap_oneway": jet_time_to_evaporation,
    r"jet_gas_heat_tau_.*": lambda i: exact.volumetric_heat_capacity(0.4, RHO_G, CP_G) / jet_eps(i),
    r"W_cubic_0_(\d)D": lambda i, dims: kernels.cubic_spline(
        0.0, i["h"], kernels.normalisation("cubic_spline", int(dims), i["h"])
    ),
    r"W2_.*": lambda i: spline(kernels.cubic_spline, i),
    r"dW2_.*": lambda i: spline(kernels.cubic_spline_gradient, i) * i["q"] * i["h"],
    r"lattice_divr_2D": lambda i: solutions.lattice_divergence_factor("cubic_spline", 2, 1.5),
    r"cm_pair": conducting_pair,
    r"Pi_ij": artificial_viscosity,
    r"dustywave_roots_.*": dusty_wave_roots,
    r"cos_decay": lambda i: solutions.cosine_decay(i["t"], math.pi / i["L"], BED_DIFFUSIVITY),
    r"exchange_EXP": cell_exchange,
    r"settle_slip_bed_.*": lambda i: settling(drag.gidaspow, i["alpha_p"], i),
    r"slope_crit_phi30": lambda i: math.degrees(solutions.yield_slope(math.radians(i["phi_deg"]))),
    r"settle_relax_.*": lambda i: solutions.settling_slip_at(i["t"], i["beta"], 0.6, BED["rho"], RHO_G, GRAVITY),
}

# Values that are no law but the work of a part of the code, whose own tests hold it against them.
ELSEWHERE = {"N_disc_lattice": "how particles are seeded in a disc"}


def matching(name):
    return [(re.fullmatch(pattern, name), check) for pattern, check in CHECKS.items() if re.fullmatch(pattern, name)]


@pytest.mark.parametrize("name", [name for name in VALUES if name not in ELSEWHERE])
def test_reference_value(name):
    [(match, check)] = matching(name)
    value = VALUES[name]
    computed = np.atleast_1d(check(value["inputs"], *match.groups()))
    expected = np.broadcast_to(value["expected"], computed.shape)
    np.testing.assert_allclose(computed, expected, rtol=value["rtol"], atol=0.0)


def test_every_value_is_covered_by_exactly_one_check():
    assert {name: len(matching(name)) for name in VALUES} == {name: int(name not in ELSEWHERE) for name in VALUES}


def test_every_check_covers_a_value():
    assert [p for p in CHECKS if not any(re.fullmatch(p, name) for name in VALUES)] == []


def test_gas_constant_is_that_of_the_reference():
    assert CONSTANTS["R_J_per_kmolK"] == GAS_CONSTANT
