"""Char that burns in a stream, on both gas solvers: it goes on bit for bit, its ledger closes, both say the same."""

import json

import pytest

from sdph import cli

SET = ("--set", "run.output_interval_s=0.3", "--set", "resolution.cell_mm=5", "--json")
SPREAD = ("--set", "grains.diameter_std_mm=0.02", "--set", "particles.cloud.velocity_m_s=[0.0,0.05]")
CLOSED = ("exchange_mass_mismatch_rel", "exchange_energy_mismatch_rel", "exchange_momentum_mismatch_rel",
          "species_drift_rel", "energy_drift_rel")  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def told(capsys, *arguments) -> dict:
    assert cli.main(["run", *arguments]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("gas", ["embedded", pytest.param("openfoam", marks=pytest.mark.openfoam)])
def test_it_goes_on_bit_for_bit_and_its_ledger_closes(folder, capsys, gas):
    run = ["burning_char", "--gas", gas, *SET, *SPREAD]
    whole = told(capsys, *run, "--until", "0.6", "--out", "whole")
    told(capsys, *run, "--until", "0.3", "--out", "cut")
    told(capsys, "--resume", "cut", "--until", "0.6", "--json")
    for name in ("ledger.csv", "history.csv"):
        assert (folder / "whole" / name).read_bytes() == (folder / "cut" / name).read_bytes(), name
    assert whole["reacted_kg"] > 0.0
    for key in CLOSED:
        assert whole[key] < 1e-10, key
    assert whole["particle_mass_drift_rel"] < 1e-13 and whole["mass_drift_rel"] < 1e-12


@pytest.mark.openfoam
def test_both_gas_solvers_say_the_same(folder, capsys):
    one, other = (
        told(capsys, "burning_char", "--gas", gas, *SET, "--until", "1", "--out", gas)
        for gas in ("embedded", "openfoam")
    )
    for key in ("reacted_kg", "heat_exchanged_J", "reaction_heat_J"):
        assert one[key] == pytest.approx(other[key], rel=0.01), key
