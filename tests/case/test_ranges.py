"""Moduli, strengths and pressures of solids in another unit are told of, by themselves or beside each other."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.case import usual


def told(scene, *overrides):
    return usual.warnings(cases.load(scenes.find(scene)[1], overrides))


@pytest.mark.parametrize("given", ["70", "7e4", "1.17e5", "2.1e5"])
def test_a_modulus_of_a_metal_in_gpa_or_mpa_is_told(given):
    (line,) = told("taylor_bar", f"solid.youngs_modulus_Pa={given}")
    assert line.startswith("solid.youngs_modulus_Pa = ") and "if MPa was meant, give" in line


def test_a_jelly_may_be_as_soft_as_metal_is_not():
    weak = "solid.youngs_modulus_Pa=7e4", "solid.yield_stress_Pa=1e3", "solid.hardening_Pa=0.0"
    assert told("taylor_bar", *weak, "solid.density_kg_m3=1999") == []
    assert len(told("taylor_bar", *weak, "solid.density_kg_m3=2001")) == 1


@pytest.mark.parametrize(
    ("scene", "override", "meant"),
    [
        ("taylor_bar", "solid.yield_stress_Pa=400", "if MPa was meant, give solid.yield_stress_Pa = 4e+08"),
        ("taylor_bar", "solid.hardening_Pa=100", "if MPa was meant, give solid.hardening_Pa = 1e+08"),
        ("gel_droplet", "solid.youngs_modulus_Pa=20", "if MPa was meant, give solid.youngs_modulus_Pa = 2e+07"),
        ("gel_spray", "micro_explosion.yield_stress_Pa=0.49", "give micro_explosion.yield_stress_Pa = 490000"),
        ("gel_spray", "micro_explosion.hardening_Pa=0.807", "give micro_explosion.hardening_Pa = 807000"),
    ],
)
def test_strengths_are_judged_by_the_modulus(scene, override, meant):
    lines = told(scene, override)
    key = override.partition("=")[0]
    assert lines and all(key in line and " of " in line for line in lines) and meant in lines[0]


@pytest.mark.parametrize(("given", "meant"), [("1.0", "100000"), ("10", "1e+06")])
def test_a_surrounding_pressure_in_bar_is_told(given, meant):
    (line,) = told("gel_droplet", f"bubble.around_Pa={given}")
    assert line.startswith("bubble.around_Pa = ") and f"if bar was meant, give {meant}" in line
    assert told("gel_droplet", "bubble.around_Pa=1e4") == []


def test_the_bulk_modulus_that_drives_a_ring_is_judged():
    driven = 'inflation.by="growth"', "inflation.pressure_Pa=0", "inflation.growth_1_s=1000"
    (line,) = told("thick_ring", *driven, "inflation.bulk_modulus_Pa=2200")
    assert "if MPa was meant, give 2.2e+09" in line
    assert told("thick_ring", *driven, "inflation.bulk_modulus_Pa=1e7") == []


def test_a_body_that_is_none_is_not_judged():
    """`kernel` of the effect refuses it."""
    assert told("thick_ring", "inflation.body=other", "inflation.pressure_Pa=1e9") == []


def test_a_pressure_that_no_ring_bears_is_told():
    """By hand: 2e7/(1 - 0.45^2) 5e-5/(2 e 4.75e-4) Pa = 4.856e5 Pa."""
    (line,) = told("thick_ring", "inflation.pressure_Pa=4.86e5")
    assert line.startswith("inflation.pressure_Pa = 486000 is more than the ring bears at any size, about 4.86e+05 Pa")
    assert told("thick_ring", "inflation.pressure_Pa=4.85e5") == []
    (line,) = told("thick_ring", "solid.youngs_modulus_Pa=2e5")
    assert "about 4.86e+03 Pa" in line
