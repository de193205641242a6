"""Sensors of a tank and its motion: what would tell otherwise than meant is told before a run."""

import pytest

from sdph.case import read as cases
from sdph.study.explain import tanks

TABLE = {
    "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank", "frame"],
    "run": {"end_time_s": 3.0, "output_interval_s": 1.0},
    "domain": {"size_m": [0.6, 0.3], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 10.0},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 20.0},
    "tank": {"shape": "outline", "corners_m": [[0.1, 0.05], [0.5, 0.05], [0.5, 0.25], [0.1, 0.25]]},
    "pools": {"water": {"shape": "box", "lower_m": [0.1, 0.05], "upper_m": [0.5, 0.15]}},
}  # fmt: skip


def told(place=None, fields=(), end=None, rows=(0.0, 1.0, 2.0), folder=None):
    table = TABLE | {"frame": {}}
    if place:
        table |= {"probes": {"one": {"at_m": place, "fields": list(fields)}}}
    if folder:
        head = "time_s,ax_m_s2,ay_m_s2,az_m_s2,wx_rad_s,wy_rad_s,wz_rad_s\n"
        (folder / "motion.csv").write_text(head + "".join(f"{t},0.1,0,0,0,0,0\n" for t in rows))
        table |= {"frame": {"table": str(folder / "motion.csv"), "start_s": 0.5, "end_s": end}}
    return tanks.warnings(cases.from_table(table))


@pytest.mark.parametrize(
    ("place", "fields", "said"),
    [
        ([0.3, 0.05], (), "lies at a floor"),
        ([0.3, 0.055], ("pressure",), "lies at a floor"),
        ([0.3, 0.05], ("velocity",), None),
        ([0.1, 0.1], (), None),  # at a side
        ([0.3, 0.1], (), None),
        ([0.3, 0.02], (), "lies 0.03 m outside of the tank"),
        ([0.05, 0.1], ("velocity",), "lies 0.05 m outside of the tank"),
    ],
)
def test_a_probe_at_a_floor_or_outside_is_told_of(place, fields, said):
    found = told(place, fields)
    assert len(found) == (said is not None) and all(said in line for line in found)


@pytest.mark.parametrize(("end", "fine"), [(2.5, True), (2.4, True), (1.5, False), (1.2, False)])
def test_rows_of_a_motion_that_are_dropped_are_told_of(tmp_path, end, fine):
    """A table of 2 s after 0.5 s; within its last interval nothing is said."""
    found = told(end=end, folder=tmp_path)
    assert len(found) == (not fine)
    assert fine or f"rows after {end - 0.5:g} s of the table are dropped" in found[0]


def test_a_table_of_one_row_ends_with_it(tmp_path):
    assert told(end=0.6, rows=(0.0,), folder=tmp_path) == []
    (line,) = told(end=0.6, rows=(1.0,), folder=tmp_path)
    assert "frame.start_s + 1 = 1.5 s" in line
