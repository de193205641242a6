"""Loops of grains that `benchmarks/cuda_kernels.py` has compiled for a device are all heard, without one too."""

from scripts import script

from sdph.engine.gpu import assembled


def test_loops_of_grains_in_a_window_are_heard():
    kernels = script("cuda_kernels", "benchmarks")
    loops = kernels.loops_of("bubbling_bed", "resolution.spacing_mm=25", "resolution.cell_mm=50")
    expected = "rates shear constitutive sum_density kick warm contact _gather deposit shares"
    assert set(expected.split()) <= {assembled.name_of(loop).split(".")[-1] for loop, _ in loops}
