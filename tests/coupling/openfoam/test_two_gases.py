"""Short forms of the paper's three scenes on both gas solvers: a case runs on either by `--gas` alone, and says the
same."""

import numpy as np
import pytest
from gas_boxes import box, box_case

from coupling.embedded import EmbeddedGas
from sdph import scenes
from sdph.case import read as cases
from sdph.case.gas_cells import cell_edges
from sdph.running import driver
from sdph.running.progress import Reporter

# scene -> (overrides, key of summary.json -> relative difference allowed)
SHORT = {
    "disc_cluster": (("run.end_time_s=1e-3",), {"centre_rise_K": 1e-3, "heat_exchanged_J": 0.02}),
    "bubbling_bed": (
        ("run.end_time_s=0.02",),
        {"bubble_area_m2": 0.02, "bed_height_m": 0.02, "heat_exchanged_J": 0.02},
    ),
    "bubbling_bed, stretched": (
        ("run.end_time_s=0.02", "resolution.stretch=[1.0,4.0]"),
        {"bed_height_m": 0.02, "heat_exchanged_J": 0.02},
    ),
    "evaporating_jet": (("run.end_time_s=0.02",), {"front_m": 0.02, "heat_exchanged_J": 0.02}),
}


@pytest.mark.openfoam
@pytest.mark.parametrize("scene", SHORT)
def test_both_gas_solvers_say_the_same(tmp_path, scene):
    overrides, keys = SHORT[scene]
    summaries = {}
    for gas in ("openfoam", "embedded"):
        name = scene.partition(",")[0]
        case = cases.load(scenes.find(name)[1], (*overrides, f"coupling.gas={gas}"))
        summaries[gas] = driver.run(case, name, tmp_path / gas, None, Reporter(quiet=True))
    for key, allowed in keys.items():
        assert summaries["embedded"][key] == pytest.approx(summaries["openfoam"][key], rel=allowed), key


SIZE, STRETCH = (0.1, 0.2), [3.0, 0.25]


def through_a_slot(gas):
    """Centres (C, 2), volumes (C,) and fields of gas driven through a slot into a body that drags, in one order for
    both solvers."""
    cells = len(gas.mesh.volumes)
    gas.start(None, ("momentum_coefficient", "momentum"))
    for _ in range(5):
        state = gas.advance(1e-2, {"momentum_coefficient": np.full(cells, 1e3), "momentum": np.zeros((cells, 3))})
    order = np.lexsort(np.round(gas.mesh.centres[:, :2], 9).T)
    fields = state.fields
    return (
        gas.mesh.centres[order, :2],
        gas.mesh.volumes[order],
        fields["velocity"][order, :2],
        fields["pressure"][order],
    )


@pytest.mark.openfoam
def test_stretched_cells_and_what_flows_through_them_are_the_same(tmp_path):
    across, _along = cell_edges(box_case(SIZE, 0.01, stretch=STRETCH))
    assert np.diff(across)[[0, -1]] @ [-3.0, 1.0] == pytest.approx(0.0, abs=1e-15)
    boundaries = {
        "slot": {
            "kind": "velocity_inlet",
            "side": "bottom",
            "span_m": [across[3], across[6]],
            "velocity_m_s": [0.0, 1.0],
        },
        "above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0},
        "walls": {"kind": "slip_wall"},
    }
    own = through_a_slot(EmbeddedGas(box_case(SIZE, 0.01, stretch=STRETCH, boundaries=boundaries)))
    with box(tmp_path, SIZE, 0.01, stretch=STRETCH, boundaries=boundaries) as gas:
        other = through_a_slot(gas)
    assert len(own[1]) == 200
    assert np.allclose(other[0], own[0], rtol=0, atol=1e-9)  # blockMesh writes ten digits
    assert np.allclose(other[1], own[1], rtol=1e-9)
    for name, a, b in zip(("velocity", "pressure"), own[2:], other[2:]):
        apart = np.abs(a - b).max() / np.abs(b).max()
        print(f"{name}: largest difference {apart:.2e} of the largest value")
        assert apart < 0.02
