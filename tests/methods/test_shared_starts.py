"""Processes that each make a part of the particles at the start make together what one makes, to the last bit."""

import functools

import numpy as np
import pytest
import pyvista

from sdph import effects
from sdph.api.case import Case
from sdph.case.sections import Region
from sdph.engine import gathered, regions
from sdph.engine import state as particles
from sdph.engine.domain import Domain
from sdph.engine.neighbours import Neighbours
from sdph.engine.state import WALL
from sdph.engine.walls import facets
from sdph.methods.grains import start as grains
from sdph.methods.liquids import start as liquids
from tests.of_ranks import Among, together

OF_GRAINS = {
    "box": ("bubbling_bed", {}),
    "box in space, by chance": ("bubbling_bed_3d", {"particles.bed.disorder": 0.2, "particles.bed.seed": 3}),
    "disc": ("disc_cluster", {}),
    "up to a level": ("bubbling_bed", {"particles.bed.height_m": 0.2, "particles.bed.disorder": 0.1}),
    "of a mass": ("bubbling_bed", {"particles.bed.mass_kg": 100.0, "particles.bed.disorder": 0.1}),
    "two materials": ("segregation", {}),
}
OF_LIQUIDS = {
    "box in a tank": ("dam_break", {}),
    "in space": ("dam_break_3d", {"resolution.spacing_mm": 5.715}),
    "two phases": ("water_under_air", {}),
    "disc on a plate": ("drop_on_plate", {}),
    "tank": ("sloshing_sphere", {}),
    "disc": ("oscillating_droplet", {}),
    "vortices": ("taylor_green", {}),
    "pipe": ("sloshing_cassini", {}),
}
COARSE = {"resolution.spacing_mm": 10.0, "resolution.cell_mm": 20.0}


def case_of(name: str, changes: dict, more=()):
    case = Case.load(name)
    case.update(dict(more) | changes)
    return case.resolved


def same(parts: list, whole) -> None:
    """Parts make up the whole."""
    ident = np.concatenate([part.ident for part in parts])
    order = np.argsort(ident, kind="stable")
    for name, values in whole._asdict().items():
        found = np.concatenate([getattr(part, name) for part in parts])
        np.testing.assert_array_equal(found[order] if len(values) else found, values, err_msg=name)


@pytest.mark.parametrize("number", [2, 3])
@pytest.mark.parametrize("name", OF_GRAINS)
def test_grains(name, number):
    case = case_of(*OF_GRAINS[name], {} if name in ("disc", "two materials") else COARSE)
    names, told, mass = effects.arrays(case), [[] for _ in range(number + 1)], [{} for _ in range(number + 1)]
    whole = grains.fill(case, names, told[-1], mass[-1])
    worlds = Among.several(number)
    parts = together(lambda own: grains.fill(case, names, told[own.rank], mass[own.rank], own), worlds)
    same(parts, whole)
    even = name != "up to a level"  # of its lattice each has a share, and the first ones have what is low
    assert max(len(part.x) for part in parts) <= 1.3 * len(whole.x) / number or not even
    assert told[0] == told[-1] and mass[0] == pytest.approx(mass[-1], rel=1e-12)


@pytest.mark.parametrize("number", [2, 3])
@pytest.mark.parametrize("name", OF_LIQUIDS)
def test_liquids(name, number):
    case = case_of(*OF_LIQUIDS[name])
    parts = together(lambda own: liquids.fill(case, own), Among.several(number))
    same(parts, whole := liquids.fill(case))
    assert max(len(part.x) for part in parts) <= 1.2 * len(whole.x) / number + 100


def test_particles_come_to_their_part_of_space_in_the_order_they_were_made_in():
    case = case_of("dam_break", {})
    whole = liquids.fill(case)

    def shared(own, parted):
        domain = Domain(own, 2.0 * case.smoothing_length, np.zeros(2))
        domain.parted = parted
        state = domain.share(liquids.fill(case, own) if parted else whole)
        return particles.take(state, state.copy == 0)

    cut, all_made = (together(functools.partial(shared, parted=way), Among.several(4)) for way in (True, False))
    for found, known in zip(cut, all_made):
        for name in ("ident", "x", "y", "mass", "density", "kind"):
            np.testing.assert_array_equal(getattr(found, name), getattr(known, name))


FEW = {
    "box": ("bubbling_bed", {"particles.bed.upper_m": [0.03, 0.02], "particles.bed.lower_m": [0.0, 0.0]}),
    "by height": ("bubbling_bed", {"particles.bed.upper_m": [0.03, 0.04], "particles.bed.height_m": 0.02}),
    "by mass": ("bubbling_bed", {"particles.bed.upper_m": [0.03, 0.04], "particles.bed.mass_kg": 0.5}),
    "disc": ("disc_cluster", {"particles.disc.radius_m": 0.006}),
    "two materials": ("segregation", {"resolution.spacing_mm": 20.0}),
}


@pytest.mark.parametrize("name", FEW)
def test_some_processes_make_no_grains(name):
    case = case_of(*FEW[name], COARSE if FEW[name][0] == "bubbling_bed" else {})
    names = effects.arrays(case)
    whole = grains.fill(case, names)
    parts = together(lambda own: grains.fill(case, names, world=own), Among.several(len(whole.x) + 2))
    assert min(len(part.x) for part in parts) == 0
    same(parts, whole)


FEW_OF_LIQUID = {
    "column": ("dam_break", {"pools.column.upper_m": [0.03, 0.02], "resolution.spacing_mm": 10.0}),
    "in space": ("dam_break_3d", {"resolution.spacing_mm": 14.0}),
    "tank": ("sloshing_sphere", {"resolution.spacing_mm": 150.0}),
    "drop": ("oscillating_droplet", {"resolution.spacing_mm": 0.5}),
}


@pytest.mark.parametrize("name", FEW_OF_LIQUID)
def test_some_processes_make_no_liquid(name):
    case = case_of(*FEW_OF_LIQUID[name])
    whole = liquids.fill(case)
    parts = together(lambda own: liquids.fill(case, own), Among.several(int((whole.kind != WALL).sum()) + 2))
    same(parts, whole)


def region(shape, **keys):
    return Region(shape=shape, volume_fraction=0.5, temperature=300.0, **keys)


@pytest.mark.parametrize("number", [2, 5, 40])
@pytest.mark.parametrize("shape", ["box", "sphere", "cylinder", "cone", "mesh", "walls"])
def test_regions_in_space(tmp_path, shape, number):
    """Of some lattices ends are cut off, so that the first process has nothing of them."""
    ball = pyvista.Sphere(radius=0.1, center=(0.1, 0.1, 0.1))
    ball.save(tmp_path / "ball.stl")
    ball.flip_faces().save(tmp_path / "walls.stl")
    walls, place = facets.read(str(tmp_path / "walls.stl"), 3), {"centre": (0.1, 0.1, 0.1), "radius": 0.1}
    own = {
        "box": region(shape, lower=(0.0, 0.0, 0.0), upper=(0.05, 0.05, 0.1)),
        "sphere": region(shape, **place),
        "cylinder": region(shape, **place, length=0.2, axis="z"),
        "cone": region(shape, **place, length=0.2, axis="z", end_radius=0.0),
        "mesh": region(shape, mesh=str(tmp_path / "ball.stl")),
        "walls": region(shape),
    }[shape]

    def stand(world):
        points = regions.points(own, 0.03, 3, walls, world)
        return points[regions.in_front(points, walls, 0.03, 3)]

    (whole,) = together(stand, Among.several(1))
    parts = together(stand, Among.several(number))
    np.testing.assert_array_equal(np.concatenate(parts), whole)
    assert {part.shape[1] for part in parts} == {3} and (number < 40 or min(map(len, parts)) == 0)


class Sharing:
    """What `gathered.whole` takes of a stepper: particles in space, of which each process has made a part."""

    ROWS = ("heights",)

    def __init__(self, state, world):
        self.neighbours = Neighbours(0.02, (0.0, 0.0, 0.0), world=world)
        self.domain = self.neighbours.domain
        self.domain.parted = world.number > 1
        self.state, _ = self.neighbours.update(state)
        self.heights = self.state.z.copy()


def test_a_process_without_particles_shares_space():
    """The last of three makes none at first; of two places that hold all, the second has none of from then on."""
    state = particles.empty(6, dimensions=3)
    state.ident[:], state.x[:], state.z[:] = np.arange(6), np.arange(6) // 4, 0.5 * (np.arange(6) // 4)

    def share(world):
        own = Sharing(particles.take(state, np.flatnonzero(np.arange(6) // 3 == world.rank)), world)
        with gathered.whole(own) as chief:
            found = own.state.ident.tolist(), own.heights.tolist(), [len(axis) for axis in own.neighbours.built]
        return len(own.domain.own(own.state).x), len(own.neighbours.built), found if chief else None

    found = together(share, Among.several(3))
    assert [own[:2] for own in found] == [(4, 3), (0, 3), (2, 3)]
    ident, heights, built = found[0][2]
    assert ident == list(range(6)) and heights == state.z.tolist() and built == [6, 6, 6]


def test_space_is_cut_anew_by_all_processes_or_by_none():
    """One of which has lost a particle since its neighbours were counted, and the other one not."""
    state = particles.empty(8, dimensions=3)
    state.ident[:], state.x[:] = np.arange(8), np.arange(8)

    def share(world):
        own = Sharing(particles.take(state, np.flatnonzero(state.ident % 2 == world.rank)), world)
        own.domain.imbalance = 2.0
        kept = particles.take(own.state, own.state.ident > 0)
        return own.domain.share(kept).ident.tolist()

    assert together(share, Among.several(2)) == [[1, 2, 3], [4, 5, 6, 7]]
