"""Inlets with a parabola: both gas solvers let in the same, at the middles of faces, along a side or a part of it."""

import re

import numpy as np
import pytest
from gas_boxes import box, box_case

from coupling.embedded import EmbeddedGas
from coupling.embedded.boundaries import boundary_faces
from coupling.embedded.grid import build_grid
from coupling.openfoam import start_fields
from coupling.openfoam.case import write_case
from sdph import scenes
from sdph.case import inlet_profiles
from sdph.case import read as cases
from sdph.case.gas_cells import cell_edges
from sdph.scenes import paths
from sdph.schema import CaseError

SIZE, CELL, MEAN = (0.1, 0.2), 0.01, 0.5


def channel(**inlet):
    own = {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.1, MEAN], "profile": "parabolic"}
    return {"inlet": own | inlet, "above": {"kind": "pressure_outlet", "side": "top"}, "walls": {"kind": "wall"}}


def let_in(**inlet):
    """Places along the side [m] and velocity (n, 2) [m/s] of the faces of the inlet."""
    case = box_case(SIZE, CELL, boundaries=channel(**inlet))
    edges = cell_edges(case)
    faces = boundary_faces(case, build_grid(edges))
    along = 1 if inlet.get("side") == "left" else 0
    middles, mine = 0.5 * (edges[along][1:] + edges[along][:-1]), faces.inlet
    low, high = inlet.get("span_m", (0.0, SIZE[along]))
    return middles[(middles > low) & (middles < high)], faces.velocity[mine], (low, high)


@pytest.mark.parametrize(
    "inlet", [{}, {"span_m": [0.02, 0.07]}, {"side": "left"}, {"side": "left", "span_m": [0.1, 0.2]}]
)
def test_a_parabola_along_a_side_or_a_part_of_it(inlet):
    """6 s (1 - s) times the mean, whose sum over N faces is 1 + 1/(2 N^2) of it; both parts alike."""
    places, velocity, (low, high) = let_in(**inlet)
    share = (places - low) / (high - low)
    np.testing.assert_allclose(velocity[:, 1], MEAN * 6.0 * share * (1.0 - share), rtol=1e-12)
    np.testing.assert_allclose(velocity[:, 0] / velocity[:, 1], 0.1 / MEAN, rtol=1e-12)
    assert velocity[:, 1].mean() / MEAN == pytest.approx(1.0 + 0.5 / len(places) ** 2, rel=1e-12)


def test_openfoam_is_told_the_same():
    """The polynomial of its text, read back, at the same places."""
    case = box_case(SIZE, CELL, boundaries=channel(side="left", span_m=[0.1, 0.2]))
    text = start_fields.start_fields(case)["U"]
    numbers = [float(n) for n in re.search(r"direction(.*?);\s*origin(.*?);\s*profile polynomial(.*?);", text)
               .expand(r"\1 \2 \3").replace("(", " ").replace(")", " ").split()]  # fmt: skip
    direction, origin, first, second = numbers[:3], numbers[3], numbers[4:7], numbers[10:13]
    assert direction == [0.0, 1.0, 0.0]
    places, velocity, _ = let_in(side="left", span_m=[0.1, 0.2])
    way = (places - origin)[:, None]
    np.testing.assert_allclose(way * first[:2] + way**2 * second[:2], velocity, rtol=1e-12)


@pytest.mark.openfoam
def test_both_gases_have_the_same_flow(tmp_path):
    """Half a second of gas alone, let in through a part of the floor: flow and form of the lowest cells, within 2 % of
    the mean (schemes differ); a uniform inlet is off by 50 %."""
    boundaries, found = channel(velocity_m_s=[0.0, MEAN], span_m=[0.02, 0.08]), []
    with box(tmp_path, SIZE, CELL, boundaries=boundaries) as other:
        for gas in (EmbeddedGas(box_case(SIZE, CELL, boundaries=boundaries)), other):
            gas.start(None, ())
            for _ in range(50):
                state = gas.advance(1e-2, {})
            lowest = gas.mesh.centres[:, 1] < CELL
            found.append(state.fields["velocity"][lowest][np.argsort(gas.mesh.centres[lowest, 0]), 1])
    np.testing.assert_allclose(found[0], found[1], atol=0.02 * MEAN)
    assert found[0].sum() == pytest.approx(6 * MEAN * (1.0 + 0.5 / 36), rel=1e-3)


@pytest.mark.parametrize(
    "boundaries",
    [
        {"inlet": {"kind": "velocity_inlet", "velocity_m_s": [0.0, 1.0], "profile": "parabolic"}},
        {"walls": {"kind": "wall", "side": "top", "velocity_m_s": [1.0, 0.0], "profile": "parabolic"}},
    ],
)
def test_a_profile_where_none_is_known_is_refused(boundaries):
    with pytest.raises(CaseError, match=r"profile = 'parabolic'; it is known for a velocity_inlet on a named side"):
        box_case(SIZE, CELL, boundaries={**boundaries, "rest": {"kind": "pressure_outlet", "side": "left"}})


def test_on_a_mesh_of_ones_own_it_is_refused(tmp_path):
    """Its patch may be narrower than the box around it."""
    case = cases.load(scenes.find("tapered_bed")[1], ("boundaries.inlet.profile='parabolic'",))
    with pytest.raises(CaseError, match=r"boundaries.inlet.profile = 'parabolic'; .* whose mesh is made from the case"):
        write_case(case, paths.gas_template("tapered_bed"), tmp_path / "gas")


def test_in_space_it_is_refused():
    with pytest.raises(CaseError, match="two dimensions"):
        box_case((0.1, 0.1, 0.1), CELL, boundaries=channel(velocity_m_s=[0.0, 1.0, 0.0]))


def test_a_span_in_brackets_of_its_own_is_the_same():
    """One pair, or a list of one pair, as in 3-D."""
    inlet = {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, MEAN], "profile": "parabolic"}
    inlet |= {"temperature_K": 300.0}
    for span in ([0.1, 0.4], [[0.1, 0.4]]):
        own = box_case((0.5, 0.5), 0.05, boundaries={"inlet": inlet | {"span_m": span}})
        assert inlet_profiles.extent(own, own.boundaries["inlet"]) == (0, 0.1, 0.4)
