"""Inlets whose velocity changes in time: what comes in is the integral of the rows in both gases, windows end at the
rows, a run goes on across them bit for bit, and what is no table is refused in one line."""

import re
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from gas_boxes import box, box_case
from hypothesis import given
from hypothesis import strategies as st
from test_restart import Cut, Reporter, load, same_run, start

from coupling.embedded import EmbeddedGas
from coupling.openfoam import start_fields
from coupling.openfoam.comparators import droplet_fields, two_fluid_fields, two_fluid_numbers
from sdph.case import inlets
from sdph.case.sections import Boundary
from sdph.exchange.window import Window, opening
from sdph.methods.grains import ways
from sdph.running import driver
from sdph.schema import CaseError
from sdph.study.closed_vessels import refuse_filling

SIZE, CELL, DENSITY = (0.2, 0.04), 0.02, 1.2
ROWS = [[0.01, 0.0, 0.0], [0.012, 0.5, 0.0], [0.03, 0.3, 0.0], [0.031, 0.0, 0.0], [0.05, 0.0, 0.0], [0.09, 0.9, 0.0]]
AREA = 2.0 * (0.001 * 0.5 + 0.018 * 0.4 + 0.0005 * 0.3 + 0.04 * 0.45 + 0.01 * 0.9)  # integral up to 0.1 s, m, twice
openfoam = pytest.param("openfoam", marks=pytest.mark.openfoam)


def channel(rows=ROWS, **inlet):
    """Plug flow between walls that slip, hotter and with another speed as `rows` say."""
    own = {"kind": "velocity_inlet", "side": "left", "velocities": rows, "temperature_K": 350.0} | inlet
    return {"inlet": own, "out": {"kind": "pressure_outlet", "side": "right"}, "walls": {"kind": "slip_wall"}}


def gas_of(name, folder, **given):
    """A started gas of either kind, and what closes it."""
    options = {"boundaries": channel()} | given
    if name == "embedded":
        gas = EmbeddedGas(box_case(SIZE, CELL, **options))
        gas.start(None, ())
        return gas, lambda: None
    own = box(folder, SIZE, CELL, **options)
    gas = own.__enter__()
    gas.start(None, ())
    return gas, lambda: own.__exit__(None, None, None)


def windows(end=0.1, longest=7e-3):
    """Lengths [s] of windows up to `end` that end at the rows."""
    ends = np.unique([*(row[0] for row in ROWS), end])
    gaps = [(gap, int(np.ceil(gap / longest))) for gap in np.diff(ends, prepend=0.0).tolist()]
    return [gap / n for gap, n in gaps for _ in range(n)]


def same_fields(one, other):
    names = "velocity", "pressure", "vorticity"
    return all(one.fields[key].tobytes() == other.fields[key].tobytes() for key in names)


@pytest.mark.parametrize("name", ["embedded", openfoam])
def test_what_flows_out_is_the_integral_of_the_rows(tmp_path, name):
    """Gas of constant density: as much leaves as comes in, with the velocity of the last cells, to 1e-10 of it; the
    ledger's mass closes to round-off."""
    gas, close = gas_of(name, tmp_path)
    last, passed = gas.mesh.centres[:, 0] > SIZE[0] - CELL, 0.0
    try:
        first = gas.state.budget if name == "embedded" else gas._state.budget
        for dt in windows():
            state = gas.advance(dt, {})
            passed += DENSITY * CELL * dt * state.fields["velocity"][last, 0].sum()
            assert state.budget.mass - first.mass == pytest.approx(state.budget.mass_in, abs=1e-12 * first.mass)
    finally:
        close()
    assert state.time == pytest.approx(0.1, rel=1e-12)
    assert passed == pytest.approx(DENSITY * SIZE[1] * 0.5 * AREA, rel=1e-10)
    carried = 1000.0 * DENSITY * SIZE[1] * 0.5 * AREA * 50.0  # J: it came in 50 K hotter, and has not got to the end
    assert state.budget.energy_in == pytest.approx(carried, rel=1e-2)


@pytest.mark.parametrize(
    ("name", "equation"),
    [
        ("embedded", "operating"),
        pytest.param("openfoam", "operating", marks=pytest.mark.openfoam),
        pytest.param("openfoam", "ideal", marks=pytest.mark.openfoam),
    ],
)
def test_a_closed_box_holds_what_came_in(tmp_path, name, equation):
    """Its mass grows by what the ledger is told, about the integral of the rows at the density of the inlet."""
    boundaries = channel(temperature_K=300.0) | {"out": {"kind": "wall", "side": "right"}}
    gas, close = gas_of(name, tmp_path, boundaries=boundaries, equation_of_state=equation)
    try:
        first = gas.advance(1e-3, {}).budget
        for dt in [9e-3, *windows()[2:]]:
            state = gas.advance(dt, {})
    finally:
        close()
    grown, came = state.budget.mass - first.mass, state.budget.mass_in - first.mass_in
    assert grown == pytest.approx(came, rel=1e-9)
    if equation == "operating":
        assert grown / first.mass == pytest.approx(0.5 * AREA / SIZE[0], rel=0.3) and grown > 0.1 * first.mass


@given(
    steps=st.lists(st.floats(1e-4, 1.0), min_size=2, max_size=6),
    values=st.lists(st.floats(-3.0, 3.0), min_size=6, max_size=6),
    cuts=st.lists(st.floats(0.0, 1.0), max_size=8),
)
def test_means_of_any_windows_add_up_to_the_integral(steps, values, cuts):
    times = np.cumsum(steps)
    own = Boundary(kind="velocity_inlet", velocities=tuple((t, u, -u) for t, u in zip(times.tolist(), values)))
    end = 1.5 * times[-1]
    ends = np.unique([0.0, *(share * end for share in cuts), end])
    found = sum(inlets.mean(own, a, b) * (b - a) for a, b in pairwise(ends))
    known = values[: len(times)]
    exact = np.trapezoid([known[0], *known, known[-1]], [0.0, *times, end])
    np.testing.assert_allclose(found, [exact, -exact], atol=1e-12 * end * 3.0)


def test_between_rows_it_is_linear_and_beyond_them_it_stays():
    own = Boundary(kind="velocity_inlet", velocities=((1.0, 2.0, 0.0), (3.0, 4.0, -1.0)))
    assert [inlets.at(own, time).tolist() for time in (0.0, 2.0, 9.0)] == [[2.0, 0.0], [3.0, -0.5], [4.0, -1.0]]


@pytest.mark.parametrize("name", ["embedded", openfoam])
def test_a_gas_goes_on_from_a_checkpoint_and_back_across_a_row(tmp_path, name):
    """Bit for bit; the vorticity that an effect may ask for too, which the embedded gas makes from the boundary."""
    steps, asked = windows(), ("vorticity",)
    boundaries = channel([[*row[:2], 0.3 * row[1]] for row in ROWS])
    gas, close = gas_of(name, tmp_path / "a", boundaries=boundaries)
    other, close_other = gas_of(name, tmp_path / "b", boundaries=boundaries)
    try:
        gas.start(None, (), asked)
        for dt in steps[:3]:
            before = gas.advance(dt, {})
        gas.checkpoint(tmp_path / "kept")
        gas.advance(2.0 * steps[3], {})
        assert same_fields(gas.retreat(), before)
        assert same_fields(other.restore(tmp_path / "kept", (), asked), before)
        for dt in steps[3:]:
            one, two = gas.advance(dt, {}), other.advance(dt, {})
            assert same_fields(one, two) and one.budget == two.budget
    finally:
        close(), close_other()


def test_windows_end_at_the_rows_and_obey_what_is_to_come():
    """Before the gas comes in faster, a window is no longer than it may be with the gas of then, as fast as it is
    between the grains."""
    case = box_case(SIZE, CELL, boundaries=channel())
    clock, ends, time = Window(case), [], 0.0
    assert opening(case)["courant"] == pytest.approx(CELL / 0.9)
    while time < 0.1:
        end = clock.choose(time)
        clock.learn(end - time, 0.0, 0.0, 1e-9, 0.0)  # gas at rest: each window may be twice as long as the last
        ends.append(end)
        time = end
    assert {row[0] for row in ROWS} <= set(ends)
    clock.limits["courant"] = clock.limits["largest"] = 1.0
    assert clock.choose(0.0) == 0.01 and clock.choose(0.031) == 0.05
    assert clock.choose(0.05) == pytest.approx(0.05 + 0.04 / np.ceil(0.04 / (CELL / 0.9)))


PULSED = (
    "boundaries.jet={kind='velocity_inlet', side='bottom', span_m=[0.24,0.26], temperature_K=350.0, "
    "velocities=[[0.0,0.0,7.5],[0.0004,0.0,7.5],[0.0011,0.0,0.0],[0.0018,0.0,0.0],[0.002,0.0,5.0]]}",
    "boundaries.distributor={kind='velocity_inlet', side='bottom', temperature_K=288.0, "
    "velocities=[[0.0,0.0,0.08],[0.0014,0.0,0.5]]}",
)


def test_a_run_goes_on_across_rows_bit_for_bit(tmp_path):
    start(tmp_path / "whole", "bubbling_bed", more=PULSED)
    with pytest.raises(Cut):
        start(tmp_path / "cut", "bubbling_bed", cut_after=7, more=PULSED)
    driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    rows = (tmp_path / "whole" / "ledger.csv").read_text().splitlines()[1:]
    times = [float(row.split(",")[0]) for row in rows]
    assert set(inlets.times(load("bubbling_bed", "embedded", *PULSED))) <= set(times)
    rows = "[[0.0, 0.0, 0.08], [0.0014, 0.0, 0.5]]"
    longer = f"{rows[:-1]}, [0.5, 0.0, 0.0]]"
    told = f"boundaries.distributor.velocities was {rows} and is {longer}; put it back, or run anew"
    with pytest.raises(CaseError, match=re.escape(told)):
        driver.resume(tmp_path / "cut", (f"boundaries.distributor.velocities={longer}",), Reporter())


@pytest.mark.parametrize(
    ("inlet", "told"),
    [
        ({"velocities": []}, "velocities has the times []; give two at least, each after the one before"),
        ({"velocities": [[0.0, 1.0, 0.0]]}, "velocities has the times [0.0]; give two at least"),
        ({"velocities": [[0.0, 1.0, 0.0], [0.0, 2.0, 0.0]]}, "has the times [0.0, 0.0]; give two at least, each after"),
        ({"velocities": [[0.2, 1.0, 0.0], [0.1, 2.0, 0.0]]}, "has the times [0.2, 0.1]; give two at least, each after"),
        ({"velocities": [[0.0, 1.0], [1.0, 2.0]]}, "holds [0.0, 1.0]; a row is [time s, u, v m/s], the time 0 or more"),
        ({"velocities": [[0.0, 1.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0]]}, "a row is [time s, u, v m/s]"),
        ({"velocities": [[-1.0, 1.0, 0.0], [1.0, 2.0, 0.0]]}, "holds [-1.0, 1.0, 0.0]; a row is"),
        ({"velocities": [0.0, 1.0]}, "holds 0.0; a row is [time s, u, v m/s]"),
        ({"velocities": [[0.0, [1.0, 0.0]], [1.0, [2.0, 0.0]]]}, "a row is [time s, u, v m/s]"),
        ({"velocities": 0.3}, "velocities = 0.3; it must be a list of numbers"),
        ({"velocities": [[0.0, 1e9, 0.0], [1.0, 2.0, 0.0]]}, "velocities: the velocity = 1e+09"),
        ({"velocities": [[0.0, 1.0, 0.0], [1e13, 2.0, 0.0]]}, "velocities: the time = 1e+13"),
        ({"velocity_m_s": [0.1, 0.0]}, "boundaries.inlet: give either velocity_m_s or velocities"),
        ({"profile": "parabolic"}, "are the same all over the inlet; leave profile = 'parabolic' out"),
        ({"kind": "wall"}, "boundaries.inlet.velocities are of a velocity_inlet; kind = 'wall': leave them out"),
    ],
)
def test_what_is_no_table_is_refused_in_one_line(inlet, told):
    with pytest.raises(CaseError, match=re.escape(told)) as refusal:
        box_case(SIZE, CELL, boundaries=channel(**inlet))
    assert "\n" not in str(refusal.value) and len(str(refusal.value)) < 300


def test_openfoam_is_told_the_rows():
    """In all of its solvers, digit for digit; temperature and gas of the inlet stay as they are."""
    case = box_case(SIZE, CELL, boundaries=channel())
    rows = " ".join(f"({t!r} ({u!r} {v!r} 0.0))" for t, u, v in ROWS)
    told = f"inlet {{ type uniformFixedValue; uniformValue table ({rows}); }}"
    fields = start_fields.start_fields(case)
    assert told in fields["U"] and "inlet { type fixedValue; value uniform 350.0; }" in fields["T"]
    inlet = case.boundaries["inlet"]
    assert two_fluid_fields.KINDS[inlet.kind](case, inlet)["U.gas"] in told
    assert droplet_fields.KINDS[inlet.kind](case, inlet)["U"] in told
    steady = box_case(SIZE, CELL, boundaries=channel() | {"inlet": STEADY})
    assert two_fluid_numbers._time_steps(case, 0.5, CELL) == two_fluid_numbers._time_steps(steady, 0.5, CELL)


STEADY = {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [0.9, 0.0], "temperature_K": 350.0}


def test_it_counts_as_fast_as_it_ever_is():
    """For steps and numbers; what gas carries of a bed's weight it does not where it is shut off."""
    own, steady = (box_case(SIZE, CELL, boundaries=channel() | {"inlet": one}) for one in (channel()["inlet"], STEADY))
    found, other = own.boundaries["inlet"], steady.boundaries["inlet"]
    assert found.lets_in and found.strongest == other.strongest and found.fastest == other.fastest == 0.9
    assert opening(own) == opening(steady)
    down = SimpleNamespace(gravity=(-9.81, 0.0))
    upwards = SimpleNamespace(dimensions=2, domain=down, boundaries={"inlet": found})
    assert ways.slowest(upwards) == 0.9 and ways.slowest(upwards, min) == 0.0


def test_a_vessel_that_fills_for_a_while_is_refused(tmp_path):
    """At its first row as much leaves as comes in, later not."""
    leaves = {"kind": "velocity_inlet", "side": "right", "velocity_m_s": [0.2, 0.0]}
    rows = [[0.0, 0.2, 0.0], [0.1, 0.2, 0.0], [0.2, 0.3, 0.0]]
    for own, refused in ((rows, True), (rows[:2], False)):
        case = box_case(SIZE, CELL, boundaries=channel(own) | {"out": leaves}, equation_of_state="constant")
        if not refused:
            refuse_filling(case, tmp_path)
            continue
        with pytest.raises(CaseError, match="of gas of constant density come in that find no way out"):
            refuse_filling(case, tmp_path)
