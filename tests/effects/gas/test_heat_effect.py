"""The heat term of one particle: the laws with the particle's own numbers, choices by name."""

import numpy as np
import pytest
from builders import disc
from hypothesis import given
from hypothesis import strategies as st
from lognormal import mass_moment

from sdph import effects
from sdph.effects import OFF
from sdph.effects.gas import heat, sizes
from sdph.engine import state as particles
from sdph.laws import heat as law

PRANDTL = law.prandtl_number(1.7895e-5, 1006.43, 0.0242)


def one_grain(mass=2.0, diameter=285e-6, variance=0.0):
    state = particles.empty(1, ("temperature", "diameter", "diameter_variance"))
    state.mass[:], state.diameter[:], state.diameter_variance[:] = mass, diameter, variance
    return state


@pytest.mark.parametrize("name", heat.LAWS)
@pytest.mark.parametrize("closure", heat.CLOSURES)
@given(alpha_p=st.floats(0.01, 0.62), slip=st.floats(0.0, 5.0), gas_density=st.floats(0.5, 5.0))
def test_conductance_is_the_law_of_its_name(name, closure, alpha_p, slip, gas_density):
    p = heat.kernel(disc(f"heat.law={name!r}", f"heat.closure={closure!r}"))
    found = heat.conductance(p, OFF, one_grain(), 0, alpha_p, slip, gas_density)
    nusselt = law.LAWS[name](1.0 - alpha_p, gas_density * slip * 285e-6 / 1.7895e-5, PRANDTL)
    expected = 2.0 / 3060.0 * law.CLOSURES[closure](1.0 - alpha_p, nusselt, 0.0242, 285e-6)
    assert found == pytest.approx(expected, rel=1e-13)


def test_every_law_and_closure_can_be_chosen():
    assert set(heat.LAWS) == set(law.LAWS)
    assert set(heat.CLOSURES) == set(law.CLOSURES)


def test_off_is_nothing():
    assert heat.conductance(OFF, OFF, one_grain(), 0, 0.5, 1.0, 1.2) == 0.0


@given(std=st.floats(0.001, 0.285))
def test_grains_of_all_sizes_exchange_by_their_surface_and_film(std):
    """With Nu = 2 exchange goes as 1/d^2, whose mass average over the log-normal law is known in closed form."""
    alike, spread = (disc(f"grains.diameter_std_mm={each!r}", "heat.law='ranz_marshall'") for each in (0.0, std))
    assert sizes.kernel(alike) == OFF
    state = one_grain(variance=(std * 1e-3) ** 2)
    found = heat.conductance(heat.kernel(spread), sizes.kernel(spread), state, 0, 0.5, 0.0, 1.2)
    single = heat.conductance(heat.kernel(alike), OFF, state, 0, 0.5, 0.0, 1.2)
    assert found / single == pytest.approx(mass_moment(-2.0, 285e-6, std * 1e-3) * 285e-6**2, rel=2e-3)


def test_registry_rows_are_whole():
    case = disc()
    for name, row in effects.REGISTRY.items():
        assert row.name == name and row.summary
        assert set(row.arrays) <= set(particles.FIELDS)
        assert effects.kernel_of(row, case) == OFF or name in case.effects


def test_conduction_limit_is_that_of_diffusion():
    case, row = disc(), effects.REGISTRY["conduction"]
    limit = row.dt_limit(row.kernel(case), case, None)
    assert limit == pytest.approx(0.1 * 3060.0 * 2470.0 * case.smoothing_length**2 / 500.0, rel=1e-12)
    insulating = disc("grains.conductivity_W_m_K=1e-300")
    assert row.dt_limit(row.kernel(insulating), insulating, None) > 1e290
    assert np.isfinite(limit)
