"""Inlets set the gas moving at once, before the first window: no impulse of it is a pressure on walls and grains."""

import numpy as np
import own_meshes
import pytest
from gas_boxes import box, box_case, template

from coupling.embedded import EmbeddedGas
from coupling.openfoam.solver import OpenFoamGas

SIZE, CELL, SPEED, ALPHA_G, DRAG = (0.06, 0.3), 0.01, 0.4, 0.45, 1e3
OPEN = {"above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0}, "walls": {"kind": "slip_wall"}}
BLOWN = {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, SPEED], "temperature_K": 300.0}
BED = {"below": BLOWN} | OPEN
JET = {"jet": BLOWN | {"span_m": [0.02, 0.04]}} | OPEN
openfoam = pytest.param("openfoam", marks=pytest.mark.openfoam)


def begun(gas, dt=1e-6):
    """Fields at the start of gas in a bed up to half the height, and pressures (2, C) [Pa] of two windows of dt [s]."""
    below = gas.mesh.centres[:, 1] < 0.5 * SIZE[1]
    given = {"momentum_coefficient": DRAG * below, "momentum": np.zeros((len(below), 3))}
    start = gas.start(np.where(below, ALPHA_G, 1.0), tuple(given)).fields
    return start, np.array([gas.advance(dt, given).fields["pressure"] for _ in range(2)])


def begun_in(name, folder, boundaries, **own):
    """The same in a box, by the gas of a name, and the centres of its cells."""
    if name == "embedded":
        gas = EmbeddedGas(box_case(SIZE, CELL, boundaries=boundaries, **own))
        return gas.mesh.centres, *begun(gas)
    with box(folder, SIZE, CELL, boundaries=boundaries, **own) as gas:
        return gas.mesh.centres, *begun(gas)


def check_pressures(pressures):
    """The impulse of the start would be 1e5 Pa in the first window; what the tolerance of a solver leaves of it is some
    Pa. The drop over the bed is 1e2 Pa."""
    assert np.abs(pressures[0] - pressures[1]).max() < 0.05 * np.ptp(pressures[1])


@pytest.mark.parametrize("name", ["embedded", openfoam])
def test_gas_goes_through_a_bed_from_the_start(tmp_path, name):
    centres, start, pressures = begun_in(name, tmp_path, BED)
    y, velocity = centres[:, 1], start["velocity"]
    away = np.abs(y - 0.5 * SIZE[1]) > CELL
    assert velocity[away, 1] == pytest.approx(SPEED / np.where(y < 0.5 * SIZE[1], ALPHA_G, 1.0)[away], rel=1e-6)
    assert np.abs(velocity[:, 0]).max() < 1e-6 * SPEED
    check_pressures(pressures)


@pytest.mark.parametrize("name", ["embedded", openfoam])
def test_gas_that_nothing_blows_rests(tmp_path, name):
    assert not begun_in(name, tmp_path, OPEN)[1]["velocity"].any()


@pytest.mark.openfoam
def test_both_gases_begin_alike_above_a_jet(tmp_path):
    found = []
    for name in ("embedded", "openfoam"):
        centres, start, pressures = begun_in(name, tmp_path / name, JET)
        check_pressures(pressures)
        found.append(start["velocity"][np.lexsort(np.round(centres[:, :2], 9).T), :2])
    assert np.abs(found[0]).max() > 0.3 * SPEED
    assert np.abs(found[0] - found[1]).max() < 1e-3 * SPEED


OPERATING = {"equation_of_state": "operating", "molar_mass_kg_kmol": 29.0}


@pytest.mark.openfoam
@pytest.mark.parametrize(("came", "there"), [(300.0, 1200.0), (900.0, 300.0)])
def test_gas_of_another_density_takes_its_room(tmp_path, came, there):
    """Cold gas into hot gas would come in four times as fast by its mass, and be stopped by 39 kPa in the first
    window; the impulse of the start would be 12.7 kPa. Where it comes in cells have no velocity of their own yet."""
    boundaries = {name: own | {"temperature_K": there} if name == "above" else own for name, own in JET.items()}
    boundaries["jet"] = JET["jet"] | {"temperature_K": came}
    found = []
    for name in ("embedded", "openfoam"):
        where = tmp_path / name
        centres, start, pressures = begun_in(name, where, boundaries, temperature_K=there, **OPERATING)
        order = np.lexsort(np.round(centres[:, :2], 9).T)
        found.append(start["velocity"][order[centres[order, 1] > CELL], :2])
        print(name, np.ptp(pressures, axis=1), np.abs(found[-1]).max())
        assert np.ptp(pressures[0]) < 2e3
    assert np.abs(found[0] - found[1]).max() < 1e-3 * SPEED


@pytest.mark.openfoam
def test_faces_that_lean_are_seen_to_at_the_start(tmp_path):
    own = template(tmp_path)
    (own / "system" / "blockMeshDict").write_text(own_meshes.taper(0.06, 0.2, 0.3, 8, 24))
    names = {"inlet": BLOWN, "outlet": OPEN["above"], "wall": OPEN["walls"]}
    boundaries = {name: {key: given for key, given in rows.items() if key != "side"} for name, rows in names.items()}
    gas = OpenFoamGas(box_case((0.2, 0.3), CELL, boundaries=boundaries), tmp_path / "gas", own)
    try:
        start, pressures = begun(gas)
    finally:
        gas.close()
    assert start["velocity"][:, 1].max() > 1.5 * SPEED
    check_pressures(pressures)
