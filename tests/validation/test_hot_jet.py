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
    """Within the bar of the scene; less than a tenth of it between windows, and between cells and spacings."""
    run = evaporated(tmp_path / "run")
    mass = JET.evaporated(run, END)
    reference, coarse = JET.droplets(run, tmp_path)
    limit = JET.limit_by(reference, coarse, run.case, END)
    others = {
        "window": JET.evaporated(evaporated(tmp_path / "window", "coupling.window_largest_s=5e-4"), END),
        "spacing": JET.evaporated(evaporated(tmp_path / "spacing", "resolution.spacing_mm=100.0"), END),
        "cells": JET.evaporated(evaporated(tmp_path / "cells", "resolution.cell_mm=200.0"), END),
    }
    print(
        "hot jet [g]:", 1e3 * mass, "droplets", 1e3 * JET.evaporated_by(reference, run.case, END), "limit", 1e3 * limit
    )
    print({name: 1e3 * value for name, value in others.items()})
    print("heat [kJ]:", 1e-3 * JET.heat(run, END), 1e-3 * JET.heat_of(reference, run.case, END))
    assert mass == pytest.approx(limit, rel=JET.MASS)
