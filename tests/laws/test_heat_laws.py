import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import heat

porosities = st.floats(0.37, 1.0)
reynolds_numbers = st.floats(0.0, 1e4)
prandtl_numbers = st.floats(0.6, 10.0)


@pytest.mark.parametrize("name", sorted(heat.LAWS))
@given(alpha_g=porosities, reynolds=reynolds_numbers, prandtl=prandtl_numbers, more=st.floats(0.1, 100.0))
def test_nusselt_is_at_least_conduction_and_grows_with_wind(name, alpha_g, reynolds, prandtl, more):
    law = heat.LAWS[name]
    assert 2.0 <= law(alpha_g, reynolds, prandtl) < law(alpha_g, reynolds + more, prandtl)


@pytest.mark.parametrize("name", sorted(heat.LAWS))
def test_lone_sphere_at_rest_conducts_only(name):
    assert heat.LAWS[name](1.0, 0.0, 0.7) == 2.0


@given(alpha_g=porosities, reynolds=reynolds_numbers, prandtl=prandtl_numbers)
def test_superficial_and_interstitial_gunn_agree_without_grains_and_order_with_them(alpha_g, reynolds, prandtl):
    assert heat.gunn(1.0, reynolds, prandtl) == heat.gunn_interstitial(1.0, reynolds, prandtl)
    assert heat.gunn(alpha_g, reynolds, prandtl) <= heat.gunn_interstitial(alpha_g, reynolds, prandtl)


@given(alpha_g=porosities, d=st.floats(1e-5, 1e-2))
def test_exchange_is_the_surface_of_spheres_times_h(alpha_g, d):
    nusselt, k = 5.0, 0.0242
    geometric = heat.exchange_geometric(alpha_g, nusselt, k, d)
    assert geometric == pytest.approx(6.0 / d * (nusselt * k / d), rel=1e-14)
    assert heat.exchange_paper(alpha_g, nusselt, k, d) == pytest.approx(alpha_g * geometric, rel=1e-15)


def test_prandtl_number_of_air():
    assert heat.prandtl_number(1.7895e-5, 1006.43, 0.0242) == pytest.approx(0.744, abs=5e-4)
