"""What a case with a liquid calls for: its numbers by hand, its effects, and what is told when something is missing."""

import math

import pytest

from sdph import effects, scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.effects.around import drain, tank
from sdph.engine.state import GAS, LIQUID
from sdph.methods.liquids.method import LiquidStepper
from sdph.running.together import Together
from sdph.schema import CaseError
from sdph.study.explain import liquids, lockstep, stages, tables

LIQUIDS = [name for name in scenes.names() if cases.load(scenes.HERE / name / "case.toml").liquid]


def load(scene, *more):
    return cases.load(scenes.HERE / scene / "case.toml", more)


def numbers(case):
    return {row["number"].split(",")[0]: row["value"] for row in tables.explain(case)["numbers"]}


def test_numbers_of_the_channel():
    """g = 8 nu U/H2 for U = 1 m/s, H = 1 m, nu = 0.1 m2/s."""
    own = numbers(load("poiseuille"))
    assert own["Reynolds"] == pytest.approx(10.0)
    assert own["Mach"] == pytest.approx(0.1)


def test_numbers_of_the_dam():
    """U = sqrt(2 g H), H = 0.1143 m; L = 57.15 mm."""
    own, speed = numbers(load("dam_break")), math.sqrt(2.0 * 9.81 * 0.1143)
    assert own["Froude"] == pytest.approx(speed / math.sqrt(9.81 * 0.05715), rel=0.01)
    assert own["Weber"] == pytest.approx(1000.0 * speed**2 * 0.05715 / 0.0728, rel=0.01)
    assert own["Bond"] == pytest.approx(1000.0 * 9.81 * 0.05715**2 / 0.0728, rel=0.01)
    assert own["Mach"] == pytest.approx(speed / 21.2, rel=0.01)


def test_both_phases_are_counted():
    """As the summary of a run has them; of oil on water one had been told half of the particles."""
    own = load("water_under_air")
    told = {row["what"]: row["value"] for row in tables.explain(own)["expected"]}
    kinds = judge.scales_of(own).state.kind
    assert told["liquid particles"] == (kinds == LIQUID).sum() + (kinds == GAS).sum() > (kinds == LIQUID).sum()


def test_what_nozzles_bring_is_counted_where_it_leaves_again():
    """Without a pool: what fits into the way through the domain, and no more."""
    own = load("free_overfall")
    table = cases.to_table(own)
    del table["pools"]
    alone = cases.from_table(table)
    told = {row["what"]: row["value"] for row in tables.explain(alone)["expected"]}
    (nozzle,) = alone.nozzles.values()
    most = nozzle.width * max(alone.domain.size) / alone.resolution.spacing**2
    assert 0.2 * most < told["liquid particles"] <= 1.01 * most


@pytest.mark.parametrize("scene", LIQUIDS)
def test_shipped_scenes_have_all_that_they_call_for(scene):
    case = load(scene)
    assert tables.text(tables.explain(case))
    assert not tables.warnings(case)


def test_every_effect_on_liquids_judges_itself():
    assert [name for name, row in effects.REGISTRY.items() if "liquid" in row.matter and not row.call] == []


@pytest.mark.parametrize(
    ("scene", "off"),
    [
        ("dam_break", "gravity"),
        ("dam_break", "tank"),
        ("taylor_green", "laminar_viscosity"),
        ("taylor_green", "shifting"),
        ("bubble_rise", "shifting"),
        ("poiseuille", "tank"),
    ],
)
def test_a_missing_effect_is_told(scene, off):
    table = cases.to_table(load(scene))
    table["effects"].remove(off)
    table.pop(off, None)
    assert any(line.startswith(f"effect {off} is off") for line in judge.missing(cases.from_table(table)))


def test_advice_on_diffusion_is_one_where_density_is_summed():
    """With the effect the case is refused; without it nobody asks for it."""
    summed = 'gas_phase.density_by="summation"'
    with pytest.raises(CaseError, match="density_diffusion"):
        load("oscillating_droplet", summed)
    without = 'effects=["laminar_viscosity", "liquid_damping", "shifting", "surface_tension"]'
    told = [tables.warnings(load("oscillating_droplet", *given, without)) for given in ((), (summed,))]
    assert [any("density_diffusion" in line for line in lines) for lines in told] == [True, False]


def test_what_a_scene_does_not_call_for_is_not_judged_missing():
    judged = judge.called_for(load("hydrostatic_tank"))
    assert not {"laminar_viscosity", "frame", "shifting"} & judged.keys()
    assert "surface_tension" not in judged


def test_slow_sound_is_told():
    assert any(
        "raise liquid.sound_speed_m_s from 5 to" in line
        for line in tables.warnings(load("dam_break", "liquid.sound_speed_m_s=5"))
    )


def expected(case):
    return {row["what"]: row["value"] for row in liquids.explain(judge.scales_of(case))["expected"]}


OUTLINE = [[0.0, 0.1], [0.05, 0.1], [0.05, 0.0], [0.1, 0.0], [0.1, 0.1], [0.28575, 0.1], [0.28575, 0.17], [0.0, 0.17]]


@pytest.mark.parametrize(
    ("more", "height"),
    [
        ((), 0.1143),
        (("pools.column.lower_m=[0,0.05]", "pools.column.upper_m=[0.05715,0.1643]"), 0.1643),
        (("pools.column.lower_m=[0,0.05]", "pools.column.upper_m=[0.05715,0.1643]", "tank.lower_m=[0,0.05]"), 0.1143),
        (
            (
                "tank.shape='outline'", f"tank.corners_m={OUTLINE}", "tank.open_sides=[]",
                "pools.column.lower_m=[0,0.1]", "pools.column.upper_m=[0.05,0.15]",
            ),
            0.15,
        ),
        (
            (
                "domain.gravity_m_s2=[9.81,0.0]", "pools.column.lower_m=[0,0]", "pools.column.upper_m=[0.1,0.05]",
                "run.end_time_s=1.0",
            ),
            0.28575,
        ),
    ],
)  # fmt: skip
def test_liquid_falls_down_to_the_floor_of_its_tank(more, height):
    """By hand: sqrt(2 g H) from its highest to the lowest place of the tank."""
    speed = judge.scales_of(load("dam_break", *more)).speed
    assert speed == pytest.approx(math.sqrt(2.0 * 9.81 * height), rel=0.02)


def test_liquid_falls_by_its_height_along_gravity():
    """One that lies on its side, twice as wide as it is high, in a run too short to fall to a floor."""
    lying = "pools.column.lower_m=[0,0]", "pools.column.upper_m=[0.1,0.05]", "domain.gravity_m_s2=[9.81,0.0]"
    short = load("dam_break", *lying, "run.end_time_s=0.001", "run.output_interval_s=0.001")
    assert judge.scales_of(short).speed == pytest.approx(math.sqrt(2.0 * 9.81 * 0.1), rel=0.02)


def test_liquid_falls_no_longer_than_the_run():
    high = "pools.column.lower_m=[0,0.16]", "pools.column.upper_m=[0.05,0.17]"
    short = load("dam_break", *high, "run.end_time_s=0.1", "run.output_interval_s=0.1")
    assert judge.scales_of(short).speed == pytest.approx(9.81 * 0.1, rel=1e-9)


def test_bodies_take_the_place_of_the_liquid_that_is_counted(tmp_path):
    """As many as a run begins with: the flap stands in the water."""
    case = load("tank_with_flap", "pools.water.upper_m=[0.16,0.25]")
    parts = tables.explain(case)
    told = {row["what"]: row["value"] for row in parts["expected (liquid)"]}
    state = Together(case, tmp_path / "ledger.csv").method.stepper.state
    assert told["particles, walls included"] == len(state.x)
    assert told["liquid particles"] == (state.kind == LIQUID).sum() < expected(case.only("liquid"))["liquid particles"]


def test_limits_are_the_steppers_own():
    case = load("poiseuille", "liquid.viscosity_Pa_s=10.0", "resolution.spacing_mm=50")
    own = {row["cause"]: row["largest [s]"] for row in tables.explain(case)["limits"]}
    stepper = LiquidStepper(case)
    dt = stepper.next_step(1e9)
    assert stepper.limit == "laminar_viscosity" == min(own, key=own.get)
    assert dt == pytest.approx(own["laminar_viscosity"], rel=1e-6)


def test_a_hastened_droplet_is_counted_by_the_time_of_its_motion():
    """The scene took 114 157 steps (validation/gel_droplet); liquid and shell go by the shorter step of the two."""
    case = load("gel_droplet")
    parts = tables.explain(case)
    steps = {
        row["value"]
        for matter in ("liquid", "solid")
        for row in parts[f"expected ({matter})"]
        if row["what"] == "steps"
    }
    assert len(steps) == 1 and steps.pop() == pytest.approx(114_157, rel=0.3)
    unknown = "solid.temperature_share=0.1"  # to the reduced model: the way to 1.4 D_0 at the cap
    case = load("gel_droplet", unknown)
    own = lockstep.motion(load("gel_droplet", unknown, "time_scaling.wall_speed_cap_m_s=0.1"))
    way = math.sqrt(0.45**2 + (1.4**2 - 1.0) * 0.5**2) - 0.45  # mm: the shell keeps its section
    assert own - lockstep.motion(case) == pytest.approx(1e-3 * way * (10.0 - 5.0))
    assert lockstep.motion(load("tank_with_flap")) == load("tank_with_flap").run.end_time


@pytest.mark.parametrize(("scene", "told"), [("oscillating_droplet", True), ("swirl_sheet", False)])
def test_moving_particles_are_told_where_tension_rules(scene, told):
    """Their drops miss every bar of tension; a sheet of We = 1000 hardly feels it."""
    changes = ("method.name=mps",) if told else ()
    assert any("moving particles" in text for text in tables.warnings(load(scene, *changes))) == told


@pytest.mark.parametrize(
    ("more", "told"),
    [((), False), (("tank.slip='no_slip'",), True), (("tank.slip='no_slip'", "liquid.viscosity_Pa_s=100.0"), False)],
)
def test_walls_whose_layer_is_thinner_than_the_spacing_are_told_of(more, told):
    """The shipped tanks slip for that reason."""
    warnings = tables.warnings(load("sloshing_cassini", *more))
    assert any("how soon the liquid turns with its tank" in line for line in warnings) == told


@pytest.mark.parametrize(("end", "told"), [(240.0, False), (0.01, True)])
def test_a_drain_that_tears_its_liquid_out_is_told_of(end, told):
    case = load("sloshing_cassini", f"drain.end_s={end}", "drain.start_s=0.0")
    own, radius = case.parameters["drain"], case.parameters["tank"].outlet_radius
    drained = (drain.filled(case) - own.fill) * tank.shape_of(case).volume
    assert drain.speed(case) * end * math.pi * radius**2 == pytest.approx(drained)
    assert any("torn out rather than drained" in line for line in tables.warnings(case)) == told


def test_a_bubble_has_the_surface_tension_that_its_case_gives():
    """0.025 N/m of the gel droplet, not that of water: twice the Weber number of 0.05 N/m."""

    def weber(sigma):
        own = tables.explain(load("gel_droplet", f"bubble.surface_tension_N_m={sigma}").only("liquid"))["numbers"]
        (row,) = [row for row in own if row["number"].startswith("Weber")]
        return row

    assert weber(0.025)["value"] == pytest.approx(2.0 * weber(0.05)["value"])
    assert weber(0.025)["source"].endswith("bubble.surface_tension_N_m")
    assert weber(0.0)["source"].endswith("for want of one")


def test_a_gel_droplet_is_told_what_acts_as_it_grows_necks_and_has_torn():
    """Largest pressure 150.9 kPa, of a plastic limit of 59.6 kPa; 0.315 of strain at 1.4 D_0, which is a little beyond
    the tear at 1.362 (gel-droplet.md, 5)."""
    case = load("gel_droplet")
    told = {row["judged by"]: row for row in stages.rows(case)}
    limit = told["p/((2/sqrt3) A ln(ro/ri))"]
    assert limit["at the largest pressure"] == pytest.approx(150.9 / 59.6, rel=0.01)
    assert 0.2 < told["plastic strain"]["at the tear"] < 0.315
    assert (told["sigma/(R p)"]["growth"], told["sigma/(R p)"]["after the tear"]) == (
        "on, in the bubble's pressure", "off",
    )  # fmt: skip
    paces = told["S = min(largest, v_cap/(wall's speed))"]
    assert 1000.0 > paces["at the largest pressure"] > 2.0 * paces["at the tear"] > 2.0
    assert told["T*^m"]["growth"] == "off"
    assert "stages" in tables.explain(case) and "stages" not in tables.explain(load("thick_ring"))


@pytest.mark.parametrize("given", ["solid.temperature_share=0.1", "solid.damage_begins_at=0.01"])
def test_stages_say_why_there_are_none(given):
    (row,) = stages.rows(load("gel_droplet", given))
    assert row["effect"] == "none" and row["why"]
