"""The vorticity that a gas solver hands where an effect asks for it: exact in a simple shear, the same from both, else
absent."""

import numpy as np
import pytest
from gas_boxes import box, box_case
from gas_cases import gas_of, set_flow

from coupling.embedded import EmbeddedGas
from coupling.gas import GasError

RATE = 50.0  # 1/s
SIZE, CELL = (0.1, 0.06), 0.01
HOLD = 1e9  # kg/m3/s, so that the gas takes the velocity that it is told
OPEN = {
    "left": {"kind": "pressure_outlet", "side": "left", "pressure_Pa": 0.0},
    "right": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "floor": {"kind": "wall", "side": "bottom"},
    "lid": {"kind": "wall", "side": "top", "velocity_m_s": [RATE * SIZE[1], 0.0]},
}


def sheared(gas):
    """Gas held at u = RATE y between a wall at rest and one that moves along with it."""
    state = gas.start(None, ("momentum_coefficient", "momentum"), ("vorticity",))
    assert state.fields["vorticity"].shape == (len(gas.mesh.volumes), 3)
    pull = np.zeros((len(gas.mesh.volumes), 3))
    pull[:, 0] = HOLD * RATE * gas.mesh.centres[:, 1]
    for _ in range(3):
        state = gas.advance(1e-3, {"momentum_coefficient": np.full(len(pull), HOLD), "momentum": pull})
    return state


def check(gas, state):
    inside = np.abs(gas.mesh.centres[:, 0] - 0.5 * SIZE[0]) < 0.5 * SIZE[0] - 1.1 * CELL
    found = state.fields["vorticity"]
    print("largest error of the vorticity in a simple shear:", np.abs(found[inside, 2] / -RATE - 1.0).max())
    np.testing.assert_allclose(found[inside, 2], -RATE, rtol=1e-9)
    assert (found[:, :2] == 0.0).all()


def test_simple_shear_in_the_embedded_gas(tmp_path):
    gas = EmbeddedGas(box_case(SIZE, CELL, boundaries=OPEN))
    state = sheared(gas)
    check(gas, state)
    gas.checkpoint(tmp_path)
    again = EmbeddedGas(box_case(SIZE, CELL, boundaries=OPEN)).restore(tmp_path, fields=("vorticity",))
    np.testing.assert_array_equal(again.fields["vorticity"], state.fields["vorticity"])


@pytest.mark.openfoam
def test_simple_shear_in_openfoam(tmp_path):
    with box(tmp_path, SIZE, CELL, boundaries=OPEN) as gas:
        state = sheared(gas)
        check(gas, state)
        gas.checkpoint(tmp_path / "kept")
        assert "vorticity" not in gas.restore(tmp_path / "kept").fields
        np.testing.assert_array_equal(
            gas.restore(tmp_path / "kept", fields=("vorticity",)).fields["vorticity"], state.fields["vorticity"]
        )


@pytest.mark.parametrize("stretch", [None, [3.0, 0.5, 2.0]])
def test_turning_gas_in_space(stretch):
    """Twice the angular velocity of gas that turns like a solid, about any axis, away from the walls."""
    omega = np.array([3.0, -2.0, 5.0])
    gas = gas_of((0.1, 0.1, 0.1), 8, stretch=stretch)
    gas.start(None, (), ("vorticity",))
    set_flow(gas, velocity=lambda a, x, y, z: np.cross(omega, np.stack((x, y, z), axis=1))[:, a])
    inside = (np.abs(gas.mesh.centres - 0.05) < 0.03).all(axis=1)
    assert inside.any()
    np.testing.assert_allclose(
        gas._state().fields["vorticity"][inside], np.tile(2.0 * omega, (inside.sum(), 1)), rtol=1e-12
    )


def test_an_unknown_field_is_named():
    with pytest.raises(GasError, match="unknown field 'vorticty'; on request a gas solver hands vorticity"):
        gas_of((0.1, 0.1), 8).start(None, (), ("vorticty",))
