"""Weber numbers say of which speed and size they are, and of which time of a table."""

import numpy as np
import pytest

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.effects.around import drops, sizes
from sdph.effects.gas import break_up
from sdph.laws.break_up import sauter_diameter
from sdph.study.explain import droplets, weber


def numbers():
    case = cases.load(scenes.find("spray_cone")[1])
    return {row[0]: row for row in droplets.numbers(judge.scales_of(case), True)}


def test_the_number_of_a_case_says_its_speed_and_size():
    case = cases.load(scenes.find("spray_cone")[1])
    speed, size = case.nozzles["cone"].speed, sauter_diameter(case.grains.diameter, case.grains.diameter_std**2)
    _, value, _, meaning, _ = numbers()["Weber"]
    assert value == pytest.approx(case.gas.density * speed**2 * size / case.grains.surface_tension)
    assert meaning.endswith(f"of {1e3 * size:.3g} mm at {speed:.3g} m/s, nozzles.cone")


def test_what_is_fastest_is_named():
    """Of two nozzles the faster one, and drops that begin faster than either."""
    table = cases.parsed(scenes.find("spray_cone")[1])
    table["nozzles"]["beside"] = table["nozzles"]["cone"] | {"speed_m_s": 25.0, "centre_m": [0.05, 0.05, 0.5]}
    assert weber.rows(judge.scales_of(cases.from_table(table)))[0][3].endswith("at 25 m/s, nozzles.beside")
    table["particles"] = {"cloud": {
        "shape": "sphere", "centre_m": [0.15, 0.15, 0.25], "radius_m": 0.02, "volume_fraction": 1e-4,
        "temperature_K": 300.0, "velocity_m_s": [0.0, 0.0, 90.0],
    }}  # fmt: skip
    assert weber.rows(judge.scales_of(cases.from_table(table)))[0][3].endswith("at 90 m/s, as they begin")


def test_a_rate_against_time_changes_no_speed():
    table = cases.parsed(scenes.find("spray_cone")[1])
    del table["nozzles"]["cone"]["rate_kg_s"]
    table["nozzles"]["cone"]["rates"] = [[0.0, 1e-3], [0.02, 4e-3], [0.06, 2e-3]]
    (row, *_) = weber.rows(judge.scales_of(cases.from_table(table)))
    assert row[1] == pytest.approx(numbers()["Weber"][1])
    assert row[3].endswith("m/s, nozzles.cone, as fast at all times of its rates")


def test_faster_gas_is_named():
    case = judge.scales_of(cases.load(scenes.find("spray_cone")[1]))
    case.jet = 1e3
    assert weber.rows(case)[0][3].endswith("at 1e+03 m/s, gas that comes in")


def spray(tmp_path, **more):
    """swirl_spray with four drops in its table, of which the third has the largest number after table_from_s."""
    place = np.array([[0.0, 0.01, 0.0]] * 4)
    speed, d, time = np.array([90.0, 20.0, 30.0, 25.0]), np.array([2e-4, 1e-4, 2e-4, 1e-4]), np.array([1, 2, 3, 4.0])
    path = tmp_path / "drops.csv"
    rows = np.column_stack([1e-3 * time, place, *([0 * d] * 2), speed, 780.0 * np.pi / 6.0 * d**3, d])
    np.savetxt(path, rows, delimiter=",", header=",".join(drops.COLUMNS), comments="")
    table = cases.parsed(scenes.find("swirl_spray")[1])
    own = table["nozzles"]["mouth"]
    del own["record"], own["record_set"]
    own |= {"table": str(path)} | more
    return judge.scales_of(cases.from_table(table))


def test_the_largest_of_a_table_is_told_with_its_time(tmp_path):
    """By hand: 0.4354 30^2 2e-4/0.024 = 3.2655; the faster one comes before the table begins to count."""
    scene, own = weber.rows(spray(tmp_path, table_from_s=1.5e-3))
    assert scene[3].endswith("of 0.15 mm at 20 m/s, nozzles.mouth, not of its table's drops")
    assert own[0] == "Weber, largest of nozzles.mouth.table" and own[1] == pytest.approx(3.2655)
    assert own[3].endswith("its drop at 0.003 s, of 0.2 mm at 30 m/s")
    assert weber.rows(spray(tmp_path, table_from_s=0.0))[1][1] == pytest.approx(9.0 * 3.2655)


def test_the_largest_class_of_a_nozzle_across_the_wind_is_the_likeliest_to_break():
    """Of five classes of Rosin & Rammler the coarsest, in gas that comes from the side."""
    table = cases.parsed(scenes.find("spray_cone")[1])
    own = table["nozzles"]["cone"]
    own |= {"sizes": "rosin_rammler", "size_parameter_mm": 0.3, "size_exponent": 2.5, "least_diameter_mm": 0.03}
    own |= {"size_classes": 5, "speed_m_s": 20.0}
    side = {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [60.0, 0.0, 0.0], "temperature_K": 500.0}
    table["boundaries"]["wind"] = side
    case = cases.from_table(table)
    drop = sizes.of_nozzle(case, case.nozzles["cone"])
    largest = float(sauter_diameter(drop.diameter, drop.variance).max())
    scales = judge.scales_of(case)
    assert largest > 1.5 * scales.grains.diameter
    number = case.gas.density * (60.0**2 + 20.0**2) * largest / case.grains.surface_tension
    row = weber.rows(scales)[0]
    assert row[1] == pytest.approx(number)
    assert row[3].endswith(f"of {1e3 * largest:.3g} mm at 63.2 m/s, drops across gas that comes in")
    assert break_up.call(scales).number == pytest.approx(number / 12.0)
