"""Grains that hide each other as they radiate are told of after a run, by what is there in the end."""

import pytest
from builders import simulation

from sdph import scenes
from sdph.case import read as cases
from sdph.running import haze

SCENE = scenes.HERE / "radiating_grains" / "case.toml"


def started(tmp_path, alpha_p, *more):
    case = cases.load(SCENE, (f"particles.cloud.volume_fraction={alpha_p}", "resolution.spacing_mm=5", *more))
    return simulation(case, tmp_path)


def test_the_depth_is_that_of_the_mean_over_the_domain(tmp_path):
    """A quarter of 40 mm x 40 mm is full of them: 1.5 alpha_p/4/d over 40 mm."""
    found = haze.depth(started(tmp_path, 1e-2))
    assert found == pytest.approx(1.5 * 1e-2 / 4.0 / 0.285e-3 * 0.04, rel=1e-6)


@pytest.mark.parametrize(("alpha_p", "told"), [(1e-2, ""), (4e-2, "the optical depth of the grains across the domain")])
def test_thick_clouds_are_told_of(tmp_path, alpha_p, told):
    found = [text for text in started(tmp_path, alpha_p).warnings() if "optical depth" in text]
    assert len(found) == bool(told) and all(text.startswith(told) for text in found)


def test_sizes_count_by_their_surface(tmp_path):
    """Of a log-normal the Sauter mean is m (1 + v)^2, v = (std/m)^2."""
    wide = haze.depth(started(tmp_path, 1e-2, "grains.diameter_std_mm=0.1"))
    sauter = 0.285e-3 * (1.0 + (0.1 / 0.285) ** 2) ** 2
    assert wide == pytest.approx(1.5 * 1e-2 / 4.0 / sauter * 0.04, rel=5e-3)


def test_without_radiation_nothing_is_told(tmp_path):
    table = cases.parsed(SCENE) | {"effects": ["heat"], "heat": {"law": "gunn"}}
    table["particles"]["cloud"]["volume_fraction"] = 4e-2
    del table["radiation"]
    assert haze.warnings(simulation(cases.from_table(table), tmp_path)) == []
