"""The slab of the bubbling bed, coarse and short: the same code in three dimensions."""

import numpy as np
import pytest
from grain_boxes import box, started

from coupling.embedded import EmbeddedGas
from sdph import effects, scenes
from sdph.case import read as cases
from sdph.effects import OFF
from sdph.engine import state as particles
from sdph.engine.ledger import Ledger
from sdph.methods.grains import contacts as shearing
from sdph.running.simulation import Simulation

COARSE = (
    "resolution.spacing_mm=10.0", "resolution.cell_mm=20.0", "domain.size_m=[0.12,0.2,0.08]",
    "particles.bed.upper_m=[0.12,0.1,0.08]", "boundaries.jet.span_m=[[0.04,0.08],[0.0,0.08]]",
    "boundaries.jet.velocity_m_s=[0.0,1.0,0.0]", "run.end_time_s=0.02", "run.output_interval_s=0.02",
)  # fmt: skip


@pytest.mark.parametrize("kind", ["slip_wall", "wall"])
def test_slab_runs_and_keeps_its_books(tmp_path, kind):
    sides = tuple(f"boundaries.{side}.kind='{kind}'" for side in ("front", "back"))
    case = cases.load(scenes.HERE / "bubbling_bed_3d" / "case.toml", (*COARSE, *sides))
    gas = EmbeddedGas(case)
    simulation = Simulation(case, gas, Ledger(tmp_path / "ledger.csv", case, gas.mesh.depth, *effects.in_ledger(case)))
    simulation.start()
    mass = simulation.state.mass.sum()
    while simulation.time < case.run.end_time:
        simulation.window()
    simulation.ledger.table.close()
    state, summary = simulation.state, simulation.ledger.summary()
    assert state.mass.sum() == mass
    place = particles.positions(state)
    assert (place >= 0.0).all() and (place <= case.domain.size).all()
    assert summary["exchange_momentum_mismatch_rel"] < 1e-10
    assert summary["exchange_energy_mismatch_rel"] < 1e-10
    above = np.abs(state.x - 0.06) < 0.02
    assert state.v[above].mean() > state.v[~above].mean()  # the jet lifts what stands on it
    assert np.abs(state.w).max() < 0.5 * np.abs(state.v).max()


def test_strain_of_a_uniform_flow_in_space(tmp_path):
    """I2D and div v of v = A x inside a block of grains."""
    case = box(["gravity"], size=(0.06, 0.06, 0.06), periodic=(), gravity=(0.0, 0.0, 0.0))
    stepper = started(case, tmp_path).stepper
    state, gradient = stepper.state, np.random.default_rng(5).uniform(-1.0, 1.0, (3, 3))
    velocity = particles.positions(state) @ gradient.T
    for own, column in zip((state.u, state.v, state.w), velocity.T):
        own[:] = column
    sheared = stepper.scratch
    shearing.shear(
        stepper.kernel, state, stepper.rows, stepper.neighbours.box, sheared, OFF, OFF, OFF, OFF, 1e-4,
        np.empty((5, 0)), *sheared.shearing,
    )  # fmt: skip
    shear, divergence = sheared.strain[:2]
    inside = (np.abs(particles.positions(state) - 0.03) < 0.011).all(axis=1)
    D = 0.5 * (gradient + gradient.T)
    deviator = D - np.trace(D) / 3.0 * np.eye(3)
    assert inside.any()
    np.testing.assert_allclose(shear[inside], 0.5 * (deviator**2).sum(), rtol=0.03)
    np.testing.assert_allclose(divergence[inside], np.trace(D), rtol=0.03)
