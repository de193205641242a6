"""The hot jet, whose droplets are above the onset from the nozzle on: coarse, to 0.05 s, against the droplet solver."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

JET = compare.scene_module("evaporating_jet")
COARSE = ("resolution.spacing_mm=50.0", "resolution.cell_mm=100.0", "run.end_time_s=0.05", "coupling.gas='embedded'")
END = 0.05  # s


def evaporated(folder, *more):
    case = cases.load(scenes.find("evaporating_jet")[1], (*JET.VARIANTS["hot"][0], *COARSE, *more))
    driver.run(case, "evaporating_jet", folder, None, Reporter(quiet=True))
    return compare.open_run(folder)


@pytest.mark.openfoam
def test_mass_is_that_of_the_droplet_solver_and_bears_other_settings(tmp_path):
    """Within the bar of the scene; windows and spacings twice as long move it by less than that bar's third."""
    run = evaporated(tmp_path / "run")
    mass = JET.evaporated(run, END)
    limit = JET.limit_by(*JET.droplets(run, tmp_path), run.case, END)
    window = JET.evaporated(evaporated(tmp_path / "window", "coupling.window_largest_s=5e-4"), END)
    spacing = JET.evaporated(evaporated(tmp_path / "spacing", "resolution.spacing_mm=100.0"), END)
    print(f"hot jet [g]: {1e3 * mass:.2f}, droplets {1e3 * limit:.2f}, window {1e3 * window:.2f}, {1e3 * spacing:.2f}")
    assert mass == pytest.approx(limit, rel=JET.MASS)
    assert [window, spacing] == pytest.approx([mass, mass], rel=JET.MASS / 3.0)
