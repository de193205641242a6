"""Liquids that thin: flow between plates against the exact profile, shear rates, momentum, limits, nothing when off."""

import numpy as np
import pytest

from sdph import effects, scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.effects.liquids import laminar_viscosity, shear_thinning
from sdph.engine import kernels
from sdph.engine.state import LIQUID, positions
from sdph.laws import thinning as law
from sdph.methods.liquids.history import _told
from sdph.methods.liquids.loads import loads, wall_loads
from sdph.methods.liquids.method import LiquidStepper
from sdph.schema import CaseError
from sdph.study.explain import tables

POISEUILLE = scenes.HERE / "poiseuille" / "case.toml"
LIMITS = {"least_viscosity_Pa_s": 1e-3, "most_viscosity_Pa_s": 1.0}
OTHERS = {
    "carreau": {"model": "carreau", "index": 0.4, "time_s": 2.0, "infinite_viscosity_Pa_s": 0.01},
    "herschel_bulkley": {"model": "herschel_bulkley", "index": 0.7, "time_s": 20.0, "yield_stress_Pa": 0.03},
}


def channel(viscosity=0.1, spacing=25.0, more=(), **own):
    table = cases.to_table(
        cases.load(POISEUILLE, (f"liquid.viscosity_Pa_s={viscosity}", f"resolution.spacing_mm={spacing}", *more))
    )
    table["effects"] = [name.replace("laminar_viscosity", "shear_thinning") for name in table["effects"]]
    return cases.from_table(table | {"shear_thinning": {"model": "power_law", "index": 1.0} | LIMITS | own})


def gone(case, end):
    own = LiquidStepper(case)
    while own.time < end:
        own.step(end - own.time)
    return own


# K so that the exact flow is 1 m/s fast in the middle; ends long after the slowest mode, of about n K gamma^(n-1)
# (pi/H)^2
@pytest.mark.parametrize(
    ("index", "viscosity", "most", "end"),
    [(0.5, 0.8 / 24.0**0.5, 0.5, 14.0), (1.5, 0.8 / (0.5 ** (-5.0 / 3.0) / 0.6) ** 1.5, 1.0, 8.0)],
)
def test_flow_of_a_power_law_between_plates(index, viscosity, most, end):
    """The exact profile within 1 % of its largest velocity, everywhere."""
    own = gone(channel(viscosity, index=index, most_viscosity_Pa_s=most), end)
    wet = own.state.kind == LIQUID
    u = law.between_plates(own.state.y[wet], 1.0, 0.8, viscosity, index)
    assert law.between_plates([0.5], 1.0, 0.8, viscosity, index)[0] == pytest.approx(1.0, rel=1e-12)
    error = own.state.u[wet] - u
    mean = np.sqrt(np.mean(error**2))
    print(f"power law, n = {index}: L2 {mean:.2e}, largest {np.abs(error).max():.2e}, steps {own.steps}")
    assert np.abs(error).max() < 0.01


def stirred(case, dimensions=2):
    """The channel's liquid with a smooth flow, on places that are off the lattice by a tenth."""
    own, random = LiquidStepper(case), np.random.default_rng(3)
    wet = own.state.kind == LIQUID
    for axis in (own.state.x, own.state.y):
        axis[wet] += 2.5e-3 * random.uniform(-1.0, 1.0, wet.sum())
    x, y = own.state.x[wet], own.state.y[wet]
    own.state.u[wet], own.state.v[wet] = 3.0 * x + 2.0 * y, 5.0 * x - 3.0 * y
    own.forces()
    return own


@pytest.mark.parametrize("model", ["power_law", *OTHERS])
def test_each_particle_has_the_viscosity_of_its_own_shear_rate(model):
    """Of a linear flow sqrt(2 D:D) = sqrt(4 a^2 + (b + c)^2), exact on shaken places away from ends."""
    own = stirred(channel(**OTHERS.get(model, {"index": 0.5})))
    rate = np.sqrt(4.0 * 9.0 + 49.0)
    p = own.p["shear_thinning"]
    expected = {
        "power_law": lambda: law.power_law(rate, 0.1, 0.5),
        "carreau": lambda: law.carreau(rate, 0.1, 0.4, 2.0, 0.01),
        "herschel_bulkley": lambda: law.herschel_bulkley(rate, 0.1, 0.7, 20.0, 0.03),
    }[model]()
    r = positions(own.state)
    inside = (own.state.kind == LIQUID) & (np.abs(r[:, 0] - 0.25) < 0.15) & (np.abs(r[:, 1] - 0.5) < 0.4)
    np.testing.assert_allclose(own.state.viscosity[inside], expected, rtol=1e-10)
    assert p.least < expected < p.most


def test_images_of_walls_mirror_the_middle_of_what_is_in_front():
    """2 depth n - m of every wall particle: m the mean way to the liquid that it sees, n its direction."""
    own = stirred(channel(index=0.5))
    image = np.zeros((len(own.state.x), 3))
    shear_thinning.images(own.kernel, own.state, own.rows, own.neighbours.box, own.walls, own.volume, image)
    places, length = positions(own.state)[:, :2], own.case.domain.size[0]
    wet, seen = np.flatnonzero(own.volume > 0.0), 0
    for i in own.walls:
        way = places[wet] - places[i]
        way[:, 0] -= length * np.rint(way[:, 0] / length)
        value = np.array([kernels.value(own.kernel, float(np.hypot(*each))) for each in way])
        if value.sum() > 0.0:
            mean = value @ way / value.sum()
            expected = 2.0 * own.state.depth[i] * mean / np.hypot(*mean) - mean
            np.testing.assert_allclose(image[i, :2], expected, rtol=1e-9, atol=1e-12)
            seen += abs(mean[0]) > 1e-6
    assert seen > 10  # the liquid is off the lattice: the mean is not straight ahead


def test_a_linear_flow_along_a_wall_is_sheared_alike_up_to_the_wall():
    """Walls count where a linear flow has their velocity: without that the first layer would see 6 % less."""
    own = LiquidStepper(channel(index=0.5))
    wet = own.state.kind == LIQUID
    own.state.u[wet] = 2.0 * own.state.y[wet]
    own.forces()
    low = (own.state.kind == LIQUID) & (own.state.y < 0.7)
    np.testing.assert_allclose(own.state.viscosity[low], law.power_law(2.0, 0.1, 0.5), rtol=1e-10)


def test_pairs_share_momentum_and_walls_feel_the_rest():
    """What the liquid gains is what acts from outside, less what its walls feel, particle by particle."""
    own = stirred(channel(index=0.5))
    assert np.ptp(own.state.viscosity[own.active]) > 0.01
    momentum, felt = loads(own), wall_loads(own)
    np.testing.assert_allclose(momentum[:2], felt[:2], atol=1e-10 * np.abs(felt).max())


def test_limits_of_the_viscosity_hold_and_are_counted():
    own = LiquidStepper(channel(index=0.5))  # at rest: no shear
    count = len(own.active)
    assert (own.state.viscosity[own.active] == 1.0).all()
    told = _told(own)
    assert told == {
        "viscosity_smallest_Pa_s": 1.0,
        "viscosity_largest_Pa_s": 1.0,
        "at_least_viscosity": 0.0,
        "at_most_viscosity": count,
    }
    thick = LiquidStepper(channel(index=1.5))
    assert _told(thick)["at_least_viscosity"] == count


def test_the_step_is_that_of_the_largest_viscosity_now():
    case = channel(index=0.5, spacing=50.0)
    own = LiquidStepper(case)
    at_rest = 0.125 * (1.5 * 0.05) ** 2 / 1.0
    assert own.next_step(1.0) == pytest.approx(at_rest, rel=1e-3) and own.limit == "shear_thinning"
    (row,) = [row for row in tables.explain(case)["limits"] if row["cause"] == "shear_thinning"]
    assert row["largest [s]"] == pytest.approx(at_rest, rel=1e-12)
    moved = stirred(case)
    p, largest = moved.p["shear_thinning"], moved.state.viscosity.max()
    assert largest < 1.0
    assert shear_thinning.dt_limit(p, case, moved.state) == pytest.approx(
        0.125 * (1.5 * 0.05) ** 2 / largest, rel=1e-12
    )


def test_off_there_is_no_array():
    case = cases.load(POISEUILLE)
    own = LiquidStepper(case)
    assert (
        len(own.state.viscosity) == 0
        and own.p["shear_thinning"] == effects.OFF
        and not own.renewing
        and _told(own) == {}
    )
    assert len(own.state.depth) == 0 and laminar_viscosity.pair(own.p["laminar_viscosity"], own.state, 0, 1) == 0.2


def test_explain_knows_what_it_is_for():
    judged = judge.judgements(channel(0.05, index=0.5))
    assert judged["shear_thinning"].number > 0.01 and judged["laminar_viscosity"].error_if_off == 0.0


@pytest.mark.parametrize(
    ("own", "text"),
    [
        (
            {"most_viscosity_Pa_s": 1e-4},
            "least_viscosity_Pa_s = 0.001; it must not be above most_viscosity_Pa_s = 0.0001",
        ),
        ({"model": "carreau"}, "shear_thinning.time_s is missing; model = 'carreau' needs it"),
        ({"model": "herschel_bulkley", "time_s": 1.0}, "shear_thinning.yield_stress_Pa is missing"),
        ({"index": 0.0}, "shear_thinning.index"),
        ({"model": "cross"}, "allowed: power_law, carreau, herschel_bulkley"),
    ],
)
def test_bad_input_is_one_line(own, text):
    with pytest.raises(CaseError, match=text) as told:
        LiquidStepper(channel(**own))
    assert "\n" not in str(told.value)


def test_it_takes_the_place_of_laminar_viscosity():
    table = cases.to_table(channel())
    table["effects"].append("laminar_viscosity")
    with pytest.raises(CaseError, match="laminar_viscosity and shear_thinning, which takes its place; leave one out"):
        LiquidStepper(cases.from_table(table))
