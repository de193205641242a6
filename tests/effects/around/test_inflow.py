"""Nozzles: mass-exact, without a seam, in two and three dimensions; what leaves is counted."""

import math

import numpy as np
import pytest
from builders import simulation
from grain_boxes import Row
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph.case import read as cases
from sdph.effects.around import inflow
from sdph.effects.around.source import Source
from sdph.engine import state as particles
from sdph.engine.state import GRAIN, INFLOW
from sdph.running import output
from sdph.schema import CaseError

AIR = {
    "density_kg_m3": 1.2,
    "viscosity_Pa_s": 1.8e-5,
    "conductivity_W_m_K": 0.025,
    "heat_capacity_J_kg_K": 1006.0,
    "temperature_K": 300.0,
}
SAND = {"density_kg_m3": 700.0, "diameter_mm": 1.0, "heat_capacity_J_kg_K": 2000.0, "conductivity_W_m_K": 1.0}
SLOT = {
    "shape": "slot",
    "centre_m": [0.0, 0.5],
    "width_m": 0.2,
    "direction": [1.0, 0.0],
    "speed_m_s": 2.0,
    "volume_fraction": 0.3,
    "temperature_K": 290.0,
}
CONE = {
    "shape": "cone", "centre_m": [0.5, 0.5, 0.0], "radius_m": 0.11, "direction": [0.0, 0.0, 1.0], "speed_m_s": 2.0,
    "rate_kg_s": 3.0, "half_angle_deg": 30.0, "temperature_K": 290.0,
}  # fmt: skip


def case(nozzle, dimensions=2, **more):
    return cases.from_table({
        "title": "", "scene": "", "dimensions": dimensions, "effects": ["inflow", "outflow", "granular_pressure"],
        "run": {"end_time_s": 0.3, "output_interval_s": 0.3}, "coupling": {"window_largest_s": 0.01},
        "domain": {"size_m": [1.0] * dimensions, "gravity_m_s2": [0.0] * dimensions},
        "resolution": {"spacing_mm": 20.0, "cell_mm": 100.0}, "gas": AIR, "grains": SAND,
        "boundaries": {"sides": {"kind": "pressure_outlet", "pressure_Pa": 0.0}}, "nozzles": {"one": nozzle},
    } | more)  # fmt: skip


def source(chosen):
    names = {"temperature", "diameter", "diameter_variance"}
    return Source(chosen, names, 1), particles.empty(0, names, chosen.dimensions)


def drift(chosen, until, dt):
    """Streams that feel nothing: the state at `until` [s], in steps of `dt` [s]."""
    made, state = source(chosen)
    time = 0.0
    while time < until * (1.0 - 1e-12):
        step = min(dt, until - time)
        state = made.fill(state, time, step)
        for place, speed in zip(particles.axes(state), (state.u, state.v, state.w)):
            place += speed * step
        made.release(state)
        time += step
    return made, state


@settings(max_examples=12)
@given(dt=st.floats(1e-3, 0.05), speed=st.floats(0.5, 5.0), until=st.floats(0.05, 0.4))
def test_mass_is_rate_times_time_whatever_the_step(dt, speed, until):
    """Within half a layer, and the same in any steps; energy and momentum go with it."""
    chosen = case(SLOT | {"speed_m_s": speed})
    made, state = drift(chosen, until, dt)
    rate = 0.3 * 700.0 * 0.2 * speed
    layer = 0.3 * 700.0 * 0.2 * 0.02
    assert abs(made.mass - rate * until) <= 0.5 * layer * (1.0 + 1e-9)
    assert made.energy == pytest.approx(made.mass * 290.0 * 2000.0, rel=1e-12)
    assert made.momentum[0] == pytest.approx(made.mass * speed, rel=1e-12)
    assert made.mass == pytest.approx(state.mass[state.kind == GRAIN].sum(), rel=1e-12)
    assert len(np.unique(state.ident)) == len(state.ident)


def test_gas_is_displaced_at_an_even_rate():
    """The volume that is in the gas grows as the rate times time at every instant, not layer by layer."""
    chosen = case(SLOT)
    made, state = source(chosen)
    state = made.fill(state, 0.0, 0.1)
    volumes = [(state.mass * made.inside(state, after)).sum() / 700.0 for after in np.linspace(0.0, 0.1, 23)]
    np.testing.assert_allclose(volumes, 0.3 * 0.2 * 2.0 * np.linspace(0.0, 0.1, 23), atol=1e-12)


@pytest.mark.parametrize(("nozzle", "dimensions"), [
    (SLOT, 2),
    ({**SLOT, "centre_m": [0.5, 0.5, 0.0], "direction": [0.0, 0.0, 1.0], "length_m": 0.3}, 3),
    ({**CONE, "shape": "disc", "half_angle_deg": 0.0}, 3),
])  # fmt: skip
def test_no_seam_at_the_mouth(tmp_path, nozzle, dimensions):
    """Density by summation within 2 % of the set value in the heart of the stream, on both sides of the mouth."""
    done = simulation(case(nozzle, dimensions), tmp_path, cells=(4,) * dimensions)
    while done.time < 0.15:
        done.window()
    streams = done.grains.source.streams[0]
    along, aside = done.grains.source._beyond(0, particles.positions(done.state))
    heart = (np.abs(along) < 0.06) & (aside < streams.pitch * 1.5)
    assert heart.sum() > 8 and (along[heart] > 0.0).any() and (along[heart] < 0.0).any()
    np.testing.assert_allclose(done.state.density[heart], streams.alpha_p * 700.0, rtol=0.02)


def test_what_came_in_just_now_is_tracked_too(tmp_path):
    """The heat rates of a row are those of the last window, in which a newcomer had none."""
    done = simulation(case(SLOT, track={"particles": [1]}), tmp_path, cells=(4, 4))
    first = int(done.state.ident.max(initial=0))
    while done.state.ident.max() == first:
        done.window()
    assert done.row()["particle_1_convective_heat_W"] == 0.0  # no heat exchange here


def test_cone_spreads_to_its_angle_and_keeps_its_rate():
    chosen = case(CONE, 3)
    made, state = drift(chosen, 0.1, 0.004)
    out = state.kind == GRAIN
    velocity = particles.velocities(state)[out]
    np.testing.assert_allclose(np.linalg.norm(velocity, axis=1), 2.0, rtol=1e-12)
    angle = np.degrees(np.arccos(velocity[:, 2] / 2.0))
    assert 24.0 < angle.max() <= 30.0 + 1e-9 and angle.min() < 8.0
    assert made.mass == pytest.approx(3.0 * 0.1, rel=0.15)  # half a layer of 0.02 m in 0.2 m
    rate = sum(s.mass * (s.speed / s.pitch).sum() for s in made.streams)
    assert rate == pytest.approx(3.0, rel=1e-12)


def test_parabolic_profile_has_the_mean_speed_and_the_rate():
    streams = inflow.streams_of(
        case(SLOT | {"profile": "parabolic"}), case(SLOT | {"profile": "parabolic"}).nozzles["one"]
    )
    assert streams.speed.mean() == pytest.approx(2.0, rel=1e-12)
    # 3/2 of the mean, 0 at the rim
    assert streams.speed.max() == pytest.approx(3.0, rel=0.02) and streams.speed.min() < 0.6
    assert (streams.mass * streams.speed / streams.pitch).sum() == pytest.approx(0.3 * 700.0 * 0.2 * 2.0, rel=1e-12)


def test_a_nozzle_opens_and_closes():
    made, state = drift(case(SLOT | {"start_s": 0.1, "end_s": 0.2}), 0.4, 0.01)
    assert made.mass == pytest.approx(0.3 * 700.0 * 0.2 * 2.0 * 0.1, rel=1e-12)
    assert not (state.kind >= INFLOW).any()


def test_what_leaves_is_counted_and_taken_out(tmp_path):
    """Grains fly through the box and out of it: mass in = mass there + mass out, to the last bit of the sum."""
    done = simulation(case(SLOT | {"speed_m_s": 8.0}), tmp_path, cells=(4, 4))
    while done.time < 0.3:
        done.window()
    summary = done.ledger.summary()
    assert summary["left_kg"] > 0.2 * summary["injected_kg"]
    assert summary["particle_mass_drift_rel"] <= 1e-12
    inside = particles.positions(done.grains.inside)
    assert (inside[:, 0] <= 1.0).all()
    assert math.fsum(done.grains.inside.mass) == pytest.approx(summary["injected_kg"] - summary["left_kg"], rel=1e-12)
    gone = recorded(done, tmp_path)
    assert gone["mass_kg"].sum() == pytest.approx(summary["left_kg"], rel=1e-12)
    assert (gone["x_m"] > 1.0).all() and (gone["x_m"] < 1.0 + 0.01 * gone["velocity_x_m_s"].max()).all()
    told = done.outlet.summary()
    assert told["outflow_count"] == pytest.approx(summary["left_kg"] / (700.0 * math.pi / 6.0 * 1e-9), rel=1e-9)
    assert told["outflow_particles"] == len(gone["time_s"]) and told["outflow_D32_m"] == pytest.approx(1e-3)


def recorded(done, folder):
    """Columns of outflow.csv; a particle is not there again."""
    done.outlet.table.flush()
    gone = output.read_table(folder / "outflow.csv")
    assert (
        len(set(gone["particle"])) == len(gone["particle"]) and set(gone["particle"]) & set(done.state.ident) == set()
    )
    return gone


def test_a_record_of_nothing_names_its_columns(tmp_path):
    done = simulation(case(SLOT), tmp_path, cells=(4, 4))
    assert list(recorded(done, tmp_path)) == [
        "time_s", "particle", "outlet", "nozzle", "residence_s", "x_m", "y_m", "velocity_x_m_s", "velocity_y_m_s",
        "mass_kg", "diameter_m", "diameter_std_m", "count",
    ]  # fmt: skip
    assert math.isnan(done.outlet.summary()["outflow_D10_m"])


def test_what_waits_and_comes_in_closes_the_balances_of_motion(tmp_path):
    """Layers let go in the middle of windows, under gravity, drag and pressure of the gas: to round-off."""
    effects = ["inflow", "outflow", "granular_pressure", "gravity", "drag", "gas_pressure"]
    domain = {"size_m": [1.0, 1.0], "gravity_m_s2": [3.0, -9.81]}
    chosen = case(SLOT | {"speed_m_s": 8.0}, effects=effects, domain=domain)
    done = simulation(chosen, tmp_path, 4, lambda own, cells: Row(own, cells, gradient=(-4e3, 7e3, 0.0)))
    while done.time < 0.3:
        done.window()
    done.ledger.table.close()
    rows, sums = output.read_table(tmp_path / "ledger.csv"), done.ledger.sums
    assert done.ledger.summary()["motion_drift_rel"] < 1e-12
    given = ("to_particles", "of_body_forces", "of_walls", "of_inflow", "of_outflow", "of_contact")
    for a in "xy":
        change = np.diff(rows[f"particle_momentum_{a}_kg_m_s"][[0, -1]])[0]
        impulses = [sums[f"impulse_{name}_{a}_kg_m_s"] for name in given]
        assert change == pytest.approx(math.fsum(impulses), abs=1e-12 * sum(map(abs, impulses)))
    acted = ("work_of_inflow_J", "work_of_drag_J", "work_of_pressure_J", "bounds_work_J")
    assert all(sums[name] != 0.0 for name in acted)


@pytest.mark.parametrize(("change", "words"), [
    ({"volume_fraction": None}, "either volume_fraction or rate_kg_s"),
    ({"rate_kg_s": 1.0}, "either volume_fraction or rate_kg_s"),
    ({"volume_fraction": 0.9}, "packing_limit"),
    ({"width_m": None}, "width_m is missing"),
    ({"half_angle_deg": 10.0}, "half_angle_deg is of a cone"),
    ({"direction": [1.0, 0.0, 0.0]}, "components"),
    ({"radius_m": 0.1}, "radius_m is of disc, cone, annulus, table; shape = 'slot': leave it out"),
    ({"table_from_s": 0.1}, "table_from_s is of table"),
    ({"record_set": ["run.end_time_s=1.0"]}, "record_set is of table"),
    ({"seed": 3}, "seed is of annulus, table"),
])  # fmt: skip
def test_a_nozzle_that_cannot_be_says_so(tmp_path, change, words):
    nozzle = {key: value for key, value in (SLOT | change).items() if value is not None}
    with pytest.raises(CaseError, match=words):
        simulation(case(nozzle), tmp_path)
