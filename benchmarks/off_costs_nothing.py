"""An effect that is off leaves no code behind: the machine code of the loops is that of loops built without its terms.

    python benchmarks/off_costs_nothing.py [effect ...]

For each effect that has terms in the loops over particles (sdph/methods/grains/equations.py,
sdph/methods/grains/contacts.py), these are compiled for a bubbling bed with the effect off, once from the source and
once from the source in which every call of a function of the effect's file is replaced by what that function gives when
it is off. Identical instructions take the same time on any machine and under any load, which no timing can show. Serial
builds are compared: threads share out the same body.
"""

import ast
import importlib.util
import inspect
import re
import sys
import tempfile
from pathlib import Path

import numpy as np
from numba import njit

from sdph import effects, scenes
from sdph.case import read as cases
from sdph.effects.effect import OFF
from sdph.laws.compiled import FAST
from sdph.methods.grains import contacts as shearing
from sdph.methods.grains import equations as rates
from sdph.study.explain import effect_costs
from sdph.study.explain.tables import table

LOOPS = {"sum_density": rates, "shear": shearing, "constitutive": rates, "rates": rates}
NAME = re.compile(r"[.$\w@]*[A-Za-z_][.$\w@]*")


class Strip(ast.NodeTransformer):
    """Replaces the calls of an effect's functions by what they give when it is off."""

    def __init__(self, effect: str):
        self.effect, self.module = effect, getattr(effects, effect)

    def visit_Call(self, node):
        self.generic_visit(node)
        of = node.func
        if not (isinstance(of, ast.Attribute) and isinstance(of.value, ast.Name) and of.value.id == self.effect):
            return node
        function = getattr(self.module, of.attr).py_func
        try:
            given = function(OFF, *[None] * (len(inspect.signature(function).parameters) - 1))
        except (AttributeError, IndexError):  # it is never called when off: it stands behind `if len(p)`
            return node
        return ast.parse(repr(given), mode="eval").body


def built_without(effect: str, whole):
    """A module of loops without the terms of an effect, as one of its own."""
    tree = ast.fix_missing_locations(Strip(effect).visit(ast.parse(Path(whole.__file__).read_text(encoding="utf-8"))))
    file = Path(tempfile.mkdtemp()) / f"{whole.__name__.split('.')[-1]}_without_{effect}.py"
    file.write_text(ast.unparse(tree), encoding="utf-8")
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    return module


def arguments(simulation) -> dict[str, tuple]:
    """Name of each loop -> its arguments in one sub-step."""
    effect_costs.step(simulation, 1e-7)
    stepper = simulation.stepper
    zeros = np.zeros(len(stepper.state.x))
    stepper.force(zeros, np.zeros((len(zeros), 3)), zeros)
    return {name: given for name, (_, given) in stepper.loops(1e-7).items() if name in LOOPS}


def instructions(loop, given: tuple) -> list[str]:
    """Machine code of a loop for the types of its arguments, with symbols by the order in which they come up."""
    serial = njit(error_model="numpy", fastmath=FAST)(loop.py_func)
    serial(*(a.copy() if hasattr(a, "copy") else a for a in given))
    (text,) = serial.inspect_asm().values()
    seen: dict[str, str] = {}
    lines = (line.split("#")[0].strip() for line in text.splitlines())
    code = [line for line in lines if (line and not line.startswith((".", "_", "\t."))) or line.startswith(".L")]
    return [NAME.sub(lambda m: _symbol(m[0], seen), line) for line in code]


def _symbol(word: str, seen: dict) -> str:
    """Names made by the compiler, which hold the module's name and running numbers, become s0, s1, ...; others stay."""
    made = word.startswith((".L", "__")) or "_Z" in word or "numba" in word or "$" in word
    return seen.setdefault(word, f"s{len(seen)}") if made else word


def compared(effect: str) -> list[dict]:
    """A row for each loop that has terms of the effect."""
    whole = cases.load(scenes.HERE / "bubbling_bed" / "case.toml", effect_costs.BED)
    given = arguments(effect_costs.prepared(effect_costs.without(whole, effect)))
    other, rows = {module: built_without(effect, module) for module in set(LOOPS.values())}, []
    for name in given:
        loop = getattr(LOOPS[name], name)
        if inspect.getsource(loop.py_func).count(f"{effect}."):
            own, bare = instructions(loop, given[name]), instructions(getattr(other[LOOPS[name]], name), given[name])
            rows.append(
                {
                    "effect off": effect,
                    "loop": name,
                    "instructions": len(own),
                    "built without": len(bare),
                    "identical": own == bare,
                }
            )
    return rows


def with_terms() -> list[str]:
    """Effects whose functions the loops call; those of granular temperature give their argument when off: no constant
    stands for them."""
    source = "".join(inspect.getsource(getattr(module, name).py_func) for name, module in LOOPS.items())
    return [name for name in effects.REGISTRY if f"{name}." in source and name != "granular_temperature"]


if __name__ == "__main__":
    found = [row for effect in sys.argv[1:] or with_terms() for row in compared(effect)]
    print(table(found))
    sys.exit(0 if all(row["identical"] for row in found) else 1)
