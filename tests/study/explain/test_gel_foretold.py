"""What `sdph explain` tells of a gel droplet by the droplet without particles, and what its motion costs."""

import math

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.laws import solids
from sdph.schema import CaseError
from sdph.study.explain import gel, lockstep
from sdph.study.gel_droplet import foretold


def load(*more, scene="gel_droplet"):
    return cases.load(scenes.HERE / scene / "case.toml", more)


def told(*more):
    return {row["quantity"]: row for row in gel.rows(load(*more))}


def test_tear_pressure_and_boiling_are_told():
    """0.749 s, 150.9 kPa and 1.362 are those of validation/gel_droplet; dodecane boils at 489.5 K at 1 bar."""
    own = told()
    assert own["tear"]["value"] == pytest.approx(0.74894, rel=1e-4)
    assert own["largest pressure"]["value"] == pytest.approx(150_891.0, rel=1e-4)
    assert own["D/D0"]["value"] == pytest.approx(1.3621, rel=1e-4) and own["D/D0"]["how"] == "at the tear"
    assert own["boiling temperature"]["value"] == pytest.approx(489.5, abs=0.1)
    assert "layers = 4" in own["reduced model"]["how"]
    assert gel.rows(load(scene="thick_ring")) == gel.rows(load(scene="dam_break")) == []


def test_a_run_that_ends_before_the_tear_is_told_so():
    own = told("run.end_time_s=0.3")
    assert "it does not tear within run.end_time_s = 0.3; it would at 0.7489 s" in own["tear"]["how"]
    assert own["D/D0"]["value"] == pytest.approx(1.0056, abs=1e-4)
    never = told("liquid_heat.flux_W_m2=30")
    assert math.isnan(never["tear"]["value"]) and "nor within 5 s" in never["tear"]["how"]
    assert "not foretold" in told("solid.temperature_share=0.1")["tear"]["how"]


def test_outputs_that_miss_the_growth_and_gel_that_is_compressed_are_told():
    assert gel.warnings(load()) == []
    (late,) = gel.warnings(load("run.output_interval_s=0.15"))
    assert "one picture of it at most" in late
    assert gel.warnings(load("run.output_interval_s=0.15", "run.end_time_s=0.3")) == []  # it sees none of it
    (soft,) = gel.warnings(load("liquid.sound_speed_m_s=45"))
    assert "p/(rho c2) = 0.05" in soft and "raise liquid.sound_speed_m_s from 45 to 100" in soft


def test_the_fuel_is_named_with_where_it_is_from():
    assert "n-dodecane" in told()["boiling temperature"]["how"]
    line = gel.fuel(load("bubble.molar_mass_kg_kmol=46.07").parameters["bubble"])
    assert line == (
        "a fuel, 46.07 kg/kmol, with the case's own molar_mass_kg_kmol, and n-dodecane's critical_temperature_K, "
        "critical_pressure_Pa, acentric_factor, antoine, latent_heat_J_kg, saturated_heat_capacity_J_kg_K, heat_ratio "
        "([bubble])"
    )


ETHANOL = (
    "bubble.molar_mass_kg_kmol=46.07", "bubble.critical_temperature_K=513.9", "bubble.critical_pressure_Pa=6.15e6",
    "bubble.acentric_factor=0.645", "bubble.antoine=[10.33675, 1648.22, -42.232]", "bubble.latent_heat_J_kg=8.5e5",
)  # fmt: skip


def test_a_whole_fuel_is_the_cases_own_but_for_what_may_be_alike():
    bubble = load(*ETHANOL).parameters["bubble"]
    assert gel.fuel(bubble).endswith("and n-dodecane's saturated_heat_capacity_J_kg_K, heat_ratio ([bubble])")
    whole = (*ETHANOL, "bubble.saturated_heat_capacity_J_kg_K=2800", "bubble.heat_ratio=1.13")
    assert "n-dodecane" not in gel.fuel(load(*whole).parameters["bubble"])


def test_two_fuels_in_one_are_warned_of():
    (line,) = [one for one in gel.warnings(load(*ETHANOL[:1], "solid.temperature_share=0.1"))]
    assert line.startswith("[bubble] gives molar_mass_kg_kmol of a fuel, and critical_temperature_K, ")
    (line,) = [one for one in gel.warnings(load(ETHANOL[5])) if "two fuels" in one]
    assert line.startswith("[bubble] gives latent_heat_J_kg of a fuel, and molar_mass_kg_kmol, ")
    assert not any("two fuels" in one for one in gel.warnings(load(*ETHANOL, "solid.temperature_share=0.1")))
    assert gel.warnings(load("bubble.heat_ratio=1.1", "solid.temperature_share=0.1")) == []


def test_the_vapour_of_a_spray_of_gel_is_one_fuel_too():
    assert gel.warnings(load(scene="gel_spray")) == []
    (line,) = gel.warnings(load("vapour.molar_mass_kg_kmol=46.07", scene="gel_spray"))
    assert line.startswith("vapour.molar_mass_kg_kmol = 46.07, and critical_temperature_K, critical_pressure_Pa, acen")
    given = [f"micro_explosion.{text.partition('.')[2]}" for text in ETHANOL[1:4]]
    assert gel.warnings(load("vapour.molar_mass_kg_kmol=46.07", *given, scene="gel_spray")) == []


def test_a_short_run_goes_at_the_largest_pace_while_the_shell_starts_to_move():
    """User's droplet: 0.01 s took 380 steps, of 1000 times as much time each; without the start it were 1300."""
    case = load("run.end_time_s=0.005", "liquid_heat.heated=inside", "liquid_heat.flux_W_m2=1e6")
    assert lockstep.motion(case) == pytest.approx(0.005 / 1000.0, rel=0.01)
    cold = load("liquid_heat.flux_W_m2=30", "run.end_time_s=0.6")
    assert lockstep.motion(cold) == pytest.approx(0.6 / 1000.0, rel=0.01)


def test_a_ring_breathes_at_the_speed_of_sound_around_it():
    """2 pi R/c, c^2 = E/(rho (1 - nu^2)); with as much inside as it weighs, sqrt(2) slower."""
    alone = solids.ring_period(0.05, 0.005, 70e9, 0.33, 2700.0)
    assert alone == pytest.approx(2.0 * math.pi * 0.05 / math.sqrt(70e9 / (2700.0 * (1.0 - 0.33**2))))
    loaded = solids.ring_period(0.05, 0.005, 70e9, 0.33, 2700.0, 2700.0 * 0.005)
    assert loaded == pytest.approx(math.sqrt(2.0) * alone)


def test_a_case_without_bubbles_is_told_so():
    table = cases.to_table(load(scene="gel_droplet_three"))
    table["bubble"] |= {"centres_m": [], "radii_m": []}
    with pytest.raises(CaseError, match="no bubbles: give bubble.centre_m"):
        cases.from_table(table)


def test_growth_is_told_from_a_tenth_of_it_on():
    own = foretold.growth(load(), foretold.of(load()))
    assert own.lasts == pytest.approx(0.1396, rel=1e-3)
