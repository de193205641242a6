import math

import exact_solutions as exact
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_values import BED

from sdph.laws import granular

RHO, D = BED["rho"], BED["d"]
ALPHA_MAX = 0.63
TRANSPORT = [
    granular.gidaspow_collisional_viscosity,
    granular.gidaspow_kinetic_viscosity,
    granular.gidaspow_viscosity,
    granular.lun_bulk_viscosity,
    granular.gidaspow_conductivity,
]

fractions = st.floats(0.01, 0.62)
thetas = st.floats(1e-6, 10.0)
restitutions = st.floats(0.5, 0.99)
steps = st.floats(1e-7, 10.0)


def g0_of(alpha_p):
    return granular.sinclair_jackson(alpha_p, ALPHA_MAX)


@given(alpha_p=st.floats(0.01, 0.61))
def test_radial_distribution_and_its_slope(alpha_p):
    step = 1e-6
    difference = (g0_of(alpha_p + step) - g0_of(alpha_p - step)) / (2.0 * step)
    assert g0_of(alpha_p) > 1.0
    slope = granular.sinclair_jackson_slope(alpha_p, ALPHA_MAX)
    assert slope == pytest.approx(difference, rel=1e-6)
    assert granular.crowding_slope(alpha_p, g0_of(alpha_p)) == pytest.approx(slope, rel=1e-13)


def test_radial_distribution_of_nothing_is_one():
    assert g0_of(0.0) == 1.0


def test_gap_form_of_sinclair_jackson():
    gap = D * ((ALPHA_MAX / 0.4) ** (1.0 / 3.0) - 1.0)
    assert g0_of(0.4) == pytest.approx((gap + D) / gap, rel=1e-13)


@given(alpha_p=st.floats(0.0, 2.0))
def test_capped_fraction_stays_short_of_the_pole(alpha_p):
    capped = granular.capped_fraction(alpha_p, ALPHA_MAX)
    assert capped == (alpha_p if alpha_p <= 0.62 else 0.62)
    assert 1.0 <= g0_of(capped) < 200.0


@given(alpha_p=st.floats(0.01, 0.61), theta=thetas, e=restitutions)
def test_pressure_slope(alpha_p, theta, e):
    step = 1e-6
    high, low = (granular.lun_pressure(a, theta, e, g0_of(a), RHO) for a in (alpha_p + step, alpha_p - step))
    slope = granular.sinclair_jackson_slope(alpha_p, ALPHA_MAX)
    computed = granular.lun_pressure_slope(alpha_p, theta, e, g0_of(alpha_p), slope, RHO)
    assert computed == pytest.approx((high - low) / (2.0 * step), rel=1e-6)


@given(alpha_p=st.floats(0.05, 0.6), theta=thetas, e=restitutions)
def test_sound_speed_is_the_slope_along_an_isentrope(alpha_p, theta, e):
    """Compress by d alpha; theta rises by the work of the pressure, 3/2 alpha rho d theta = p_s d alpha/alpha."""
    d_alpha = 1e-6 * alpha_p

    def pressure(sign):
        p = granular.lun_pressure(alpha_p, theta, e, g0_of(alpha_p), RHO)
        heated = theta + sign * d_alpha * 2.0 / 3.0 * p / (alpha_p**2 * RHO)
        squeezed = alpha_p + sign * d_alpha
        return granular.lun_pressure(squeezed, heated, e, g0_of(squeezed), RHO)

    slope = (pressure(1.0) - pressure(-1.0)) / (2.0 * d_alpha * RHO)
    g0_slope = granular.sinclair_jackson_slope(alpha_p, ALPHA_MAX)
    computed = granular.sound_speed_squared(alpha_p, theta, e, g0_of(alpha_p), g0_slope, RHO, 1000.0)
    assert computed == pytest.approx(slope + 1000.0 / RHO, rel=1e-6)


@pytest.mark.parametrize("law", TRANSPORT, ids=lambda law: law.__name__)
@given(alpha_p=fractions, theta=thetas, e=restitutions)
def test_transport_is_positive_and_scales_with_the_root_of_theta(law, alpha_p, theta, e):
    value = law(alpha_p, theta, e, g0_of(alpha_p), RHO, D)
    assert value > 0.0
    assert law(alpha_p, 4.0 * theta, e, g0_of(alpha_p), RHO, 3.0 * D) == pytest.approx(6.0 * value, rel=1e-12)
    assert law(alpha_p, 0.0, e, g0_of(alpha_p), RHO, D) == 0.0


@pytest.mark.parametrize("law", TRANSPORT, ids=lambda law: law.__name__)
def test_transport_is_finite_without_grains(law):
    assert math.isfinite(law(0.0, 0.01, 0.9, 1.0, RHO, D))


@given(alpha_p=fractions, theta=thetas, e=restitutions)
def test_dissipation(alpha_p, theta, e):
    assert granular.lun_dissipation(alpha_p, theta, e, g0_of(alpha_p), RHO, D) > 0.0
    assert granular.lun_dissipation(alpha_p, theta, 1.0, g0_of(alpha_p), RHO, D) == 0.0


@given(alpha_p=fractions, theta=thetas, e=restitutions)
def test_cooling_is_the_dissipation_per_mass(alpha_p, theta, e):
    gamma = granular.lun_dissipation(alpha_p, theta, e, g0_of(alpha_p), RHO, D)
    cooling = granular.cooling_coefficient(alpha_p, e, g0_of(alpha_p), D)
    assert cooling * theta**1.5 == pytest.approx(2.0 / 3.0 * gamma / (alpha_p * RHO), rel=1e-12)
    assert granular.cooling_coefficient_paper(alpha_p, e, g0_of(alpha_p), D) * alpha_p == pytest.approx(cooling)
    damping = granular.damping_rate(5e3 / RHO)
    assert damping * theta == pytest.approx(2.0 / 3.0 * 3.0 * alpha_p * 5e3 * theta / (alpha_p * RHO))


@given(theta=thetas, cooling=st.floats(0.0, 1e5), damping=st.floats(0.0, 1e3), dt=steps, parts=st.integers(2, 5))
def test_theta_step_does_not_depend_on_how_time_is_cut(theta, cooling, damping, dt, parts):
    cut = theta
    for _ in range(parts):
        cut = granular.theta_step(cut, cooling, damping, dt / parts)
    assert granular.theta_step(theta, cooling, damping, dt) == pytest.approx(cut, rel=1e-9, abs=1e-290)
    assert 0.0 <= cut <= theta


@given(theta=thetas, cooling=st.floats(1.0, 1e5), dt=st.floats(1e-7, 1.0))
def test_theta_step_tends_to_haff_without_drag_and_to_decay_without_collisions(theta, cooling, dt):
    haff = exact.haff_cooling(dt, theta, cooling)
    assert granular.theta_step(theta, cooling, 0.0, dt) == pytest.approx(haff, rel=1e-12)
    assert granular.theta_step(theta, cooling, 1e-12, dt) == pytest.approx(haff, rel=1e-10)
    assert granular.theta_step(theta, 0.0, 3.0, dt) == pytest.approx(theta * math.exp(-3.0 * dt), rel=1e-12)
    assert granular.theta_step(0.0, cooling, 3.0, dt) == 0.0


@given(
    alpha_p=st.floats(0.01, 0.6),
    e=restitutions,
    shear=st.floats(1e-2, 1e5),
    div=st.floats(-50.0, 50.0),
    beta=st.floats(0.0, 1e5),
)
def test_equilibrium_balances_shear_compression_collisions_and_drag(alpha_p, e, shear, div, beta):
    g0 = g0_of(alpha_p)
    theta = granular.equilibrium_theta(alpha_p, e, g0, RHO, D, shear, div, beta)
    made = 4.0 * shear * granular.gidaspow_viscosity(alpha_p, theta, e, g0, RHO, D)
    made += div**2 * granular.lun_bulk_viscosity(alpha_p, theta, e, g0, RHO, D)
    work = granular.lun_pressure(alpha_p, theta, e, g0, RHO) * div
    lost = granular.lun_dissipation(alpha_p, theta, e, g0, RHO, D) + 3.0 * beta * theta
    assert theta > 0.0
    assert made - work == pytest.approx(lost, rel=1e-9, abs=1e-9 * (made + abs(work)))


def test_stress_ratio_of_uniform_shear():
    shear = exact.uniform_shear(100.0, 0.5, 0.9, g0_of(0.5), RHO, D)
    assert shear.stress / shear.pressure == pytest.approx(0.305091, abs=5e-7)  # sdph notes, section 5
    faster = exact.uniform_shear(200.0, 0.5, 0.9, g0_of(0.5), RHO, D)
    assert faster.stress / faster.pressure == pytest.approx(shear.stress / shear.pressure, rel=1e-12)
