"""Writes the pages and parts that are made from the code: `write(docs)`. What is as it was is not touched."""

from __future__ import annotations

import argparse
import inspect
import os
import pkgutil
from pathlib import Path

import sdph.laws
from making import dashboard, docstrings, embedding, gallery, keys
from sdph import effects, scenes
from sdph.cli.arguments import parser
from sdph.engine import restart
from sdph.running import metrics

FOLDERS = ("generated", "scenes", "studies")
ROOMS = (  # whose docstrings tell how a run goes
    "sdph.running.simulation", "sdph.exchange.exchange", "sdph.exchange.window", "coupling.transfer", "coupling.gas",
    "coupling.embedded.solver", "sdph.methods.method", "sdph.methods.grains.method", "sdph.methods.grains.equations",
    "sdph.methods.grains.contacts", "sdph.methods.liquids.method", "sdph.methods.liquids.totals",
    "sdph.methods.liquids.correction", "sdph.methods.solids.method", "sdph.methods.mps.method", "sdph.engine.ledger",
    "sdph.engine.contact", "sdph.engine.restart",
)  # fmt: skip


def write(docs: Path) -> None:
    """All of them; files of the same folders that are made no more go."""
    wanted = made(docs)
    for folder in FOLDERS:
        (docs / folder).mkdir(exist_ok=True)
        for path in (docs / folder).glob("*.md"):
            if f"{folder}/{path.name}" not in wanted:
                path.unlink()
    for name, text in wanted.items():
        path = docs / name
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def made(docs: Path) -> dict[str, str]:
    """Page -> its Markdown."""
    found = {f"scenes/{name}.md": gallery.scene(name) for name in scenes.names()}
    found |= {f"studies/{name}.md": gallery.study(name) for name in gallery.studies()}
    return found | {
        "scenes/index.md": gallery.index(),
        "studies/index.md": gallery.all_studies(),
        "generated/keys.md": keys.tables(
            keys.of_a_case(), {row.name: _effect(row) for row in effects.REGISTRY.values()}
        ),
        "generated/droplet_keys.md": keys.tables(keys.of_a_droplet()),
        "generated/plausible.md": keys.plausible(),
        "generated/laws.md": "\n".join(docstrings.functions(name, 2) for name in _modules()),
        "generated/effects.md": "\n".join(map(_effect_page, effects.FILES)),
        "generated/commands.md": _commands(),
        "generated/rooms.md": "\n".join(docstrings.module(name, 2) for name in ROOMS),
        "generated/restart.md": docstrings.markdown(inspect.getdoc(restart)),
        "generated/metrics.md": _metrics(),
        "generated/dashboard.md": dashboard.whole(),
        "generated/benchmarks.md": _benchmarks(docs.parent),
        "generated/estimates.md": embedding.text("validation/estimates.md", "cost.md", 1),
        "generated/contributing.md": embedding.text("CONTRIBUTING.md", "contributing.md", 0),
        "generated/changes.md": embedding.text("CHANGELOG.md", "changes.md", 0),
    }


def _benchmarks(root: Path) -> str:
    """The README of the benchmarks, and each other page of theirs under its title."""
    parts = [embedding.text("benchmarks/README.md", "benchmarks.md", 0)]
    for path in sorted((root / "benchmarks").glob("[a-z]*.md")):
        title = path.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
        parts.append(f"## {title}\n\n{embedding.text(f'benchmarks/{path.name}', 'benchmarks.md', 1)}")
    return "\n\n".join(parts)


def _modules() -> list[str]:
    """Rooms of the laws that hold formulas."""
    return [f"sdph.laws.{info.name}" for info in pkgutil.iter_modules(sdph.laws.__path__) if info.name != "compiled"]


def _effect(row) -> str:
    return f"Effect on {', '.join(row.matter)}: {docstrings.escaped(row.summary)}"


def _effect_page(file) -> str:
    text = docstrings.markdown(file.__doc__)
    link = f"{{src}}`{docstrings.file(file)}`, [keys](#keys-{file.EFFECT.name.replace('_', '-')})"
    return f"## {file.EFFECT.name}\n\n{link}\n\n{text}\n"


def _metrics() -> str:
    """A row for each name that `run.metrics` may hold."""
    rows = [f"| `{name}` | {docstrings.escaped(_first_line(own))} |" for name, own in metrics.AT_OUTPUTS.items()]
    return "\n".join(["| name | columns |\n|--|--|", *rows])


def _first_line(function) -> str:
    return " ".join(function.__doc__.split("\n\n")[0].split())


def _commands() -> str:
    """Help of every command."""
    os.environ["COLUMNS"] = "100"  # of its lines
    found = next(action for action in parser()._actions if isinstance(action, argparse._SubParsersAction))
    return "\n".join(f"### sdph {name}\n\n```text\n{own.format_help()}```\n" for name, own in found.choices.items())
