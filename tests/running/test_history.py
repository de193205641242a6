"""Rows of the history: a probe tells what there is to tell, under a name of its own."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista
from builders import disc
from grain_boxes import started

from coupling.embedded import EmbeddedGas
from sdph import scenes
from sdph.case import read as cases
from sdph.running import history
from sdph.running.alone import Alone
from sdph.schema import CaseError
from sdph.study.explain.effect_costs import prepared

TANK = scenes.HERE / "hydrostatic_tank" / "case.toml"
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


def test_a_probe_follows_the_fields_that_it_names():
    simulation = prepared(
        disc(
            "resolution.spacing_mm=20",
            "resolution.cell_mm=50",
            "probes.centre.fields=['pressure','velocity','alpha_p','temperature']",
        )
    )
    row = history.row(simulation)
    assert list(row)[1:] == [
        "centre_velocity_x_m_s", "centre_velocity_y_m_s", "centre_alpha_p", "centre_temperature_K",
        "centre_gas_pressure_Pa", "centre_gas_velocity_x_m_s", "centre_gas_velocity_y_m_s", "centre_gas_alpha_p",
        "centre_gas_temperature_K",
    ]  # fmt: skip
    assert row["centre_alpha_p"] == pytest.approx(0.6, rel=0.05) and row["centre_gas_alpha_p"] > 0.4
    assert row["centre_temperature_K"] == pytest.approx(288.0)
    assert summary(simulation, row)["centre_gas_pressure_Pa"] == row["centre_gas_pressure_Pa"]


def test_a_probe_in_a_liquid_tells_pressure_and_velocity():
    """Of a linear pressure the value at the probe; nan where no liquid is near."""
    case = cases.load(
        scenes.HERE / "dam_break" / "case.toml", ("probes.wet.at_m=[0.03,0.05]", "probes.dry.at_m=[0.2,0.15]")
    )
    ticks = np.arange(0.5, 40.0) * case.resolution.spacing
    places = np.stack(np.meshgrid(ticks, ticks, [0.0], indexing="ij"), axis=-1).reshape(-1, 3)
    cloud = pyvista.PolyData(places)
    cloud["mass"], cloud["pressure"] = np.ones(len(places)), 9810.0 * (0.1 - places[:, 1])
    cloud["velocity"] = places * (2.0, 0.0, 0.0)
    row = history.of_liquid(case, cloud)
    assert row["wet_pressure_Pa"] == pytest.approx(9810.0 * 0.05, rel=0.01)
    assert row["wet_velocity_x_m_s"] == pytest.approx(0.06, rel=0.01) and row["wet_velocity_y_m_s"] == 0.0
    assert all(math.isnan(row[f"dry_{name}"]) for name in ("pressure_Pa", "velocity_x_m_s", "velocity_y_m_s"))
    assert history.of_liquid(case, pyvista.PolyData()).keys() == row.keys()


def test_a_probe_at_a_periodic_side_sees_both_sides():
    """Of what is odd about the side the mean is 0; one half of it alone has none such."""
    case = cases.load(scenes.HERE / "taylor_green" / "case.toml", ("probes.side.at_m=[0.0,0.5]",))
    ticks = np.arange(0.005, 1.0, 0.01)
    places = np.stack(np.meshgrid(ticks, ticks, [0.0], indexing="ij"), axis=-1).reshape(-1, 3)
    cloud = pyvista.PolyData(places)
    odd = np.sin(2.0 * np.pi * places[:, 0])
    cloud["mass"], cloud["pressure"], cloud["velocity"] = np.ones(len(places)), odd, odd[:, None] * np.ones(3)
    row = history.of_liquid(case, cloud)
    assert abs(row["side_pressure_Pa"]) < 1e-12


def test_the_history_of_a_liquid_has_its_probes(tmp_path):
    case = cases.load(
        scenes.HERE / "dam_break" / "case.toml", ("resolution.spacing_mm=5.715", "probes.wet.at_m=[0.03,0.05]")
    )
    alone = Alone(case, tmp_path / "ledger.csv")
    assert {"wet_pressure_Pa", "wet_velocity_x_m_s", "kinetic_energy_J"} <= alone.row().keys()


@pytest.mark.parametrize(("effects", "energy"), [("['tank','gravity']", True), ("['tank']", False)])
def test_a_liquid_that_no_gravity_pulls_has_no_energy_of_place(tmp_path, effects, energy):
    """domain.gravity_m_s2 may be given for what is up alone; the ledger has no work of it then."""
    case = cases.load(scenes.HERE / "dam_break" / "case.toml", ("resolution.spacing_mm=5.715", f"effects={effects}"))
    assert (Alone(case, tmp_path / "ledger.csv").row()["potential_energy_J"] != 0.0) is energy


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


def test_forces_of_the_gas_on_a_boundary_are_those_of_the_ledger(tmp_path):
    """Gas at rest in a closed box: its walls bear its weight, in the last window and over the run."""
    settings = ("resolution.spacing_mm=20", "resolution.cell_mm=50", "domain.gravity_m_s2=[0.0,-9.81]")
    end = ("run.end_time_s=0.002", "run.forces=['walls']")
    case = disc(*settings, *end)
    simulation = started(case, tmp_path, EmbeddedGas(case))
    assert math.isnan(history_of(simulation, "pressure_force_y_N"))
    while simulation.time < case.run.end_time:
        simulation.window()
    row = simulation.row()
    told, ledger = summary(simulation, row), simulation.ledger.last
    for part, name in (("pressure", "pressure"), ("viscous", "walls")):
        given = ledger[f"gas_impulse_{name}_y_kg_m_s"] / simulation.time
        assert told[f"mean_walls_gas_{part}_force_y_N"] == pytest.approx(-given, rel=1e-12, abs=1e-15)
    weight = case.gas.density * 9.81 * math.prod(case.domain.size)
    assert history_of(simulation, "pressure_force_y_N") == pytest.approx(-weight, rel=0.02)
    assert row["walls_gas_moment_z_Nm"] == pytest.approx(-weight * 0.5 * case.domain.size[0], rel=0.02)


def history_of(simulation, column):
    return simulation.row()[f"walls_gas_{column}"]


@pytest.mark.parametrize(
    "case, given, said",
    [
        (disc, "run.forces=['lid']", "'lid', which is no boundary or wall of the case; it has walls$"),
        (disc, "run.forces=['walls','walls']", "name each once"),
        (disc, "run.forces='lid'", "'lid', which is no boundary or wall"),  # a text is a list of one
        (disc, "parts.lid={lower_m=[0.0,0.0],upper_m=[1.0,-1.0]}", "parts.lid: upper_m = .* lies below"),
        (disc, "parts.left={lower_m=[0.0,0.0],upper_m=[1.0,1.0]}", "parts.left has the name of a boundary, a side"),
        (lambda key: cases.load(TANK, (key,)), "run.forces=['walls']", "it has left, right, bottom, tank$"),
    ],
)
def test_forces_that_nobody_can_tell_are_refused(case, given, said):
    with pytest.raises(CaseError, match=said):
        case(given)
