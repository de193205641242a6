"""The embedded gas solver against exact solutions, a manufactured one, and Ghia's cavity."""

import math

import numpy as np
import pytest
from gas_cases import gas_of, norms, orders, set_flow

# Ghia, Ghia & Shin, J. Comput. Phys. 48, 387 (1982), tables I and II, Re = 100: u along the vertical centre line
# over y, v along the horizontal centre line over x, in units of the lid.
GHIA_U = {
    0.0547: -0.03717, 0.0625: -0.04192, 0.0703: -0.04775, 0.1016: -0.06434, 0.1719: -0.10150, 0.2813: -0.15662,
    0.4531: -0.21090, 0.5000: -0.20581, 0.6172: -0.13641, 0.7344: 0.00332, 0.8516: 0.23151, 0.9531: 0.68717,
    0.9609: 0.73722, 0.9688: 0.78871, 0.9766: 0.84123,
}  # fmt: skip
GHIA_V = {
    0.0625: 0.09233, 0.0703: 0.10091, 0.0781: 0.10890, 0.0938: 0.12317, 0.1563: 0.16077, 0.2266: 0.17507,
    0.2344: 0.17527, 0.5000: 0.05454, 0.8047: -0.24533, 0.8594: -0.22445, 0.9063: -0.16914, 0.9453: -0.10313,
    0.9531: -0.08864, 0.9609: -0.07391, 0.9688: -0.05906,
}  # fmt: skip


def test_ergun_column():
    """Pressure drop of a fixed bed, Ergun's equation (Chem. Eng. Prog. 48, 89, 1952), iterated with the velocity handed
    back."""
    alpha_p, d, speed, mu, rho = 0.6, 0.5e-3, 0.2, 1.8e-5, 1.2
    boundaries = {
        "below": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, speed]},
        "above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0},
        "walls": {"kind": "slip_wall"},
    }
    gas = gas_of((0.04, 0.4), 4, boundaries=boundaries)
    alpha = np.full(len(gas.mesh.volumes), 1.0 - alpha_p)
    state = gas.start(alpha, ("alpha_g", "momentum_coefficient", "momentum"))
    for _ in range(20):
        slip = np.linalg.norm(state.fields["velocity"], axis=1)
        beta = 150 * alpha_p**2 * mu / (alpha * d**2) + 1.75 * alpha_p * rho * slip / d
        state = gas.advance(
            1e-3, {"alpha_g": alpha, "momentum_coefficient": beta, "momentum": np.zeros((len(beta), 3))}
        )
    ergun = (150 * alpha_p**2 * mu * speed / d**2 + 1.75 * alpha_p * rho * speed**2 / d) / (1 - alpha_p) ** 3
    y, p = gas.mesh.centres[:, 1], state.fields["pressure"]
    inside = y > 0.02  # the gas enters with the velocity of alpha_g = 1 and speeds up in the first cell
    assert np.allclose(state.fields["pressure_gradient"][inside, 1], -ergun, rtol=1e-3)
    slope = (p[y.argmax()] - p[y.argmin()]) / (y.max() - y.min())
    print(f"Ergun {-ergun:.3f} Pa/m, computed {slope:.3f}")
    assert slope == pytest.approx(-ergun, rel=1e-3)


def test_lid_driven_cavity():
    boundaries = {"lid": {"kind": "wall", "side": "top", "velocity_m_s": [1.0, 0.0]}, "walls": {"kind": "wall"}}
    gas = gas_of((1.0, 1.0), 64, boundaries=boundaries, density_kg_m3=1.0, viscosity_Pa_s=0.01)
    state = gas.start(None, ())
    for _ in range(3000):
        old = state.fields["velocity"]
        state = gas.advance(0.01, {})
        if np.abs(state.fields["velocity"] - old).max() < 1e-6:
            break
    grid, flow = gas.box.grid, gas.flow
    for table, axis, lid in ((GHIA_U, 0, 1.0), (GHIA_V, 1, 0.0)):
        place, values = _line(grid, flow.velocity[axis], axis, 1 - axis)
        computed = np.interp(list(table), [0.0, *place, 1.0], [0.0, *values, lid])
        error = np.abs(computed - list(table.values()))
        print(f"cavity, component {axis}: largest error {error.max():.5f} of the lid after {state.time:.1f} s")
        assert error.max() < 0.01


def _line(grid, velocity, axis, along):
    """A velocity component on the centre line across its own axis, over the coordinate `along`."""
    centres = grid.centres
    middle = grid.cells[np.isclose(centres[:, axis], 0.5 + 0.5 / grid.counts[axis])]
    return centres[np.isin(grid.cells, middle), along], velocity[middle]


def taylor_green(n, limited=True):
    """Decay of a vortex between slip walls: error of the velocity at t = 0.5 and its order."""
    nu, end, size = 0.05, 0.5, math.pi
    options = {"boundaries": {"walls": {"kind": "slip_wall"}}, "density_kg_m3": 1.0, "viscosity_Pa_s": nu}
    gas = gas_of((size, size), n, limited=limited, **options)
    gas.start(None, ())
    velocity = lambda a, x, y: np.sin(x) * np.cos(y) if a == 0 else -np.cos(x) * np.sin(y)  # noqa: E731
    set_flow(gas, velocity=velocity, pressure=lambda x, y: 0.25 * (np.cos(2 * x) + np.cos(2 * y)))
    steps = round(end / (0.4 * (size / n) ** 2))
    for _ in range(steps):
        state = gas.advance(end / steps, {})
    x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
    error = state.fields["velocity"][:, 0] - math.exp(-2 * nu * end) * velocity(0, x, y)
    return norms(error, gas.mesh.volumes)[0]


def test_taylor_green_is_second_order():
    errors = [taylor_green(n) for n in (16, 32, 64)]
    print("Taylor-Green errors", errors, "orders", orders(errors))
    assert orders(errors)[-1] > 1.8
    assert taylor_green(32, limited=False) > 3.0 * errors[1]


class Manufactured:
    """Steady flow with voidage between no-slip walls: alpha rho u is the curl of psi, and the force that makes it
    a solution of the momentum equation is taken by differences of eighth order (error below 1e-9)."""

    rho, mu, P = 1.0, 0.1, 0.7
    step = 2e-3
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}

    def alpha(self, x, y):
        return 0.6 + 0.2 * np.cos(math.pi * x) * np.cos(math.pi * y)

    def pressure(self, x, y):
        return self.P * np.cos(math.pi * x) * np.cos(math.pi * y)

    def velocity(self, a, x, y):
        sx, sy = np.sin(math.pi * x), np.sin(math.pi * y)
        curl = (2 * sx**2 * sy * np.cos(math.pi * y), -2 * sy**2 * sx * np.cos(math.pi * x))[a]
        return curl / (self.rho * self.alpha(x, y))

    def slope(self, function, a, x, y):
        move = lambda n: (x + n * self.step, y) if a == 0 else (x, y + n * self.step)  # noqa: E731
        return sum(w * (function(*move(n)) - function(*move(-n))) for n, w in self.weights.items()) / self.step

    def stress(self, a, b, x, y):
        gradient = lambda i, j: self.slope(lambda *r: self.velocity(i, *r), j, x, y)  # noqa: E731
        tau = gradient(a, b) + gradient(b, a) - (a == b) * 2 / 3 * (gradient(0, 0) + gradient(1, 1))
        return self.alpha(x, y) * self.mu * tau

    def force(self, a, x, y):
        flow = lambda b: lambda *r: self.alpha(*r) * self.rho * self.velocity(a, *r) * self.velocity(b, *r)  # noqa: E731
        inertia = sum(self.slope(flow(b), b, x, y) for b in (0, 1))
        friction = sum(self.slope(lambda *r, b=b: self.stress(a, b, *r), b, x, y) for b in (0, 1))
        return inertia + self.alpha(x, y) * self.slope(self.pressure, a, x, y) - friction


def manufactured(n, stretch=1.0):
    """Errors of velocity and pressure at rest, on cells that widen by `stretch` from end to end."""
    exact, dt = Manufactured(), 1.0 / n**2
    gas = gas_of((1.0, 1.0), n, density_kg_m3=exact.rho, viscosity_Pa_s=exact.mu, stretch=(stretch, 1.0 / stretch))
    x, y, _ = gas.mesh.centres.T
    alpha = exact.alpha(x, y)
    state = gas.start(alpha, ("alpha_g", "momentum_coefficient", "momentum"))
    set_flow(gas, velocity=exact.velocity, pressure=exact.pressure)
    force = np.stack((exact.force(0, x, y), exact.force(1, x, y), 0 * x), axis=1)
    for _ in range(round(1.0 / dt)):
        state = gas.advance(dt, {"alpha_g": alpha, "momentum_coefficient": 0 * x, "momentum": force})
    p = state.fields["pressure"] - np.average(state.fields["pressure"], weights=gas.mesh.volumes)
    errors = state.fields["velocity"][:, 0] - exact.velocity(0, x, y), p - exact.pressure(x, y)
    return [norms(error, gas.mesh.volumes)[0] for error in errors]


@pytest.mark.parametrize("stretch", [1.0, 3.0])
def test_manufactured_flow_with_voidage_is_second_order(stretch):
    velocity, pressure = zip(*(manufactured(n, stretch) for n in (12, 24, 48)))
    for name, errors in (("velocity", velocity), ("pressure", pressure)):
        print(f"manufactured, stretch {stretch}: {name} errors {errors}, orders {orders(errors)}")
    assert min(orders(velocity)) > 1.8
    assert min(orders(pressure)) > 1.6
