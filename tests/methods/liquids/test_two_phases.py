"""Two phases: sums written out pair by pair, what they must keep, and that fluids at rest stay there."""

import numpy as np
import pytest
from matrices import corrections
from two_phase_drops import BASE, stepper

from sdph import scenes
from sdph.case import read as cases
from sdph.effects import OFF
from sdph.engine import kernels as smoothing
from sdph.engine.state import GAS, LIQUID, positions, velocities
from sdph.methods.liquids import phases, shift
from sdph.methods.liquids.loads import loads, wall_loads
from sdph.methods.liquids.method import LiquidStepper
from sdph.running.alone import Alone
from sdph.schema import CaseError


def expected_acceleration(own, i, weighted, B):
    s, p = own.state, own.p
    r, v, gravity = positions(s), velocities(s), np.array([0.0, -9.81, 0.0])
    mu = {(LIQUID, LIQUID): 1.0, (GAS, GAS): 0.02, (LIQUID, GAS): 2.0 * 0.02 / 1.02, (GAS, LIQUID): 2.0 * 0.02 / 1.02}
    total = np.zeros(3)
    for j in np.flatnonzero(np.linalg.norm(r - r[i], axis=1) < 2.0 * own.kernel.h):
        if j == i:
            continue
        d, wet = r[i] - r[j], s.kind[j] >= LIQUID
        distance, closing = np.linalg.norm(d), (v[i] - v[j]) @ d
        rho_i, rho_j = s.density[i], s.density[j] if wet else s.density[i]
        kind_j = s.kind[j] if wet else s.kind[i]
        p_i, p_j = own.pressure[i], own.pressure[j] if wet else own.pressure[i] - rho_i * gravity @ d
        first, second = (2.0 * rho_j / (rho_i + rho_j), 2.0 * rho_i / (rho_i + rho_j)) if weighted else (1.0, 1.0)
        pair = first * p_i * B[i] + second * p_j * B[j if wet else i]
        damping = -p["liquid_damping"].strength * closing / (distance**2 + p["liquid_damping"].softening)
        along = (
            damping * 2.0 * rho_i * rho_j / (rho_i + rho_j) / 1000.0
            - 8.0 * mu[s.kind[i], kind_j] * closing / distance**2
        )
        volume = s.mass[j] / s.density[j] if wet else 0.05**2
        total -= volume * smoothing.slope.py_func(own.kernel, distance) * (pair @ d + along * d)
    return total / s.density[i] + gravity


@pytest.mark.parametrize(
    ("interaction", "gradient"),
    [("riemann", "plain"), ("plain", "plain"), ("riemann", "corrected"), ("plain", "corrected")],
)
def test_acceleration_is_the_sum_over_all_pairs(interaction, gradient):
    own = stepper(
        gas_phase=BASE["gas_phase"] | {"interaction": interaction},
        liquid=BASE["liquid"] | {"pressure_gradient": gradient},
    )
    B = corrections(own) if gradient == "corrected" else np.zeros((len(own.state.x), 3, 3)) + np.eye(3)
    chosen = np.concatenate([np.flatnonzero(own.state.kind == kind)[::5] for kind in (LIQUID, GAS)])
    for i in chosen:
        expected = expected_acceleration(own, i, interaction == "riemann", B)
        assert np.allclose(own.acceleration[i], expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("interaction", ["riemann", "plain"])
def test_compression_takes_what_corrected_pressure_gives(interaction):
    """Sum of p/rho^2 d rho/dt m over all particles, against the power of all forces of pressure: conjugate sums."""
    own = stepper(
        effects=[], gas_phase=BASE["gas_phase"] | {"interaction": interaction},
        liquid=BASE["liquid"] | {"pressure_gradient": "corrected", "periodic": [1.0, 1.0]},
        domain={"size_m": [0.5, 0.8], "gravity_m_s2": [0.0, 0.0]},
    )  # fmt: skip
    s, wet = own.state, own.active
    before = s.density.copy()
    own._densify(1e-9)
    rate = (s.density - before)[wet] / 1e-9
    compressed = (s.mass * own.pressure / before**2)[wet] @ rate
    pushed = (s.mass[wet, None] * velocities(s)[wet] * own.acceleration[wet]).sum()
    scale = np.abs((s.mass * own.pressure / before**2)[wet] * rate).sum()
    assert abs(pushed + compressed) < 1e-6 * scale and abs(compressed) > 1e-3 * scale


# a drop of oil that rises in water, in a box that is full
OIL = {
    "title": "Oil in water", "dimensions": 2,
    "effects": [
        "gravity", "density_diffusion", "laminar_viscosity", "liquid_damping", "shifting", "surface_tension", "tank",
    ],
    "run": {"end_time_s": 0.25, "output_interval_s": 0.25},
    "domain": {"size_m": [0.03, 0.06], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 1.5},
    "liquid": {
        "density_kg_m3": 998.0, "viscosity_Pa_s": 1e-3, "sound_speed_m_s": 7.7, "exponent": 1.0,
        "pressure_gradient": "corrected",
    },
    "gas_phase": {"density_kg_m3": 900.0, "viscosity_Pa_s": 0.05, "exponent": 1.0},
    "liquid_damping": {"model": "riemann"}, "shifting": {"form": "transport_velocity", "strength": 0.2},
    "surface_tension": {"coefficient_N_m": 0.03}, "tank": {"slip": "no_slip", "suction": "full"},
    "pools": {
        "oil": {"phase": "gas", "shape": "disc", "centre_m": [0.015, 0.015], "radius_m": 0.006},
        "water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.03, 0.06]},
    },
}  # fmt: skip


def test_a_drop_of_oil_rises_by_its_weight_alone():
    """The bar is that of every run (sdph.running.balances); with the plain continuity equation it was 0.6."""
    run = Alone(cases.from_table(OIL), None)
    run.start()
    while run.time < 0.25:
        run.window()
    told, s = run.ledger.summary(), run.stepper.state
    print({name: told[name] for name in ("energy_made_rel", "work_of_gravity_J", "dissipated_J", "numerical_work_rel")})
    assert told["energy_made_rel"] < 0.05 and told["gradient_correction_J"] == 0.0
    assert told["numerical_work_rel"] < 0.02
    assert s.y[s.kind == GAS].mean() > 0.015 + 0.005


@pytest.mark.parametrize("gradient", ["plain", "corrected"])
def test_walls_feel_what_both_phases_lose(gradient):
    own = stepper(liquid=BASE["liquid"] | {"pressure_gradient": gradient})
    momentum, felt = loads(own), wall_loads(own)
    assert np.allclose(momentum[:3], felt[:3], rtol=1e-9, atol=1e-9 * np.abs(felt).max())


@pytest.mark.parametrize(
    ("interaction", "gradient"), [("riemann", "plain"), ("plain", "plain"), ("riemann", "corrected")]
)
def test_pair_forces_keep_momentum(interaction, gradient):
    effects = ["density_diffusion", "liquid_damping", "laminar_viscosity", "xsph"]
    own = stepper(
        effects=effects, liquid=BASE["liquid"] | {"periodic": [1.0, 1.0], "pressure_gradient": gradient},
        gas_phase=BASE["gas_phase"] | {"density_kg_m3": 100.0, "interaction": interaction},
        domain={"size_m": [0.5, 0.8], "gravity_m_s2": [0.0, 0.0]},
    )  # fmt: skip
    scale = (own.state.mass[:, None] * np.abs(velocities(own.state))).sum()
    before = own.state.mass @ velocities(own.state)
    for _ in range(20):
        own.step(1.0)
    assert np.abs(own.state.mass @ velocities(own.state) - before).max() < 1e-12 * scale


def test_xsph_moves_each_phase_with_its_own_and_as_a_whole_not_at_all():
    own = stepper(effects=["xsph"], liquid=BASE["liquid"] | {"periodic": [1.0, 1.0]})
    s = own.state
    s.u[s.kind == GAS], s.u[s.kind == LIQUID] = 5.0, -2.0
    shift.mingle(
        own.kernel, s, own.rows, own.neighbours.box, own.active, own.p["xsph"], own.phases, own.volume, *own.extra
    )
    assert np.abs(own.extra[0]).max() < 1e-12
    assert np.abs(own.extra[1]).max() > 1e-3
    for kind in (LIQUID, GAS):
        assert abs(s.mass @ np.where(s.kind == kind, own.extra[1], 0.0)) < 1e-12 * s.mass.sum()


def test_summed_density_of_a_lattice_is_that_of_rest():
    own = stepper(
        shaken=False,
        effects=["tank"],
        gas_phase=BASE["gas_phase"] | {"density_by": "summation"},
        domain={"size_m": [0.5, 0.8], "gravity_m_s2": [0.0, 0.0]},
    )
    assert np.allclose(own.state.density[own.state.kind == LIQUID], 1000.0, rtol=1e-9)
    assert np.allclose(own.state.density[own.state.kind == GAS], 1.0, rtol=1e-9)


def test_van_der_waals_gas_begins_at_the_pressure_of_the_case():
    own = stepper(shaken=False, effects=["tank"], gas_phase=BASE["gas_phase"] | {"cohesion_Pa_m6_kg2": 20.0})
    assert np.allclose(own.pressure[own.state.kind == GAS], 100.0, rtol=1e-9)


def test_paper_and_default_let_the_column_fall_alike():
    """XSPH and Van der Waals' gas as the paper has them (p_i + p_j, c_a = 14.1 c_w), and the Riemann form: fronts
    within a spacing."""
    fronts = []
    for paper in (False, True):
        table = cases.to_table(cases.load(scenes.find("dam_break_gas")[1], ("resolution.spacing_mm=7.14375",)))
        if paper:
            table["effects"] = [*(name for name in table["effects"] if name != "shifting"), "xsph"]
            del table["shifting"]
            table["gas_phase"] |= {
                "interaction": "plain",
                "exponent": 1.4,
                "sound_speed_m_s": 299.0,
                "cohesion_Pa_m6_kg2": 1682.0,
            }
            table["liquid"] |= {"exponent": 7.0}
        own = LiquidStepper(cases.from_table(table))
        while own.time < 0.03:
            own.step(0.03 - own.time)
        fronts.append(own.state.x[own.state.kind == LIQUID].max())
    assert fronts[0] > 0.0572
    assert fronts[1] == pytest.approx(fronts[0], abs=0.00714375)


@pytest.mark.parametrize("interaction", ["riemann", "plain"])
def test_the_second_phase_may_be_the_heavier_one(interaction):
    """The same two liquids, the heavy one below: which of them is called the second phase changes nothing."""
    heavy, light = ({"density_kg_m3": rho, "viscosity_Pa_s": mu, "exponent": 7.0} for rho, mu in ((1200, 1), (900, 2)))
    more, wide = {"background_pressure_Pa": 100.0, "sound_speed_m_s": 20.0}, {"lower_m": [0.0, 0.0], "shape": "box"}
    low, all_ = wide | {"upper_m": [0.5, 0.4]}, wide | {"upper_m": [0.5, 0.8]}
    found = [
        stepper(liquid=one | more, gas_phase=other | {"interaction": interaction}, pools=pools)
        for one, other, pools in (
            (heavy, light, {"low": low, "high": all_ | {"phase": "gas"}}),
            (light, heavy, {"low": low | {"phase": "gas"}, "high": all_}),
        )
    ]
    usual, turned = (own.acceleration[own.active] for own in found)
    assert np.allclose(turned, usual, rtol=1e-9, atol=1e-9 * np.abs(usual).max())
    usual, turned = (own.pressure[own.active] for own in found)
    assert np.allclose(turned, usual, rtol=1e-9, atol=1e-9 * np.abs(usual).max())


def test_one_phase_is_off():
    case = cases.from_table(
        {key: value for key, value in BASE.items() if key != "gas_phase"} | {"pools": {"water": BASE["pools"]["water"]}}
    )
    assert phases.kernel(case) == OFF


@pytest.mark.parametrize(
    "change, word",
    [
        ({"pools": {"a": {"shape": "box", "lower_m": [0.0, 0.5], "upper_m": [0.5, 0.4]}}}, "must lie above lower_m"),
        ({"pools": {"a": {"shape": "disc", "centre_m": [0.2, 0.2]}}}, "pools.a.radius_m is missing"),
        ({"resolution": {"spacing_mm": 1e12}}, "larger than pools.water"),
        ({"gas_phase": None}, "gas_phase"),
        ({"tank": {"suction": "none"}}, "suction"),
        ({"gas_phase": {"density_kg_m3": 1.0, "density_by": "summation"}}, "density_diffusion"),
        (
            {
                "gas_phase": {"density_kg_m3": 1.0, "density_by": "summation"},
                "liquid": BASE["liquid"] | {"pressure_gradient": "corrected"},
            },
            "makes energy",
        ),
        (
            {
                "pools": {
                    "a": {
                        "phase": "gas",
                        "shape": "box",
                        "lower_m": [0.0, 0.0],
                        "upper_m": [0.5, 0.8],
                        "flow": "quadrupole",
                    }
                }
            },
            "quadrupole",
        ),
        ({"pools": BASE["pools"] | {"air": BASE["pools"]["air"] | {"flow": "wave"}}}, "crest"),
        ({"pools": BASE["pools"] | {"air": BASE["pools"]["air"] | {"displacement_m": 0.01}}}, "that of a wave"),
    ],
)
def test_what_two_phases_cannot_be_is_told(change, word):
    table = {key: value for key, value in (BASE | change).items() if value is not None}
    with pytest.raises(CaseError, match=word):
        LiquidStepper(cases.from_table(table))
