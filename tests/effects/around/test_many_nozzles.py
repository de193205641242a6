"""Several nozzles: each particle belongs to one of them, and what waits upstream of any is not in the gas."""

import math

import numpy as np
import pytest
import pyvista
from test_inflow import AIR, SAND

from coupling.embedded import EmbeddedGas
from sdph.case import read as cases
from sdph.effects.around.source import Source
from sdph.engine import state as particles
from sdph.engine.state import GRAIN, INFLOW
from sdph.running import driver, output
from sdph.running.metrics import jet
from sdph.running.progress import Reporter
from sdph.schema import CaseError

ROUND_OFF = 1e-10
CLOSED = ("particle_mass_drift_rel", "mass_drift_rel", "energy_drift_rel")


def slot(centre, direction, **more):
    return {
        "shape": "slot", "centre_m": centre, "width_m": 0.1, "direction": direction, "speed_m_s": 4.0,
        "volume_fraction": 0.05, "temperature_K": 320.0,
    } | more  # fmt: skip


def abreast(count):
    """Nozzles one over the other on the left side, each of one stream, no two at the same speed."""
    places = (np.arange(count) + 0.5) / count
    return {
        f"n{k}": slot([0.0, y], [1.0, 0.0], width_m=0.5 / count, speed_m_s=4.0 + k / count)
        for k, y in enumerate(places)
    }


FACING = {"left": slot([0.2, 0.5], [1.0, 0.0]), "right": slot([0.6, 0.5], [-1.0, 0.0], temperature_K=280.0)}
BESIDE = {"here": slot([0.0, 0.5], [1.0, 0.0]), "there": slot([0.01, 0.55], [1.0, 0.2], start_s=0.02, end_s=0.06)}
MIXED = {
    "drops": slot([0.0, 0.4], [1.0, 0.0], sizes="rosin_rammler", size_parameter_mm=1.0, size_exponent=3.0,
                  least_diameter_mm=0.3, size_classes=3),
    "two": slot([0.0, 0.7], [1.0, 0.0], sizes="given", diameters_mm=[0.5, 2.0], shares=[1.0, 3.0]),
}  # fmt: skip
CONE_AND_SLOT = {
    "cone": slot([0.5, 0.5, 0.0], [0.0, 0.0, 1.0], shape="cone", radius_m=0.11, half_angle_deg=30.0, width_m=None),
    "slot": slot([0.0, 0.5, 0.5], [1.0, 0.0, 0.0], length_m=0.2),
}


def case(nozzles, dimensions=2, **more):
    nozzles = {
        name: {key: value for key, value in nozzle.items() if value is not None} for name, nozzle in nozzles.items()
    }
    return cases.from_table({
        "title": "", "scene": "", "dimensions": dimensions, "effects": ["inflow", "outflow", "drag", "heat",
        "gas_pressure"], "run": {"end_time_s": 0.1, "output_interval_s": 0.1},
        "coupling": {"gas": "embedded", "window_largest_s": 0.01},
        "domain": {"size_m": [1.0] * dimensions, "gravity_m_s2": [0.0] * dimensions},
        "resolution": {"spacing_mm": 50.0 if dimensions == 3 else 20.0, "cell_mm": 100.0},
        "gas": AIR | {"equation_of_state": "constant"}, "grains": SAND,
        "boundaries": {"sides": {"kind": "pressure_outlet", "pressure_Pa": 0.0}}, "nozzles": nozzles,
    } | more)  # fmt: skip


def begun(chosen, folder):
    simulation = driver.simulation_of(chosen, EmbeddedGas(chosen), folder / "ledger.csv")
    simulation.start()
    return simulation


@pytest.mark.parametrize(("nozzles", "dimensions"), [
    (abreast(1), 2), (abreast(2), 2), (abreast(3), 2), (abreast(200), 2), (FACING, 2), (BESIDE, 2), (MIXED, 2),
    (CONE_AND_SLOT, 3),
])  # fmt: skip
def test_the_books_close_whatever_the_number_of_nozzles(tmp_path, nozzles, dimensions):
    done = begun(case(nozzles, dimensions), tmp_path)
    while done.time < 0.1:
        done.window()
    summary = done.ledger.summary()
    assert {name: summary[name] for name in CLOSED if not summary[name] < ROUND_OFF} == {}
    came = sum(
        s.mass * (s.speed / s.pitch).sum() * _open(n)
        for s, n in zip(done.grains.source.streams, done.grains.source.nozzles)
    )
    half_layers = 0.5 * sum(s.mass * len(s.speed) for s in done.grains.source.streams)
    assert abs(summary["injected_kg"] - came) <= half_layers * (1.0 + 1e-9)
    assert math.fsum(done.grains.inside.mass) == pytest.approx(summary["injected_kg"] - summary["left_kg"], rel=1e-12)


def _open(nozzle) -> float:
    """Time [s] that a nozzle was open until 0.1 s."""
    return min(nozzle.end or 0.1, 0.1) - nozzle.start


def test_kinds_are_unique():
    """And liquids keep the numbers that files of earlier runs hold."""
    kinds = (particles.GRAIN, particles.WALL, particles.LIQUID, particles.GAS, particles.INFLOW)
    assert len(set(kinds)) == len(kinds) and kinds[:4] == (0, 1, 2, 3)


def test_each_particle_knows_its_nozzle():
    """More nozzles than a byte counts, each with its own temperature."""
    chosen = case({name: n | {"temperature_K": 300.0 + k} for k, (name, n) in enumerate(abreast(300).items())})
    made = Source(chosen, {"temperature"}, 1)
    state = made.fill(particles.empty(0), 0.0, 0.01)
    assert set(state.nozzle) == set(range(1, 301))
    np.testing.assert_array_equal(state.temperature, 299.0 + state.nozzle)
    assert (state.kind == INFLOW).all()


def at(made, nozzle, x, kind=GRAIN, entering=1):
    """One particle of a nozzle at a place on the axis of FACING."""
    state = made.make(np.array([nozzle]), np.array([[x, 0.5]]), np.zeros((1, 2)))
    state.kind[:], state.entering[:] = kind, entering
    return state


@pytest.mark.parametrize(("nozzle", "x", "kind", "entering", "share"), [
    (0, 0.595, GRAIN, 0, 1.0),  # of the other nozzle, at the mouth
    (0, 0.605, GRAIN, 0, 1.0),  # and behind it
    (1, 0.595, GRAIN, 1, 0.75),  # on its way in
    (1, 0.595, GRAIN, 0, 1.0),  # has been in, and comes back
    (1, 0.605, GRAIN, 1, 0.5),  # came in and is pushed back
    (1, 0.605, INFLOW, 1, 0.25),
    (1, 0.4, INFLOW, 1, 1.0),  # will be released
    (0, 0.605, INFLOW, 1, 1.0),
    (1, 0.64, INFLOW, 1, 0.0),
])  # fmt: skip
def test_only_its_own_mouth_matters_to_a_grain(nozzle, x, kind, entering, share):
    made = Source(case(FACING), (), 1)
    assert made.inside(at(made, nozzle, x, kind, entering))[0] == pytest.approx(share, abs=1e-12)


def test_release_lets_go_of_each_at_its_own_mouth():
    made = Source(case(FACING), (), 1)
    rows = [
        at(made, 0, 0.19, INFLOW),
        at(made, 0, 0.201, INFLOW),
        at(made, 1, 0.7, INFLOW),
        at(made, 1, 0.4, INFLOW),
        at(made, 0, 0.605),
    ]
    state = rows[0]
    for row in rows[1:]:
        state = particles.join(state, row)
    made.release(state)
    np.testing.assert_array_equal(state.kind, [INFLOW, GRAIN, INFLOW, GRAIN, GRAIN])
    np.testing.assert_array_equal(state.entering, [1, 1, 1, 0, 0])
    np.testing.assert_allclose(state.u, [0.0, 4.0, 0.0, -4.0, 0.0], atol=1e-12)
    assert made.mass == pytest.approx(state.mass[1] + state.mass[3], rel=1e-12)


def test_what_waits_upstream_is_nowhere_in_the_output(tmp_path):
    chosen = case(FACING, track={"particles": [1, 2]}, run={"end_time_s": 0.02, "output_interval_s": 0.01})
    first = begun(chosen, tmp_path)
    metrics = {key: value for key, value in first.row().items() if key not in {"time_s", *first.limiters.now}}
    assert len(first.state.x) > 0 and metrics and all(math.isnan(value) for value in metrics.values())
    first.gas.close()
    first.ledger.table.close()
    summary = driver.run(chosen, "own", tmp_path / "run", None, Reporter(quiet=True))
    fields = pyvista.read(sorted((tmp_path / "run" / "fields").glob("particles_*.vtp"))[-1])
    ledger = output.read_table(tmp_path / "run" / "ledger.csv")
    assert summary["particles"] == fields.n_points == ledger["particles"][-1] > 0
    assert (fields["kind"] == GRAIN).all() and ((fields.points[:, 0] > 0.2) & (fields.points[:, 0] < 0.6)).all()
    assert summary["injected_kg"] == pytest.approx(math.fsum(fields["mass"]), rel=1e-12)


def test_the_jet_of_each_nozzle_is_told_apart(tmp_path):
    done = begun(case(FACING | {"late": slot([0.4, 0.0], [0.0, 1.0], start_s=1.0)}), tmp_path)
    while done.time < 0.02:
        done.window()
    row = jet.metrics(done)
    assert row["grains"] == len(done.grains.inside.x)
    assert 0.05 < row["left_front_m"] < 0.1 and 0.05 < row["right_front_m"] < 0.1
    assert row["left_core_temperature_K"] > 310.0 and row["right_core_temperature_K"] < 285.0
    assert math.isnan(row["late_front_m"])


def test_jets_without_a_nozzle_are_refused(tmp_path):
    done = begun(case({}, effects=["drag"]), tmp_path)
    with pytest.raises(CaseError, match="'jet', which tells of nozzles"):
        jet.metrics(done)


def test_the_grip_of_the_gas_is_of_the_grains_in_it(tmp_path):
    """What waits upstream is not held by the gas, and does not weaken the mean."""
    done = begun(case(FACING), tmp_path)
    while done.time < 0.03:
        done.window()
    handed = done.hand(1e-3)
    lone = particles.grains(done.state)
    alone = handed.damping[done.state.kind == GRAIN]
    assert done.exchange.grip(done.state, handed.damping) == pytest.approx(done.exchange.grip(lone, alone), rel=1e-12)


@pytest.mark.parametrize(("times", "words"), [
    ({"start_s": 0.2, "end_s": 0.2}, "its end must come after its start"),
    ({"start_s": 0.2, "end_s": 0.1}, "its end must come after its start"),
    ({"end_s": 2e-3}, "its grains go 8 mm, less than half of resolution.spacing_mm = 20"),
])  # fmt: skip
def test_a_nozzle_that_gives_nothing_is_refused(tmp_path, times, words):
    with pytest.raises(CaseError, match=words):
        begun(case({"one": slot([0.0, 0.5], [1.0, 0.0], **times)}), tmp_path)
