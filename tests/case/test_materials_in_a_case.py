"""Several materials in a case: keys of [grains] hold for all, a material's own go before them, and every part names
one."""

import tomllib

import pytest
import tomli_w
from grain_boxes import table
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph import cli, effects
from sdph.case import read as cases
from sdph.schema import CaseError

KEYS = ("density_kg_m3", "diameter_mm", "heat_capacity_J_kg_K", "conductivity_W_m_K", "diameter_std_mm")
NAMES = ("sand", "char", "glass_1", "Kohle")
VALUES = st.fixed_dictionaries({
    "density_kg_m3": st.floats(100.0, 8000.0), "diameter_mm": st.floats(0.05, 2.0),
    "heat_capacity_J_kg_K": st.floats(100.0, 5000.0), "conductivity_W_m_K": st.floats(0.01, 400.0),
    "diameter_std_mm": st.just(0.0),
})  # fmt: skip
FIELDS = {
    "density_kg_m3": ("density", 1.0), "diameter_mm": ("diameter", 1e-3),
    "heat_capacity_J_kg_K": ("heat_capacity", 1.0), "conductivity_W_m_K": ("conductivity", 1.0),
    "diameter_std_mm": ("diameter_std", 1e-3),
}  # fmt: skip


def in_halves(grains, materials=("sand", "char"), effects=("granular_pressure",)):
    """The TOML table of a box whose left and right half are of these materials."""
    given = table(effects)
    halves = (("left", 0.0, materials[0]), ("right", 0.03, materials[1]))
    given["particles"] = {
        name: given["particles"]["bed"] | {"lower_m": [low, 0.0], "upper_m": [low + 0.03, 0.06]}
        | ({"material": material} if material else {})
        for name, low, material in halves
    }  # fmt: skip
    return given | {"grains": grains}


PLAIN = {"density_kg_m3": 2500.0, "diameter_mm": 0.3, "heat_capacity_J_kg_K": 900.0, "conductivity_W_m_K": 1.0}


@settings(max_examples=60, deadline=None)
@given(data=st.data(), common=VALUES, names=st.permutations(NAMES))
def test_own_keys_go_before_common_ones_and_a_case_reads_back(data, common, names):
    names = names[: data.draw(st.integers(1, 4))]
    own = {name: data.draw(VALUES) for name in names}
    kept = {name: data.draw(st.sets(st.sampled_from(KEYS))) for name in names}
    grains = common | {name: {key: own[name][key] for key in kept[name]} for name in names}
    used = (names[0], names[-1])
    case = cases.from_table(in_halves(grains, used))
    assert list(case.materials) == list(names) and case.mixed == (len(names) > 1)
    for name in names:
        for key, (field, unit) in FIELDS.items():
            expected = (own[name] if key in kept[name] else common)[key]
            assert getattr(case.materials[name], field) == expected * unit
    assert case.grains == case.materials[names[0]] and case.of(names[-1]) == case.materials[names[-1]]
    assert case.number(used[1]) == names.index(used[1])
    assert cases.from_table(tomllib.loads(cases.dumps(case))) == case


TWO = {"sand": {}, "char": {}}
USED = ("sand", "char")


@pytest.mark.parametrize(
    ("grains", "materials", "told"),
    [
        (PLAIN | TWO, ("sand", ""), "particles.right.material is missing; the case has several: sand, char"),
        (PLAIN | TWO, ("sand", "chra"), "particles.right.material: no material chra; did you mean char"),
        (PLAIN, ("sand", ""), "[grains] is one material without a name; leave it out, or name it: [grains.sand]"),
        ({"sand": PLAIN, "char": {"density_kg_m3": 1.0}}, USED, "grains.char.diameter_mm is missing"),
        (PLAIN | TWO | {"sand": {"restitution": 0.5}}, USED, "grains.sand.restitution is of all grains"),
        (PLAIN | TWO | {"sand": {"fluid": "water"}}, USED, "fluid is of droplets, which are of one material"),
        (PLAIN | TWO | {"sand": {"densty_kg_m3": 0.5}}, USED, "did you mean grains.sand.density_kg_m3"),
        (PLAIN | TWO | {"densty_kg_m3": 2.0}, USED, "unknown key grains.densty_kg_m3"),
        (PLAIN | {"diameter_mm": {}, "char": {}}, ("char", "char"), "grains.diameter_mm is a section"),
        (PLAIN | {"a b": {}, "char": {}}, ("char", "char"), "[grains.a b]: a material is a word"),
        (PLAIN | TWO | {"surface_tension_N_m": 0.07}, USED, "grains.surface_tension_N_m is of"),
        (PLAIN | TWO | {"sand": {"density_kg_m3": -1.0}}, USED, "grains.sand.density_kg_m3 = -1.0"),
    ],
)
def test_what_cannot_be_meant_is_refused_in_one_line(grains, materials, told, tmp_path, capsys):
    with pytest.raises(CaseError) as error:
        cases.from_table(in_halves(grains, materials))
    assert told in str(error.value) and "\n" not in str(error.value)
    (tmp_path / "case.toml").write_text(tomli_w.dumps(in_halves(grains, materials)))
    assert cli.main(["explain", str(tmp_path / "case.toml")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


RUN = {"end_time_s": 1.0, "output_interval_s": 1.0}
BOTH = PLAIN | {"sand": {}, "char": {"density_kg_m3": 900.0}}


@pytest.mark.parametrize(
    ("effects", "sections", "told"),
    [
        (("drag", "break_up"), {"break_up": {"liquid_viscosity_Pa_s": 1e-3}}, "effects holds break_up"),
        (("drag",), {"drag": {"filter": "igci"}}, "drag.filter goes by the speed"),
        (("drag", "turbulent_dispersion"), {}, "effects holds turbulent_dispersion"),
        (("drag",), {"run": RUN | {"metrics": ["column"]}}, "metrics holds column.*leave it out; .* gas_pressure_Pa"),
    ],
)  # fmt: skip
def test_what_knows_one_material_is_refused(effects, sections, told):
    grains = BOTH | ({"surface_tension_N_m": 0.07} if "break_up" in effects else {})
    with pytest.raises(CaseError, match=told):
        cases.from_table(in_halves(grains, effects=effects) | sections)


def test_drag_between_materials_needs_two():
    case = cases.from_table(in_halves(PLAIN, ("", ""), effects=("grain_drag",)))
    with pytest.raises(CaseError, match="the grains are of one"):
        effects.kernel_of(effects.REGISTRY["grain_drag"], case)
