"""Energy that moving particles make of nothing: weight and tension are taken over the ways that particles really go."""

import pytest
from moving import case, joined, started
from test_pools import RHO, TANK, G

from sdph.engine.state import LIQUID

STEPS = 40


def go(run) -> None:
    run.method.begin()
    run.method.advance(10.0, STEPS)
    run.method.close()


def told(tmp_path, own):
    """The run of a case, its summary of the ledger and the energy [J] in gravity that it gained, after some steps."""
    run = started(tmp_path, own)
    begun = height(run)
    go(run)
    return run, run.method.ledger.summary(), height(run) - begun


def height(run) -> float:
    s, gravity = run.state, run.case.domain.gravity
    wet = s.kind == LIQUID
    return float(-(s.mass[wet] @ (s.x[wet] * gravity[0] + s.y[wet] * gravity[1])))


def test_a_free_fall_makes_no_energy_and_the_way_is_that_of_the_drop(tmp_path):
    """Kick, then drift: it is g dt t/2 further down than by its speed, and has less motion than it fell."""
    own = {"domain": {"gravity_m_s2": [2.0, -G]}}
    run, summary, gained = told(tmp_path, case(("gravity",), own, 2))
    moved = run.method.ledger.last["kinetic_energy_J"]
    assert summary["energy_made_J"] == 0.0 and moved > 0.0
    assert moved == pytest.approx(summary["fallen_J"], rel=1.5 / STEPS)
    assert summary["fallen_J"] == pytest.approx(-gained, rel=1e-9)


def test_what_keeps_particles_of_a_pool_apart_lifts_them_too(tmp_path):
    water = {"pools": {"drop": {"velocity_m_s": [0.3, 0.0]}}}
    run, summary, gained = told(tmp_path, case(tuple(TANK["effects"]), joined(TANK, water), 2))
    assert summary["fallen_J"] == pytest.approx(-gained, rel=1e-6, abs=1e-9 * RHO * G)
    first, last = run.method.ledger.first, run.method.ledger.last
    beyond = last["kinetic_energy_J"] - first["kinetic_energy_J"] + gained
    assert summary["energy_made_J"] == pytest.approx(max(0.0, beyond), abs=1e-9 * RHO * G)
    assert abs(summary["work_of_gravity_J"] - summary["fallen_J"]) > 0.1 * abs(gained)


def test_energy_from_nowhere_shows(tmp_path):
    run, summary, _ = told(tmp_path, case(tuple(TANK["effects"]), TANK, 2))
    wet = run.state.kind == LIQUID
    run.state.u[wet] += 0.5
    go(run)
    last, mass = run.method.ledger.summary(), run.state.mass[wet].sum()
    assert last["energy_made_J"] > summary["energy_made_J"] + 0.1 * 0.5 * mass * 0.5**2
    assert last["energy_made_rel"] == last["energy_made_J"] / run.method.ledger.most


def test_the_work_of_tension_is_what_cohesion_gains_and_comes_from_outside(tmp_path):
    """A drop that is drawn out contracts."""
    run = started(tmp_path, case(("free_energy_tension",), None, 2))
    begun, s = run.method.ledger.first, run.state
    s.v[:] = -0.5 * (s.y - s.y.mean()) / 4e-4
    go(run)
    summary, last = run.method.ledger.summary(), run.method.ledger.last
    freed = begun["cohesion_energy_J"] - last["cohesion_energy_J"]
    assert summary["drawn_J"] == pytest.approx(freed, rel=0.1) and abs(freed) > 0.0
    made = last["kinetic_energy_J"] - begun["kinetic_energy_J"] - summary["drawn_J"]
    assert summary["energy_made_J"] == pytest.approx(max(0.0, made), rel=1e-9) and summary["fallen_J"] == 0.0
