"""Rows of the history: a probe tells what there is to tell, under a name of its own."""

from types import SimpleNamespace

import pytest
from builders import disc

from sdph import scenes
from sdph.case import read as cases
from sdph.running import history
from sdph.schema import CaseError
from sdph.study.explain.effect_costs import prepared

COLUMN = scenes.HERE / "fluidised_column" / "case.toml"  # whose grains have no temperature


def summary(simulation, row):
    return simulation.summary(SimpleNamespace(first=row, last=row))


def test_a_probe_among_grains_without_heat_tells_of_the_gas():
    simulation = prepared(cases.load(COLUMN, ("probes.low.at_m=[0.015,0.1]",)))
    row = history.row(simulation)
    assert row == {"time_s": 0.0, "low_gas_temperature_K": pytest.approx(298.0)}
    told = summary(simulation, row)
    assert told["low_gas_temperature_K"] == row["low_gas_temperature_K"] and "low_rise_K" not in told


def test_a_probe_where_there_is_heat_tells_of_both():
    simulation = prepared(disc("resolution.spacing_mm=20", "resolution.cell_mm=50"))
    row = history.row(simulation)
    assert row.keys() == {"time_s", "centre_temperature_K", "centre_gas_temperature_K"}
    assert summary(simulation, row)["centre_rise_K"] == 0.0


def test_every_row_has_the_same_columns(tmp_path):
    """Of a jet too whose first grains are still to come."""
    case = cases.load(
        scenes.HERE / "evaporating_jet" / "case.toml",
        ("nozzles.jet.start_s=1.0", "track.particles=[1]", "probes.p.at_m=[1.0,1.0]"),
    )
    row = history.row(prepared(case))
    assert {
        "p_temperature_K",
        "p_gas_temperature_K",
        "particle_1_temperature_K",
        "particle_1_x_m",
        "particle_1_convective_heat_W",
    } <= row.keys()
    assert "particle_1_z_m" not in row


def test_the_summary_keeps_probes_apart_whose_names_begin_alike():
    simulation = prepared(
        disc("resolution.spacing_mm=20", "resolution.cell_mm=50", "probes.centre_low.at_m=[0.25,0.2]")
    )
    row = history.row(simulation)
    told = summary(simulation, row)
    assert [key for key in told if key.startswith("centre")] == [
        "centre_temperature_K", "centre_gas_temperature_K", "centre_rise_K",
        "centre_low_temperature_K", "centre_low_gas_temperature_K", "centre_low_rise_K",
    ]  # fmt: skip


@pytest.mark.parametrize("name", ["$\\frac{$", "a b", "<b>", "a,b", 'say "a"', "ä", "../../x", "x; #calc y", "a_b.c"])
def test_a_probe_may_have_any_name_that_can_be_printed(name):
    table = cases.to_table(disc("resolution.spacing_mm=20", "resolution.cell_mm=50"))
    table["probes"] = {name: {"at_m": [0.25, 0.25]}}
    assert f"{name}_temperature_K" in history.row(prepared(cases.from_table(table)))


@pytest.mark.parametrize("name", ["", " ", "a\nb", "\0", "\x1b[31m", "x" * 101])
@pytest.mark.parametrize("group", ["probes", "particles", "boundaries"])
def test_a_name_that_cannot_be_printed_is_refused(group, name):
    table = cases.to_table(disc())
    table[group][name] = dict(next(iter(table[group].values())))
    with pytest.raises(CaseError, match=f"{group} holds the name"):
        cases.from_table(table)


def test_two_probes_may_not_share_a_column():
    with pytest.raises(CaseError, match="a_gas_temperature_K"):
        disc("probes.a.at_m=[0.25,0.25]", "probes.a_gas.at_m=[0.25,0.2]")
    with pytest.raises(CaseError, match="particle_3_temperature_K"):
        disc("probes.particle_3.at_m=[0.25,0.25]", "track.particles=[3]")
