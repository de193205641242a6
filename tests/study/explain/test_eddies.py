"""Gas taken as laminar though it is turbulent is told of, where grains do not rule its flow."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.case.judge import scales_of
from sdph.study.explain import eddies, tables

DUCT = ("boundaries.bottom.kind='velocity_inlet'", "boundaries.bottom.velocity_m_s=[0.0,0.0,5.0]")


def told(scene, *overrides) -> list[str]:
    case = cases.load(scenes.HERE / scene / "case.toml", overrides)
    return [text for text in tables.warnings(case) if "taken as laminar" in text]


def test_a_fast_dilute_flow_is_told_of():
    """0.3 m at 5 m/s, 0.882 kg/m3 and 2.3e-5 Pa s."""
    (text,) = told("spray_cone", *DUCT)
    assert "Re = 5.75e+04" in text and "[gas.turbulence]" in text
    assert told("spray_cone") == []  # nothing flows in
    model = "gas.turbulence={model='kEpsilon',mixing_length_m=0.02}"
    assert told("spray_cone", *DUCT, model) == []


def test_what_a_riser_carries_does_not_rule_its_gas():
    """Droplets at alpha_p = 0.001 leave eddies as they are, at 0.04 they do not."""
    rate = cases.load(scenes.HERE / "spray_cone" / "case.toml").nozzles["cone"].rate
    for times, known in ((1.0, True), (3.0, True), (100.0, False)):
        assert bool(told("spray_cone", *DUCT, f"nozzles.cone.rate_kg_s={times * rate}")) == known


@pytest.mark.parametrize("scene", ["bubbling_bed", "cylindrical_bed", "fluidised_column"])
def test_beds_are_not(scene):
    case = cases.load(scenes.HERE / scene / "case.toml")
    assert eddies.reynolds(case) > 0.0 and eddies.warnings(scales_of(case)) == []


@pytest.mark.parametrize(("speed", "mach"), [(0.29, ""), (0.31, "Mach 0.31:"), (2.0, "Mach 2:")])
def test_gas_near_the_speed_of_sound_is_told_of(speed, mach):
    """c of air at 300 K by hand, of c_p = 1014 J/(kg K) and M = 28.96: gamma = 1.395, 346.6 m/s."""
    inlet = (DUCT[0], f"boundaries.bottom.velocity_m_s=[0.0,0.0,{speed * 346.6}]", "gas.temperature_K=300")
    case = cases.load(scenes.HERE / "spray_cone" / "case.toml", inlet)
    found = [text for text in tables.warnings(case) if "gas enters at Mach" in text]
    assert len(found) == bool(mach) and mach in "".join(found)
