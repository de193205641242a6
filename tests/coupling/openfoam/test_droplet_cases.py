"""A case of droplets as OpenFOAM's: what comes in, what patches do, pressure of saturation, what is refused."""

import dataclasses
from math import cos, exp, log, pi, radians

import numpy as np
import pytest

from coupling.openfoam.comparators import (
    droplet_cloud,
    droplet_liquid,
    droplet_log,
    droplet_numbers,
    droplet_sources,
)
from coupling.openfoam.comparators.droplet_fields import start_fields
from coupling.openfoam.comparators.droplet_sources import Drops
from coupling.openfoam.comparators.reference import Reference
from sdph import scenes
from sdph.case import read as cases
from sdph.schema import CaseError
from tests.coupling.openfoam.spray_cases import EFFECTS, case, table

NONE = droplet_sources.none(2)


def fit_at(fit, temperature: float) -> float:
    a, b, c, d = fit.numbers
    return exp(a + b / temperature + c * log(temperature) + d * temperature)


def test_antoine_s_pressure_is_met_within_what_is_told():
    fit = droplet_liquid.fitted(case())
    pressure = [10.0 ** (9.6543 - 1435.264 / (T - 64.848)) for T in (250.0, 300.0, 350.0, 370.0)]
    found = [fit_at(fit, T) for T in (250.0, 300.0, 350.0, 370.0)]
    off = np.abs(np.divide(found, pressure) - 1.0).max()
    assert 1e-5 < off <= fit.error < 0.01
    assert (fit.low, fit.boiling) == pytest.approx((240.0, 1435.264 / (9.6543 - log(101325.0, 10.0)) + 64.848))


def test_laws_of_openfoam_s_form_are_met_to_the_last_digits():
    own = {"saturation": "clausius_clapeyron", "saturation_pressure_Pa": 101325.0, "saturation_temperature_K": 373.15}
    fit = droplet_liquid.fitted(case(evaporation=own))
    assert fit.error < 1e-12 and fit.numbers[2:] == (0.0, 0.0)
    assert fit_at(fit, 300.0) == pytest.approx(101325.0 * exp(2.257e6 * 18.015 / 8314.462618 * (1 / 373.15 - 1 / 300)))
    fit = droplet_liquid.fitted(case(evaporation={"saturation": "constant", "saturation_pressure_Pa": 1329.0}))
    assert fit_at(fit, 5000.0) == pytest.approx(1329.0) and fit.boiling == droplet_liquid.NOT_SO_HOT


def test_a_law_far_from_openfoam_s_form_is_refused():
    with pytest.raises(CaseError, match="saturation = 'antoine': OpenFOAM's form of it is .* % off between 240 and"):
        droplet_liquid.fitted(case(evaporation={"antoine": [9.0, 700.0, -220.0]}))


def test_what_comes_in_is_what_the_nozzles_give():
    """To the mass of steps that are open; alike rows in a table of their own."""
    own = case()
    found = droplet_sources.injectors(own, NONE, 1e-3)
    given = {n: sum(i.mass for i in found if i.name.startswith(f"nozzle{n}_")) for n in (1, 2)}
    assert given == pytest.approx({1: 1e-3 * 998.0 * 8.0 * 0.1 * 0.02, 2: 0.5 * 0.01}, rel=1e-6)
    left, top = ([i for i in found if i.name.startswith(f"nozzle{n}_")] for n in (1, 2))
    assert [len(i.rows.mass) for i in left] == [4] and sum(len(i.rows.mass) for i in top) == 4 * droplet_sources.PARTS
    assert all(np.ptp(i.rows.mass) < 1e-8 * i.rows.mass.max() for i in found)
    assert [(i.start, i.duration) for i in top] == [pytest.approx((0.005, 0.01), abs=1e-9)] * len(top)
    speeds = np.concatenate([i.rows.velocity for i in top])
    assert np.linalg.norm(speeds, axis=1) == pytest.approx(10.0)
    assert (-speeds[:, 1]).min() == pytest.approx(10.0 * cos(radians(7.5)))  # the middle of the outermost stream
    assert all((i.rows.place[:, 0] == droplet_sources.INSIDE).all() for i in left)


def test_sizes_keep_mass_and_surface_of_the_distribution():
    own = case(nozzles={"top": table()["nozzles"]["top"] | {"size_classes": 2}})
    rows = [i.rows for i in droplet_sources.injectors(own, NONE, 1e-3) if i.name.startswith("nozzle2_")]
    mass, size = (np.concatenate(column) for column in zip(*((r.mass, r.diameter) for r in rows)))
    assert len(mass) == 4 * 2 * 3  # places, classes, parts of each
    sauter = 1e-4 * (1.0 + 0.3**2) ** 2  # of a log-normal of 0.1 and 0.03 mm by number
    assert mass.sum() / (mass / size).sum() == pytest.approx(sauter, rel=1e-6)
    assert size.min() < 0.8 * sauter and size.max() > 1.3 * sauter


def started() -> Drops:
    place = np.array([[0.1, 0.1], [0.2, 0.1], [0.3, 0.1]])
    each = np.ones(3)
    velocity = place * 10.0
    return Drops(place, velocity, 310.0 * each, np.array([2e-3, 1e-3, 2e-3]), 1e-4 * each, np.array([0.0, 0.0, 9e-10]))


def test_droplets_of_the_start_come_in_at_once_and_whole():
    found = [i for i in droplet_sources.injectors(case(), started(), 1e-3) if i.name.startswith("start")]
    assert sum(i.mass for i in found) / droplet_sources.AT_ONCE == pytest.approx(5e-3)
    assert [len(i.rows.mass) for i in found] == [1, 1, droplet_sources.PARTS]
    assert all(i.start == 0.0 and i.duration == droplet_sources.AT_ONCE * 1e-3 for i in found)
    assert droplet_numbers.time_step(case(), started(), 0.1, 0.05) == pytest.approx(0.01 / 20)  # 10 m/s of the nozzle
    still = started()._replace(velocity=np.tile([50.0, 0.0], (3, 1)))
    assert droplet_numbers.time_step(case(), still, 0.1, 0.05) == pytest.approx(0.01 / 100)


def test_a_table_has_the_flow_of_its_mesh_s_depth():
    injector = droplet_sources.injectors(case(), NONE, 1e-3)[0]
    text = droplet_sources.table(case(), injector, 0.05, 0.1)
    assert text.count("\n") == 6 and "(1e-06 0.1625 0.05) (8.0 0.0 0.0) 0.0001 998.0" in text
    flows = [float(line.split(") ")[2].split()[2]) for line in text.splitlines()[1:-1]]
    assert sum(flows) == pytest.approx(0.1 * 1e-3 * 998.0 * 8.0 * 0.1)
    asked = droplet_sources.entry(injector, 1e-3, 0.1)
    assert f"massTotal {0.1 * injector.mass!r};" in asked


def test_droplets_leave_or_are_held_as_in_the_run():
    said = droplet_cloud.cloud(case(), [], ["wind", "out", "walls", "tube"], 1e-3, 1.0)
    assert said.count("type escape;") == 4 and "{ sphereDrag; gravity; }" in said
    held = case(effects=[*EFFECTS, "walls"], walls={"restitution": 0.5})
    said = droplet_cloud.cloud(held, [], ["wind", "out", "walls", "tube"], 1e-3, 1.0)
    assert said.count("type rebound; e 0.5; mu 0;") == 3 and "out { type escape; }" in said
    closed = case(effects=["inflow", "walls"])
    said = droplet_cloud.cloud(closed, [], ["out"], 1e-3, 1.0)
    assert "out { type rebound; e 0.0; mu 0; }" in said and "particleForces {  }" in said
    assert "heatTransferModel none" in said and "phaseChangeModel none" in said


def test_every_boundary_says_what_it_asks():
    own = table()["boundaries"]
    own = own | {"wind": own["wind"] | {"vapour_mass_fraction": 0.02}}
    fields = start_fields(case(boundaries=own))
    assert "wind { type fixedValue; value uniform (2.0 0.0 0.0); }" in fields["U"]
    assert "wind { type fixedValue; value uniform 0.98; }" in fields["air"]
    assert "out { type fixedValue; value uniform 101335.0; }" in fields["p_rgh"]
    assert "out { type inletOutlet; inletValue uniform 360.0;" in fields["T"]
    assert "walls { type slip; }" in fields["U"] and "frontAndBack { type empty; }" in fields["C10H22"]
    assert "tube { type fixedValue; value uniform (0.0 0.0 0.0); }" in start_fields(case(), {"tube": "wall"})["U"]


def test_the_gas_begins_as_moist_as_that_of_the_run():
    """Evaporation is driven by what the gas lacks to saturation: a dry one would be another case."""
    fields = start_fields(case(vapour={"mass_fraction": 0.01}))
    assert "internalField uniform 0.01;" in fields["C10H22"] and "internalField uniform 0.99;" in fields["air"]
    assert "internalField uniform 0.0;" in start_fields(case())["C10H22"]


TOP = table()["nozzles"]["top"]
WIND = {name: part for name, part in table()["boundaries"].items() if name != "out"}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"effects": ["drag", "heat", "gravity"]}, "neither evaporation nor inflow: its grains are no droplets"),
        ({"effects": [*EFFECTS, "lift"]}, "effects holds lift; the droplet reference has none"),
        ({"effects": [*EFFECTS, "walls", "wall_heat"]}, "effects holds wall_heat; the droplet reference has none"),
        ({"effects": [*EFFECTS, "walls"], "walls": {"mesh": "funnel.stl"}}, "walls.mesh holds grains where the gas"),
        ({"effects": [n for n in EFFECTS if n != "gravity"]}, "gravity in domain, none in effects"),
        ({"gas": {"equation_of_state": "ideal"}}, "equation_of_state = 'ideal'; the droplet reference has: constant"),
        ({"gas": {"turbulence": {"model": "WALE"}}}, "the droplet reference is laminar"),
        ({"drag": {"filter": "igci"}, "nozzles": {"top": TOP | {"diameter_std_mm": 0.0}}}, "drag.filter"),
        (
            {"nozzles": {"top": {k: v for k, v in TOP.items() if k != "rate_kg_s"} | {"rates": [[0, 1], [1, 2]]}}},
            "nozzles.top.rates; the droplet reference has one rate",
        ),
        ({"boundaries": {"out": {"kind": "slip_wall", "side": "right"}}}, "no boundary is a pressure_outlet"),
        ({"domain": {"periodic": ["y"]}}, "domain.periodic"),
    ],
)
def test_what_the_droplet_reference_lacks_is_said(change, said):
    (lacking,) = droplet_cloud.lacks(case(**change))
    assert said in lacking and "\n" not in lacking


def test_walls_that_are_the_patches_of_the_gas_are_known():
    """As a run of a vessel writes them into its case.toml."""
    walls = {"mesh": "patches.vtk", "source": "gas"}
    assert not droplet_cloud.lacks(case(effects=[*EFFECTS, "walls"], walls=walls))


@pytest.mark.parametrize("scene", ["evaporating_jet", "spray_cone", "stefan_tube"])
def test_scenes_that_have_droplets_of_openfoam_are_not_refused(scene):
    assert not droplet_cloud.lacks(cases.load(scenes.find(scene)[1]))


def test_what_nobody_looked_at_is_refused():
    for name in ("reaction", "grain_drag", "new"):
        (lacking,) = droplet_cloud.lacks(dataclasses.replace(case(), effects=(*EFFECTS, name)))
        assert lacking.startswith(f"effects holds {name}; the droplet reference has none")


def test_a_mouth_outside_of_the_gas_is_refused():
    with pytest.raises(CaseError, match="nozzles.top: a part of its mouth is outside of the gas"):
        droplet_sources.injectors(case(nozzles={"top": TOP | {"centre_m": [0.01, 0.4]}}), NONE, 1e-3)


def test_what_is_not_alike_is_told():
    told = "\n".join(droplet_cloud.unlike(case()))
    assert "(coupling.voidage=false)" in told and "(coupling.film=true)" in told
    assert "droplets of top part in flight" in told and "(size_classes=5)" in told
    alike = {"coupling": {"voidage": False, "film": True}, "nozzles": {"top": TOP | {"diameter_std_mm": 0.0}}}
    assert len(droplet_cloud.unlike(case(**alike))) == 2  # the room of the droplets, how vapour spreads
    held = alike | {"effects": [*EFFECTS, "walls"], "walls": {"friction": 0.1}, "boundaries": WIND | {
        "out": {"kind": "pressure_outlet", "side": "right"}, "walls": {"kind": "wall"}}}  # fmt: skip
    by_walls = "\n".join(set(droplet_cloud.unlike(case(**held))) - set(droplet_cloud.unlike(case(**alike))))
    assert by_walls.count("\n") == 1 and "walls.friction=0.1" in by_walls and "(cellPoint)" in by_walls
    kept = [name for name in EFFECTS if name != "outflow"]
    other = {
        "drag": {"law": "gidaspow"},
        "heat": {"law": "gunn"},
        "effects": [*kept, "granular_pressure", "gas_pressure"],
    }
    evaporation = {"law": "spalding", "onset": "latched", "onset_temperature_K": 310.0}
    told = "\n".join(droplet_cloud.unlike(case(**other, evaporation=evaporation)))
    for word in ("gidaspow", "gunn", "spalding", "onset", "granular_pressure", "gradient", "(outflow)"):
        assert word in told


def test_diffusivity_is_the_case_s_in_the_film_where_droplets_come_in():
    """By hand: D = 3.6059e-3 (1.8 T)^1.75/(p (a^(1/3) + b^(1/3))^2), a = b, T = (2 300 + 373)/3."""
    volume = droplet_numbers.diffusion_volume(case(), NONE)
    film = 3.6059e-3 * (1.8 * 973.0 / 3.0) ** 1.75 / (101325.0 * 4.0 * volume ** (2.0 / 3.0))
    assert film == pytest.approx(3.7e-5)


def test_masses_are_read_from_the_log(tmp_path):
    step = "Time = {}\n    Injector a:\n      - mass introduced             = {}\n    Injector b:\n" \
        "      - mass introduced             = 2\n    Current mass in system          = 2.5\n" \
        "    Mass transfer phase change      = {}\n"  # fmt: skip
    (tmp_path / "log").write_text(step.format(0.1, 0.5, 0) + step.format(0.2, 1e0, 0.5))
    found = {name: column.tolist() for name, column in droplet_log.history(tmp_path / "log").items()}
    assert found == {
        "time_s": [0.1, 0.2], "injected_kg": [2.5, 3.0], "airborne_kg": [2.5, 2.5], "evaporated_kg": [0.0, 0.5],
    }  # fmt: skip


def test_a_deep_plane_mesh_is_told_by_the_metre():
    own = Reference(
        "some", 1.0, np.zeros((1, 3)), np.ones(1), {1.0: {}}, {"time_s": np.ones(1), "evaporated_kg": np.ones(1)},
        {1.0: {"count": np.full(1, 4.0), "diameter": np.full(1, pi)}},
    )  # fmt: skip
    found = droplet_log.by_the_metre(own, 2.0)
    assert (found.volumes[0], found.history["evaporated_kg"][0], found.history["time_s"][0]) == (0.5, 0.5, 1.0)
    assert (found.parcels[1.0]["count"][0], found.parcels[1.0]["diameter"][0]) == (2.0, pi)
