"""Gallery: a page for each scene, and one for each study of validation/ that is no scene."""

from __future__ import annotations

from pathlib import Path

from making import dashboard, embedding
from sdph import scenes

ROOT = Path(__file__).parents[2]
COVER = ("bed.png", "spray.png", "liquid.png", "solid.png", "disc.png")


def picture(name: str) -> str | None:
    """The picture of a scene, from docs/scenes; None where it has none."""
    for folder in ("sdph/scenes", "validation"):
        found = sorted(path.name for path in (ROOT / folder / name).glob("*.png") if path.name != "cost.png")
        if found:
            return f"../../{folder}/{name}/{min(found, key=lambda one: one not in COVER)}"
    return None


def scene(name: str) -> str:
    """Page of a scene: picture, how to run it, what it is, its case, what it was checked against."""
    page, own = f"scenes/{name}.md", [f"# {name}", scenes.title(name)]
    readme = f"sdph/scenes/{name}/README.md"
    shown = picture(name)
    if shown:
        own.append(f"![{scenes.title(name)}]({shown})")
    own.append(f"```text\nsdph run {name}\nsdph validate {name}\n```")
    if (ROOT / readme).is_file():
        own.append(embedding.text(readme, page, 1, pictures=False))
    own.append(f"## Checks\n\n{dashboard.of_scene(name)}")
    proof = f"validation/{name}/README.md"
    if (ROOT / proof).is_file():
        own.append(f"## How it was checked, and what fell short\n\n{embedding.text(proof, page, 1)}")
    own.append(f"## Its case\n\n```{{literalinclude}} ../../sdph/scenes/{name}/case.toml\n:language: toml\n```")
    return "\n\n".join(own) + "\n"


def study(name: str) -> str:
    """Page of a study."""
    file = f"validation/{name}/README.md"
    title = (ROOT / file).read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
    checks = f"## Checks\n\n{dashboard.of_scene(name)}\n\n" if name in embedding.STUDIES else ""
    return f"# {title}\n\n{checks}## What was done\n\n{embedding.text(file, f'studies/{name}.md', 1)}\n"


def studies() -> list[str]:
    """Folders of validation/ that are no scene and have a README."""
    found = (path.parent.name for path in (ROOT / "validation").glob("*/README.md"))
    return sorted(name for name in found if name not in scenes.names())


def index() -> str:
    """The gallery itself: every scene with its picture, and the studies."""
    cards = "\n\n".join(_card(name) for name in scenes.names())
    pages = "\n".join(scenes.names())
    without = ", ".join(f"[{name}]({name}.md)" for name in scenes.names() if picture(name) is None)
    return (
        f"# Gallery\n\nEvery scene that comes along: `sdph run NAME` runs it, `sdph init NAME DIR` makes it yours.\n\n"
        f":::{{container}} gallery\n\n{cards}\n\n:::\n\nNo picture yet: {without or 'none'}.\n\n"
        f"```{{toctree}}\n:hidden:\n\n{pages}\n```\n"
    )


def _card(name: str) -> str:
    shown = picture(name)
    top = f"[![{name}]({shown})]({name}.md)\\\n" if shown else ""
    return f"{top}[**{name}**]({name}.md)\\\n{scenes.title(name)}"


def all_studies() -> str:
    """Page that lists the studies."""
    lines = [f"- [{name}]({name}.md)" for name in studies()]
    pages = "\n".join(studies())
    text = "Checks that stand for no single scene: `sdph validate NAME` runs those on the dashboard.\n\n"
    return f"# Studies\n\n{text}" + "\n".join(lines) + f"\n\n```{{toctree}}\n:hidden:\n\n{pages}\n```\n"
