"""Where a fault can be put in Python: arithmetic, comparisons, indices and added terms of lines that compute.

No site is what only says something: texts, messages, annotations, functions that return a text, and the estimates of
`sdph explain` (functions named `call`), which claim to be right within a factor of ten. Named constants are sites in
laws alone: elsewhere they are tolerances, waiting times and choices that no result may hang on.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from .fault import Fault, numbered

FACTOR = "1.2"
TALK = ("print", "warn", "warning", "CaseError", "ValueError", "Unfit", "GasError", "choice", "quantity", "Judgement")
TEXTS = ("str", "list[str]", "tuple[str, ...]")
SWAPS = {ast.Add: ("+", "-"), ast.Sub: ("-", "+")}
TURNS = {ast.Lt: ("<", ">"), ast.LtE: ("<=", ">="), ast.Gt: (">", "<"), ast.GtE: (">=", "<=")}
EDGES = {ast.Lt: ("<", "<="), ast.LtE: ("<=", "<"), ast.Gt: (">", ">="), ast.GtE: (">=", ">")}
PLACES = re.compile(r"folder|draft|path|Path|HERE|scratch")  # what a "/" puts together is the name of a file
NEXT = {"x": "y", "y": "z", "z": "x", "u": "v", "v": "w", "w": "u", "i": "j", "j": "i"}


def sites(room: str, file: str, source: bytes) -> list[Fault]:
    """All faults that a file has room for."""
    return numbered(_Reader(room, file, source).of(ast.parse(source)))


class _Reader:
    def __init__(self, room: str, file: str, source: bytes):
        self.room, self.file, self.source = room, file, source
        self.starts = [0]
        for line in source.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))
        self.where, self.names = "", set()

    def of(self, tree: ast.Module) -> Iterator[Fault]:
        for node in tree.body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                yield from self._definition(node, "")
            elif self.file.startswith("sdph/laws/") and isinstance(node, ast.Assign) and _is_number(node.value):
                self.where = ast.unparse(node.targets[0])
                yield from self._factor(node.value)

    def _definition(self, node, inside: str) -> Iterator[Fault]:
        name = f"{inside}{node.name}"
        if isinstance(node, ast.ClassDef):
            for part in node.body:
                if isinstance(part, ast.FunctionDef):
                    yield from self._definition(part, f"{name}.")
            return
        if node.name == "call" or (node.returns and ast.unparse(node.returns) in TEXTS):
            return
        self.names = {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
        self.names |= {argument.arg for argument in node.args.args}
        for statement in node.body:
            self.where = name
            yield from self._walk(statement, None, name)

    def _walk(self, node, parent, name: str) -> Iterator[Fault]:
        if isinstance(node, ast.FunctionDef):
            yield from self._definition(node, f"{name}.")
            self.where = name
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.JoinedStr | ast.Raise | ast.Assert) or _talks(node):
            return
        yield from self._own(node, parent)
        for field, child in ast.iter_fields(node):
            if field not in ("annotation", "returns", "decorator_list"):
                for part in child if isinstance(child, list) else [child]:
                    if isinstance(part, ast.AST):
                        yield from self._walk(part, node, name)

    def _own(self, node, parent) -> Iterator[Fault]:
        if isinstance(node, ast.BinOp) and not _is_text(node):
            yield from self._arithmetic(node, parent)
        elif isinstance(node, ast.AugAssign) and type(node.op) in SWAPS and not _is_text(node):
            yield self._between(node.target, node.value, *SWAPS[type(node.op)], "sign")
            yield self._fault(*self._span(node), "pass", "drop")
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and not isinstance(parent, ast.Subscript):
            start, end = self._span(node)
            yield self._fault(start, end, self._text(node.operand), "sign")
        elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in TURNS:
            kind, table = ("off by one", EDGES) if _counts(node) else ("sign", TURNS)
            yield self._between(node.left, node.comparators[0], *table[type(node.ops[0])], kind)
        elif isinstance(node, ast.Subscript):
            yield from self._subscript(node)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and node.attr in "xyzuvw":
            _, end = self._span(node)
            yield self._fault(end - 1, end, NEXT[node.attr], "index")
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "range":
            yield from self._more(node.args)

    def _arithmetic(self, node: ast.BinOp, parent) -> Iterator[Fault]:
        if type(node.op) in SWAPS:
            if _counted(parent) and isinstance(node.right, ast.Constant):
                yield from self._more([node.right])
                return
            yield self._between(node.left, node.right, *SWAPS[type(node.op)], "sign")
            yield self._fault(*self._span(node), self._text(node.left), "drop")
        elif isinstance(node.op, ast.Mult | ast.Div) and not _is_product(parent):
            yield from self._factor(node)
        elif isinstance(node.op, ast.Pow) and isinstance(node.right, ast.Constant):
            yield from self._factor(node.right)

    def _factor(self, node) -> Iterator[Fault]:
        yield self._fault(*self._span(node), f"({FACTOR} * ({self._text(node)}))", "factor")

    def _subscript(self, node: ast.Subscript) -> Iterator[Fault]:
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        for part in parts:
            if isinstance(part, ast.Name) and part.id in ("i", "j") and NEXT[part.id] in self.names:
                yield self._fault(*self._span(part), NEXT[part.id], "index")
            elif isinstance(part, ast.Constant) and isinstance(part.value, int):
                yield self._fault(*self._span(part), str(1 - part.value if part.value < 2 else 0), "index")
            elif isinstance(part, ast.Slice):
                yield from self._more([part.lower, part.upper])

    def _more(self, nodes) -> Iterator[Fault]:
        for node in nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, int):
                yield self._fault(*self._span(node), str(node.value + 1), "off by one")

    def _between(self, left, right, old: str, new: str, kind: str) -> Fault:
        """A sign between two operands, brackets beside it passed over."""
        start, end = self._span(left)[1], self._span(right)[0]
        at = start + self.source[start:end].index(old.encode())
        return self._fault(at, at + len(old), new, kind)

    def _span(self, node) -> tuple[int, int]:
        return (
            self.starts[node.lineno - 1] + node.col_offset,
            self.starts[node.end_lineno - 1] + node.end_col_offset,
        )

    def _text(self, node) -> str:
        start, end = self._span(node)
        return self.source[start:end].decode()

    def _fault(self, start: int, end: int, new: str, kind: str) -> Fault:
        line = self.source.count(b"\n", 0, start) + 1
        old = self.source[start:end].decode()
        return Fault(self.room, self.file, start, end, line, kind, self.where, old, new)


def _talks(node) -> bool:
    """Whether a node is a text, or a call that says something, declares an input or counts rows of equal number."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return True
    function = node.func if isinstance(node, ast.Call) else None
    return getattr(function, "id", getattr(function, "attr", None)) in (*TALK, "len")


def _is_text(node) -> bool:
    """Whether texts, lists, sets or names of files are put together."""
    parts = (getattr(node, "left", None), getattr(node, "right", None), getattr(node, "value", None))
    kinds = ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp | ast.Set | ast.SetComp
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div) and PLACES.search(ast.unparse(node.left)):
        return True
    if any(isinstance(part, ast.Call) and ast.unparse(part.func) in ("set", "str") for part in parts):
        return True
    return any(
        isinstance(part, kinds) or (isinstance(part, ast.Constant) and isinstance(part.value, str | bytes))
        for part in parts
    )


def _is_number(node) -> bool:
    return isinstance(getattr(node, "operand", node), ast.Constant) and isinstance(ast.literal_eval(node), float)


def _is_product(node) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div)


def _counted(node) -> bool:
    """Whether what a node holds is a place or a number of things."""
    return isinstance(node, ast.Subscript | ast.Slice) or (
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "range"
    )


def _counts(node: ast.Compare) -> bool:
    """Whether a comparison is of numbers of things."""
    return any(
        (isinstance(part, ast.Constant) and type(part.value) is int)
        or (isinstance(part, ast.Call) and isinstance(part.func, ast.Name) and part.func.id == "len")
        for part in (node.left, *node.comparators)
    )
