"""The implicit solver of the embedded gas."""

import numpy as np
import pytest
from gas_cases import gas_case

from coupling.embedded import EmbeddedGas
from coupling.embedded.linear import solve_implicit

TOLERANCE = 1e-11


def solved(size: float):
    """Solution (S,) of a random equation of a 4 x 3 box whose right hand side is of a `size`, and its residual."""
    rng = np.random.default_rng(7)
    grid = EmbeddedGas(gas_case((0.04, 0.03), 4)).box.grid
    active, source, x = grid.zeros() > 0.0, grid.zeros(), grid.zeros()
    active[grid.cells] = True
    source[grid.cells] = size * rng.normal(size=len(grid.cells))
    conductance, diagonal = rng.uniform(0.1, 5.0, (2, grid.size)), np.ones(grid.size)
    _, error = solve_implicit(grid.wide, active, conductance, diagonal, source, x, TOLERANCE)
    return x, error


@pytest.mark.parametrize("size", [1e-100, 1e-160, 1e-250, 1e-285])
def test_a_field_that_died_away_is_solved_as_any_other(size):
    """Squares of such numbers are 0; a velocity gets there that every window washes out by a power of ten."""
    (usual, error), (small, same) = solved(1.0), solved(size)
    assert small / size == pytest.approx(usual, rel=1e-9, abs=1e-11) and np.abs(usual).max() > 0.1
    assert error < TOLERANCE and same < TOLERANCE


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-318])
def test_a_field_that_is_nothing_stays_so(size):
    x, error = solved(size)
    assert np.abs(x).max() <= 3.0 * size and error < TOLERANCE
