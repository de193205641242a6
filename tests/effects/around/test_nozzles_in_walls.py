"""Nozzles in the walls that hold the grains: a mouth lets its stream through, and is a wall while nothing comes."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from test_many_nozzles import begun, case, slot

from sdph.engine import kept
from sdph.engine import state as particles
from sdph.engine.state import GRAIN, INFLOW

CLOSED = {"walls": {"kind": "wall"}}
EFFECTS = ["inflow", "walls", "drag", "granular_pressure"]
ALPHA = 0.05


def until(done, time):
    while done.time < time:
        done.window()
    return done


@pytest.mark.parametrize(("nozzles", "dimensions"), [
    ({"left": slot([0.0, 0.5], [1.0, 0.0], width_m=0.2), "below": slot([0.5, 0.0], [0.0, 1.0], width_m=0.2)}, 2),
    ({"left": slot([0.0, 0.5, 0.5], [1.0, 0.0, 0.0], width_m=0.3, length_m=0.3)}, 3),
])  # fmt: skip
def test_a_stream_comes_through_a_wall_as_it_comes_through_none(tmp_path, nozzles, dimensions):
    """Mass as rate times time, and no seam in the density: not as if the wall stood in the mouth too."""
    done = until(begun(case(nozzles, dimensions, effects=EFFECTS, boundaries=CLOSED), tmp_path), 0.04)
    layer = sum(s.mass * len(s.speed) for s in done.grains.source.streams)
    came = sum(s.mass * (s.speed / s.pitch).sum() for s in done.grains.source.streams) * done.time
    assert abs(done.grains.source.mass - came) <= 0.5 * layer * (1.0 + 1e-9)
    state, streams = done.state, done.grains.source.streams[0]
    along, aside = done.grains.source._beyond(0, particles.positions(state))
    heart = (state.nozzle == 1) & (np.abs(along) < 1.2 * streams.pitch) & (aside < 1.2 * streams.pitch)
    assert (along[heart] > 0.0).any() and (along[heart] < 0.0).any()
    np.testing.assert_allclose(state.density[heart], ALPHA * 700.0, rtol=0.1)


def test_a_mouth_that_gives_nothing_holds_grains_like_a_wall(tmp_path):
    """Before it opens and after it has closed."""
    nozzle = slot([0.5, 0.0], [0.0, 1.0], width_m=0.2, start_s=0.2, end_s=0.24)
    bed = {
        "shape": "box",
        "lower_m": [0.3, 0.02],
        "upper_m": [0.7, 0.06],
        "volume_fraction": ALPHA,
        "temperature_K": 300.0,
        "velocity_m_s": [0.0, -0.5],
    }
    chosen = case(
        {"below": nozzle}, effects=EFFECTS, boundaries=CLOSED, particles={"bed": bed},
        run={"end_time_s": 1.0, "output_interval_s": 1.0},
    )  # fmt: skip
    done = until(begun(chosen, tmp_path), 0.15)
    assert (done.state.kind == GRAIN).all() and done.state.y.min() > 0.0
    until(done, 0.3)
    assert done.grains.source.mass > 0.0 and not (done.state.kind == INFLOW).any()
    assert done.state.y.min() > 0.0
    assert math.fsum(done.state.mass) == pytest.approx(ALPHA * 700.0 * 0.4 * 0.04 + done.grains.source.mass, rel=1e-12)


def test_walls_beside_a_mouth_take_nothing_from_grains_that_wait(tmp_path):
    """Viscous grains between gripping walls: what waits upstream is carried, and motion closes to round-off."""
    effects = [*EFFECTS, "granular_viscosity", "granular_temperature"]
    nozzles = {"left": slot([0.0, 0.5], [1.0, 0.0], width_m=0.2)}
    done = until(begun(case(nozzles, effects=effects, boundaries=CLOSED), tmp_path), 0.06)
    assert done.grains.source.mass > 0.0 and done.ledger.sums["work_of_inflow_J"] != 0.0
    assert done.ledger.summary()["motion_drift_rel"] < 1e-12


def test_grains_that_will_have_left_take_no_room(tmp_path):
    """Those that fall through an open side within a window are not in the gas at its end; beside a wall they are."""
    bed = {"shape": "box", "lower_m": [0.3, 0.02], "upper_m": [0.7, 0.06], "volume_fraction": ALPHA,
           "temperature_K": 300.0, "velocity_m_s": [0.0, -1.0]}  # fmt: skip
    shares = {}
    for kind in ("pressure_outlet", "wall"):
        sides = {"below": {"kind": kind, "side": "bottom"}, "walls": {"kind": "wall"}}
        own = case({}, effects=["outflow", "drag", "walls"], boundaries=sides, particles={"bed": bed})
        (tmp_path / kind).mkdir()
        done = begun(own, tmp_path / kind)
        shares[kind] = done.grains.share_inside(0.04), done.state.y
    share, y = shares["pressure_outlet"]
    assert np.array_equal(share == 0.0, y < 0.04) and 0 < (share == 0.0).sum() < len(y)
    assert (shares["wall"][0] == 1.0).all()


def test_a_lance_inside_leaves_the_wall_behind_it_whole(tmp_path):
    """A mouth in the middle of the box opens no wall in line with it; one in the wall opens its own."""
    counts = {}
    for name, height in (("lance", 0.5), ("in the wall", 0.0)):
        nozzle = slot([0.5, height], [0.0, 1.0], width_m=0.2)
        (tmp_path / name).mkdir()
        done = begun(case({"up": nozzle}, 2, effects=EFFECTS, boundaries=CLOSED), tmp_path / name)
        counts[name] = int((done.grains.stepper.mouths > 0).sum())
    assert counts["lance"] == 0 and counts["in the wall"] > 0


def test_rows_made_anew_have_the_mouths_open_that_they_had(tmp_path):
    """After the last particle of a nozzle is through, its mouth stays open while the rows hold, resumed or not."""
    closing = slot([0.5, 0.0], [0.0, 1.0], width_m=0.2, end_s=0.05)
    short = {"gas": "embedded", "window_largest_s": 2e-4}
    done = begun(case({"below": closing}, effects=EFFECTS, boundaries=CLOSED, coupling=short), tmp_path)
    shut = 0
    while done.time < 0.06 and shut < 2:
        done.window()
        shut += done.grains.stepper.giving.any() and not (done.state.kind == INFLOW).any()
        done.grains.stepper.revive()  # Unfit where the density of the particles is another
    assert shut


def test_a_mouth_is_open_where_particles_of_another_process_wait(tmp_path):
    """Rows of a checkpoint are made anew by all processes with what the first one knows."""
    both = {"below": slot([0.5, 0.0], [0.0, 1.0]), "left": slot([0.0, 0.5], [1.0, 0.0])}
    done = begun(case(both, effects=EFFECTS, boundaries=CLOSED), tmp_path)
    own, world = done.grains.source, SimpleNamespace(most=lambda here: np.maximum(here, [0.0, 0.0, 1.0]))
    done.window()
    done.state.kind[done.state.nozzle == 2] = GRAIN
    assert own.giving(done.state, world).tolist() == [False, True, True]


def test_what_a_checkpoint_holds_goes_on_while_mouths_are_open(tmp_path):
    chosen = case({"below": slot([0.5, 0.0], [0.0, 1.0], width_m=0.2)}, effects=EFFECTS, boundaries=CLOSED)
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    done, fresh, saved = until(begun(chosen, tmp_path / "a"), 0.02), begun(chosen, tmp_path / "b"), {}
    fresh.grains.stepper.giving[:] = False  # as of a run that is resumed, which has not begun by itself
    packed = kept.pack(done.grains, saved)
    kept.put(fresh.grains, kept.unpack(packed, saved))  # Unfit where the density of the particles is another
    assert fresh.grains.stepper.giving.tolist() == [False, True]
