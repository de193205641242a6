"""The Mach number of the gas before a run: of inlets, of meshes that contract, not known where pressures drive it."""

import math

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.case.judge import scales_of
from sdph.study.explain import mach, prices, tables

SCENE = "spray_cone"
SOUND = 346.6  # m/s at 300 K by hand, of c_p = 1014 J/(kg K) and M = 28.96
OUTLET = {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 300.0}
INLET = {"kind": "velocity_inlet", "velocity_m_s": [0.0, 0.0, 34.66], "temperature_K": 300.0}


def case_of(equation="operating", grains=True, **boundaries):
    table = cases.parsed(scenes.HERE / SCENE / "case.toml")
    table["gas"] |= {"temperature_K": 300.0, "equation_of_state": equation, "operating_pressure_Pa": 1e5}
    table["gas"] |= {"density_kg_m3": 1.161}
    named = {name: own | {"side": name} for name, own in boundaries.items()}
    table["boundaries"] = named | {"rest": {"kind": "wall"}}
    if not grains:
        table = {key: own for key, own in table.items() if key not in (*table["effects"], "nozzles")}
        table["effects"] = []
    return cases.from_table(table)


def number(case, fastest=0.0):
    rows = tables.numbers(scales_of(case), fastest=fastest)
    return next(row[1] for row in rows if row[0] == "Mach of the gas")


def test_gas_without_grains_has_the_mach_number_of_its_inlet():
    case = case_of(grains=False, back=INLET, front=OUTLET)
    assert number(case) == pytest.approx(0.1, rel=1e-3)
    assert number(case, 0.5 * SOUND) == pytest.approx(0.5, rel=1e-3)
    assert number(case_of(grains=False, front=OUTLET)) == 0.0


def test_what_pressures_drive_is_not_known():
    apart = case_of(grains=False, back=OUTLET | {"pressure_Pa": 900.0}, front=OUTLET)
    assert math.isnan(number(apart)) and mach.head(apart) == 900.0
    assert number(apart, 0.5 * SOUND) == pytest.approx(0.5, rel=1e-3)  # what the mesh tells is known
    for equation, head in (("operating", 0.0), ("ideal", 500.0)):  # one outlet: ideal gas begins at another pressure
        assert mach.head(case_of(equation, grains=False, front=OUTLET | {"pressure_Pa": -500.0})) == head


@pytest.mark.parametrize(
    ("equation", "wrong"), [("operating", "temperature are wrong"), ("ideal", "its temperature is")]
)
def test_a_throat_is_told_of(equation, wrong):
    case = case_of(equation, back=INLET, front=OUTLET)
    priced = prices.by_openfoam(1000)._replace(edges=(0.01, 0.01), fastest=0.4 * SOUND)
    (text,) = [line for line in tables.warnings(case, priced=priced) if "Mach" in line]
    assert "comes to Mach 0.4 (139 m/s) where the mesh is narrow" in text and wrong in text
    slow = priced._replace(fastest=0.29 * SOUND)
    assert not [line for line in tables.warnings(case, priced=slow) if "Mach" in line]
    rows = tables.explain(case, priced)["numbers"]
    assert next(row["value"] for row in rows if row["number"] == "Mach of the gas") == pytest.approx(0.4, rel=1e-3)


def test_pressures_far_apart_are_told_of():
    """sqrt(2 20 kPa/1.161) = 185.6 m/s."""
    apart = case_of(back=OUTLET | {"pressure_Pa": 2e4}, front=OUTLET)
    (text,) = mach.warnings(apart)
    assert "2e+04 Pa apart" in text and "Mach 0.54 by Bernoulli" in text
    assert mach.warnings(case_of(back=OUTLET | {"pressure_Pa": 2e3}, front=OUTLET)) == []
