"""Beds that begin so dense that they burst open are told of."""

import dataclasses
import math
import re

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.grains import friction
from sdph.study.explain import pressed, tables

SHALLOW = "particles.bed.upper_m=[0.5,0.05]"


def bed(*more):
    return cases.load(scenes.HERE / "bubbling_bed" / "case.toml", ("particles.bed.volume_fraction=0.6", *more))


def test_a_bed_whose_contacts_outweigh_it_is_told_of_with_what_would_be_calm():
    case = bed("friction.onset=0.55", SHALLOW)
    (line,) = pressed.warnings(case)
    pressure, weight, calm = (
        float(re.search(rf"{words} ([\d.e+]+)", line)[1]) for words in ("with", "and", "begin at")
    )
    assert pressure == pytest.approx(0.05 * 0.05**2 / 0.03**5, rel=0.01)  # Fr (a - onset)^2/(limit - a)^5
    assert weight == pytest.approx(0.6 * case.grains.density * 9.81 * 0.05, rel=0.01) and weight < pressure
    below, above = (
        friction.pressure(friction.kernel(case), a)[0] - 0.5 * weight * a / 0.6 for a in (calm - 6e-4, calm + 6e-4)
    )
    assert below < 0.0 < above  # half of the weight, to the digits that are told
    assert line in tables.warnings(case)
    assert not pressed.warnings(bed("friction.onset=0.55", SHALLOW, f"particles.bed.volume_fraction={calm:.4f}"))


@pytest.mark.parametrize(
    "more",
    [(SHALLOW,), ("friction.onset=0.55",), ("friction.onset=0.55", SHALLOW, "domain.gravity_m_s2=[0.0,0.0]")],
    ids=["below the onset", "deep", "without weight"],
)
def test_others_are_not(more):
    assert not pressed.warnings(bed(*more))


def test_what_lies_above_weighs_on_what_is_below():
    """Layers of one bed: the lowest bears all of them, and is held; the highest is not, and is one region of the
    line."""
    case = bed("friction.onset=0.55", SHALLOW)
    whole, layers = case.particles["bed"], {}
    for number in range(10):
        lower, upper = ((side[0], 0.05 * (number + n)) for n, side in enumerate((whole.lower, whole.upper)))
        layers[f"layer{number}"] = dataclasses.replace(whole, lower=lower, upper=upper)
    (line,) = pressed.warnings(dataclasses.replace(case, particles=layers))
    held = math.floor(0.5 / 0.05 - 5144.0 / (0.6 * case.grains.density * 9.81 * 0.05))  # layers that all above hold
    told = re.search(r"particles\.layer(\d)(?: \(and (\d) more regions\))? begins", line)
    assert int(told[1]) == held + 1 and int(told[2] or 0) == 10 - held - 2
