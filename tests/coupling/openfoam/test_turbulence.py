"""Turbulence in sdphGasFoam: what its eddy viscosity does to heat and vapour, voidage, restart, files, and refusals."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
from gas_boxes import AIR, box, box_case, template

from coupling import choice
from coupling.gas import GasError
from coupling.openfoam.block_mesh import block_mesh
from coupling.openfoam.solver import OpenFoamGas
from coupling.openfoam.start_fields import start_fields
from coupling.transport.messages import decode
from sdph.schema import CaseError

RHO, CP, K = AIR["density_kg_m3"], AIR["heat_capacity_J_kg_K"], AIR["conductivity_W_m_K"]
SLIP = {"walls": {"kind": "slip_wall"}}
STILL = {"model": "kEpsilon", "k_m2_s2": 0.02, "epsilon_m2_s3": 0.03, "schmidt_number": 0.6, "prandtl_number": 0.8}
NUT = 0.09 * 0.02**2 / 0.03  # m2/s, of that
VAPOUR = {
    "molar_mass_kg_kmol": 28.96, "diffusivity_m2_s": 2e-5, "heat_capacity_J_kg_K": CP,
    "conductivity_W_m_K": K, "viscosity_Pa_s": AIR["viscosity_Pa_s"],
}  # fmt: skip
BLOWN = {
    "inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [2.0, 0.0]},
    "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "slide": {"kind": "slip_wall", "side": "top"},
    "walls": {"kind": "wall"},
}
MODELS = {
    "kEpsilon": {"model": "kEpsilon", "mixing_length_m": 0.003},
    "kOmegaSST": {"model": "kOmegaSST", "mixing_length_m": 0.003},
    "WALE": {"model": "WALE"},
}
TURBULENT = ("k", "epsilon", "omega", "nut")


def remembered(gas, folder):
    """Fields of a checkpoint of one rank."""
    gas.checkpoint(folder)
    return decode((folder / "gas.0").read_bytes()).values


def implicit(before, content, conductance, width, dt):
    """A step of conduction along a row of cells: content dT/dt = conductance d2T/dx2, no flux through the ends."""
    n = len(before)
    second = np.diag(np.full(n, 2.0)) - np.eye(n, k=1) - np.eye(n, k=-1)
    second[0, 0] = second[-1, -1] = 1.0
    return np.linalg.solve(np.eye(n) * content / dt + conductance / width**2 * second, before * content / dt)


def in_cells(text, values):
    rows = " ".join(map(repr, values.tolist()))
    inside = f"internalField nonuniform List<scalar> {len(values)} ({rows});"
    return re.sub(r"internalField uniform [^;]*;", inside, text)


@pytest.mark.openfoam
def test_heat_and_vapour_diffuse_with_the_eddy_viscosity(tmp_path):
    """One step of still gas of voidage 0.7, in closed form: k + cp rho nut/Pr_t and D + nut/Sc_t."""
    case = box_case((0.2, 0.01), 0.01, boundaries=SLIP, vapour=VAPOUR, turbulence=STILL)
    x, dt = np.arange(20) / 20.0, 0.02
    first = {"T": 300.0 + 40.0 * (x > 0.4), "Y": 0.1 * (x > 0.6)}
    own = template(tmp_path)
    (own / "0").mkdir()
    for name, values in first.items():
        (own / "0" / name).write_text(in_cells(start_fields(case)[name], values))
    gas = OpenFoamGas(case, tmp_path / "gas", own)
    try:
        gas.start(np.full(20, 0.7), ())
        state = gas.advance(dt, {})
    finally:
        gas.close()
    heat = implicit(first["T"], 0.7 * RHO * CP, 0.7 * (K + CP * RHO * NUT / 0.8), 0.01, dt)
    vapour = implicit(first["Y"], RHO, RHO * (2e-5 + NUT / 0.6), 0.01, dt)
    assert np.abs(heat - first["T"]).max() > 5.0 and np.abs(vapour - first["Y"]).max() > 0.01  # they have moved
    assert state.fields["temperature"] == pytest.approx(heat, rel=1e-12)
    assert state.fields["vapour_mass_fraction"] == pytest.approx(vapour, rel=1e-11, abs=1e-14)


@pytest.mark.openfoam
def test_turbulence_of_still_gas_decays_whatever_its_room(tmp_path):
    """Uniform k and epsilon in a closed box whose voidage falls: the implicit steps of dk/dt = -epsilon and
    d epsilon/dt = -1.92 epsilon^2/k, by hand."""
    dt, k, epsilon = 5e-3, 0.02, 0.3
    with box(tmp_path, (0.04, 0.04), 0.01, boundaries=SLIP, turbulence=STILL | {"epsilon_m2_s3": epsilon}) as gas:
        gas.start(np.full(16, 0.9), ("alpha_g",))
        assert remembered(gas, tmp_path / "first")["nut"] == pytest.approx(0.09 * k**2 / epsilon, rel=1e-12)
        for step in range(1, 6):
            gas.advance(dt, {"alpha_g": np.full(16, 0.9 - 0.05 * step)})
            epsilon, rate = epsilon / (1.0 + dt * 1.92 * epsilon / k), k
            k = k / (1.0 + dt * epsilon / rate)
        found = remembered(gas, tmp_path / "kept")
    assert found["epsilon"] == pytest.approx(epsilon, rel=1e-7)
    assert found["k"] == pytest.approx(k, rel=1e-7)
    assert found["nut"] == pytest.approx(0.09 * k**2 / epsilon, rel=1e-7)


@pytest.mark.openfoam
@pytest.mark.parametrize("model", MODELS)
def test_a_restart_goes_on_bit_for_bit(tmp_path, model):
    """From a checkpoint in another process, and after a step that is taken back."""
    args = (0.1, 0.05), 0.01
    with box(tmp_path / "one", *args, boundaries=BLOWN, turbulence=MODELS[model]) as gas:
        gas.start(None, ())
        for _ in range(3):
            gas.advance(2e-3, {})
        gas.checkpoint(tmp_path / "kept")
        gas.advance(3e-3, {})
        gas.retreat()
        for _ in range(3):
            gas.advance(2e-3, {})
        expected = remembered(gas, tmp_path / "end")
    with box(tmp_path / "two", *args, boundaries=BLOWN, turbulence=MODELS[model]) as gas:
        gas.restore(tmp_path / "kept")
        for _ in range(3):
            gas.advance(2e-3, {})
        found = remembered(gas, tmp_path / "again")
    names = [name for name in expected if name.partition(".")[0] in TURBULENT]
    assert len([name for name in names if "." not in name]) == (1 if model == "WALE" else 3)
    assert np.ptp(expected["nut"]) > 0.0
    for name in ("U", "p_rgh", "T", *names):
        assert np.array_equal(found[name], expected[name]), name


@pytest.mark.openfoam
def test_what_openfoam_lifts_to_its_bound_is_counted(tmp_path):
    """Jumps of k, carried without a limiter, undershoot: in steps in which OpenFOAM's log says so, and in no other."""
    case = box_case((0.2, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["kEpsilon"])
    own = template(tmp_path)
    schemes = own / "system" / "fvSchemes"
    schemes.write_text(schemes.read_text().replace("limitedLinear 1", "linear"))
    (own / "0").mkdir()
    k = np.where(np.arange(100) % 20 < 10, 1e-4, 0.02)
    for name, values in {"k": k, "epsilon": 0.09**0.75 * k**1.5 / 0.003}.items():
        (own / "0" / name).write_text(in_cells(start_fields(case)[name], values))
    gas = OpenFoamGas(case, tmp_path / "gas", own)
    try:
        states = [gas.start(None, ()), *(gas.advance(3e-3, {}) for _ in range(20))]
    finally:
        gas.close()
    counted = [state.budget.held["gas_turbulence_bounded_rel"] for state in states]
    log = (tmp_path / "gas" / "log.sdphGasFoam").read_text().split("\nTime = ")
    lowest = [min(map(float, re.findall(r"bounding \w+, min: (\S+)", step)), default=0.0) for step in log]
    print(counted, lowest)
    assert [share > 0.0 for share in counted] == [low < 0.0 for low in lowest]
    assert any(counted) and not all(counted) and max(counted) < 0.1


@pytest.mark.openfoam
def test_another_model_in_the_folder_is_refused(tmp_path):
    own = template(tmp_path)
    (own / "constant" / "turbulenceProperties").write_text(
        "FoamFile { version 2.0; format ascii; class dictionary; object turbulenceProperties; }\n"
        "simulationType RAS; RAS { RASModel kEpsilon; turbulence on; printCoeffs on; }\n"
    )
    # with the fields of kEpsilon too, as of a folder of that model
    turned = {"model": "kEpsilon", "mixing_length_m": 0.003}
    (own / "0").mkdir()
    for name in ("k", "epsilon"):
        text = start_fields(box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=turned))[name]
        (own / "0" / name).write_text(text)
    case = box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["kOmegaSST"])
    with pytest.raises(GasError, match="turbulenceProperties has the model kEpsilon; .* kOmegaSST: make them the same"):
        OpenFoamGas(case, tmp_path / "gas", own)


@pytest.mark.openfoam
def test_a_laminar_gas_has_none_of_it(tmp_path):
    for name, given in {"left out": {}, "laminar": {"turbulence": {"model": "laminar"}}}.items():
        with box(tmp_path / name.replace(" ", ""), (0.04, 0.04), 0.01, **given) as gas:
            state = gas.start(None, ())
            assert "urbulence" not in Path(f"/proc/{gas._process.pid}/maps").read_text()
            assert not {"k", "nut"} & remembered(gas, tmp_path / f"{name[0]}kept").keys()
            assert "gas_turbulence_bounded_rel" not in state.budget.held
            assert not (gas.case_folder / "constant/turbulenceProperties").exists()


def conditions(case, name, others=None):
    text = start_fields(case, others)[name]
    return dict(re.findall(r"^    (\w+) \{ type (\w+)", text, re.MULTILINE))


def test_each_side_has_its_conditions():
    case = box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["kEpsilon"])
    others = {"grate": "wall", "frontAndBack": "empty"}
    expected = {
        "k": ("fixedValue", "inletOutlet", "zeroGradient", "kqRWallFunction"),
        "epsilon": ("fixedValue", "inletOutlet", "zeroGradient", "epsilonWallFunction"),
        "nut": ("calculated", "calculated", "zeroGradient", "nutkWallFunction"),
    }
    for name, kinds in expected.items():
        sides = dict(zip(("inlet", "outlet", "slide", "walls"), kinds))
        assert conditions(case, name, others) == sides | {"grate": kinds[3], "frontAndBack": "empty"}
    omega = box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["kOmegaSST"])
    assert conditions(omega, "omega")["walls"] == "omegaWallFunction"
    wale = box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["WALE"])
    assert conditions(wale, "nut")["walls"] == "nutUSpaldingWallFunction"
    assert not {"k", "epsilon", "omega"} & start_fields(wale).keys()
    assert "value uniform 0.015000000000000003" in start_fields(case)["k"]  # 1.5 (0.05 x 2)^2


def test_a_slip_wall_is_no_wall_that_distance_is_taken_to():
    text = block_mesh(box_case((0.1, 0.05), 0.01, boundaries=BLOWN), 1.0)
    assert re.search(r"slide \{ type patch;", text) and re.search(r"walls \{ type wall;", text)


def test_the_embedded_gas_refuses_turbulence(tmp_path):
    case = box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["WALE"])
    case = dataclasses.replace(case, coupling=dataclasses.replace(case.coupling, gas="embedded"))
    for asked in (choice.expected, lambda one: choice.open_gas(one, tmp_path, None, print)):
        with pytest.raises(CaseError, match='turbulence.model = "WALE", but the embedded gas is laminar; give --gas'):
            asked(case)


@pytest.mark.openfoam
@pytest.mark.parametrize(("line", "told"), [
    ("gas_turbulence_model laminar;", "gas_turbulence_model = laminar; case.toml has kEpsilon: make them the same"),
    ("gas_turbulence_schmidt_number 0.5;", "gas_turbulence_schmidt_number = 0.5; case.toml has 0.7: make them"),
])  # fmt: skip
def test_properties_that_differ_from_the_case_are_refused(tmp_path, line, told):
    own = template(tmp_path)
    with (own / "constant" / "gasProperties").open("a") as file:
        file.write(f"\n{line}\n")
    with pytest.raises(CaseError, match=re.escape(told)):
        OpenFoamGas(box_case((0.1, 0.05), 0.01, boundaries=BLOWN, turbulence=MODELS["kEpsilon"]), tmp_path / "gas", own)
