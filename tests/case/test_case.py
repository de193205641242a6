"""case.toml: what loads, what is read back, and what is refused with one line that helps."""

import copy
import dataclasses
import math
import tomllib

import pytest
from builders import DISC, disc
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph import effects, scenes, schema
from sdph.case import gas_cells, sections
from sdph.case import read as cases
from sdph.methods.liquids.sections import GasPhase, Liquid
from sdph.methods.solids.sections import Solid
from sdph.schema import CaseError

TABLE = tomllib.loads(DISC.read_text(encoding="utf-8"))
BOX = ("particles.disc.shape='box'", "particles.disc.lower_m=[0.1,0.1]", "particles.disc.upper_m=[0.3,0.3]")


def refusal(*overrides) -> str:
    """The message with which the disc is refused under overrides."""
    with pytest.raises(CaseError) as caught:
        disc(*overrides)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    return message


def read_back(case):
    return cases.from_table(tomllib.loads(cases.dumps(case)))


@pytest.mark.parametrize("name", scenes.names())
def test_scene_loads_and_reads_back(name):
    case = cases.load(scenes.HERE / name / "case.toml")
    assert case.title == scenes.title(name)
    assert read_back(case) == case


def test_disc_in_si():
    case = disc()
    assert case.resolution.spacing == pytest.approx(2.5e-3, rel=1e-15)
    assert case.smoothing_length == pytest.approx(3.75e-3, rel=1e-15)
    assert case.grains.diameter == pytest.approx(285e-6, rel=1e-15)
    assert (case.gas.viscosity, case.domain.size, case.dimensions) == (1.7895e-5, (0.5, 0.5), 2)
    assert case.parameters["heat"].closure == "geometric"
    assert gas_cells.cells(case) == (100, 100)


def test_case_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        disc().resolution.spacing = 1.0


positive = st.floats(1e-12, 1e12)


@given(spacing=st.floats(1e-6, 90.0), diameter=positive, tolerance=positive, times=st.lists(positive, max_size=3))
def test_reads_back_to_the_last_bit(spacing, diameter, tolerance, times):
    overrides = (
        f"resolution.spacing_mm={spacing!r}",
        f"grains.diameter_mm={diameter!r}",
        f"coupling.window_tolerance={tolerance!r}",
        f"run.report_at_s={times!r}",
    )
    case = disc(*overrides)
    assert read_back(case) == case


@given(value=st.floats(allow_nan=False, allow_infinity=False, width=64), unit=st.sampled_from(sorted(schema.UNITS)))
def test_every_unit_reads_back(value, unit):
    record = schema.record(type("Section", (), {"__annotations__": {"size": float}, "size": schema.quantity(unit)}))
    key = f"size_{unit}" if unit else "size"
    first = schema.read(record, {key: value}, "section")
    assert schema.read(record, schema.write(first), "section") == first


def test_default_is_in_the_unit_of_its_key():
    record = schema.record(
        type("Section", (), {"__annotations__": {"angle": float}, "angle": schema.quantity("deg", 30.0, most=60.0)})
    )
    assert schema.read(record, {}, "section") == schema.read(record, {"angle_deg": 30.0}, "section")
    assert schema.read(record, {}, "section").angle == pytest.approx(math.pi / 6.0, rel=1e-15)


def test_optional_sections_read_back():
    vapour = (
        "{molar_mass_kg_kmol=142.3, diffusivity_m2_s=3.8e-6, heat_capacity_J_kg_K=2e3, conductivity_W_m_K=0.018, "
        "viscosity_Pa_s=7e-6}"
    )
    case = disc(
        f"vapour={vapour}",
        "track.particles=[645, 1050]",
        "boundaries.inlet.kind='velocity_inlet'",
        "boundaries.inlet.velocity_m_s=[0,1]",
    )
    assert case.vapour.molar_mass == 142.3
    assert case.track == (645, 1050)
    assert read_back(case) == case


@pytest.mark.parametrize(
    ("override", "named"),
    [
        ("resolution.spacing_cm=0.25", "did you mean resolution.spacing_mm?"),
        ("resolution.spaceing_mm=2.5", "did you mean resolution.spacing_mm?"),
        ("particles.disc.raduis_m=0.1", "did you mean particles.disc.radius_m?"),
        ("coupling.one_wey=true", "did you mean coupling.one_way?"),
        ("coupling.ranks=2", "did you mean coupling.gas_ranks?"),  # its name up to 0.1.0
        ("heat.closur='paper'", "did you mean heat.closure?"),
        ("granis.density_kg_m3=1", "did you mean grains?"),
    ],
)
def test_unknown_key_names_the_nearest(override, named):
    message = refusal(override)
    assert override.partition("=")[0].split(".")[0] in message
    assert named in message


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (("scene='disc_clutser'",), ("scene = disc_clutser", "did you mean disc_cluster?")),
        (("gas.density_kg_m3=-1.2",), ("gas.density_kg_m3", "-1.2", "above 0")),
        (("grains.diameter_std_mm=-0.1",), ("grains.diameter_std_mm", "at least 0")),
        (("particles.disc.volume_fraction=1.5",), ("particles.disc.volume_fraction", "at most 1")),
        (("run.end_time_s=nan",), ("run.end_time_s", "nan", "finite")),
        (("run.end_time_s=inf",), ("run.end_time_s", "inf", "finite")),
        (("domain.size_m=[0.5,nan]",), ("domain.size_m", "nan", "finite")),
        ((f"resolution.spacing_mm=1{'0' * 400}",), ("resolution.spacing_mm", "finite")),
        (("grains.density_kg_m3='3060 kg/m3'",), ("grains.density_kg_m3", "3060 kg/m3", "without the unit")),
        (("grains.density_kg_m3=true",), ("grains.density_kg_m3", "number")),
        (("coupling.gas_ranks=1.5",), ("coupling.gas_ranks", "whole number")),
        (("coupling.gas_ranks=0",), ("coupling.gas_ranks", "at least 1")),
        (("coupling.one_way='yes'",), ("coupling.one_way", "true or false")),
        (("coupling.transport='pigeon'",), ("coupling.transport", "pigeon", "socket, file")),
        (("domain.size_m=0.5",), ("domain.size_m", "list of numbers in m")),
        (("domain.size_m=[0.5]",), ("domain.size_m", "1 components", "2")),
        (("domain.gravity_m_s2=[]",), ("domain.gravity_m_s2", "0 components", "2")),
        (("probes.centre.at_m=[0.1,0.1,0.1]",), ("probes.centre.at_m", "3 components", "2")),
        (("probes.centre.at_m=[0.1,0.7]",), ("probes.centre", "out of the domain")),
        (("probes.centre.fields=['colour']",), ("probes.centre.fields holds 'colour'", "alpha_p, density, diameter")),
        (("probes.centre.fields=['theta']",), ("probes.centre.fields holds 'theta'", "in this case there are")),
        (("domain.size_m=[0.5,0.0]",), ("domain.size_m", "above 0")),
        (("resolution.stretch=[1.0,1e9]",), ("resolution.stretch", "from 0.01 to 100")),
        (("run.output_interval_s=1e-12",), ("run.output_interval_s = 1e-12", "outputs; 1e+05 are allowed")),
        (("dimensions=4",), ("dimensions", "2 or 3")),
        (("dimensions=2.0",), ("dimensions", "2 or 3")),
        (("track.particles=[1.5]",), ("track.particles", "1.5", "whole numbers")),
        (("track.particles='all'",), ("track.particles", "all", "list of numbers")),
        (("run.report_at_s=[-0.1]",), ("run.report_at_s", "above 0")),
        (("effects=['heat','conduction','levitation']",), ("levitation", "heat")),
        (("effects=['heat','heat']",), ("effects", "once")),
        (("effects='heat'",), ("effects", "list")),
        (("effects=['conduction']",), ("[heat]", "not among effects", "remove the section")),
        (("resolution.spacing_mm=150",), ("resolution.spacing_mm = 150", "larger than particles.disc")),
        (("particles.disc.centre_m=[0.45,0.25]",), ("particles.disc", "out of the domain")),
        (("particles.disc.shape='box'",), ("particles.disc.lower_m", "missing")),
        ((*BOX, "particles.disc.upper_m=[0.05,0.3]"), ("particles.disc", "upper_m", "above lower_m")),
        ((*BOX, "particles.disc.lower_m=[[0.1,0.1]]"), ("particles.disc.lower_m", "components")),
        (("particles.disc=3",), ("[particles]", "named sections")),
        (("gas=3",), ("gas", "section")),
        (("title.x=1",), ("title", "not a section")),
        (("run.end_time_s",), ("--set run.end_time_s", "section.key=value")),
    ],
)
def test_bad_value_is_refused_by_name(overrides, told):
    message = refusal(*overrides)
    for part in told:
        assert part in message


RECORDS = (
    sections.SECTIONS
    | sections.GROUPS
    | {
        "coupling": sections.Coupling,
        "vapour": sections.Vapour,
        "liquid": Liquid,
        "gas_phase": GasPhase,
        "solid": Solid,
    }
)
RECORDS |= {name: row.parameters for name, row in effects.REGISTRY.items()}
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


def test_a_byte_order_mark_is_no_error(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + DISC.read_bytes())
    assert cases.load(file) == disc()


@pytest.mark.parametrize(("section", "key"), [("run", "end_time_s"), ("grains", "density_kg_m3"), ("domain", "size_m")])
def test_missing_key_is_named(section, key):
    table = copy.deepcopy(TABLE)
    del table[section][key]
    with pytest.raises(CaseError, match=rf"{section}\.{key} is missing"):
        cases.from_table(table)


@pytest.mark.parametrize("text", ["title = ", "a = [1,\n", b"\xff\xfe", f"a = {'9' * 5000}", "a = " + "[" * 3000])
def test_file_that_is_not_toml(tmp_path, text):
    file = tmp_path / "case.toml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(CaseError, match="is not TOML"):
        cases.load(file)


@pytest.mark.parametrize("value", ["5e-324", "1e-16", "0.0"])
def test_windows_of_no_length_are_refused(value):
    """The number of windows would be no number, or one that no machine counts to."""
    assert "coupling.window_largest_s" in refusal(f"coupling.window_largest_s={value}")


@pytest.mark.parametrize(
    "text", ["a." * 20000 + "b = 1\n", "[" + "'a'. " * 20000 + "b]\n", "x = {" + "a." * 20000 + "b = 1}\n"]
)
def test_key_of_very_many_parts_is_refused_at_once(tmp_path, text):
    """The time of the parser goes with the square of the parts: minutes for these."""
    (tmp_path / "case.toml").write_text(text)
    with pytest.raises(CaseError, match="a key there has 50 parts or more"):
        cases.load(tmp_path / "case.toml")


def test_file_of_gigabytes_is_refused_before_it_is_read(tmp_path):
    with open(tmp_path / "case.toml", "wb") as file:
        file.truncate(3 * 2**30)
    with pytest.raises(CaseError, match="too large for a case: at most 1048576 letters"):
        cases.load(tmp_path / "case.toml")


def paths(table, here=()):
    """Where every value of a nested table is."""
    for key, value in table.items():
        yield (*here, key)
        if isinstance(value, dict):
            yield from paths(value, (*here, key))


anything = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.integers(10**308, 10**310)
    | st.floats()
    | st.text(max_size=6)
    | st.sampled_from(["box", "ideal"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["kind", "at_m", "x"]), inner, max_size=2)
    ),
    max_leaves=4,
)
# TOML has no null; a None stands for "take it away"
changes = st.lists(st.tuples(st.sampled_from(sorted(paths(TABLE))), anything, st.booleans()), min_size=1, max_size=3)


def mutate(table, path, value, rename):
    for key in path[:-1]:
        if not isinstance(table.get(key), dict):
            return
        table = table[key]
    if rename and path[-1] in table:
        table[path[-1] + "x"] = table.pop(path[-1])
    elif value is None:
        table.pop(path[-1], None)
    else:
        table[path[-1]] = value


@settings(max_examples=200)
@given(changes=changes)
def test_mutated_case_loads_or_is_refused(changes):
    """Nothing but `CaseError`, and what does load can be read back and fills the box with particles or gas cells."""
    table = copy.deepcopy(TABLE)
    for change in changes:
        mutate(table, *change)
    try:
        case = cases.from_table(table)
    except CaseError as error:
        assert str(error).strip()
        return
    assert read_back(case) == case
    assert len(gas_cells.cells(case)) == case.dimensions
