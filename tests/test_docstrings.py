"""Docstrings open with a verb or a noun, and say what a thing does or is."""

import ast

import pytest

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
QUESTIONS = {"What", "How", "Whether", "That", "Those", "Who", "Whose", "Where", "When", "Which", "Why"}
OPEN = {"Of", "After", "Before", "Between", "At", "For"}  # what they belong to, and not what they are
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def docstrings(text: str) -> list[tuple[int, str]]:
    """(line, docstring) of a module and of all in it."""
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, DOCUMENTED)]
    return [(node.body[0].lineno, found) for node in nodes if (found := ast.get_docstring(node))]


def is_question(docstring: str) -> bool:
    return docstring.split()[0].rstrip(",:") in QUESTIONS | OPEN


@pytest.mark.parametrize("package, least", [("sdph", 300), ("coupling", 300), ("validation", 100), ("benchmarks", 40)])
def test_docstrings_open_with_a_verb_or_a_noun(package, least):
    found = [
        (file, line, docstring)
        for file in sorted((ROOT / package).rglob("*.py"))
        for line, docstring in docstrings(file.read_text(encoding="utf-8"))
    ]
    assert len(found) > least
    questions = [
        f"{file.relative_to(ROOT)}:{line}: {docstring.splitlines()[0]}"
        for file, line, docstring in found
        if is_question(docstring)
    ]
    assert not questions, "open as questions do:\n" + "\n".join(questions)


def test_questions_are_found():
    text = 'class Rows:\n    """What a run is."""\n    def near(self):\n        """True where they are."""\n'
    assert [(line, is_question(found)) for line, found in docstrings(text)] == [(2, True), (4, False)]
