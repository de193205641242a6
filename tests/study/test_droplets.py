"""Any spray beside OpenFOAM's droplets: what the checks see, what is refused, a case of nobody's through OpenFOAM."""

import dataclasses
import shutil
from math import cos, pi, sin

import numpy as np
import pytest
import pyvista
import tomli_w

from coupling.gas import GasError
from coupling.openfoam import poly_mesh
from coupling.openfoam.comparators import droplet_cloud
from coupling.openfoam.comparators import run as comparators
from coupling.openfoam.comparators.droplet_sources import Drops
from coupling.openfoam.comparators.reference import Reference
from coupling.openfoam.programs import barrier
from coupling.openfoam.programs import run as programs
from sdph.case import read as cases
from sdph.cli import main
from sdph.study import droplets
from sdph.study.droplets import Air, Side, Way
from tests.coupling.openfoam.own_meshes import turned_box
from tests.coupling.openfoam.spray_cases import case, table
from tests.study.test_two_fluid_in_vessels import CONTROL

WAY = Way(np.array([1.0, 0.0]), np.zeros(2))


@pytest.fixture
def shelf(tmp_path, monkeypatch):
    monkeypatch.setattr(comparators, "shelf", lambda: tmp_path / "references")


def air(**more) -> Air:
    """A hundred droplets in a row, the last of them the coldest, in two cells."""
    x = np.linspace(0.0, 1.0, 100)
    gas = {"temperature": np.array([340.0, 370.0]), "vapour_mass_fraction": np.array([0.01, 0.0])}
    whole = Air(np.stack([x, x], 1), np.full(100, 1e-3), 5.0 + x, 310.0 - x, 1e-4, gas | {"density": np.ones(2)})
    return whole._replace(**more)


def side(*airs: Air, **more) -> Side:
    return Side(1.0, 0.01, list(airs) or [air(), air()], np.ones(2))._replace(**more)


def failed(own: Side, other: Side) -> set[str]:
    return {row["name"].split()[0] for row in droplets.checks(case(), [WAY], own, other) if not row["ok"]}


def test_two_sides_alike_agree():
    rows = droplets.checks(case(), [WAY], side(), side())
    assert len(rows) == 10 and all(row["ok"] for row in rows)


def with_gas(name, values) -> Air:
    return air(gas=air().gas | {name: np.array(values)})


@pytest.mark.parametrize(
    ("own", "seen"),
    [
        (side(came=1.04), {"liquid"}),
        (side(evaporated=0.0117), {"evaporated"}),
        (side(air(), air(place=1.06 * air().place)), {"front"}),
        (side(air(temperature=air().temperature + 8.0), air()), {"droplets"}),
        (side(air(speed=1.22 * air().speed), air()), {"speed"}),
        (side(air(sauter=1.12e-4), air()), {"D32"}),
        (side(*[with_gas("temperature", [349.0, 370.0])] * 2), {"coldest", "temperature"}),
        (side(*[with_gas("vapour_mass_fraction", [0.0125, 0.0])] * 2), {"largest"}),
        (side(*[with_gas("vapour_mass_fraction", [0.01, 0.002])] * 2), {"temperature"}),
    ],
)
def test_what_differs_is_seen(own, seen):
    assert failed(own, side()) == seen


def gone(**more) -> Side:
    """A side that has no droplets any more."""
    return side(air(**{name: getattr(air(), name)[:0] for name in ("place", "mass", "speed", "temperature")}), **more)


def test_what_a_case_has_not_is_not_asked():
    """Without evaporation no pressure of saturation and no vapour, without droplets nothing of them."""
    cold = case(effects=["inflow", "drag", "gravity"])
    names = [row["name"].split()[0] for row in droplets.checks(cold, [WAY], side(), side())]
    assert names == ["liquid", "front", "speed", "D32"]
    names = [row["name"].split()[0] for row in droplets.checks(case(), [WAY], gone(), gone())]
    assert not {"front", "droplets", "speed", "D32"} & set(names) and len(names) == 6


def test_what_one_side_alone_has_is_wrong():
    """All droplets of the run have evaporated or left, and OpenFOAM's fly, or the other way round."""
    dry = [air(gas=air().gas | {"vapour_mass_fraction": np.zeros(2)})]
    of_droplets = {"front", "droplets", "speed", "D32"}
    assert failed(gone(), side()) == failed(side(), gone()) == of_droplets
    assert failed(side(*dry), side()) == failed(side(), side(*dry)) == {"largest", "temperature"}
    rows = {row["name"].split()[0]: row for row in droplets.checks(case(), [WAY], gone(), side())}
    assert all(np.isnan(rows[name]["value"]) and np.isfinite(rows[name]["reference"]) for name in of_droplets)


def test_sizes_are_those_of_the_particles_where_no_metric_tells_of_them():
    """A run has the metric D32 where sizes change or differ; where they do not, each particle is of equal drops."""
    points = pyvista.PolyData(np.zeros((2, 3)))
    points["mass"], points["velocity"] = np.array([1.0, 3.0]), np.zeros((2, 3))
    own = case(effects=["inflow", "drag", "gravity"])
    assert np.isnan(droplets._particles(own, points, None, {}).sauter)
    points["diameter"] = np.array([1e-4, 2e-4])
    assert droplets._particles(own, points, None, {}).sauter == pytest.approx(4.0 / (1e4 + 1.5e4))
    assert droplets._particles(own, points, 3e-4, {}).sauter == 3e-4
    flown = case(effects=["inflow", "gravity"])
    names = [row["name"].split()[0] for row in droplets.checks(flown, [WAY], side(), side())]
    assert "D32" not in names and any("D32 is left out" in line for line in droplet_cloud.unlike(flown))
    assert not any("D32" in line for line in droplet_cloud.unlike(own))


def test_ways_are_those_of_the_nozzles_or_of_what_is_there():
    nothing = np.zeros((0, 2))
    none = Drops(nothing, nothing, *(np.zeros(0),) * 4)
    found = droplets.ways(case(), none)
    assert [tuple(way.direction) for way in found] == [(0.0, -1.0), (1.0, 0.0)]
    assert [tuple(way.origin) for way in found] == [(0.3, 0.4), (0.0, 0.2)]
    each = np.ones(2)
    drops = Drops(
        np.array([[0.0, 0.0], [0.4, 0.0]]), np.array([[3.0, 0.0]] * 2), each, np.array([1.0, 3.0]), each, each
    )
    still = dataclasses.replace(case(), nozzles={})
    (way,) = droplets.ways(still, drops)
    assert tuple(way.direction) == (1.0, 0.0) and way.origin == pytest.approx([0.3, 0.0])
    (way,) = droplets.ways(still, drops._replace(velocity=np.zeros((2, 2))))
    assert tuple(way.direction) == (0.0, -1.0)
    assert droplets.front(air(), WAY) == pytest.approx(0.95, abs=0.01)
    assert droplets.front(air(), WAY._replace(origin=np.array([0.5, 0.0]))) == pytest.approx(0.45, abs=0.01)


def test_openfoam_s_evaporated_mass_is_that_of_no_step():
    """Of first order: 3 with a step, 4 with two of it, 2 with none."""
    fields = {1.0: {"gas_temperature": np.ones(1), "density": np.ones(1), "vapour_mass_fraction": np.zeros(1)}}
    histories = ({"time_s": np.array([0.0, 1.0]), "evaporated_kg": np.array([0.0, m])} for m in (3.0, 4.0))
    fine, coarse = (
        Reference("some", 1.0, np.zeros((1, 3)), np.ones(1), fields, own | {"injected_kg": np.ones(2)}, {})
        for own in histories
    )
    assert droplets._other(case(), [1.0], fine, coarse).evaporated == 2.0


@pytest.mark.openfoam
def test_a_spray_of_nobody_s_runs_beside_openfoam_s_droplets(tmp_path, shelf, capsys):
    """Four cells across its slot. At two the evaporated mass differs by 18 %, at four by 10 % (15 % may): coarse cells
    and the kernel spread the jet. Longer first windows once hid that at two."""
    own = case(coupling={"film": True, "voidage": False}, resolution={"spacing_mm": 12.5, "cell_mm": 25.0})
    (tmp_path / "case.toml").write_text(cases.dumps(own), encoding="utf-8")
    folder = tmp_path / "run"
    assert main(["run", str(tmp_path / "case.toml"), "--gas", "embedded", "--out", str(folder)]) == 0
    capsys.readouterr()
    assert main(["compare", str(folder), "--against", "dpm"]) in (0, 1)
    said = capsys.readouterr().out
    for name in ("largest error of OpenFOAM's pressure", "liquid that came in", "evaporated mass", "D32"):
        assert next(line for line in said.splitlines() if line.startswith(name)).endswith("ok")
    assert "not alike:" in said and "part in flight" in said
    assert (folder / droplets.PICTURE).stat().st_size > 10_000
    assert "unlike" in (folder / "compare_dpm.json").read_text(encoding="utf-8")
    table = (folder / "dpm/constant/nozzle1_0").read_text(encoding="utf-8")
    assert "(8.0 0.0 0.0) 0.0001 998.0" in table


@pytest.mark.openfoam
def test_bad_input_is_one_line(tmp_path, shelf, capsys):
    folder = tmp_path / "run"
    beads = case(effects=["drag", "gravity"], vapour=table()["vapour"], particles={"bed": {
        "shape": "box", "lower_m": [0.1, 0.1], "upper_m": [0.3, 0.2], "volume_fraction": 0.1, "temperature_K": 300.0,
    }})  # fmt: skip
    (tmp_path / "case.toml").write_text(cases.dumps(beads), encoding="utf-8")
    assert main(["run", str(tmp_path / "case.toml"), "--gas", "embedded", "--until", "1e-3", "--out", str(folder)]) == 0
    capsys.readouterr()
    assert main(["compare", str(folder), "--against", "dpm"]) == 2
    said = capsys.readouterr().err
    assert "its grains are no droplets" in said and said.count("\n") == 1


SIZE, CELLS = (0.1, 0.24), (10, 12)  # m, and cells of 10 x 20 mm: products of fields go wrong on these once turned


def vessel(angle: float):
    """A spray against a stream of gas in a plane vessel that is turned, gravity with it."""
    up = np.array([-sin(angle), cos(angle)])
    corner = np.array([cos(angle), sin(angle)]) * 0.5 * SIZE[0]
    return case(
        run={"end_time_s": 0.01},
        domain={"lower_m": [-0.2, 0.0], "size_m": [0.4, 0.4], "gravity_m_s2": (-9.81 * up).tolist()},
        resolution={"spacing_mm": 5.0, "cell_mm": 14.0},
        nozzles={"left": table()["nozzles"]["left"] | {
            "centre_m": (corner + 0.2 * up).tolist(), "direction": (-up).tolist(), "width_m": 0.02,
        }, "top": table()["nozzles"]["left"] | {
            "centre_m": (corner + 0.2 * up).tolist(), "direction": up.tolist(), "width_m": 0.02,
        }},
        boundaries={
            "wind": {"kind": "velocity_inlet", "velocity_m_s": (0.5 * up).tolist(), "temperature_K": 373.0},
        },
    )  # fmt: skip


def meshed(folder, angle: float):
    """An OpenFOAM case with the mesh of the turned vessel, and no more."""
    for part in ("system", "constant"):
        (folder / part).mkdir(parents=True)
    (folder / "system" / "controlDict").write_text(CONTROL, encoding="utf-8")
    text = turned_box(*SIZE, *CELLS, angle)
    for old, new in ((" inlet ", " wind "), (" outlet ", " out "), (" wall ", " walls ")):
        text = text.replace(old, new)
    (folder / poly_mesh.BLOCKS).write_text(text, encoding="utf-8")
    programs.run(["blockMesh"], folder, folder / "log", barrier.environment())
    return folder


def sprayed(folder, angle: float):
    own = vessel(angle)
    sides = {name: dataclasses.replace(part, side=None, span=None) for name, part in own.boundaries.items()}
    sides["walls"] = dataclasses.replace(sides["walls"], kind="wall")
    found = comparators.run_droplets(
        dataclasses.replace(own, boundaries=sides), folder / "dpm", mesh=meshed(folder / "gas", angle)
    )
    return found.fields[max(found.fields)], found


@pytest.mark.openfoam
def test_a_turned_vessel_has_the_same_spray(tmp_path, shelf):
    """OpenFOAM as it is packaged ends in a floating point exception here."""
    upright, first = sprayed(tmp_path / "upright", 0.0)
    turned, second = sprayed(tmp_path / "turned", pi / 6.0)
    assert second.history["evaporated_kg"][-1] == pytest.approx(first.history["evaporated_kg"][-1], rel=2e-3)
    speeds = [np.linalg.norm(fields["gas_velocity"], axis=1) for fields in (upright, turned)]
    assert speeds[0].max() > 0.6 and np.abs(speeds[1] - speeds[0]).max() < 0.02 * speeds[0].max()
    assert turned["gas_temperature"] == pytest.approx(upright["gas_temperature"], abs=0.5)


@pytest.mark.openfoam
def test_a_spray_with_walls_in_a_vessel_runs_beside_openfoam_s_droplets(tmp_path, shelf, capsys):
    """Its run writes the patches of the gas into its case.toml as a mesh of walls."""
    own, folder = tmp_path / "own", tmp_path / "run"
    assert main(["init", "spray_cone", str(own)]) == 0
    shutil.copytree(meshed(tmp_path / "gas", pi / 6.0) / poly_mesh.FOLDER, own / "gas" / poly_mesh.FOLDER)
    told = cases.to_table(dataclasses.replace(vessel(pi / 6.0), scene=""))
    told["effects"], told["walls"] = [*told["effects"], "walls"], {"restitution": 0.0}
    del told["domain"]["lower_m"], told["domain"]["size_m"]
    for side in told["boundaries"].values():
        side.pop("side", None)
    (own / "case.toml").write_text(tomli_w.dumps(told), encoding="utf-8")
    assert main(["run", str(own), "--gas", "openfoam", "--out", str(folder)]) == 0, capsys.readouterr().err
    assert cases.load(folder / "case.toml").parameters["walls"].source == "gas"
    capsys.readouterr()
    assert main(["compare", str(folder), "--against", "dpm"]) in (0, 1), capsys.readouterr().err
    assert "liquid that came in" in capsys.readouterr().out
    assert "walls { type rebound;" in (folder / "dpm/constant/sdphCloud").read_text(encoding="utf-8")


@pytest.mark.openfoam
def test_a_run_of_openfoam_that_fails_names_its_log(tmp_path, shelf, capsys):
    """A mouth in the box around a mesh, but in none of its cells."""
    mesh, own = meshed(tmp_path / "gas", pi / 6.0), vessel(pi / 6.0)
    aside = {"left": dataclasses.replace(own.nozzles["left"], centre=(0.15, 0.02))}
    with pytest.raises(GasError, match=r"reactingParcelFoam ended with code 1.*injection cell.*\(log: .*log.reacting"):
        comparators.run_droplets(dataclasses.replace(own, nozzles=aside), tmp_path / "dpm", mesh=mesh)
    shutil.rmtree(tmp_path / "dpm")
