"""The capillary wave's table of Prosperetti's solution, and the figure of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study import compare

WAVE = compare.scene_module("capillary_wave")


def case(*overrides):
    return cases.load(scenes.find("capillary_wave")[1], overrides)


def test_the_table_in_seconds_is_the_solution_without_its_sign():
    """All 738 rows, over the height at the start; they have six digits."""
    times, height = WAVE.table(case())
    assert len(times) == 738 and height[0] == 1.0
    np.testing.assert_allclose(height, np.abs(WAVE.solution(case(), times)), atol=1e-4, rtol=0.0)


def test_a_wave_of_other_length_has_the_table_in_its_own_time():
    """omega is sqrt(sigma k^3/(2 rho)): a wave twice as long, tension doubled, is slower by sqrt(8/2) = 2."""
    long = case(
        "pools.lower.upper_m=[2.0, 1.0]", "pools.upper.upper_m=[2.0, 2.0]", "domain.size_m=[2.0, 2.0]",
        "pools.lower.displacement_m=0.02", "pools.upper.displacement_m=0.02",
        "surface_tension.coefficient_N_m=2.0", f"liquid.viscosity_Pa_s={2.0 * 0.0182571749236}",
        f"gas_phase.viscosity_Pa_s={2.0 * 0.0182571749236}",
    )  # fmt: skip
    assert WAVE.table(long)[0] == pytest.approx(2.0 * WAVE.table(case())[0], rel=1e-9)


@pytest.mark.parametrize(
    "other",
    [
        "liquid.viscosity_Pa_s=0.02", "surface_tension.coefficient_N_m=1.1", "gas_phase.density_kg_m3=1.1",
        "gas_phase.viscosity_Pa_s=0.02",
    ],
)  # fmt: skip
def test_other_liquids_have_no_table(other):
    assert [len(column) for column in WAVE.table(case(other))] == [0, 0]


def test_the_figure_of_a_run_has_run_solution_and_table(tmp_path, monkeypatch):
    """A run that lags by a tenth of its time; the table's points have the sign of the solution."""
    from matplotlib import pyplot

    kept, times = [], np.linspace(0.0, 2.15, 44)
    run = SimpleNamespace(case=case(), folder=tmp_path, summary={"time_s": 2.2})
    ours = WAVE.solution(run.case, 0.9 * times)
    monkeypatch.setattr(pyplot, "close", kept.append)
    monkeypatch.setattr(WAVE, "heights", lambda run: (times, ours))
    (told,) = WAVE.exact(run)
    assert not told["ok"] and (tmp_path / "wave.png").stat().st_size < 200_000
    exact, points, line = kept[0].axes[0].lines
    for one in (exact, points):
        x, y = one.get_data()
        assert len(x) > 50 and y == pytest.approx(WAVE.solution(run.case, x), abs=1e-4) and min(y) < -0.3
    assert line.get_data()[0] == pytest.approx(times) and line.get_data()[1] == pytest.approx(ours, rel=1e-12)
