"""sdphGasFoam as a process: transports and ranks agree, checkpoints go on bit for bit, failures are told and leave
nothing."""

import os
import re
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest
from gas_boxes import TEMPLATE, WALLS, box, box_case, total

from coupling.gas import CheckpointError, GasError, Unfinished
from coupling.openfoam.programs import install
from coupling.openfoam.programs.build import header_folder
from coupling.openfoam.solver import OpenFoamGas
from coupling.transport.messages import Kind, Message, decode, encode
from sdph.schema import CaseError

pytestmark = pytest.mark.openfoam

SOURCES = ("alpha_g", "momentum_coefficient", "momentum", "heat_coefficient", "heat")
INLET = {
    "inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [0.5, 0.0], "temperature_K": 320.0},
    "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "walls": {"kind": "wall"},
}


def busy_sources(gas, step):
    x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
    alpha = 1.0 - 0.4 * np.exp(-((x - 0.04 - 0.001 * step) ** 2 + (y - 0.03) ** 2) / 0.01**2)
    drag, heat = 200.0 * (1 - alpha), 1e5 * (1 - alpha)
    pull = drag[:, None] * [0.3, 0.1, 0.0]
    return {
        "alpha_g": alpha,
        "momentum_coefficient": drag,
        "momentum": pull,
        "heat_coefficient": heat,
        "heat": heat * 290.0,
    }


def busy(gas, steps, begin=0):
    """Some steps with all that moves and heats; the states of each."""
    return [gas.advance(1e-3, busy_sources(gas, step)) for step in range(begin + 1, begin + steps + 1)]


def started(gas):
    gas.start(busy_sources(gas, 0)["alpha_g"], SOURCES)
    return gas


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
    """After a step that could be finished, and after one that could not: as if neither had been tried."""
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
        after = busy(gas, 3, begin=3)
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


def alive(pids):
    return [
        pid for pid in pids if os.path.exists(f"/proc/{pid}") and " Z " not in Path(f"/proc/{pid}/stat").read_text()
    ]


def wait_for_end(pids, seconds=2.0):
    deadline = time.monotonic() + seconds
    while alive(pids) and time.monotonic() < deadline:
        time.sleep(0.02)
    return alive(pids)


@pytest.mark.parametrize("ranks, transport", [(1, "socket"), (1, "file"), (2, "socket"), (2, "file")])
def test_a_killed_solver_is_told_within_two_seconds_and_nothing_stays(tmp_path, ranks, transport):
    with box(tmp_path, (0.1, 0.06), 0.005, ranks=ranks, transport=transport) as gas:
        started(gas)
        busy(gas, 1)
        pids = solver_processes(gas)
        assert len(pids) == ranks
        os.kill(pids[-1], signal.SIGKILL)
        begin = time.monotonic()
        with pytest.raises(GasError, match=r"sdphGasFoam .*log: .*log\.sdphGasFoam") as told:
            busy(gas, 3)
        assert time.monotonic() - begin < 2.0
        assert "residual" not in str(told.value) and "---" not in str(told.value)
        assert not wait_for_end(pids)
    assert not list((tmp_path / "gas").glob("*exchange-*"))


def solver_processes(gas):
    """The ranks, wherever mpirun put them."""
    found = subprocess.run(["pgrep", "-f", f"sdphGasFoam -case {gas._folder} "], capture_output=True, text=True)
    pids = [int(pid) for pid in found.stdout.split()]
    return [pid for pid in pids if Path(f"/proc/{pid}/comm").read_text().strip() == "sdphGasFoam"]


@pytest.mark.parametrize("ranks", [1, 2])
def test_one_sigterm_ends_a_run_whose_gas_hangs(tmp_path, ranks):
    """Within 10 s, with the exit code of the signal; nothing stays behind."""
    settings = ("resolution.spacing_mm=20", "resolution.cell_mm=50", f"coupling.gas_ranks={ranks}")
    quick = [word for setting in settings for word in ("--set", setting)]
    command = [
        sys.executable,
        "-m",
        "sdph.cli",
        "run",
        "disc_cluster",
        "--gas",
        "openfoam",
        "--out",
        str(tmp_path / "run"),
        *quick,
    ]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while not (tmp_path / "run" / "ledger.csv").is_file() or len((tmp_path / "run" / "ledger.csv").read_bytes()) < 500:
        time.sleep(0.1)
        assert process.poll() is None
    found = subprocess.run(["pgrep", "-f", f"sdphGasFoam -case {tmp_path}/run/gas "], capture_output=True, text=True)
    pids = [int(pid) for pid in found.stdout.split()]
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=10.0)
    assert process.returncode == 128 + signal.SIGTERM and "stopped by SIGTERM" in said.splitlines()[-1]
    assert not wait_for_end(pids)


@pytest.mark.parametrize("ranks, transport", [(1, "socket"), (2, "file")])
def test_the_solver_ends_when_the_particles_are_killed(tmp_path, ranks, transport):
    script = f"""
        import sys, time
        sys.path.insert(0, {str(Path(__file__).parent)!r})
        from pathlib import Path
        from gas_boxes import TEMPLATE, box_case
        from coupling.openfoam.solver import OpenFoamGas
        case = box_case((0.1, 0.06), 0.005, ranks={ranks}, transport={transport!r})
        gas = OpenFoamGas(case, Path({str(tmp_path)!r}) / "gas", TEMPLATE)
        gas.start(None, ())
        print("ready", flush=True)
        time.sleep(60)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    found = subprocess.run(["pgrep", "-f", "--", f"-case {tmp_path}/gas "], capture_output=True, text=True)
    pids = [int(pid) for pid in found.stdout.split()]
    assert len(pids) == (1 if ranks == 1 else 1 + ranks)
    process.kill()
    left = wait_for_end(pids, 3.0)
    process.wait()
    process.stdout.close()
    assert not left


def test_close_leaves_nothing(tmp_path):
    with box(tmp_path, (0.1, 0.06), 0.005, ranks=2) as gas:
        gas.start(None, ())
        pids = solver_processes(gas)
    assert len(pids) == 2
    assert not wait_for_end(pids)
    gas.close()
    with pytest.raises(GasError, match="closed"):
        gas.advance(1e-3, {})


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


def test_waiting_is_told(tmp_path):
    told = []
    gas = OpenFoamGas(box_case((0.1, 0.06), 0.005), tmp_path / "gas", TEMPLATE, status=told.append)
    try:
        gas.start(None, ())
        os.kill(gas._process.pid, signal.SIGSTOP)
        waker = subprocess.Popen(["sh", "-c", f"sleep 2.6; kill -CONT {gas._process.pid}"])
        gas.advance(1e-3, {})
        waker.wait()
    finally:
        gas.close()
    assert any(line.startswith("waiting for sdphGasFoam, 2 s, log: ") for line in told)


@pytest.fixture(scope="module")
def wire_echo(tmp_path_factory):
    """The C++ side of the wire format alone: reads a message, writes it again."""
    folder = tmp_path_factory.mktemp("wire")
    (folder / "echo.C").write_text("""
        #include "wire.H"
        #include <iostream>
        #include <iterator>
        int main()
        {
            const std::string in((std::istreambuf_iterator<char>(std::cin)), std::istreambuf_iterator<char>());
            try
            {
                std::cout << wire::encode(wire::decode(in, wire::absoluteLimit));
                return 0;
            }
            catch (const wire::Error& error) { std::cerr << error.what(); return 3; }
        }
    """)
    program = folder / "echo"
    flags = ["-std=c++14", "-O1", "-Wall", "-Werror", f"-I{install.GAS_SOLVER}"]
    subprocess.run(["g++", *flags, str(folder / "echo.C"), "-o", str(program)], check=True)
    return lambda data: subprocess.run([program], input=data, capture_output=True)


def test_both_languages_mean_the_same_format(wire_echo):
    message = Message(
        Kind.STATE,
        {
            "a": np.arange(12.0).reshape(4, 3),
            "b": 7,
            "c": "wärme",
            "d": np.float64(0.1),
            "e": np.zeros((0, 3)),
            "f": "",
        },
        {"a": "m/s"},
    )
    echoed = decode(wire_echo(encode(message)).stdout)
    assert encode(echoed) == encode(message)
    rng = np.random.default_rng(3)
    data = encode(message)
    for _ in range(200):
        damaged = bytearray(data)
        damaged[rng.integers(len(data))] ^= int(rng.integers(1, 256))
        done = wire_echo(bytes(damaged[: rng.integers(len(data) + 1)] if rng.random() < 0.5 else damaged))
        assert done.returncode in (0, 3)
        if done.returncode == 0:
            assert done.stdout[6:8] != data[6:8]  # only the kind lies outside the checksum


def test_the_last_word_of_a_header_is_named_by_cpp_too(wire_echo):
    data = encode(Message(Kind.DONE))
    done = wire_echo(data[:20] + b"\x07\0\0\0" + data[24:])
    assert done.returncode == 3 and b"the last word of its header is 7; one of sdph has 0" in done.stderr


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
