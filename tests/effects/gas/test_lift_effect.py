"""Lift: the closed-form force on grains in a uniform shear, equal on both sides, its work in the ledger, nothing when
off."""

import math

import numpy as np
import pytest
from grain_boxes import DENSITY, DIAMETER, VISCOSITY, Row, box, go, started, windows
from lognormal import mass_moment

from coupling.embedded import EmbeddedGas
from sdph import effects
from sdph.effects import OFF
from sdph.effects.gas import lift, sizes
from sdph.engine import state as particles
from sdph.engine.ledger import Ledger
from sdph.exchange.equations import Around
from sdph.laws import lift as law
from sdph.running.simulation import Simulation

SHEAR, SLIP = 200.0, 0.3  # 1/s, m/s


class Sheared(Row):
    """Gas at one velocity with the vorticity of a shear, which takes what it is pushed with."""

    def __init__(self, case, **kwargs):
        super().__init__(case, **kwargs)
        self.velocity[:] = SLIP, 0.0, 0.0

    def start(self, alpha_g, sources, fields=()):
        self.fields = fields
        return super().start(alpha_g, sources)

    def _state(self):
        state = super()._state()
        state.fields.update({name: np.tile((0.0, 0.0, -SHEAR), (len(self.velocity), 1)) for name in self.fields})
        return state


def grain(law="saffman_mei", effects=("lift",), end=1e-4, count=1, **more):
    coupling = windows(end, count)
    coupling["coupling"] |= more.pop("coupling", {})
    return box(list(effects), alpha_p=1e-3, **({"lift": {"law": law}} if "lift" in effects else {}), **coupling, **more)


@pytest.mark.parametrize("name", lift.LAWS)
def test_a_grain_in_a_uniform_shear(tmp_path, name):
    """A grain that lags behind the gas is pushed to the faster side: 1.615 f mu d s sqrt(Re_G) over its mass."""
    done = go(started(case := grain(name, coupling={"one_way": True}), tmp_path, Sheared(case, alpha_g=1.0)))
    reynolds, shear = 1.225 * DIAMETER * SLIP / VISCOSITY, 1.225 * DIAMETER**2 * SHEAR / VISCOSITY
    force = (
        1.615
        * VISCOSITY
        * DIAMETER
        * SLIP
        * math.sqrt(shear)
        * (law.mei_factor(reynolds, shear) if name == "saffman_mei" else 1.0)
    )
    expected = force / (DENSITY * math.pi / 6.0 * DIAMETER**3) * 1e-4
    np.testing.assert_allclose(done.state.v, expected, rtol=1e-12)
    np.testing.assert_allclose(done.state.u, 0.0, atol=1e-20)


def test_windows_are_short_enough_for_the_drift_that_lift_makes(tmp_path):
    """Lift is held over a window beside drag, as weight is: both are of the pull that `settling` asks for."""
    weight = {"gravity": (-0.05, 0.0)}
    case = grain(
        effects=("drag", "lift", "gravity"), end=1.0, drag={"law": "stokes"}, coupling={"one_way": True}, **weight
    )
    run = started(case, tmp_path, Sheared(case, alpha_g=1.0))
    reynolds, shear = 1.225 * DIAMETER * SLIP / VISCOSITY, 1.225 * DIAMETER**2 * SHEAR / VISCOSITY
    force = 1.615 * VISCOSITY * DIAMETER * SLIP * math.sqrt(shear) * law.mei_factor(reynolds, shear)
    pull = math.hypot(0.05, force / (DENSITY * math.pi / 6.0 * DIAMETER**3))
    assert pull > 1.2 * 0.05
    tau = DENSITY * DIAMETER**2 / (18.0 * VISCOSITY)
    assert run.clock.limits["settling"] == pytest.approx(
        2.0 * case.run.accuracy * max(tau * pull, SLIP, case.smoothing_length / 1.0) / pull, rel=1e-9
    )


def around(apart, vorticity):
    """Gas of 1.2 kg/m3 at a velocity (1, 3) [m/s] from that of a grain, with a vorticity (1, 3) [1/s]."""
    return Around(apart, particles.lengths(apart), np.array([1.2]), np.array([300.0]), vorticity)


def test_in_space_lift_is_across_slip_and_vorticity():
    state = particles.empty(1, ("diameter", "diameter_variance"), 3)
    state.mass[:], state.diameter[:] = 2.0, DIAMETER
    apart, vorticity, p = np.array([[0.1, -0.2, 0.4]]), np.array([[30.0, 50.0, -80.0]]), lift.kernel(grain())
    slip, spin = np.linalg.norm(apart), np.linalg.norm(vorticity)
    expected = 2.0 / DENSITY * law.saffman_mei(slip, spin, DIAMETER, 1.2, VISCOSITY) * np.cross(apart[0], vorticity[0])
    np.testing.assert_allclose(lift.force(p, OFF, state, 0, around(apart, vorticity), slip), expected, rtol=1e-13)


def test_grains_of_all_sizes_are_lifted_by_mass():
    """Saffman's L goes as 1/d, whose mass average over the log-normal law is known in closed form."""
    state, std = particles.empty(1, ("diameter", "diameter_variance")), 0.3 * DIAMETER
    state.mass[:], state.diameter[:], state.diameter_variance[:] = 2.0, DIAMETER, std**2
    spread = box(["lift"], lift={"law": "saffman"}, grains={"diameter_std_mm": std * 1e3})
    seen = around(np.array([[0.1, 0.0, 0.0]]), np.array([[0.0, 0.0, 50.0]]))
    found, single = (lift.force(lift.kernel(spread), p, state, 0, seen, 0.1)[1] for p in (sizes.kernel(spread), OFF))
    assert found / single == pytest.approx(mass_moment(-1.0, DIAMETER, std) * DIAMETER, rel=1e-3)


@pytest.mark.parametrize("effects", [("lift",), ("drag", "lift")])
def test_the_gas_gets_the_opposite(tmp_path, effects):
    """Momentum of grains and gas stays to round-off, and so does what the ledger says of both sides."""
    case = grain(effects=effects, end=1e-2, count=10)
    simulated = started(case, tmp_path, gas := Sheared(case))

    def total():
        mean = np.array([simulated.state.u.mean(), simulated.state.v.mean()])
        return gas.mass * gas.velocity[0, :2] + 1e-3 * DENSITY * mean

    before = total()
    go(simulated)
    assert abs(simulated.state.v.mean()) > 1e-5
    np.testing.assert_allclose(total(), before, atol=1e-13 * before[0])
    assert simulated.ledger.summary()["exchange_momentum_mismatch_rel"] < 1e-12


def test_off_asks_for_nothing(tmp_path):
    on, off = (
        started(case := grain(effects=effects), tmp_path, Sheared(case)) for effects in (("drag", "lift"), ("drag",))
    )
    assert on.gas.fields == ("vorticity",) and off.gas.fields == ()
    assert len(on.hand(1e-4).force) == len(on.state.x) and len(off.hand(1e-4).force) == 0


def work(folder, count):
    """Ledger and heat of friction [J] of grains that are carried through sheared gas of the embedded solver, in `count`
    windows."""
    case = grain(
        effects=("drag", "heat", "lift"), end=4e-3, count=count, size=(0.06, 0.06), fill=(0.03, 0.06), periodic=(),
        drag={"law": "stokes"}, gas={"temperature_K": 350.0}, boundaries={
            "floor": {"kind": "wall", "side": "bottom"}, "lid": {"kind": "wall", "side": "top", "velocity_m_s": [5.0,
            0.0]}, "sides": {"kind": "pressure_outlet", "pressure_Pa": 0.0}},
    )  # fmt: skip
    gas = EmbeddedGas(case)
    simulation = Simulation(case, gas, Ledger(folder / f"{count}.csv", case, gas.mesh.depth, *effects.in_ledger(case)))
    simulation.start()
    return go(simulation).ledger.summary()


def test_budgets_close_with_a_gas_that_flows(tmp_path):
    own = work(tmp_path, 8)
    print("lift with the embedded gas:", {key: f"{own[key]:.1e}" for key in own if key.endswith("_rel")})
    assert own["exchange_momentum_mismatch_rel"] < 1e-10
    assert own["energy_drift_rel"] < 1e-10 and own["drag_heat_J"] > 0.0
