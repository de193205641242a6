"""The documentation is built, its links lead somewhere, and its commands do what it says."""

import importlib.util
import re
import shlex

import pytest

from sdph import cli
from sdph.scenes import paths

DOCS = paths.PACKAGE.parent / "docs"
FENCE = re.compile(r"`(?P<file>[\w/.]+)`:\n\n```toml\n(?P<text>.*?)```|```sh\n(?P<commands>.*?)```", re.DOTALL)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    spec = importlib.util.spec_from_file_location("docs_build", DOCS / "build.py")
    builder = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(builder)
    folder = tmp_path_factory.mktemp("site")
    assert builder.build(folder)
    return folder


def test_links_and_pictures_lead_somewhere(site):
    links = [
        (page, link)
        for page in site.glob("*.html")
        for link in re.findall(r'(?:href|src)="([^"#]+)"', page.read_text())
    ]
    assert len(links) > 20
    for page, link in links:
        assert (site / link).is_file(), f"{page.name}: {link}"


def test_pages_were_filled_in(site):
    assert not [page for page in site.glob("*.html") if re.search(r"<p>@\w+", page.read_text())]
    assert "particles.NAME" in (site / "reference.html").read_text()
    assert "required" in (site / "reference.html").read_text()
    assert "wen_yu" in (site / "theory.html").read_text()


@pytest.mark.parametrize("page", [path.stem for path in sorted(DOCS.glob("*.md")) if "```sh" in path.read_text()])
def test_commands_do_what_the_page_says(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for block in FENCE.finditer((DOCS / f"{page}.md").read_text()):
        if block["file"]:
            (tmp_path / block["file"]).write_text(block["text"])
            continue
        for command in block["commands"].splitlines():
            program, *words = shlex.split(command)
            assert program == "sdph"
            assert cli.main(words) == 0, command
    assert list(tmp_path.iterdir())
