"""Any case beside two fluids: what the checks see, what is refused, and a case of nobody's through OpenFOAM."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from coupling.openfoam import fields
from coupling.openfoam.comparators import known, two_fluid_numbers
from coupling.openfoam.comparators import run as comparators
from coupling.openfoam.comparators.start import Start
from coupling.openfoam.comparators.two_fluid_fields import start_fields
from coupling.openfoam.comparators.two_fluid_numbers import macros
from sdph import effects, scenes
from sdph.case import read as cases
from sdph.cli import main
from sdph.laws.friction import sticking_specularity
from sdph.schema import CaseError
from sdph.study import against, two_fluid

EFFECTS = ["drag", "gas_pressure", "gravity", "granular_pressure", "friction", "granular_temperature", "walls", "heat"]


def table(**more) -> dict:
    """A bed and a hot lump over it in a box that two inlets blow through."""
    inlet = {"kind": "velocity_inlet", "side": "bottom", "temperature_K": 300.0}
    return {
        "title": "nobody's", "dimensions": 2, "effects": EFFECTS,
        "run": {"end_time_s": 4e-3, "output_interval_s": 1e-3},
        "domain": {"size_m": [0.1, 0.2], "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": 5.0, "cell_mm": 10.0},
        "gas": {
            "equation_of_state": "constant", "density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5,
            "conductivity_W_m_K": 0.024, "heat_capacity_J_kg_K": 1006.0, "temperature_K": 300.0,
        },
        "grains": {
            "density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 840.0, "conductivity_W_m_K": 1.0,
        },
        "particles": {
            "bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.1, 0.06], "volume_fraction": 0.55},
            "lump": {
                "shape": "disc", "centre_m": [0.05, 0.12], "radius_m": 0.02, "volume_fraction": 0.3,
                "temperature_K": 400.0, "velocity_m_s": [0.0, -0.5],
            },
        },
        "boundaries": {
            "spout": inlet | {"span_m": [0.04, 0.06], "velocity_m_s": [0.0, 2.0]},
            "floor": inlet | {"velocity_m_s": [0.0, 0.2]},
            "outlet": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 50.0},
            "left": {"kind": "slip_wall", "side": "left"},
            "walls": {"kind": "wall"},
        },
    } | more  # fmt: skip


def case(**more):
    for region in (own := table(**more))["particles"].values():
        region.setdefault("temperature_K", 300.0)
    return cases.from_table(own)


@pytest.fixture
def sides():
    """Two sides alike: a bed of 0.5 in the lower half of four by eight cells, three times."""
    x, y = np.meshgrid(0.0125 + 0.025 * np.arange(4), 0.0125 + 0.025 * np.arange(8))
    centres = np.column_stack((x.ravel(), y.ravel()))
    alpha_p = np.tile(np.where(centres[:, 1] < 0.1, 0.5, 0.0), (3, 1))
    pressure = np.tile(1000.0 - 5000.0 * centres[:, 1], (3, 1))
    own = two_fluid.Cells(centres, np.full(32, 6.25e-4), alpha_p, pressure, np.array([0.0, 1.0, 2.0]))
    return own, own


def failed(own, other) -> set[str]:
    return {row["name"].split()[0] for row in two_fluid.checks(case(), [1, 2], own, other) if not row["ok"]}


def test_two_sides_alike_agree(sides):
    assert failed(*sides) == set()


@pytest.mark.parametrize(
    ("field", "change", "seen"),
    [
        ("alpha_p", lambda a: 1.02 * a, {"mass"}),
        ("alpha_p", lambda a: np.roll(a, 4, axis=1), {"middle", "grains"}),
        ("pressure", lambda p: 1.12 * p, {"pressure"}),
        ("warmth", lambda t: 1.12 * t, {"grains"}),
    ],
)
def test_what_differs_is_seen(sides, field, change, seen):
    own, other = sides
    assert failed(own._replace(**{field: change(getattr(own, field))}), other) == seen


def test_the_first_half_counts_for_nothing(sides):
    own, other = sides
    first = own.alpha_p * np.array([3.0, 1.0, 1.0])[:, None]
    assert failed(own._replace(alpha_p=first), other) == set()


def test_heights_and_pressures_are_those_along_gravity(sides):
    told = {row["name"].split()[0]: row["value"] for row in two_fluid.checks(case(), [1, 2], *sides)}
    assert told["middle"] == pytest.approx(0.5 * (0.0125 + 0.0875) - 0.0125)
    assert told["pressure"] == pytest.approx(5000.0 * 0.175)


def test_every_boundary_says_what_it_asks():
    own = start_fields(case())
    assert "left { type slip; }" in own["U.particles"] and "left { type slip; }" in own["U.gas"]
    assert "walls { type fixedValue; value uniform (0.0 0.0 0.0); }" in own["U.particles"]
    assert "p uniform 101375.0" in own["p_rgh"] and "frontAndBack { type empty; }" in own["p"]
    assert "value uniform (0.0 2.0 0.0)" in own["U.gas"] and "outlet { type noSlip; }" in own["U.particles"]
    leaves = start_fields(case(effects=[*EFFECTS, "outflow"]))
    assert "outlet { type zeroGradient; }" in leaves["U.particles"]
    rough = start_fields(case(walls={"specularity": 0.3}))
    assert "walls { type JohnsonJacksonParticleSlip; specularityCoefficient 0.3;" in rough["U.particles"]
    rubbed = case(walls={"friction": 0.1})
    sticking = sticking_specularity(0.1, rubbed.grains.restitution)
    assert f"specularityCoefficient {sticking!r};" in start_fields(rubbed)["U.particles"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"drag": {"law": "beetstra"}}, "drag.law = 'beetstra'; the two-fluid reference has: gidaspow"),
        ({"gas": table()["gas"] | {"turbulence": {"model": "WALE"}}}, "the two-fluid reference is laminar"),
        ({"effects": [*EFFECTS, "lift"]}, "effects holds lift; the two-fluid reference has none"),
        ({"effects": [*EFFECTS, "wall_heat"]}, "effects holds wall_heat; the two-fluid reference has none"),
        ({"coupling": {"film": True}}, "coupling.film = true; the two-fluid reference"),
        ({"walls": {"mesh": "funnel.stl"}}, "walls.mesh holds grains where the gas has no patch"),
    ],
)
def test_what_two_fluids_lack_is_said(change, said):
    with pytest.raises(CaseError, match=said):
        macros(case(**change))


def test_all_that_they_lack_is_said_at_once_and_explain_says_it_too():
    own = case(coupling={"film": True}, effects=[*EFFECTS, "lift"], gas=table()["gas"] | {"equation_of_state": "ideal"})
    with pytest.raises(CaseError, match=r"equation_of_state.*;  coupling\.film.*;  effects holds lift"):
        macros(own)
    rows = {row["compare --against"]: row for row in against.offered(own)}
    assert rows["tfm"]["possible"] == "no" and "effects holds lift" in rows["tfm"]["lacks"]
    assert {row["compare --against"]: row["possible"] for row in against.offered(case())} == {"tfm": "yes"}


def test_a_bed_of_one_temperature_is_not_judged_by_the_heat_of_its_motion(sides):
    alike = case(particles={"bed": table()["particles"]["bed"]})
    names = [[row["name"] for row in two_fluid.checks(own, [1, 2], *sides)] for own in (case(), alike)]
    assert set(names[0]) - set(names[1]) == {"grains warmer than at the start, mean [K]"}


def test_walls_that_are_the_patches_of_the_gas_are_known():
    """As a run of a vessel writes them into its case.toml."""
    assert macros(case(walls={"mesh": "patches.vtk", "source": "gas"})) == macros(case())


def test_what_nobody_looked_at_is_refused():
    own = case()
    for name in (*effects.REGISTRY, "new"):
        asked = dataclasses.replace(own, effects=(*own.effects, name))
        if name in two_fluid_numbers.KNOWN:
            assert not known.lacks(asked, two_fluid_numbers.KNOWN, "it")
            continue
        (lacking,) = known.lacks(asked, two_fluid_numbers.KNOWN, "it")
        assert lacking.startswith(f"effects holds {name}; it has none")


@pytest.mark.parametrize(
    "scene",
    [
        "bed_with_tube", "bubbling_bed", "bubbling_bed_3d", "cylindrical_bed", "disc_cluster", "fluidised_column",
        "granular_jet", "tapered_bed",
    ],
)  # fmt: skip
def test_scenes_that_have_two_fluids_are_not_refused(scene):
    assert macros(cases.load(scenes.find(scene)[1]))["packing_margin"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"effects": [n for n in EFFECTS if n not in ("drag", "gas_pressure")]}, "effects without drag"),
        ({"effects": [n for n in EFFECTS if n != "gravity"]}, "gravity in domain, none in effects"),
        ({"grains": table()["grains"] | {"diameter_std_mm": 0.1}}, "grains.diameter_std_mm above 0"),
        ({"coupling": {"one_way": True}}, "coupling.one_way = true"),
        ({"coupling": {"voidage": False}}, "coupling.voidage = false"),
    ],
)
def test_what_the_shared_template_would_run_otherwise_is_refused(change, said):
    with pytest.raises(CaseError, match=f"^{said}: the two-fluid reference"):
        start_fields(case(**change))


@pytest.mark.openfoam
def test_a_column_without_heat_runs_as_two_fluids(tmp_path, monkeypatch):
    monkeypatch.setattr(comparators, "shelf", lambda: tmp_path / "references")
    own = case(effects=[name for name in EFFECTS if name != "heat"])
    centres = np.stack(np.meshgrid(0.005 + 0.01 * np.arange(10), 0.005 + 0.01 * np.arange(20)), axis=-1).reshape(-1, 2)
    bed = np.where(centres[:, 1] < 0.06, 0.55, 0.0)
    start = Start(centres, bed, np.zeros((200, 3)), np.full(200, 300.0))
    run = comparators.run_two_fluid(own, tmp_path / "run", start=start)
    assert run.fields[max(run.fields)]["alpha_p"] @ run.volumes == pytest.approx(bed.sum() * 1e-4, rel=1e-6)
    half = dataclasses.replace(start, alpha_p=0.5 * bed)
    run = comparators.run_two_fluid(own, tmp_path / "half", start=half)  # not the kept one of the other start
    assert run.fields[max(run.fields)]["alpha_p"] @ run.volumes == pytest.approx(0.5 * bed.sum() * 1e-4, rel=1e-6)


def test_places_take_what_the_nearest_cell_has():
    centres = np.array([[0.0, 0.0], [1.0, 0.0]])
    start = Start(centres, np.array([0.1, 0.2]), np.eye(3)[:2], np.array([300.0, 400.0]))
    own = start.at(np.array([[0.9, 0.1], [0.2, -0.1]]))
    assert own.alpha_p.tolist() == [0.2, 0.1] and own.temperature.tolist() == [400.0, 300.0]
    assert own.velocity.tolist() == [[0, 1, 0], [1, 0, 0]]
    assert start.digest != dataclasses.replace(start, temperature=start.temperature + 1.0).digest


@pytest.mark.openfoam
def test_a_case_of_nobodys_runs_beside_two_fluids(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(comparators, "shelf", lambda: tmp_path / "references")
    (tmp_path / "case.toml").write_text(cases.dumps(case()), encoding="utf-8")
    folder = tmp_path / "run"
    assert main(["run", str(tmp_path / "case.toml"), "--gas", "embedded", "--out", str(folder)]) == 0
    capsys.readouterr()
    assert main(["compare", str(folder), "--against", "tfm"]) in (0, 1)
    said = capsys.readouterr().out
    for name in ("mass of the grains", "middle of the grains"):
        assert next(line for line in said.splitlines() if line.startswith(name)).endswith("ok")
    assert (folder / two_fluid.PICTURE).stat().st_size > 10_000
    begun = {name: fields.read(folder / "tfm/0" / name, 200) for name in ("C", "T.particles", "alpha.particles")}
    lump = np.hypot(begun["C"][:, 0] - 0.05, begun["C"][:, 1] - 0.12) < 0.01
    bed = begun["C"][:, 1] < 0.04
    assert np.all(begun["T.particles"][lump] == 400.0) and np.all(begun["T.particles"][bed] == 300.0)
    assert begun["alpha.particles"][lump] == pytest.approx(0.3, abs=0.02)
    assert begun["alpha.particles"][bed] == pytest.approx(0.55, abs=0.03)


def test_what_two_fluids_lack_is_said_before_a_run_is_read():
    """Grains that come by a nozzle: there are none at the start, which nothing may trip over."""
    run = SimpleNamespace(case=case(effects=[*EFFECTS, "lift"]), folder=None, fields=lambda t: SimpleNamespace(gas=1))
    with pytest.raises(CaseError, match="effects holds lift"):
        two_fluid.tfm(run)


@pytest.mark.openfoam
def test_a_run_without_a_gas_is_refused(tmp_path, capsys):
    folder = tmp_path / "run"
    assert main(["run", "taylor_green", "--set", "run.end_time_s=0.01", "--out", str(folder)]) == 0
    assert main(["compare", str(folder), "--against", "tfm"]) == 2
    assert "has no such reference" in capsys.readouterr().err
