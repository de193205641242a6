"""The scripts of benchmarks/ begin, take of the code only what is there, and see whether effects that are off cost."""

import ast
import builtins
import importlib.util
import os
import sys
import types

import numpy as np
import pytest
from scripts import script

from coupling import gas
from sdph.scenes import paths

FOLDER = paths.PACKAGE.parent / "benchmarks"
SCRIPTS = [file.stem for file in sorted(FOLDER.glob("*.py"))]
ELSEWHERE = {"pysph_side": "compyle"}  # script -> what its own Python has


@pytest.fixture(autouse=True)
def _beside_each_other(monkeypatch):
    """Let scripts import each other, as where they are run; the threads that some ask for are theirs alone."""
    monkeypatch.syspath_prepend(str(FOLDER))
    monkeypatch.setenv("NUMBA_NUM_THREADS", os.environ.get("NUMBA_NUM_THREADS", "1"))


def missing(module, text: str) -> list[str]:
    """What a script takes of modules that these have not, and names of its entry that nobody defines."""
    tree, found = ast.parse(text), []
    stored = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id not in stored:
            of = getattr(module, node.value.id, None)
            if isinstance(of, types.ModuleType) and not hasattr(of, node.attr):
                found.append(ast.unparse(node))
    entries = [node for part in tree.body if isinstance(part, ast.If) for node in ast.walk(part)]
    names = [node.id for node in entries if isinstance(node, ast.Name)]
    return found + [name for name in names if not {name} & {*stored, *dir(builtins)} and not hasattr(module, name)]


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_script_begins_and_takes_what_is_there(name):
    if name in ELSEWHERE and importlib.util.find_spec(ELSEWHERE[name]) is None:
        pytest.skip(f"needs {ELSEWHERE[name]}")
    assert not missing(script(name, "benchmarks"), (FOLDER / f"{name}.py").read_text(encoding="utf-8"))


def test_what_is_missing_is_seen():
    module = types.SimpleNamespace(sys=sys, main=len)
    text = "sys.argv\nsys.argw\nif a == b:\n    c = main(c)\n    print(d)\n"
    assert missing(module, text) == ["sys.argw", "a", "b", "d"]


def test_sources_of_the_gas_that_is_timed_are_those_that_a_gas_knows():
    """Sources of a bed in `embedded_gas.py`, which no import shows."""
    centres = np.array([[0.1, 0.1, 0.0], [0.3, 0.7, 0.0]])
    assert set(script("embedded_gas", "benchmarks").sources(centres, np.ones(2), 0.0)) <= set(gas.SOURCES)


@pytest.fixture(scope="module")
def dam():
    """off_costs_nothing.py, and what it hears of a dam break."""
    with pytest.MonkeyPatch.context() as patched:
        patched.syspath_prepend(str(FOLDER))
        costs = script("off_costs_nothing", "benchmarks")
        return costs, costs.Scenes(("dam_break",))


def test_an_effect_that_is_off_leaves_no_code_in_the_loops_of_a_liquid(dam):
    costs, heard = dam
    rows, said = costs.looked_into("liquid_damping", heard)
    found = {row["loop"].split(".")[-1]: row[""] for row in rows}
    assert found == dict.fromkeys(("push", "wall_force", "losses"), costs.SAME) and not said
    assert all(row["places"] and row["instructions"] == row["built without"] > 100 for row in rows)


def test_code_that_is_left_is_seen(dam):
    """Terms of an effect that is on, and the loop built without them."""
    costs, heard = dam
    term = next(own for own in heard.terms("liquid_damping") if own.loop.py_func.__name__ == "losses")
    (on,) = [taken for loop, taken in heard.heard["dam_break"] if loop is term.loop]
    row = costs.compared(term, "liquid_damping", heard.homes["liquid_damping"], on)
    assert row[""].startswith("not identical") and row["instructions"] > row["built without"]


def test_an_effect_without_such_a_loop_is_named(dam):
    costs, heard = dam
    assert costs.looked_into("tank", heard) == ([], "no loop takes its parameters")
    assert costs.looked_into("xsph", heard) == ([], "none of the scenes has it")
