"""Loops of moving particles and of solids take from neighbours what HALO says, and nothing else, as tests/methods/
test_halo.py has it of grains and liquids. The pressure of mps is given: its equations are solved by all together."""

import numpy as np
import pytest
from blocks import stepper as block
from moving import case
from test_halo import poison, strewn
from test_pools import TANK, tank

from sdph.engine import state as particles
from sdph.methods.mps import compressible, equations, pools
from sdph.methods.mps.method import MpsStepper
from sdph.methods.solids import equations as of_solids
from sdph.methods.solids.method import SolidStepper

OF_MPS = ("number", "surface", "speed", "pulled", "energy")  # arrays of the particles that are no field of the state
OF_SOLIDS = (
    "unloaded", "strained", "hardened", "harm", "gradient", "stress", "kirchhoff", "amounts", "acceleration",
    "steadying", "friction", "free", "broken",
)  # fmt: skip
POOLS = {
    "pool": tank,
    "drop": lambda: MpsStepper(case(("free_energy_tension", "laminar_viscosity"), {}, 2)),
    "sticking pool": lambda: MpsStepper(case(("gravity", "tank", "laminar_viscosity"), TANK, 2)),
}


def of_far(own, arrays, extra):
    """What nobody may take from others: all that no HALO names, and `extra`."""
    return *(name for name in (*particles.FIELDS, *arrays) if name not in own.HALO), *extra


def mps_answer(name, extra=()):
    """All that loops make of the own particles: surface, divergence, matrix, accelerations, collisions, ways, and how
    uneven the density is."""
    own = POOLS[name]()
    inside, rng = strewn(own.state), np.random.default_rng(1)
    own.state.pressure[:] = rng.random(len(inside))
    own.state.density[:] *= 1.0 + 0.01 * rng.random(len(inside))
    own._look()
    if extra is not None:
        poison(own, of_far(own, OF_MPS, extra), ~inside)
        own.surface[own.surface > 1] = 1  # a surface where none is
    count, around, unit = len(inside), own.around, own.cloud.spacing
    beside, (divergence, meeting, uneven) = np.zeros(count, np.int8), np.zeros((3, count))
    pressed, borne, rubbed, change, way = np.zeros((5, count, 3))
    equations.near_surface(*around, own.surface, beside)
    if own.pool:
        pools.diverge(*around, beside, divergence)
        pools.press(*around, own.state.pressure, beside, 1.0, pressed, borne)
        pools.keep_apart(*around, beside, unit, way)
    else:
        equations.diverge(*around, divergence)
        equations.press(*around, own.state.pressure, pressed)
    equations.rub(*around, 1.0, rubbed)
    compressible.even(*around, uneven)
    equations.meet(own.walls, own.state, own.rows, own.neighbours.box, unit, meeting)
    equations.collide(own.walls, own.state, own.rows, own.neighbours.box, unit, 0.5, np.maximum(meeting, 1.0), change)
    own._look()
    seen = own.number, own.surface, own.speed, own.pulled
    found = beside, divergence, uneven, *seen, pressed, borne, rubbed, change, way
    return np.column_stack(found)[inside & (own.state.mass > 0.0)]


def solid_answer(extra=()):
    """Deformation and accelerations of the own particles of a block that is shaken."""
    own, rng = block(2), np.random.default_rng(1)
    inside = strewn(own.state)
    for axis in particles.axes(own.state):
        axis += 0.05 * own.case.resolution.spacing * rng.standard_normal(len(axis))
    own._load(own.plastic, own.damage, 1e-9)
    if extra is not None:
        poison(own, of_far(own, OF_SOLIDS, extra), ~inside)
    s, acceleration, aside = own.state, np.zeros((len(inside), 3)), np.zeros((2, len(inside), 3))
    of_solids.push(
        own.kernel, own.material, s.x, s.y, s.z, s.u, s.v, s.w, own.weights.rows, own.ref, own.gradient, own.stress,
        acceleration, *aside,
    )  # fmt: skip
    gradient = np.zeros_like(own.gradient)
    of_solids.deform(s.x, s.y, s.z, own.weights.rows, own.ref, gradient)
    return np.column_stack((acceleration, gradient))[inside]


@pytest.mark.parametrize("name", POOLS)
def test_moving_particles_take_what_they_declare_and_nothing_else(name):
    whole = mps_answer(name, None)
    assert len(whole) and np.isfinite(whole).all()
    np.testing.assert_array_equal(mps_answer(name), whole)


def test_solids_take_what_they_declare_and_nothing_else():
    whole = solid_answer(None)
    assert np.isfinite(whole).all()
    np.testing.assert_array_equal(solid_answer(), whole)


def test_moving_particles_declare_nothing_for_nothing():
    """A number that is not there would be read past the end of the walls: `ident` is left out."""
    wholes = {name: mps_answer(name) for name in POOLS}
    idle = [
        field
        for field in MpsStepper.HALO
        if field not in ("z", "w", "ident")
        and all(np.array_equal(mps_answer(name, (field,)), whole) for name, whole in wholes.items())
    ]
    assert not idle


def test_solids_declare_nothing_for_nothing():
    whole = solid_answer()
    idle = [field for field in SolidStepper.HALO if np.array_equal(solid_answer((field,)), whole)]
    assert set(idle) <= {"z", "w"}
