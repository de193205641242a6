"""What validates scenes of liquids: measures that find what is known, checks that can fail."""

from types import SimpleNamespace

import numpy as np
import pytest

from sdph.engine.state import GAS, LIQUID
from sdph.study import compare
from tests.validation.told_runs import told

RADIUS, SPACING = 0.25, 0.025  # m


class Points(dict):
    """As pyvista points: places, and arrays by name."""

    def __init__(self, points, kind):
        super().__init__(kind=kind)
        self.points = np.column_stack([points, np.zeros(len(points))])


@pytest.mark.parametrize("stretch", [1.0, 1.2, 1.3])
def test_circularity_of_an_ellipse_is_found(stretch):
    """Cut out of a lattice whose particles are off by a tenth of a spacing; 0.005: half of what the bubble is held
    to."""
    ticks = (np.arange(-20, 20) + 0.5) * SPACING  # as in the scene
    points = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2) + 0.1 * SPACING * np.random.default_rng(
        1
    ).standard_normal((1600, 2))
    inside = (points[:, 0] / stretch) ** 2 + (points[:, 1] * stretch) ** 2 < RADIUS**2
    case = SimpleNamespace(resolution=SimpleNamespace(spacing=SPACING), smoothing_length=1.5 * SPACING)
    found, area = compare.scene_module("bubble_rise").circularity(Points(points, np.where(inside, GAS, LIQUID)), case)
    angle = np.linspace(0.0, 2.0 * np.pi, 10001)
    rim = RADIUS * np.stack([stretch * np.cos(angle), np.sin(angle) / stretch])
    perimeter = np.hypot(*np.diff(rim, axis=1)).sum()
    assert found == pytest.approx(2.0 * np.pi * RADIUS / perimeter, abs=0.005)
    assert area == pytest.approx(np.pi * RADIUS**2, rel=0.02)


@pytest.mark.parametrize(
    ("made", "shaken", "piped", "ok"),
    [
        (0.0, 0.0, 0.0, [True, True, True]),
        (1.0, 0.0, 0.0, [False, True, True]),
        (0.0, 1.0, 0.0, [True, False, False]),
        (0.0, 0.0, 1.0, [True, False, True]),
    ],
)
def test_energy_that_cassini_makes_is_told(made, shaken, piped, ok):
    """`made` [J] at 100 s by nobody, as the ledger has it; `shaken` [J] more in the tank from 250 s on, `piped`
    [J] in its pipe."""
    time = np.arange(0.0, 300.5, 0.5)
    ones, late = np.ones_like(time), time > 250.0
    history = {
        "time_s": time,
        "mass_kg": 200.0 * ones,
        "kinetic_energy_J": 3.0 - 1e-3 * time + (shaken + piped) * late,
        "pipe_kinetic_energy_J": ones + piped * late,
    }
    ledger = {"time_s": time, "dissipated_J": 0.01 * ones, "numerical_work_J": made * (time == 100.0)}
    run = told("sloshing_cassini", 300.0, history=history, ledger=ledger)
    rows = compare.scene_module("sloshing_cassini")._energy(run)
    assert [row["ok"] for row in rows] == ok
    assert rows[1]["value"] < 0.0 or shaken or piped  # what falls is told as it falls
