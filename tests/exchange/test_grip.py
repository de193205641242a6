"""Windows in which a plug of grains stops in a closed column: gas flows past it, and a window holds that gas."""

import csv
import math

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.exchange.window import GRIP
from sdph.running import driver
from sdph.running.progress import Reporter

SPEED = 0.02  # m/s, of the plug at the start: it goes no further than a tenth of a cell


def plug(folder, alpha_p, end, largest):
    """(Rate [1/s] at which the plug stops, windows) by its momentum over `end` [s]."""
    table = cases.parsed(scenes.find("fluidised_column")[1])
    bed = {"lower_m": [0.0, 0.1], "upper_m": [0.03, 0.3], "volume_fraction": alpha_p, "velocity_m_s": [0.0, SPEED]}
    table["particles"]["bed"] |= bed
    table["domain"]["gravity_m_s2"] = [0.0, 0.0]
    table |= {
        "effects": ["drag", "gas_pressure", "walls"],
        "run": {"end_time_s": end, "output_interval_s": end},
        "boundaries": {"walls": {"kind": "slip_wall"}},
        "drag": {"law": "gidaspow"},
        "coupling": {"window_largest_s": largest, "gas": "embedded"},
    }
    found = driver.run(cases.from_table(table), "plug", folder / "run", None, Reporter(quiet=True))
    with open(folder / "run" / "ledger.csv") as file:
        momentum = [float(row["particle_momentum_y_kg_m_s"]) for row in csv.DictReader(file)]
    return math.log(momentum[0] / momentum[-1]) / end, found["windows"]


@pytest.mark.parametrize(("alpha_p", "end", "most"), [(0.55, 0.008, 6), (0.3, 0.03, 3), (0.01, 0.1, 1)])
def test_a_plug_stops_at_its_rate_however_dilute(tmp_path, alpha_p, end, most):
    """Within GRIP/2 of the rate in windows of a hundredth; the more dilute, the longer the windows."""
    (tmp_path / "fine").mkdir()
    converged, _ = plug(tmp_path / "fine", alpha_p, end, end / 100.0)
    rate, windows = plug(tmp_path, alpha_p, end, end)
    print(f"alpha_p {alpha_p}: rate {converged:.3f} 1/s, {rate / converged - 1.0:+.4f} in {windows} windows")
    assert windows <= most
    assert abs(rate / converged - 1.0) < 0.5 * GRIP
