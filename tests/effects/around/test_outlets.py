"""What grains left through: outlets by their names, sides as such, each with the sizes of what went there."""

import numpy as np
import pytest
from builders import simulation
from test_inflow import SLOT, case, recorded

from sdph.effects.around import outflow
from sdph.engine.state import GRAIN
from sdph.schema import CaseError

LOW = SLOT | {"speed_m_s": 8.0, "centre_m": [0.0, 0.4], "diameter_mm": 1.0}  # both from the left to the right
HIGH = LOW | {"centre_m": [0.0, 0.85], "diameter_mm": 2.0}
OUTLET = {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 300.0, "side": "right"}


def run(folder, span):
    """Two streams to the right, through the outlet where it is, else through the side."""
    more = {"nozzles": {"low": LOW, "high": HIGH}, "boundaries": {"chimney": OUTLET | {"span_m": span}}}
    done = simulation(case(SLOT, **more), folder, cells=(4, 4))
    while done.time < 0.2:
        done.window()
    return done


def test_each_outlet_has_its_own(tmp_path):
    done = run(tmp_path, [0.0, 0.6])
    gone, told = recorded(done, tmp_path), done.outlet.summary()
    low = gone["y_m"] < 0.6
    assert set(gone["outlet"][low]) == {"chimney"} and set(gone["outlet"][~low]) == {"right_side"}
    assert told["outflow_chimney_D10_m"] == pytest.approx(1e-3)
    assert told["outflow_right_side_D32_m"] == pytest.approx(2e-3)
    counts = [told[f"outflow_{name}_count"] for name in ("chimney", "right_side")]
    assert sum(counts) == pytest.approx(told["outflow_count"], rel=1e-12) and min(counts) > 0.0
    assert counts[0] == pytest.approx(gone["count"][low].sum(), rel=1e-12)
    assert 1e-3 < told["outflow_D10_m"] < 2e-3 and "outflow_left_side_count" not in told


def test_who_misses_an_outlet_leaves_by_its_side(tmp_path):
    done = run(tmp_path, [0.3, 0.4])
    gone = recorded(done, tmp_path)
    within = (gone["y_m"] >= 0.3) & (gone["y_m"] <= 0.4)
    assert within.any() and all((gone["outlet"] == "chimney") == within)
    assert outflow.exits(done.case) == ["chimney", "left_side", "right_side", "bottom_side", "top_side"]


def test_where_all_leave_by_one_it_is_not_told_twice(tmp_path):
    done = simulation(case(LOW), tmp_path, cells=(4, 4))
    while done.time < 0.3:
        done.window()
    assert not [key for key in done.outlet.summary() if "_side" in key]


def test_what_comes_in_beside_the_domain_has_not_left(tmp_path):
    """The mouth of a nozzle that leans lies with one half outside: all of its stream comes in, and crosses."""
    done = simulation(case(LOW | {"direction": [1.0, -0.3], "speed_m_s": 4.0}), tmp_path, cells=(4, 4))
    while done.time < 0.1:
        done.window()
    inside = done.state.kind == GRAIN
    assert inside.sum() > 10 and done.outlet.summary().get("outflow_count", 0.0) == 0.0
    assert done.ledger.sums["injected_kg"] == pytest.approx(done.state.mass[inside].sum(), rel=1e-12)


def test_an_outlet_that_is_all_that_is_left_over_lets_grains_go():
    """Walls by their sides, and an outlet without one: what is beyond the right side is gone, beyond the floor not."""
    walls = {f"{side}_wall": {"kind": "wall", "side": side} for side in ("left", "bottom", "top")}
    rest = {"rest": {name: value for name, value in OUTLET.items() if name != "side"}}
    for boundaries, free in ((walls | rest, True), (walls, False)):
        box = case(SLOT, boundaries=boundaries, effects=["inflow", "outflow", "drag", "walls"])
        for axis, (side, across) in enumerate((("right", 0), ("bottom", 1))):
            place = [np.array([0.5]), np.array([0.5]), np.zeros(1)]
            place[across][:] = 1.2 if axis == 0 else -0.2
            assert outflow._open(box, side, across, place[:2])[0] == (free and side == "right")


def plate(catches, **more):
    """A stream down on a plate with an outlet beside it, between walls."""
    down = LOW | {"centre_m": [0.4, 0.5], "direction": [0.0, -1.0], "speed_m_s": 5.0, "diameter_mm": 1.0}
    boundaries = {
        "plate": {"kind": "wall", "side": "bottom", "span_m": [0.0, 0.8], "catches": catches},
        "drain": OUTLET | {"side": "bottom", "span_m": [0.8, 1.0]},
        "walls": {"kind": "wall"},
    }
    return case(down, boundaries=boundaries, effects=["inflow", "outflow", "granular_pressure", "walls"], **more)


@pytest.mark.parametrize("catches", [True, False])
def test_a_wall_that_catches_takes_what_reaches_it(tmp_path, catches):
    done = simulation(plate(catches), tmp_path, cells=(4, 4))
    while done.time < 0.2:
        done.window()
    gone, told = recorded(done, tmp_path), done.outlet.summary()
    inside = done.state.kind == GRAIN
    came, kept = done.ledger.sums["injected_kg"], done.state.mass[inside].sum()
    assert came == pytest.approx(kept + done.ledger.sums["left_kg"], rel=1e-12)
    if not catches:
        assert not len(gone["time_s"]) and kept == pytest.approx(came, rel=1e-12)
        return
    assert set(gone["outlet"]) == {"plate"} and done.ledger.sums["left_kg"] > 0.3 * came
    assert (
        (gone["y_m"] < 0.0).all() and (np.abs(gone["x_m"] - 0.4) < 0.2).all() and (gone["velocity_y_m_s"] < 0.0).all()
    )
    assert "outflow_plate_kg" not in told  # all left by one


def test_what_leaves_by_each_of_several_is_told_in_kilograms(tmp_path):
    done = run(tmp_path, [0.0, 0.6])
    gone, told = recorded(done, tmp_path), done.outlet.summary()
    for name in ("chimney", "right_side"):
        assert told[f"outflow_{name}_kg"] == pytest.approx(gone["mass_kg"][gone["outlet"] == name].sum(), rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "effects"),
    [
        ("wall", ["inflow", "outflow"]),
        ("wall", ["inflow", "walls"]),
        ("pressure_outlet", ["inflow", "outflow", "walls"]),
    ],
)
def test_only_a_wall_with_its_effects_catches(kind, effects):
    rest = {"pressure_Pa": 0.0} if kind == "pressure_outlet" else {}
    with pytest.raises(CaseError, match="catches is of a wall"):
        case(LOW, boundaries={"plate": {"kind": kind, "side": "bottom", "catches": True, **rest}}, effects=effects)
