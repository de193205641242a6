"""Cells of the gas: edges that widen by one factor, and layers that ten written digits do not split."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coupling.gas import Mesh
from sdph.case.gas_cells import CellRows, graded_edges, layers, nearest_edge, round_off
from sdph.schema import CaseError


@given(length=st.floats(1e-3, 1e2), count=st.integers(1, 200), stretch=st.floats(1e-2, 1e2))
def test_widths_grow_by_one_factor(length, count, stretch):
    edges = graded_edges(length, count, stretch)
    widths = np.diff(edges)
    assert edges[0] == 0.0 and edges[-1] == pytest.approx(length, rel=1e-14) and len(widths) == count
    assert np.allclose(widths[1:] * widths[0], widths[:-1] * widths[1:2], rtol=1e-9)
    if count > 1:
        assert widths[-1] / widths[0] == pytest.approx(stretch, rel=1e-9)


def test_an_edge_is_found_and_a_place_between_two_is_refused():
    edges = graded_edges(1.0, 4, 8.0)
    assert [nearest_edge(edges, edge, "span_m") for edge in edges] == [0, 1, 2, 3, 4]
    with pytest.raises(CaseError, match="span_m ends at 0.5, which is no edge of a gas cell"):
        nearest_edge(edges, 0.5, "span_m")


@given(digits=st.integers(10, 16), count=st.integers(2, 100), stretch=st.floats(0.1, 10.0))
def test_layers_are_those_of_the_cells(digits, count, stretch):
    edges = graded_edges(1.0, count, stretch)
    centres = np.tile(0.5 * (edges[1:] + edges[:-1]), 3) + np.repeat([-4e-11, 0.0, 4e-11], count)
    written = np.array([float(f"{c:.{digits}g}") for c in centres])
    assert (layers(written, round_off(written[:, None])) == np.tile(np.arange(count), 3)).all()


def test_rows_of_a_stretched_column():
    """What falls straight falls by the right amount between floor and top, whatever the heights of the rows."""
    edges = graded_edges(0.8, 12, 5.0)
    x, y = np.meshgrid([0.1, 0.3, 0.5], 0.5 * (edges[1:] + edges[:-1]))
    volumes = 0.2 * np.repeat(np.diff(edges), 3)
    rows = CellRows(Mesh(np.stack((x.ravel(), y.ravel(), 0 * x.ravel()), axis=1), volumes, 2), (0.0, 1.0, 0.0))
    assert rows.height == pytest.approx(np.diff(edges), rel=1e-12)
    assert rows.at_ends(rows.mean(5.0 - 3.0 * y.ravel())) == pytest.approx((5.0, 5.0 - 3.0 * 0.8), rel=1e-12)
