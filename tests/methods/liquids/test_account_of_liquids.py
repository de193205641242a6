"""Energy and momentum of a liquid by cause: each is as large as it is told, or the rest would not be small."""

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.liquids import account
from sdph.running.alone import Alone

DROP = {
    "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    "domain": {"size_m": [0.4, 0.4], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 20.0},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 20.0}, "tank": {"slip": "free_slip", "suction": "none"},
    "pools": {"drop": {"shape": "box", "lower_m": [0.15, 0.01], "upper_m": [0.25, 0.11], "velocity_m_s": [0.0, -4.0]}},
}  # fmt: skip
# scene or case, time [s], what is set; what is to be seen there
SEEN = {
    "dam_break": (
        0.02, ("resolution.spacing_mm=8",), ("work_of_gravity_J", "work_of_walls_J", "damping_J", "diffusion_J"),
    ),
    "sloshing_box": (
        0.03, ("frame.start_s=0", "frame.shake=[[0, 0.05, 20.0, 0.0]]"), ("work_of_frame_J",),
    ),
    "square_patch": (0.02, ("resolution.spacing_mm=50",), ("tension_control_J", "shifting_J", "diffusion_J")),
    "poiseuille": (0.05, ("resolution.spacing_mm=2",), ("viscosity_J", "work_of_gravity_J")),
    "bubble_rise": (
        0.01, ("resolution.spacing_mm=50",),
        ("work_of_surface_tension_J", "gradient_correction_J", "viscosity_J", "work_of_walls_J"),
    ),
    "sloshing_sphere": (
        0.03,
        (
            "resolution.spacing_mm=70", "frame.start_s=0", "drain.start_s=0", "drain.end_s=1", "run.step_factor=0.25",
        ),
        ("drained_J", "work_of_gravity_J"),
    ),
    "drop": (0.01, (), ("held_off_J",)),
}  # fmt: skip


@pytest.fixture
def every_step(monkeypatch):
    monkeypatch.setattr(account, "EVERY", 1)


def gone(folder, name, end, *more) -> Alone:
    """A run of a scene, or of the drop, up to `end` [s]."""
    given = (*SEEN[name][1], *more, f"run.end_time_s={end}", f"run.output_interval_s={end}")
    drop = name == "drop"
    case = cases.from_table(DROP) if drop else cases.load(scenes.HERE / name / "case.toml", given)
    run = Alone(case, folder / "ledger.csv")
    run.start()
    while run.time < end:
        run.window()
    return run


@pytest.mark.parametrize("name", SEEN)
def test_the_rest_is_small_beside_each_cause(tmp_path, every_step, name):
    """A wrong sign of one of them would make a rest of twice its size."""
    end, _, seen = SEEN[name]
    told = gone(tmp_path, name, end).ledger.summary()
    print(name, {key: told[key] for key in (*seen, "numerical_work_J", "momentum_drift_rel")})
    assert told["momentum_drift_rel"] < 1e-12
    for cause in seen:
        assert abs(told["numerical_work_J"]) < 0.25 * abs(told[cause]), cause


def test_the_rest_falls_with_the_square_of_the_step(tmp_path, every_step):
    """Without shifting the scheme is of second order, and so is what the ledger misses; bar 1.7 as in other tests of
    order."""
    rest = [
        abs(gone(tmp_path, "poiseuille", 0.05, f"run.step_factor={f}").ledger.sums["numerical_work_J"])
        for f in (1.0, 0.5, 0.25)
    ]
    orders = np.log2(np.array(rest[:-1]) / rest[1:])
    print("orders of numerical_work_J in the step:", orders)
    assert (orders > 1.7).all()


def test_looks_now_and_then_find_what_looks_at_each_step_find(tmp_path, monkeypatch):
    told = []
    for every in (1, 8):
        monkeypatch.setattr(account, "EVERY", every)
        told.append(gone(tmp_path, "poiseuille", 0.05).ledger.sums["viscosity_J"])
    assert told[1] == pytest.approx(told[0], rel=2e-2)


def test_what_pushes_from_outside_does_work(tmp_path, every_step):
    run = Alone(cases.from_table(DROP), tmp_path / "ledger.csv")
    run.start()
    push = np.zeros((len(run.state.x), 3))
    push[run.stepper.active] = 50.0, 200.0, 0.0
    run.liquid.begin()
    run.liquid.push(push)
    run.liquid.advance(1e-3)
    run.liquid.close()
    told = run.ledger.summary()
    assert told["momentum_drift_rel"] < 1e-12
    assert abs(told["numerical_work_J"]) < 0.05 * abs(told["work_of_contact_J"])


def test_a_wall_whose_force_is_told_wrong_shows(tmp_path, monkeypatch):
    rates = account.rates

    def wrong(*given):
        now = rates(*given)
        now[account.WALLS] *= 1.001
        return now

    monkeypatch.setattr(account, "rates", wrong)
    assert gone(tmp_path, "dam_break", 0.02).ledger.summary()["momentum_drift_rel"] > 1e-5
