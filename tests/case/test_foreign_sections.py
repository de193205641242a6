"""Sections that do not belong to a case are refused in one line: what an outsider's mutated cases found."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around.outflow import leaving
from sdph.engine import state as particles
from sdph.schema import CaseError

REGION = (
    "particles.a.shape='box'", "particles.a.lower_m=[0,0]", "particles.a.upper_m=[0.1,0.1]",
    "particles.a.volume_fraction=0.6", "particles.a.temperature_K=288",
)  # fmt: skip


def load(scene, *more):
    return cases.load(scenes.HERE / scene / "case.toml", more)


@pytest.mark.parametrize("scene", ["sloshing_box", "dam_break", "poiseuille"])
def test_grains_in_a_case_without_them(scene):
    with pytest.raises(CaseError, match=r"particles\.a is given without \[grains\]"):
        load(scene, *REGION)


@pytest.mark.parametrize(
    "scene, pool, upper", [("taylor_green", "square", [127.0, 1.0]), ("poiseuille", "gap", [20.0, 1.0])]
)
def test_a_pool_beyond_its_period(scene, pool, upper):
    with pytest.raises(CaseError, match=rf"pools\.{pool} reaches from .* along x, which is periodic"):
        load(scene, f"pools.{pool}.upper_m={upper}")


@pytest.mark.parametrize("periodic, gone", [([], True), (["x"], False)])
def test_who_goes_round_has_not_left(periodic, gone):
    case = load("disc_cluster", f"domain.periodic={periodic}")
    state = particles.empty(1)
    state.x[0], state.y[0] = -1e-4, 0.05
    assert leaving(case, state)[0] == gone
