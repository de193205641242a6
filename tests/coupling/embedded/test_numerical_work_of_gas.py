"""What the embedded gas loses or gains besides physical work (`gas_numerical_work_J` of the ledger) falls with the
window and with the cell, with an order of each: a decaying vortex. docs/theory/gas.md has the table."""

import math

import numpy as np
import pytest
from gas_cases import gas_of, orders, set_flow

END, WINDOWS, CELLS = 0.2, (8, 16, 32), (16, 32, 64)  # s


def numerical_work(cells: int, windows: int) -> float:
    """Work [J/m] that is missing in the motion of a vortex between slip walls, over its viscous work."""
    size = math.pi
    options = {"boundaries": {"walls": {"kind": "slip_wall"}}, "density_kg_m3": 1.0, "viscosity_Pa_s": 0.05}
    gas = gas_of((size, size), cells, **options)
    gas.start(None, ())
    velocity = lambda a, x, y: np.sin(x) * np.cos(y) if a == 0 else -np.cos(x) * np.sin(y)  # noqa: E731
    set_flow(gas, velocity=velocity, pressure=lambda x, y: 0.25 * (np.cos(2 * x) + np.cos(2 * y)))
    kinetic = gas._state().budget.kinetic
    for _ in range(windows):
        last = gas.advance(END / windows, {}).budget
    change = last.kinetic - kinetic + last.pressure_work - last.boundary_work - last.gravity_work
    return (change - last.viscous_work) / abs(last.viscous_work)


@pytest.fixture(scope="module")
def found() -> np.ndarray:
    """(cells, windows)."""
    works = np.array([[numerical_work(cells, windows) for windows in WINDOWS] for cells in CELLS])
    print(works)
    return works


def test_it_is_first_order_in_the_window(found):
    of_window = orders(found[-1])
    print("orders in the window", of_window)
    assert (found < 0.0).all()  # it brakes
    assert all(0.9 < order < 1.2 for order in of_window)


def test_what_windows_of_no_length_leave_is_third_order_in_the_cell(found):
    left = 2.0 * found[:, -1] - found[:, -2]  # with windows of no length
    print("left by cells", left, "orders in the cell", orders(left))
    assert all(2.7 < order < 3.3 for order in orders(left))
    assert abs(left[-1]) < 1e-3
