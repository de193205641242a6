"""A drain that takes liquid faster than its pipe brings it says so."""

import pytest

from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter

CORNERS = [[0.0, 0.0], [0.12, 0.0], [0.12, -0.08], [0.16, -0.08], [0.16, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]]


def notched(fill: float, lasts: float):
    """A tank with a pipe in its floor, half full, drained down to a fill within a time [s]."""
    return cases.from_table({
        "dimensions": 2, "effects": ["gravity", "density_diffusion", "liquid_damping", "tank", "drain"],
        "run": {"end_time_s": 0.01 + lasts, "output_interval_s": lasts},
        "domain": {"size_m": [0.3, 0.4], "lower_m": [0.0, -0.1], "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": 10.0}, "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 20.0},
        "tank": {"shape": "outline", "corners_m": CORNERS, "slip": "free_slip"},
        "pools": {"water": {"shape": "tank", "fill": 0.5}},
        "drain": {"fill": fill, "start_s": 0.01, "end_s": 0.01 + lasts},
    })  # fmt: skip


class Kept(Reporter):
    """Keeps what a run says."""

    def __init__(self):
        super().__init__()
        self.told = []

    def status(self, text: str) -> None:
        self.told.append(text)


@pytest.mark.parametrize(("fill", "lasts", "dry"), [(0.3, 0.03, True), (0.48, 0.1, False)])
def test_a_run_says_once_that_its_outlet_ran_empty(tmp_path, fill, lasts, dry):
    """Through 0.04 m go 0.0186 m2 in 0.03 s: 15 m/s, where a depth of 0.23 m drives 2; and 0.5 m/s."""
    told = Kept()
    driver.run(notched(fill, lasts), "notch", tmp_path / "run", None, told)
    lines = [line for line in told.told if "the outlet had run empty" in line]
    assert len(lines) == dry and all("from 0.0" in line and "3 spacings above" in line for line in lines)
