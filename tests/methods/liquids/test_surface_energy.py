"""Energy of the surface in the ledger of a liquid: its size, and that it takes what tension gives."""

import numpy as np
import pytest
from scipy import special
from two_phase_drops import BASE, stepper

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import GAS, LIQUID, positions
from sdph.methods.liquids import interface, surface
from sdph.methods.liquids.totals import LOSSES, WORKS
from sdph.running.alone import Alone

SIGMA, COSINE, SPACING = 0.5, 0.5, 0.05
LAYERS = {
    "effects": ["surface_tension", "tank"], "liquid": BASE["liquid"] | {"periodic": [1.0, 0.0]},
    "domain": {"size_m": [0.5, 0.8], "gravity_m_s2": [0.0, 0.0]},
    "surface_tension": {"coefficient_N_m": SIGMA, "contact_angle_deg": 60.0},
}  # fmt: skip
ELLIPSE = {
    "effects": ["surface_tension"], "domain": {"size_m": [4.0, 4.0], "gravity_m_s2": [0.0, 0.0]},
    "liquid": BASE["liquid"] | {"periodic": [1.0, 1.0]}, "surface_tension": {"coefficient_N_m": SIGMA},
    "resolution": {"spacing_mm": 50.0, "smoothing_ratio": 1.5},
    "pools": {
        "drop": {"shape": "disc", "centre_m": [2.0, 2.0], "radius_m": 1.0},
        "air": {"phase": "gas", "shape": "box", "lower_m": [0.0, 0.0], "upper_m": [4.0, 4.0]},
    },
}  # fmt: skip
COARSE = "resolution.spacing_mm=0.1", "liquid.viscosity_Pa_s=0.02", "run.output_interval_s=0.0005"
# scene, end [s], what is set, whether the surface gains; least change [J/m]. The closed forms are 4 sigma (1.8 mm) less
# the disc as large, 59e-6 J/m, and of the box on the plate 51e-6 J/m
TURNED = {
    "a square relaxes": (
        "oscillating_droplet", 0.001,
        (
            *COARSE, "pools.drop={shape='box', lower_m=[0.0011, 0.0011], upper_m=[0.0029, 0.0029]}",
            "pools.air={phase='gas', shape='box', lower_m=[0.0, 0.0], upper_m=[0.004, 0.004]}",
        ),
        False, 35e-6,
    ),
    "a disc is stretched": (
        "oscillating_droplet", 0.001, (*COARSE, "pools.drop.speed_m_s=0.25", "pools.air.speed_m_s=0.25"), True, 10e-6,
    ),
    "a box wets a plate": (
        "drop_on_plate", 0.001,
        ("resolution.spacing_mm=0.1", "pools.drop.lower_m=[0.0011, 0.0]", "pools.drop.upper_m=[0.0029, 0.0009]"),
        False, 20e-6,
    ),
}  # fmt: skip


def parts(own):
    """Energy [J/m] as the ledger has it; area of the interface, and of wetted wall [m]."""
    area = np.zeros((len(own.active), 2))
    surface.border(own.kernel, own.state, own.rows, own.neighbours.box, own.active, own.volume, area)
    return surface.energy(own), *area.sum(axis=0)


def test_straight_interface_and_wetted_floor_are_as_long_as_the_box():
    """To round-off on a lattice, and both are in the energy: Young's equation."""
    energy, free, wetted = parts(stepper(shaken=False, **LAYERS))
    assert free == pytest.approx(0.5, rel=1e-12) and wetted == pytest.approx(0.5, rel=1e-12)
    assert energy == pytest.approx(SIGMA * (free - COSINE * wetted), rel=1e-12)


def test_walls_without_an_angle_cost_nothing():
    energy, free, _ = parts(stepper(shaken=False, **LAYERS | {"surface_tension": {"coefficient_N_m": SIGMA}}))
    assert energy == pytest.approx(SIGMA * free, rel=1e-12)


def test_where_particles_lie_matters_little():
    """Displaced by a tenth of the spacing, at random."""
    _, free, wetted = parts(stepper(shaken=True, **LAYERS))
    print("free, wetted over the box:", free / 0.5, wetted / 0.5)
    assert free == pytest.approx(0.5, rel=0.03) and wetted == pytest.approx(0.5, rel=0.03)


def cut(by):
    """Stepper whose liquid is what lies in an ellipse of the disc's area, exp(by) long and exp(-by) wide."""
    own = stepper(shaken=False, **ELLIPSE)
    s = own.state
    s.kind[:] = np.where(((s.x - 2.0) * np.exp(-by)) ** 2 + ((s.y - 2.0) * np.exp(by)) ** 2 < 1.0, LIQUID, GAS)
    s.density[:] = np.where(s.kind == LIQUID, 1000.0, 1.0)
    s.mass[:] = s.density * SPACING**2
    own.volume[:] = SPACING**2
    interface.tighten(own)
    return own


@pytest.mark.parametrize("by", [0.0, 0.5])
def test_energy_of_an_ellipse_is_that_of_its_rim(by):
    """By the complete elliptic integral; on a lattice steps make it longer."""
    rim = 4.0 * np.exp(by) * special.ellipe(1.0 - np.exp(-4.0 * by))
    energy = parts(cut(by))[0]
    print("over that of the rim:", energy / (SIGMA * rim))
    assert energy == pytest.approx(SIGMA * rim, rel=0.02)


def test_power_of_tension_is_what_the_energy_falls_by():
    """Of an ellipse that is stretched on, by differences of the energy."""
    by, step = 0.3, 0.3
    own = cut(by)
    velocity = (positions(own.state) - 2.0) * [1.0, -1.0, 0.0]
    power = (own.state.mass[:, None] * own.tightening * velocity).sum()
    rate = (parts(cut(by + step))[0] - parts(cut(by - step))[0]) / (2.0 * step)
    print("power, rate of the energy:", power, rate)
    assert power < 0.0
    assert rate == pytest.approx(-power, rel=0.1)


def gone(folder, scene, end, given):
    """Ledger of a run."""
    run = Alone(cases.load(scenes.find(scene)[1], (*given, f"run.end_time_s={end}")), folder / "ledger.csv")
    run.start()
    while run.time < end:
        run.window()
    return run.ledger


@pytest.mark.parametrize("name", TURNED)
def test_what_tension_gives_the_surface_loses(tmp_path, name):
    """A sign that is wrong makes a rest of twice the work; measured rests are 0.02 to 0.1 of it."""
    scene, end, given, gains, least = TURNED[name]
    ledger = gone(tmp_path, scene, end, given)
    change, told = ledger.last["surface_energy_J"] - ledger.first["surface_energy_J"], ledger.summary()
    print(name, {"change": change} | {key: told[key] for key in told if "tension" in key})
    assert (change > least) if gains else (change < -least)
    assert told["numerical_tension_rel"] < 0.2
    assert abs(told["numerical_tension_J"]) < 0.2 * abs(told["work_of_surface_tension_J"])


def test_motion_compression_and_surface_close(tmp_path):
    """Window by window, to round-off, without the work of tension: it moves energy from one to the other."""
    given = (*TURNED["a square relaxes"][2], "run.end_time_s=0.001")
    run = Alone(cases.load(scenes.find("oscillating_droplet")[1], given), tmp_path / "ledger.csv")
    run.start()
    held = ("kinetic_energy_J", "elastic_energy_J", "surface_energy_J")
    others = [name for name in WORKS if name != "work_of_surface_tension_J"]
    for _ in range(3):
        before = run.ledger.last
        run.window()
        row = run.ledger.last
        grown = sum(row[name] - before[name] for name in held)
        came = sum(row[name] for name in others) + row["numerical_work_J"] + row["numerical_tension_J"]
        assert grown == pytest.approx(came - sum(row[name] for name in LOSSES), abs=1e-12 * row["surface_energy_J"])
        assert abs(row["work_of_surface_tension_J"]) > 1e-3 * row["surface_energy_J"]


def test_without_tension_there_is_no_surface(tmp_path):
    ledger = gone(tmp_path, "dam_break", 0.002, ("resolution.spacing_mm=8",))
    assert "surface_energy_J" not in ledger.last and "numerical_tension_rel" not in ledger.summary()
    assert ledger.summary()["numerical_tension_J"] == 0.0
