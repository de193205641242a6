"""Drains of tanks that pools without a `fill`, or nozzles, have filled."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from sdph.case import read as cases
from sdph.effects.around import drain
from sdph.engine.kept import Unfit
from sdph.running import driver
from sdph.running.alone import Alone
from sdph.running.progress import Reporter
from sdph.schema import CaseError

TANK = """
dimensions = 2
effects = ["gravity", "density_diffusion", "liquid_damping", "tank", "drain"{more}]
[run]
end_time_s = 1.0
output_interval_s = 0.5
[domain]
size_m = [0.4, 0.4]
gravity_m_s2 = [0.0, -9.81]
[resolution]
spacing_mm = 20.0
[liquid]
density_kg_m3 = 1000.0
sound_speed_m_s = 30.0
[tank]
open_sides = ["top"]
slip = "free_slip"
[drain]
fill = 0.05
start_s = 0.7
end_s = 0.9
"""
TAP = """
[nozzles.tap]
shape = "slot"
centre_m = [0.0, 0.2]
width_m = 0.06
direction = [1.0, 0.0]
speed_m_s = 0.8
{end}
"""
BOX = """
[pools.water]
shape = "box"
lower_m = [0.0, 0.0]
upper_m = [{width}, 0.2]
"""


def case_of(folder, text: str, more: str = ""):
    file = folder / "case.toml"
    file.write_text(TANK.format(more=more) + text)
    return cases.load(file)


def test_a_tank_that_a_nozzle_fills_keeps_what_is_asked(tmp_path):
    """It begins empty: the fill when the drain opens is what the nozzle has brought, not a whole tank."""
    case = case_of(tmp_path, TAP.format(end="end_s = 0.5"), ', "inflow"')
    brought = 0.06 * 0.8 * 0.5 * 1000.0
    assert drain.filled(case) == pytest.approx(brought / 160.0, rel=1e-12)
    summary = driver.run(case, "tap", tmp_path / "run", None, Reporter())
    assert summary["drained_kg"] == pytest.approx(brought - 0.05 * 160.0, rel=1e-6)


@pytest.mark.parametrize(
    "open_, seconds", [("end_s = 0.5", 0.5), ("end_s = 0.8", 0.7), ("", 0.7), ("start_s = 0.7", 0.0)]
)
def test_what_a_nozzle_brings_counts_until_the_drain_opens(tmp_path, open_, seconds):
    case = case_of(tmp_path, TAP.format(end=open_) + BOX.format(width=0.1), ', "inflow"')
    assert drain.filled(case) == pytest.approx((0.02 + 0.06 * 0.8 * seconds) / 0.16, rel=1e-12)


def test_pools_of_any_shape_tell_how_full_the_tank_is(tmp_path):
    disc = '[pools.drop]\nshape = "disc"\ncentre_m = [0.3, 0.3]\nradius_m = 0.08\n'
    case = case_of(tmp_path, BOX.format(width=0.1) + disc)
    assert drain.filled(case) == pytest.approx((0.02 + math.pi * 0.08**2) / 0.16, rel=1e-12)


def test_a_tank_that_is_empty_when_its_drain_opens_has_nothing_to_drain(tmp_path):
    case = case_of(tmp_path, TAP.format(end="start_s = 0.8"), ', "inflow"')
    with pytest.raises(CaseError, match=r"drain\.fill = 0\.05 is more than the 0 of the tank"):
        drain.kernel(case)
    own = dataclasses.replace(case.parameters["drain"], fill=0.0)
    empty = dataclasses.replace(case, parameters=case.parameters | {"drain": own})
    assert drain.call(SimpleNamespace(case=empty, end=1.0)).error_if_off == 0.0


def test_a_tank_that_a_nozzle_fills_is_drained_in_whole_particles_too(tmp_path):
    """It begins empty, so that no pool says how heavy a particle is."""
    case = case_of(tmp_path, TAP.format(end=""), ', "inflow"')
    own = dataclasses.replace(case.parameters["drain"], form="paper", fill=0.0)
    case = dataclasses.replace(case, parameters=case.parameters | {"drain": own})
    summary = driver.run(case, "tap", tmp_path / "run", None, Reporter())
    assert summary["drained_kg"] == pytest.approx(0.06 * 0.8 * 0.7 * 1000.0, abs=0.5001 * 0.4)


def test_what_a_nozzle_brought_may_have_left_when_a_run_goes_on(tmp_path):
    """More than stood there at the start, walls included."""
    outlet = Alone(case_of(tmp_path, TAP.format(end=""), ', "inflow"'), tmp_path / "ledger.csv").method.outlet
    kept = {"leaving": np.zeros((0, 4)), "gone": np.array([outlet.stepper.born.mass + 50.0])}
    came = np.zeros((2, 5))
    stepper = {"state": {"ident": np.zeros(0), "kind": np.zeros(0)}, "openings": {"passed": came}}
    with pytest.raises(Unfit, match="was never there"):
        outlet.admit_at(1.0, kept, stepper)
    came[0, 0] = 100.0
    outlet.admit_at(1.0, kept, stepper)
