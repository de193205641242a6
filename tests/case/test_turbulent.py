"""[gas.turbulence]: what each model takes, and what flows in."""

import tomllib

import pytest
from discs import refusal

from sdph import scenes
from sdph.case import read as cases
from sdph.case import turbulent

RANS = 'gas.turbulence={model="kEpsilon", k_m2_s2=0.01, mixing_length_m=0.002}'


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ('{model="k-epsilon"}', "gas.turbulence.model = 'k-epsilon'; allowed: laminar, kEpsilon, kOmegaSST, WALE"),
        ('{models="WALE"}', "unknown key gas.turbulence.models; did you mean gas.turbulence.model?"),
        ('"WALE"', "it must be a section, [gas.turbulence]"),
        ('{model="WALE", schmidt_number=0}', "gas.turbulence.schmidt_number = 0.0; it must be above 0"),
        ('{model="kEpsilon", k_m2_s2=0.01}', 'model = "kEpsilon" needs mixing_length_m or epsilon_m2_s3; give one'),
        ('{model="kOmegaSST", k_m2_s2=0.01}', 'model = "kOmegaSST" needs mixing_length_m or omega_1_s; give one'),
        ('{model="kEpsilon", epsilon_m2_s3=1, mixing_length_m=1}', "needs mixing_length_m or epsilon_m2_s3; give one"),
        ('{model="kEpsilon", mixing_length_m=0.002}', "gas.turbulence.k_m2_s2 is missing; without a velocity_inlet"),
        ('{model="kOmegaSST", epsilon_m2_s3=1}', 'epsilon_m2_s3 is given, but model = "kOmegaSST" does not take it'),
        ('{model="WALE", mixing_length_m=1}', 'mixing_length_m is given, but model = "WALE" does not take it'),
        ('{model="laminar", k_m2_s2=1}', 'k_m2_s2 is given, but model = "laminar" does not take it'),
        ('{model="kEpsilon", k_m2_s2=1e30, mixing_length_m=1}', "turbulence.k_m2_s2 = 1e+30; what makes sense"),
    ],
)
def test_what_does_not_fit_is_refused(given, told):
    assert told in refusal(f"gas.turbulence={given}")


def disc(*overrides):
    return cases.load(scenes.HERE / "disc_cluster" / "case.toml", overrides)


def test_a_resolved_case_reads_back_as_itself():
    case = disc(RANS)
    assert case.gas.turbulence.prandtl_number == 0.85
    assert cases.from_table(tomllib.loads(cases.dumps(case))) == case
    assert "turbulence" not in cases.dumps(disc())


def test_a_laminar_case_is_not_turbulent():
    assert not disc().gas.turbulent
    assert not disc('gas.turbulence.model="laminar"').gas.turbulent
    assert disc(RANS).gas.turbulent


def test_what_flows_in_is_of_its_inlet_or_of_the_fastest():
    inlets = {
        name: {"kind": "velocity_inlet", "side": name, "velocity_m_s": [speed, 0.0]}
        for name, speed in (("left", 2.0), ("right", 0.0))
    }
    given = 'gas.turbulence={model="kOmegaSST", intensity=0.1, mixing_length_m=0.01}'
    table = cases.to_table(disc()) | {"boundaries": inlets | {"walls": {"kind": "wall"}}}
    cases.put(table, given)
    case = cases.from_table(table)
    k = 1.5 * 0.2**2
    expected = {"k": pytest.approx(k), "omega": pytest.approx(k**0.5 / (0.09**0.25 * 0.01))}
    assert turbulent.brought(case, case.boundaries["left"]) == expected
    assert turbulent.brought(case, case.boundaries["right"]) == expected  # at rest: that of the fastest
    assert turbulent.brought(case) == expected
    assert turbulent.brought(disc(RANS))["k"] == 0.01
