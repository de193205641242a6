"""Docstrings as Markdown: paragraphs flow, what is set in columns or indented stays as it stands."""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
SPECIAL = re.compile(r"([\\*_\[\]<>$|#~^{}])")
COLUMNS = re.compile(r"\S {2,}\S")  # words set in columns


def markdown(text: str) -> str:
    """A docstring as Markdown."""
    return "\n\n".join(_block(block) for block in re.split(r"\n\s*\n", inspect.cleandoc(text)))


def _block(block: str) -> str:
    lines = block.splitlines()
    if all(line.startswith("  ") for line in lines) or any(COLUMNS.search(line) for line in lines):
        return f"```{{code-block}} text\n:class: docstring\n\n{block}\n```"
    return escaped(block)


def escaped(text: str) -> str:
    """Text as Markdown that reads the same; what stands in backticks stays code."""
    parts = re.split(r"(`[^`\n]+`)", text)
    return "".join(part if part.startswith("`") else SPECIAL.sub(r"\\\1", part) for part in parts)


def module(name: str, level: int) -> str:
    """A module: its file and its docstring."""
    found = importlib.import_module(name)
    return f"{'#' * level} {name}\n\n{{src}}`{file(found)}`\n\n{markdown(inspect.getdoc(found))}\n"


def functions(name: str, level: int) -> str:
    """A module with its public functions, each with its formula as it stands in the code."""
    found = importlib.import_module(name)
    return "\n".join([module(name, level), *(_function(found, own) for own in _own(found))])


def _own(found) -> list:
    """Public functions that a module defines, compiled or not, with a docstring."""
    plain = (getattr(value, "py_func", value) for value in vars(found).values())
    return [
        f for f in plain
        if inspect.isfunction(f) and f.__module__ == found.__name__ and f.__doc__ and f.__name__[0] != "_"
    ]  # fmt: skip


def _function(found, function) -> str:
    bare = inspect.signature(function)
    signature = bare.replace(
        parameters=[p.replace(annotation=p.empty) for p in bare.parameters.values()],
        return_annotation=bare.empty,
    )
    text = markdown(inspect.getdoc(function))
    return (
        f"````{{py:function}} {found.__name__}.{function.__name__}{signature}\n\n"
        f"{text}\n\n{{src}}`code <{file(found)}:{function.__name__}>`\n````\n"
    )


def file(found) -> str:
    """Path of a module's file from the root."""
    return str(Path(found.__file__).relative_to(ROOT))
