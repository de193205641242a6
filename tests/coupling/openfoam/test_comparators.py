"""Stock OpenFOAM as a reference: short runs against exact solutions and laws."""

import re

import numpy as np
import pytest

from coupling.gas import GasError
from coupling.openfoam.comparators import reference, two_fluid_numbers
from coupling.openfoam.comparators import run as comparators
from coupling.openfoam.programs import install
from coupling.openfoam.programs import run as programs
from sdph import scenes
from sdph.case import read as cases
from sdph.laws import drag, exact, heat
from sdph.schema import CaseError

pytestmark = pytest.mark.openfoam
DISC = scenes.HERE / "disc_cluster" / "case.toml"
AIR = {
    "equation_of_state": "constant", "density_kg_m3": 1.225, "viscosity_Pa_s": 1.7895e-5, "conductivity_W_m_K": 0.0242,
    "heat_capacity_J_kg_K": 1006.43, "temperature_K": 288.0,
}  # fmt: skip
SAND = {"density_kg_m3": 3060.0, "diameter_mm": 0.285, "heat_capacity_J_kg_K": 2470.0, "conductivity_W_m_K": 500.0}


@pytest.fixture(autouse=True)
def _own_shelf(tmp_path, monkeypatch):
    monkeypatch.setattr(comparators, "shelf", lambda: tmp_path / "references")


def disc(*overrides):
    return cases.load(DISC, ("resolution.cell_mm=10.0", *overrides))


def last(run):
    """Fields of a run's last output."""
    return run.fields[max(run.fields)]


def exchange(case):
    """eps, C_p, C_g of a disc at rest."""
    gas, grains, alpha_p = case.gas, case.grains, 0.6
    nusselt = heat.gunn(1.0 - alpha_p, 0.0, heat.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity))
    eps = alpha_p * heat.CLOSURES[case.parameters["heat"].closure](
        1.0 - alpha_p, nusselt, gas.conductivity, grains.diameter
    )
    return eps, alpha_p * grains.density * grains.heat_capacity, (1.0 - alpha_p) * gas.density * gas.heat_capacity


@pytest.mark.parametrize("closure", ["paper", "geometric"])
def test_one_way_disc_heats_as_the_exact_solution(tmp_path, closure):
    case = disc(
        "coupling.one_way=true", f"heat.closure={closure!r}", "run.end_time_s=0.02", "run.output_interval_s=0.01"
    )
    run = comparators.run_two_fluid(case, tmp_path / "run")
    eps, of_grains, _ = exchange(case)
    expected = exact.one_way_temperature(0.02, 288.0, 350.0, eps, of_grains) - 288.0
    assert list(run.fields) == pytest.approx([0.01, 0.02])
    assert run.history["centre_temperature_K"][-1] - 288.0 == pytest.approx(expected, rel=1e-3)
    assert np.allclose(last(run)["gas_temperature"], 350.0, rtol=0.0, atol=1e-9)


def test_two_way_disc_follows_the_lumped_solution_and_keeps_its_energy(tmp_path):
    case = disc("heat.closure='paper'", "run.end_time_s=2e-3", "run.output_interval_s=1e-3")
    run = comparators.run_two_fluid(case, tmp_path / "run")
    for when in (1e-3, 2e-3):
        place = int(np.argmin(np.abs(run.history["time_s"] - when)))
        grains, gas = exact.two_way_temperatures(run.history["time_s"][place], 288.0, 350.0, *exchange(case))
        assert run.history["centre_temperature_K"][place] - 288.0 == pytest.approx(grains - 288.0, rel=1e-3)
        assert run.history["centre_gas_temperature_K"][place] - 350.0 == pytest.approx(gas - 350.0, rel=1e-3)
    alpha_p, volume = last(run)["alpha_p"], run.volumes
    gained = np.sum(alpha_p * 3060.0 * 2470.0 * (last(run)["particle_temperature"] - 288.0) * volume)
    lost = np.sum((1.0 - alpha_p) * 1.225 * 1006.43 * (350.0 - last(run)["gas_temperature"]) * volume)
    assert gained > 100.0  # J
    assert gained == pytest.approx(lost, rel=1e-6)


def test_a_finished_run_is_not_made_twice(tmp_path, monkeypatch):
    case = disc("coupling.one_way=true", "run.end_time_s=0.01", "run.output_interval_s=0.01")
    heard = []
    monkeypatch.setattr(programs, "TELL", 0.0)
    with programs.told(heard.append):
        first = comparators.run_two_fluid(case, tmp_path / "first")
    again = comparators.run_two_fluid(case, tmp_path / "again")
    assert re.fullmatch(r"twoPhaseEulerFoam: t = 0\.0\d+ of 0\.01 s, \d+ s left", heard[-1])
    assert (tmp_path / "first" / "log.twoPhaseEulerFoam").exists()
    assert not (tmp_path / "again" / "log.twoPhaseEulerFoam").exists()
    assert np.array_equal(last(first)["particle_temperature"], last(again)["particle_temperature"])
    assert np.array_equal(first.history["time_s"], again.history["time_s"]) and first.wall == again.wall
    other = disc(
        "coupling.one_way=true", "run.end_time_s=0.01", "run.output_interval_s=0.01", "grains.density_kg_m3=1530.0"
    )
    lighter = comparators.run_two_fluid(other, tmp_path / "other")
    assert lighter.history["centre_temperature_K"][-1] - 288.0 > 1.9 * (
        first.history["centre_temperature_K"][-1] - 288.0
    )


def test_two_ranks_give_the_fields_of_one(tmp_path):
    case = disc("heat.closure='paper'", "run.end_time_s=4e-4", "run.output_interval_s=2e-4")
    one = comparators.run_two_fluid(case, tmp_path / "one")
    two = comparators.run_two_fluid(case, tmp_path / "two", ranks=2)
    assert (tmp_path / "two" / "processor1").is_dir()
    assert np.allclose(last(two)["gas_temperature"], last(one)["gas_temperature"], rtol=0.0, atol=1e-6)


def bed(alpha_p, jet, distributor, end, outputs=1, law="gidaspow"):
    """A bed of 0.2 x 0.2 m in the lower half of a box, blown through by a jet and a distributor [m/s]."""
    inlet = {"kind": "velocity_inlet", "side": "bottom"}
    return cases.from_table({
        "title": "bed", "scene": "bubbling_bed", "dimensions": 2,
        "effects": ["drag", "gravity", "granular_pressure", "friction", "granular_temperature", "heat"],
        "run": {"end_time_s": end, "output_interval_s": end / outputs},
        "domain": {"size_m": [0.2, 0.4], "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": 5.0, "cell_mm": 10.0},
        "gas": AIR, "grains": SAND, "drag": {"law": law},
        "particles": {"bed": {
            "shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.2, 0.2], "volume_fraction": alpha_p,
            "temperature_K": 288.0,
        }},
        "boundaries": {
            "jet": inlet | {"span_m": [0.09, 0.11], "velocity_m_s": [0.0, jet], "temperature_K": 350.0},
            "distributor": inlet | {"velocity_m_s": [0.0, distributor], "temperature_K": 288.0},
            "outlet": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0, "temperature_K": 288.0},
            "walls": {"kind": "wall"},
        },
    })  # fmt: skip


def test_steps_follow_the_grains_that_move_at_the_start():
    """1 m/s through cells of 4 mm, Courant number 0.2: 0.8 ms at most, a part of the 10 ms of an output."""
    stream = cases.load(scenes.find("granular_jet")[1], ("resolution.cell_mm=4.0",))
    assert float(two_fluid_numbers.macros(stream, 0.2)["time_step"]) == pytest.approx(0.01 / 13, rel=1e-12)


def test_bed_keeps_its_grains_and_lets_the_jet_in(tmp_path):
    case = bed(0.6, jet=7.5, distributor=0.08, end=3e-3)
    run = comparators.run_two_fluid(case, tmp_path / "run")
    grains = np.sum(last(run)["alpha_p"] * run.volumes)
    assert grains == pytest.approx(0.6 * 0.2 * 0.2, rel=1e-5)
    above_jet = np.argmin(np.linalg.norm(run.centres[:, :2] - [0.095, 0.005], axis=1))
    assert last(run)["gas_velocity"][above_jet, 1] > 1.0
    assert 290.0 < last(run)["gas_temperature"].max() <= 350.01


@pytest.mark.parametrize(
    ("law", "alpha_p"),
    [
        ("gidaspow", 0.6),
        ("gidaspow", 0.2),
        ("gidaspow_switch", 0.6),
        ("gidaspow_switch", 0.15),
        ("ergun", 0.5),
        ("wen_yu", 0.3),
    ],
)
def test_drag_of_the_closures_library_is_the_law(tmp_path, law, alpha_p):
    """The gas pressure falls through a bed by beta u_r/alpha_g + rho_g g, with the slip that the solver has there."""
    case = bed(alpha_p, jet=0.06, distributor=0.06, end=2e-2, outputs=20, law=law)
    run = comparators.run_two_fluid(case, tmp_path / "run")
    x, y = run.centres[:, 0], run.centres[:, 1]
    column = np.flatnonzero(np.isclose(x, 0.055))
    lower, middle, upper = (column[np.argmin(np.abs(y[column] - place))] for place in (0.085, 0.095, 0.105))
    slope = -(last(run)["pressure"][upper] - last(run)["pressure"][lower]) / (y[upper] - y[lower])
    slip = (last(run)["gas_velocity"] - last(run)["particle_velocity"])[middle, 1]
    there = last(run)["alpha_p"][middle]
    beta = there * getattr(drag, law)(there, slip, 0.285e-3, 1.225, 1.7895e-5)
    assert slope - 1.225 * 9.81 == pytest.approx(beta * slip / (1.0 - there), rel=5e-3)


def test_droplets_come_in_evaporate_and_nothing_is_lost(tmp_path, monkeypatch):
    """They need nothing of what two fluids need."""
    monkeypatch.setattr(install, "two_fluid_closures", lambda: pytest.fail("two fluids' library, of droplets"))
    case = cases.from_table({
        "title": "jet", "scene": "evaporating_jet", "dimensions": 2,
        "effects": ["inflow", "outflow", "drag", "gravity", "heat", "evaporation"],
        "run": {"end_time_s": 0.02, "output_interval_s": 0.01},
        "domain": {"size_m": [2.0, 2.0], "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": 50.0, "cell_mm": 100.0},
        "gas": AIR | {"temperature_K": 350.0}, "grains": SAND | {"density_kg_m3": 700.0, "diameter_mm": 3.0},
        "vapour": {
            "molar_mass_kg_kmol": 142.284, "diffusivity_m2_s": 3.79e-6, "heat_capacity_J_kg_K": 1006.43,
            "conductivity_W_m_K": 0.0242, "viscosity_Pa_s": 1.7895e-5,
        },
        "boundaries": {
            "walls": {"kind": "wall", "side": "left"},
            "sides": {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 350.0},
        },
        "nozzles": {"jet": {
            "shape": "slot", "centre_m": [0.0, 1.0], "width_m": 0.5, "direction": [1.0, 0.0], "speed_m_s": 10.0,
            "volume_fraction": 0.6, "temperature_K": 295.0,
        }},
        "evaporation": {
            "onset": "paper", "onset_temperature_K": 294.3, "saturation": "constant",
            "saturation_pressure_Pa": 1329.0, "latent_heat_J_kg": 277000.0,
        },
    })  # fmt: skip
    run = comparators.run_droplets(case, tmp_path / "run")
    drops = run.parcels[max(run.parcels)]
    mass = np.sum(drops["count"] * drops["density"] * np.pi / 6.0 * drops["diameter"] ** 3)
    vapour = np.sum(last(run)["vapour_mass_fraction"] * 1.225 * run.volumes)
    assert vapour > 1e-4  # kg
    assert mass + vapour == pytest.approx(0.02 * 0.6 * 700.0 * 10.0 * 0.5, rel=1e-6)
    assert 0.19 < drops["position"][:, 0].max() < 0.202 and drops["position"].shape[1] == 3
    assert drops["velocity"][:, 0].max() < 10.5
    assert run.history["evaporated_kg"][-1] == pytest.approx(vapour, rel=1e-3)
    assert run.history["injected_kg"][-1] == pytest.approx(mass + vapour, rel=1e-6)


def test_what_cannot_be_run_says_so(tmp_path):
    with pytest.raises(CaseError, match="equation_of_state"):
        comparators.run_two_fluid(disc("gas.equation_of_state='ideal'"), tmp_path / "ideal")
    with pytest.raises(CaseError, match="no OpenFOAM reference of kind 'tfm'"):
        comparators.template(cases.load(scenes.find("spray_cone")[1]), "tfm")
    with pytest.raises(CaseError, match="neither evaporation nor inflow"):
        comparators.run_droplets(disc(), tmp_path / "disc")
    with pytest.raises(CaseError, match="takes no blanks.*; the reference is.*: move the run to a path without them$"):
        comparators.run_two_fluid(disc(), tmp_path / "with a blank")
    assert not (tmp_path / "with a blank").exists()
    (tmp_path / "empty").mkdir()
    with pytest.raises(GasError, match="blockMesh ended with code 1.*log"):
        programs.run(["blockMesh"], tmp_path / "empty", tmp_path / "log.blockMesh")


def test_closures_library_is_built_once():
    assert install.two_fluid_closures().exists()
    assert install.two_fluid_closures(status=pytest.fail) == install.two_fluid_closures()


def test_a_reference_comes_back_as_it_was_kept(tmp_path):
    kept = reference.Reference(
        solver="some", wall=1.5, centres=np.zeros((2, 3)), volumes=np.ones(2),
        fields={0.1: {"alpha_p": np.array([0.1, 0.2])}}, history={"time_s": np.array([0.0])},
        parcels={0.1: {"diameter": np.array([1e-3])}},
    )  # fmt: skip
    reference.keep(kept, tmp_path / "shelf" / "some.npz")
    back = reference.load(tmp_path / "shelf" / "some.npz")
    assert (back.solver, back.wall, back.nearest(0.3)) == ("some", 1.5, 0.1)
    assert np.array_equal(back.fields[0.1]["alpha_p"], [0.1, 0.2]) and np.array_equal(
        back.parcels[0.1]["diameter"], [1e-3]
    )
    assert np.array_equal(back.centres, kept.centres) and np.array_equal(back.history["time_s"], [0.0])
