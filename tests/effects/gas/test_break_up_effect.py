"""Break-up: drops in steady gas follow the equation of TAB and break when it says; mass, momentum and energy close."""

import math

import numpy as np
import pytest
from grain_boxes import Row, box, go, started, windows
from lognormal import raw_moment

from sdph.case import judge
from sdph.effects import OFF, REGISTRY
from sdph.effects.gas import break_up, sizes
from sdph.engine import state as particles
from sdph.laws import break_up as law
from sdph.schema import CaseError

DENSITY, DIAMETER, SIGMA, VISCOSITY, GAS = 700.0, 100e-6, 0.024, 1e-3, 1.225
DROPS = {"density_kg_m3": DENSITY, "diameter_mm": 1e3 * DIAMETER, "surface_tension_N_m": SIGMA}
NUMBER = 10.0  # We of the radius


def slip(number=NUMBER):
    return math.sqrt(number * SIGMA / (GAS * 0.5 * DIAMETER))


def thrown(number):
    """Section of drops that fly into gas at rest, with this Weber number."""
    return {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.06, 0.06], "volume_fraction": 1e-4,
                    "temperature_K": 300.0, "velocity_m_s": [slip(number), 0.0]}}  # fmt: skip


def drops(effects=("break_up",), number=NUMBER, end=1e-4, count=1, products="equal", own=None, **more):
    given = {"liquid_viscosity_Pa_s": VISCOSITY, "products": products} | (own or {})
    coupling = windows(end, count)
    coupling["coupling"] |= more.pop("coupling", {})
    sections = {"break_up": given} if "break_up" in effects else {}
    grains = DROPS | more.pop("grains", {})
    return box(list(effects), alpha_p=1e-4, grains=grains, particles=thrown(number), **sections, **coupling, **more)


def coefficients(radius, number):
    return law.rest(number), law.decay(radius, DENSITY, VISCOSITY), law.stiffness(radius, DENSITY, SIGMA)


def follow(number, end):
    """Radius [m], y and its rate of a drop that breaks again and again, by the laws alone."""
    radius, y, rate, left = 0.5 * DIAMETER, 0.0, 0.0, end
    while True:
        own = coefficients(radius, number)
        time = law.time_to_break(y, rate, *own, left)
        if time > left:
            return radius, *law.after(y, rate, *own, left)
        product = law.product_radius(radius, law.after(y, rate, *own, time)[1], DENSITY, SIGMA)
        number, radius, y, rate, left = number * product / radius, product, 0.0, 0.0, left - time


@pytest.mark.parametrize("number", [3.0, NUMBER, 200.0])
@pytest.mark.parametrize("count", [1, 7, 40])
def test_drops_in_steady_gas(tmp_path, number, count):
    """Whatever the windows, as nothing stops the drops: radius, deformation and its rate."""
    end = 2e-4
    case = drops(number=number, end=end, count=count, coupling={"one_way": True})
    done = go(started(case, tmp_path, Row(case, alpha_g=1.0)))
    radius, y, rate = follow(number, end)
    assert (radius < 0.5 * DIAMETER) == (number > 6.0)
    np.testing.assert_allclose(done.state.diameter, 2.0 * radius, rtol=1e-8)
    np.testing.assert_allclose(done.state.deformation, y, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(done.state.deformation_rate, rate, rtol=1e-5, atol=1e-2)
    np.testing.assert_allclose(done.state.weber, number * 2.0 * radius / DIAMETER, rtol=1e-8)


def test_products_of_the_source_have_its_moments(tmp_path):
    case = drops(end=2e-4, products="chi_squared", coupling={"one_way": True})
    done = go(started(case, tmp_path, Row(case, alpha_g=1.0)))
    radius, *_ = follow(NUMBER, 2e-4)
    mean, std = done.state.diameter[0], math.sqrt(done.state.diameter_variance[0])
    first = 2.0 * radius / 3.0  # mean diameter of r exp(-r/mean) with this Sauter mean
    assert raw_moment(2, mean, std) == pytest.approx(2.0 * first**2, rel=1e-8)
    assert raw_moment(3, mean, std) == pytest.approx(6.0 * first**3, rel=1e-8)
    assert sizes.kernel(case) != OFF and sizes.kernel(drops()) == OFF


def test_mass_momentum_and_energy_close(tmp_path):
    """With drag and agitation: the new surface and the parting come out of the heat of the drops."""
    case = drops(("drag", "conduction", "granular_temperature", "break_up"), 30.0, end=3e-4, count=30)
    done = started(case, tmp_path)
    mass = done.state.mass.copy()
    go(done)
    own, agitated = done.ledger.summary(), 1.5 * done.state.mass @ (done.state.theta - 1e-4)
    radius = 0.5 * done.state.diameter
    surface = 3.0 * SIGMA / DENSITY * (done.state.mass * (1.0 / radius - 2.0 / DIAMETER)).sum()
    assert own["break_up_surface_J"] == pytest.approx(surface, rel=1e-10) and surface > 0.0
    assert own["break_up_agitation_J"] > 0.0 and agitated > 0.0
    assert own["broken_kg"] >= mass.sum() * (1.0 - 1e-12)
    np.testing.assert_array_equal(done.state.mass, mass)
    for drift in ("energy_drift_rel", "motion_drift_rel", "exchange_momentum_mismatch_rel", "mass_drift_rel"):
        assert own[drift] < 1e-10, drift


def test_surface_and_parting_cool_the_drops(tmp_path):
    """Nothing else warms or cools them here: m c (T_0 - T) is the energy of both, to round-off of T."""
    case = drops(("conduction", "granular_temperature", "break_up"), end=2e-4, coupling={"one_way": True},
                 grains={"heat_capacity_J_kg_K": 1.0, "restitution": 0.9999})  # fmt: skip
    done = go(started(case, tmp_path, Row(case, alpha_g=1.0)))
    own = done.ledger.sums
    gone = own["break_up_surface_J"] + own["break_up_agitation_J"] - own["collision_heat_J"]
    assert gone > 0.0
    assert done.state.mass @ (300.0 - done.state.temperature) == pytest.approx(gone, rel=1e-8)


def test_evaporation_begins_anew_for_the_products():
    """What small drops of the parent had lost is not taken from the products."""
    names = {*break_up.EFFECT.arrays, *REGISTRY["evaporation"].arrays}
    s = particles.empty(2, names)
    s.mass[:], s.diameter[:], s.born_mass[:], s.born_diameter[:] = 1.0, DIAMETER, 2.0, 2.0 * DIAMETER
    s.lost_still[:], s.lost_moving[:] = 1e-9, 1e-8
    blown = np.array([slip(20.0), 0.0])  # the second feels nothing
    told = break_up.apply(break_up.kernel(drops()), s, blown, np.full(2, GAS), 2e-4)
    assert told["broken_kg"] == 1.0 and s.diameter[0] < 0.5 * DIAMETER and s.diameter[1] == DIAMETER
    assert (s.lost_still[0], s.lost_moving[0], s.born_mass[0], s.born_diameter[0]) == (0.0, 0.0, 1.0, s.diameter[0])
    assert (s.lost_still[1], s.lost_moving[1], s.born_mass[1], s.born_diameter[1]) == (1e-9, 1e-8, 2.0, 2.0 * DIAMETER)


def test_windows_are_short_for_drops_that_can_break():
    """A tenth of the time in which drag stops them; none for those that stay whole."""
    p, s = break_up.kernel(drops()), particles.empty(2, break_up.EFFECT.arrays)
    s.diameter[:], s.weber[:] = DIAMETER, (NUMBER, 5.0)
    expected = 0.1 * 8.0 / 3.0 * DENSITY / GAS * 0.5 * DIAMETER / slip()
    assert break_up.window_limit(p, None, s) == pytest.approx(expected, rel=1e-12)
    s.weber[0] = 5.9
    assert break_up.window_limit(p, None, s) == math.inf


def test_off_has_no_arrays_and_says_nothing(tmp_path):
    done = go(started(case := drops(("drag",)), tmp_path, Row(case)))
    assert not len(done.state.deformation) and not len(done.state.weber)
    assert "broken_kg" not in done.ledger.summary() and done.ledger.sums["broken_kg"] == 0.0


def test_it_is_judged_where_the_case_has_its_section():
    own = judge.judgements(drops())
    assert own["break_up"].number == pytest.approx(NUMBER / 6.0, rel=1e-6)
    assert "break_up" not in judge.judgements(drops(("drag",)))


def test_without_surface_tension_nothing_holds_drops():
    with pytest.raises(CaseError, match="needs grains.surface_tension_N_m"):
        break_up.kernel(box(["break_up"], break_up={"liquid_viscosity_Pa_s": 1e-3}))


def test_without_agitation_no_product_parts():
    """What has no theta has nowhere to put the energy of parting: the drops pay for their surface alone."""
    s = particles.empty(1, {*break_up.EFFECT.arrays, "temperature"} - {"theta"})
    s.mass[:], s.diameter[:], s.temperature[:] = 1.0, DIAMETER, 300.0
    p = break_up.kernel(drops())
    told = break_up.apply(p, s, np.array([slip(20.0)]), np.full(1, GAS), 2e-4)
    assert told["broken_kg"] == 1.0 and told["break_up_agitation_J"] == 0.0
    assert 300.0 - s.temperature[0] == pytest.approx(told["break_up_surface_J"] / p.heat_capacity, rel=1e-6)
