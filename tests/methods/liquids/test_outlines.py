"""Tanks in the plane with any outline: where the wall is, liquid at rest in one, and a baffled one that moves."""

import numpy as np
import pytest

from sdph.case import read as cases
from sdph.effects.around import tank
from sdph.engine.state import LIQUID, WALL
from sdph.engine.walls import shapes
from sdph.engine.walls.outline import Outline, outline
from sdph.methods.liquids import start
from sdph.running.alone import Alone
from sdph.schema import CaseError

G, SPACING = 9.81, 0.02  # m/s2, m
# a tank of 1 x 0.6 m with a plate that stands in the middle of its floor
PLATE = [[0.0, 0.0], [0.48, 0.0], [0.48, 0.2], [0.52, 0.2], [0.52, 0.0], [1.0, 0.0], [1.0, 0.6], [0.0, 0.6]]
BOX = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.6], [0.0, 0.6]]


def table(corners=PLATE, **sections) -> dict:
    return {
        "title": "baffle", "dimensions": 2,
        "effects": ["gravity", "frame", "density_diffusion", "laminar_viscosity", "liquid_damping", "tank"],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [1.0, 0.6], "gravity_m_s2": [0.0, -G]},
        "resolution": {"spacing_mm": 1e3 * SPACING},
        "liquid": {"density_kg_m3": 1000.0, "viscosity_Pa_s": 1.0, "sound_speed_m_s": 25.0},
        "tank": {"shape": "outline", "corners_m": corners},
        "frame": {"shake": [[0, 0.05, 8.0, 0.0]], "start_s": 0.5},
        "pools": {"water": {"shape": "tank", "fill": 0.5}},
    } | sections  # fmt: skip


def gone(case, end: float) -> Alone:
    run = Alone(case, None)
    run.start()
    while run.time < end:
        run.window()
    return run


def test_a_box_by_its_corners_is_the_box():
    own, box = outline("corners_m", tuple(map(tuple, BOX))), shapes.Box(np.zeros(2), np.array([1.0, 0.6]))
    points = np.random.default_rng(1).uniform([-0.5, -0.5], [1.5, 1.1], (1000, 2))
    assert np.allclose(own.distance(points), box.distance(points), atol=1e-15)
    assert own.volume == pytest.approx(box.volume) and own.furthest(np.array([0.6, 0.8])) == pytest.approx(1.08)
    for depth in (0.01, 0.03):
        places = own.shell(depth, SPACING)
        assert np.allclose(box.distance(places), depth, rtol=1e-9)
        side = places[(places[:, 1] < 0.0) & (places[:, 0] > 0.0) & (places[:, 0] < 1.0)]
        assert np.allclose(np.sort(side[:, 0]), 0.01 + 0.02 * np.arange(50))  # the lattice of the liquid, mirrored


def test_corners_may_go_either_way_around():
    one, other = (outline("corners_m", tuple(map(tuple, each))) for each in (PLATE, PLATE[::-1]))
    assert one.volume == pytest.approx(0.6 - 0.04 * 0.2) and other.volume == pytest.approx(one.volume)
    assert np.allclose(one.distance(np.array([[0.5, 0.1], [0.5, 0.3], [0.3, 0.1]])), [0.02, -0.1, -0.1])


@pytest.mark.parametrize(
    ("corners", "word"),
    [
        ([[0.0, 0.0], [1.0, 0.0]], "3 at least"),
        ([0.0, 0.0, 1.0], "3 at least"),
        ([[0.0, 0.0], [1.0, 0.6], [1.0, 0.0], [0.0, 0.6]], "meets that"),
        ([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.6]], "no length"),
        ([[0.0, 0.0], [0.49, 0.0], [0.49, 0.2], [0.51, 0.2], [0.51, 0.0], *PLATE[5:]], "thinner than two spacings"),
        (None, "needs tank.corners_m"),
    ],
)
def test_what_is_no_outline_is_refused_in_a_line(corners, word):
    own = {"shape": "outline"} | ({"corners_m": corners} if corners else {})
    with pytest.raises(CaseError, match=word) as error:
        tank.shape_of(cases.from_table(table(tank=own)))
    assert "\n" not in str(error.value)


def test_a_baffled_tank_moves_with_its_liquid():
    """At rest the tank carries the weight of the liquid; shaken, the plate is hit, nothing goes through, and what the
    walls give is what the liquid gets."""
    case = cases.from_table(table(run={"end_time_s": 1.0, "output_interval_s": 1.0, "forces": ["baffle"]}, parts={
        "baffle": {"lower_m": [0.47, -0.01], "upper_m": [0.53, 0.21]},
    }))  # fmt: skip
    shape, run = tank.shape_of(case), gone(case, 0.5)
    assert isinstance(shape, Outline)
    s = run.state
    weight = G * s.mass[s.kind == LIQUID].sum()
    assert weight == pytest.approx(0.5 * 1000.0 * G * (0.6 - 0.04 * 0.2), rel=0.01)
    held = -run.ledger.impulses[1, 1] / 0.5
    print("weight, held", weight, held, "fastest", np.hypot(s.u, s.v)[s.kind == LIQUID].max())
    assert abs(held + weight) < 0.02 * weight
    left = s.mass[(s.kind == LIQUID) & (s.x < 0.5)].sum()
    while run.time < 1.0:
        run.window()
    s, told = run.state, run.ledger.summary()
    places = np.stack([s.x, s.y], axis=1)[s.kind == LIQUID]
    print("deepest in the wall", shape.distance(places).max() / SPACING, told["momentum_drift_rel"])
    assert shape.distance(places).max() < 0.0 and (s.kind == WALL).any()
    assert told["momentum_drift_rel"] < 1e-12 and told["energy_made_rel"] < 0.05
    assert abs(s.mass[(s.kind == LIQUID) & (s.x < 0.5)].sum() - left) > 0.02 * left  # it went over the plate


# a channel with a weir in it, that liquid comes into through its left wall and leaves where it is open
WEIR = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.1], [0.48, 0.1], [0.48, 0.0], [0.8, 0.0], [0.8, 0.4], [0.0, 0.4]]


def channel(corners=WEIR, open_sides=("right", "top")) -> dict:
    mouth = {"shape": "slot", "centre_m": [0.0, 0.1], "direction": [1.0, 0.0], "width_m": 0.2, "speed_m_s": 0.8}
    own = table(
        effects=["gravity", "density_diffusion", "liquid_damping", "tank", "inflow", "outflow"],
        domain={"size_m": [0.8, 0.4], "gravity_m_s2": [0.0, -G]}, nozzles={"mouth": mouth},
        tank={"shape": "outline", "corners_m": corners, "open_sides": list(open_sides)},
        pools={"pond": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.4, 0.2]}},
        parts={"weir": {"lower_m": [0.4, 0.02], "upper_m": [0.4, 0.1]}},
        run={"end_time_s": 1.0, "output_interval_s": 1.0, "forces": ["weir"]},
    )  # fmt: skip
    del own["frame"]
    return own


def test_an_open_side_of_an_outline_has_no_wall():
    """But for rounded corners behind the left wall they are those of the box with the same open sides."""
    flat = channel([[0.0, 0.0], [0.8, 0.0], [0.8, 0.4], [0.0, 0.4]])
    box = flat | {
        "tank": {"open_sides": ["right", "top"]},
        "parts": {},
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    }
    one, other = (start.fill(cases.from_table(each)) for each in (flat, box))
    places = [
        {(round(x, 9), round(y, 9)) for x, y, kind in zip(s.x, s.y, s.kind) if kind == WALL and max(x, y) > 0.0}
        for s in (one, other)
    ]
    assert places[0] == places[1] and max(x for x, _ in places[0]) < 0.8


def test_liquid_flows_over_a_weir():
    run = gone(cases.from_table(channel()), 0.5)
    told, s = run.ledger.summary(), run.state
    assert told["injected_kg"] == pytest.approx(1000.0 * 0.8 * 0.2 * 0.5, abs=0.5001 * 1000.0 * 0.2 * SPACING)
    assert told["left_kg"] > 1.0 and told["mass_drift_rel"] < 1e-13 and told["momentum_drift_rel"] < 1e-12
    over = (s.kind == LIQUID) & (s.x > 0.4) & (s.x < 0.48)
    assert over.any() and s.y[over].min() > 0.1
    assert run.row()["weir_liquid_pressure_force_x_N"] > 0.0


def test_an_open_side_needs_a_side_there():
    """Two sides in the one do not stand for one in the other."""
    inward = [[x - 0.02 * (x == 0.8), y] for x, y in WEIR]
    inward[7:7] = [[0.4, 0.4]]
    with pytest.raises(CaseError, match=r"each needs a side of tank\.corners_m"):
        tank.shape_of(cases.from_table(channel(inward)))
