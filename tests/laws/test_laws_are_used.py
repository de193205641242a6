"""Every name in sdph/laws is used by what runs or by what validates: a law that only tests call tests nothing."""

import ast
from pathlib import Path

ROOT = Path(__file__).parents[2]
LAWS = ROOT / "sdph" / "laws"
USERS = ("sdph", "coupling", "validation")


def defined(tree) -> dict[str, ast.AST]:
    """Top-level names of a module: functions, classes and what is assigned."""
    names = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names[node.name] = node
        for target in node.targets if isinstance(node, ast.Assign) else ():
            names |= {part.id: node for part in ast.walk(target) if isinstance(part, ast.Name)}
    return names


def aliases(tree) -> tuple[dict, dict]:
    """Names that a file gives to modules of laws, and to what is in them, (module, name)."""
    modules, members = {}, {}
    for node in ast.walk(tree):
        if not isinstance(node, ast.ImportFrom):
            continue
        for alias in node.names:
            if node.module == "sdph.laws":
                modules[alias.asname or alias.name] = alias.name
            elif (node.module or "").startswith("sdph.laws."):
                members[alias.asname or alias.name] = (node.module.removeprefix("sdph.laws."), alias.name)
    return modules, members


def used(tree, modules, members) -> set[tuple[str, str]]:
    """(module, name) of all that a tree takes from laws."""
    found = {members[n.id] for n in ast.walk(tree) if isinstance(n, ast.Name) and n.id in members}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            found.add((modules[node.value.id], node.attr))
    return found


def reached() -> tuple[set, set]:
    """(module, name) of what laws define, and of what is used from outside, directly or by way of other laws."""
    needs, seen = {}, set()
    for file in LAWS.glob("*.py"):
        if file.stem == "by_reference":  # no law: numba calls what it holds
            continue
        tree = ast.parse(file.read_text(encoding="utf-8"))
        modules, members = aliases(tree)
        own = defined(tree)
        members |= {name: (file.stem, name) for name in own}
        needs |= {(file.stem, name): used(node, modules, members) for name, node in own.items()}
        for node in tree.body:
            if isinstance(node, ast.Expr):  # called as the module is imported
                seen |= used(node, modules, members)
    for room in USERS:
        for file in (ROOT / room).rglob("*.py"):
            if LAWS not in file.parents:
                tree = ast.parse(file.read_text(encoding="utf-8"))
                seen |= used(tree, *aliases(tree))
    left = list(seen)
    while left:
        new = needs.get(left.pop(), set()) - seen
        seen |= new
        left += new
    return set(needs), seen


def test_every_law_is_called_by_production_or_validation():
    laws, seen = reached()
    assert len(laws) > 100
    assert sorted(".".join(name) for name in laws - seen) == []
