"""Cost of each effect, and that one that is off costs nothing: against the same loop built without its terms.

    python benchmarks/effect_costs.py [effect ...]

The loop without an effect is made from the source of sdph/methods/grains/equations.py: every call of a function of the
effect's file is replaced by the zeros that it would return. Both are timed in turns; the least of each counts.
"""

import ast
import importlib.util
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.grains import equations as rates
from sdph.study.explain import effect_costs
from sdph.study.explain.tables import table

# functions in the loop, and how many numbers each returns
TERMS = {"conduction": {"pair": 1}, "artificial_viscosity": {"pair": 1}}
ROUNDS = 60
ALLOWED = 0.02


class Strip(ast.NodeTransformer):
    """Replaces calls effect.function(...) by zeros."""

    def __init__(self, effect: str):
        self.effect = effect

    def visit_Call(self, node):
        self.generic_visit(node)
        of = node.func
        if isinstance(of, ast.Attribute) and isinstance(of.value, ast.Name) and of.value.id == self.effect:
            zeros = [ast.Constant(0.0) for _ in range(TERMS[self.effect][of.attr])]
            return zeros[0] if len(zeros) == 1 else ast.Tuple(zeros, ast.Load())
        return node


def built_without(effect: str):
    """sdph.methods.grains.equations without the terms of an effect, as a module of its own."""
    tree = ast.fix_missing_locations(Strip(effect).visit(ast.parse(Path(rates.__file__).read_text(encoding="utf-8"))))
    file = Path(tempfile.mkdtemp()) / f"rates_without_{effect}.py"
    file.write_text(ast.unparse(tree), encoding="utf-8")
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    return module


def compared(effect: str) -> dict:
    """Time of the loop with the effect off over that of the loop built without it; whether they agree to the last
    bit."""
    whole = cases.load(scenes.HERE / "bubbling_bed" / "case.toml", effect_costs.BED)
    off = effect_costs.prepared(effect_costs.without(whole, effect))
    arguments, results = captured(off), []
    loops = [rates.rates, built_without(effect).rates]
    for loop in loops:
        out = [a.copy() for a in arguments[-3:]]
        loop(*arguments[:-3], *out)
        results.append(out)
    times = np.array([[timed(loop, arguments) for loop in loops] for _ in range(ROUNDS)]).min(axis=0)
    same = all(np.array_equal(a, b) for a, b in zip(*results))
    ratio = times[0] / times[1]
    return {
        "effect off": effect,
        "loop [us]": 1e6 * times[0],
        "built without [us]": 1e6 * times[1],
        "ratio": ratio,
        "bitwise": same,
        "within 2 %": ratio <= 1.0 + ALLOWED,
    }


def captured(simulation) -> tuple:
    """The arguments of the loop over pairs in one sub-step."""
    effect_costs.step(simulation, 1e-7)
    stepper = simulation.stepper
    zeros = np.zeros(len(stepper.state.x))
    stepper.force(zeros, np.zeros((len(zeros), 3)), zeros)
    return stepper.loops(1e-7)["rates"][1]


def timed(loop, arguments) -> float:
    started = time.perf_counter()
    loop(*arguments)
    return time.perf_counter() - started


if __name__ == "__main__":
    print(table([compared(effect) for effect in sys.argv[1:] or TERMS]))
    if not sys.argv[1:]:
        print(table(effect_costs.table()))
