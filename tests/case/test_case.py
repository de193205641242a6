"""case.toml: what loads, what is read back, and what is refused with one line that helps."""

import copy
import dataclasses
import math

import pytest
from builders import disc
from discs import TABLE, read_back, refusal
from hypothesis import given
from hypothesis import strategies as st

from sdph import scenes, schema
from sdph.case import gas_cells
from sdph.case import read as cases
from sdph.schema import CaseError

BOX = ("particles.disc.shape='box'", "particles.disc.lower_m=[0.1,0.1]", "particles.disc.upper_m=[0.3,0.3]")


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
        ("nozzles.any.rate=0.25", "did you mean nozzles.any.rate_kg_s?"),
        ("particles.disc.raduis_m=0.1", "did you mean particles.disc.radius_m?"),
        ("coupling.one_wey=true", "did you mean coupling.one_way?"),
        ("coupling.ranks=2", "did you mean coupling.gas_ranks?"),  # its name up to 0.1.0
        ("heat.closur='paper'", "did you mean heat.closure?"),
        ("grains.friction=0.5", "did you mean [friction] or grain_drag.friction or walls.friction?"),
        ("gas.wall_friction=0.5", "did you mean [friction]? known here: conductivity_W_m_K"),
        ("heat.mesh_scale=0.1", "did you mean walls.mesh_scale or tank.mesh_scale?"),
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
        (("domain.gravity_m_s2=-9.81",), ("domain.gravity_m_s2", "list of numbers in m/s2")),
        (("gas.viscosity_Pa_s='thin'",), ("gas.viscosity_Pa_s", "number in Pa s")),
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
        (("effects=[]", "drag.law='ergun'"), ("[drag], [heat]", "not among effects", "remove the section")),
        (("resolution.spacing_mm=150",), ("resolution.spacing_mm = 150", "larger than particles.disc")),
        (("particles.disc.centre_m=[0.45,0.25]",), ("particles.disc", "out of the domain")),
        (("particles.disc.shape='box'",), ("particles.disc.lower_m", "missing")),
        (("particles.disc.shape='outline'",), ("particles.disc.corners_m", "missing")),
        (
            ("particles.disc.shape='outline'", "particles.disc.corners_m=[[0,0],[0.1,0.1],[0.1,0],[0,0.1]]"),
            ("particles.disc.corners_m", "meets that from"),
        ),
        (("particles.disc.shape='outline'", "particles.disc.corners_m=[0,1,2]"), ("[[x, y], ...]", "3 at least")),
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


@pytest.mark.parametrize(("section", "key"), [("run", "end_time_s"), ("grains", "density_kg_m3"), ("domain", "size_m")])
def test_missing_key_is_named(section, key):
    table = copy.deepcopy(TABLE)
    del table[section][key]
    with pytest.raises(CaseError, match=rf"{section}\.{key} is missing"):
        cases.from_table(table)


@pytest.mark.parametrize("value", ["5e-324", "1e-16", "0.0"])
def test_windows_of_no_length_are_refused(value):
    """The number of windows would be no number, or one that no machine counts to."""
    assert "coupling.window_largest_s" in refusal(f"coupling.window_largest_s={value}")


def test_one_text_is_a_list_of_one():
    assert cases.from_table(TABLE | {"run": TABLE["run"] | {"metrics": "column"}}).run.metrics == ("column",)


@pytest.mark.parametrize("number", [0, -1])
def test_a_particle_that_no_run_has_is_not_followed(number):
    assert "begin at 1" in refusal(f"track.particles=[1, {number}]")
