"""Vapour that was refused to condense is told of, where it is more than a hundredth of what evaporated."""

import types

import pytest

from sdph.exchange import vapour


@pytest.mark.parametrize(
    ("evaporated", "refused", "told"),
    [
        (1.0, 0.02, "condensation_refused_kg = 0.02, 2% of what evaporated"),
        (1.0, 0.0099, ""),
        (0.0, 0.02, "condensation_refused_kg = 0.02, while nothing evaporated"),
        (0.0, 4e-6, ""),  # of 5 kg of droplets
    ],
)
def test_refused_condensation_is_told(evaporated, refused, told):
    sums = {"evaporated_kg": evaporated, "condensation_refused_kg": refused, "injected_kg": 2.0}
    found = vapour.refusals(types.SimpleNamespace(sums=sums, first={"particle_mass_kg": 3.0}))
    assert len(found) == bool(told) and all(line.startswith(told) for line in found)


def test_without_evaporation_nothing_is_told():
    sums = {"evaporated_kg": 0.0, "injected_kg": 0.0}
    assert not vapour.refusals(types.SimpleNamespace(sums=sums, first={"particle_mass_kg": 0.0}))
