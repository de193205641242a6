"""Builds the documentation: `python docs/build.py [--out docs/site]` turns docs/*.md into HTML.

A line that begins with @ is filled in from the code, so that it cannot go stale:

    @include FILE        a file of the repository, as code
    @doc MODULE          the docstring of a module, and where it lies
    @laws  @effects      every law with its formula, every effect with its section
    @reference           every key of a case: unit, default, bounds
    @droplet             every key of `sdph droplet`
    @gallery             every scene: picture, title, how to run it
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import inspect
import pkgutil
import shutil
import sys
from pathlib import Path

from markdown_it import MarkdownIt

HERE = Path(__file__).parent
ROOT = HERE.parent
STYLE = """body { font: 16px/1.5 sans-serif; max-width: 900px; margin: 2em auto; padding: 0 1em }
pre { background: #f5f5f5; padding: 0.8em; overflow: auto }
td, th { padding: 0.2em 0.8em 0.2em 0; text-align: left; vertical-align: top } img { max-width: 100% }"""
PAGE = (
    '<!doctype html><html lang="en"><head><meta '
    'charset="utf-8"><title>{title}</title><style>{style}</style></head><body>{body}</body></html>\n'
)
NONE = (inspect.Parameter.empty, dataclasses.MISSING)


def include(path: str) -> str:
    kind = {".py": "python", ".toml": "toml"}.get(Path(path).suffix, "")
    return f"`{path}`:\n\n```{kind}\n{(ROOT / path).read_text(encoding='utf-8')}```\n"


def doc(name: str) -> str:
    module = importlib.import_module(name)
    return f"### `{_file(module)}`\n\n```\n{inspect.getdoc(module)}\n```\n"


def laws() -> str:
    """Every public function of sdph.laws with its docstring."""
    import sdph.laws

    parts = []
    for info in pkgutil.iter_modules(sdph.laws.__path__):
        module = importlib.import_module(f"sdph.laws.{info.name}")
        own = [
            f for f in map(_python, vars(module).values()) if inspect.isfunction(f) and f.__module__ == module.__name__
        ]
        parts.append(f"### `{_file(module)}`\n\n{inspect.getdoc(module)}\n")
        parts += [
            f"**{f.__name__}{inspect.signature(f)}**\n\n```\n{inspect.getdoc(f)}\n```\n"
            for f in own
            if f.__doc__ and f.__name__[0] != "_"
        ]
    return "\n".join(parts)


def _python(function):
    """The function behind a compiled one."""
    return getattr(function, "py_func", function)


def effects() -> str:
    from sdph.effects import FILES

    return "\n".join(
        f"### {file.EFFECT.name}\n\n`{_file(file)}`\n\n```\n{inspect.getdoc(file)}\n```\n" for file in FILES
    )


def reference() -> str:
    """Sections of a case from its dataclasses."""
    from sdph import effects as all_effects
    from sdph.case import sections as declared

    sections = declared.SECTIONS | {f"{name}.NAME": cls for name, cls in declared.GROUPS.items()}
    sections |= {
        "coupling": declared.Coupling,
        "vapour": declared.Vapour,
        "liquid": declared.Liquid,
        "method": declared.LiquidMethod,
        "gas_phase": declared.GasPhase,
        "solid": declared.Solid,
    }
    sections |= {name: row.parameters for name, row in all_effects.REGISTRY.items()}
    return "\n".join(_keys(name, cls) for name, cls in sections.items())


def droplet() -> str:
    """Sections of `sdph droplet`."""
    from sdph.study.gel_droplet.sections import CLASSES

    return "\n".join(_keys(name, cls) for name, cls in CLASSES.items())


def _keys(section: str, cls) -> str:
    from sdph.schema import fields

    text = (cls.__doc__ or "").strip() if not (cls.__doc__ or "").startswith(cls.__name__ + "(") else ""
    rows = [f"| `{key}` | {_default(cls, name)} | {_allowed(kind)} |" for key, (name, kind) in fields(cls).items()]
    table = "\n".join(["| key | default | allowed |", "|--|--|--|", *rows]) if rows else "No keys."
    return f"### [{section}]\n\n{text}\n\n{table}\n"


def _default(cls, name: str) -> str:
    from sdph.schema import write

    field = next(f for f in dataclasses.fields(cls) if f.name == name)
    if field.default in NONE:
        return "required"
    bare = object.__new__(cls)
    for other in dataclasses.fields(cls):
        object.__setattr__(bare, other.name, other.default if other.default is not dataclasses.MISSING else None)
    return str(write(bare).get(field.metadata["kind"].key(name), "not given"))


def _allowed(kind) -> str:
    if kind.choices:
        return ", ".join(kind.choices)
    low = (
        f"above {kind.above:g}"
        if kind.above > float("-inf")
        else f"at least {kind.least:g}"
        if kind.least > float("-inf")
        else ""
    )
    high = f"at most {kind.most:g}" if kind.most < float("inf") else ""
    what = {
        bool: "true or false",
        int: "a whole number",
        str: "a text",
        Path: "the path of a file, from the folder of the case file",
    }.get(kind.of, "numbers" if kind.components is None else "a number")
    return f"{what} {' and '.join(filter(None, (low, high)))}"


def gallery() -> str:
    from sdph import scenes

    return "\n".join(_scene(scenes.HERE / name) for name in scenes.names())


def _scene(folder: Path) -> str:
    from sdph import scenes

    pictures = "".join(
        f"![{folder.name}]({folder.name}-{picture.name})\n\n" for picture in sorted(folder.glob("*.png"))
    )
    return (
        f"## {folder.name}\n\n{scenes.title(folder.name)}\n\n{pictures}`sdph run {folder.name}`, "
        f"[case.toml]({folder.name}.toml)\n"
    )


def _file(module) -> str:
    return str(Path(module.__file__).relative_to(ROOT))


FILLED = {
    "@include": include,
    "@doc": doc,
    "@laws": laws,
    "@effects": effects,
    "@reference": reference,
    "@droplet": droplet,
    "@gallery": gallery,
}


def page(source: Path) -> str:
    """The markdown of a page, its @ lines filled in."""
    lines = []
    for line in source.read_text(encoding="utf-8").splitlines():
        word, *arguments = line.split() or [""]
        lines.append(FILLED[word](*arguments) if word in FILLED else line)
    return "\n".join(lines)


def build(target: Path) -> list[Path]:
    """All pages and pictures into `target`; the pages."""
    from sdph import scenes

    target.mkdir(parents=True, exist_ok=True)
    for name in scenes.names():
        shutil.copy(scenes.HERE / name / "case.toml", target / f"{name}.toml")
        for picture in (scenes.HERE / name).glob("*.png"):
            shutil.copy(picture, target / f"{name}-{picture.name}")
    markdown, pages = MarkdownIt("commonmark").enable("table"), []
    for source in sorted(HERE.glob("*.md")):
        text = page(source).replace(".md)", ".html)")
        pages.append(target / f"{source.stem}.html")
        pages[-1].write_text(PAGE.format(title=source.stem, style=STYLE, body=markdown.render(text)), encoding="utf-8")
    return pages


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=HERE / "site")
    sys.path.insert(0, str(ROOT))
    for path in build(parser.parse_args().out):
        print(path)
