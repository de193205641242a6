"""Shifting of liquids: its directions, its velocities, and what it leaves at a surface."""

import numpy as np
import pytest
from shaken_liquids import stepper

from sdph.case import read as cases
from sdph.effects.liquids import shifting
from sdph.engine import kernels as smoothing
from sdph.engine.state import LIQUID, positions
from sdph.laws import matrices
from sdph.methods.liquids import shift
from sdph.methods.liquids.method import LiquidStepper
from sdph.running import driver
from sdph.schema import CaseError


def test_eigenvalues():
    random = np.random.default_rng(2)
    for _ in range(50):
        a = random.standard_normal((3, 3))
        m = a + a.T
        least = matrices.smallest(m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[1, 2], m[2, 0])
        assert least == pytest.approx(np.linalg.eigvalsh(m)[0], abs=1e-9)


def test_a_rotating_liquid_stays_where_shifting_puts_its_velocity():
    """Shifting moves particles, not the field: of a linear velocity each particle still has that of its place."""
    own = stepper(2, effects=("density_diffusion", "shifting"))
    s = own.state
    s.u[:], s.v[:], s.density[:] = 3.0 * s.y, -2.0 * s.x, 1000.0
    own.forces()
    inside = own.active[own.state.enclosure[own.active] > 0.75]
    before = positions(s).copy()
    own._shift(1e-3)
    moved = np.abs(positions(s) - before).max(axis=1)[inside]
    assert len(inside) > 10 and moved.max() > 1e-5
    assert np.allclose(s.u[inside], 3.0 * s.y[inside], rtol=1e-9)
    assert np.allclose(s.v[inside], -2.0 * s.x[inside], rtol=1e-9)


def test_at_a_surface_particles_are_shifted_along_it():
    """Of the shift of who sees a surface nothing leads along the gradient of the smallest eigenvalue; spray stays; deep
    inside nothing changes."""
    pool = {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.6, 0.6]}}
    own = stepper(2, effects=("density_diffusion", "shifting"), pools=pool)
    s, least = own.state, own.state.enclosure
    along = own.shift.copy()
    own.shift[:] = 0.0
    shift.surround(
        own.kernel,
        s,
        own.rows,
        own.neighbours.box,
        own.active,
        own.p["shifting"],
        own.phases,
        own.volume,
        least,
        own.shift,
        own.twist,
    )
    full, r = own.shift, positions(s)
    near = np.linalg.norm(r[:, None] - r, axis=2) < 2.0 * own.case.smoothing_length
    deep = ~(near & (least <= shifting.INTERIOR)).any(axis=1)
    assert deep.sum() > 10 and np.array_equal(along[deep], full[deep])
    assert (along[least <= shifting.SPRAY] == 0.0).all()
    edge = np.flatnonzero(~deep & (least > shifting.SPRAY))
    assert len(edge) > 40 and (least[edge] > shifting.INTERIOR).any()
    for i in edge:
        d = r[i] - r
        slope = np.array([smoothing.slope.py_func(own.kernel, q) for q in np.linalg.norm(d, axis=1)])
        normal = (own.volume * slope * (least - least[i])) @ d
        normal /= np.linalg.norm(normal)
        assert np.allclose(along[i], full[i] - (full[i] @ normal) * normal, atol=1e-9 * np.abs(full).max())


def resting(effects=("gravity", "density_diffusion", "liquid_damping", "shifting", "tank"), **sections):
    """A pool of eight rows at rest in a tank whose sides it meets."""
    return cases.from_table({
        "dimensions": 2, "effects": list(effects), "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [0.3, 0.2], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 10.0},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 10.0}, "tank": {"slip": "free_slip"},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.3, 0.08]}},
        "shifting": {"form": "transport_velocity", "strength": 0.2}, **sections,
    })  # fmt: skip


def test_a_wall_is_no_surface():
    """Of a pool in a tank the last rows alone have one: beside the floor and the sides none is found."""
    own = LiquidStepper(resting(), 1e-9)
    s = own.state
    wet = s.kind == LIQUID
    high = s.y[wet] > 0.06
    assert (s.enclosure[wet][~high] > shifting.INTERIOR).all() and (s.enclosure[wet][s.y[wet] > 0.07] < 0.7).all()


def test_shifting_leaves_the_level_of_a_pool_where_it_is(tmp_path):
    """0.3 s at rest: what is lifted is below a thousandth of the energy in gravity, 9.42 J per metre (3 % where rows
    below the surface were lifted, and corners at walls)."""
    own = driver.simulation_of(resting(), None, tmp_path / "ledger.csv")
    own.start()
    first = own.ledger.last["potential_energy_J"]
    while own.time < 0.3:
        own.window()
    last, sums = own.ledger.last["potential_energy_J"], own.ledger.sums
    assert abs(last - first) < 0.01 * first and abs(sums["shifting_lift_J"]) < 1e-3 * first
    assert last - first == pytest.approx(sums["shifting_lift_J"] - sums["work_of_gravity_J"], abs=2e-4 * first)


def test_what_shifting_lifts_is_energy_made(tmp_path):
    """A pool whose surface nothing holds back is lifted, and told to have made that energy."""
    own = driver.simulation_of(resting(), None, tmp_path / "ledger.csv")
    own.start()
    own.method.stepper.shift[:, 1] = -1.0 / own.method.stepper.p["shifting"].strength  # 1 m/s upwards
    before = own.ledger.made
    own.method.stepper._shift(1e-6)
    lifted = own.method.stepper.eased[1]
    assert lifted == pytest.approx(1000.0 * 0.3 * 0.08 * 9.81 * 1e-6, rel=0.01)
    own.window()
    assert own.ledger.made > before


@pytest.mark.parametrize(("height", "fine"), [(0.2, True), (0.15, False)])
def test_two_phases_that_leave_room_are_not_shifted(height, fine):
    oil = {"phase": "gas", "shape": "box", "lower_m": [0.0, 0.08], "upper_m": [0.3, height]}
    pools = {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.3, 0.08]}, "oil": oil}
    two = {"pools": pools, "gas_phase": {"density_kg_m3": 700.0}}
    assert shifting.filled(resting(**two)) == pytest.approx(height / 0.2)
    if fine:
        assert shifting.kernel(resting(**two)).liquid == 1.0
    else:
        with pytest.raises(CaseError, match="pools fill 75 % of the tank"):
            shifting.kernel(resting(**two))
