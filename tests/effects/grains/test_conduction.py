"""Conduction by a law of packed beds: heat of pairs, decay of a wave, limit of sub-steps, what is refused."""

import math

import numpy as np
import pytest
from builders import cloud, conduction_heating, disc

from sdph import effects
from sdph.effects.grains import conduction
from sdph.laws import heat, kernels, packed_beds
from sdph.methods.grains import equations as rates
from sdph.methods.grains.scales import Scales
from sdph.schema import CaseError
from sdph.study.explain import tables

PACKED = "conduction.law='zehner_schluender'"
RHO, K, GAS = 3060.0, 500.0, 0.0242  # of the disc


def uneven(count=60):
    """Particles of alpha_p 0.03 to 0.5 at random."""
    rng = np.random.default_rng(5)
    amounts = {"mass": (0.01, 0.02), "temperature": (300.0, 900.0), "density": (0.03 * RHO, 0.5 * RHO)}
    own = {name: rng.uniform(*ends, count) for name, ends in amounts.items()}
    return cloud(rng.uniform(0.0, 0.02, (count, 2)), **own)


def packed(alpha_p):
    return np.array([packed_beds.beside_gas(a, K, GAS) for a in alpha_p])


def kernel():
    return rates.Kernel(4e-3, kernels.normalisation("cubic_spline", 2, 4e-3))


def test_uneven_pairs_keep_the_heat_and_are_those_of_the_law():
    """sum m q = 0 to round-off; q against a sum over all pairs, K = k_bed - alpha_g k_g by harmonic means."""
    p = conduction.kernel(disc(PACKED))
    state, heating = conduction_heating(kernel(), uneven(), p)
    power = state.mass * heating
    assert abs(math.fsum(power)) <= 1e-13 * np.abs(power).sum()
    alpha_p = state.density / RHO
    own = packed(alpha_p)
    r = np.hypot(*(a[:, None] - a[None] for a in (state.x, state.y)))
    slope = np.vectorize(lambda r: kernels.cubic_spline_gradient(r, kernel().h, kernel().sigma))(r)
    mean = 4.0 * own[:, None] * own[None] / (own[:, None] + own[None])
    pairs = mean * state.mass[None] / (state.density[:, None] * state.density[None])
    pairs = pairs * slope * r * r / (r * r + 0.01 * kernel().h ** 2)
    expected = (pairs * (state.temperature[:, None] - state.temperature[None])).sum(axis=1)
    np.testing.assert_allclose(heating, expected, rtol=1e-9, atol=1e-11 * np.abs(expected).max())


def test_a_bed_conducts_as_its_law_and_not_as_one_piece():
    """Heat of an even bed is that of the default with a k that makes alpha_p k the law's."""
    points = (np.stack(np.meshgrid(*2 * [np.arange(12) + 0.5]), axis=-1) * 2.5e-3).reshape(-1, 2)
    lattice, period = rates.kernel_of(disc()), (12 * 2.5e-3, 12 * 2.5e-3, 0.0)

    def heat(p):
        bed = cloud(points, mass=0.6 * RHO * 2.5e-3**2, density=0.6 * RHO, temperature=300.0 + np.sin(np.arange(144.0)))
        return conduction_heating(lattice, bed, p, period)[1]

    own = packed_beds.beside_gas(0.6, K, GAS)
    np.testing.assert_allclose(heat(conduction.kernel(disc(PACKED))), heat(conduction.ConductionP(own / 0.6, RHO)))
    assert own == pytest.approx(packed_beds.zehner_schluender(0.6, K, GAS) - 0.4 * GAS, rel=1e-12)
    assert own < 0.003 * 0.6 * K


def test_limit_is_that_of_the_densest_and_holds_for_all_pairs():
    case, row = disc(PACKED), effects.REGISTRY["conduction"]
    state = uneven()
    state.density[:] = RHO * np.linspace(0.01, 0.6, len(state.x))
    limit = row.dt_limit(row.kernel(case), case, state)
    own = packed(state.density / RHO)
    assert limit == pytest.approx(0.1 * case.smoothing_length**2 / (2.0 * own[-1] / (0.6 * RHO * 2470.0)), rel=1e-12)
    pairs = 2.0 * own[:, None] * own[None] / (own[:, None] + own[None]) / (state.density[:, None] * 2470.0)
    assert limit <= 0.1 * case.smoothing_length**2 / pairs.max()


def test_explain_judges_by_the_law_and_tells_what_one_piece_would_conduct():
    """The Fourier number is that of the law; alpha_p k over the bed's, and 0.3 eps h_c^2 over K, as by hand."""
    one, bed = (conduction.call(Scales(disc(*sets))).number for sets in ((), (PACKED,)))
    own = packed_beds.beside_gas(0.6, K, GAS)
    assert bed / one == pytest.approx(own / (0.6 * K), rel=1e-9)
    for sets, k in (((), 0.6 * K + 0.4 * GAS), ((PACKED,), own + 0.4 * GAS)):
        rows = {row["number"]: row for row in tables.explain(disc(*sets))["numbers"]}
        told = rows["conduction over that of a packed bed"]["value"]
        assert told == pytest.approx(k / packed_beds.zehner_schluender(0.6, K, GAS), rel=1e-9)
        eps = 6.0 * 0.6 * heat.gunn(0.4, 0.0, 1.7895e-5 * 1006.43 / GAS) * GAS / 0.285e-3**2
        spread = rows["heat spread by cells over conduction"]["value"]
        assert spread == pytest.approx(0.3 * eps * 5e-3**2 / (k - 0.4 * GAS), rel=1e-6)


def test_grains_that_insulate_are_refused():
    with pytest.raises(CaseError, match="insulate in gas of 0.0242.*parallel"):
        conduction.kernel(disc(PACKED, "grains.conductivity_W_m_K=0.02"))
