"""What a case calls for: judgements against hand-made numbers, limits against the stepper's own, warnings where they
belong."""

import pytest
from builders import DISC, simulation

from sdph import effects, scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.cli import main
from sdph.methods.grains.scales import Scales
from sdph.study import explained
from sdph.study.explain import estimate, tables

BED = scenes.HERE / "bubbling_bed" / "case.toml"
SMALL_BED = ("resolution.spacing_mm=20", "resolution.cell_mm=50")


def rows_by(rows, key):
    return {row[key]: row for row in rows}


def test_scales_of_the_bed_are_those_of_the_notes():
    """sdph-notes, section 3, slip 10 m/s: a_p rp/beta = 24 ms, a_g rg/beta = 6.5 us."""
    scales = Scales(cases.load(BED, ("boundaries.jet.velocity_m_s=[0,10]",)))
    assert scales.drag_time == pytest.approx(24e-3, rel=0.05)
    assert scales.gas_drag_time == pytest.approx(6.5e-6, rel=0.05)
    assert scales.loading == pytest.approx(0.6 * 3060.0 / (0.4 * 1.225))


def test_heat_time_of_the_disc():
    """The notes' 2.78 s has the paper's factor alpha_g = 0.4."""
    assert Scales(cases.load(DISC)).heat_time / 0.4 == pytest.approx(2.78, rel=0.01)


def test_a_grain_falls_as_stokes_says():
    """18 mu/(rho d^2) v = g for grains of 20 um, Re = 0.1: within Schiller-Naumann's 4 %."""
    case = cases.load(BED, ("grains.diameter_mm=0.02", "boundaries.jet.velocity_m_s=[0,0]"))
    stokes = (3060.0 - 1.225) * 9.81 * (2e-5) ** 2 / (18.0 * 1.7895e-5)
    assert Scales(case).falling == pytest.approx(stokes, rel=0.05)


def test_nothing_that_moves_is_called_for_by_the_disc():
    assert set(judge.called_for(cases.load(DISC))) == {"heat"}


def test_heat_is_called_for_as_long_as_there_is_time_for_it():
    short = judge.judgements(cases.load(DISC, ("coupling.one_way=true", "run.end_time_s=0.001")))["heat"]
    long = judge.judgements(cases.load(DISC, ("coupling.one_way=true",)))["heat"]
    assert short.number == pytest.approx(0.01 * long.number)
    assert short.error_if_off < 0.01 < long.error_if_off


def test_auto_is_the_effects_called_for():
    table = cases.to_table(cases.load(BED))
    case = cases.from_table(table | {"effects": "auto"})
    assert set(case.effects) == set(judge.called_for(cases.load(BED)))
    assert cases.to_table(case)["effects"] == list(case.effects)  # the resolved case lists them
    assert "conduction" not in case.effects
    hot = table | {"effects": "auto", "grains": table["grains"] | {"conductivity_W_m_K": 5e7}}
    assert "conduction" in cases.from_table(hot).effects


def test_auto_asks_for_more_at_a_smaller_error():
    loose, fine = (set(cases.load(BED, ("effects='auto'", f"run.accuracy={a}")).effects) for a in (0.3, 1e-5))
    assert loose < fine


def test_a_missing_effect_is_told_with_its_error():
    (line,) = judge.missing(_disc_without_heat())
    assert "heat is off" in line and "error of about 1 " in line


def _disc_without_heat():
    table = cases.to_table(cases.load(DISC))
    del table["heat"]
    return cases.from_table(table | {"effects": ["conduction"]})


def test_cells_far_smaller_than_particles_are_warned_of():
    assert not estimate.warnings(cases.load(DISC))
    (line,) = estimate.warnings(cases.load(DISC, ("resolution.cell_mm=0.9",)))
    assert "cell / h = 0.24" in line and "shrink the windows" in line
    below_grains = estimate.warnings(cases.load(DISC, ("resolution.cell_mm=0.5",)))
    assert any("cell / grain" in line for line in below_grains)


def test_a_case_without_grains_is_warned_of():
    table = cases.to_table(cases.load(DISC))
    assert not tables.warnings(cases.from_table(table))
    (told,) = tables.warnings(cases.from_table({key: own for key, own in table.items() if key != "particles"}))
    assert told.startswith("the case has no grains")


def test_the_mass_of_grains_is_explained_and_summed_up(capsys, tmp_path):
    embedded = cases.load(DISC, ("coupling.gas='embedded'",))
    (row,) = explained.explained(embedded, DISC.parent / "gas")["filled"]
    run = simulation(cases.load(DISC), tmp_path)
    given = {"region": "disc", "given [kg/m]": pytest.approx(57.679641, rel=1e-6)}
    assert row == given | {"mass [kg/m]": run.grains.summary()["filled_disc_kg"]}
    assert row["mass [kg/m]"] == pytest.approx(run.state.mass.sum(), rel=1e-12)


def test_sub_step_limits_are_the_steppers_own(tmp_path):
    """Grains at rest in a box without gas flow: the limit by cause, and what the stepper takes."""
    case = cases.load(DISC, ("resolution.spacing_mm=10", "resolution.cell_mm=25"))
    own = rows_by(estimate.limits(case, judge.scales_of(case)), "cause")
    conduction = effects.REGISTRY["conduction"]
    run = simulation(case, tmp_path)
    assert own["conduction"]["largest [s]"] == conduction.dt_limit(conduction.kernel(case), case, run.state)
    assert own["heat exchange"]["largest [s]"] == pytest.approx(run.clock.limits["heat exchange"], rel=0.2)


def test_expected_counts_are_those_of_the_case(tmp_path):
    case = cases.load(DISC, ("resolution.spacing_mm=10", "resolution.cell_mm=25"))
    own = rows_by(estimate.expected(case, judge.scales_of(case)), "what")
    run = simulation(case, tmp_path)
    assert own["particles"]["value"] == len(run.state.x)
    assert own["gas cells"]["value"] == len(run.gas.mesh.volumes)
    while run.time < case.run.end_time:
        run.window()
    assert own["windows"]["value"] == pytest.approx(run.windows, rel=0.3)


def test_explained_as_text_and_numbers():
    parts = tables.explain(cases.load(BED, SMALL_BED))
    shown = tables.text(parts)
    for name in (name for name, row in effects.REGISTRY.items() if "grains" in row.matter):
        assert name in shown


def test_shipped_scenes_have_all_that_they_call_for():
    for name in ("disc_cluster", "bubbling_bed", "evaporating_jet"):
        case = cases.load(scenes.HERE / name / "case.toml")
        assert tables.text(tables.explain(case))
        assert not tables.warnings(case), name


def scales(scene, *overrides):
    return judge.scales_of(cases.load(scenes.find(scene)[1], overrides))


def test_a_bed_rests_as_long_as_the_gas_cannot_lift_it():
    """Ergun's U_mf of the column is 0.085 m/s (case.toml)."""
    still, blown = scales("fluidised_column"), scales("fluidised_column", "boundaries.distributor.velocity_m_s=[0,0.1]")
    assert still.minimum_fluidisation == pytest.approx(0.085, rel=0.02)
    assert still.resting and still.speed == 0.0
    assert not blown.resting and blown.speed > 0.0
    calm = judge.called_for(still.case)
    assert {"drag", "gravity", "friction", "walls"} <= set(calm) and "granular_viscosity" not in calm
    assert not scales("fluidised_column", "domain.gravity_m_s2=[0,9.81]").resting  # it falls up, to an open side


def test_gas_that_streams_past_grains_at_a_distance_does_not_move_them():
    """The wind over the mouth of Stefan's tube, 18 widths above the liquid."""
    assert scales("stefan_tube").jet == 0.0
    assert set(judge.called_for(scales("stefan_tube").case)) == {"evaporation"}
    near = scales("stefan_tube", "particles.film.lower_m=[0,0.09]", "particles.film.upper_m=[0.005,0.095]")
    assert near.jet == pytest.approx(0.2)


def test_droplets_coast_until_they_share_their_momentum_with_the_gas():
    heavy, light = scales("evaporating_jet"), scales("spray_cone")
    assert heavy.coasting == pytest.approx(heavy.end, rel=2e-3)  # 857 times the mass of the gas among them
    share = light.loading / (1.0 + light.loading)
    assert share * light.end < light.coasting < share * light.end + light.drag_time


def test_grains_are_walled_in_where_they_get_to_a_wall():
    assert "walls" not in judge.called_for(scales("evaporating_jet").case)  # it flies away from its one wall
    assert "walls" in judge.called_for(scales("bubbling_bed").case)
    assert "outflow" not in judge.called_for(scales("evaporating_jet").case)  # 2 m of 6 m
    assert "outflow" in judge.called_for(scales("evaporating_jet", "run.end_time_s=0.7").case)


def test_numbers_of_droplets_by_hand():
    """Table 3 of the paper, sigma = 23.8 mN/m, 10 m/s: We = rho U2 d/sigma, Bo = (rho_l - rho) g d2/sigma, B_T = c (T -
    T_l)/L."""
    rows = rows_by(tables.explain(cases.load(scenes.find("evaporating_jet")[1]))["numbers"], "number")
    assert rows["Weber"]["value"] == pytest.approx(1.225 * 100.0 * 3e-3 / 0.0238, rel=1e-6)
    assert rows["Bond"]["value"] == pytest.approx((700.0 - 1.225) * 9.81 * 9e-6 / 0.0238, rel=1e-6)
    assert rows["Spalding B of heat"]["value"] == pytest.approx(2470.0 * 56.0 / 277000.0, rel=1e-6)
    fraction = 1329.0 / 101325.0 * 142.284 / (1329.0 / 101325.0 * 142.284 + (1.0 - 1329.0 / 101325.0) * 28.96)
    assert rows["Spalding B of mass"]["value"] == pytest.approx(fraction / (1.0 - fraction), rel=1e-3)
    assert "take 'spalding'" in rows["Spalding B of heat"]["meaning"]
    assert rows["Nusselt / Ranz & Marshall's"]["value"] > 1.1  # Gunn's, among droplets of 60 %
    own = cases.load(scenes.find("spray_cone")[1])  # Spalding's law
    sprayed = rows_by(tables.explain(own)["numbers"], "number")
    assert "take" not in sprayed["Spalding B of heat"]["meaning"]
    assert sprayed["Nusselt / Ranz & Marshall's"]["value"] == 1.0
    cold = tables.explain(cases.load(scenes.find("stefan_tube")[1]))["numbers"]  # no heat from the gas
    assert "Nusselt / Ranz & Marshall's" not in rows_by(cold, "number")
    assert "no film" in sprayed["way of droplets / gap to a wall"]["meaning"]
    assert not any(
        name.startswith("Spalding") for name in rows_by(tables.explain(cases.load(BED))["numbers"], "number")
    )


@pytest.mark.parametrize(
    "scene",
    [
        "bubbling_bed",
        "bubbling_bed_3d",
        "disc_cluster",
        "fluidised_column",
        "single_droplet",
        "spray_cone",
        "stefan_tube",
    ],
)
def test_auto_holds_what_the_scenes_were_given_by_hand(scene):
    """All that is called for is on; what is on besides is told to matter less than the accuracy asked for."""
    case = cases.load(scenes.find(scene)[1])
    auto = cases.load(scenes.find(scene)[1], ("effects='auto'",))
    judged = judge.judgements(case)
    assert set(auto.effects) <= set(case.effects)
    assert all(judged[name].error_if_off <= case.run.accuracy for name in set(case.effects) - set(auto.effects))


def test_the_gas_that_is_asked_for_is_rehearsed(capsys):
    """`--gas embedded` refuses what a run on the embedded gas would, and prices it."""
    own = ("explain", "bubbling_bed", "--gas", "embedded")
    assert main([*own, "--set", "boundaries.jet.span_m=[0.123,0.3]"]) == 2
    assert "no edge of a gas cell" in capsys.readouterr().err
    assert main([*own]) == 0 and "embedded gas, warm" in capsys.readouterr().out


def test_the_slowest_inlet_is_told_beside_a_jet():
    """A jet of 10 m/s beside a distributor of 0.08 m/s; U_mf is 0.086 m/s (Ergun, alpha_p = 0.6)."""
    found = rows_by(tables.explain(cases.load(BED))["numbers"], "number")
    assert found["U/U_mf"]["value"] > 50.0
    assert found["U/U_mf of the slowest inlet"]["value"] == pytest.approx(0.08 / 0.086, rel=0.1)


def test_unequal_grains_are_lifted_and_resolved_as_those_of_their_sauter_diameter():
    """Standard deviation 1 of the mean: D32 = 4 d by hand."""
    mean = scales("fluidised_column").grains.diameter
    wide = scales("fluidised_column", f"grains.diameter_std_mm={mean * 1e3}")
    alike = scales("fluidised_column", f"grains.diameter_mm={4e3 * mean}")
    assert wide.minimum_fluidisation == pytest.approx(alike.minimum_fluidisation, rel=1e-12)
    names = ("cell / grain", "spacing / grain")
    told, by_hand = ({r["ratio"]: r["value"] for r in estimate.ratios(s.case)} for s in (wide, alike))
    assert [told[n] for n in names] == pytest.approx([by_hand[n] for n in names], rel=1e-12)


@pytest.mark.parametrize(("more", "told"), [((), False), (("boundaries.jet.temperature_K=288.0",), True)])
def test_heat_of_one_temperature_is_told_of(more, told):
    case = cases.load(BED, more)
    assert (tables.ALIKE in tables.warnings(case)) is told
