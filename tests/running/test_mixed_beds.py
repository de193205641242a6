"""A bed of two materials as a whole: it goes on bit for bit, its ledger closes, and its output tells of each."""

import json

import numpy as np
import pytest
import pyvista

from sdph import cli, scenes
from sdph.case import read as cases
from sdph.laws import exact
from sdph.methods.grains.materials import fluidising
from sdph.running.metrics import segregation

WARM = (
    'effects=["drag","gas_pressure","gravity","granular_pressure","friction","granular_viscosity",'
    '"granular_temperature","artificial_viscosity","grain_drag","walls","heat","conduction"]'
)
SET = [
    *("--set", WARM, "--set", "run.output_interval_s=0.02", "--set", "particles.large.temperature_K=340.0"),
    *("--set", "grains.large.density_kg_m3=3500.0", "--set", "grains.small.heat_capacity_J_kg_K=2000.0"),
    *("--set", "boundaries.distributor.velocity_m_s=[0.0,1.6]"),
]
CLOSED = ("exchange_energy_mismatch_rel", "exchange_momentum_mismatch_rel", "motion_drift_rel", "energy_drift_rel")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_it_goes_on_bit_for_bit_and_its_ledger_closes(folder, capsys):
    run = ["run", "segregation", "--gas", "embedded", "--json", *SET]
    assert cli.main([*run, "--until", "0.06", "--out", "whole"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert cli.main([*run, "--until", "0.04", "--out", "cut"]) == 0
    assert cli.main(["run", "--resume", "cut", "--until", "0.06", "--json"]) == 0
    for name in ("ledger.csv", "history.csv", "metrics.csv"):
        assert (folder / "whole" / name).read_bytes() == (folder / "cut" / name).read_bytes(), name
    for key in CLOSED:
        assert told[key] < 1e-10, key
    assert told["grain_drag_J"] > 0.0 and told["particle_mass_drift_rel"] < 1e-13
    rows = np.genfromtxt("whole/history.csv", delimiter=",", names=True)
    np.testing.assert_allclose(rows["material_small_kg"], 0.3 * 2525.0 * 0.15**2, rtol=1e-12)
    np.testing.assert_allclose(rows["material_large_kg"], 0.3 * 3500.0 * 0.15**2, rtol=1e-12)
    shown = pyvista.read(sorted((folder / "whole" / "fields").glob("particles_*.vtp"))[-1])
    assert set(np.unique(shown["material"])) == {0, 1} and shown["alpha_p"].max() < 0.7
    assert cli.main(["view", "whole", "--png", "whole.png", "--field", "material"]) == 0
    assert cli.main(["compare", "whole", "--against", "tfm"]) == 2
    assert "of one material" in capsys.readouterr().err


def test_explain_tells_of_each(folder, capsys):
    assert cli.main(["explain", "segregation"]) == 0
    said = capsys.readouterr().out
    assert "MATERIALS" in said and "terminal velocity" in said
    case = cases.load(scenes.find("segregation")[1])
    for grains, speed in zip(case.kinds, fluidising(case)):  # Ergun's gradient at U_mf carries the weight in gas
        gradient = exact.ergun_gradient(0.6, speed, grains.diameter, 1.2, 1.8e-5)
        assert gradient == pytest.approx(0.6 * (2525.0 - 1.2) * 9.81, rel=1e-9)
        assert f"{speed:.3g}" in said
    assert segregation.ranked(case) == (1, 0)


def test_segregation_of_layers_and_of_a_mixture():
    """1 where all flotsam lies on all jetsam, 0 where they alternate; jetsam on top is what is there over its share."""
    height, volume = (np.arange(400) + 0.5) / 400.0, np.full(400, 0.1)
    layers = segregation.of(height, volume, height < 0.25, "large", "small")
    assert layers["segregation"] == pytest.approx(1.0) and layers["mixing_index"] == 0.0
    assert layers["height_large_m"] == pytest.approx(0.125) and layers["height_small_m"] == pytest.approx(0.625)
    mixed = segregation.of(height, volume, np.arange(400) % 4 == 0, "large", "small")
    assert mixed["segregation"] == pytest.approx(0.0, abs=0.01)
    assert mixed["mixing_index"] == pytest.approx(1.0, abs=0.01)


@pytest.mark.openfoam
def test_openfoam_moves_its_gas_as_well(folder, capsys):
    run = ["run", "segregation", "--gas", "openfoam", "--json", *SET, "--until", "0.02", "--out", "foam"]
    assert cli.main(run) == 0
    told = json.loads(capsys.readouterr().out)
    for key in CLOSED:
        assert told[key] < 1e-10, key
