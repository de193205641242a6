"""Temperature and vapour of the embedded gas solver against exact solutions."""

import math
from pathlib import Path

import numpy as np
import pytest
from gas_cases import OIL, gas_case, gas_of, norms, orders, set_flow

from coupling.embedded import convection
from coupling.openfoam import start_fields
from sdph.study import inlets

VAPOUR = OIL | {"diffusivity_m2_s": 2e-2}


def channel(speed, **more):
    return {
        "in": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [speed, 0.0], "temperature_K": 300.0} | more,
        "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
        "walls": {"kind": "slip_wall"},
    }


def pulse(n, limited=True, courant=0.4):
    """A warm Gaussian carried along and spread by conduction: error of its temperature over its height."""
    speed, end, start, spread = 1.0, 0.3, 0.3, 0.06
    gas = gas_of((1.0, 4.0 / n), n, boundaries=channel(speed), conductivity_W_m_K=1.2, limited=limited)
    gas.start(None, ())
    D = 1.2 / (1.2 * 1000.0)

    def exact(x, t):
        wide = spread**2 + 2 * D * t
        return 300.0 + 10.0 * spread / math.sqrt(wide) * np.exp(-((x - start - speed * t) ** 2) / (2 * wide))

    set_flow(gas, velocity=lambda a, x, y: speed * (a == 0) + 0 * x, temperature=lambda x, y: exact(x, 0.0))
    steps = math.ceil(end * speed * n / courant)
    for _ in range(steps):
        state = gas.advance(end / steps, {})
    T = state.fields["temperature"]
    return norms(T - exact(gas.mesh.centres[:, 0], end), gas.mesh.volumes)[0] / 10.0, T.min(), T.max()


def test_pulse_is_second_order_and_bounded():
    results = [pulse(n) for n in (40, 80, 160)]
    errors = [r[0] for r in results]
    print("advected pulse: errors", errors, "orders", orders(errors))
    assert min(orders(errors)) > 1.7
    assert all(low > 300.0 - 1e-9 and high < 310.0 for _, low, high in results)
    assert pulse(80, limited=False)[0] > 4.0 * errors[1]


def test_window_beyond_courant_one():
    """Sub-steps keep a window of Courant number 4 bounded and as good as a short one."""
    error, low, high = pulse(80, courant=4.0)
    assert low > 300.0 - 1e-9 and high < 310.0
    assert error < 2.0 * pulse(80)[0]


def test_conduction_between_walls_of_given_temperature():
    ends = (("left", 400.0), ("right", 300.0))
    boundaries = {side: {"kind": "wall", "side": side, "temperature_K": T} for side, T in ends} | {
        "walls": {"kind": "wall"}
    }
    gas = gas_of((0.1, 0.02), 10, boundaries=boundaries)
    gas.start(None, ())
    for _ in range(10):
        before = gas.flow.energy_in
        state = gas.advance(1e4, {})
    x = gas.mesh.centres[:, 0]
    assert np.allclose(state.fields["temperature"], 400.0 - 1000.0 * x, rtol=0, atol=1e-6)
    assert abs(state.budget.energy_in - before) < 1e-6 * state.budget.energy_in


def stefan(equation_of_state, length, low, high):
    """Flux [kg/m2/s], profile Y(y) and density(Y) of vapour that rises through gas at rest (Bird, Stewart & Lightfoot,
    Transport Phenomena, 18.2): mass fractions and rho D at constant density, mole fractions and c D for ideal gases."""
    D, M, Mg = VAPOUR["diffusivity_m2_s"], 142.0, 28.96
    if equation_of_state == "constant":
        N = 1.2 * D / length * math.log((1 - high) / (1 - low))
        return N, lambda y: 1 - (1 - low) * ((1 - high) / (1 - low)) ** (y / length), lambda Y: 1.2 + 0 * Y
    c = 101325.0 / (8314.462618 * 300.0)
    moles = lambda Y: (Y / M) / (Y / M + (1 - Y) / Mg)  # noqa: E731
    mass = lambda X: X * M / (X * M + (1 - X) * Mg)  # noqa: E731
    share = (1 - moles(high)) / (1 - moles(low))
    profile = lambda y: mass(1 - (1 - moles(low)) * share ** (y / length))  # noqa: E731
    return M * c * D / length * math.log(share), profile, lambda Y: c / (Y / M + (1 - Y) / Mg)


@pytest.mark.parametrize("equation_of_state", ["constant", "operating"])
def test_stefan_tube(equation_of_state):
    """Held mass fractions at both ends and the exact mass flux: the vapour flux must be all of it (no air moves)."""
    length, low, high = 0.1, 0.6, 0.1
    flux, profile, density = stefan(equation_of_state, length, low, high)

    def end(side, Y):
        through = {"velocity_m_s": [0.0, flux / density(Y)], "vapour_mass_fraction": Y, "temperature_K": 300.0}
        return {"kind": "velocity_inlet", "side": side} | through

    boundaries = {"surface": end("bottom", low), "mouth": end("top", high), "walls": {"kind": "slip_wall"}}
    gas = gas_of((0.0025, length), 1, boundaries=boundaries, vapour=VAPOUR, equation_of_state=equation_of_state)
    gas.start(None, ())
    cells, y = gas.box.grid.cells, gas.mesh.centres[:, 1]
    flow = gas.flow
    flow.mass[cells] = density(profile(y)) * gas.mesh.volumes
    flow.vapour[cells] = flow.mass[cells] * profile(y)
    for _ in range(1000):
        before = gas.flow.vapour_in
        state = gas.advance(2e-3, {})
    error = np.abs(state.fields["vapour_mass_fraction"] - profile(y)).max()
    print(equation_of_state, "Stefan tube: largest error of Y", error, "box", state.budget.held["gas_box_rel"])
    assert error < 1e-3
    assert abs(gas.flow.vapour_in - before) < 1e-6 * flux * 0.0025 * 2e-3
    assert np.ptp(state.fields["temperature"]) < 1e-9


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_straight_profile_is_carried_exactly_over_uneven_nodes(way):
    """What passes a face is what stands half of what passes behind it, upstream; every distance and mass differs."""
    x = np.array([0.0, 1.0, 1.5, 2.7, 3.0, 4.4, 5.0, 5.2])
    gap, mass = np.diff(x, prepend=np.nan), np.linspace(1.0, 2.4, 8)
    reach, flux, sub = 0.4 * gap, way * np.linspace(0.5, 1.9, 8), 0.3
    one, faces = np.uint64(1), range(2, 7)
    wide = np.array([2], np.uint64), np.uint64(5), (one,)
    nodes = convection.Nodes(wide, wide, np.uint64(0), np.ones(8, bool), gap[None], reach[None])
    face = np.zeros(8)
    convection._face_flux(nodes, 0, 3.0 + 2.0 * x, mass, flux, sub, True, face)
    for f in faces:
        courant = 2.0 * sub * abs(flux[f]) / (mass[f - 1] + mass[f])
        start, distance = (x[f - 1], reach[f]) if way > 0.0 else (x[f], reach[f] - gap[f])
        assert face[f] == pytest.approx(flux[f] * (3.0 + 2.0 * (start + distance * (1.0 - courant))), rel=1e-13)


@pytest.mark.parametrize(("given", "comes"), [({}, 0.05), ({"vapour_mass_fraction": 0.0}, 0.0)])
def test_an_inlet_that_names_no_vapour_brings_that_of_the_start(given, comes):
    """As with its temperature; 0 is dry gas. A start that it leaves even stays so; OpenFOAM's files say the same."""
    boundaries = channel(1.0, **given)
    gas = gas_of((0.4, 0.1), 8, boundaries=boundaries, vapour=OIL | {"mass_fraction": 0.05})
    case = gas_case((0.4, 0.1), 8, boundaries=boundaries, vapour=OIL | {"mass_fraction": 0.05})
    gas.start(None, ())
    for _ in range(200):
        state = gas.advance(1e-2, {})
    found = state.fields["vapour_mass_fraction"]
    print(given, found.min(), found.max())
    assert np.allclose(found, comes, rtol=1e-9, atol=1e-6)
    written = start_fields.start_fields(case)["Y"]
    assert f"in {{ type fixedValue; value uniform {comes}; }}" in written and "inletValue uniform 0.05;" in written
    told = [line for line in inlets.warnings(case, Path("nowhere")) if "vapour_mass_fraction" in line]
    assert len(told) == (0 if given else 1)
