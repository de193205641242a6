"""Loops over particles built without the terms of an effect, from the code of the loop and of all that it calls.

`Rebuilt` follows the parameters of an effect from the arguments of a loop to whatever takes them. There every call of a
function of the effect's file becomes what that function gives when it is off, the length of the parameters becomes 0,
and what stands behind `if 0` goes. Functions that take nothing of the effect stay as they are.
"""

import ast
import copy
import inspect
import textwrap

from numba.core.registry import CPUDispatcher

from sdph.effects.effect import OFF


class Given:
    """An argument of a term, to see whether the term hands it on when it is off."""

    def __init__(self, node):
        self.node = node


class Rebuilt:
    """Functions built anew for one effect, each once, for one thread.

    home: module of the effect; strip: take its terms out, else build the same functions as they stand; places: how many
    took parameters of it; left: terms that could not be taken out, as they give something that is computed."""

    def __init__(self, home: str, strip: bool):
        self.home, self.strip, self.places, self.left, self.known = home, strip, 0, [], {}

    def of(self, function, off: frozenset[str]) -> CPUDispatcher:
        """A compiled function whose parameters `off` are those of the effect."""
        if (function, off) not in self.known:
            own = function.py_func
            tree = ast.parse(textwrap.dedent(inspect.getsource(own)))
            tree.body[0].decorator_list = []
            names = dict(own.__globals__)
            tree = ast.fix_missing_locations(_Terms(self, names, off).visit(tree))
            exec(compile(tree, own.__code__.co_filename, "exec"), names)
            kept = {name: value for name, value in function.targetoptions.items() if name not in LEFT_OUT}
            made = CPUDispatcher(names[own.__name__], targetoptions=kept | {"nopython": True, **ALONE})
            self.known[function, off] = made
        return self.known[function, off]


LEFT_OUT = ("parallel", "cache")
ALONE = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # no way in from Python: its code is no part of a loop


class _Terms(ast.NodeTransformer):
    """Takes the terms of an effect out of a function, whose globals are `names`."""

    def __init__(self, rebuilt: Rebuilt, names: dict, off: frozenset[str]):
        self.rebuilt, self.names, self.off = rebuilt, names, off

    def visit_If(self, node):
        node.test = self.visit(node.test)
        if self.rebuilt.strip and _never(node.test):
            return [self.visit(own) for own in node.orelse] or ast.Pass()
        return self.generic_visit(node)

    def visit_IfExp(self, node):
        node.test = self.visit(node.test)
        return self.visit(node.orelse) if self.rebuilt.strip and _never(node.test) else self.generic_visit(node)

    def visit_Call(self, node):
        self.generic_visit(node)
        if ast.unparse(node.func) == "len" and ast.unparse(node.args[0]) in self.off:
            self.rebuilt.places += 1
            return ast.Constant(0) if self.rebuilt.strip else node
        called = self._called(node.func)
        if called is None or not (taken := self._taken(called, node)):
            return node
        own = called.py_func.__module__ == self.rebuilt.home and ast.unparse(node.args[0]) in self.off
        gives = _when_off(called, node) if own else None
        if gives is not None:
            self.rebuilt.places += 1
            return gives if self.rebuilt.strip else node
        if own:
            self.rebuilt.left.append(ast.unparse(node.func))
        name = f"built_{len(self.names)}"
        self.names[name] = self.rebuilt.of(called, taken)
        node.func = ast.Name(name, ast.Load())
        return node

    def _called(self, of):
        """The compiled function that is called; None where it is none."""
        found = self.names.get(of.id) if isinstance(of, ast.Name) else None
        if isinstance(of, ast.Attribute) and isinstance(of.value, ast.Name):
            found = getattr(self.names.get(of.value.id), of.attr, None)
        return found if isinstance(found, CPUDispatcher) else None

    def _taken(self, called, node) -> frozenset[str]:
        """Names under which a function that is called takes parameters of the effect."""
        names, given = inspect.signature(called.py_func).parameters, node.args
        stars = [n for n, one in enumerate(given) if isinstance(one, ast.Starred)]
        if stars and any(ast.unparse(one) in self.off for one in given[stars[0] :]):
            raise ValueError(f"{ast.unparse(node)}: parameters of an effect behind a star are not followed")
        return frozenset(name for name, one in zip(names, given) if ast.unparse(one) in self.off)


def _never(test) -> bool:
    """True of a test of constants alone that fails."""
    if any(isinstance(node, ast.Name | ast.Call) for node in ast.walk(test)):
        return False
    return not eval(compile(ast.Expression(ast.fix_missing_locations(test)), "test", "eval"))


def _when_off(called, node):
    """Node of what a function gives whose first parameter is off; None where it does not tell without running."""
    try:
        return _told(called.py_func(OFF, *map(Given, node.args[1:])))
    except (AttributeError, IndexError, TypeError):
        return None


def _told(value):
    """A number, an argument, or several of them as a node."""
    if isinstance(value, tuple):
        return ast.Tuple([_told(part) for part in value], ast.Load())
    return copy.deepcopy(value.node) if isinstance(value, Given) else ast.parse(repr(value), mode="eval").body
