"""Grains in a vessel of triangles that is shaken by half its radius at 5 Hz: 1e4 sub-steps, and none gets out."""

import pytest

from sdph.study import validate

FEW = 250  # particles: nine spacings across, every third of them at the wall; 1e4 of them take ten minutes


@pytest.mark.parametrize("shape", ["cylinder", "cone"])
def test_no_grain_is_lost_from_a_vessel_that_is_shaken(tmp_path, shape):
    leaks = validate.part("own_vessel", "leaks")
    found = leaks.shaken(tmp_path, {"cylinder": leaks.RADIUS, "cone": leaks.WIDER}[shape], FEW, 10000)
    assert found.lost == 0 and found.steps >= 10000 and found.particles > 0.8 * FEW
    assert found.nearest > 0.1 and found.fastest > 1.0  # it is thrown about, by up to 1.6 m/s
