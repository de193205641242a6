"""Burn-off: closed forms of a grain in uniform oxidant and of a box that runs out of it; mass, species, momentum and heat
of both sides; any window; what cannot be says so."""

import math

import numpy as np
import pytest
from builders import simulation
from grain_boxes import table
from scipy.integrate import solve_ivp

from coupling.embedded import EmbeddedGas
from coupling.gas import Unfinished
from sdph.case import read as cases
from sdph.effects.gas import reaction, sizes
from sdph.schema import CaseError

DENSITY, DIAMETER, RATIO, RATE, GAS, OXIDANT, D = 1200.0, 1e-4, 32.0 / 12.0, 0.3, 0.32, 0.1, 2e-4
HEAT, CHAR, CARRIER, OXYGEN = 32.8e6, 1500.0, 1150.0, 1050.0  # J/kg, J/(kg K)
END, LEFT = 2.0, 0.4  # s, of the oxidant, in `boxed`
BOTH = ("reaction", "heat")
SPECIES = {"molar_mass_kg_kmol": 32.0, "diffusivity_m2_s": D, "heat_capacity_J_kg_K": OXYGEN, "conductivity_W_m_K": 0.07,
           "viscosity_Pa_s": 4.5e-5, "mass_fraction": OXIDANT}  # fmt: skip


def char(effects=("reaction",), end=1.0, windows=20, alpha_p=1e-6, **more):
    """A box of char, one cell of gas of 1100 K with 10 % of oxygen, that feels nothing unless it is told."""
    base = {
        "size": (0.02, 0.02), "periodic": (), "alpha_p": alpha_p,
        "resolution": {"spacing_mm": 5.0, "cell_mm": 20.0},
        "run": {"end_time_s": end, "output_interval_s": end},
        "coupling": {"window_largest_s": end / windows, "window_tolerance": 1e30, "courant": 1e30, "one_way": True},
        "gas": {"density_kg_m3": GAS, "viscosity_Pa_s": 4.5e-5, "conductivity_W_m_K": 0.07,
                "heat_capacity_J_kg_K": CARRIER, "temperature_K": 1100.0},
        "grains": {"density_kg_m3": DENSITY, "diameter_mm": DIAMETER * 1e3, "heat_capacity_J_kg_K": CHAR},
        "particles": {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.02, 0.02], "volume_fraction": alpha_p,
                              "temperature_K": 1100.0}},
        "vapour": SPECIES, "boundaries": {"walls": {"kind": "wall"}},
    }  # fmt: skip
    if "reaction" in effects:
        base["reaction"] = {"oxidant_ratio": RATIO, "rate_m_s": RATE, "heat_J_kg": 0.0}
    if "heat" in effects:
        base["heat"] = {"law": "ranz_marshall", "closure": "geometric"}
    for name, section in more.items():
        base[name] = base.get(name, {}) | section if isinstance(section, dict) else section
    return cases.from_table(table(list(effects), **base))


def started(case, folder):
    return simulation(case, folder, gas=lambda case, cells: EmbeddedGas(case))


def finished(case, folder):
    run = started(case, folder)
    while run.time < case.run.end_time * (1.0 - 1e-12):
        run.window()
    return run


def boxed(count=40, **more):
    """A closed box in which the oxidant falls to LEFT of what it was within END, if grains stayed as they are."""
    strip = -math.log(LEFT) / END  # 6 alpha_p k/(d (1 - alpha_p)) [1/s]
    alpha_p = 1.0 / (1.0 + 6.0 / ((1.0 / RATE + DIAMETER / (2.0 * D)) * DIAMETER * strip))
    more = {"coupling": {"one_way": False, "window_largest_s": END / count, "window_tolerance": 1e30}} | more
    return char(end=END, alpha_p=alpha_p, **more)


@pytest.mark.parametrize("windows", [1, 7])
def test_without_a_film_the_diameter_falls_evenly(tmp_path, windows):
    """d = d_0 - 2 k_s rho_g Y t/(nu rho_p), whatever the windows."""
    burn_out = RATIO * DENSITY * DIAMETER / (2.0 * RATE * GAS * OXIDANT)
    case = char(end=0.5 * burn_out, windows=windows, reaction={"film": False})
    run = finished(case, tmp_path)
    np.testing.assert_allclose(run.state.diameter, 0.5 * DIAMETER, rtol=1e-12)
    np.testing.assert_allclose(run.state.mass, 0.125 * run.state.born_mass, rtol=1e-12)


def test_a_fast_surface_has_the_d2_law(tmp_path):
    """d^2 = d_0^2 - 8 D rho_g Y t/(nu rho_p) in gas at rest, where the film alone hinders."""
    burn_out = RATIO * DENSITY * DIAMETER**2 / (8.0 * D * GAS * OXIDANT)
    run = finished(char(end=0.75 * burn_out, windows=5, reaction={"rate_m_s": 1e8}), tmp_path)
    np.testing.assert_allclose(run.state.diameter, 0.5 * DIAMETER, rtol=1e-6)


@pytest.mark.parametrize("slip", [0.0, 3.0])
def test_surface_and_film_in_series(tmp_path, slip):
    """dd/dt = -2 k rho_g Y/(nu rho_p), 1/k = 1/k_s + d/(Sh D), integrated apart; Arrhenius' k_s at the grain's
    temperature. Without drag the grains keep their speed."""
    k_s = 5.0 * math.exp(-3000.0 / 1100.0)

    def fall(t, d):
        reynolds, schmidt = GAS * slip * d / 4.5e-5, 4.5e-5 / (GAS * D)
        sherwood = 2.0 + 0.6 * math.sqrt(reynolds) * schmidt ** (1.0 / 3.0)
        return -2.0 * GAS * OXIDANT / (RATIO * DENSITY) / (1.0 / k_s + d / (sherwood * D))

    end = 4.0
    expected = solve_ivp(lambda t, d: [fall(t, d[0])], (0.0, end), [DIAMETER], rtol=1e-10, atol=1e-14).y[0, -1]
    case = char(end=end, windows=3, reaction={"rate_m_s": 5.0, "activation_temperature_K": 3000.0})
    run = started(case, tmp_path)
    run.gas_state.fields["velocity"][:, 0] = slip
    run.gas.advance = lambda dt, sources: run.gas_state
    while run.grains.time < end * (1.0 - 1e-12):
        run.window()
    assert 0.3 * DIAMETER < expected < 0.9 * DIAMETER
    np.testing.assert_allclose(run.state.diameter, expected, rtol=2e-6)


def test_a_box_runs_out_of_oxidant_as_its_equation_says(tmp_path):
    """Grains so heavy that they stay as they are strip the gas of a box: its oxidant is m_0 exp(-K t) in any windows."""
    case = boxed(count=4, grains={"density_kg_m3": 9e5})
    run = finished(case, tmp_path)
    strip = run.exchange.losing._taken(run.state, run.weights, _stripped(run))[0]
    gas = run.gas_state
    mass, vapour = gas.budget.mass, gas.budget.vapour
    first = run.ledger.first
    assert strip == pytest.approx(-math.log(LEFT) / END, rel=5e-4)  # they shrink a little
    assert vapour == pytest.approx(LEFT * first["gas_vapour_kg"], rel=5e-4)
    burned = (1.0 - vapour / first["gas_vapour_kg"]) * first["gas_vapour_kg"] / RATIO
    assert mass == pytest.approx(first["gas_mass_kg"] + burned, rel=1e-12)


def _stripped(run):
    p, s = run.parameters["reaction"], run.state
    return np.array([reaction.stripped(p, (), s, i, reaction.surface(p, 1100.0), 0.0) for i in range(len(s.x))])


def errors(folder, **more):
    """Mass burned in `boxed` in 10, 20 and 40 windows, less that of an integration of the two equations, over it."""
    return [_burned(folder / str(n), n, **more) for n in (10, 20, 40)]


def _burned(folder, count):
    """As much solid as the oxidant burns: both run low."""
    folder.mkdir()
    case = boxed(count=count, vapour=SPECIES | {"mass_fraction": 0.3})
    run = finished(case, folder)
    first = run.ledger.first
    volume, alpha_p = 4e-4, first["particle_mass_kg"] / DENSITY / 4e-4
    number = alpha_p * volume / (math.pi / 6.0 * DIAMETER**3)

    def both(t, y):
        d, oxidant = y
        k = 1.0 / (1.0 / RATE + d / (2.0 * D))
        content = oxidant / (volume * (1.0 - number * math.pi / 6.0 * d**3 / volume))
        taken = number * math.pi * d * d * k * content
        return [-2.0 * k * content / (RATIO * DENSITY), -taken]

    start = [DIAMETER, first["gas_vapour_kg"]]
    d = solve_ivp(both, (0.0, END), start, rtol=1e-11, atol=1e-18).y[0, -1]
    expected = first["particle_mass_kg"] * (1.0 - (d / DIAMETER) ** 3)
    return (run.ledger.sums["reacted_kg"] - expected) / expected


def test_the_order_in_the_window_is_the_second_at_one_temperature(tmp_path):
    """Windows halved quarter the error, of grains and oxidant that both change much."""
    coarse, middle, fine = errors(tmp_path)
    print("burned in 10, 20, 40 windows, off by", coarse, middle, fine)
    assert abs(fine) < 1e-4
    assert coarse / middle == pytest.approx(4.0, rel=0.1) and middle / fine == pytest.approx(4.0, rel=0.1)


def test_the_order_in_the_window_is_the_first_where_temperatures_change(tmp_path):
    """A grain that warms as it burns, five times as fast at the end, against its two equations integrated apart."""
    end, given = 0.4, {"rate_m_s": 150.0, "activation_temperature_K": 8000.0, "heat_J_kg": HEAT}

    def both(t, y):
        d, hot = y
        k = 1.0 / (math.exp(8000.0 / hot) / 150.0 + d / (2.0 * D))
        taken, h = k * GAS * OXIDANT, 2.0 * 0.07 / d
        warming = 6.0 / (d * DENSITY * CHAR) * (HEAT * taken / RATIO - h * (hot - 1100.0))
        return [-2.0 * taken / (RATIO * DENSITY), warming]

    expected = solve_ivp(both, (0.0, end), [DIAMETER, 1100.0], rtol=1e-11, atol=1e-16).y[0, -1]
    off = []
    for count in (20, 40, 80):
        (tmp_path / str(count)).mkdir()
        run = finished(char(BOTH, end=end, windows=count, reaction=given), tmp_path / str(count))
        off.append((run.state.diameter[0] - expected) / (DIAMETER - expected))
    print("loss of diameter in 20, 40, 80 windows, off by", off)
    assert abs(off[2]) < 0.02
    assert off[0] / off[1] == pytest.approx(2.0, rel=0.15) and off[1] / off[2] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("more", [
    {},
    {"reaction": {"gas_share": 0.3}},
    {"reaction": {"film": False}},
    {"gas": {"equation_of_state": "operating"}},
    {"grains": {"diameter_std_mm": 0.03}},
    {"particles": {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.01, 0.01], "temperature_K": 900.0}}},
    {"resolution": {"cell_mm": 5.0}},
])  # fmt: skip
def test_what_grains_lose_and_use_up_the_gas_gets(tmp_path, more):
    """Mass, species and energy of both sides over a run in a closed box, to 1e-10 of what was exchanged."""
    run = finished(_hot(more), tmp_path)
    summary = run.ledger.summary()
    assert summary["reacted_kg"] > 0.05 * run.ledger.first["gas_vapour_kg"] / RATIO
    assert summary["reaction_heat_J"] == pytest.approx(HEAT * summary["reacted_kg"], rel=1e-12)
    for name in ("exchange_mass_mismatch_rel", "exchange_energy_mismatch_rel", "species_drift_rel", "energy_drift_rel"):
        assert summary[name] <= 1e-10, name
    assert summary["particle_mass_drift_rel"] <= 1e-12 and summary["mass_drift_rel"] <= 1e-12
    gone = run.ledger.first["gas_vapour_kg"] - run.ledger.last["gas_vapour_kg"]
    assert gone == pytest.approx(RATIO * summary["reacted_kg"], rel=1e-10)
    assert run.state.temperature.max() > 1100.0


def _hot(more):
    given = {key: dict(value) for key, value in more.items()}
    given["reaction"] = {"heat_J_kg": HEAT} | given.get("reaction", {})
    if "particles" in given:
        given["particles"]["bed"]["volume_fraction"] = 2e-4
    return boxed(effects=BOTH, **given)


def test_grains_that_burn_up_hand_their_heat_on(tmp_path):
    """More oxidant than they need: nothing is left of them, and all of the heat is in the gas."""
    case = boxed(
        count=5, effects=BOTH, vapour=SPECIES | {"mass_fraction": 0.9}, grains={"density_kg_m3": 120.0},
        reaction={"heat_J_kg": HEAT},
    )  # fmt: skip
    run = finished(case, tmp_path)
    summary = run.ledger.summary()
    assert len(run.state.x) == 0
    assert summary["reacted_kg"] == pytest.approx(run.ledger.first["particle_mass_kg"], rel=1e-12)
    assert summary["energy_drift_rel"] <= 1e-10 and summary["species_drift_rel"] <= 1e-10


def test_a_grain_warms_until_the_film_takes_the_heat_off(tmp_path):
    """T - T_g = Q k rho_g Y/(nu h), h = 2 k_g/d, in gas that stays as it is; after many times of warming."""
    case = char(BOTH, end=0.2, windows=40, reaction={"heat_J_kg": HEAT, "rate_m_s": 0.05})
    run = finished(case, tmp_path)
    d = run.state.diameter[0]
    k = 1.0 / (1.0 / 0.05 + d / (2.0 * D))
    rise = HEAT * k * GAS * OXIDANT / RATIO / (2.0 * 0.07 / d)
    np.testing.assert_allclose(run.state.temperature - 1100.0, rise, rtol=5e-3)


def test_momentum_of_what_was_solid_goes_along(tmp_path):
    case = boxed(particles={"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.02, 0.02],
                                    "volume_fraction": 1e-4, "temperature_K": 1100.0, "velocity_m_s": [0.3, -0.2]}})  # fmt: skip
    run = started(case, tmp_path)
    handed = run._hand(0.01)
    volumes, burned = run.exchange.volumes, handed.loss.mass.sum()
    momentum = (handed.terms["momentum", "reaction"] * volumes[:, None]).sum(axis=0)
    np.testing.assert_allclose(0.01 * momentum, burned * np.array([0.3, -0.2, 0.0]), rtol=1e-12, atol=1e-30)
    assert (handed.sources["vapour"] * volumes).sum() * 0.01 == pytest.approx(-RATIO * burned, rel=1e-12)
    assert (handed.sources["carrier"] * volumes).sum() * 0.01 == pytest.approx((1.0 + RATIO) * burned, rel=1e-12)


def test_no_window_takes_more_than_a_cell_holds(tmp_path):
    """Grains that strip their cell a hundred times over in a window leave nothing, and not less."""
    case = boxed(count=1, reaction={"rate_m_s": 1e3, "film": False}, grains={"density_kg_m3": 9e5})
    run = started(case, tmp_path)
    run.clock.limits = {"largest": END}
    run.window()
    oxidant = run.gas_state.fields["vapour_mass_fraction"]
    assert -1e-12 < oxidant.min() <= oxidant.max() < 1e-3 * OXIDANT
    assert run.ledger.summary()["species_drift_rel"] <= 1e-10


def test_a_gas_that_has_less_than_is_used_up_says_so(tmp_path):
    run = started(boxed(), tmp_path)
    handed = run._hand(0.01)
    more = handed.sources | {"vapour": -np.full(1, 0.2 * GAS / 0.01)}
    with pytest.raises(Unfinished, match="less vapour than"):
        run.gas.advance(0.01, more)


def test_windows_take_a_fifth_of_the_oxidant(tmp_path):
    """The limit is there from the start, is obeyed and has the reaction's name."""
    run = started(boxed(count=1, grains={"density_kg_m3": 9e5}), tmp_path)
    before = run.gas_state.budget.vapour
    for _ in range(2):
        run.window()
        assert run.clock.limit == "reaction"
        taken, before = before - run.gas_state.budget.vapour, run.gas_state.budget.vapour
        assert 0.1 < taken / run.ledger.first["gas_vapour_kg"] < 0.2


def test_sizes_shrink_with_the_mass(tmp_path):
    """A spread of sizes: the particle's mass is what its own sizes say, and each of them has burned by its own law."""
    std, end = 0.3 * DIAMETER, 6.0
    run = finished(char(end=end, windows=3, grains={"diameter_std_mm": std * 1e3}), tmp_path)
    state, p = run.state, run.exchange.sizes_p
    left, mean, variance = sizes.remaining(sizes.birth(p, state, 0))
    whole = sizes.remaining(sizes.birth_of(DIAMETER, std**2, 0.0, 0.0))[0]
    assert state.mass[0] / state.born_mass[0] == pytest.approx(left / whole, rel=1e-9)
    assert state.diameter[0] == pytest.approx(mean, rel=1e-12)
    assert state.diameter_variance[0] == pytest.approx(variance, rel=1e-9)

    def after(d):  # d/k_s + d^2/(4 D) falls by 2 rho_g Y t/(nu rho_p)
        left = d / RATE + d * d / (4.0 * D) - 2.0 * GAS * OXIDANT * end / (RATIO * DENSITY)
        root = -2.0 * D / RATE + np.sqrt((2.0 * D / RATE) ** 2 + 4.0 * D * np.maximum(left, 0.0))
        return np.where(left > 0.0, root, 0.0)

    spread = math.sqrt(math.log1p((std / DIAMETER) ** 2))
    z = np.linspace(-8.0, 12.0, 200_001)
    born = DIAMETER * np.exp(spread * z - 0.5 * spread**2)
    number = np.exp(-0.5 * z * z)
    expected = (number * after(born) ** 3).sum() / (number * born**3).sum()
    assert 0.1 < expected < 0.9
    assert state.mass[0] / state.born_mass[0] == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize(("changes", "words"), [
    ({"vapour": None}, r"needs \[vapour\]"),
    ({"effects": ("reaction", "evaporation"), "evaporation": {"latent_heat_J_kg": 0.0, "saturation_pressure_Pa": 100.0}},
     "reaction and evaporation"),
    ({"reaction": {"heat_J_kg": 1.0}}, "add heat to effects"),
    ({"coupling": {"film": True}}, "coupling.film"),
])  # fmt: skip
def test_a_reaction_that_cannot_be_says_so(tmp_path, changes, words):
    changes = dict(changes)
    effects = changes.pop("effects", ("reaction",))
    if changes.get("vapour", 1) is None:
        given = cases.to_table(char())
        del given["vapour"]
        case = cases.from_table(given)
    else:
        case = char(effects, **changes)
    with pytest.raises(CaseError, match=words):
        started(case, tmp_path)


def test_off_leaves_nothing_behind(tmp_path):
    run = started(char(("heat",)), tmp_path)
    assert "carrier" not in run.exchange.sources and run.exchange.losing is None
    assert len(run.state.lost_kinetic) == 0 and not any("D10" in name for name in run.row())
    assert "reaction" not in run.clock.limits
