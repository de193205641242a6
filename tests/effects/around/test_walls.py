"""Walls: what grains feel along them, and that none gets through."""

import math

import meshio
import numpy as np
import pytest
from grain_boxes import DENSITY, DIAMETER, SPACING, box, go, started, windows
from scipy.optimize import brentq

from sdph.engine.walls import facets, sides
from sdph.laws import friction, granular

ALPHA_P, THETA, HEIGHT = 0.5, 1.0, 0.06
G0 = granular.sinclair_jackson(ALPHA_P, 0.63)
MU = granular.gidaspow_viscosity(ALPHA_P, THETA, 0.9, G0, DENSITY, DIAMETER)


def channel(folder, push, end, kind="wall", held=True, **walls):
    """(y, u) [m], [m/s] of grains of constant agitation between two plates, pushed along them by `push` [m/s2].

    Where they are `held`, they keep their places: a lattice of particles bears a stress of about 0.01 of the pressure
    as a solid does, which would hide a slow flow.
    """
    case = box(
        ["gravity", "granular_pressure", "granular_viscosity", "walls"], size=(0.06, HEIGHT), alpha_p=ALPHA_P,
        periodic=("x",), gravity=(push, 0.0), boundaries={"plates": {"kind": kind}}, walls=walls,
        grains={"granular_temperature_m2_s2": THETA}, **windows(end, 1),
    )  # fmt: skip
    if not held:
        state = go(started(case, folder)).state
        return state.y, state.u
    stepper = started(case, folder).stepper
    state, dt = stepper.state, 1e-4
    start, zeros = (state.x.copy(), state.y.copy()), np.zeros(len(state.x))
    for _ in range(round(end / dt)):
        stepper.force(zeros, np.tile((push, 0.0, 0.0), (len(zeros), 1)), zeros)
        stepper.move(dt)
        assert stepper.state.x is state.x  # not sorted anew
        state.x[:], state.y[:] = start
        stepper.prepare()
    return state.y, state.u


def poiseuille(y, push):
    """u [m/s] of no slip in the steady state."""
    return ALPHA_P * DENSITY * push / (2.0 * MU) * y * (HEIGHT - y)


RELAXATION = HEIGHT**2 / np.pi**2 * ALPHA_P * DENSITY / MU


def test_grains_between_rough_plates_flow_as_a_liquid_does(tmp_path):
    y, u = channel(tmp_path, 1.0, 5.0 * RELAXATION)
    error = np.abs(u - poiseuille(y, 1.0)).max() / poiseuille(0.5 * HEIGHT, 1.0)
    print(f"plane Poiseuille flow of grains, 12 across: error {error:.3f} of the largest speed")
    assert error < 0.06


def test_fast_flow_between_rough_plates(tmp_path):
    """The same with particles that move, at a stress of 0.02 of the pressure, of which their lattice bears some."""
    y, u = channel(tmp_path, 20.0, 5.0 * RELAXATION, held=False)
    error = abs(u.mean() / poiseuille(y, 20.0).mean() - 1.0)
    print(f"moving: error {error:.3f} of the flux")
    assert error < 0.3


def test_grains_between_smooth_plates_fall_freely(tmp_path):
    for name, options in (("side", {"kind": "slip_wall"}), ("walls", {"specularity": 0.0})):
        (tmp_path / name).mkdir()
        _, u = channel(tmp_path / name, 1.0, 0.05, held=False, **options)
        np.testing.assert_allclose(u, 0.05, rtol=1e-6)


def test_specular_plates_hold_back_with_the_stress_of_johnson_and_jackson(tmp_path):
    """tau = phi pi rho_p alpha_p g0 sqrt(3 theta) u/(6 alpha_max) carries the push: the slip adds to the parabola."""
    phi = 0.02
    k = phi * np.pi * DENSITY * ALPHA_P * G0 * np.sqrt(3.0 * THETA) / (6.0 * 0.63)
    slip = 0.5 * ALPHA_P * DENSITY * HEIGHT / k
    y, u = channel(tmp_path, 1.0, 5.0 * (RELAXATION + 0.5 * HEIGHT * ALPHA_P * DENSITY / k), specularity=phi)
    print(f"slip {np.mean(u - poiseuille(y, 1.0)):.4f} m/s, exact {slip:.4f}")
    assert slip > 0.3 * poiseuille(0.5 * HEIGHT, 1.0)
    np.testing.assert_allclose(u, slip + poiseuille(y, 1.0), atol=0.06 * (slip + poiseuille(0.5 * HEIGHT, 1.0)))


def test_plates_of_a_friction_hold_back_by_li_and_benyahia(tmp_path):
    """A stress k u with the specularity of that slip, or of the speed of the grains that a plate sees, a spacing and a
    half away at most, by the load that is the pressure; grains that stuck to it would slip by 15 % less."""
    mu = 0.02
    load = (1.0 + 2.0 * 1.9 * ALPHA_P * G0) * 2.0 * 0.63 * np.sqrt(6.0 * np.pi) / (1.9 * np.pi * G0)
    push = 5.0 * load
    sliding, sticking = 3.5 * mu * 1.9, friction.sticking_specularity(mu, 0.9)
    stress = 0.5 * ALPHA_P * DENSITY * HEIGHT * push
    per = load * np.pi * DENSITY * ALPHA_P * G0 * np.sqrt(3.0 * THETA) / (6.0 * 0.63)  # k over the specularity [Pa s/m]

    def slip(height):
        faster = poiseuille(height, push)
        return brentq(
            lambda u: per * friction.sliding_specularity(sticking, sliding, u + faster, THETA) * u - stress, 0.0, 2.0
        )

    least, most = slip(0.0), slip(1.5 * SPACING)
    assert least > 1.15 * stress / (per * sticking)
    y, u = channel(tmp_path, push, 5.0 * (RELAXATION + stress / (push * per * sticking)), friction=mu)
    ours = np.mean(u - poiseuille(y, push))
    print(f"slip {ours:.4f} m/s, exact {least:.4f} to {most:.4f}")
    assert 0.98 * least < ours < 1.02 * most


@pytest.mark.parametrize(("given", "slows"), [(0.1, 0.1), (None, math.sin(math.radians(28.5)))])
def test_a_bed_that_slides_on_a_floor_is_slowed_by_its_friction(tmp_path, given, slows):
    """Grains at rest on each other slide as a slab: mu g; on a rough floor as grains on grains, sin(phi) g."""
    gravity, speed, end = 9.81, 1.0, 0.05
    case = box(
        ["gravity", "granular_pressure", "friction", "walls"], size=(0.06, 0.06), alpha_p=0.605, periodic=("x",),
        fill=(0.06, 0.03), gravity=(0.0, -gravity), walls={} if given is None else {"friction": given},
        grains={"granular_temperature_m2_s2": 1e-10}, **windows(end, 1),
    )  # fmt: skip
    stepper = started(case, tmp_path).stepper
    zeros = np.zeros(len(stepper.state.x))
    push = np.tile((0.0, -gravity, 0.0), (len(zeros), 1))
    for step, length in enumerate((0.3, end)):
        stepper.force(zeros, push, zeros)
        stepper.state.u[:] = step * speed
        stepper.move(length)
    slowed = (speed - np.average(stepper.state.u, weights=stepper.state.mass)) / (end * gravity)
    print(f"slows by {slowed:.3f} g")
    assert slowed == pytest.approx(slows, rel=0.15)


def wedge(folder, lower, upper):
    """A tilted square of lines in the middle of the box, normals outwards."""
    middle, reach = 0.5 * (lower + upper), 0.2 * (upper - lower)
    corners = middle + reach * np.array([[1.0, 0.2], [-0.2, 1.0], [-1.0, -0.2], [0.2, -1.0]])
    corners = corners[::-1]  # clockwise: the left of each line is outside
    path = folder / "wedge.vtk"
    meshio.Mesh(np.column_stack((corners, np.zeros(4))), [("line", np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))]).write(
        path
    )
    return path, corners


def within(corners, x, y):
    """Mask of the points inside the clockwise square."""
    sides = [
        (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) for a, b in zip(corners, np.roll(corners, -1, axis=0))
    ]
    return np.all(np.array(sides) < 0.0, axis=0)


def storm(folder, case, steps, corners=None):
    """Grains flung about at up to 20 m/s, again and again, for `steps` particle-steps; how many got out or in."""
    simulated = started(case, folder)
    stepper, rng = simulated.stepper, np.random.default_rng(3)
    if corners is not None:
        keep = ~within(1.3 * (corners - corners.mean(axis=0)) + corners.mean(axis=0), stepper.state.x, stepper.state.y)
        stepper.replace(type(stepper.state)(*(a[keep] if len(a) else a for a in stepper.state)))
        stepper.prepare()
    count, lost = len(stepper.state.x), 0
    while stepper.steps * count < steps:
        state = stepper.state
        for velocity in (state.u, state.v, state.w):
            velocity[:] = rng.uniform(-20.0, 20.0, len(velocity))
        stepper.force(np.zeros(count), np.zeros((count, 3)), np.zeros(count))
        stepper.move(2e-3)
        stepper.release()
        here = [axis for axis in (stepper.state.x, stepper.state.y, stepper.state.z) if len(axis)]
        out = np.any([(axis < 0.0) | (axis > length) for axis, length in zip(here, case.domain.size)], axis=0)
        if corners is not None:
            out |= within(corners, *here)
        lost += int(out.sum())
    assert stepper.contacts > 100
    return lost


def stormy(size, alpha_p=0.3, **walls):
    none = (0.0,) * len(size)
    bed = {"velocity_m_s": [20.0, *none[1:]], "shape": "box", "lower_m": list(none), "upper_m": list(size),
        "volume_fraction": alpha_p,
           "temperature_K": 300.0}  # fmt: skip
    return box(
        ["granular_pressure", "walls"], size=size, periodic=(), gravity=none, walls=walls, particles={"bed": bed}
    )


def test_nothing_leaks_from_a_box(tmp_path):
    assert storm(tmp_path, stormy((0.1, 0.1)), 500_000) == 0


def test_nothing_leaks_through_a_mesh(tmp_path):
    path, corners = wedge(tmp_path, np.zeros(2), np.full(2, 0.16))
    assert storm(tmp_path, stormy((0.16, 0.16), mesh=str(path)), 500_000, corners) == 0


def test_a_mesh_is_drawn_as_it_is(tmp_path):
    path, corners = wedge(tmp_path, np.zeros(2), np.full(2, 0.16))
    drawn = facets.drawn(str(path), 2)
    np.testing.assert_allclose(drawn.points[:, :2], corners)
    assert drawn.n_lines == len(corners)


@pytest.mark.parametrize("restitution", [0.0, 0.9])
def test_nothing_leaks_in_space(tmp_path, restitution):
    assert storm(tmp_path, stormy((0.04, 0.04, 0.04), restitution=restitution), 100_000) == 0


def test_grains_do_not_depend_on_when_their_rows_were_made(tmp_path):
    """A wall counts where it reaches into the kernel, not where the skin of a row reaches it."""

    def fallen(skin):
        case = box(
            ["gravity", "granular_pressure", "granular_viscosity", "friction", "walls"], size=(0.04, 0.06),
            fill=(0.04, 0.05), alpha_p=0.6, periodic=(), gravity=(5.0, -9.81), boundaries={"around": {"kind": "wall"}},
            resolution={"neighbour_skin": skin}, **windows(1e-2, 5),
        )  # fmt: skip
        folder = tmp_path / str(skin)
        folder.mkdir()
        state = go(started(case, folder)).state
        order = np.argsort(state.ident)
        return np.array([state.u, state.v])[:, order]

    few, often = fallen(0.5), fallen(0.01)
    print(f"{np.abs(few - often).max():.1e} of {np.abs(often).max():.1e} m/s")
    np.testing.assert_allclose(few, often, rtol=0.0, atol=1e-10 * np.abs(often).max())


def test_a_span_of_another_boundary_on_a_side_that_slides_rests():
    lid = {"lid": {"kind": "wall", "side": "top", "velocity_m_s": [1.0, 0.0]}}
    plate = {"plate": {"kind": "wall", "side": "top", "span_m": [0.02, 0.04]}, "rest": {"kind": "wall"}}
    own = box(["granular_pressure", "walls"], (0.06, HEIGHT), ALPHA_P, periodic=(), boundaries=lid | plate)
    table = sides._box(own).table
    above = (table[:, 1] > HEIGHT) & (table[:, 0] > 0.0) & (table[:, 0] < 0.06)
    behind = (table[:, 0] > 0.02) & (table[:, 0] < 0.04)
    assert (above & behind).any() and (above & ~behind).any()
    assert (table[above & behind, 8] == 0.0).all() and (table[above & ~behind, 8] == 1.0).all()
