"""A tank filled by `fill`: its volume, its level, the first peak of its pressure; tilted, shaken, with a pipe, under a
gas."""

import math

import numpy as np
import pytest
from test_tank_shapes import mesh_of_a_ball

from sdph.case import read as cases
from sdph.effects.around import tank
from sdph.engine import state as particles
from sdph.engine.state import GAS, LIQUID
from sdph.engine.walls import shapes
from sdph.methods.liquids import filling
from sdph.methods.liquids.method import LiquidStepper
from sdph.schema import CaseError

G, RADIUS, RHO = 9.81, 0.5, 1000.0  # m/s2, m, kg/m3
MIDDLE = [0.5, 0.5, 0.8]
ROUND = {"centre_m": MIDDLE, "radius_m": RADIUS}
SHAPES = {
    "box": {"shape": "box", "lower_m": [0.1, 0.1, 0.0], "upper_m": [0.9, 0.9, 1.6]},
    "sphere": {"shape": "sphere", **ROUND},
    "cylinder": {"shape": "cylinder", "length_m": 1.2, **ROUND},
    "capsule": {"shape": "capsule", "length_m": 0.4, **ROUND},
    "mesh": {"shape": "mesh"},
}
DEEP = {"box": 0.8, "sphere": RADIUS, "cylinder": 0.6, "capsule": 0.7, "mesh": RADIUS}  # m, half full
SPACINGS = [RADIUS / 6.0, RADIUS / 9.0]


def table(shape: dict, spacing: float, fill: float = 0.5, gravity=(0.0, 0.0, -G), **sections) -> dict:
    d = len(gravity)
    return {
        "dimensions": d,
        "effects": [
            "gravity",
            "density_diffusion",
            "liquid_damping",
            "tank",
            *(name for name in sections if name == "frame"),
        ],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [1.0, 1.0, 1.6][-d:], "gravity_m_s2": list(gravity)},
        "resolution": {"spacing_mm": 1e3 * spacing},
        "liquid": {"density_kg_m3": RHO, "sound_speed_m_s": 10.0 * math.sqrt(G * 0.8)},
        "tank": {"slip": "free_slip", **shape},
        "pools": {"water": {"shape": "tank", "fill": fill}},
    } | sections


def filled(*args, **sections) -> LiquidStepper:
    return LiquidStepper(cases.from_table(table(*args, **sections)))


def of_kind(own, kind=LIQUID) -> np.ndarray:
    """(N, d) places."""
    return particles.positions(own.state)[own.state.kind == kind][:, : own.case.dimensions]


def nearest(points, others) -> float:
    """Least distance [m]."""
    return min(np.linalg.norm(others - point, axis=1).min() for point in points)


def levels_of_columns(own, level: float, spacing: float) -> np.ndarray:
    """Highest particle plus half a spacing [m] in columns two spacings wide, those 1.5 spacings and more from the
    rim."""
    x = of_kind(own) - np.array([*MIDDLE[:2], 0.0])
    away = np.hypot(x[:, 0], x[:, 1])
    rim = away[np.abs(x[:, 2] - level) < spacing].max() / math.sqrt(2.0) - 1.5 * spacing
    column = np.round(x[:, :2] / (2.0 * spacing)).astype(int)
    inner = [key for key in np.unique(column, axis=0) if np.hypot(*key) * 2.0 * spacing < rim]
    return np.array([x[(column == key).all(axis=1), 2].max() for key in inner]) + 0.5 * spacing


def first_peak(own, seconds: float) -> float:
    """Largest pressure within so long over the hydrostatic of the lowest liquid particle at the start."""
    gravity = np.array(own.case.domain.gravity)
    deepest, largest = np.ptp(of_kind(own) @ gravity) + 0.5 * own.case.resolution.spacing * np.linalg.norm(gravity), 0.0
    while own.time < seconds:
        own.step(seconds - own.time)
        largest = max(largest, own.pressure[own.active].max())
    return largest / (RHO * deepest)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("name", SHAPES)
def test_half_a_tank_holds_its_volume_at_its_level_and_stays(name, spacing, tmp_path):
    shape = SHAPES[name] | ({"mesh": mesh_of_a_ball(tmp_path, MIDDLE)} if name == "mesh" else {})
    own = filled(shape, spacing)
    held = own.state.mass[own.active].sum() / RHO
    level, bottom = MIDDLE[2], MIDDLE[2] - DEEP[name]
    assert abs(held - 0.5 * tank.shape_of(own.case).volume) <= 0.5 * spacing**3 * (1.0 + 1e-9)
    top = of_kind(own)[:, 2].max() + 0.5 * spacing
    assert top == pytest.approx(level, abs=0.5 * spacing) and of_kind(own)[:, 2].min() < bottom + spacing
    columns = levels_of_columns(own, level, spacing)
    assert len(columns) >= 4 and np.abs(columns - level).max() < 0.5 * spacing
    # sound needs 0.03 s to the surface, a fall by half a spacing 0.09 s
    assert first_peak(own, 0.15) == pytest.approx(1.0, abs=0.1)


CAPS = {"sphere": 0.0, "capsule": 0.4}  # m, length of the straight part


@pytest.mark.parametrize("fill", [0.05, 0.15, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("name", CAPS)
def test_levels_are_those_of_the_closed_form(name, fill):
    """Of a spherical cap and a cylinder, V = pi h^2 (R - h/3) and pi R^2 h, within a tenth of a spacing."""
    shape, spacing = shapes.Capsule(np.array(MIDDLE), RADIUS, CAPS[name]), RADIUS / 6.0
    low, high = filling.levels(shape, np.array([0.0, 0.0, 1.0]), (0.0, fill), spacing)
    depth, length = high - low, CAPS[name]
    assert low == pytest.approx(MIDDLE[2] - 0.5 * length - RADIUS)

    def cap(h):
        return math.pi * h**2 * (RADIUS - h / 3.0)

    top = 2.0 * RADIUS + length - depth
    straight = math.pi * RADIUS**2 * min(max(depth - RADIUS, 0.0), length)
    held = cap(min(depth, RADIUS)) + straight + (cap(RADIUS) - cap(top) if top < RADIUS else 0.0)
    area = math.pi * max(RADIUS**2 - max(RADIUS - depth, RADIUS - top, 0.0) ** 2, 0.25 * RADIUS**2)
    assert abs(held - fill * shape.volume) < 0.1 * spacing * area


@pytest.mark.parametrize("up", [(1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.6, 0.0, 0.8), (-0.48, 0.6, 0.64)])
def test_levels_lie_across_any_direction(up):
    """Through the middle at a half; what lies above one side's level lies below the other's."""
    up, spacing = np.array(up), 0.08
    for shape in (
        shapes.Capsule(np.array(MIDDLE), RADIUS, 0.4),
        shapes.Cylinder(np.array(MIDDLE), RADIUS, 1.2, 0.1),
        shapes.Box(np.zeros(3), np.ones(3)),
    ):
        middle = np.array(MIDDLE) if not isinstance(shape, shapes.Box) else np.full(3, 0.5)
        fifth, half = filling.levels(shape, up, (0.2, 0.5), spacing)
        assert half == pytest.approx(middle @ up, abs=1e-9)
        other = filling.levels(shape, -up, (0.8,), spacing)[0]
        assert -other == pytest.approx(fifth, abs=0.01 * spacing)


SIDEWAYS, TILTED = (-G, 0.0, 0.0), (G * math.sin(0.35), 0.0, -G * math.cos(0.35))


@pytest.mark.parametrize(
    ("name", "gravity"), [("box", SIDEWAYS), ("box", TILTED), ("sphere", SIDEWAYS), ("capsule", TILTED)]
)
def test_a_tank_on_its_side_or_tilted(name, gravity):
    spacing = RADIUS / 12.0
    own = filled(SHAPES[name], spacing, 0.5, gravity)
    up = -np.array(gravity) / G
    assert abs(own.state.mass[own.active].sum() / RHO - 0.5 * tank.shape_of(own.case).volume) <= 0.5 * spacing**3 * (
        1.0 + 1e-9
    )
    assert (of_kind(own) @ up).max() + 0.5 * spacing == pytest.approx(np.array(MIDDLE) @ up, abs=0.5 * spacing)
    assert first_peak(own, 0.15) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(("fill", "across"), [(0.15, 15.0), (0.8, 8.0)])
@pytest.mark.parametrize("name", ["sphere", "capsule"])
def test_other_fills(name, fill, across):
    spacing = RADIUS / across
    own = filled(SHAPES[name], spacing, fill)
    assert abs(own.state.mass[own.active].sum() / RHO - fill * tank.shape_of(own.case).volume) <= 0.5 * spacing**3
    assert first_peak(own, 0.1) == pytest.approx(1.0, abs=0.1)


def test_a_tank_that_begins_to_move():
    own = filled(SHAPES["sphere"], RADIUS / 7.0, frame={"shake": [[0, 0.02, 3.0, 0.0]]})
    assert first_peak(own, 0.15) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("fill", [0.15, 0.5])
def test_a_disc_in_two_dimensions(fill):
    shape, spacing = {"shape": "sphere", "centre_m": [0.5, 0.8], "radius_m": RADIUS}, RADIUS / 15.0
    own = filled(shape, spacing, fill, (0.0, -G))
    assert abs(own.state.mass[own.active].sum() / RHO - fill * math.pi * RADIUS**2) <= 0.5 * spacing**2
    assert first_peak(own, 0.15) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(
    "shape",
    [
        shapes.Capsule(np.zeros(3), 0.5, 0.3),
        shapes.Cylinder(np.zeros(3), 0.15, 0.3, 0.18),
        shapes.Cylinder(np.zeros(3), 0.5, 0.3, 0.18),
    ],
)
def test_walls_have_as_many_particles_as_their_area_asks_for(shape):
    """At half a spacing's depth; of the pipe's ends, 2.5 spacings in radius, one in five was missing, and liquid went
    through."""
    spacing = 0.06
    radius = shape.radius + 0.5 * spacing
    ends, side = 4.0 * math.pi * radius**2, 2.0 * math.pi * radius * shape.length
    if isinstance(shape, shapes.Cylinder):
        ends, side = 2.0 * math.pi * shape.radius**2, 2.0 * math.pi * radius * (shape.length + 2.0 * shape.reach)
    assert len(shape.shell(0.5 * spacing, spacing)) * spacing**2 == pytest.approx(ends + side, rel=0.015)


@pytest.mark.parametrize("name", ["disc", "box"])
def test_gas_fills_what_the_liquid_leaves(name):
    spacing = RADIUS / 12.0
    shape = {"shape": "sphere", "centre_m": [0.5, 0.8], "radius_m": RADIUS} if name == "disc" else {"shape": "box"}
    pools = {"water": {"shape": "tank", "fill": 0.4}, "air": {"shape": "tank", "phase": "gas", "fill": 1.0}}
    own = filled(shape, spacing, gravity=(0.0, -G), gas_phase={"density_kg_m3": 1.0}, pools=pools)
    volume = tank.shape_of(own.case).volume / spacing**2
    water, air = of_kind(own), of_kind(own, GAS)
    assert len(water) == pytest.approx(0.4 * volume, rel=0.03) and len(air) == pytest.approx(0.6 * volume, rel=0.03)
    assert air[:, 1].min() - water[:, 1].max() == pytest.approx(spacing, rel=0.1)
    assert nearest(water, air) > 0.6 * spacing
    assert first_peak(own, 0.1) == pytest.approx(1.0, abs=0.1)


def test_what_cannot_be_filled_is_told():
    with pytest.raises(CaseError, match="less than half a particle"):
        filled(SHAPES["sphere"], 0.25, 1e-3)
    twice = {"low": {"shape": "tank", "fill": 0.5}, "lower": {"shape": "tank", "fill": 0.3}}
    with pytest.raises(CaseError, match="pools.lower.fill = 0.3"):
        filled(SHAPES["sphere"], 0.1, pools=twice)
    with pytest.raises(CaseError, match="needs the effect tank, and fill"):
        filled(SHAPES["sphere"], 0.1, pools={"water": {"shape": "tank"}})


@pytest.mark.parametrize(
    ("middle", "outside"), [([0.5, 0.5, 2.0], "all"), ([0.5, 0.5, 1.5], "some"), ([0.5, 0.5, 1.0], "none")]
)
def test_a_pool_outside_its_tank_is_refused(middle, outside):
    """Nothing would hold it there, and no picture would show it."""
    drop = {"drop": {"shape": "sphere", "centre_m": middle, "radius_m": 0.2}}
    own = table({"shape": "box"}, 0.05)
    own["pools"] = drop
    if outside == "none":
        LiquidStepper(cases.from_table(own))
        return
    with pytest.raises(
        CaseError, match=r"pools\.drop: (\d+) of its (\d+) particles would stand outside the tank, up to"
    ) as told:
        LiquidStepper(cases.from_table(own))
    given, many = (int(word) for word in str(told.value).split() if word.isdigit())
    assert (given == many) == (outside == "all")


def test_a_drain_that_fills_is_refused():
    drain = {"fill": 0.9, "start_s": 0.0, "end_s": 1.0}
    own = table(SHAPES["sphere"], 0.1) | {"drain": drain}
    own["effects"] += ["drain"]
    with pytest.raises(CaseError, match=r"drain\.fill = 0\.9 is more than the 0\.5 of the tank that pools"):
        LiquidStepper(cases.from_table(own))
