"""The state: what a case is filled with, and that every array goes along when particles are chosen or joined."""

import json
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from builders import FULL_BOX, disc
from hypothesis import given
from hypothesis import strategies as st

from sdph.engine import lattice
from sdph.engine import state as particles
from sdph.methods.grains import start

REFERENCE = json.loads((Path(__file__).parents[1] / "data" / "sdph_reference_values.json").read_text())["values"]
COUNT = next(int(v["expected"]) for v in REFERENCE if v["id"] == "N_disc_lattice")
ALL = ("temperature", "diameter", "diameter_variance", "theta")


def numbered(count, names, dimensions):
    """A state whose every array tells rows apart: row i of array number a holds 100 a + i (at most 127 in `kind`)."""
    state = particles.empty(count, names, dimensions)
    for a, array in enumerate(state):
        array[:] = np.arange(len(array)) + (0 if array.dtype == np.int8 else 100 * a)
    return state


def rows_of(state):
    """The set of rows over all arrays that there are: what makes a particle."""
    present = [array for array in state if len(array)]
    return list(zip(*(array.tolist() for array in present)))


def test_disc_has_the_particles_of_the_reference():
    case = disc()
    state = start.fill(case, ("temperature", "diameter", "diameter_variance"))
    assert len(state.x) == COUNT == 5024
    assert state.mass.sum() == pytest.approx(5024 * 0.011475, rel=1e-12)  # alpha_p rho_p dx^2, reference m_sph_disc
    np.testing.assert_array_equal(state.ident, np.arange(1, 5025))  # the paper counts from 1
    np.testing.assert_array_equal(state.temperature, 288.0)
    np.testing.assert_array_equal(state.diameter, case.grains.diameter)
    assert np.hypot(state.x - 0.25, state.y - 0.25).max() <= 0.1
    assert (len(state.z), len(state.w), len(state.theta)) == (0, 0, 0)


@given(spacing=st.floats(1.0, 20.0))
def test_disc_is_symmetric_whatever_the_spacing(spacing):
    state = start.fill(disc(f"resolution.spacing_mm={spacing!r}"), ())
    assert state.x.mean() == pytest.approx(0.25, abs=1e-12)
    assert state.y.mean() == pytest.approx(0.25, abs=1e-12)
    area = len(state.x) * (spacing * 1e-3) ** 2
    assert area == pytest.approx(math.pi * 0.01, rel=8.0 * spacing * 1e-3 / 0.1)


@given(spacing=st.floats(0.4, 30.0), alpha=st.floats(0.01, 0.63))
def test_box_holds_its_mass_at_any_spacing(spacing, alpha):
    state = start.fill(
        disc(*FULL_BOX, f"resolution.spacing_mm={spacing!r}", f"particles.disc.volume_fraction={alpha!r}"), ()
    )
    assert state.mass.sum() == pytest.approx(alpha * 3060.0 * 0.05**2, rel=1e-12)
    assert 0.0 < state.x.min() < state.x.max() < 0.05 or len(state.x) == 1


def test_numbering_is_row_major():
    state = start.fill(disc(*FULL_BOX, "resolution.spacing_mm=10"), ())
    np.testing.assert_allclose(state.x[:6], [0.005, 0.015, 0.025, 0.035, 0.045, 0.005])
    np.testing.assert_allclose(state.y[:6], [0.005] * 5 + [0.015])


def test_sphere_in_three_dimensions():
    region = SimpleNamespace(shape="sphere", centre=(1.0, 2.0, 3.0), radius=0.5)
    points = lattice.lattice(region, 0.05, 3)
    assert points.shape[1] == 3
    np.testing.assert_allclose(points.mean(axis=0), region.centre, atol=1e-12)
    assert len(points) * 0.05**3 == pytest.approx(4.0 / 3.0 * math.pi * 0.5**3, rel=0.02)
    assert np.linalg.norm(points - region.centre, axis=1).max() <= 0.5


def test_regions_are_numbered_through_and_keep_their_own():
    two = (
        "particles.other.shape='box'",
        "particles.other.lower_m=[0.0,0.0]",
        "particles.other.upper_m=[0.05,0.05]",
        "particles.other.volume_fraction=0.3",
        "particles.other.temperature_K=400.0",
        "particles.other.velocity_m_s=[1.0,-2.0]",
    )
    state = start.fill(disc(*two), ("temperature",))
    np.testing.assert_array_equal(state.ident, np.arange(1, 5425))
    hot = state.temperature == 400.0
    assert hot.sum() == 400
    np.testing.assert_array_equal(np.unique(state.v[hot]), [-2.0])
    np.testing.assert_array_equal(np.unique(state.u[~hot]), [0.0])
    assert state.mass[hot].sum() == pytest.approx(0.3 * 3060.0 * 0.0025, rel=1e-12)


def test_case_without_particles_is_an_empty_state():
    state = start.fill(disc("particles={}"), ("temperature",))
    assert all(len(array) == 0 for array in state)


states = st.builds(numbered, st.integers(0, 12), st.sets(st.sampled_from(ALL)), st.sampled_from([2, 3]))


@given(state=states, data=st.data())
def test_take_moves_whole_particles(state, data):
    count = len(state.x)
    rows = np.array(data.draw(st.lists(st.integers(0, max(0, count - 1)), max_size=0 if count == 0 else 20)), int)
    chosen = particles.take(state, rows)
    whole = rows_of(state)
    assert rows_of(chosen) == [whole[row] for row in rows]
    for before, after in zip(state, chosen):
        assert after.dtype == before.dtype
        assert len(after) == (len(rows) if len(before) else 0)
        assert after.flags.c_contiguous


@given(state=states, data=st.data())
def test_take_by_mask_does_not_share_memory(state, data):
    mask = np.array(data.draw(st.lists(st.booleans(), min_size=len(state.x), max_size=len(state.x))), bool)
    chosen = particles.take(state, mask)
    np.testing.assert_array_equal(chosen.ident, state.ident[mask])
    assert not np.shares_memory(chosen.x, state.x)


@given(
    count=st.integers(0, 5),
    other=st.integers(0, 5),
    names=st.sets(st.sampled_from(ALL)),
    dimensions=st.sampled_from([2, 3]),
)
def test_join_keeps_both(count, other, names, dimensions):
    first, second = numbered(count, names, dimensions), numbered(other, names, dimensions)
    both = particles.join(first, second)
    assert rows_of(both) == rows_of(first) + rows_of(second)
    absent = set(ALL) - names | ({"z", "w"} if dimensions == 2 else set())
    assert all(len(getattr(both, name)) == 0 for name in absent)
    assert [a.dtype for a in both] == [a.dtype for a in first]


@pytest.mark.parametrize("dimensions", [2, 3])
def test_positions_and_velocities_are_three_columns(dimensions):
    state = numbered(3, (), dimensions)
    columns = np.concatenate((particles.positions(state), particles.velocities(state)), axis=1)
    for column, name in zip(columns.T, "xyzuvw"):
        np.testing.assert_array_equal(column, getattr(state, name) if len(getattr(state, name)) else 0.0)
    assert len(particles.axes(state)) == dimensions


def test_every_array_has_a_unit():
    assert tuple(particles.FIELDS) == particles.Whole._fields


@pytest.mark.parametrize("held", particles.CLASSES)
def test_a_state_holds_what_its_class_says_and_nothing_of_the_rest(held):
    state = particles.empty(3, held._fields, 3)
    assert type(state) is held
    assert {name for name in particles.FIELDS if len(getattr(state, name))} == set(held._fields)
    other = [name for name in particles.FIELDS if name not in held._fields]
    assert all(getattr(state, name).dtype == particles.INTEGERS.get(name, float) for name in other)
    with pytest.raises(AttributeError, match="a state has no colour"):
        _ = state.colour


def test_states_of_two_classes_are_joined_in_the_narrowest_that_holds_both():
    liquid, plain = particles.empty(2, ("viscosity",)), particles.empty(0)
    assert type(particles.join(plain, liquid)) is type(particles.join(liquid, plain)) is particles.Liquid
    assert type(particles.empty(0, (), least=particles.Grains)) is particles.Grains
    assert type(particles.join(liquid, particles.empty(0, ("theta",)))) is particles.Whole
