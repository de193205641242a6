"""Windows and sub-steps before the run: within 30 % of those of a run, and each argument by hand."""

import math

import pytest
from builders import DISC, simulation

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.effects.grains import friction
from sdph.engine import state as particles
from sdph.methods.grains.sound import swing, waves_of
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study.explain import pace, tables

WITHIN = 0.3
EMBEDDED = "coupling.gas='embedded'"
COARSE = (  # a second nozzle, of droplets ten times as wide
    "nozzles.coarse.shape='cone'", "nozzles.coarse.centre_m=[0.08,0.15,0.5]", "nozzles.coarse.direction=[0,0,-1]",
    "nozzles.coarse.radius_m=0.02", "nozzles.coarse.half_angle_deg=20", "nozzles.coarse.temperature_K=300",
    "nozzles.coarse.speed_m_s=5", "nozzles.coarse.rate_kg_s=0.01", "nozzles.coarse.diameter_mm=0.3",
    "nozzles.coarse.diameter_std_mm=0",
)  # fmt: skip
FINE = "grains.diameter_mm=0.03", "grains.diameter_std_mm=0.01", "resolution.cell_mm=40"
RUNS = [
    ("disc_cluster", "coupling.window_tolerance=1e-2", "resolution.spacing_mm=10", "resolution.cell_mm=25"),
    ("disc_cluster", "coupling.window_tolerance=1.0", "resolution.spacing_mm=10", "resolution.cell_mm=25"),
    ("single_droplet", "coupling.window_largest_s=4.0"),
    ("fluidised_column", "run.end_time_s=0.1", "resolution.spacing_mm=7.5", "resolution.cell_mm=15"),
    ("bubbling_bed", "run.end_time_s=0.1", "resolution.spacing_mm=20", "resolution.cell_mm=20"),
    ("bubbling_bed", "run.end_time_s=0.05", "resolution.spacing_mm=10", "resolution.cell_mm=10"),
    (
        "bubbling_bed", "boundaries.distributor.velocity_m_s=[0.0,0.15]", "run.end_time_s=0.8",
        "resolution.spacing_mm=20", "resolution.cell_mm=20",
    ),
    ("evaporating_jet", "run.end_time_s=0.1", "resolution.spacing_mm=50", "resolution.cell_mm=100"),
    ("spray_cone", "resolution.spacing_mm=16", "resolution.cell_mm=40", "coupling.window_tolerance=4e-3"),
    ("spray_cone", "run.end_time_s=0.02", "gas.temperature_K=900", "nozzles.cone.rate_kg_s=0.1"),
    ("spray_cone", "run.end_time_s=0.01", "resolution.cell_mm=8"),
    ("spray_cone", "run.end_time_s=0.03", "resolution.spacing_mm=16", *FINE, *COARSE),
    (
        "evaporating_jet", "run.end_time_s=0.05", "coupling.window_largest_s=1e-3",
        "gas.equation_of_state='operating'", "gas.molar_mass_kg_kmol=28.96",
    ),
    ("stefan_tube", "run.end_time_s=20.0"),
    ("stefan_tube", "run.end_time_s=0.05", "run.output_interval_s=0.05"),  # ruled by evaporation
    (
        "burning_char", "run.end_time_s=0.1", "run.output_interval_s=0.1", "particles.cloud.volume_fraction=0.01",
        "coupling.window_tolerance=0.5", "coupling.courant=50.0", "reaction.heat_J_kg=0.0",
    ),
]  # fmt: skip


def load(scene, *more):
    return cases.load(scenes.find(scene)[1], more)


def counts(case):
    rows = {row["what"]: row["value"] for row in tables.explain(case)["expected"]}
    return rows["windows"], rows["sub-steps"]


@pytest.mark.parametrize("run", RUNS, ids=lambda run: " ".join(run))
def test_a_run_takes_as_many_as_were_predicted(tmp_path, run):
    case = load(run[0], EMBEDDED, *run[1:])
    found = driver.run(case, run[0], tmp_path / "run", None, Reporter(quiet=True))
    assert counts(case) == pytest.approx((found["windows"], found["sub_steps"]), rel=WITHIN)


def test_windows_meet_the_moments_of_the_run():
    """Windows of 0.4 s, an output every second: three in each."""
    case = load("single_droplet", "coupling.window_largest_s=0.4", "run.end_time_s=10", "run.output_interval_s=1")
    s = judge.scales_of(case)
    found = pace.lengths(case, s, start(case))
    assert sum(length * number for length, number in found) == pytest.approx(10.0)
    assert found[-1] == (pytest.approx(1.0 / 3.0), 3)


def start(case):
    from sdph.study.explain.estimate import _state

    return _state(case)


@pytest.mark.parametrize("scene", ["bubbling_bed", "fluidised_column", "evaporating_jet", "single_droplet"])
def test_windows_are_counted_and_not_gone_through(scene):
    """A thousand times as many as usual; limits that do not rule, and never will, keep nobody waiting."""
    case = load(scene, "coupling.window_largest_s=1e-6")
    found = pace.lengths(case, judge.scales_of(case), start(case))
    assert sum(number for _, number in found) == pytest.approx(case.run.end_time / 1e-6, rel=0.05)
    assert len(found) < 1000


def test_a_window_longer_than_the_limit_is_parted():
    assert [pace.parts(1.0, limit, False) for limit in (math.inf, 1.0, 0.9, 0.4)] == [1, 1, 2, 3]
    assert [pace.parts(1.0, limit, True) for limit in (math.inf, 2.0, 0.5)] == [1.0, 1.0, 2.5]


def test_the_step_factor_counts():
    """Of the column: sound rules, some twenty sub-steps a window."""
    coarse = "resolution.spacing_mm=7.5", "resolution.cell_mm=15", "coupling.window_largest_s=0.01"
    whole, half = (counts(load("fluidised_column", *coarse, f"run.step_factor={f}"))[1] for f in (0.1, 0.05))
    assert half == pytest.approx(2.0 * whole, rel=0.02)


def test_the_grip_is_that_of_the_exchange(tmp_path):
    """Of the column at rest: the stepper's clock after a window, on the gas that flows through it."""
    coarse = EMBEDDED, "resolution.spacing_mm=7.5", "resolution.cell_mm=15", "coupling.window_largest_s=0.01"
    case = load("fluidised_column", *coarse, "run.end_time_s=0.01")
    found = driver.run(case, "fluidised_column", tmp_path / "run", None, Reporter(quiet=True))
    assert pace.grip(case, judge.scales_of(case)) == pytest.approx(0.01 / found["windows"], rel=0.1)
    for off in ("coupling.one_way=true", "effects=['gravity','drag']"):
        loose = load("fluidised_column", EMBEDDED, off)
        assert pace.grip(loose, judge.scales_of(loose)) == math.inf


def test_contacts_carry_the_weight_that_the_gas_leaves_them():
    """0.61 x 3060 kg/m3 x 9.81 m/s2 x 0.3 m, and (1 - U/U_mf) of it at U = 0.04 m/s; nothing above U_mf, as the column
    is too narrow for bubbles."""
    weight = 0.61 * 3060.0 * 9.81 * 0.3
    for speed, share in ((0.0, 1.0), (0.04, 1.0 - 0.04 / 0.0855), (0.2, 0.0)):
        case = load("fluidised_column", f"boundaries.distributor.velocity_m_s=[0.0,{speed}]")
        assert pace.carried(case, judge.scales_of(case)) == pytest.approx(share * weight, rel=1e-2, abs=1e-9)


def test_a_bed_that_bubbles_carries_its_whole_weight_once_grains_have_fallen_through_it():
    """0.6 x 3060 kg/m3 x 9.81 m/s2 x 0.5 m, after sqrt(2 x 0.5 m/9.81 m/s2); not below U_mf, nor where grains fly."""
    case, below, beyond = (
        load("bubbling_bed", f"boundaries.distributor.velocity_m_s=[0.0,{speed}]") for speed in (0.15, 0.08, 5.0)
    )
    s, state = judge.scales_of(case), start(case)
    assert pace.bubbles(case, s) and pace.carried(case, s) == pytest.approx(0.6 * 3060.0 * 9.81 * 0.5)
    assert pace.coming_down(case, s) == pytest.approx(math.sqrt(1.0 / 9.81))
    early, late = (pace.sub_steps(case, s, state, come_down)["sound"] for come_down in (False, True))
    assert late < 0.5 * early
    for other in (below, beyond):
        own = judge.scales_of(other)
        assert not pace.bubbles(other, own) and pace.coming_down(other, own) == 0.0


def test_grains_that_carry_are_not_those_that_a_jet_blows_along():
    """The bed weighs on contacts at rest: its step is longer than that of waves there that go with the jet."""
    case = load("bubbling_bed")
    s = judge.scales_of(case)
    waves, packed = waves_of(case), pace.stiffness(case, s)
    assert s.speed > 2.0 and s.thrown == 0.0
    assert pace.fastest(case, s, True) == pytest.approx(swing(waves, *packed))
    assert pace.fastest(case, s, True) > swing(waves, *pace.stiffness(case, s, lasting=False)) + 2.0 * s.speed


def test_thrown_grains_press_with_their_dynamic_pressure():
    """alpha_p rho_p v^2/2 = 0.6 x 700 kg/m3 x (10 m/s)^2/2; grains far from each other have no contacts to stiffen."""
    case = load("evaporating_jet")
    assert pace.carried(case, judge.scales_of(case)) == pytest.approx(21000.0)
    thin = load("evaporating_jet", "nozzles.jet.volume_fraction=0.02")
    assert pace.sound(thin, judge.scales_of(thin)) < 1.0 < pace.sound(case, judge.scales_of(case))


def test_grains_are_packed_by_what_they_carry():
    p = friction.kernel(load("evaporating_jet"))
    for pressure in (1.0, 1e3, 1e6):
        assert friction.pressure(p, pace.packed_by(p, pressure))[0] == pytest.approx(pressure)


def test_a_jet_blows_its_mouth_free():
    """Cells of 10 mm at 7.5 m/s; between grains of 60 % the first window has 18.75 m/s."""
    case = load("bubbling_bed")
    assert pace.later(case, judge.scales_of(case))["courant"] == pytest.approx(0.01 / 7.5)


def test_one_lump_relaxes_as_the_disc_does(tmp_path):
    """Rate and first window are those of the run's own control."""
    case = cases.load(DISC, ("resolution.spacing_mm=10", "resolution.cell_mm=25"))
    run = simulation(case, tmp_path)
    found = pace.lengths(case, judge.scales_of(case), particles_of(run))
    assert found[0][0] == pytest.approx(run.clock.limits["heat exchange"], rel=0.2)
    assert found[-1][0] > 100.0 * found[0][0]


def particles_of(run):
    assert isinstance(run.state, particles.State)
    return run.state


def test_a_case_that_gets_nowhere_is_explained():
    """Its first window is 1e-12 s: below what the run takes."""
    case = load("bubbling_bed", "coupling.window_tolerance=1e-15", "resolution.spacing_mm=20", "resolution.cell_mm=20")
    windows, steps = counts(case)
    assert windows > 0 and steps >= windows


def test_gas_that_comes_in_cold_takes_the_bed_s_temperature_and_no_more():
    """It is twice as fast then; gas among grains of its own temperature does not rush anywhere."""
    hot = ("gas.equation_of_state='operating'", "gas.molar_mass_kg_kmol=28.9", "gas.temperature_K=600",
           "particles.bed.temperature_K=600", "boundaries.jet.temperature_K=300",
           "boundaries.distributor.temperature_K=300")  # fmt: skip
    case = load("bubbling_bed", *hot)
    assert judge.scales_of(case).rush == pytest.approx(2.0 * case.boundaries["jet"].velocity[1])
    apart = load("bubbling_bed", *hot, "gas.temperature_K=300")
    assert judge.scales_of(apart).rush > 100.0 * judge.scales_of(case).rush
