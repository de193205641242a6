"""A droplet that a bubble inflates: pace, flaw, the way out, and a coarse short run to the tear and beyond."""

import json
import math
import tomllib

import numpy as np
import pytest
from test_restart import Cut, Reporter, same_run

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.liquids import time_scaling
from sdph.engine import polygons, restart
from sdph.methods.solids import start
from sdph.running import driver
from sdph.running.hastened import Hastened
from sdph.schema import CaseError
from sdph.study.gel_droplet import checks

FILE = scenes.HERE / "gel_droplet" / "case.toml"


POST = "bodies.post={shape='box', lower_m=[1e-4,1e-4], upper_m=[3e-4,3e-4]}"


def load(*more):
    return cases.load(FILE, more)


def test_a_flaw_takes_its_share_of_the_ring_and_leaves_the_inner_face():
    whole, thin = (start.Made(load(f"bodies.shell.flaw={flaw}")) for flaw in (0.0, 0.3))
    body = load().bodies["shell"]
    inner, outer, half = body.inner_radius, body.radius, body.flaw_half_width
    missing = half * (outer**2 - (inner + 0.7 * (outer - inner)) ** 2)
    layers = round((outer - inner) / load().resolution.spacing)
    count = len(whole.volume) // layers
    assert whole.volume.sum() - thin.volume.sum() == pytest.approx(missing, rel=layers / (count * half / math.pi))
    r = np.hypot(thin.state.x - 1.5e-3, thin.state.y - 1.5e-3)
    x = thin.state.x - 1.5e-3
    spot = (np.abs(np.arctan2(thin.state.y - 1.5e-3, x)) < 0.9 * half) & (x > 0.0)
    assert r[spot].max() == pytest.approx(inner + 0.7 * (1.0 - 0.5 / layers) * (outer - inner), rel=1e-9)
    assert r[~spot].max() == pytest.approx(outer - 0.5 * (outer - inner) / layers, rel=1e-9)


def test_pace_holds_the_wall_at_its_cap():
    p = time_scaling.TimeScalingP(0.2, 1000.0, 25e-6, 2e-4)
    assert time_scaling.pace(p, 0.0, 0.0, 1.0) == 1000.0
    assert time_scaling.pace(p, 0.4, 0.0, 1000.0) == pytest.approx(500.0)
    assert time_scaling.pace(p, -0.4, 0.0, 1000.0) == pytest.approx(500.0)
    assert time_scaling.pace(p, 400.0, 0.0, 1000.0) == 1.0


@pytest.mark.parametrize("pace", [1.0, 8.0])
def test_a_tear_is_followed_whatever_the_pace(tmp_path, pace):
    """Its rows and its end are there where time was as it is too."""
    run = Hastened(load("resolution.spacing_mm=0.025"), tmp_path / "ledger.csv")
    run._hasten(pace)
    run.tear.time = 1e-3
    run._learn(1e-7)
    assert run.clock.end == 1e-3 + run.p.after_tear and run.pace == 1.0
    rows = len(run.clock.landmarks)
    run._learn(1e-7)
    assert len(run.clock.landmarks) == rows > 40


def test_a_run_that_is_to_end_soon_after_its_tear_ends_there(tmp_path):
    run = Hastened(load("resolution.spacing_mm=0.025", "run.end_time_s=1.1e-3"), tmp_path / "ledger.csv")
    run.tear.time = 1e-3
    run._learn(1e-7)
    assert run.clock.end == 1.1e-3 < 1e-3 + run.p.after_tear and run.clock.landmarks.max() == pytest.approx(1.1e-3)
    assert len(run.clock.landmarks) > 40


def test_pace_holds_what_a_closing_bubble_throws():
    p = time_scaling.TimeScalingP(0.2, 1000.0, 25e-6, 2e-4)
    assert time_scaling.pace(p, 0.1, 0.4, 1000.0) == pytest.approx(250.0)
    assert time_scaling.pace(p, 0.1, 0.1, 250.0) == pytest.approx(250.0)
    assert time_scaling.pace(p, 0.4, 0.05, 1000.0) == pytest.approx(500.0)


def test_inertia_of_a_cylinder_is_that_of_rayleigh():
    """Work of the pressure is what the kinetic energy pi rho r^2 v^2 ln(R/r) gains, of a liquid that grows at r v."""
    inner, outer, speed, rate, dt = 2e-4, 5e-4, 0.3, 2e3, 1e-9

    def energy(r, v):
        return math.pi * 1500.0 * r * r * v * v * math.log(math.sqrt(outer**2 + r * r - inner**2) / r)

    gained = energy(inner + speed * dt, speed * (1.0 + rate * dt)) - energy(
        inner - speed * dt, speed * (1.0 - rate * dt)
    )
    power = gained / (2.0 * dt)
    pressure = time_scaling.pressure(1500.0, inner, outer, speed, rate)
    assert power == pytest.approx(pressure * 2.0 * math.pi * inner * speed, rel=1e-5)


def test_viscosity_of_a_cylinder_takes_what_it_dissipates():
    """Power of the pressure is that of the ring: 2 mu D:D = 4 mu (v r/x^2)^2 over 2 pi x dx."""
    inner, outer, speed, viscosity = 2e-4, 5e-4, 0.3, 0.1
    x = np.linspace(inner, outer, 20001)
    lost = np.trapezoid(4.0 * viscosity * (speed * inner / x**2) ** 2 * 2.0 * math.pi * x, x)
    pressure = time_scaling.viscous_pressure(viscosity, inner, outer, speed)
    assert pressure * 2.0 * math.pi * inner * speed == pytest.approx(lost, rel=1e-6)


def test_polygon_knows_what_it_holds():
    turn = 2.0 * math.pi * np.arange(200) / 200
    x, y = np.cos(turn), np.sin(turn)
    assert polygons.area(x, y) == pytest.approx(math.pi, rel=1e-3)
    r = np.linspace(0.01, 2.0, 100)
    assert (polygons.holds(x, y, r * 0.6, r * 0.8) == (r < 1.0)).all()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("bodies.shell.flaw=1.0",), "bodies.shell.flaw"),
        (("bubble.around_Pa=1e7",), "critical pressure"),
        (("bubble.centre_m=[1.6e-3,1.5e-3]",), 'pool of shape "ring"'),
        (("bubble.centre_m=[9.0,9.0]",), 'pool of shape "ring"'),
        (("bodies.shell.shape='disc'",), 'one body of shape "ring"'),
        (("pools.gel.radius_m=6e-4",), "liquid would stand outside its shell"),
        (("effects=['density_diffusion','bubble','gravity','time_scaling','liquid_heat']",), "gravity is not scaled"),
        (("bodies={}",), "one body"),
        (("effects=['density_diffusion','liquid_heat','time_scaling']",), "bubble"),
        (("bubble.flux_W_m2=1e4",), "flux_W_m2 = 10000; time_scaling scales a bubble"),
        (('bubble.content="gas"',), 'bubble.content = "gas"'),
        ((POST,), "give that alone"),
    ],
)
def test_what_is_no_droplet_is_refused_in_one_line(tmp_path, change, told):
    from sdph.running.hastened import of

    with pytest.raises(CaseError, match=told) as error:
        of(load(*change), tmp_path / "ledger.csv")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "told"), [("liquid_heat", "nothing heats the droplet"), ("time_scaling", "looks for the tear")]
)
def test_effects_that_belong_together_are_asked_for(name, told):
    table = tomllib.loads(FILE.read_text())
    table["effects"].remove(name)
    del table[name]
    with pytest.raises(CaseError, match=told):
        cases.from_table(table)


def test_the_reduced_model_is_of_the_fuel_of_the_run_and_tells_nothing_of_another_shell():
    ours = checks.reduced(load("bubble.molar_mass_kg_kmol=100.0", "bubble.flux_W_m2=0.0", "liquid_heat.flux_W_m2=1e6"))
    assert ours.model.own.vapour.molar_mass == 100.0
    assert ours.model.own.vapour.antoine == load().parameters["bubble"].antoine
    for key in ("liquid_heat.body_heat_capacity_J_kg_K=500", "solid.density_kg_m3=900", "solid.damage_begins_at=0.1"):
        with pytest.raises(CaseError, match=f"knows no {key.partition('=')[0]}"):
            checks.reduced(load(key))


HURRIED = (
    "resolution.spacing_mm=0.025", "liquid_heat.flux_W_m2=5.68e6", 'liquid_heat.heated="inside"',
    "time_scaling.wall_speed_cap_m_s=3.0", "run.end_time_s=0.028", "run.output_interval_s=0.014",
    "liquid.history_interval_s=0.001", "run.checkpoint_windows=2",
)  # fmt: skip


def test_resumed_run_in_mid_neck_is_the_uninterrupted_one_bit_for_bit(tmp_path):
    """Heat ten times as fast as the fastest droplet: it is damaged when it is cut, and goes at another pace."""
    whole = driver.run(load(*HURRIED), "gel_droplet", tmp_path / "whole", None, Reporter(None))
    with pytest.raises(Cut):
        driver.run(load(*HURRIED), "gel_droplet", tmp_path / "cut", None, Reporter(whole["windows"] - 2))
    kept = json.loads((restart.newest(tmp_path / "cut").folder / "numbers.json").read_text())
    assert kept["simulation"]["pace"] < 1000.0  # it changes in each window: impulse and work of that are kept too
    driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    rows = np.genfromtxt(tmp_path / "whole" / "history.csv", delimiter=",", names=True)
    assert rows["solid_damage_largest"][-3] > 0.0 and rows["time_scale"][-3] < 1000.0
    assert whole["heat_drift_rel"] < 1e-10 and whole["mass_drift_rel"] < 1e-12
    assert whole["whole_mass_drift_rel"] < 1e-10  # the vapour in the bubble with it


def test_a_torn_droplet_goes_on_bit_for_bit(tmp_path):
    """A weak shell, cut as soon as it yields: the void is flooded, vapour goes out, and both go on as they were."""
    weak = "solid.failure=[1e-4,1e-3,-0.054,0.0,0.0]", "bodies.shell.flaw=0.3", "liquid_heat.flux_W_m2=1.1e7"
    quick = load(*HURRIED, *weak, "time_scaling.after_tear_ms=0.045")
    whole = driver.run(quick, "gel_droplet", tmp_path / "whole", None, Reporter(None))
    assert whole["torn"] and whole["rupture_time_s"] < whole["vent_opened_s"] < whole["bubble_gone_s"]
    with pytest.raises(Cut):
        driver.run(quick, "gel_droplet", tmp_path / "cut", None, Reporter(whole["windows"] - 25))
    kept = json.loads((restart.newest(tmp_path / "cut").folder / "numbers.json").read_text())["simulation"]
    assert kept["tear"]["opened"] is not None and kept["tear"]["gone"] is None
    with pytest.raises(Cut):
        driver.resume(tmp_path / "cut", (), Reporter(whole["windows"] - 2))
    kept = json.loads((restart.newest(tmp_path / "cut").folder / "numbers.json").read_text())["simulation"]
    assert kept["tear"]["gone"] is not None
    driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    assert whole["whole_mass_drift_rel"] < 1e-12
    rows = np.genfromtxt(tmp_path / "whole" / "history.csv", delimiter=",", names=True)
    out = rows["tear_width_m"] > 0.0
    assert (
        (np.diff(rows["vented_kg"]) >= 0.0).all()
        and out.any()
        and (rows["bubble_pressure_Pa"][-1], rows["tear_width_m"][-1]) == (0.0, 0.0)
    )
