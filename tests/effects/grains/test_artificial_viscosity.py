"""Artificial viscosity of any strength: no sub-step turns a wave round, and none makes motion."""

import numpy as np
import pytest
from builders import DISC, run
from decaying_waves import fastest

from sdph.case import read as cases
from sdph.effects.effect import Live
from sdph.effects.grains import artificial_viscosity
from sdph.methods.grains import sound


@pytest.mark.parametrize("ratio", [1.0, 1.2, 1.5, 3.0])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_step_takes_no_more_than_all_of_a_wave(ratio, dimensions):
    assert 0.5 < artificial_viscosity.STEP * fastest("cubic_spline", ratio, dimensions) <= 1.0


@pytest.mark.parametrize("own", [{"alpha": 30.0, "beta": 0.0}, {"alpha": 0.0, "beta": 30.0}])
def test_strong_viscosity_makes_no_motion(tmp_path, own):
    """Two clouds that fly into each other are slower than before."""
    table = {name: part for name, part in cases.parsed(DISC).items() if name not in ("heat", "conduction")} | {
        "effects": ["granular_pressure", "granular_temperature", "artificial_viscosity"], "artificial_viscosity": own,
        "run": {"end_time_s": 0.02, "output_interval_s": 0.02},
        "resolution": {"spacing_mm": 4.0, "cell_mm": 20.0}, "probes": {}, "coupling": {"window_largest_s": 1e-3},
    }  # fmt: skip
    part = {"shape": "box", "volume_fraction": 0.3, "temperature_K": 300.0}
    table["particles"] = {
        "left": part | {"lower_m": [0.01, 0.02], "upper_m": [0.05, 0.08], "velocity_m_s": [1.0, 0.0]},
        "right": part | {"lower_m": [0.05, 0.02], "upper_m": [0.09, 0.08], "velocity_m_s": [-1.0, 0.0]},
    }
    case = cases.from_table(table)
    done = run(case, tmp_path)
    s = done.state
    assert np.hypot(s.u, s.v).max() < 1.0
    assert done.stepper.limit == "artificial_viscosity"


def test_weak_viscosity_limits_nothing():
    """With alpha and beta of the paper sound asks for shorter sub-steps, whatever the pace."""
    p = artificial_viscosity.ArtificialP(0.1, 0.2, 0.01)
    asked = artificial_viscosity.dt_limit(p, None, Live(None, {"artificial_viscosity": 3.0}))
    assert asked > sound.limit(0.01, 3.0)
