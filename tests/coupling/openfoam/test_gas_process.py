"""sdphGasFoam as a process: transports and ranks agree, checkpoints go on bit for bit, failures are told and leave
nothing."""

import re

import numpy as np
import pytest
from busy_gas import SOURCES, busy, busy_sources, started
from gas_boxes import TEMPLATE, WALLS, box, box_case, total

from coupling.gas import CheckpointError, GasError, Unfinished
from coupling.openfoam.programs import install
from coupling.openfoam.programs.build import header_folder
from coupling.openfoam.solver import OpenFoamGas
from coupling.transport.messages import Message, decode, encode
from sdph.schema import CaseError

pytestmark = pytest.mark.openfoam
INLET = {
    "inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [0.5, 0.0], "temperature_K": 320.0},
    "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "walls": {"kind": "wall"},
}


def same(a, b):
    return (
        a.time == b.time
        and a.budget == b.budget
        and all(a.fields[k].tobytes() == b.fields[k].tobytes() for k in a.fields)
    )


def run_busy(folder, **kwargs):
    with box(folder, (0.1, 0.06), 0.005, boundaries=INLET, **kwargs) as gas:
        return gas.mesh, busy(started(gas), 8)


def test_socket_and_files_agree_bit_for_bit(tmp_path):
    _, by_socket = run_busy(tmp_path / "a")
    _, by_file = run_busy(tmp_path / "b", transport="file")
    assert len(by_socket) == 8
    assert all(same(a, b) for a, b in zip(by_socket, by_file))
    assert not list((tmp_path / "b" / "gas").glob("*exchange-*"))


def test_one_and_two_ranks_agree(tmp_path):
    """To the tolerance of the pressure solver, whose multigrid is another on two ranks; what is conserved, to
    round-off."""
    one_mesh, one = run_busy(tmp_path / "a")
    two_mesh, two = run_busy(tmp_path / "b", ranks=2)
    a, b = (np.lexsort(mesh.centres.round(9).T) for mesh in (one_mesh, two_mesh))
    assert np.allclose(one_mesh.centres[a], two_mesh.centres[b], atol=1e-12)
    for name in one[-1].fields:
        scale = np.abs(one[-1].fields[name]).max()
        assert np.allclose(one[-1].fields[name][a], two[-1].fields[name][b], rtol=0, atol=1e-5 * scale), name
    assert two[-1].budget.mass == pytest.approx(one[-1].budget.mass, rel=1e-9)
    assert two[-1].budget.energy == pytest.approx(one[-1].budget.energy, rel=1e-9)


@pytest.mark.parametrize("ranks", [1, 2])
def test_ranks_and_files_conserve_energy_too(tmp_path, ranks):
    with box(tmp_path, (0.1, 0.06), 0.005, boundaries=INLET, transport="file", ranks=ranks) as gas:
        first = started(gas).advance(1e-3, busy_sources(gas, 1)).budget
        given = 0.0
        for step in range(2, 20):
            sources = busy_sources(gas, step)
            state = gas.advance(1e-3, sources)
            given += 1e-3 * total(gas, sources["heat"] - sources["heat_coefficient"] * state.fields["temperature"])
    change = state.budget.energy - first.energy - (state.budget.energy_in - first.energy_in)
    change -= state.budget.pressure_work - first.pressure_work
    assert abs(change - given) < 1e-9 * abs(given)


@pytest.mark.parametrize("ranks, equation", [(1, "constant"), (2, "constant"), (1, "ideal")])
def test_a_retreat_goes_back_bit_for_bit(tmp_path, ranks, equation):
    """After steps that could be finished, could not, and were not begun: as if none of them had been tried."""
    options = {"boundaries": INLET, "ranks": ranks, "equation_of_state": equation}
    with box(tmp_path / "a", (0.1, 0.06), 0.005, **options) as gas:
        expected = busy(started(gas), 6)
    with box(tmp_path / "b", (0.1, 0.06), 0.005, **options) as gas:
        began = busy(started(gas), 3)
        gas.advance(5e-3, busy_sources(gas, 9))
        back = gas.retreat()
        assert back.time == began[-1].time
        assert all(back.fields[name].tobytes() == began[-1].fields[name].tobytes() for name in back.fields)
        frozen = busy_sources(gas, 4) | {"heat": np.full(len(gas.mesh.volumes), -1e12)}
        with pytest.raises(Unfinished, match="temperature is .* in cell|residual of T is not a number"):
            gas.advance(1e-3, frozen)
        gas.retreat()
        after = busy(gas, 1, begin=3)
        full = busy_sources(gas, 5) | {"alpha_g": np.full(len(gas.mesh.volumes), -0.1)}  # refused before it is sent
        with pytest.raises(Unfinished, match="over-packed"):
            gas.advance(1e-3, full)
        assert gas.retreat() is after[-1]
        after += busy(gas, 2, begin=4)
    assert all(same(a, b) for a, b in zip(after, expected[3:], strict=True))


@pytest.mark.parametrize("ranks, equation", [(1, "constant"), (2, "constant"), (1, "ideal")])
def test_a_checkpoint_goes_on_bit_for_bit(tmp_path, ranks, equation):
    options = {"boundaries": INLET, "ranks": ranks, "equation_of_state": equation}
    with box(tmp_path / "a", (0.1, 0.06), 0.005, **options) as gas:
        busy(started(gas), 4)
        gas.checkpoint(tmp_path / "checkpoint")
        expected = busy(gas, 4, begin=4)
    with box(tmp_path / "b", (0.1, 0.06), 0.005, **options) as gas:
        restored = gas.restore(tmp_path / "checkpoint")
        assert restored.time == pytest.approx(4e-3)
        assert all(same(a, b) for a, b in zip(expected, busy(gas, 4, begin=4)))


def test_a_checkpoint_of_many_patches_is_read_again(tmp_path):
    """A mesh from snappyHexMesh may well have forty."""
    spans = {
        f"tile_{k}": {"kind": "wall", "side": "top", "span_m": [k / 200.0, (k + 1) / 200.0]} for k in range(40)
    } | WALLS
    options = ((0.2, 0.02), 0.005)
    with box(tmp_path / "a", *options, boundaries=spans) as gas:
        gas.start(None, ("heat",))
        gas.checkpoint(tmp_path / "checkpoint")
        expected = gas.advance(1e-3, {"heat": np.full(len(gas.mesh.volumes), 1e5)})
    with box(tmp_path / "b", *options, boundaries=spans) as gas:
        gas.restore(tmp_path / "checkpoint")
        assert same(expected, gas.advance(1e-3, {"heat": np.full(len(gas.mesh.volumes), 1e5)}))


def test_a_checkpoint_of_other_ranks_is_refused(tmp_path):
    with box(tmp_path / "a", (0.1, 0.06), 0.005) as gas:
        gas.start(None, ())
        gas.checkpoint(tmp_path / "checkpoint")
    with box(tmp_path / "b", (0.1, 0.06), 0.005, ranks=2) as gas, pytest.raises(GasError, match="of 1 ranks"):
        gas.restore(tmp_path / "checkpoint")


@pytest.mark.parametrize("rank", [0, 1])
def test_a_damaged_file_of_one_rank_is_told_by_all(tmp_path, rank):
    with box(tmp_path / "a", (0.1, 0.06), 0.005, ranks=2) as gas:
        gas.start(None, ())
        gas.checkpoint(tmp_path / "checkpoint")
    path = tmp_path / "checkpoint" / f"gas.{rank}"
    path.write_bytes(path.read_bytes()[:-1])
    with (
        box(tmp_path / "b", (0.1, 0.06), 0.005, ranks=2) as gas,
        pytest.raises(CheckpointError, match=f"gas.{rank}: .*damaged"),
    ):
        gas.restore(tmp_path / "checkpoint")


@pytest.mark.parametrize(
    ("harm", "says"),
    [
        ({"T": lambda a: a * np.nan}, "T is nan"),
        ({"alpha_g": lambda a: a - 1.0}, "alpha_g is 0"),
        ({"U": lambda a: a + 1e300}, "U is 1e?"),
        ({"p_rgh": lambda a: a[:-1]}, "p_rgh does not have the shape"),
        ({"numbers": lambda a: a - 1.0}, "time -1"),
    ],
)
def test_values_that_no_gas_has_are_refused(tmp_path, harm, says):
    with box(tmp_path / "a", (0.1, 0.06), 0.005) as gas:
        gas.start(None, ())
        gas.checkpoint(tmp_path / "checkpoint")
    path = tmp_path / "checkpoint" / "gas.0"
    message = decode(path.read_bytes())
    values = dict(message.values) | {name: change(message[name]) for name, change in harm.items()}
    path.write_bytes(encode(Message(message.kind, values, message.units)))
    with box(tmp_path / "b", (0.1, 0.06), 0.005) as gas, pytest.raises(CheckpointError, match=says):
        gas.restore(tmp_path / "checkpoint")


def test_a_checkpoint_of_other_sources_is_refused(tmp_path):
    with box(tmp_path / "a", (0.1, 0.06), 0.005) as gas:
        gas.start(None, ("heat",))
        gas.checkpoint(tmp_path / "checkpoint")
    with box(tmp_path / "b", (0.1, 0.06), 0.005) as gas, pytest.raises(CheckpointError, match="of the sources 'heat'"):
        gas.restore(tmp_path / "checkpoint", SOURCES)


def test_time_folders_are_written_at_the_output_interval(tmp_path):
    import dataclasses

    case = box_case((0.02, 0.02), 0.005)
    case = dataclasses.replace(case, run=dataclasses.replace(case.run, output_interval=2e-3))
    gas = OpenFoamGas(case, tmp_path / "gas", TEMPLATE)
    try:
        gas.start(None, ())
        for _ in range(5):
            gas.advance(1e-3, {})
    finally:
        gas.close()
    times = sorted(path.name for path in (tmp_path / "gas").iterdir() if path.name[0].isdigit())
    assert times == ["0", "0.002", "0.004"]
    assert {"T", "U", "p", "p_rgh", "alpha_g", "rho"} <= {path.name for path in (tmp_path / "gas" / "0.004").iterdir()}


@pytest.mark.parametrize("name, value, says", [
    ("heat_coefficient", np.nan, "heat_coefficient is nan in cell 7 at"),
    ("momentum_coefficient", -1.0, "momentum_coefficient is -1 in cell 7 at"),
    ("alpha_g", 0.0, "alpha_g is 0 in cell 7 at"),
    ("momentum", np.inf, "momentum is inf in cell 7 at"),
])  # fmt: skip
def test_an_impossible_source_is_named_with_its_cell(tmp_path, name, value, says):
    with box(tmp_path, (0.1, 0.06), 0.005) as gas:
        sources = busy_sources(started(gas), 1)
        sources[name] = np.array(sources[name])
        sources[name][7] = value
        with pytest.raises(GasError, match=says):
            gas.advance(1e-3, sources)


@pytest.mark.parametrize("dt, given", [(9e15, "9e+15"), (0.0, "0"), (-1e-3, "-0.001"), (np.nan, "nan")])
def test_a_step_that_cannot_be_is_told_with_what_is_allowed(tmp_path, dt, given):
    with (
        box(tmp_path, (0.1, 0.06), 0.005) as gas,
        pytest.raises(GasError, match=re.escape(f"dt is {given} s; it must be above 0 and below 1e+15 s: choose")),
    ):
        started(gas)._clock.writes = lambda time: False
        gas.advance(dt, busy_sources(gas, 1))


def test_a_source_of_the_wrong_shape_or_name_is_refused(tmp_path):
    with box(tmp_path / "a", (0.1, 0.06), 0.005) as gas:
        gas.start(None, ("heat",))
        with pytest.raises(GasError, match="heat does not have the shape of the mesh"):
            gas.advance(1e-3, {"heat": np.zeros(3)})
    with box(tmp_path / "b", (0.1, 0.06), 0.005) as gas, pytest.raises(GasError, match="unknown source heaat"):
        gas.start(None, ("heaat",))


def test_a_field_that_blows_up_is_named(tmp_path):
    with box(tmp_path, (0.1, 0.06), 0.005) as gas:
        gas.start(None, ("heat",))
        with pytest.raises(GasError, match="temperature is .* in cell"):
            gas.advance(1.0, {"heat": np.full(len(gas.mesh.volumes), -1e9)})


def test_fatal_errors_of_openfoam_are_told(tmp_path):
    template = tmp_path / "template"
    box_template(template)
    schemes = (template / "system" / "fvSchemes").read_text()
    (template / "system" / "fvSchemes").write_text(schemes.replace("vanLeer", "noSuchScheme"))
    gas = OpenFoamGas(box_case((0.1, 0.06), 0.005, boundaries=INLET), tmp_path / "gas", template)
    with pytest.raises(GasError, match="noSuchScheme.*log: "):
        busy(started(gas), 1)
    with pytest.raises(GasError, match="closed"):
        gas.advance(1e-3, {})


def box_template(folder):
    import shutil

    shutil.copytree(TEMPLATE, folder)


def test_a_case_without_a_field_says_which(tmp_path):
    template = tmp_path / "template"
    box_template(template)
    (template / "constant" / "gasProperties").unlink()
    with pytest.raises(GasError, match="gasProperties"):
        OpenFoamGas(box_case((0.1, 0.06), 0.005, boundaries=WALLS), tmp_path / "gas", template)


def test_another_gas_than_that_of_the_case_is_refused(tmp_path):
    template = tmp_path / "template"
    box_template(template)
    with (template / "constant" / "gasProperties").open("a") as file:
        file.write("gas_density 1.3;\n")
    with pytest.raises(CaseError, match="gas_density = 1.3; case.toml has 1.2"):
        OpenFoamGas(box_case((0.1, 0.06), 0.005), tmp_path / "gas", template)


def test_nothing_is_built_twice():
    installation = install.require()
    assert (
        installation.wmake or (header_folder(installation) / "src" / "finiteVolume" / "lnInclude" / "fvMesh.H").exists()
    )
    products = [install.gas_solver(), install.two_fluid_closures(), install.code_guard()]
    before = [path.stat().st_mtime_ns for path in products]
    said = []
    install.setup(status=said.append)
    assert [path.stat().st_mtime_ns for path in products] == before
    assert not [line for line in said if "compiling" in line or "fetching" in line]
    assert all(row.found for row in install.doctor())
