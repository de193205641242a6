"""Evaporation: what leaves particles is what the gas gets; wet bulb, boiling, onset, the end of a droplet,
condensation."""

import math
import tomllib

import numpy as np
import pytest
from builders import fixed_windows, simulation

from coupling.embedded import EmbeddedGas
from sdph import scenes
from sdph.case import read as cases
from sdph.effects.effect import OFF
from sdph.effects.gas import evaporation, heat, sizes
from sdph.engine import state as particles
from sdph.exchange import droplets as droplet_loss
from sdph.exchange import equations as exchange
from sdph.laws import evaporation as law
from sdph.laws import exact
from sdph.schema import CaseError

DROPLET = scenes.HERE / "single_droplet" / "case.toml"
TWO_WAY = ("coupling.one_way=false", "gas.equation_of_state='operating'")
MANY = ("particles.droplet.volume_fraction=1e-4", "run.end_time_s=0.5", "run.output_interval_s=0.5")
CLAPEYRON = (1329.0, 294.3, 277000.0, 142.284)


def droplet(*overrides):
    return cases.load(DROPLET, overrides)


def started(case, folder):
    return simulation(case, folder, gas=lambda case, cells: EmbeddedGas(case))


def finished(case, folder):
    run = started(case, folder)
    while run.time < case.run.end_time:
        run.window()
    return run


@pytest.mark.parametrize("more", [
    (),
    ("evaporation.law='spalding'",),
    ("evaporation.law='spalding'", "gas.temperature_K=1000"),
    ("grains.diameter_std_mm=0.4",),
    ("evaporation.saturation='constant'",),
    ("vapour.heat_capacity_J_kg_K=1500",),
])  # fmt: skip
def test_what_the_droplets_lose_the_gas_gains(tmp_path, more):
    """Mass, vapour and energy of both sides over a run in a closed box, to 1e-10 of what was exchanged."""
    case = droplet(*TWO_WAY, *MANY, "grains.diameter_mm=0.3", *more, *fixed_windows(0.05))
    summary = finished(case, tmp_path).ledger.summary()
    assert summary["evaporated_kg"] > 1e-6 * case.grains.density * 1e-4 * 1e-4
    for name in ("exchange_mass_mismatch_rel", "exchange_energy_mismatch_rel", "species_drift_rel", "energy_drift_rel"):
        assert summary[name] <= 1e-10, name
    assert summary["particle_mass_drift_rel"] <= 1e-12 and summary["mass_drift_rel"] <= 1e-12


def test_momentum_of_the_vapour_is_that_of_the_droplet(tmp_path):
    case = droplet(*TWO_WAY, *MANY, "particles.droplet.velocity_m_s=[0.3, -0.2]")
    run = started(case, tmp_path)
    handed = run.hand(0.01)
    volumes = run.exchange.volumes
    mass = (handed.sources["vapour"] * volumes).sum()
    momentum = (handed.terms["momentum", "evaporation"] * volumes[:, None]).sum(axis=0)
    np.testing.assert_allclose(momentum, mass * np.array([0.3, -0.2, 0.0]), rtol=1e-12, atol=1e-30)
    enthalpy = (handed.terms["heat", "evaporation"] * volumes).sum()
    assert enthalpy == pytest.approx(mass * case.vapour.heat_capacity * 294.0, rel=1e-12)
    assert mass * 0.01 == pytest.approx(handed.loss.mass.sum(), rel=1e-12)


def test_the_pace_of_vapour_is_what_a_short_window_brings(tmp_path):
    """Vapour over the gas of the cell that gets most: rate at the start times a window, and what that window hands
    over."""
    run = started(droplet(*TWO_WAY, *MANY), tmp_path)
    pace, _ = run.exchange.pace(run.state, run.weights, run.gas_state)[2]
    assert pace > 0.0
    assert run.exchange.losing.share(run.hand(1e-6), run.gas_state) == pytest.approx(1e-6 * pace, rel=1e-3)


@pytest.mark.parametrize("windows", [1, 7])
def test_a_droplet_vanishes_in_any_window(tmp_path, windows):
    """Three lives in one window or in seven: nothing left, nothing negative, nothing that is no number."""
    case = droplet(
        "coupling.one_way=true", "run.end_time_s=180.0", "run.output_interval_s=180.0", *fixed_windows(180.0 / windows)
    )
    run = finished(case, tmp_path)
    assert len(run.state.x) == 0
    summary = run.ledger.summary()
    assert summary["evaporated_kg"] == pytest.approx(case.grains.density * 1e-6 * 1e-4, rel=1e-12)
    assert np.isfinite(list(value for value in summary.values())).all()


def one(temperature, latched=0.0):
    names = {"temperature", "diameter", "diameter_variance", *evaporation.EFFECT.arrays}
    state = particles.empty(1, names, 2)
    for name, value in (
        ("mass", 1e-9),
        ("density", 1.0),
        ("temperature", temperature),
        ("diameter", 1e-3),
        ("evaporating", latched),
    ):
        getattr(state, name)[:] = value
    return particles.born(state)


@pytest.mark.parametrize(
    ("onset", "latched", "expected"), [("latched", 1.0, True), ("latched", 0.0, False), ("paper", 1.0, False)]
)
def test_onset(onset, latched, expected):
    """Below the onset a droplet evaporates only where it is latched and has begun before."""
    p = evaporation.kernel(droplet(f"evaporation.onset='{onset}'", "evaporation.onset_temperature_K=300.0"))
    assert (droplet_loss.active_time(p, one(295.0, latched), 0, 0.0, 295.0, 0.0, 1.0) > 0.0) == expected
    assert droplet_loss.active_time(p, one(301.0), 0, 0.0, 301.0, 0.0, 1.0) == 1.0


def test_onset_within_a_window():
    """It starts when the droplet, warming up towards the gas, passes the onset."""
    p = evaporation.kernel(droplet("evaporation.onset_temperature_K=300.0"))
    state = one(290.0)
    conductance = 2.0 * state.mass[0] * p.grain_heat_capacity
    active = droplet_loss.active_time(p, state, 0, conductance, 350.0, 0.0, 1.0)
    warm = 350.0 - 60.0 * math.exp(-2.0 * (1.0 - active))
    assert warm == pytest.approx(300.0, rel=1e-12)


@pytest.mark.parametrize("relaxations", [0.0, 1e-6, 2.0])
def test_onset_within_a_window_by_other_heat(relaxations):
    """Heat that comes beside the gas's brings it there too: C dT/dt = K (T_g - T) + beside, in gas of 290 K."""
    p = evaporation.kernel(droplet("evaporation.onset_temperature_K=300.0"))
    state = one(290.0)
    capacity = state.mass[0] * p.grain_heat_capacity
    arguments = relaxations * capacity, 290.0
    active = droplet_loss.active_time(p, state, 0, *arguments, 40.0 * capacity, 1.0)
    late = 1.0 - active
    rise = 40.0 * late if relaxations == 0.0 else -40.0 / relaxations * math.expm1(-relaxations * late)
    assert 0.0 < active < 1.0 and rise == pytest.approx(10.0, rel=1e-9)
    assert droplet_loss.active_time(p, state, 0, *arguments, 5.0 * capacity, 1.0) == 0.0


def test_condensation_is_refused_and_counted(tmp_path):
    """Warm droplets saturate the gas; cold ones beside them lose nothing, gain nothing, and what they would gain is
    counted."""
    table = tomllib.loads(DROPLET.read_text(encoding="utf-8"))
    del table["heat"]
    table["resolution"]["spacing_mm"] = 5.0
    box = {"shape": "box", "volume_fraction": 1e-2}
    table |= {
        "effects": ["evaporation"],
        "coupling": {"window_largest_s": 0.2, "window_tolerance": 1e30},
        "run": {"end_time_s": 8.0, "output_interval_s": 8.0},
        "evaporation": {"latent_heat_J_kg": 0.0, "saturation": "antoine", "antoine": [9.0, 1500.0, 0.0]},
        "particles": {
            "droplet": box | {"lower_m": [0.015, 0.015], "upper_m": [0.025, 0.025], "temperature_K": 320.0},
            "cold": box | {"lower_m": [0.005, 0.015], "upper_m": [0.015, 0.025], "temperature_K": 280.0},
        },
    }
    table["gas"]["equation_of_state"] = "operating"
    run = finished(cases.from_table(table), tmp_path)
    summary = run.ledger.summary()
    cold = run.state.temperature < 300.0
    assert summary["condensation_refused_kg"] > 0.01 * summary["evaporated_kg"]
    assert f"condensation_refused_kg = {summary['condensation_refused_kg']:.3g}, " in run.warnings()[0]
    assert (run.state.mass <= run.state.born_mass).all()
    assert (run.state.mass[~cold] < run.state.born_mass[~cold]).all()
    assert summary["species_drift_rel"] <= 1e-10


def test_rate_is_ranz_and_marshall_in_a_stream():
    """Mass lost in a short time by a droplet in a stream, against the law by itself."""
    case = droplet()
    p, state, dry = evaporation.kernel(case), one(330.0), np.zeros(1)
    around = np.full(1, 3.0), np.full(1, 1.225), np.full(1, 350.0)
    convection, conductance, damping = (np.empty(1) for _ in range(3))
    nothing, apart = np.zeros((0, 3)), np.zeros((1, 3))
    off = (OFF, heat.kernel(case), OFF, OFF, OFF, OFF)
    seen = exchange.Around(apart, *around, nothing)
    exchange.rates(*off, state, 700.0, seen, convection, conductance, damping, nothing)
    loss, rate, *others = (np.empty(1) for _ in range(6))
    droplet_loss.losses(p, OFF, state, *around, dry, np.zeros(1), 1e-6, convection, conductance, loss, *others)
    droplet_loss.rates(p, OFF, state, *around, dry, rate)
    reynolds = 1.225 * 3.0 * 1e-3 / case.gas.viscosity
    sherwood = law.sherwood_ranz_marshall(reynolds, law.schmidt_number(1.225, case.gas.viscosity, 3.79e-6))
    surface = law.vapour_concentration(law.saturation_clausius_clapeyron(330.0, CLAPEYRON), 330.0)
    flux = sherwood * 3.79e-6 / 1e-3 * 142.284 * surface  # kg/(m2 s)
    expected = 6.0 * flux / (700.0 * 1e-3) * 1e-9 * 1e-6
    assert loss[0] == pytest.approx(expected, rel=1e-4) and 1e-6 * rate[0] == pytest.approx(expected, rel=1e-4)


def lost(case, state, window, share):
    """Mass lost in a window [s], its force [kg/m3] and the mean conductance over that at the start, in gas of 1000 K;
    `share` of the conductance is by convection."""
    p, dry = evaporation.kernel(case), np.zeros(1)
    around = np.full(1, 3.0), np.full(1, 0.35), np.full(1, 1000.0)
    conductance = np.full(1, 1e-6)
    convection = share * conductance
    loss, still, *others = (np.empty(1) for _ in range(5))
    droplet_loss.losses(p, OFF, state, *around, dry, np.zeros(1), window, convection, conductance, loss, still, *others)
    force = still[0] * p.grain_density / (8.0 * p.diffusivity * window)
    return loss[0], force, conductance[0] / 1e-6


@pytest.mark.parametrize("share", [1.0, 0.4])
def test_vapour_holds_back_heat_of_convection_alone(share):
    """Of the part that is convection z/(exp(z) - 1), z = m' c_pv/(h A); of radiation nothing. Linear has none."""
    case = droplet("evaporation.law='spalding'")
    mass, _, mean = lost(case, one(390.0), 1e-6, share)
    z = mass / 1e-6 * case.vapour.heat_capacity / (share * 1e-6)
    assert z > 0.5
    assert mean == pytest.approx(1.0 - share * (1.0 - z / math.expm1(z)), rel=1e-4)
    assert lost(droplet(), one(390.0), 1e-6, share)[2] == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize("temperature", [300.0, 390.0, 402.6, 420.0])
@pytest.mark.parametrize("window", [1e-6, 0.01, 1.0, 100.0])
def test_rate_and_heat_of_a_window_belong_together(temperature, window):
    """Vapour of the force that was found leaves the heat that makes it, in any window; boiling, cold, or gone in it."""
    p, state, dry = evaporation.kernel(droplet("evaporation.law='spalding'")), one(temperature), np.zeros(1)
    c = evaporation.ventilation(p, 3.0, 0.35)
    rate = droplet_loss.transfer(p, OFF, state, 0, c)
    balance = droplet_loss.balance_of(
        p, OFF, state, 0, rate, c, (0.35, 1000.0, dry[0], 0.0), window, window, 1e-6, 1e-6
    )
    force = droplet_loss.window_force(p, balance)
    free, none = (droplet_loss.force_by(p, balance, without) for without in (0.0, 1.0))
    assert none <= force <= free
    assert droplet_loss.force_by(p, balance, droplet_loss.held_back(balance, force)) == pytest.approx(force, rel=1e-10)


def test_spaldings_force_is_what_drives_a_droplet():
    """rho_g ln((1 - Y)/(1 - Y_s)), the mole fractions being p_sat/p and C R T/p, worked out here once more."""
    case = droplet("evaporation.law='spalding'")
    p = evaporation.kernel(case)
    surface = law.saturation_clausius_clapeyron(330.0, CLAPEYRON) / 101325.0
    around = 2e-4 * 8314.46261815324 * 350.0 / 101325.0
    y_s, y = (x * 142.284 / (x * 142.284 + (1.0 - x) * case.gas.molar_mass) for x in (surface, around))
    found = evaporation.driving_force(p, 330.0, 2e-4, 350.0, 1.1)
    assert found == pytest.approx(1.1 * math.log((1.0 - y) / (1.0 - y_s)), rel=1e-10)


def test_wet_bulb_in_a_stream_of_windows(tmp_path):
    """Long windows land on the wet bulb of the closed form."""
    case = droplet("run.end_time_s=40.0", "run.output_interval_s=40.0", *fixed_windows(5.0))
    run = finished(case, tmp_path)
    expected = exact.wet_bulb_temperature(
        350.0,
        lambda T: law.saturation_clausius_clapeyron(T, CLAPEYRON),
        3.79e-6,
        142.284,
        277000.0,
        case.gas.conductivity,
    )
    assert run.state.temperature[0] == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize(("overrides", "words"), [
    (("evaporation.saturation='antoine'",), "antoine is missing"),
    (("effects=['evaporation']", "heat.law='gunn'"), "heat"),
])  # fmt: skip
def test_an_evaporation_that_cannot_be_says_so(tmp_path, overrides, words):
    with pytest.raises(CaseError, match=words):
        started(droplet(*overrides), tmp_path)


def test_sizes_shrink_with_the_mass(tmp_path):
    """A spread of sizes: after the run the particle's mass is what its own sizes say."""
    case = droplet(
        "grains.diameter_std_mm=0.3", "run.end_time_s=30.0", "run.output_interval_s=30.0", *fixed_windows(1.0)
    )
    run = finished(case, tmp_path)
    state, p = run.state, run.exchange.sizes_p
    left, mean, variance = sizes.remaining(sizes.birth(p, state, 0))
    whole = sizes.remaining(sizes.birth_of(1e-3, 0.3e-3**2, 0.0, 0.0))[0]
    assert state.mass[0] / state.born_mass[0] == pytest.approx(left / whole, rel=1e-9)
    assert 0.1 < left / whole < 0.9
    assert state.diameter[0] == pytest.approx(mean, rel=1e-12) and state.diameter_variance[0] == pytest.approx(
        variance, rel=1e-9
    )
