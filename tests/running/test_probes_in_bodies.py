"""Probes beside a liquid: one that lies in a body goes along with it, others stay in the liquid."""

import csv
import math
from types import SimpleNamespace

import numpy as np
import pytest
from test_bodies_in_liquids import flap, gone
from test_restart import Reporter

from sdph.case.bodies import around
from sdph.methods.solids.sections import Body
from sdph.running import driver
from sdph.schema import CaseError
from sdph.study.explain import tables

PROBES = (
    "probes.tip.at_m=[0.125, 0.295]", "probes.wet.at_m=[0.05, 0.1]",
    'probes.root.at_m=[0.1025, 0.07]', 'probes.root.fields=["equivalent_stress", "displacement"]',
)  # fmt: skip


def own_case(*more):
    return flap("run.end_time_s=0.01", *PROBES, *more)


def test_a_probe_in_a_body_goes_along_with_its_particle_and_others_tell_of_the_liquid(tmp_path):
    run, rows = gone(own_case(), tmp_path)
    solid, last = run.solids.stepper, rows[-1]
    away = np.linalg.norm(solid.reference[:, :2] - [0.125, 0.295], axis=1)
    place = np.array([solid.state.x, solid.state.y])[:, away.argmin()]
    found = [last[f"tip_displacement_{a}_m"] for a in "xy"]
    np.testing.assert_array_equal(found, place - solid.reference[away.argmin(), :2])
    assert last["tip_velocity_x_m_s"] == solid.state.u[away.argmin()] and abs(found[0]) > 0.0
    assert last["root_equivalent_stress_Pa"] > 0.0
    assert last["wet_pressure_Pa"] > 100.0 and "tip_pressure_Pa" not in last and "wet_displacement_x_m" not in last
    assert all(row.keys() == last.keys() for row in rows)


def test_the_history_has_them_and_goes_on(tmp_path):
    case = own_case()
    driver.run(case, "tank_with_flap", tmp_path / "run", None, Reporter())
    driver.resume(tmp_path / "run", ("run.end_time_s=0.012",), Reporter())
    with open(tmp_path / "run" / "history.csv", newline="", encoding="utf-8") as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["time_s"]) == pytest.approx(0.012)
    assert math.isfinite(float(last["tip_displacement_x_m"])) and math.isfinite(float(last["wet_pressure_Pa"]))


def test_explain_says_what_each_follows():
    rows = {row["probe"]: row for row in tables.explain(own_case())["probes"]}
    assert rows["tip"]["follows"] == "the particle of bodies.flap that is nearest to it"
    assert rows["wet"]["follows"] == "the liquid at its place" and rows["wet"]["columns"].startswith("wet_pressure_Pa")


def test_a_probe_outside_the_domain_is_refused_beside_bodies_too():
    with pytest.raises(CaseError, match=r"probes.other.*"):
        own_case("probes.other.at_m=[0.5, 0.1]")
    with pytest.raises(CaseError, match=r"probes.other.at_m"):
        own_case("probes.other.at_m=[0.05, 0.1, 0.0]")


@pytest.mark.parametrize(("place", "field", "there"), [
    ("[0.125, 0.29]", "alpha_p", "damage, density, displacement"),
    ("[0.05, 0.1]", "displacement", "density, level, pressure"),
])  # fmt: skip
def test_a_field_that_is_not_where_a_probe_lies_is_refused(place, field, there):
    with pytest.raises(CaseError, match=f"{field}'; at this place there are: {there}"):
        own_case("probes.other.at_m=" + place, f'probes.other.fields=["{field}"]')


@pytest.mark.parametrize(("body", "inside", "outside"), [
    (Body(shape="box", lower=(0.0, 0.0), upper=(1.0, 2.0)), (0.5, 1.9), (1.1, 1.0)),
    (Body(shape="disc", centre=(0.0, 0.0), radius=1.0), (0.6, 0.6), (0.8, 0.8)),
    (Body(shape="ring", centre=(0.0, 0.0), radius=1.0, inner_radius=0.5), (0.6, 0.6), (0.2, 0.2)),
    (Body(shape="cylinder", centre=(0.0, 0.0, 0.0), radius=1.0, length=4.0), (0.0, 0.9, 1.9), (0.0, 0.9, 2.1)),
])  # fmt: skip
def test_what_lies_in_a_body(body, inside, outside):
    other = Body(shape="box", lower=(9.0, 9.0, 9.0), upper=(10.0, 10.0, 10.0))
    case = SimpleNamespace(bodies={"other": other, "one": body} if len(inside) == 3 else {"one": body})
    assert around(case, inside) == len(case.bodies) - 1 and around(case, outside) is None
