"""What limiters of grains hold is told by the effects that have them: shares of chosen grains, by numbers worked out by
hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from grain_boxes import DENSITY, DIAMETER, box, started

from sdph import effects
from sdph.effects.grains import friction, grain_shifting
from sdph.engine import state as particles
from sdph.engine.state import INFLOW

H = 7.5e-3  # m, of the boxes
BED = ["granular_pressure", "granular_viscosity", "granular_temperature", "friction"]


def grains(alpha_p, theta, upstream=()):
    """A method with grains of these packings and agitations, some of them still upstream of a nozzle."""
    state = particles.empty(len(alpha_p), effects.arrays(box(BED)), 2)
    state.density[:], state.theta[:], state.diameter[:] = np.multiply(alpha_p, DENSITY), theta, DIAMETER
    state.kind[list(upstream)] = INFLOW
    return SimpleNamespace(state=state, step=0.0, scratch=SimpleNamespace(strain=np.ones((3, len(alpha_p)))))


def held(name, method, **sections):
    case = box(BED, **sections)
    row = effects.REGISTRY[name]
    return row.held(row.kernel(case), method)


def free_path(alpha_p, factor, e=0.9):
    """Free path [m] of a kinetic coefficient, by hand."""
    g0 = 1.0 / (1.0 - (alpha_p / 0.63) ** (1.0 / 3.0))
    return factor * math.sqrt(math.pi) * DIAMETER / (96 * (1 + e) * alpha_p * g0)


@pytest.mark.parametrize(
    ("name", "coefficient", "factor"),
    [("granular_viscosity", "viscosity", 10), ("granular_temperature", "conductivity", 25)],
)
def test_the_limit_of_free_paths(name, coefficient, factor):
    """It takes nothing of dense grains, a part at 0.001; a grain upstream does not count."""
    told = held(name, grains([0.02, 0.60, 0.001, 0.001], 1e-4, upstream=(3,)))
    assert told[f"knudsen_{coefficient}_share"] == pytest.approx(1.0 / 3.0)
    assert told[f"knudsen_{coefficient}_rel"] == pytest.approx((1.0 - H / free_path(0.001, factor)) / 3.0, rel=1e-12)
    assert 0.0 < told[f"knudsen_{coefficient}_rel"] < 1.0 / 3.0


def test_an_algebraic_theta_is_not_conducted():
    told = held("granular_temperature", grains([0.001], 1e-4), granular_temperature={"model": "algebraic"})
    assert told["knudsen_conductivity_share"] == told["knudsen_conductivity_rel"] == 0.0


def test_grains_at_the_bounds_of_theta():
    bounds = {"least_m2_s2": 1e-6, "most_m2_s2": 1e-2}
    own = grains([0.5] * 5, [1e-6, 1e-6, 1e-4, 1e-2, 1e-6], upstream=(4,))
    told = held("granular_temperature", own, granular_temperature=bounds)
    assert (told["theta_at_least_share"], told["theta_at_most_share"]) == (0.5, 0.25)


@pytest.mark.parametrize("name", BED)
def test_grains_past_the_cap_of_packing(name):
    """0.01 below the packing limit of 0.63."""
    own = grains([0.60, 0.6199, 0.6201, 0.64, 0.64], 1e-4, upstream=(4,))
    assert held(name, own)["alpha_p_capped_share"] == 0.5


def test_grains_that_neighbours_do_not_enclose():
    own = grains([0.6] * 4, 1e-4, upstream=(3,))
    own.scratch.strain[2, 1:] = 0.0
    for name in ("granular_viscosity", "friction"):
        assert held(name, own)["unenclosed_share"] == pytest.approx(2.0 / 3.0)


def test_no_grains_are_no_share():
    for name in BED:
        assert set(held(name, grains([], [])).values()) == {0.0}


def test_contacts_that_do_not_yield(tmp_path):
    """Slight strain leaves all at the viscosity of the step, fast shear none of those that are sheared evenly."""
    case = box(["friction", "granular_pressure"], size=(0.1, 0.1), alpha_p=0.61)
    stepper = started(case, tmp_path).stepper
    assert stepper.held["contact_viscosity_share"] == 0.0  # no step has gone
    inside, zeros = np.abs(stepper.state.y - 0.05) < 0.03, np.zeros(len(stepper.state.x))
    found = []
    for rate in (1e-5, 20.0):
        for name in friction.ARRAYS[:3]:
            getattr(stepper.state, name)[:] = 0.0
        stepper.state.u[:] = rate * stepper.state.y
        stepper.force(zeros, np.zeros((len(zeros), 3)), zeros)
        stepper.move(1e-4)
        stepper.state.v[:] = 0.0
        found.append(stepper.held["contact_viscosity_share"])
    assert found[0] > 0.6 and found[1] < 1.0 - inside.mean()


def test_what_shifting_moves(tmp_path):
    """Of grains on their lattice one is pushed over its neighbour: these two are parted, and the others do not move."""
    case = box(["granular_pressure", "grain_shifting"], size=(0.06, 0.06), alpha_p=0.3)
    stepper = started(case, tmp_path).stepper
    s, dt, zeros = stepper.state, 1e-5, np.zeros(len(stepper.state.x))
    assert stepper.held == {"alpha_p_capped_share": 0.0, "shifted_share": 0.0, "shift_m": 0.0}
    s.x[0] += 2.5e-3
    s.u[0] = 0.5
    stepper.prepare()
    stepper.force(zeros, np.zeros((len(zeros), 3)), zeros)
    stepper.move(dt)
    told, moved = stepper.held, np.empty((len(zeros), 3))
    p = stepper.parameters["grain_shifting"]
    grain_shifting.shift(p, stepper.state, stepper.rows, stepper.neighbours.box, dt, moved)
    assert told["shifted_share"] == pytest.approx(2.0 / len(zeros))
    assert told["shift_m"] == pytest.approx(np.linalg.norm(moved, axis=1).max(), rel=0.02) and told["shift_m"] > 0.0


def test_an_effect_that_is_off_tells_nothing(tmp_path):
    assert started(box(["gravity"]), tmp_path).stepper.held == {}


@pytest.mark.parametrize("name", ["artificial_viscosity", "conduction"])
def test_what_softening_takes_off_pairs(tmp_path, name):
    """Off a square lattice, by hand; more off grains that are pressed together."""
    stepper = started(box([name, "granular_pressure"], size=(0.06, 0.06), alpha_p=0.5), tmp_path).stepper
    cells = np.stack(np.meshgrid(*[np.arange(-3.0, 4.0)] * 2), axis=-1).reshape(-1, 2) * 5e-3
    r = np.linalg.norm(cells, axis=1)
    q = r / H
    weight = np.where(q < 1.0, 3.0 * q - 2.25 * q**2, np.where(q < 2.0, 0.75 * (2.0 - q) ** 2, 0.0)) * r  # -r dW/dr
    expected = 1.0 - (weight * r**2 / (r**2 + 0.01 * H**2)).sum() / weight.sum()
    stepper.tell()
    assert stepper.held["softened_rel"] == pytest.approx(expected, rel=1e-9)
    stepper.state.x[:] *= 0.5
    stepper.prepare()
    stepper.tell()
    assert stepper.held["softened_rel"] > expected
