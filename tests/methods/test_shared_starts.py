"""Processes that each make a part of the particles at the start make together what one makes, to the last bit."""

import functools

import numpy as np
import pytest

from sdph import effects
from sdph.api.case import Case
from sdph.engine import state as particles
from sdph.engine.domain import Domain
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
