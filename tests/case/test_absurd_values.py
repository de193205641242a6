"""Quantities of a case: each has bounds, and what lies beyond is refused by name."""

import dataclasses

import pytest
from discs import refusal

from sdph import effects, schema
from sdph.case import matter, sections
from sdph.methods.liquids.sections import GasPhase, Liquid
from sdph.methods.solids.sections import Solid
from sdph.schema import CaseError

RECORDS = (
    sections.SECTIONS
    | sections.GROUPS
    | {
        "coupling": sections.Coupling,
        "vapour": sections.Vapour,
        "gas.turbulence": matter.Turbulence,
        "liquid": Liquid,
        "gas_phase": GasPhase,
        "solid": Solid,
    }
    | {name: row.parameters for name, row in effects.REGISTRY.items()}
)
QUANTITIES = [
    (cls, key, *found)
    for cls in RECORDS.values()
    for key, found in schema.fields(cls).items()
    if not found[1].choices and found[1].of is None
]


def holding(cls, name, value):
    """A record that has this value, and nothing else."""
    made = object.__new__(cls)
    for field in dataclasses.fields(cls):
        object.__setattr__(made, field.name, value if field.name == name else None)
    return made


@pytest.mark.parametrize(
    ("cls", "key", "name", "kind"), QUANTITIES, ids=[f"{cls.__name__}.{key}" for cls, key, *_ in QUANTITIES]
)
def test_no_quantity_may_be_absurd(cls, key, name, kind):
    """1e31 of anything, and 1e-31 of what must be above 0: not of times, which may be as short as one likes, nor of
    what stands for 0."""
    for value in (1e31, -1e31) if kind.components == 0 else ((1e31, 0.0), ((0.0, -1e31),)):
        with pytest.raises(CaseError, match=rf"section.{key} = .*e\+\d\d; what makes sense here"):
            schema.plausible(holding(cls, name, value), "section")
    if kind.above == 0.0 and kind.unit not in ("s", "ms", "us") and not kind.tiny:
        with pytest.raises(CaseError, match=f"section.{key} = .*e-.*makes sense here is from"):
            schema.plausible(holding(cls, name, 1e-31), "section")
    # round-off of who computed it
    schema.plausible(holding(cls, name, (0.0, 1e-300) if kind.components is None else 1.0), "section")


def test_every_unit_has_bounds():
    for unit in schema.UNITS:
        least, most, _ = schema.PLAUSIBLE[schema.SAME_AS.get(unit, unit)]
        assert 0.0 <= least < 1.0 < most


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("title=5", "title = 5; it must be a text"),
        ("title=['a']", "title = ['a']; it must be a text"),
        ("scene=true", "scene = True; it must be a text"),
        (
            "grains.density_kg_m3=1e30",
            "grains.density_kg_m3 = 1e+30; what makes sense here is from 1e-20 to 1e+06 kg m3",
        ),
        ("grains.diameter_mm=1e-30", "grains.diameter_mm = 1e-30; what makes sense here is from 1e-13 to 1e+13 mm"),
        ("gas.temperature_K=1e12", "gas.temperature_K = 1e+12"),
        ("domain.gravity_m_s2=[0,-1e20]", "domain.gravity_m_s2 = -1e+20"),
        ("run.step_factor=1e9", "run.step_factor = 1000000000.0; it must be at least 1e-06 and at most 1000"),
    ],
)
def test_absurd_values_are_refused_by_name(override, told):
    assert told in refusal(override)
