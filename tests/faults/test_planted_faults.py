"""The command that plants faults: where it finds room for them, what it draws, and three that the tests must catch."""

import itertools
from pathlib import Path

import pytest

from faults import cpp_sites, draw, python_sites, record, trial
from faults.fault import KINDS
from faults.rooms import ROOMS, seen_by
from faults.tree import Tree
from faults.trial import CAUGHT, Laboratory

ROOT = Path(__file__).parents[2]
SEED = 1
PYTHON = b'''"""Says a - b."""
def f(s, i, j, n):
    """Says a - b."""
    if n <= 2 and s.x[i] < s.y[j]:
        raise ValueError(f"{n - 1} is a - b")
    total = -3.0 * (s.a + n)
    total += s.b[0, 1] ** 2
    return "a" + "b", total
def said(n) -> str:
    return str(n + 1)
'''
CPP = b"""#include "a.H"
scalar f(const scalar a)
{
    for (label k = 0; k < n; ++k) sum += a*v[k].x();
    // b = a - c;
    Info<< "a - b" << a - b;
    return a - b;
}
"""


def test_room_for_faults_in_python():
    found = {(fault.kind, fault.old, fault.new) for fault in python_sites.sites("laws", "sdph/methods/a.py", PYTHON)}
    assert found == {
        *[("off by one", "<=", "<"), ("sign", "<", ">")],
        *[("index", "x", "y"), ("index", "y", "z"), ("index", "i", "j"), ("index", "j", "i")],
        *[("factor", "-3.0 * (s.a + n)", "(1.2 * (-3.0 * (s.a + n)))"), ("sign", "-3.0", "3.0")],
        *[("sign", "+", "-"), ("drop", "s.a + n", "s.a")],
        *[("drop", "total += s.b[0, 1] ** 2", "pass"), ("index", "0", "1"), ("index", "1", "0")],
        ("factor", "2", "(1.2 * (2))"),
    }


def test_room_for_faults_in_cpp():
    found = {(fault.kind, fault.old, fault.new) for fault in cpp_sites.sites("sdphGasFoam", "a.C", CPP)}
    assert found == {
        *[("off by one", "0", "1"), ("off by one", "<", "<="), ("sign", "+=", "-="), ("index", "x", "y")],
        *[("drop", "sum += a*v[k].x();", ";"), ("sign", "-", "+")],
    }


def test_what_is_put_in_stands_where_it_was_found():
    for fault in python_sites.sites("laws", "sdph/methods/a.py", PYTHON):
        planted = fault.planted(PYTHON)
        compile(planted, "a.py", "exec")
        assert planted != PYTHON and len(planted) - len(PYTHON) == len(fault.new) - len(fault.old)


def test_a_seed_draws_the_same_faults_of_every_room_and_kind():
    first, again, other = ([*itertools.islice(draw.drawn(ROOT, seed), 80)] for seed in (1, 1, 2))
    assert first == again != other
    assert {fault.room for fault in first} == set(ROOMS) and {fault.kind for fault in first} == set(KINDS)
    assert len({fault.name for fault in first}) == 80


@pytest.mark.parametrize("room", ROOMS)
def test_every_room_has_faults_and_tests(room):
    faults = draw.in_room(ROOT, room)
    assert len(faults) > 20 and len({fault.name for fault in faults}) == len(faults)
    assert all((ROOT / name).is_file() for name in seen_by(ROOT, room, faults[0].file))


def test_given_faults_stand_in_the_code_and_reasons_have_words():
    given = draw.given(ROOT, Path(__file__).with_name("given.toml"))
    assert len(given) >= 4 and {fault.room for fault in given} <= set(ROOMS)
    assert all(row["why"] and isinstance(row["equivalent"], bool) for row in record.reasons().values())


def test_kernels_that_hold_a_fault_are_compiled_anew(tmp_path):
    tree = Tree(ROOT, tmp_path)
    stale = {name for _, name in tree.stale("sdph/laws/lift.py")}
    assert {"lift", "equations"} <= stale and not {"sizes", "transfer", "rows"} & stale
    fault = next(draw.of_room(ROOT, "laws", SEED))
    before = (tree.root / fault.file).read_bytes(), (tree.root / fault.file).stat().st_mtime_ns
    tree.plant(fault)
    assert (tree.root / fault.file).read_bytes() == fault.planted(before[0])
    tree.restore(fault)
    assert before == ((tree.root / fault.file).read_bytes(), (tree.root / fault.file).stat().st_mtime_ns)


def test_a_trial_ends_where_pytest_itself_does_not_run(tmp_path, monkeypatch):
    """It named the same test for ever."""
    monkeypatch.setattr(trial, "Tree", lambda *_: None)
    own = Laboratory(ROOT, tmp_path, 1.0)
    monkeypatch.setattr(own, "_seen", lambda fault: (CAUGHT, "tests/a.py::b"))
    monkeypatch.setattr(own, "_sound", lambda test: False)
    with pytest.raises(RuntimeError, match="tests/a.py::b fails without a fault too"):
        own.trial(None)


@pytest.mark.parametrize("room", ["laws", "ledger", "messages"])
def test_a_fault_is_caught(tmp_path, room):
    """One that was caught when faults were last recorded: a test that sees it no longer is missed (CONTRIBUTING.md)."""
    recorded = record.Record(Path(__file__).with_name("record.csv"), resume=True)
    fault = next(one for one in draw.of_room(ROOT, room, SEED) if one in recorded and recorded.caught(one))
    outcome = Laboratory(ROOT, tmp_path, 300.0).trial(fault)
    assert outcome.what == CAUGHT, f"{outcome.what}: {fault}"
