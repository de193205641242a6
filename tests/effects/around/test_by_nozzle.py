"""What each of several nozzles gave, what of it evaporated and what left."""

import csv

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import by_nozzle
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

SECOND = (
    "nozzles.my small={shape='cone', centre_m=[0.15,0.15,0.1], direction=[0.0,0.0,-1.0], radius_m=0.02, "
    "half_angle_deg=20.0, speed_m_s=10.0, rate_kg_s=0.005, temperature_K=300.0, diameter_mm=0.03}"
)
SHORT = (
    "coupling.gas='embedded'", "domain.size_m=[0.3,0.3,0.1]", "nozzles.cone.centre_m=[0.15,0.15,0.1]",
    "run.end_time_s=0.012", "run.output_interval_s=0.006", SECOND,
)  # fmt: skip


def load(*more):
    return cases.load(scenes.find("spray_cone")[1], more)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("two") / "run"
    driver.run(load(*SHORT), "spray_cone", folder, None, Reporter(quiet=True))
    return compare.open_run(folder)


def test_parts_of_nozzles_are_all(done):
    for key in ("injected", "evaporated", "left"):
        own = [done.summary[f"nozzle_{name}_{key}_kg"] for name in ("cone", "my small")]
        assert sum(own) == pytest.approx(done.summary[f"{key}_kg"], rel=1e-12) and own[0] > 0.0


def test_a_nozzle_gives_its_rate_and_its_drops_evaporate_by_their_size(done):
    """To half a layer of 8 mm; the gas that both share is soon nearly full of vapour."""
    told = {key: done.summary[f"nozzle_{key}_kg"] for key in ("cone_injected", "my small_injected")}
    assert told["cone_injected"] == pytest.approx(0.01 * 0.012, abs=0.01 * 0.5 * 0.008 / 20.0)
    assert told["my small_injected"] == pytest.approx(0.005 * 0.012, abs=0.005 * 0.5 * 0.008 / 10.0)
    small, wide = (
        done.summary[f"nozzle_{name}_evaporated_kg"] / told[f"{name}_injected"] for name in ("my small", "cone")
    )
    assert small > wide > 0.0


def test_what_leaves_names_its_nozzle(done):
    with open(done.folder / "outflow.csv", encoding="utf-8") as opened:
        rows = list(csv.DictReader(opened))
    for name in ("cone", "my small"):
        left = sum(float(row["mass_kg"]) for row in rows if row["nozzle"] == name)
        assert left == pytest.approx(done.summary[f"nozzle_{name}_left_kg"], rel=1e-12)
    assert {row["nozzle"] for row in rows} <= {"cone", "my small"} and rows


def test_fields_have_the_number_of_the_nozzle(done):
    cloud = done.fields(0.012).particles
    held = {1: "cone", 2: "my small"}
    assert set(cloud["nozzle"]) == held.keys()
    for number, name in held.items():
        there = cloud["mass"][cloud["nozzle"] == number].sum()
        came, gone, left = (done.summary[f"nozzle_{name}_{key}_kg"] for key in ("injected", "evaporated", "left"))
        assert there == pytest.approx(came - gone - left, rel=0.02)  # those half-way in the mouth count as in the gas


def test_grains_of_one_place_have_no_parts():
    assert by_nozzle.names(load()) == ()
    still = cases.parsed(scenes.find("spray_cone")[1]) | {"effects": ["inflow", "gravity", "drag"]}
    still |= {"nozzles": {name: still["nozzles"]["cone"] for name in ("one", "other")}}
    still = {key: own for key, own in still.items() if key not in ("heat", "evaporation", "vapour")}
    assert by_nozzle.names(cases.from_table(still)) == ("nozzle_one_injected_kg", "nozzle_other_injected_kg")
