"""What the gas's own viscosity does to its motion, against a closed form, and what is left for the numerics. Both
solvers."""

import math

import pytest
from test_impulses_of_gas import BOTH, ENDS, RHO, running


def lost_and_rubbed(gas, first, last):
    """Loss [J] of the gas's motion beyond what came in, and the work of viscosity [J], per metre of depth."""
    names = ("kinetic", "kinetic_in", "pressure_work", "boundary_work", "gravity_work", "viscous_work")
    change = {name: getattr(last.budget, name) - getattr(first.budget, name) for name in names}
    lost = change["kinetic_in"] + change["boundary_work"] + change["gravity_work"] - change["pressure_work"]
    lost -= change["kinetic"]
    return lost / gas.mesh.depth, change["viscous_work"] / gas.mesh.depth


@BOTH
def test_a_wall_that_slides_drags_the_gas_along(tmp_path, solver):
    """Stokes' first problem: of the wall's power, 2 rho U^2 sqrt(nu t/pi) per area, (2 - sqrt 2)/2 goes into motion:
    the work of viscosity on the gas, and nothing is left for the numerics."""
    speed, length, height, mu, t, steps = 0.7, 0.04, 0.02, 1.2e-3, 8e-3, 200
    lid = {"kind": "wall", "side": "top", "velocity_m_s": [speed, 0.0]}
    boundaries = ENDS | {"lid": lid, "floor": {"kind": "wall", "side": "bottom"}}
    with running(solver, tmp_path, (length, height), 5e-4, boundaries=boundaries, viscosity_Pa_s=mu) as gas:
        first = gas.start(None, ())
        for _ in range(steps):
            state = gas.advance(t / steps, {})
    lost, rubbed = lost_and_rubbed(gas, first, state)
    hand = (2.0 - math.sqrt(2.0)) * RHO * speed**2 * math.sqrt(mu / RHO * t / math.pi) * length
    print(f"{solver}: viscous work {rubbed:.5e} J, by hand {hand:.5e}, numerical {-(lost + rubbed):.1e}")
    assert rubbed == pytest.approx(hand, rel=0.01)
    assert abs(lost + rubbed) < 0.01 * hand


@BOTH
def test_flow_between_plates_is_held_back_by_viscosity(tmp_path, solver):
    """Steady flow between plates at rest: viscosity takes 12 mu u^2/H^2 per volume, all that the pressure does."""
    mean, length, height, mu, dt, steps, last = 0.1, 0.01, 0.02, 4e-3, 2e-3, 300, 20
    slope = 12.0 * mu * mean / height**2
    ends = {"left": slope * length, "right": 0.0}
    boundaries = {s: {"kind": "pressure_outlet", "side": s, "pressure_Pa": p} for s, p in ends.items()}
    boundaries |= {s: {"kind": "wall", "side": s} for s in ("top", "bottom")}
    with running(solver, tmp_path, (length, height), 1e-3, boundaries=boundaries, viscosity_Pa_s=mu) as gas:
        gas.start(None, ())
        states = [gas.advance(dt, {}) for _ in range(steps)]
    lost, rubbed = lost_and_rubbed(gas, states[-last - 1], states[-1])
    hand = -12.0 * mu * mean**2 / height**2 * length * height * dt * last
    print(f"{solver}: viscous work {rubbed:.5e} J, by hand {hand:.5e}, numerical {-(lost + rubbed):.1e}")
    assert rubbed == pytest.approx(hand, rel=0.02)
    assert abs(lost + rubbed) < 0.02 * abs(hand)
