"""Pages of the repository inside the site: READMEs, their headings and links put right for where they stand."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path

from sdph import scenes
from sdph.study.validate import STUDIES

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"(?P<mark>!?)\[(?P<text>[^\]]*)\]\((?P<target>[^)\s]+)\)")
FENCE = re.compile(r"(^```.*?^```$)", re.DOTALL | re.MULTILINE)
PICTURES = (".png", ".gif", ".svg")
PAGES = {
    "README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "benchmarks/README.md": "benchmarks.md",
    "CHANGELOG.md": "changes.md", "validation": "dashboard.md", "CITATION.cff": "cite.md",
}  # fmt: skip


def text(file: str, page: str, level: int, pictures: bool = True) -> str:
    """A Markdown file of the repository for a page of docs: without its title, headings so many levels down."""
    body = re.sub(r"\A# .*\n", "", (ROOT / file).read_text(encoding="utf-8"))
    parts = FENCE.split(body)
    return "".join(part if part.startswith("```") else _moved(part, file, page, level, pictures) for part in parts)


def _moved(part: str, file: str, page: str, level: int, pictures: bool) -> str:
    part = re.sub(r"^#", "#" * (level + 1), part, flags=re.MULTILINE)
    return LINK.sub(lambda match: _link(match, posixpath.dirname(file), posixpath.dirname(page), pictures), part)


def _link(match: re.Match, here: str, there: str, pictures: bool) -> str:
    mark, shown, target = match["mark"], match["text"], match["target"]
    if target.startswith(("http", "#")):
        return match[0]
    path, _, anchor = target.partition("#")
    path = posixpath.normpath(posixpath.join(here, path))
    if mark or path.endswith(PICTURES):
        own = posixpath.relpath(path, posixpath.join("docs", there))
        return f"{mark}[{shown}]({own})" if pictures or not mark else ""
    page = page_of(path)
    if page:
        return f"[{shown}]({posixpath.relpath(page, there or '.')}{'#' + anchor if anchor else ''})"
    if (ROOT / path).is_file():
        return f"{{src}}`{shown.strip('`')} <{path}>`"
    return shown


def page_of(path: str) -> str | None:
    """Page of docs that shows a file or folder of the repository; None where none does."""
    if path.startswith("docs/"):
        return path.removeprefix("docs/")
    if path in PAGES:
        return PAGES[path]
    folder = path.removesuffix("/README.md")
    name = posixpath.basename(folder)
    if folder in (f"validation/{name}", f"sdph/scenes/{name}"):
        return page_of_scene(name)
    return None


def page_of_scene(name: str) -> str | None:
    """Page of a scene, or of another folder of validation with a README."""
    if name in scenes.names():
        return f"scenes/{name}.md"
    return f"studies/{name}.md" if name in STUDIES or (ROOT / "validation" / name / "README.md").is_file() else None
