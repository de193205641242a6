"""Sheets of two nozzles: which one a drop is from, no copy of each other, and what is not told of them."""

import numpy as np
import pytest
from test_swirling_sheet import FILE, SHORT

from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.mps import pieces, sheet
from sdph.methods.mps.method import MpsStepper
from sdph.methods.mps.mps import Mps

ASIDE = 6e-3  # m, of the second nozzle from the first
OTHER = (
    'nozzles.other.shape="annulus"', f"nozzles.other.centre_m=[{0.01 + ASIDE}, 0.01, 0.0]",
    "nozzles.other.direction=[0.0, 0.0, 1.0]", "nozzles.other.inner_radius_m=1.3e-3", "nozzles.other.radius_m=1.5e-3",
    "nozzles.other.speed_m_s=20.0", "nozzles.other.swirl=1.0",
)  # fmt: skip


def case_of(*more):
    return cases.load(FILE, (*SHORT, *more))


def waiting(state, number: int) -> np.ndarray:
    """Places (n, 3) [m] of what waits in a nozzle, from 1."""
    return particles.positions(state)[state.nozzle == number]


def test_the_second_nozzle_is_no_copy_of_the_first_which_is_as_it_is_alone():
    alone, both = MpsStepper(case_of()).state, MpsStepper(case_of(*OTHER)).state
    first, second = waiting(both, 1), waiting(both, 2)
    np.testing.assert_array_equal(np.sort(waiting(alone, 1), axis=0), np.sort(first, axis=0))
    moved = second - [ASIDE, 0.0, 0.0]
    assert len(first) == len(second)
    assert np.abs(np.sort(first[:, 0]) - np.sort(moved[:, 0])).max() > 1e-6
    again = waiting(MpsStepper(case_of(*OTHER)).state, 2)
    np.testing.assert_array_equal(second, again)


@pytest.mark.parametrize(("numbers", "expected"), [
    ([2, 2, 1, 0], ["other"]), ([1, 1, 2, 0], ["mouth"]), ([0, 0, 0, 2], [""]),
])  # fmt: skip
def test_a_drop_is_of_the_nozzle_of_most_of_its_mass(numbers, expected):
    own = case_of(*OTHER)
    state = particles.empty(4, {"nozzle"}, 3)
    state.nozzle[:], state.mass[:] = numbers, 1.0
    assert [row["nozzle"] for row in pieces.of(state, np.zeros(4, int), own)] == expected
    state.mass[-1] = 10.0
    by_mass = pieces.of(state, np.zeros(4, int), own)[0]["nozzle"]
    assert by_mass == ("", "mouth", "other")[numbers[-1]]
    bare = particles.empty(2, set(), 3)
    bare.mass[:] = 1.0
    assert pieces.of(bare, np.zeros(2, int), own)[0]["nozzle"] == ""


def test_what_is_not_told_of_several_sheets_is_said():
    one, two = case_of(), case_of(*OTHER)
    assert sheet.untold(one) == []
    (line,) = sheet.untold(two)
    assert "there are 2 nozzles" in line and line in Mps(two, None, 0.0).warnings()
