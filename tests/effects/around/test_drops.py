"""Drops of a table that come in through a nozzle: nothing of theirs is lost, and they are played again and again."""

import csv
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_inflow import AIR, SAND
from test_restart import Cut, Reporter, same_run

from sdph.case import read as cases
from sdph.effects.around import drops, inflow
from sdph.laws import grain_sizes
from sdph.running import driver, inputs
from sdph.schema import CaseError

DENSITY = SAND["density_kg_m3"]
TABLE = {
    "shape": "table", "centre_m": [0.5, 0.5, 0.15], "direction": [0.0, 0.0, -1.0], "speed_m_s": 5.0, "radius_m": 0.1,
    "rate_kg_s": 2e-3, "temperature_K": 290.0,
}  # fmt: skip


def drops_of(seed, count=200, lasting=0.02):
    draw = np.random.default_rng(seed)
    diameter = draw.uniform(2e-4, 2e-3, count)
    place = np.column_stack([draw.uniform(-0.1, 0.1, (count, 2)), np.full(count, 0.02)])
    velocity = np.column_stack([20.0 * place[:, :2], draw.uniform(4.0, 6.0, count)])
    mass = math.pi / 6.0 * DENSITY * diameter**3
    return drops.Drops(np.sort(draw.uniform(0.0, lasting, count)), place, velocity, mass, diameter)


def write(path, own):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(drops.COLUMNS)
        writer.writerows(np.column_stack([own.time, own.place, own.velocity, own.mass, own.diameter]).tolist())
    return path


def table_of(path, nozzle=(), **more):
    return {
        "title": "", "scene": "", "dimensions": 3,
        "effects": ["inflow", "outflow", "gravity", "drag", "heat"],
        "run": {"end_time_s": 0.05, "output_interval_s": 0.05, "checkpoint_windows": 5},
        "coupling": {"window_largest_s": 2e-3, "gas": "embedded"},
        "domain": {"size_m": [1.0] * 3, "gravity_m_s2": [0.0, 0.0, -9.81]},
        "resolution": {"spacing_mm": 40.0, "cell_mm": 100.0}, "gas": AIR,
        "grains": SAND | {"granular_temperature_m2_s2": 1e-6, "diameter_std_mm": 0.1},
        "boundaries": {"sides": {"kind": "pressure_outlet", "pressure_Pa": 0.0}},
        "nozzles": {"mouth": TABLE | {"table": str(path)} | dict(nozzle)},
    } | more  # fmt: skip


def case_of(path, nozzle=(), **more):
    return cases.from_table(table_of(path, nozzle, **more))


@pytest.fixture
def file(tmp_path):
    return write(tmp_path / "drops.csv", drops_of(1))


def of_parcels(parcels):
    """Mass, number, surface, momentum and energy of motion that particles stand for."""
    q = 1.0 + parcels.variance / parcels.diameter**2
    number = parcels.mass / (math.pi / 6.0 * DENSITY * parcels.diameter**3 * q**3)
    energy = 0.5 * parcels.mass * (parcels.velocity**2).sum(axis=1) + 1.5 * parcels.mass * parcels.theta
    surface = number * parcels.diameter**2 * q
    return np.array([parcels.mass.sum(), number.sum(), surface.sum(), *(parcels.mass @ parcels.velocity), energy.sum()])


def of_drops(own):
    energy = 0.5 * own.mass * (own.velocity**2).sum(axis=1)
    surface = (own.diameter**2).sum()
    return np.array([own.mass.sum(), len(own.mass), surface, *(own.mass @ own.velocity), energy.sum()])


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 300), st.floats(1e-4, 0.1), st.floats(1e-3, 1.0))
def test_what_becomes_one_particle_keeps_all_that_it_was(seed, count, interval, spacing):
    own = drops_of(seed, count)
    parcels = drops.gathered(own, interval, spacing)
    size = of_drops(drops.Drops(*(abs(part) for part in own)))
    assert (abs(of_parcels(parcels) - of_drops(own)) <= 1e-12 * size).all()
    assert (parcels.variance >= 0.0).all() and (parcels.theta >= 0.0).all() and (np.diff(parcels.time) >= 0.0).all()


def test_one_drop_alone_is_itself():
    own = drops_of(3, 1)
    parcels = drops.gathered(own, 1e-3, 0.01)
    assert parcels.diameter[0] == pytest.approx(own.diameter[0], rel=1e-12) and parcels.theta[0] == 0.0
    assert parcels.variance[0] == pytest.approx(0.0, abs=1e-12 * own.diameter[0] ** 2)
    np.testing.assert_allclose(parcels.place, own.place, rtol=1e-14)


def test_moments_of_sizes():
    """Drops of 1 and 3: mean d^2 = 5, mean d^3 = 14; the log-normal has both."""
    mean, variance = grain_sizes.of_moments(5.0, 14.0)
    q = 1.0 + variance / mean**2
    assert mean**2 * q == pytest.approx(5.0) and mean**3 * q**3 == pytest.approx(14.0)


def test_a_middle_flies_straight_between_its_drops():
    """Two drops at z = 0, one 10 ms after the other at 2 m/s: at 5 ms their middle is at 0, 10 mm apart each."""
    place = np.zeros((2, 3))
    own = drops.Drops(np.array([0.0, 0.01]), place, np.tile([0.0, 0.0, 2.0], (2, 1)), np.ones(2), np.full(2, 1e-3))
    parcels = drops.gathered(own, 1.0, 1.0)
    assert parcels.time == pytest.approx([0.005]) and parcels.place[0] == pytest.approx([0.0, 0.0, 0.0])


def test_played_again_it_is_turned_and_the_rate_holds(file):
    replay = drops.Replay(case := case_of(file), case.nozzles["mouth"])
    one = len(replay.parcels.time)
    first, second = replay.due(0, replay.period), replay.due(one, 2.0 * replay.period)
    assert len(first.time) == len(second.time) == one
    assert first.mass.sum() == pytest.approx(TABLE["rate_kg_s"] * replay.period, rel=1e-12)
    np.testing.assert_allclose(second.time - first.time, replay.period, rtol=1e-9)
    # along the axis the same, around it elsewhere
    np.testing.assert_allclose(second.velocity[:, 2], first.velocity[:, 2], rtol=1e-12)
    radius, again = (np.hypot(*(part.place[:, :2] - 0.5).T) for part in (first, second))
    np.testing.assert_allclose(again, radius, rtol=1e-9)
    assert abs(first.place - second.place).max() > 0.01
    assert first.velocity[:, 2].max() < 0.0 and first.place[:, 2].max() < 0.15  # down, from the mouth on


def test_a_table_of_another_nozzle_is_turned_otherwise(file):
    """With the same seed, in squares and periods; the first nozzle's is as it is alone."""
    case = case_of(file)
    alone, first, second = (drops.Replay(case, case.nozzles["mouth"], *nth) for nth in ((), (0,), (1,)))
    last = [replay.due(len(replay.parcels.time), 2.0 * replay.period).place for replay in (alone, first, second)]
    np.testing.assert_array_equal(last[0], last[1])
    assert np.abs(first._turn(1) - second._turn(1)).max() > 0.01
    one, other = (replay.parcels.place for replay in (first, second))
    assert one.shape != other.shape or np.abs(one - other).max() > 0.01


@settings(max_examples=20, deadline=None, suppress_health_check=["function_scoped_fixture"])
@given(st.lists(st.floats(0.0, 0.1), min_size=1, max_size=6), st.floats(0.0, 0.03))
def test_in_parts_as_at_once(file, times, start):
    case = case_of(file, {"start_s": start, "end_s": 0.09})
    replay = drops.Replay(case, case.nozzles["mouth"])
    given_, mass = 0, 0.0
    for time in sorted(times):
        own = replay.due(given_, time)
        # a drop is where straight flight from its crossing brings it
        assert (own.time <= time).all() and (own.time >= start).all()
        given_, mass = replay.count(time), mass + own.mass.sum()
    whole = replay.due(0, max(times))
    assert given_ == len(whole.time) and mass == pytest.approx(whole.mass.sum(), rel=1e-12, abs=1e-300)
    assert replay.count(1.0) == replay.count(0.09) and replay.count(start - 1e-9) == 0


def test_a_run_of_drops(file, tmp_path):
    summary = driver.run(case_of(file), "", tmp_path / "run", None, Reporter())
    assert summary["injected_kg"] == pytest.approx(TABLE["rate_kg_s"] * 0.05, rel=0.1)
    for name in ("particle_mass_drift_rel", "mass_drift_rel", "energy_drift_rel", "motion_drift_rel"):
        assert abs(summary[name]) < 1e-10, name
    assert summary["left_kg"] > 0.0


def test_it_goes_on_to_the_last_bit(file, tmp_path):
    driver.run(case_of(file), "", tmp_path / "whole", None, Reporter())
    with pytest.raises(Cut):
        driver.run(case_of(file), "", tmp_path / "part", None, Reporter(12))
    driver.resume(tmp_path / "part", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "part")


def test_the_table_moves_with_the_run(file, tmp_path):
    driver.run(
        case_of(file, run={"end_time_s": 0.01, "output_interval_s": 0.01}), "", tmp_path / "run", None, Reporter()
    )
    assert (tmp_path / "run" / "inputs" / "nozzles.mouth.table" / "drops.csv").is_file()
    file.unlink()
    (tmp_path / "run").rename(tmp_path / "moved")
    driver.resume(tmp_path / "moved", ("run.end_time_s=0.012",), Reporter())
    assert cases.load(tmp_path / "moved" / "case.toml").nozzles["mouth"].table.startswith(str(tmp_path / "moved"))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda text: text.replace("mass_kg", "weight"), "no column mass_kg"),
        (lambda text: text.split("\n")[0] + "\n", "no rows"),
        (lambda text: text.replace("0.02,", "nan,", 1), "must be finite"),
    ],
)
def test_tables_that_are_none_are_told(file, change, told):
    file.write_text(change(file.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(CaseError, match=told):
        inputs.check(case_of(file))


def test_a_drop_without_mass_is_told(tmp_path):
    own = drops_of(1)
    own.mass[7] = 0.0
    with pytest.raises(CaseError, match="line 9: mass_kg = 0; it must be above 0"):
        inputs.check(case_of(write(tmp_path / "drops.csv", own)))


@pytest.mark.parametrize(
    ("nozzle", "told"),
    [
        ({"table_from_s": 1.0}, "no drop .* after table_from_s = 1"),
        ({"table": ""}, "table is missing"),
        ({"rate_kg_s": None, "volume_fraction": 0.1}, "at rate_kg_s"),
        ({"shape": "disc"}, "table and record are of shape = 'table'"),
        ({"start_s": 0.01, "end_s": 0.005}, "its end must come after its start"),
        ({"diameter_mm": 0.2}, "diameter_mm is of slot, disc, cone; shape = 'table': leave it out"),
        ({"diameter_std_mm": 0.1}, "diameter_std_mm is of slot, disc, cone"),
        ({"profile": "parabolic"}, "profile is of slot, disc, cone"),
        ({"width_m": 0.1}, "width_m is of slot"),
        ({"record_set": ["run.end_time_s=1.0"]}, "record_set is of a record, and there is none"),
        ({"table_from_s": 0.0, "effects": "granular_viscosity"}, "heavy ones throw light ones away"),
    ],
)
def test_nozzles_of_tables_that_cannot_be_are_told(file, nozzle, told):
    table = table_of(file, nozzle)
    table["effects"] += table["nozzles"]["mouth"].pop("effects", "").split()
    mouth = table["nozzles"]["mouth"]
    table["nozzles"]["mouth"] = {key: value for key, value in mouth.items() if value is not None}
    with pytest.raises(CaseError, match=told):
        case = cases.from_table(table)
        inflow.kernel(case)
        inputs.check(case)


def test_drops_of_another_density_are_told(file):
    with pytest.raises(CaseError, match="have 700 kg/m3, grains.density_kg_m3 = 1000"):
        inputs.check(case_of(file, grains=SAND | {"density_kg_m3": 1000.0}))
