"""Eddies that spread grains: Taylor's law whatever the window, momentum closed, what is mixed stays so, refusals."""

import math

import numpy as np
import pytest
from grain_boxes import Row, box, go, started, windows

import sdph
from sdph.case import read as cases
from sdph.cli import main
from sdph.effects.gas import turbulent_dispersion
from sdph.engine import state as particles
from sdph.schema import CaseError

K, EPSILON = 1.5, 2.0  # m2/s2, m2/s3
SIGMA, MEMORY = 1.0, 0.15 * K / EPSILON  # m/s, s
TURBULENCE = {"model": "kEpsilon", "k_m2_s2": K, "epsilon_m2_s3": EPSILON}
LIGHT = {"density_kg_m3": 50.0, "diameter_mm": 0.01}  # follow the gas within 15 us


class Stirred(Row):
    """Gas at rest that is turbulent: k [m2/s2] the same everywhere, or as it is given by cells."""

    def __init__(self, case, k=None, slope=0.0, **kwargs):
        super().__init__(case, **kwargs)
        count = len(self.velocity)
        self.k = np.full(count, K) if k is None else k
        self.slope = np.zeros((count, 3))
        self.slope[:, 0] = slope

    def start(self, alpha_g, sources, fields=()):
        assert set(fields) == set(turbulent_dispersion.EFFECT.fields)
        return super().start(alpha_g, sources)

    def _state(self):
        state = super()._state()
        state.fields["turbulent_energy"], state.fields["turbulent_energy_gradient"] = self.k, self.slope
        state.fields["turbulent_dissipation"] = np.full(len(self.k), EPSILON) * (self.k / K) ** 1.5
        return state


def cloud(end, count, size=(2.0, 2.0), one_way=True, **more):
    sections = windows(end, count)
    sections["coupling"] |= {"one_way": one_way}
    sections["resolution"] = {"spacing_mm": 20.0, "cell_mm": 100.0}
    effects = ["drag", "turbulent_dispersion"]
    return box(effects, size=size, alpha_p=1e-4, gas={"turbulence": TURBULENCE}, grains=LIGHT, drag={"law": "stokes"},
               **sections, **more)  # fmt: skip


def way(done, begun):
    """(N, 2) [m] from where the particles began; the box is periodic."""
    order = np.argsort(done.state.ident)
    gone = particles.positions(done.state)[order, :2] - begun
    return (gone + 1.0) % 2.0 - 1.0


@pytest.mark.parametrize(("times", "count"), [(0.3, 3), (3.0, 60), (3.0, 7), (4.0, 1)])
def test_what_follows_the_gas_spreads_by_taylors_law(tmp_path, times, count):
    """10 000 particles: one standard deviation of the mean square is 1 %."""
    run = started(case := cloud(times * MEMORY, count), tmp_path, Stirred(case, alpha_g=1.0))
    begun = particles.positions(run.state)[np.argsort(run.state.ident), :2]
    square = (way(go(run), begun) ** 2).mean(axis=0)
    taylor = 2.0 * (SIGMA * MEMORY) ** 2 * (times + math.expm1(-times))
    assert len(begun) == 10_000
    assert square == pytest.approx(taylor, rel=0.04)


def test_the_gas_loses_what_the_grains_gain(tmp_path):
    run = go(started(case := cloud(MEMORY, 4, one_way=False), tmp_path, Stirred(case)))
    assert run.ledger.summary()["exchange_momentum_mismatch_rel"] < 1e-12
    assert np.abs(particles.velocities(run.state)[:, 0]).mean() > 0.3


def test_eddies_of_one_particle_are_of_chance_alone(tmp_path):
    """Others see others, and a second run, or another order, the same."""
    run = [go(started(case := cloud(MEMORY, 2), tmp_path, Stirred(case, alpha_g=1.0))) for _ in range(2)]
    assert np.array_equal(run[0].state.u, run[1].state.u)
    assert abs(np.corrcoef(run[0].state.eddy_x, run[0].state.eddy_y)[0, 1]) < 0.04
    assert run[0].state.eddy_x.std() == pytest.approx(1.0, abs=0.03)
    other = go(
        started(case := cloud(MEMORY, 2, turbulent_dispersion={"seed": 7}), tmp_path, Stirred(case, alpha_g=1.0))
    )
    assert not np.array_equal(other.state.u, run[0].state.u)


def test_what_is_evenly_mixed_stays_so(tmp_path):
    """k rises and falls tenfold along x: without the drift grains would gather where it is low."""
    case = cloud(20.0 * MEMORY, 400)
    x = (np.arange(40) + 0.5) * 0.05
    rise = 1.0 + 0.8 * np.cos(math.pi * x)
    gas = Stirred(case, cells=40, alpha_g=1.0, k=K * rise, slope=-K * 0.8 * math.pi * np.sin(math.pi * x))
    done = go(started(case, tmp_path, gas))
    calm = np.abs(done.state.x % 2.0 - 1.0) < 0.25  # a quarter of the box, where k is least
    assert calm.mean() == pytest.approx(0.25, abs=0.03)


CHANNEL = {
    "title": "channel", "dimensions": 2, "effects": ["inflow", "outflow", "drag", "turbulent_dispersion"],
    "run": {"end_time_s": 0.02, "output_interval_s": 0.01},
    "domain": {"size_m": [0.2, 0.1], "gravity_m_s2": [0.0, 0.0]},
    "resolution": {"spacing_mm": 4.0, "cell_mm": 10.0},
    "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.024, "temperature_K": 300.0,
            "heat_capacity_J_kg_K": 1006.0, "equation_of_state": "constant", "turbulence": TURBULENCE},
    "grains": {"density_kg_m3": 1000.0, "diameter_mm": 0.02, "heat_capacity_J_kg_K": 4182.0, "conductivity_W_m_K": 0.6},
    "nozzles": {"mouth": {"shape": "slot", "centre_m": [0.0, 0.05], "direction": [1.0, 0.0], "width_m": 0.02,
                          "speed_m_s": 10.0, "temperature_K": 300.0, "volume_fraction": 1e-4}},
    "boundaries": {"inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [10.0, 0.0]},
                   "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
                   "walls": {"kind": "slip_wall"}},
}  # fmt: skip


@pytest.mark.openfoam
def test_a_run_continued_has_the_same_eddies(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(cases.dumps(cases.from_table(CHANNEL)), encoding="utf-8")
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    assert main(["run", str(file), "--out", str(whole)]) == 0
    assert main(["run", str(file), "--out", str(parts), "--until", "0.01"]) == 0
    assert main(["run", "--resume", str(parts), "--until", "0.02"]) == 0
    one, other = (sdph.load(folder).fields(0.02).particles for folder in (whole, parts))
    assert np.array_equal(one.points, other.points) and np.ptp(np.asarray(one["velocity"])[:, 1]) > 1.0
    gas = sdph.load(whole).gas(0.02)
    assert gas["turbulent_energy"].min() > 0.0 and gas["turbulent_dissipation"].min() > 0.0


def test_it_needs_a_model_that_knows_k():
    with pytest.raises(CaseError, match="turbulent_dispersion needs k and epsilon"):
        turbulent_dispersion.kernel(box(["drag", "turbulent_dispersion"]))
    with pytest.raises(CaseError, match="kEpsilon, kOmegaSST"):
        turbulent_dispersion.kernel(box(["drag", "turbulent_dispersion"], gas={"turbulence": {"model": "WALE"}}))


def test_off_leaves_no_array(tmp_path):
    state = started(box(["drag"]), tmp_path).state
    assert not len(state.eddy_x) and not len(state.eddy_z)
