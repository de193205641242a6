"""Grains in a gas beside a liquid: one run, one clock, contact that is equal on both sides, restart bit for bit."""

import csv
import json
import re

import numpy as np
import pytest
import tomli_w

from sdph import cli
from sdph.case import read as cases
from sdph.engine.contact import Contact
from sdph.schema import CaseError
from sdph.study.explain import tables

TABLE = {
    "title": "Grains fall into a pool",
    "dimensions": 2,
    "effects": [
        "drag", "gas_pressure", "gravity", "granular_pressure", "walls", "density_diffusion", "liquid_damping", "tank",
        "outflow",
    ],
    "run": {
        "end_time_s": 0.06, "output_interval_s": 0.03, "checkpoint_windows": 20,
        "forces": ["rest", "top", "bottom", "left", "right", "tank", "low"],
    },
    "domain": {"size_m": [0.4, 0.5], "gravity_m_s2": [0.0, -9.81]},
    "resolution": {"spacing_mm": 20.0, "cell_mm": 50.0},
    "gas": {
        "equation_of_state": "constant", "density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.025,
        "heat_capacity_J_kg_K": 1006.0, "temperature_K": 293.0,
    },
    "grains": {
        "density_kg_m3": 800.0, "diameter_mm": 1.0, "heat_capacity_J_kg_K": 840.0, "conductivity_W_m_K": 1.0,
        "granular_temperature_m2_s2": 1e-4,
    },
    "particles": {
        "block": {
            "shape": "box", "lower_m": [0.12, 0.17], "upper_m": [0.28, 0.25], "volume_fraction": 0.3,
            "temperature_K": 293.0, "velocity_m_s": [0.0, -1.0],
        }
    },
    "boundaries": {"top": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0}, "rest": {"kind": "wall"}},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 15.0},
    "tank": {"shape": "box", "open_sides": ["top"]},
    "parts": {"low": {"lower_m": [0.0, 0.0], "upper_m": [0.0, 0.1]}},
    "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.4, 0.14]}},
}  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "case.toml").write_text(tomli_w.dumps(TABLE))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def column(file, name) -> np.ndarray:
    with open(file) as rows:
        return np.array([float(row[name]) for row in csv.DictReader(rows)])


def forces(on, axis) -> list[np.ndarray]:
    """Forces [N] of each window by the history: of pressure, and of friction."""
    rubs = "friction" if on.endswith("grain") else "viscous"
    return [column("run/history.csv", f"{on}_{kind}_force_{axis}_N")[1:] for kind in ("pressure", rubs)]


def of_walls(ledger) -> np.ndarray:
    """Force [N] of the walls in each window by a ledger."""
    return column(ledger, "impulse_of_walls_y_kg_m_s")[1:] / column(ledger, "window_s")[1:]


def test_grains_fall_into_a_pool(folder, capsys):
    """What contact takes from the grains the liquid gets, window by window; both ledgers close."""
    assert cli.main(["run", "mine", "--gas", "embedded", "--out", "run", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    for name in ("mass_drift_rel", "exchange_momentum_mismatch_rel", "liquid_mass_drift_rel"):
        assert summary[name] < 1e-12, name
    assert summary["liquid_momentum_drift_rel"] < 1e-10
    given = column("run/ledger.csv", "impulse_of_contact_y_kg_m_s")
    taken = column("run/ledger_liquid.csv", "impulse_of_contact_y_kg_m_s")
    assert np.abs(given).sum() > 1e-3
    np.testing.assert_allclose(given, -taken, atol=1e-12 * np.abs(given).sum())
    grains = sum(forces("rest_grain", "y"))
    np.testing.assert_allclose(grains, -of_walls("run/ledger.csv"), atol=1e-12 * np.abs(grains).sum())
    for names in (("bottom", "left", "right"), ("tank",)):
        liquid = sum(force for name in names for force in forces(f"{name}_liquid", "y"))
        np.testing.assert_allclose(liquid, -of_walls("run/ledger_liquid.csv"), rtol=1e-10)
    assert np.abs(column("run/history.csv", "low_liquid_pressure_force_x_N")[1:]).min() > 0.0
    assert "mean_tank_liquid_moment_z_Nm" in summary and "mean_left_grain_pressure_force_x_N" in summary
    of_top = [key for key in summary if "_top_" in key]
    assert of_top and all(re.match("(mean|highest|lowest)_top_gas_", key) for key in of_top)
    heights = column("run/history.csv", "liquid_largest_y_m")
    assert heights[0] < 0.14 and (folder / "run" / "fields" / "liquid_00001.vtp").is_file()
    assert cli.main(["report", "run"]) == 0 and cli.main(["view", "run", "--png", "run.png"]) == 0
    assert cli.main(["explain", "mine"]) == 0
    said = capsys.readouterr().out
    words = " ".join(said.split())
    assert "rest gas, grains top gas bottom grains, liquid" in words and "tank liquid low grains, liquid" in words
    assert "(GRAINS)" in said and "(LIQUID)" in said
    with open("run/ledger.csv") as rows:
        ruled = [float(row["window_s"]) for row in csv.DictReader(rows) if row["limit"] == "contact"]
    parts = tables.explain(cases.load(folder / "mine" / "case.toml"))
    limit = next(row["largest [s]"] for row in parts["limits (grains)"] if row["cause"] == "contact")
    assert 0.5 * limit < max(ruled) <= 1.001 * limit


def test_it_goes_on_bit_for_bit(folder, capsys):
    run = ["run", "mine", "--gas", "embedded", "--json"]
    assert cli.main([*run, "--out", "whole"]) == 0
    assert cli.main([*run, "--out", "cut", "--until", "0.03"]) == 0
    assert cli.main(["run", "--resume", "cut", "--until", "0.06", "--json"]) == 0
    for name in ("ledger.csv", "ledger_liquid.csv", "history.csv"):
        assert (folder / "whole" / name).read_bytes() == (folder / "cut" / name).read_bytes(), name


def test_springs_push_both_sides_alike():
    rng, contact = np.random.default_rng(3), Contact(0.1, 50.0)
    first, second = rng.random((40, 3)) * 0.5, rng.random((30, 3)) * 0.5
    on_first, on_second = contact.forces(first, second)
    assert np.abs(on_first.sum(axis=0) + on_second.sum(axis=0)).max() < 1e-12 * np.abs(on_first).sum()
    apart = first[:, None] - second[None]
    r = np.linalg.norm(apart, axis=2)
    slow = (50.0 * np.maximum(0.1 - r, 0.0) / r)[..., None] * apart
    np.testing.assert_allclose(on_first, slow.sum(axis=1), atol=1e-12)
    np.testing.assert_allclose(on_second, -slow.sum(axis=0), atol=1e-12)
    assert contact.near(first, second) and not contact.near(first, second + 9.0)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"gas": None}, "give both .grains. and .gas., or neither"),
        ({"effects": [*TABLE["effects"], "drain"], "gas_phase": {"density_kg_m3": 1.0}}, "drain"),
        ({"domain": TABLE["domain"] | {"periodic": ["x"]}}, "without periodic axes"),
    ],
)
def test_what_cannot_stand_side_by_side_is_refused(change, told):
    table = {key: value for key, value in (TABLE | change).items() if value is not None}
    with pytest.raises(CaseError, match=told):
        cases.from_table(table)
