"""Warning of beds of few cells, whose drag is weak: by their height, or by the mass that fills a region."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import estimate


def column(*overrides):
    return cases.load(scenes.HERE / "fluidised_column" / "case.toml", overrides)


def warned(case) -> bool:
    return any(text.startswith("bed's height / cell") for text in estimate.warnings(case))


@pytest.mark.parametrize(("height", "shallow"), [(0.099, True), (0.101, False)])
def test_a_bed_below_ten_cells_is_told(height, shallow):
    case = column(f"particles.bed.upper_m=[0.03,{height}]")
    assert estimate.blown_height(case) == pytest.approx(height)
    assert warned(case) == shallow


def test_a_mass_fills_its_region_as_high_as_it_goes():
    mass = 0.05 * 0.03 * 0.61 * 3060.0  # kg per metre of depth: 5 cm of the 30
    case = column(f"particles.bed.mass_kg={mass}")
    assert estimate.blown_height(case) == pytest.approx(0.05)
    assert warned(case)


@pytest.mark.parametrize(
    "change", ["boundaries.distributor.velocity_m_s=[0.0,0.0]", "boundaries.distributor.velocity_m_s=[0.04,0.0]"]
)
def test_grains_that_no_gas_is_blown_into_from_below_are_no_bed(change):
    assert estimate.blown_height(column(change)) == 0.0
