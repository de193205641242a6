"""Words that CUDA takes too, `math` for one number in kernels, no field that is called as a method of tuples is; and no
long list of arguments."""

import ast
import math

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
METHODS_OF_TUPLES = {"index", "count"}
MOST = 16  # arguments of a compiled function: of more nobody knows which is which
FILES = [file for package in ("sdph", "coupling") for file in sorted((ROOT / package).rglob("*.py"))]
TREES = {file.relative_to(ROOT): ast.parse(file.read_text(encoding="utf-8")) for file in FILES}


def decorators() -> set[str]:
    """Names of all decorators of compiled functions, from the file that makes them."""
    tree = TREES[(paths.PACKAGE / "laws" / "compiled.py").relative_to(ROOT)]
    made = [own for own in tree.body if isinstance(own, ast.Assign) and isinstance(own.value, ast.Call)]
    made = [own for own in made if ast.unparse(own.value.func) in ("_within", "_over_particles")]
    return {name.id for own in made for name in own.targets}


COMPILED = decorators()


def named(decorator) -> str:
    """Name of a decorator, called or not."""
    own = decorator.func if isinstance(decorator, ast.Call) else decorator
    return own.attr if isinstance(own, ast.Attribute) else own.id


def compiled(tree) -> list:
    """Functions that numba compiles."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    return [own for own in functions if COMPILED & {named(decorator) for decorator in own.decorator_list}]


def of_numpy(function) -> list[str]:
    """Functions of one number that are taken from numpy though `math` has them."""
    taken = [own for own in ast.walk(function) if isinstance(own, ast.Attribute) and ast.unparse(own.value) == "np"]
    return [own.attr for own in taken if callable(getattr(math, own.attr, None))]


def shadowing(tree) -> list[str]:
    """Fields of tuples that hide a method of theirs."""
    classes = [node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    tuples = [own for own in classes if "NamedTuple" in map(ast.unparse, own.bases)]
    fields = [(own.name, part.target.id) for own in tuples for part in own.body if isinstance(part, ast.AnnAssign)]
    return [f"{name}.{field}" for name, field in fields if field in METHODS_OF_TUPLES]


def test_kernels_take_functions_of_one_number_from_math():
    found = [(file, own) for file, tree in TREES.items() for own in compiled(tree)]
    assert len(found) > 400
    assert not [f"{file}:{own.name}: np.{name}" for file, own in found for name in of_numpy(own)]


def test_no_field_hides_a_method_of_tuples():
    assert sum("NamedTuple" in ast.unparse(tree) for tree in TREES.values()) > 50
    assert not [f"{file}: {field}" for file, tree in TREES.items() for field in shadowing(tree)]


def test_no_compiled_function_takes_many_arguments():
    found = {f"{file}:{own.name}": taken(own) for file, tree in TREES.items() for own in compiled(tree)}
    assert max(found.values()) > 10 and not {name: count for name, count in found.items() if count > MOST}


def taken(function) -> int:
    """Number of arguments."""
    own = function.args
    return len(own.posonlyargs) + len(own.args) + len(own.kwonlyargs)


def test_every_decorator_of_compiled_functions_is_looked_for():
    used = {named(one) for tree in TREES.values() for own in compiled(tree) for one in own.decorator_list}
    assert used >= COMPILED and len(COMPILED) == 10
    assert {"parallel_largest", "inner", "in_turn", "in_order"} <= COMPILED


def test_words_are_found():
    kernel = "@serial\ndef f(x):\n    return np.sqrt(x) * np.pi"
    tree = ast.parse(f"class A(NamedTuple):\n    index: int\n\n\n{kernel}")
    assert taken(ast.parse("def f(a, /, b, *, c): pass").body[0]) == 3
    assert shadowing(tree) == ["A.index"] and [of_numpy(own) for own in compiled(tree)] == [["sqrt"]]
