"""What stops a run of grains, and what it is told: a speed that the case accounts for, a key for one that it does not,
grains packed beyond their limit, grains that no wall holds."""

import pytest
from builders import simulation

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.guard import RUNAWAY, Unstable
from sdph.methods.grains.bounds import Guard
from sdph.methods.grains.scales import scales_of
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.schema import CaseError

QUIET = Reporter(quiet=True)


def char(**more):
    """Char of 1200 K that burns in still gas, which is free to expand."""
    table = cases.parsed(scenes.find("burning_char")[1])
    table["effects"] = ["drag", "heat", "reaction"]
    table["run"] = {"end_time_s": 0.15, "output_interval_s": 0.15} | more
    table["domain"] = {"size_m": [0.1, 0.1], "gravity_m_s2": [0.0, 0.0]}
    table["resolution"] = {"spacing_mm": 10.0, "cell_mm": 20.0}
    table["gas"] |= {"equation_of_state": "operating", "molar_mass_kg_kmol": 29.0, "temperature_K": 1000.0}
    table["vapour"]["mass_fraction"] = 0.23
    table["reaction"] |= {"oxidant_ratio": 2.667, "rate_m_s": 600.0, "activation_temperature_K": 9000.0,
                          "heat_J_kg": 3.28e7}  # fmt: skip
    table["particles"] = {"cloud": {"shape": "disc", "centre_m": [0.05, 0.05], "radius_m": 0.03,
                                    "volume_fraction": 5e-5, "temperature_K": 1200.0}}  # fmt: skip
    table["track"] = {}
    outlet = {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0, "temperature_K": 1000.0,
              "vapour_mass_fraction": 0.23}  # fmt: skip
    table["boundaries"] = {"out": outlet, "walls": {"kind": "wall"}}
    return cases.from_table(table)


def test_grains_go_with_gas_that_a_reaction_drives(tmp_path):
    """They come to 0.3 m/s, which nothing but the expansion of the gas accounts for."""
    case = char()
    assert scales_of(case).rush > 0.1
    done = driver.run(case, "char", tmp_path / "run", None, QUIET)
    assert done["time_s"] == pytest.approx(0.15)


def test_a_speed_may_be_given(tmp_path):
    case = char(fastest_m_s=0.05)
    assert Guard(case).reach * RUNAWAY == pytest.approx(0.05)
    with pytest.raises(Unstable, match=r"allows 0 to 0\.05 m/s.*give run\.fastest_m_s"):
        driver.run(case, "char", tmp_path / "run", None, QUIET)


def falling(gravity: float):
    """The disc, which falls and feels nothing else."""
    table = cases.parsed(scenes.find("disc_cluster")[1])
    del table["heat"]
    table["effects"], table["domain"]["gravity_m_s2"] = ["gravity"], [0.0, -gravity]
    return cases.from_table(table)


def test_grains_packed_beyond_their_limit_are_told_once(tmp_path):
    run = simulation(falling(9.81), tmp_path)
    run.grains._tell_packed()
    assert run.notices == []
    run.state.density[5] = 0.84 * run.case.grains.density
    for _ in range(2):
        run.grains._tell_packed()
    (told,) = run.notices
    assert "0.84" in told and "packing_limit" in told and "friction and granular_pressure" in told


def test_particles_that_lie_upon_each_other_in_a_cell_are_told_once(tmp_path):
    """A sum over neighbours does not show it: the gas's cells do, and a run says which."""
    table = cases.parsed(scenes.find("disc_cluster")[1])
    table["effects"] = ["drag", "heat"]
    run = simulation(cases.from_table(table), tmp_path)
    run.window()
    assert run.notices == []
    run.state.mass[:] *= 0.9 / table["particles"]["disc"]["volume_fraction"]
    for _ in range(2):
        run.window()
    (told,) = (notice for notice in run.notices if "cell" in notice)
    assert "the gas's cell at (" in told and "alpha_p = 0.9" in told and "grain_shifting parts them" in told


def test_grains_that_no_wall_holds_are_told_what_would(tmp_path):
    with pytest.raises(CaseError, match=r"bottom_side, where no wall holds grains.*add walls"):
        driver.run(falling(1e6), "disc", tmp_path / "run", None, QUIET)
