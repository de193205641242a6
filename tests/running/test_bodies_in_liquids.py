"""Elastic bodies that touch a liquid: what one gets the other gives, a column swings on a block as on a spring."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from test_restart import Cut, Reporter, same_run

from sdph import cli, scenes
from sdph.case import read as cases
from sdph.effects.solids import rigid_sides
from sdph.engine import state as particles
from sdph.laws.solids import lame_ring
from sdph.methods.liquids import account
from sdph.methods.solids.method import IMPULSES, SolidStepper
from sdph.running import driver
from sdph.running.together import Together
from sdph.schema import CaseError
from sdph.show import timeline
from sdph.study import explained

WIDE, HIGH, DEEP, SPACING = 0.12, 0.12, 0.2, 0.01  # m, of a block and of the water above
YOUNGS, SOUND = 2e5, 40.0  # Pa, m/s

COLUMN = {
    "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank"],
    "run": {"end_time_s": 0.2, "output_interval_s": 0.1},
    "domain": {"size_m": [WIDE, 0.5], "gravity_m_s2": [0.0, -9.81]},
    "resolution": {"spacing_mm": SPACING * 1e3, "smoothing_ratio": 1.5},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": SOUND, "history_interval_s": 0.001},
    "tank": {"slip": "free_slip", "open_sides": ["top"]},
    "pools": {"water": {"shape": "box", "lower_m": [0.0, HIGH], "upper_m": [WIDE, HIGH + DEEP]}},
    "solid": {"density_kg_m3": 1000.0, "youngs_modulus_Pa": YOUNGS, "poisson_ratio": 0.0},
    "bodies": {"block": {
        "shape": "box", "lower_m": [0.0, 0.0], "upper_m": [WIDE, HIGH],
        "held_lower_m": [0.0, 0.0], "held_upper_m": [WIDE, SPACING],
    }},
}  # fmt: skip
DOMAIN = {"size_m": [WIDE, WIDE], "gravity_m_s2": [0.0, -9.81]}
FLAP = ("resolution.spacing_mm=12.5", "run.end_time_s=0.02", "run.output_interval_s=0.01", "solid.courant=0.2")


def flap(*more):
    return cases.load(scenes.HERE / "tank_with_flap" / "case.toml", (*FLAP, *more))


def gone(case, folder) -> tuple[Together, list[dict]]:
    run = Together(case, folder / "ledger.csv")
    run.start()
    rows = [run.row()]
    while not run.clock.over(run.time):
        run.window()
        rows += [run.row()] if run.at_row else []
    return run, rows


def period() -> float:
    """T [s] of a rod with a column of compressible liquid on it: x tan(x) tan(k d)/(k d) = rho_s L/(rho d)."""
    length = HIGH - SPACING  # of what is free
    speed, ratio = math.sqrt(YOUNGS / 1000.0), length / DEEP

    def off(w):
        x, k = w * length / speed, w * DEEP / SOUND
        return x * math.tan(x) * math.tan(k) / k - ratio

    return 2.0 * math.pi / brentq(off, 1.0, 0.499 * math.pi * speed / length)


@pytest.fixture(scope="module")
def column(tmp_path_factory):
    return gone(cases.from_table(COLUMN), tmp_path_factory.mktemp("column"))


def test_water_swings_on_a_block_as_a_mass_on_a_rod(column):
    _, rows = column
    time, top = (np.array([row[key] for row in rows]) for key in ("time_s", "solid_block_highest_y_m"))
    least = [n for n in range(1, len(top) - 1) if top[n] < top[n - 1] and top[n] <= top[n + 1]]
    measured = np.diff(time[least]).mean()
    assert measured == pytest.approx(period(), rel=0.04)  # 3 % too short: the load lies a layer deep in eleven
    assert len(least) >= 2


def test_what_the_liquid_gives_the_body_gets(column):
    run, _ = column
    liquid, solid = run.ledger, run.solids.ledger
    for name in ("momentum_drift_rel", "mass_drift_rel"):
        assert max(liquid.summary()[name], solid.summary()[name]) < 1e-12
    given = run.bodies.given
    assert liquid.impulses[5] == pytest.approx(-given[:3], abs=1e-12 * np.abs(given).max())
    assert liquid.sums["work_of_contact_J"] == pytest.approx(-solid.sums["work_of_pressure_J"], rel=1e-12)
    assert abs(solid.sums["work_of_pressure_J"]) > 1e-3
    assert solid.summary()["energy_missing_rel"] < 1e-3


def test_resumed_run_is_the_uninterrupted_one_bit_for_bit(tmp_path):
    whole = driver.run(flap("run.checkpoint_windows=2"), "", tmp_path / "whole", None, Reporter(None))
    with pytest.raises(Cut):
        driver.run(flap("run.checkpoint_windows=2"), "", tmp_path / "cut", None, Reporter(whole["windows"] // 2 + 1))
    driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    assert whole["solid_kinetic_energy_J"] > 0.0


def test_a_liquid_that_stands_in_a_body_is_left_out(tmp_path):
    drowned = flap("pools.water.upper_m=[0.3,0.25]")
    run = Together(drowned, tmp_path / "ledger.csv")
    x, y = run.state.x[run.stepper.active], run.state.y[run.stepper.active]
    assert not ((x > 0.1) & (x < 0.15) & (y < 0.3)).any() and ((x > 0.15) & (y < 0.25)).any()


def test_pictures_have_both(tmp_path):
    driver.run(flap("run.end_time_s=1e-3", "run.output_interval_s=1e-3"), "", tmp_path / "run", None, Reporter(None))
    _, cloud, _ = timeline.state_at(timeline.read(tmp_path / "run"), None)
    assert set(np.unique(cloud["kind"])) == {2, 5}
    assert cli.main(["view", str(tmp_path / "run"), "--png", str(tmp_path / "a.png"), "--field", "pressure"]) == 0


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"effects": [*COLUMN["effects"], "frame"]}, "do not move with it"),
        ({"liquid": COLUMN["liquid"] | {"pressure_gradient": "corrected"}}, "plain"),
        ({"liquid": COLUMN["liquid"] | {"periodic": [1, 0]}}, "periodic"),
        ({"gas_phase": {"density_kg_m3": 1.0}}, "one phase"),
    ],
)
def test_what_knows_no_bodies_is_refused(change, told):
    with pytest.raises(CaseError, match=told):
        cases.from_table(COLUMN | change)


INNER, OUTER, HOLE, CENTRE = 4.5e-4, 5e-4, 1.5e-4, [1e-3, 1e-3]  # m, of a shell around gel around a bubble
AROUND, EXCESS, EXPONENT = 101325.0, 8000.0, 1.02  # Pa, Pa, -
DROPLET = {
    "dimensions": 2, "effects": ["density_diffusion", "liquid_damping", "bubble"],
    "run": {"end_time_s": 1.2e-4, "output_interval_s": 6e-5},
    "domain": {"size_m": [2e-3, 2e-3], "gravity_m_s2": [0.0, 0.0]},
    "resolution": {"spacing_mm": 0.05 / 3.0, "smoothing_ratio": 1.3},
    "liquid": {"density_kg_m3": 1500.0, "sound_speed_m_s": 100.0, "history_interval_s": 6e-7},
    "pools": {"gel": {"shape": "ring", "centre_m": CENTRE, "radius_m": INNER, "inner_radius_m": HOLE}},
    "bubble": {
        "centre_m": CENTRE, "content": "gas", "exponent": EXPONENT, "around_Pa": AROUND, "excess_Pa": EXCESS,
    },
    "solid": {"density_kg_m3": 1500.0, "youngs_modulus_Pa": 20e6, "poisson_ratio": 0.45},
    "bodies": {"shell": {"shape": "ring", "centre_m": CENTRE, "radius_m": OUTER, "inner_radius_m": INNER}},
}  # fmt: skip


def test_a_bubble_in_gel_in_a_shell_rests_where_the_shell_bears_it(tmp_path):
    """Two swings about the pressure at which the gas has given way as far as Lame's ring has (3 layers)."""
    own = INNER, OUTER, 20e6, 0.45
    inner, outer = (lame_ring(r, 1.0, *own)[1] for r in (INNER, OUTER))  # displacement [m] by each Pa
    first = math.pi * HOLE**2

    def off(p):
        return (AROUND + EXCESS) * (first / (first + 2.0 * math.pi * INNER * inner * p)) ** EXPONENT - AROUND - p

    rest = brentq(off, 0.0, EXCESS)
    run, rows = gone(cases.from_table(DROPLET), tmp_path)
    pressure = np.array([row["bubble_pressure_Pa"] for row in rows])
    lifted = np.array([row["solid_shell_highest_x_m"] for row in rows]) - rows[0]["solid_shell_highest_x_m"]
    most = [n for n in range(1, len(rows) - 1) if pressure[n] > max(pressure[n - 1], pressure[n + 1], 1.5 * rest)]
    whole = slice(0, most[-1])  # from the start, which is a maximum, to the last one
    assert len(most) >= 1
    assert pressure[whole].mean() == pytest.approx(rest, rel=0.03)
    assert lifted[whole].mean() == pytest.approx(outer * rest, rel=0.03)
    assert max(run.ledger.summary()[name] for name in ("momentum_drift_rel", "mass_drift_rel")) < 1e-12
    assert run.solids.ledger.summary()["momentum_drift_rel"] < 1e-12


def wedged(folder, away):
    """The droplet with a gel particle `away` spacings before the middle of a link of the lining; it and the link."""
    run = Together(cases.from_table(DROPLET), folder / "ledger.csv")
    own, link = run.stepper, run.bodies.shell.links[3]
    first, second = run.bodies.places()[link]
    inward = np.array([first[1] - second[1], second[0] - first[0], 0.0]) / np.hypot(*(second - first)[:2])
    here = particles.positions(own.state)
    place = 0.5 * (first + second) + away * run.case.resolution.spacing * inward
    wedge = own.active[np.argmin(np.hypot(*(here[own.active] - place)[:, :2].T))]
    number = own.state.ident[wedge]
    own.state.x[wedge], own.state.y[wedge] = place[:2]
    own.forces()
    return run, int(np.flatnonzero(own.state.ident == number)[0]), link


def test_the_lining_keeps_gel_off_between_its_particles(tmp_path):
    """Spring of the liquid from half a spacing on, shared by the particles at both ends; nothing by one that is
    loose."""
    run, wedge, link = wedged(tmp_path, 0.2)
    lightest = run.state.mass[run.stepper.bodies.pairs[:, 0]].min()
    limit = 0.2 * math.sqrt(lightest / (1500.0 * 100.0**2))
    assert run.stepper.bodies.limits(run.state)["polyline"] == pytest.approx(limit, rel=1e-9)
    own, spacing = run.stepper.bodies, run.case.resolution.spacing
    size = 1500.0 * 100.0**2 * 0.3 * spacing
    assert np.hypot(*own.pressed[wedge, :2]) == pytest.approx(size, rel=1e-9)
    np.testing.assert_allclose(own.pressed[own.at[link]], [-0.5 * own.pressed[wedge]] * 2, atol=1e-12 * size)
    assert own.springs == pytest.approx(0.5 * size * 0.3 * spacing, rel=1e-9)
    acceleration = run.stepper.acceleration[wedge].copy()
    run.bodies.stepper.free[link[0]] = 1
    own.keep_off(run.stepper)
    assert own.springs == 0.0 and not own.pressed.any()
    run.bodies.stepper.free[link[0]] = 0
    run.stepper.acceleration[:] = 0.0
    own.keep_off(run.stepper)
    assert run.stepper.acceleration[wedge] == pytest.approx(own.pressed[wedge] / run.state.mass[wedge])
    assert acceleration @ own.pressed[wedge] > 0.0


def test_gel_at_rest_before_the_lining_does_not_touch_its_polyline(tmp_path):
    run, _ = gone(cases.from_table(DROPLET | {"run": DROPLET["run"] | {"end_time_s": 6e-6}}), tmp_path)
    assert len(run.stepper.bodies.pairs) == 0 and "polyline" not in run.stepper.bodies.limits(run.state)


def test_what_the_polyline_gives_the_shell_gets(tmp_path, monkeypatch):
    """Momentum of gel and shell, and energy of both with the springs', from a wedged particle until it is out; losses
    are looked at in every step, as all is over in forty."""
    monkeypatch.setattr(account, "EVERY", 1)
    run, _, _ = wedged(tmp_path, 0.3)
    run.bodies.meet(run.stepper.bodies.force(run.stepper))
    run.start()
    first, springs = run.ledger.last, run.stepper.bodies.springs
    for _ in range(4):
        run.window()
    liquid, solid = run.ledger.summary(), run.solids.ledger.summary()
    assert first["contact_energy_J"] == springs > 0.0
    assert run.stepper.bodies.springs < 0.1 * springs
    assert max(liquid["momentum_drift_rel"], solid["momentum_drift_rel"]) < 1e-12
    assert run.ledger.impulses[5] == pytest.approx(-run.bodies.given[:3], abs=1e-12 * np.abs(run.bodies.given).max())
    assert abs(run.ledger.sums["numerical_work_J"]) < 0.05 * springs


def sinking(**more):
    """A heavy block of 4 x 4 particles that hits the floor through two layers of water."""
    block = {"shape": "box", "lower_m": [0.04, 0.03], "upper_m": [0.08, 0.07], "velocity_m_s": [0.0, -2.0]}
    return cases.from_table(COLUMN | {
        "run": {"end_time_s": 0.06, "output_interval_s": 0.06},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [WIDE, 0.02]}},
        "solid": {"density_kg_m3": 3000.0, "youngs_modulus_Pa": 2e6, "poisson_ratio": 0.3},
        "bodies": {"block": block},
    } | more)  # fmt: skip


def test_walls_of_a_box_tank_hold_bodies_by_default(tmp_path):
    run, rows = gone(sinking(), tmp_path)
    lowest = np.array([row["solid_block_lowest_y_m"] for row in rows])
    assert 0.0 < lowest.min() < 0.5 * SPACING  # pressed into the springs, by less than they are long
    assert not run.warnings()
    own = run.solids.ledger.summary()
    assert own["momentum_drift_rel"] < 1e-12 and own["energy_missing_rel"] < 0.01
    assert run.solids.stepper.impulses[IMPULSES.index("sides"), 1] > 0.0


def test_sides_that_a_case_names_hold_bodies_in_place_of_the_tanks_walls(tmp_path):
    run, _ = gone(sinking(effects=[*COLUMN["effects"], "rigid_sides"], rigid_sides={"sides": ["left"]}), tmp_path)
    assert run.solids.stepper.state.y.min() < -SPACING
    (told,) = [line for line in run.warnings() if "outside" in line]
    assert "8 of 16 solid particles (bodies.block) end outside of the domain, 0 of them broken off" in told


def test_walls_stand_where_the_tank_has_them():
    """Sides of a tank within the domain, less those that are open; a body that is clamped behind one is not pushed by
    it; one that only reaches through is refused."""
    case = flap()
    assert [plane[:1] + plane[3:] for plane in rigid_sides.beside(case).planes] == [
        ("left", 0.0), ("right", 0.3), ("bottom", 0.05),
    ]  # fmt: skip
    stepper = SolidStepper(case.only("solid"), sides=rigid_sides.beside(case))
    held = [len(own) for *_, own in stepper.sides.planes]
    assert held == [(~stepper.held).sum()] * 2 + [0]
    loose = flap("bodies.flap.held_lower_m=[0.0,0.1]", "bodies.flap.held_upper_m=[0.3,0.15]")
    with pytest.raises(CaseError, match=r"bodies.flap reaches through the rigid side 'bottom' at y = 0.05 m"):
        SolidStepper(loose.only("solid"), sides=rigid_sides.beside(loose))


def test_a_tank_whose_walls_hold_no_bodies_is_warned_of(tmp_path):
    round_tank = {"shape": "sphere", "centre_m": [0.06, 0.06], "radius_m": 0.055, "slip": "free_slip"}
    case = sinking(tank=round_tank, pools={"water": {"shape": "tank", "fill": 0.3}}, domain=DOMAIN)
    assert explained.warned(case, tmp_path)[-1].startswith("tank.shape = 'sphere' holds the liquid but no bodies")
    assert not any("no bodies" in line for line in explained.warned(sinking(), tmp_path))
