"""Holes in sheets of moving particles: sites, thickness, sums of growth, rims; nothing lost, nothing when off."""

import math

import numpy as np
import pytest
from moving import SPACING, case

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.engine.neighbours import Neighbours
from sdph.laws import sheets
from sdph.methods.mps import films, holes, sheet
from sdph.methods.mps.method import MpsStepper
from sdph.schema import CaseError

WIDE, LAYERS = 20, 2  # l0
THICK = LAYERS * SPACING
ON = ("free_energy_tension", "laminar_viscosity")
PIERCED = {"perforation": {"thickness_um": 1e6 * 1.25 * THICK, "spacing_mm": 1.0}}
SUCKED = {"suction": {"gas_density_kg_m3": 1.2}}


def film(*effects, sections=None, velocity=(0.0, 0.0, 0.0), layers=LAYERS):
    """A stepper of a film that is periodic on two axes and flies at a velocity [m/s]."""
    size = [WIDE * SPACING, WIDE * SPACING, 20 * SPACING]
    pool = {
        "shape": "box", "lower_m": [0.0, 0.0, 1e-3], "upper_m": [*size[:2], 1e-3 + layers * SPACING], "centre_m": None,
        "radius_m": None, "velocity_m_s": list(velocity),
    }  # fmt: skip
    own = {"domain": {"size_m": size}, "liquid": {"periodic": [1.0, 1.0, 0.0]}, "pools": {"drop": pool}}
    return MpsStepper(case((*ON, *effects), own | (sections or {})))


def perforated(most=1, velocity=(0.0, 0.0, 0.0), **own):
    """A stepper of a film, at rest or not, of which the seed makes `most` particles sites, after the step in which they
    open."""
    ident = np.arange(LAYERS * WIDE**2)
    share = SPACING**3 / (1.25 * THICK * 1e-3**2)
    seed = next(n for n in range(10000) if (holes.drawn(ident, n) < share).sum() == most)
    sections = {"perforation": PIERCED["perforation"] | {"seed": seed} | own}
    stepper = film("perforation", sections=sections, velocity=velocity)
    stepper.step(1e-6)
    return stepper


def test_draws_are_even_and_hang_on_number_and_seed():
    one, other = holes.drawn(np.arange(10000), 1), holes.drawn(np.arange(10000), 2)
    np.testing.assert_allclose(np.histogram(one, 10, (0.0, 1.0))[0], 1000, atol=120)
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.05 and abs(np.corrcoef(one[1:], one[:-1])[0, 1]) < 0.05
    np.testing.assert_array_equal(holes.drawn(np.arange(5000, 6000), 1), one[5000:6000])


@pytest.mark.parametrize("layers", [1, 2, 3])
def test_particles_tell_the_thickness_of_a_film(layers):
    """Of a film of a few layers, within an eighth of it."""
    own = film(layers=layers)
    thickness = np.empty(len(own.state.x))
    films.see(3.1 * SPACING, SPACING**3, own.state, own.rows, own.neighbours.box, thickness)
    assert thickness.mean() == pytest.approx(layers * SPACING, rel=0.125)


@pytest.mark.parametrize(("low", "high"), [(1e-3, 2e-3), (4e-3, 5e-3), (7e-3, 8e-3)])
def test_particles_of_a_sheet_that_thins_tell_its_thickness(low, high):
    """Down to a quarter of a layer, where there are eight within reach: 3 % off, 10 % if none counted itself."""
    own = cases.load(scenes.HERE / "swirl_sheet" / "case.toml", ("resolution.spacing_mm=0.1",))
    places = sheet.ballistic(own, 9e-3)
    s = particles.empty(len(places), set(), 3)
    for axis, column in zip(particles.axes(s), places.T):
        axis[:] = column
    neighbours = Neighbours(3.1 * SPACING)
    s, rows = neighbours.update(s)
    thickness, on = np.empty(len(places)), (s.z > low) & (s.z < high)
    films.see(3.1 * SPACING, SPACING**3, s, rows, neighbours.box, thickness)
    assert thickness[on].mean() == pytest.approx(sheets.thickness(s.z[on], 1.4e-3, 2e-4, 1.0).mean(), rel=0.05)


def test_the_edge_of_a_film_is_no_thin_place():
    """Where a film ends a sphere holds half as many; no hole opens there, but it does inside, in all layers."""
    own = film("perforation", layers=3, sections={"perforation": {"thickness_um": 300.0, "spacing_mm": 0.2}})
    own.take(own.state.x < 0.6 * WIDE * SPACING)
    own._rebuild()
    own.holes.perforation = own.holes.perforation._replace(share=1.0)
    own.holes.advance(own, 1e-9)
    s, opened = own.state, own.holes.opened
    assert own.holes.thickness[s.x < SPACING].max() < 2e-4
    x = s.x[np.isin(s.ident, opened.site)]
    assert x.min() > 1.4 * SPACING and x.max() < (0.6 * WIDE - 1.4) * SPACING
    assert len(np.unique(s.z[np.isin(s.ident, opened.site)])) == 3


def test_a_hole_opens_where_a_film_is_thin_and_nothing_is_lost():
    stepper = perforated()
    mass = stepper.state.mass.sum()
    assert len(stepper.holes.opened.site) == 1
    u = sheets.taylor_culick(0.024, 780.0, THICK)
    assert stepper.holes.opened.speed[0] == pytest.approx(u, rel=0.1)
    while stepper.time < 4.0 * SPACING / u:
        stepper.step(1e-5)
    s, middle = stepper.state, stepper.holes.opened.middle[0]
    away = np.hypot(s.x - middle[0], s.y - middle[1])
    radius = stepper.holes.opened.radius[0] + stepper.holes.opened.speed[0] * stepper.time
    assert (away < radius - SPACING).sum() <= 1 and radius > 4.0 * SPACING
    assert s.mass.sum() == mass and len(stepper.holes.opened.site) == 1
    np.testing.assert_allclose(s.mass @ particles.velocities(s), 0.0, atol=1e-12 * mass * u)
    assert stepper.works[-1] > 0.0


def test_a_hole_flies_with_its_film():
    """At 28 m/s along the film, and through where it is periodic, particles go where they go of one at rest."""
    found = []
    for velocity in ((0.0, 0.0, 0.0), (28.0, 0.0, 0.0)):
        stepper = perforated(velocity=velocity)
        for _ in range(25):
            stepper.step(2e-6)
        s = stepper.state
        assert stepper.time == pytest.approx(5.1e-5) and stepper.works[-1] > 0.0
        places = particles.positions(s)[np.argsort(s.ident)] - stepper.time * np.array(velocity)
        found.append(places)
    apart = found[1] - found[0]
    apart[:, 0] -= WIDE * SPACING * np.round(apart[:, 0] / (WIDE * SPACING))
    assert np.abs(apart).max() < 1e-6 * SPACING


def test_a_thick_film_stays_whole():
    stepper = perforated(thickness_um=0.8e6 * THICK)
    stepper.step(1e-5)
    assert not len(stepper.holes.opened.site) and stepper.works[-1] == 0.0


def test_rims_that_have_met_push_nobody():
    """Two circles over the same place: within both nobody is pushed, else who goes outward slower than the rim is."""
    stepper = perforated(2)
    own = stepper.holes
    assert len(own.opened.site) == 2
    middle, born = np.array([[8e-4, 1e-3, 1.1e-3], [1.2e-3, 1e-3, 1.1e-3]]), np.full(2, stepper.time)
    own.opened = own.opened._replace(
        middle=middle,
        born=born,
        radius=np.full(2, 4e-4),
        velocity=np.zeros((2, 3)),
        normal=np.tile([0.0, 0, 1.0], (2, 1)),
    )
    s = stepper.state
    for speed in (s.u, s.v, s.w):
        speed[:] = 0.0
    change = own._pushed(s, s.kind == 2, stepper.time)
    near = np.array([np.linalg.norm(particles.positions(s) - m, axis=1) < 4e-4 for m in middle])
    assert (near.sum(axis=0) == 2).any() and not change[near.sum(axis=0) != 1].any()
    assert (np.linalg.norm(change[near.sum(axis=0) == 1], axis=1) > 0.0).mean() > 0.9
    for k in range(2):
        np.testing.assert_allclose(change[near[k]].sum(axis=0), 0.0, atol=1e-12)
    s.u[:] = np.where(near[0], -2.0 * own.opened.speed[0] * np.sign(s.x - middle[0, 0]), 0.0)  # another rim's
    away = np.abs(s.y - middle[0, 1]) < 0.6 * SPACING
    assert not own._pushed(s, s.kind == 2, stepper.time)[away & near[0] & ~near[1]].any()


def test_growth_of_waves_adds_up_along_the_path():
    """A film that flies at 28 m/s keeps its thickness, so that the sum is rate times time."""
    stepper = film("suction", sections=SUCKED, velocity=(28.0, 0.0, 0.0))
    for _ in range(5):
        stepper.step(2e-6)
    half = 0.5 * THICK
    k = sheets.fastest_wave(half, 28.0, 1.2, 0.024)
    rate = sheets.wave_growth(k, half, 28.0, 780.0, 1.2, 0.024)
    assert stepper.time == pytest.approx(1e-5)
    assert stepper.holes.growth[stepper.state.ident].mean() == pytest.approx(1e-5 * rate, rel=0.05)
    assert not len(stepper.holes.opened.site)


def test_a_sheet_tears_when_waves_have_grown_so_far_and_only_then():
    stepper = film("suction", sections=SUCKED, velocity=(28.0, 0.0, 0.0))
    stepper.step(1e-6)
    stepper.holes.growth[:] = sheets.TORN - 1e-6
    stepper.step(1e-6)
    opened = stepper.holes.opened
    expected = WIDE**2 / 6.2**2  # one on each square of two reaches: waves are 0.24 mm long
    assert 0.4 * expected < len(opened.site) < 1.8 * expected and opened.held.all()
    stepper.step(1e-6)
    assert len(stepper.holes.opened.site) == len(opened.site)
    assert stepper.holes.told() == {"holes": len(opened.site), "hole_spacing_held_share": 1.0}


def test_where_waves_have_torn_a_sheet_it_tears_no_more():
    """It is the passage that tears: a sheet that goes on to thin has more sites than before."""
    stepper = film("suction", sections=SUCKED, velocity=(28.0, 0.0, 0.0))
    stepper.step(1e-6)
    stepper.holes.growth[:] = sheets.TORN + 1.0
    stepper.step(1e-6)
    assert not len(stepper.holes.opened.site)


def test_long_waves_have_their_own_spacing():
    own = film("suction", sections=SUCKED).holes
    np.testing.assert_allclose(own.spaced(np.array([1e-4, 5e-3])), [2.0 * 3.1 * SPACING, 5e-3])


def test_off_there_is_nothing():
    stepper = film()
    stepper.step(1e-6)
    assert stepper.holes is None and stepper.p["perforation"] == stepper.p["suction"] == ()
    assert stepper.works[-1] == 0.0


@pytest.mark.parametrize(("effect", "sections", "told"), [
    ("perforation", {"perforation": {"thickness_um": 400.0}}, "particles tell the thickness of a sheet up to"),
    ("perforation", {"perforation": {"thickness_um": 100.0, "spacing_mm": 0.05}}, "more holes than there are part"),
    ("suction", SUCKED | {"free_energy_tension": {"coefficient_N_m": 0.0}}, "free_energy_tension above 0"),
])  # fmt: skip
def test_what_cannot_be_is_told(effect, sections, told):
    with pytest.raises(CaseError, match=told):
        film(effect, sections=sections)


def test_a_rim_limits_the_step():
    p = film("perforation", sections=PIERCED)
    row = math.sqrt(2.0 * 0.024 / (780.0 * SPACING / (math.pi * 3.1**2)))
    p.next_step(1.0)
    assert p.limit == "perforation" and p.next_step(1.0) == pytest.approx(0.2 * SPACING / row, rel=1e-3)


def test_one_site_for_each_square_of_the_spacing():
    stepper = film("perforation", sections=PIERCED)
    assert stepper.p["perforation"].share == pytest.approx(SPACING**3 / (1.25 * THICK * 1e-3**2), rel=1e-12)


@pytest.mark.parametrize("seed", [0, 20261128, 2**64 + 1])
def test_any_seed_draws(seed):
    """A date is above 2^24."""
    found = holes.drawn(np.arange(1000), seed)
    assert 0.4 < found.mean() < 0.6 and found.min() >= 0.0 and found.max() < 1.0
