"""Grains and gas that move through each other, against exact solutions (sdph-notes, section 5).

The gas is a fake that does what the solution assumes and no more; particles, drag, exchange and windows are real.
"""

import itertools
import math

import exact_solutions as solutions
import numpy as np
import pytest
from grain_boxes import DENSITY, DIAMETER, VISCOSITY, Row, box, go, started, windows

from sdph.laws import drag, exact

ALPHA_P = 0.1
DUST, GAS = ALPHA_P * DENSITY, (1.0 - ALPHA_P) * 1.225
START = 0.5  # m/s


def slip(simulated):
    return float(simulated.state.u.mean() - simulated.gas.velocity[0, 0])


def dusty_box(folder, law, end, count, viscosity=VISCOSITY, start=START):
    """Grains at `start` m/s in gas at rest, in a periodic box that is one cell."""
    case = box(["drag"], alpha_p=ALPHA_P, drag={"law": law}, gas={"viscosity_Pa_s": viscosity},
               particles={"bed": moving(start)}, **windows(end, count))  # fmt: skip
    return go(started(case, folder))


def moving(u, alpha_p=ALPHA_P, size=(0.06, 0.06)):
    return {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": list(size), "volume_fraction": alpha_p,
            "temperature_K": 300.0, "velocity_m_s": [u, 0.0]}  # fmt: skip


def rates_of(law, viscosity=VISCOSITY):
    """beta = a + b s [kg/m3/s] as two numbers, times 1/rho_g + 1/rho_d."""
    at = [ALPHA_P * law(ALPHA_P, s, DIAMETER, 1.225, viscosity) for s in (0.0, 1.0)]
    both = 1.0 / DUST + 1.0 / GAS
    return at[0] * both, (at[1] - at[0]) * both


CASES = {
    "linear": ("stokes", drag.stokes, VISCOSITY),
    "quadratic": ("ergun", drag.ergun, 1e-15),
    "ergun": ("ergun", drag.ergun, VISCOSITY),
}


@pytest.mark.parametrize("name", CASES)
def test_dusty_box(tmp_path, name):
    """Slip against its closed form, first order in the window; momentum to round-off; nobody passes the other."""
    law, function, viscosity = CASES[name]
    a, b = rates_of(function, viscosity)
    end = 1.0 / (a + b * START)
    expected = solutions.quadratic_slip(end, START, a, b)
    errors = []
    for count in (20, 40):
        folder = tmp_path / str(count)
        folder.mkdir()
        done = dusty_box(folder, law, end, count, viscosity)
        assert done.ledger.summary()["exchange_momentum_mismatch_rel"] < 1e-12
        total = DUST * done.state.u.mean() + GAS * done.gas.velocity[0, 0]
        assert total == pytest.approx(DUST * START, rel=1e-13)
        assert np.ptp(done.state.u) < 1e-13
        errors.append(abs(slip(done) - expected) / START)
    print(f"dusty box, {name}: error {errors[-1]:.2e}, order in the window {math.log2(errors[0] / errors[1]):.2f}")
    assert errors[1] < 0.01
    assert math.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.15)


def test_heat_of_drag_is_the_kinetic_energy_that_both_lose(tmp_path):
    """That of the last window waits for the next one."""
    count, end, start = 30, 3.0 / rates_of(drag.stokes)[0], 0.2 * START
    done = dusty_box(tmp_path, "stokes", end, count, start=start)
    grains, gas, volumes = done.state.u.mean(), done.gas.velocity[0, 0], done.exchange.volumes
    sums = done.ledger.sums
    lost = 0.5 * volumes.sum() * (DUST * (start**2 - grains**2) - GAS * gas**2)
    made = sums["friction_J"]
    print(f"heat of drag over the kinetic energy lost: {made / lost:.12f}")
    assert made == pytest.approx(lost, rel=1e-9)
    assert made == pytest.approx(sums["drag_heat_J"] + done.ledger.last["heat_on_its_way_J"], rel=1e-12)


def test_a_window_of_many_relaxation_times_ends_in_equilibrium(tmp_path):
    """Slow grains, which cross the box in few sub-steps."""
    a, _ = rates_of(drag.stokes)
    done = dusty_box(tmp_path, "stokes", 1e3 * DUST / GAS / a, 1, start=1e-3 * START)
    assert slip(done) == pytest.approx(0.0, abs=1e-12)


def settled(folder, law, end, count):
    """Grains and gas that fall past each other under a pressure gradient that carries both: no net force."""
    mixture = DUST + GAS
    case = box(
        ["drag", "gas_pressure", "gravity"],
        alpha_p=ALPHA_P,
        gravity=(0.0, -9.81),
        drag={"law": law},
        **windows(end, count),
    )
    done = go(started(case, folder, Row(case, gradient=(0.0, -9.81 * mixture, 0.0))))
    assert DUST * done.state.v.mean() + GAS * done.gas.velocity[0, 1] == pytest.approx(0.0, abs=1e-12)
    return float(done.gas.velocity[0, 1] - done.state.v.mean())


@pytest.mark.parametrize("law", ["stokes", "wen_yu", "ergun", "gidaspow", "syamlal_obrien", "di_felice"])
def test_periodic_settling_reaches_the_slip_of_the_law(tmp_path, law):
    """beta s = alpha_p alpha_g (rho_p - rho_g) g."""
    expected = solutions.settling_slip(getattr(drag, law), ALPHA_P, DENSITY, 9.81, DIAMETER, 1.225, VISCOSITY)
    assert settled(tmp_path, law, 0.02, 400) == pytest.approx(expected, rel=1e-3)


def test_periodic_settling_relaxes_at_the_rate_of_the_drag(tmp_path):
    """1 - exp(-beta (1/rho_g + 1/rho_d) t) on the way, first order in the window."""
    beta = ALPHA_P * drag.stokes(ALPHA_P, 0.0, DIAMETER, 1.225, VISCOSITY)
    end = 1.0 / exact.exchange_rate(beta, DUST, GAS)
    expected, errors = solutions.settling_slip_at(end, beta, ALPHA_P, DENSITY, 1.225, 9.81), []
    for count in (50, 100):
        folder = tmp_path / str(count)
        folder.mkdir()
        errors.append(abs(settled(folder, "stokes", end, count) / expected - 1.0))
    assert errors[1] < 0.01
    assert math.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.15)


# A standing wave of gas with dust: the kernel that takes velocities to cells is folded at the ends of the row, which
# suits it. Heavy dust, light drag: about one relaxation time and a quarter of a wave.
WAVE_C, WAVE_LENGTH = 10.0, 0.32


def dusty_wave(folder, per_wave, count, law="stokes", turns=0.25):
    """Amplitudes [cos of density of the gas, cos of velocities] after `turns` of the wave, and the exact ones."""
    k = 2.0 * math.pi / WAVE_LENGTH
    spacing, end = WAVE_LENGTH / per_wave, turns * 2.0 * math.pi / (k * WAVE_C)
    size = (WAVE_LENGTH, 8 * spacing)
    case = box(["drag"], size=size, alpha_p=WAVE_ALPHA, drag={"law": law},
        resolution={"spacing_mm": spacing * 1e3, "cell_mm": spacing * 1e3},
               gas={"viscosity_Pa_s": VISCOSITY}, **windows(end, count))  # fmt: skip
    gas = Row(case, per_wave, WAVE_C)
    simulated = started(case, folder, gas)
    wave = lambda x: 1e-4 * np.cos(k * x)  # noqa: E731
    gas.velocity[:, 0] = wave(gas.mesh.centres[:, 0])
    gas.rise[:] = 0.0
    simulated.state.u[:] = wave(simulated.state.x)
    simulated.gas_state = gas._state()
    go(simulated)
    own = [
        _amplitude(gas.mesh.centres[:, 0], gas.velocity[:, 0], k),
        _amplitude(simulated.state.x, simulated.state.u, k),
    ]
    return np.array(own) / 1e-4, _exact_wave(end, k)


WAVE_ALPHA = 2e-3


def _amplitude(x, values, k):
    return 2.0 * (values * np.cos(k * x)).mean()


def _exact_wave(t, k):
    from scipy.linalg import expm

    dust, gas = WAVE_ALPHA * DENSITY, (1.0 - WAVE_ALPHA) * 1.225
    beta = WAVE_ALPHA * drag.stokes(WAVE_ALPHA, 0.0, DIAMETER, 1.225, VISCOSITY)
    # v_g = V cos, rise = R sin: dR/dt = k V; dV/dt = -c^2 k R - beta/rho_g (V - U); dU/dt = beta/rho_d (V - U)
    matrix = np.array([[0.0, k, 0.0], [-(WAVE_C**2) * k, -beta / gas, beta / gas], [0.0, beta / dust, -beta / dust]])
    roots = np.sort_complex(np.linalg.eigvals(matrix))
    theirs = np.sort_complex(solutions.dusty_wave_roots(k, WAVE_C, gas, dust, beta))
    np.testing.assert_allclose(roots, theirs, rtol=1e-9)  # the same dispersion relation
    return (expm(matrix * t) @ np.array([0.0, 1.0, 1.0]))[1:]


def test_dusty_wave_has_the_dispersion_and_damping_of_its_three_roots(tmp_path):
    found, expected = dusty_wave(tmp_path, 64, 400)
    print("dusty wave: gas and dust", found, "exact", expected)
    np.testing.assert_allclose(found, expected, atol=0.01)


def test_dusty_wave_converges_with_the_spacing(tmp_path):
    """The error is that of the kernel that takes velocities to cells and back, (k h)^2: second order. From differences,
    in which the error of the windows drops out."""
    found = []
    for per_wave in (16, 32, 64):
        (tmp_path / str(per_wave)).mkdir()
        found.append(dusty_wave(tmp_path / str(per_wave), per_wave, 200)[0])
    first, second = (np.abs(b - a).max() for a, b in itertools.pairwise(found))
    order = math.log2(first / second)
    print(f"dusty wave: {found}, order in the spacing {order:.2f}")
    assert order == pytest.approx(2.0, abs=0.4)
