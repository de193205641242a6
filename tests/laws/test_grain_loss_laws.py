import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from sdph.laws import evaporation, grain_loss

diameters = st.floats(1e-5, 5e-3)  # m
ventilations = st.floats(0.0, 300.0)  # m^-1/2


@given(d=diameters, c=ventilations)
def test_scale_is_its_integral(d, c):
    expected = quad(lambda t: 4.0 * t**3 / (1.0 + c * math.sqrt(d) * t), 0.0, 1.0)[0]
    assert grain_loss.loss_scale(d * d, c) == pytest.approx(expected * d * d, rel=1e-5)


@given(d=diameters, c=ventilations, share=st.floats(0.0, 0.999))
def test_inverse(d, c, share):
    scale = grain_loss.loss_scale(d * d, c)
    left = grain_loss.square_after(d * d, share * scale, c)
    assert grain_loss.loss_scale(left, c) == pytest.approx((1.0 - share) * scale, rel=1e-9)


@given(d=diameters, c=ventilations, over=st.floats(1.0, 10.0))
def test_gone_is_exactly_gone(d, c, over):
    assert grain_loss.square_after(d * d, over * grain_loss.loss_scale(d * d, c), c) == 0.0


@given(d=diameters, loss=st.floats(0.0, 2.0))
def test_still_gas_is_the_d2_law(d, loss):
    left = grain_loss.square_after(d * d, loss * d * d, 0.0)
    assert left == pytest.approx(max(0.0, 1.0 - loss) * d * d, abs=1e-14 * d * d)


@given(d=diameters, c=ventilations, loss=st.floats(0.0, 1.5), parts=st.integers(2, 6))
def test_loss_does_not_depend_on_how_time_is_cut(d, c, loss, parts):
    cut = d * d
    for _ in range(parts):
        cut = grain_loss.square_after(cut, loss * d * d / parts, c)
    assert cut == pytest.approx(grain_loss.square_after(d * d, loss * d * d, c), rel=1e-9, abs=1e-12 * d * d)


@pytest.mark.parametrize("c", [1.0, 20.0, 120.0])
def test_against_the_equation_integrated(c):
    """dD/dt = -a (1 + c D^(1/4)) to a tenth of the mass."""
    start, end = 1e-6, 1e-6 * 0.1 ** (2.0 / 3.0)
    loss = grain_loss.loss_scale(start, c) - grain_loss.loss_scale(end, c)
    solved = solve_ivp(lambda t, y: -(1.0 + c * (y * 1e-6) ** 0.25), (0.0, loss / 1e-6), [1.0], rtol=1e-10, atol=1e-14)
    assert grain_loss.square_after(start, loss, c) == pytest.approx(1e-6 * solved.y[0, -1], rel=1e-5)


@given(d=diameters, slip=st.floats(0.0, 20.0))
def test_ventilation_is_ranz_and_marshall(d, slip):
    density, viscosity, diffusivity = 1.225, 1.79e-5, 3.79e-6
    schmidt = evaporation.schmidt_number(density, viscosity, diffusivity)
    c = grain_loss.ventilation(density * slip / viscosity, schmidt)
    expected = evaporation.sherwood_ranz_marshall(density * slip * d / viscosity, schmidt)
    assert 2.0 * (1.0 + c * math.sqrt(d)) == pytest.approx(expected, rel=1e-12)


def test_regression_rate_belongs_to_it():
    """a of the loss is the d^2 law's K for Sh = 2: 8 D times the vapour's density over that of the liquid."""
    rate = evaporation.regression_rate(evaporation.driving_force_linear(5e-4, 0.0, 142.284), 3.79e-6, 700.0)
    assert rate == pytest.approx(8.0 * 3.79e-6 * 142.284 * 5e-4 / 700.0, rel=1e-12)
    assert np.isclose(grain_loss.square_after(1e-6, 10.0 * rate, 0.0), 1e-6 - 10.0 * rate, rtol=1e-12)
