"""Short forms of the paper's three scenes on both gas solvers: a case runs on either by `--gas` alone, and says the same."""

import pytest

from sdph import case as cases
from sdph import driver, scenes
from sdph.progress import Reporter

# scene -> (overrides, key of summary.json -> relative difference allowed)
SHORT = {
    "disc_cluster": (("run.end_time_s=1e-3",), {"centre_rise_K": 1e-3, "heat_exchanged_J": 0.02}),
    "bubbling_bed": (("run.end_time_s=0.02",), {"bubble_area_m2": 0.02, "bed_height_m": 0.02, "heat_exchanged_J": 0.02}),
    "evaporating_jet": (("run.end_time_s=0.02",), {"front_m": 0.02, "heat_exchanged_J": 0.02}),
}


@pytest.mark.openfoam
@pytest.mark.parametrize("scene", SHORT)
def test_both_gas_solvers_say_the_same(tmp_path, scene):
    overrides, keys = SHORT[scene]
    summaries = {}
    for gas in ("openfoam", "embedded"):
        case = cases.load(scenes.find(scene)[1], (*overrides, f"coupling.gas={gas}"))
        summaries[gas] = driver.run(case, scene, tmp_path / gas, None, Reporter(quiet=True))
    for key, allowed in keys.items():
        assert summaries["embedded"][key] == pytest.approx(summaries["openfoam"][key], rel=allowed), key
