"""Slips of a unit are warned of with the value that was likely meant, and no scene is."""

import pytest
import tomli_w

from sdph import scenes
from sdph.case import read as cases
from sdph.case import usual
from sdph.cli import main
from sdph.methods.grains import start


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


@pytest.mark.parametrize("scene", scenes.names())
def test_no_scene_is_warned_of(scene):
    assert usual.warnings(load(scene)) == []


@pytest.mark.parametrize(
    ("scene", "override", "told"),
    [
        ("bubbling_bed", "gas.temperature_K=20", "if degrees Celsius was meant, give 293.15"),
        ("bubbling_bed", "particles.bed.temperature_K=77", "if degrees Celsius was meant, give 350.15"),
        ("bubbling_bed", "particles.bed.temperature_K=127", "if degrees Celsius was meant, give 400.15"),
        ("bubbling_bed", "boundaries.jet.temperature_K=199", "if degrees Celsius was meant, give 472.15"),
        ("bubbling_bed", "grains.diameter_mm=6e-4", "if m was meant, give 0.6"),
        ("spray_cone", "nozzles.cone.diameter_mm=6e-4", "if m was meant, give 0.6"),
        ("bubbling_bed", "boundaries.jet.temperature_K=20", "boundaries.jet.temperature_K = 20 is far from usual"),
        ("bubbling_bed", "domain.gravity_m_s2=[0,-9810]", "if mm/s2 was meant, give [0, -9.81]"),
        ("bubbling_bed", "gas.viscosity_Pa_s=1e3", "look at its unit, unless that is meant"),
        ("bubbling_bed", "gas.viscosity_Pa_s=0.018", "if mPa s was meant, give 1.8e-05"),
        ("bubbling_bed", "gas.viscosity_Pa_s=18", "if uPa s was meant, give 1.8e-05"),
        ("bubbling_bed", "grains.diameter_mm=3e-4", "if m was meant, give 0.3"),
        ("bubbling_bed", "grains.diameter_mm=300", "if um was meant, give 0.3"),
        ("bubbling_bed", "grains.density_kg_m3=2.5", "if g/cm3 was meant, give 2500"),
        ("bubbling_bed", "grains.heat_capacity_J_kg_K=0.8", "if kJ/(kg K) was meant, give 800"),
        ("bubbling_bed", "boundaries.jet.velocity_m_s=[0,7500]", "if mm/s was meant, give [0, 7.5]"),
        ("spray_cone", "vapour.molar_mass_kg_kmol=0.142", "if kg/mol was meant, give 142"),
        ("spray_cone", "gas.operating_pressure_Pa=101.3", "if kPa was meant, give 101300"),
        ("spray_cone", "gas.operating_pressure_Pa=1", "if bar was meant, give 100000"),
        ("spray_cone", "evaporation.latent_heat_J_kg=2257", "if kJ/kg was meant, give 2.257e+06"),
        ("spray_cone", "grains.surface_tension_N_m=72", "if mN/m was meant, give 0.072"),
        ("spray_cone", "vapour.diffusivity_m2_s=0.25", "if cm2/s was meant, give 2.5e-05"),
        ("bubbling_bed", "boundaries.outlet.pressure_Pa=1.0e5", "if it is absolute, give -1325"),
        ("taylor_bar", "solid.youngs_modulus_Pa=5", "if GPa was meant, give 5e+09"),
        ("taylor_bar", "solid.density_kg_m3=2.7", "if g/cm3 was meant, give 2700"),
        ("tank_with_flap", "solid.density_kg_m3=1.1", "if g/cm3 was meant, give 1100"),
        ("dam_break", "liquid.density_kg_m3=1.0", "if g/cm3 was meant, give 1000"),
        ("dam_break", "liquid.viscosity_Pa_s=1e-6", "if m2/s was meant, give 0.001"),
        ("dam_break_gas", "gas_phase.density_kg_m3=0.0012", "if g/cm3 was meant, give 1.2"),
        ("dam_break_gas", "gas_phase.viscosity_Pa_s=2e4", "if mPa s was meant, give 20"),
        ("oscillating_droplet", "surface_tension.coefficient_N_m=72", "if mN/m was meant, give 0.072"),
        ("swirl_sheet", "free_energy_tension.coefficient_N_m=24", "if mN/m was meant, give 0.024"),
    ],
)
def test_a_slip_is_told_with_what_was_likely_meant(scene, override, told):
    (line,) = usual.warnings(load(scene, override))
    assert line.startswith(override.partition("=")[0]) and told in line and "\n" not in line


def test_a_density_that_the_equation_of_state_does_not_give_is_told():
    """Nitrogen at 60 bar and the density of 1 bar."""
    given = ("gas.equation_of_state='operating'", "gas.operating_pressure_Pa=60e5", "gas.temperature_K=300.0")
    (line,) = usual.warnings(load("bubbling_bed", *given))
    assert line.startswith("gas.density_kg_m3 = 1.225, but the gas of the run has 69.66 kg/m3")
    assert usual.warnings(load("bubbling_bed", *given, "gas.density_kg_m3=69.7")) == []


@pytest.mark.parametrize(("given", "lines"), [("1e-6", 0), ("9e-7", 1), ("3000", 0), ("3001", 1)])
def test_bounds_that_a_line_tells_are_usual_themselves(given, lines):
    assert len(usual.warnings(load("bubbling_bed", f"boundaries.jet.velocity_m_s=[0,{given}]"))) == lines


def test_liquids_without_units_are_not_judged():
    """Benchmarks: a density of 1, or a gravity that makes the Froude number round."""
    for scene, override in (("taylor_green", "liquid.viscosity_Pa_s=1e-7"), ("bubble_rise", "liquid.density_kg_m3=10")):
        assert usual.warnings(load(scene, override)) == []


ROSIN_RAMMLER = (
    "nozzles.cone.sizes='rosin_rammler'", "nozzles.cone.size_exponent=2.0", "nozzles.cone.least_diameter_mm=0.05",
)  # fmt: skip


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (("size_parameter_mm=500", "most_diameter_mm=1.5"), "most_diameter_mm = 1.5 cuts 100 % of the mass away"),
        (("size_parameter_mm=0.05", "most_diameter_mm=1.5"), "least_diameter_mm = 0.05 cuts 63.2 % of the mass away"),
        (("size_parameter_mm=0.5", "most_diameter_mm=0.416"), "most_diameter_mm = 0.416 cuts 50 % of the mass"),
        (("size_parameter_mm=0.5", "most_diameter_mm=0.417"), ""),
        (("size_parameter_mm=0.5",), ""),
    ],
)
def test_sizes_that_are_all_but_cut_off_are_told(given, told):
    """By hand: exp(-(d/X)^2) is above the largest, half of the mass at d = X sqrt(ln 2) = 0.4163 mm."""
    table = cases.parsed(scenes.find("spray_cone")[1])
    for key in ("diameter_mm", "diameter_std_mm"):
        table["nozzles"]["cone"].pop(key, None)
    for line in (*ROSIN_RAMMLER, *(f"nozzles.cone.{one}" for one in given)):
        key, _, value = line.partition("=")
        table["nozzles"]["cone"][key.rpartition(".")[2]] = value.strip("'") if "'" in value else float(value)
    found = usual.warnings(cases.from_table(table))
    assert len(found) == bool(told) and all(f"nozzles.cone.{told}" in line for line in found)


def test_what_is_cold_by_nature_is_not_warned_of():
    """Air at 127 K as dense as it is there, by hand 101325 28.96/(8314.46 127) = 2.779 kg/m3; drops of nitrogen."""
    cold = "gas.temperature_K=127", "particles.bed.temperature_K=127", "boundaries.jet.temperature_K=127"
    assert len(usual.warnings(load("bubbling_bed", *cold))) == 3
    assert usual.warnings(load("bubbling_bed", *cold, "gas.density_kg_m3=2.78")) == []
    assert len(usual.warnings(load("bubbling_bed", *cold[1:], "gas.density_kg_m3=2.78"))) == 2  # the gas is not cold
    drops = "nozzles.cone.temperature_K=77", "evaporation.boiling_temperature_K=77.4"
    lines = usual.warnings(load("spray_cone", *drops))
    told = [line for line in lines if "_temperature_K" in line or ".temperature_K" in line]
    assert len(told) == 2
    named = usual.warnings(load("spray_cone", *drops, 'grains.fluid="nitrogen"', "grains.fluid_temperature_K=77"))
    assert not any("far from usual" in line for line in named)


def test_a_nozzle_that_opens_when_all_is_over_is_told():
    """The cone's run ends at 0.05 s."""
    (told,) = usual.warnings(load("spray_cone", "nozzles.cone.start_s=0.05"))
    assert told == "nozzles.cone opens at start_s = 0.05; the run ends at 0.05 s: it gives nothing"
    assert usual.warnings(load("spray_cone", "nozzles.cone.start_s=0.049")) == []


@pytest.mark.parametrize(("scene", "told"), [("dam_break", True), ("taylor_bar", False), ("tank_with_flap", True)])
def test_numbers_of_particles_that_nothing_follows_are_told(scene, told):
    table = cases.parsed(scenes.find(scene)[1]) | {"track": {"particles": [3]}}
    found = usual.warnings(cases.from_table(table))
    assert len(found) == told and all(line.startswith("track.particles = [3] follows nothing") for line in found)


def test_drops_that_do_not_fit_through_their_mouth_are_told():
    (line,) = usual.warnings(load("spray_cone", "nozzles.cone.diameter_mm=90"))
    assert line.startswith("nozzles.cone lets grains of") and "look at the units of its sizes" in line


def test_materials_are_looked_at_one_by_one():
    (line,) = usual.warnings(load("segregation", "grains.large.density_kg_m3=2.5"))
    assert line.startswith("grains.large.density_kg_m3 = 2.5 ")


def test_explain_and_run_tell_of_grains_that_no_number_is_of(tmp_path, capsys):
    table = cases.parsed(scenes.find("disc_cluster")[1])
    table["run"] = {"end_time_s": 1e-4, "output_interval_s": 1e-4}
    table["track"] = {"particles": [1, 99999]}
    (tmp_path / "case.toml").write_text(tomli_w.dumps(table))
    assert main(["explain", str(tmp_path), "--gas", "embedded"]) == 0
    out = capsys.readouterr().out
    assert "track.particles holds 99999; the case has " in out
    assert main(["run", str(tmp_path), "--gas", "embedded", "--out", str(tmp_path / "out")]) == 0
    assert "track.particles holds 99999; the case has " in capsys.readouterr().err


def test_the_last_grain_and_grains_to_come_are_taken():
    case = load("bubbling_bed", "track.particles=[7]")
    assert start.never_there(case, 7) == [] and len(start.never_there(case, 6)) == 1
    assert start.never_there(load("spray_cone", "track.particles=[7]"), 0) == []


def test_explain_and_run_warn_of_it(tmp_path, capsys):
    """What is possible runs: the warning is all."""
    table = cases.parsed(scenes.find("disc_cluster")[1])
    table["gas"]["temperature_K"], table["run"] = 20.0, {"end_time_s": 1e-4, "output_interval_s": 1e-4}
    (tmp_path / "case.toml").write_text(tomli_w.dumps(table))
    assert main(["explain", str(tmp_path), "--gas", "embedded"]) == 0
    assert "gas.temperature_K = 20 is far from usual, 200 to 5000" in capsys.readouterr().out
    assert main(["run", str(tmp_path), "--gas", "embedded", "--out", str(tmp_path / "out")]) == 0
    assert "warning: gas.temperature_K = 20 is far from usual" in capsys.readouterr().err
