"""A constant stands once: no two modules give a number the same name and the same value, each by itself."""

import ast
from collections import defaultdict

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent


def numbers(text: str) -> dict[str, float]:
    """Value of each number that a module gives a name in capitals, those of tuples one by one."""
    found = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                found |= named(target, node.value)
    return found


def named(target, value) -> dict[str, float]:
    """The same of one assignment."""
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        return {name: own for pair in zip(target.elts, value.elts) for name, own in named(*pair).items()}
    if not isinstance(target, ast.Name) or not target.id.isupper() or not computed(value):
        return {}
    own = eval(ast.unparse(value), {"__builtins__": {}})
    return {target.id: float(own)}


def computed(value) -> bool:
    """True of an expression of numbers alone."""
    parts = ast.BinOp | ast.UnaryOp | ast.operator | ast.unaryop
    return all(
        isinstance(node, parts) or (isinstance(node, ast.Constant) and type(node.value) in (int, float))
        for node in ast.walk(value)
    )


def twice(texts: dict[str, str]) -> dict[tuple[str, float], list[str]]:
    """(name, value) -> modules, where several have it."""
    found = defaultdict(list)
    for file, text in texts.items():
        for own in numbers(text).items():
            found[own].append(file)
    return {own: files for own, files in found.items() if len(files) > 1}


def test_no_number_has_its_name_and_value_in_two_modules():
    """One that means the same is imported; one that means something else has a name of its own."""
    files = [file for package in ("sdph", "coupling") for file in sorted((ROOT / package).rglob("*.py"))]
    texts = {str(file.relative_to(ROOT)): file.read_text(encoding="utf-8") for file in files}
    assert sum(len(numbers(text)) for text in texts.values()) > 500
    assert not twice(texts)


def test_numbers_are_found_however_they_are_written():
    one, other = "A: float = 1e-3\nB, C = 2, -0.5\nD = (1,)\n", "A = 0.001\nC = -1 / 2\nB = 3\nd = 1\nD = f(1)\n"
    assert twice({"one": one, "other": other}) == {("A", 1e-3): ["one", "other"], ("C", -0.5): ["one", "other"]}
