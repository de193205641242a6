"""Pages of source files, and the role `src`: {src}`sdph/laws/drag.py:wen_yu` leads to the line where it is defined.

A file or a name that is not there is a warning, so that no page can speak of code that has gone.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx.util import logging
from sphinx.util.docutils import SphinxRole

LOG = logging.getLogger(__name__)
ROOT = Path(__file__).parents[2]
TITLED = re.compile(r"(?P<title>.+?)\s*<(?P<target>[^>]+)>", re.DOTALL)


@cache
def lines(file: str) -> dict[str, int]:
    """Line of each function, class, method and constant of a Python file, by its dotted name."""
    found: dict[str, int] = {}
    _define(ast.parse((ROOT / file).read_text(encoding="utf-8")).body, "", found)
    return found


def _define(body: list[ast.stmt], prefix: str, found: dict[str, int]) -> None:
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found[prefix + node.name] = node.lineno
            _define(node.body, f"{prefix}{node.name}.", found)
        elif isinstance(node, ast.Assign):
            names = [name for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name)]
            found |= {prefix + name.id: node.lineno for name in names}


class Source(SphinxRole):
    """A link to a file, or to a name in it."""

    def run(self):
        match = TITLED.fullmatch(self.text)
        target = match["target"] if match else self.text
        file, _, name = target.partition(":")
        title = match["title"] if match else target.removeprefix("sdph/")
        if not (ROOT / file).is_file():
            LOG.warning("no such file: %s", target, location=self.get_location())
            return [nodes.literal(text=title)], []
        if name and name not in lines(file):
            LOG.warning("no %s in %s", name, file, location=self.get_location())
        used = self.env.__dict__.setdefault("sdph_sources", {})
        used.setdefault(self.env.docname, set()).add(file)
        place = f"#L-{lines(file)[name]}" if name and name in lines(file) else ""
        address = f"{'../' * self.env.docname.count('/')}{page(file)}.html{place}"
        text = nodes.inline(text=title) if match else nodes.literal(text=title)
        return [nodes.reference("", "", text, refuri=address, internal=True)], []


def page(file: str) -> str:
    """Name of the page of a file."""
    return f"source/{file}"


PAGE = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{file}</title>
<link rel="stylesheet" href="{up}_static/pygments.css"></head>
<body class="source"><p><a href="{up}index.html">sdph</a> / {file}</p>{code}</body></html>
"""


def write_pages(app, failure) -> None:
    """Write a page for each file that others lead to, without the navigation, which would take most of the time."""
    form = HtmlFormatter(linenos="inline", lineanchors="L", anchorlinenos=True)
    found = set().union(*getattr(app.env, "sdph_sources", {}).values()) if failure is None else ()
    for file in sorted(found):
        try:
            lexer = get_lexer_for_filename(file)
        except ClassNotFound:
            lexer = TextLexer()
        code = highlight((ROOT / file).read_text(encoding="utf-8"), lexer, form)
        target = Path(app.outdir) / f"{page(file)}.html"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(PAGE.format(file=file, code=code, up="../" * page(file).count("/")), encoding="utf-8")


def purge(app, env, docname) -> None:
    """Forget what a page led to."""
    getattr(env, "sdph_sources", {}).pop(docname, None)


def merge(app, env, names, other) -> None:
    """Take over what pages led to that another process has read."""
    found = getattr(other, "sdph_sources", {})
    env.__dict__.setdefault("sdph_sources", {}).update({name: found[name] for name in names if name in found})


def setup(app):
    """Register the role, and the pages that it leads to."""
    app.add_role("src", Source())
    app.connect("env-purge-doc", purge)
    app.connect("env-merge-info", merge)
    app.connect("build-finished", write_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
