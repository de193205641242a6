"""Nozzles and open sides of liquids: a stream is not disturbed, a closed nozzle is a wall, what passes is counted."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.engine.state import INFLOW, LIQUID, WALL
from sdph.methods.liquids import openings, start
from sdph.running.alone import Alone
from sdph.schema import CaseError
from sdph.study.explain import tables

RHO, U, DX = 1000.0, 2.0, 0.02
MOUTH = {"shape": "slot", "centre_m": [0.0, 0.2], "direction": [1.0, 0.0], "width_m": 0.2, "speed_m_s": U}
STREAM = {
    "dimensions": 2, "effects": ["density_diffusion", "liquid_damping", "inflow", "outflow"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0}, "domain": {"size_m": [0.4, 0.4], "gravity_m_s2": [0.0, 0.0]},
    "resolution": {"spacing_mm": 1e3 * DX}, "liquid": {"density_kg_m3": RHO, "sound_speed_m_s": 20.0},
    "nozzles": {"mouth": MOUTH},
    "pools": {"start": {"shape": "box", "lower_m": [0.0, 0.1], "upper_m": [0.1, 0.3], "velocity_m_s": [U, 0.0]}},
}  # fmt: skip
# a tank whose nozzle, under water, opens late or never
FULL = STREAM | {
    "effects": ["gravity", "density_diffusion", "liquid_damping", "tank", "inflow"],
    "domain": {"size_m": [0.4, 0.8], "gravity_m_s2": [0.0, -9.81]}, "tank": {"open_sides": ["top"]},
    "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.4, 0.4]}},
}  # fmt: skip


def gone(folder, table, end) -> Alone:
    run = Alone(cases.from_table(table), folder / "ledger.csv")
    run.start()
    while run.time < end:
        run.window()
    return run


@pytest.mark.parametrize("turned", [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])
def test_a_free_stream_goes_on_as_it_is(tmp_path, turned):
    """Whatever its direction: nothing acts on it, and what came in less what left is what is there."""
    x, y = turned
    centre = np.array([0.2, 0.2]) - 0.2 * np.array(turned)
    corners = np.sort([centre - 0.1 * np.array([y, x]), centre + 0.1 * np.array([x, y]) + 0.1 * np.array([y, x])], 0)
    table = STREAM | {
        "nozzles": {"mouth": MOUTH | {"centre_m": list(centre), "direction": [x, y]}},
        "pools": {
            "start": {"shape": "box", "lower_m": list(corners[0]), "upper_m": list(corners[1]),
            "velocity_m_s": [U * x, U * y]},
        },
    }  # fmt: skip
    run = gone(tmp_path, table, 0.5)
    velocity = particles.velocities(run.state)[run.stepper.active]
    np.testing.assert_allclose(velocity @ [x, y, 0.0], U, rtol=1e-9)
    told = run.ledger.summary()
    assert told["injected_kg"] == pytest.approx(RHO * U * 0.2 * run.time, abs=0.5001 * RHO * 0.2 * DX)
    assert told["left_kg"] > 0.0
    assert told["mass_drift_rel"] < 1e-14
    assert told["momentum_drift_rel"] < 1e-12


def test_a_nozzle_that_is_closed_is_a_wall(tmp_path):
    """Water above it stays at rest, and presses on it as on a wall."""
    closed = MOUTH | {"start_s": 10.0}
    run = gone(tmp_path, FULL | {"nozzles": {"mouth": closed}}, 0.3)
    waiting = run.stepper.waiting
    assert len(waiting)
    np.testing.assert_array_equal(particles.velocities(run.state)[waiting], 0.0)
    force, _, power = openings.given(run.stepper, 0.0)
    by_depth = RHO * 9.81 * 0.2 * 0.2  # of the mouth, on the liquid
    print("force of a closed mouth over rho g H A:", force[0] / by_depth)
    assert force[0] == pytest.approx(by_depth, rel=0.05)
    assert abs(power) < 1e-2 * by_depth * np.sqrt(9.81 * 0.4)
    assert run.row()["fastest_m_s"] < 0.05 * np.sqrt(9.81 * 0.4)  # as hydrostatic_tank begins; no jet through the hole
    assert run.ledger.sums["injected_kg"] == 0.0


def test_a_tank_is_filled_while_its_nozzle_is_open(tmp_path):
    opened = MOUTH | {"start_s": 0.1, "end_s": 0.2, "speed_m_s": 0.5, "centre_m": [0.0, 0.1]}
    run = gone(tmp_path, FULL | {"nozzles": {"mouth": opened}}, 0.3)
    told = run.ledger.summary()
    assert told["injected_kg"] == pytest.approx(RHO * 0.5 * 0.2 * 0.1, abs=0.5001 * RHO * 0.2 * DX)
    assert told["mass_drift_rel"] < 1e-14
    assert told["momentum_drift_rel"] < 1e-12
    assert told["work_of_inflow_J"] > 0.0
    assert not (particles.velocities(run.state)[run.stepper.waiting] != 0.0).any()


def test_an_empty_tank_is_filled(tmp_path):
    """Nothing is in it at first; the estimates count what comes in."""
    opened = MOUTH | {"end_s": 0.1, "speed_m_s": 1.0, "centre_m": [0.0, 0.3]}
    table = FULL | {"nozzles": {"mouth": opened}, "pools": {}}
    run = gone(tmp_path, table, 0.4)
    told, inside = run.ledger.summary(), run.state.kind == LIQUID
    assert told["injected_kg"] == pytest.approx(RHO * 1.0 * 0.2 * 0.1, abs=0.5001 * RHO * 0.2 * DX)
    assert told["mass_drift_rel"] < 1e-14 and told["momentum_drift_rel"] < 1e-12
    assert run.state.y[inside].min() > 0.0 and run.state.y[inside].mean() < 0.2
    rows = {row["what"]: row["value"] for row in tables.explain(cases.from_table(table))["expected"]}
    assert rows["liquid particles"] == 50


def test_walls_are_open_at_the_mouth_alone(tmp_path):
    run = Alone(cases.from_table(FULL), tmp_path / "ledger.csv")
    places, kind = particles.positions(run.state), run.state.kind
    behind = (kind == WALL) & (places[:, 0] < 0.0)
    assert not (behind & (np.abs(places[:, 1] - 0.2) < 0.1)).any()
    assert (behind & (places[:, 1] > 0.3)).any() and (behind & (places[:, 1] < 0.1)).any()
    assert ((kind == INFLOW) == ((places[:, 0] < 0.0) & (kind != WALL))).all()
    assert (kind == LIQUID).sum() == 20 * 20


AIR = {"phase": "gas", "shape": "tank", "fill": 1.0}


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"nozzles": {"mouth": MOUTH | {"temperature_K": 300.0}}}, "temperature is of grains"),
        ({"nozzles": {"mouth": MOUTH | {"volume_fraction": 0.5}}}, "volume_fraction is of grains"),
        ({"nozzles": {}}, "needs a nozzle"),
        ({"effects": [*FULL["effects"], "outflow"], "tank": {}}, "open_sides"),
        ({"gas_phase": {"density_kg_m3": 1.0}, "pools": FULL["pools"] | {"air": AIR}}, "one phase"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, given, told):
    with pytest.raises(CaseError, match=told):
        Alone(cases.from_table(FULL | given), tmp_path / "ledger.csv")


@pytest.mark.parametrize(
    ("size", "floor", "sides"), [(0.5, 0.0, {(0, 1), (1, 1)}), (1.3, 0.3, {(0, 1), (1, 0), (1, 1)})]
)
def test_liquid_leaves_where_no_wall_stands(size, floor, sides):
    from sdph.effects.around import outflow

    case = cases.load(
        scenes.HERE / "free_overfall" / "case.toml",
        (f"domain.size_m=[{size}, 0.5]", f"tank.lower_m=[0.0, {floor}]", f"tank.upper_m=[{min(size, 1.0)}, 0.5]"),
    )
    assert set(outflow.open_sides(case)) == sides


def test_a_stream_that_waits_in_a_pool_has_its_place_for_itself():
    """A lance under water: no two particles stand on each other, the pool gives way, and the run tells it."""
    lance = MOUTH | {"centre_m": [0.2, 0.2], "direction": [0.0, -1.0], "width_m": 0.08}
    table = FULL | {"nozzles": {"mouth": lance}}
    run = Alone(cases.from_table(table), None)
    s = run.method.stepper.state
    waits = s.kind == INFLOW
    places = np.column_stack([s.x, s.y])
    away, _ = cKDTree(places[waits]).query(places[~waits])
    assert away.min() >= 0.75 * DX
    (told,) = run.method.warnings()
    assert told.startswith(f"{run.method.stepper.openings.displaced} particles of pools stood where streams wait")
    assert run.method.stepper.openings.displaced >= waits.sum() / 2


@pytest.mark.parametrize("spacings", [20, 21])
@pytest.mark.parametrize("mouth", [
    {"shape": "slot", "width_m": 0.06, "length_m": 0.06}, {"shape": "disc", "radius_m": 0.03},
])  # fmt: skip
def test_no_wall_stands_in_a_mouth_wherever_its_lattice_lies(spacings, mouth):
    """In space the wall's particles may stand on the corners between streams."""
    size = 0.01 * spacings
    roof = MOUTH | {"centre_m": [size / 2, size / 2, size], "direction": [0.0, 0.0, -1.0]} | mouth
    if "radius_m" in mouth:
        del roof["width_m"]
    table = FULL | {
        "dimensions": 3, "domain": {"size_m": 3 * [size], "gravity_m_s2": [0.0, 0.0, -9.81]}, "tank": {},
        "resolution": {"spacing_mm": 10.0}, "nozzles": {"mouth": roof},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0, 0.0], "upper_m": [size, size, 0.05]}},
    }  # fmt: skip
    s = start.fill(cases.from_table(table))
    over = (s.kind == WALL) & (s.z > size)
    across = np.column_stack([s.x, s.y])[over] - size / 2
    wide = 0.03 * (1.0 + 1e-6)
    in_mouth = (np.abs(across) <= wide).all(axis=1) if "width_m" in mouth else np.hypot(*across.T) <= wide
    assert over.sum() > 300 and not in_mouth.any()
