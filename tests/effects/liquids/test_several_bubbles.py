"""Several bubbles in a liquid: told apart, grown alike, merged, closed with their mass and heat, restarted."""

import dataclasses
import math

import numpy as np
import pytest
from test_restart import Cut, Reporter, same_run

from sdph.case import read as cases
from sdph.effects.gas import gel
from sdph.effects.liquids import liquid_heat
from sdph.engine.guard import Unstable
from sdph.laws import real_gas
from sdph.methods.liquids import content, rooms
from sdph.running import balances, driver
from sdph.running.alone import Alone
from sdph.schema import CaseError

MIDDLE, RIM, SPACING = 1e-3, 5e-4, 3.75e-5  # m
END = 4e-7  # s: some steps
VAPOUR = gel.vapour(gel.Fuel())
BOILING = real_gas.saturation_temperature(VAPOUR, 101325.0)
FLUX = 0.1 * real_gas.saturated_density(VAPOUR, BOILING) * VAPOUR.latent_heat  # W/m2: a wall of 0.1 m/s
# mirror images: the circles of particles are even about the x axis
PAIR = {"centres_m": [[MIDDLE, MIDDLE - 2e-4], [MIDDLE, MIDDLE + 2e-4]], "radii_m": [1e-4, 1e-4]}
RING = {"shape": "ring", "centre_m": [MIDDLE, MIDDLE], "radius_m": RIM, "inner_radius_m": 1.5e-4}
DISC = {"shape": "disc", "centre_m": [MIDDLE, MIDDLE], "radius_m": RIM}
HEAT = {"conductivity_W_m_K": 0.5, "heat_capacity_J_kg_K": 5000.0, "flux_W_m2": 1e9, "heated": "inside"}


PAIR_MASS = 2.0 * real_gas.saturated_density(VAPOUR, BOILING) * math.pi * 1e-8  # kg/m of both at the start


def case_of(end: float, pool: dict, *effects, **bubble):
    return cases.from_table({
        "dimensions": 2, "effects": ["density_diffusion", "bubble", *effects],
        "run": {"end_time_s": end, "output_interval_s": 0.5 * end, "checkpoint_windows": 2},
        "domain": {"size_m": [2e-3, 2e-3], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": 1e3 * SPACING, "smoothing_ratio": 1.3},
        "liquid": {"density_kg_m3": 1500.0, "sound_speed_m_s": 100.0, "history_interval_s": 0.1 * end},
        "pools": {"gel": pool}, "bubble": {"content": "vapour"} | bubble,
    } | ({"liquid_heat": HEAT} if effects else {}))  # fmt: skip


def gone(case, folder) -> Alone:
    run = Alone(case, folder / "ledger.csv")
    run.start()
    while not run.clock.over(run.time):
        run.window()
    return run


def holed(gap: float) -> tuple[np.ndarray, np.ndarray]:
    """A lattice of 1 with two round holes of radius 6 that stand `gap` apart."""
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(60.0)], indexing="ij"))
    off = 6.0 + 0.5 * gap
    kept = (np.hypot(x - 29.5 - off, y - 29.5) > 6.0) & (np.hypot(x - 29.5 + off, y - 29.5) > 6.0)
    return np.stack([x, y], axis=1)[kept], np.ones(int(kept.sum()))


def test_rooms_of_a_grid_are_the_voids():
    points, volume = holed(4.0)
    found = rooms.find(points, volume, 1.0)
    one, other = (rooms.of(found, np.array([29.5 + off, 29.5]), 6.0) for off in (-8.0, 8.0))
    assert one and other and one != other
    area, middle = rooms.measure(found, one)
    assert math.sqrt(area / math.pi) == pytest.approx(6.0, abs=0.7)
    assert middle == pytest.approx([21.5, 29.5], abs=0.1)
    assert rooms.of(found, np.array([29.5, 5.0]), 6.0) == 0  # there is liquid
    joined = rooms.find(*holed(0.0), 1.0)
    assert rooms.of(joined, np.array([23.5, 29.5]), 6.0) == rooms.of(joined, np.array([35.5, 29.5]), 6.0)


def test_one_bubble_named_the_new_way_is_that_of_a_ring_bit_for_bit(tmp_path):
    old = case_of(END, RING, centre_m=[MIDDLE, MIDDLE], flux_W_m2=float(FLUX))
    new = case_of(END, DISC, centres_m=[[MIDDLE, MIDDLE]], radii_m=[1.5e-4], flux_W_m2=float(FLUX))
    first, second = gone(old, tmp_path), gone(new, tmp_path)
    assert first.row() == second.row()
    for one, other in zip(first.state, second.state):
        assert np.array_equal(one, other)


def test_two_equal_bubbles_grow_alike_and_close_mass_and_heat(tmp_path):
    run = gone(case_of(END, DISC, "liquid_heat", **PAIR), tmp_path)
    void, told = run.method.stepper.void, run.ledger.summary() | run.method.summary()
    (one, other), first = void.parts, PAIR_MASS
    assert one.area + other.area == pytest.approx(void.area, rel=1e-12)
    gained = [part.mass - 0.5 * first for part in (one, other)]
    assert gained[0] > 0.0 and gained[0] == pytest.approx(gained[1], rel=0.01)
    assert void.heat == pytest.approx(VAPOUR.latent_heat * (void.passed[0] + void.owed) + void.warmed, rel=1e-6)
    assert void.mass - first == pytest.approx(void.passed[0] + void.owed, rel=1e-6)
    assert max(told["mass_drift_rel"], told["momentum_drift_rel"], told["heat_drift_rel"]) < 1e-11
    assert void.heat == pytest.approx(told["heat_to_bubble_J"], rel=1e-9) and told["bubbles_left"] == 2


def test_a_bubble_whose_room_is_gone_leaves_mass_and_heat_to_the_liquid(tmp_path):
    run = Alone(case_of(END, DISC, "liquid_heat", **PAIR), tmp_path / "ledger.csv")
    run.start()
    stepper, void = run.method.stepper, run.method.stepper.void
    part, mass, gel_mass = void.parts[1], void.parts[1].mass, float(stepper.state.mass.sum())
    part.rim = np.array([MIDDLE + 3.5e-4, MIDDLE])  # in the liquid, farther from a void than its radius
    run.window()
    assert not part.held and void.condensed == pytest.approx(mass, rel=1e-3)
    assert stepper.state.mass.sum() + void.mass - void.owed == pytest.approx(
        gel_mass + mass + PAIR_MASS / 2.0, rel=1e-12
    )
    assert stepper.heat.taken == pytest.approx(-VAPOUR.latent_heat * mass, rel=1e-3)  # it is given back
    told = run.ledger.summary() | stepper.heat.summary()
    assert max(told["mass_drift_rel"], told["momentum_drift_rel"], told["heat_drift_rel"]) < 1e-11
    assert void.heat == pytest.approx(VAPOUR.latent_heat * (void.passed[0] + void.owed) + void.warmed, rel=1e-9)
    assert void.row()["bubbles_left"] == 1 and void.row()["bubble_2_kg"] == 0.0


def test_a_bubble_smaller_than_a_particle_is_closed(tmp_path):
    run = Alone(case_of(END, DISC, "liquid_heat", **PAIR), tmp_path / "ledger.csv")
    run.start()
    void = run.method.stepper.void
    large, small = void.parts
    large.area, small.area = 1.1 * SPACING**2, 0.9 * SPACING**2
    run.window()
    assert (large.held, small.held, void.closed) == (True, False, 1)
    assert void.row()["bubble_2_kg"] == 0.0
    told = run.ledger.summary() | run.method.stepper.heat.summary()
    assert max(told["mass_drift_rel"], told["momentum_drift_rel"], told["heat_drift_rel"]) < 1e-11


def test_merged_bubbles_of_gas_go_on_with_the_gas_of_both():
    """A checkpoint keeps what each began with, as one has that of two."""
    gas = PAIR | {"content": "gas", "excess_Pa": 1e3, "around_Pa": 1e5}
    case = case_of(END, DISC, **gas)
    void = Alone(case, None).method.stepper.void
    one, other = void.parts
    void._merge(one, other)
    kept, fresh = {name: getattr(one, name) for name in one.KEPT}, Alone(case, None).method.stepper.void.parts[0]
    for name, value in kept.items():
        setattr(fresh, name, value)
    assert fresh.first == one.first > fresh.area


def test_bubbles_that_meet_are_one_with_all_their_mass_and_heat(tmp_path):
    near = PAIR | {"centres_m": [[MIDDLE, MIDDLE - 1.01e-4], [MIDDLE, MIDDLE + 1.01e-4]]}
    run = Alone(case_of(END, DISC, "liquid_heat", **near), tmp_path / "ledger.csv")
    void = run.method.stepper.void
    first = PAIR_MASS
    assert (void.merged, len(void.left)) == (1, 1)
    assert void.area == pytest.approx(2.0 * math.pi * 1e-8, rel=1e-6)
    assert void.mass - first == pytest.approx(void.passed[0] + void.owed, abs=1e-12 * first)
    run.start()
    run.window()
    assert void.heat == pytest.approx(VAPOUR.latent_heat * (void.passed[0] + void.owed) + void.warmed, rel=1e-8)


def test_resumed_run_is_the_uninterrupted_one_bit_for_bit(tmp_path):
    case = case_of(END, DISC, "liquid_heat", **PAIR)
    whole = driver.run(case, "", tmp_path / "whole", None, Reporter(None))
    with pytest.raises(Cut):
        driver.run(case, "", tmp_path / "cut", None, Reporter(whole["windows"] // 2 + 1))
    driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")


def heated(end: float, **heat):
    """A case of one bubble in gel of such [liquid_heat]."""
    case = case_of(end, RING, "liquid_heat", centre_m=[MIDDLE, MIDDLE])
    own = liquid_heat.LiquidHeat(conductivity=0.5, heat_capacity=5000.0, **heat)
    return dataclasses.replace(case, parameters=case.parameters | {"liquid_heat": own})


def test_where_next_to_no_heat_is_exchanged_its_drift_is_related_to_a_share_of_all(tmp_path):
    """0.03 mJ go to and fro at 0.4 K from boiling, of 2.6 kJ: round-off is 2e-10 of that, and nothing is lost."""
    stepper = gone(heated(4e-6, temperature=489.0), tmp_path).method.stepper
    told = stepper.heat.summary()
    assert 0.0 < abs(told["heat_to_bubble_J"]) < 1e-4 and told["heat_drift_rel"] < 1e-11
    stepper.heat.came += 1e-5  # J, out of nothing
    assert balances.missed(stepper.heat.summary())


def test_a_drift_of_heat_is_related_to_what_was_exchanged(tmp_path):
    heat = gone(case_of(END, DISC, "liquid_heat", **PAIR), tmp_path).method.stepper.heat
    heat.taken += 1e-6  # J
    told = heat.summary()
    exchanged = told["heat_in_J"] + told["heat_to_bubble_J"]
    assert exchanged > 0.1 and told["heat_drift_rel"] == pytest.approx(told["heat_drift_J"] / exchanged, rel=1e-12)


@pytest.mark.parametrize(
    ("heat", "told"),
    [
        ({"temperature": 300.0}, "raise that to 489.4 K, where it boils"),
        ({"temperature": 640.0}, "lower liquid_heat.temperature_K or run.step_factor"),
        ({"flux": 1e6}, "lower liquid_heat.flux_W_m2 or run.step_factor"),
        ({}, "lower run.step_factor"),
    ],
)
def test_a_bubble_out_of_bounds_names_keys_of_what_is_on(heat, told):
    assert content.remedy(heated(END, **heat)).partition(": ")[2 * ("raise" in told)].startswith(told)


def test_a_bubble_that_nothing_but_its_wall_heats_names_its_own_flux():
    assert content.remedy(case_of(END, DISC, **PAIR, flux_W_m2=1e5)) == "lower bubble.flux_W_m2 or run.step_factor"


def test_a_bubble_that_condenses_ends_with_what_to_do(tmp_path):
    run = Alone(heated(1e-5, temperature=300.0), tmp_path / "ledger.csv")
    run.start()
    (bubble,) = run.method.stepper.void.parts
    bubble.mass *= 1e-3  # as if all but that had condensed
    with pytest.raises(Unstable, match=r"density of the vapour .*; in a liquid of liquid_heat\.temperature_K = 300"):
        run.window()


@pytest.mark.parametrize(
    ("pool", "change", "told"),
    [
        (RING, {}, 'one pool of shape "disc"'),
        (DISC, {"centre_m": [MIDDLE, MIDDLE]}, "give one of them"),
        (DISC, {"radii_m": [1e-4]}, "one radius for each"),
        (DISC, {"centres_m": [MIDDLE, MIDDLE]}, "one radius for each"),
        (DISC, {"radii_m": [1e-4, 3e-5]}, "below 2 resolution.spacing_mm"),
        (DISC, {"radii_m": [1e-4, 3e-4]}, "not a spacing within the pool"),
        (DISC, {"centres_m": [[9.0, 9.0], [MIDDLE, MIDDLE]]}, "not a spacing within the pool"),
        (DISC, {"centres_m": [[MIDDLE, MIDDLE], [MIDDLE, MIDDLE]]}, "overlaps"),
    ],
)
def test_what_is_no_bubble_is_refused_in_one_line(tmp_path, pool, change, told):
    with pytest.raises(CaseError, match=told) as error:
        Alone(case_of(1e-5, pool, **(PAIR | change)), tmp_path / "ledger.csv")
    assert "\n" not in str(error.value)
