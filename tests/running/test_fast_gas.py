"""Gas that came to more than Mach 0.3 in a run is told of, with the kelvin that its equations leave out."""

import numpy as np
import pytest
from builders import disc, run, simulation
from fakes import StillGas

from sdph.running import fast_gas
from sdph.running.limiters import acted

SOUND = 347.1  # m/s by hand: 300 K, c_p = 1006.43 J/(kg K), M = 28.96
CASE = ("gas.temperature_K=300", "gas.molar_mass_kg_kmol=28.96")
COARSE = ("resolution.spacing_mm=20", "resolution.cell_mm=50", "run.report_at_s=[]")


class Blowing(StillGas):
    """A gas that goes at 100 m/s in one cell in its first windows, and at 200 m/s in one of them."""

    def _state(self):
        found = super()._state()
        velocity = np.zeros((len(self.temperature), 3))
        velocity[3, :2] = (120.0, 160.0) if 0.0 < self.time < 0.02 else (60.0, 80.0)
        return found.__class__(found.time, found.fields | {"velocity": velocity}, found.budget)


def test_the_largest_mach_number_is_that_of_the_cells():
    fields = {"velocity": np.array([[30.0, 40.0, 0.0], [0.0, 0.0, 45.0]]), "temperature": np.array([1200.0, 300.0])}
    found = fast_gas.columns(disc(*CASE), fields)
    assert found == pytest.approx({"gas_mach": 45.0 / SOUND, "gas_fastest_m_s": 50.0}, rel=1e-3)


def test_vapour_has_a_sound_of_its_own():
    """Steam alone: sqrt(1.32 8314.46/18.015 400), 493 m/s."""
    from sdph import scenes
    from sdph.case import read as cases

    case = cases.load(scenes.HERE / "spray_cone" / "case.toml")
    fields = {"velocity": np.full((1, 3), 10.0), "temperature": np.array([400.0]), "vapour_mass_fraction": np.ones(1)}
    assert fast_gas.columns(case, fields)["gas_mach"] == pytest.approx(np.sqrt(300.0) / 493.5, rel=5e-3)


@pytest.mark.parametrize(
    ("equation", "told"),
    [
        ("constant", "rough there"),
        ("operating", "19.9 K are missing there"),
        ("ideal", "19.9 K are missing there, and"),
    ],
)
def test_what_is_missing_is_told_by_the_equation_of_state(equation, told):
    """200^2/(2 1006.43)."""
    case = disc(
        *CASE, f"gas.equation_of_state='{equation}'", "gas.operating_pressure_Pa=1e5", "gas.density_kg_m3=1.161"
    )
    (text,) = fast_gas.warnings(case, {"gas_mach": 0.5757, "gas_fastest_m_s": 200.0})
    assert text.startswith("the gas came to Mach 0.58 (200 m/s)") and told in text
    assert fast_gas.warnings(case, {"gas_mach": 0.3, "gas_fastest_m_s": 200.0}) == []
    assert fast_gas.warnings(case, {}) == []


def test_a_run_remembers_the_largest(tmp_path):
    case = disc(*CASE, *COARSE)
    done = run(case, tmp_path, gas=Blowing)
    assert done.row()["gas_fastest_m_s"] == pytest.approx(100.0)
    assert done.limiters.largest["gas_mach"] == pytest.approx(200.0 / SOUND, rel=5e-3)
    assert [text for text in done.warnings() if text.startswith("the gas came to Mach 0.5")]
    assert not {"gas_mach", "gas_fastest_m_s"} & acted(done.limiters.summary()).keys()  # nothing is held
    (tmp_path / "still").mkdir()
    assert not simulation(case, tmp_path / "still").warnings()
