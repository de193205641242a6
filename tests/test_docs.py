"""The documentation builds without a warning, its links lead somewhere, and its commands do what it says."""

import html.parser
import importlib
import re
import shlex
import subprocess
import sys
from urllib.parse import unquote

import pytest

from sdph import cli
from sdph.scenes import paths
from sdph.study import compare, validate

ROOT = paths.PACKAGE.parent
DOCS = ROOT / "docs"
MADE = ("generated", "scenes", "studies", "site")  # folders of docs that are made, not written
FENCE = re.compile(r"`(?P<file>[\w/.]+)`:\n\n```(?:toml|text)\n(?P<text>.*?)```|```sh\n(?P<commands>.*?)```", re.DOTALL)
PYTHON = re.compile(r"```python\n(.*?)```", re.DOTALL)
SPELLED = ("*.md", "*.py", "*.toml", "*.C", "*.H")


def written() -> list[str]:
    """Pages that stand in docs, by their path there without .md."""
    found = (path.relative_to(DOCS) for path in sorted(DOCS.rglob("*.md")))
    return [str(path.with_suffix("")) for path in found if path.parts[0] not in MADE]


def blocks(page: str, pattern: re.Pattern) -> list:
    return list(pattern.finditer((DOCS / f"{page}.md").read_text(encoding="utf-8")))


class Page(html.parser.HTMLParser):
    """Places that a page has, and addresses that it leads to."""

    def __init__(self, path):
        super().__init__()
        self.places, self.links = {""}, []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.places.add(given.get("id"))
        self.links += [given[key] for key in ("href", "src") if given.get(key) and tag != "use"]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    words = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-d", folder / "kept", DOCS, folder / "html"]
    told = subprocess.run(words, capture_output=True, text=True)
    assert told.returncode == 0, told.stderr
    return folder / "html"


@pytest.fixture(scope="module")
def pages(site):
    return {path: Page(path) for path in site.rglob("*.html")}


def test_links_lead_to_pages_and_places(site, pages):
    lost, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            address, _, place = unquote(link).partition("#")
            if re.match(r"\w+:", address):
                continue
            target, count = (path.parent / address.partition("?")[0]).resolve() if address else path, count + 1
            if not target.exists() or (target in pages and place not in pages[target].places):
                lost.append(f"{path.relative_to(site)}: {link}")
    assert not lost
    assert count > 1000


def test_no_page_needs_a_network(site, pages):
    """Scripts, styles and pictures are in the site."""
    loads = re.compile(r'<(?:script|link|img)\b[^>]*(?:src|href)="https?:')
    assert not [path.name for path in pages if loads.search(path.read_text(encoding="utf-8"))]


def test_pages_were_filled_in(site):
    def text(name):
        return (site / name).read_text(encoding="utf-8")

    assert "particles.NAME" in text("reference.html") and "required" in text("reference.html")
    assert "wen_yu" in text("laws.html") and 'id="keys-drag"' in text("reference.html")
    assert "stefan_tube" in text("scenes/index.html")


@pytest.mark.parametrize("page", [page for page in written() if blocks(page, FENCE)])
def test_commands_do_what_the_page_says(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for block in blocks(page, FENCE):
        if block["file"]:
            (tmp_path / block["file"]).write_text(block["text"])
            continue
        for command in block["commands"].splitlines():
            program, *words = shlex.split(command, comments=True)
            assert program == "sdph"
            assert cli.main(words) == 0, command
    assert list(tmp_path.iterdir())


@pytest.mark.parametrize("page", [page for page in written() if blocks(page, PYTHON) and page != "python"])
def test_python_does_what_the_page_says(page, tmp_path, monkeypatch):
    """One block after the other; those of docs/python.md are in tests/api."""
    monkeypatch.chdir(tmp_path)
    for block in blocks(page, FENCE):
        if block["file"]:
            (tmp_path / block["file"]).write_text(block["text"])
    known = {}
    for block in blocks(page, PYTHON):
        exec(block[1], known)


def test_dashboard_tells_misses_first_and_who_has_no_record(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    dashboard = importlib.import_module("making.dashboard")
    checks = [compare.check("one, exact: fine", 1.0, 1.0, 0.1), compare.check("one, exact: off", 2.0, 1.0, 0.1)]
    made = {"scene": "one", "date": "2026-11-25", "version": "0.1.0", "commit": None, "gas": "embedded"}
    monkeypatch.setattr(dashboard, "records", lambda: {"one": made | {"checks": checks}})
    monkeypatch.setattr(dashboard, "validated", lambda: ["one", "two"])
    text = dashboard.whole()
    assert "1 of 2 scenes and studies have a record, with 2 checks, of which 1 miss" in text
    assert "| one, exact: off | 2 | 1 | 1 | 0.1 | **missed** |" in text.partition("## Scenes")[0]
    assert "| one | 2 | 1 | 2026-11-25 | 0.1.0 | ? | embedded |" in text and "## Without a record\n\ntwo." in text
    every = text.partition("## Every check")[2]
    assert every.index("| exact: off |") < every.index("| exact: fine |")


def test_dashboard_tells_what_a_validation_runs_and_its_record_lacks(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    dashboard = importlib.import_module("making.dashboard")
    assert {study: tuple(parts) for study, parts in dashboard.PARTS.items()} == {
        study: (*validate.part(study).NAMES, *getattr(validate.part(study), "LONG", ())) for study in validate.STUDIES
    }

    def recorded(scene, *names):
        checks = [compare.check(name, 1.0, 1.0, 0.1) for name in names]
        return {"scene": scene, "date": "", "version": "", "commit": "", "gas": "", "checks": checks}

    rings = compare.scene_module("thick_ring").VARIANTS
    found = {
        "thick_ring": recorded("thick_ring", *(f"{name}, exact: a" for name in rings if name != "eight layers")),
        "granular_piles": recorded("granular_piles", "column a = 1: b", "slot of 40 mm: c"),
        "taylor_green": recorded("taylor_green", "taylor_green, exact: d"),
    }
    monkeypatch.setattr(dashboard, "records", lambda: found)
    monkeypatch.setattr(dashboard, "validated", lambda: list(found))
    told = dashboard.whole().partition("## Without a record")[2].partition("## Every check")[0]
    assert "[thick_ring](scenes/thick_ring.md): eight layers.\n" in told
    assert "[granular_piles](studies/granular_piles.md): slopes.\n" in told and "taylor_green" not in told
    assert dashboard.of_scene("thick_ring").endswith("Not recorded: eight layers.")
    assert "Not recorded" not in dashboard.of_scene("taylor_green")


def test_words_of_parts_are_those_of_their_checks(monkeypatch):
    """Else a part that is on record would be told as not recorded, or one by the checks of another."""
    monkeypatch.syspath_prepend(str(DOCS))
    dashboard = importlib.import_module("making.dashboard")
    for study, parts in dashboard.PARTS.items():
        for part, words in parts.items():
            assert words in (ROOT / "validation" / study / f"{part}.py").read_text(encoding="utf-8"), (study, part)
        for check in dashboard.records()[study]["checks"]:
            assert sum(words in check["name"] for words in parts.values()) <= 1, check["name"]


def test_dashboard_has_a_line_for_each_experiment_and_no_check_in_two(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    dashboard = importlib.import_module("making.dashboard")
    checks = [compare.check("heptane, one", 1.3, 1.0, 0.1), compare.check("heptane, two", 1.0, 1.0, 0.1)]
    text = dashboard.measured({"experiments": {"checks": checks}})
    assert text.count("\n") == 2
    assert "| Nomura et al. 1996 | d^2 of heptane drops in hot nitrogen | runs | 2 | 1 | 3 | " in text
    told = validate.part(validate.EXPERIMENTS).MEASURED["experiments"]
    names = [check["name"] for check in dashboard.records()["experiments"]["checks"]]
    assert [name for name in names if sum(bool(re.match(begin, name)) for begin in told) != 1] == []


def test_a_key_without_a_meaning_ends_the_building(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(DOCS))
    keys = importlib.import_module("making.keys")
    monkeypatch.setattr(keys, "MEANINGS", tmp_path / "keys.toml")
    text = (DOCS / "keys.toml").read_text(encoding="utf-8")
    for changed in (text.replace("spacing_mm =", "spacing_cm =", 1), text.replace("[lift]\nlaw", "[lifting]\nlaw")):
        assert changed != text
        (tmp_path / "keys.toml").write_text(changed, encoding="utf-8")
        with pytest.raises(ValueError, match=r"keys.toml: \[\w+\] and the code differ in (spacing_|law)"):
            keys.meanings()


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md"])
def test_links_of_pages_outside_the_site_lead_somewhere(page):
    links = re.findall(r"\]\(([^)#]+)[^)]*\)", (ROOT / page).read_text(encoding="utf-8"))
    assert links and not [link for link in links if not link.startswith("http") and not (ROOT / link).exists()]


def test_equations_with_a_slip_are_not_drawn(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    typeset = importlib.import_module("making.typeset")
    assert typeset.svg(r"\alpha_p", inline=True).startswith("<svg")
    for wrong in (r"\alfa_p", r"\frac{a"):
        with pytest.raises((ValueError, AssertionError)):
            typeset.svg(wrong, inline=True)


def test_equations_of_the_theory_lead_to_their_code():
    """But for those of derivations, which no program computes."""
    equation, lone, count = re.compile(r"\$\$ \(([\w-]+)\)\n(.*?)(?=\n\$\$\n|\n#|\Z)", re.DOTALL), [], 0
    for path in sorted((DOCS / "theory").glob("*.md")):
        for label, after in equation.findall(path.read_text(encoding="utf-8")):
            count += 1
            if "{src}`" not in after and not label.startswith("derive-"):
                lone.append(f"{path.name}: {label}")
    assert not lone and count > 80


def test_spelling():
    listed = ["git", "ls-files", "-z", "-co", "--exclude-standard", "--", *SPELLED]
    told = subprocess.run(listed, cwd=ROOT, capture_output=True, text=True)
    files = [name for name in told.stdout.split("\0") if name and not name.startswith("tests/data/")]
    if told.returncode or not files:  # no checkout
        files = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs", "sdph", "validation"]
    found = subprocess.run([sys.executable, "-m", "codespell_lib", *files], cwd=ROOT, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout


def test_the_page_of_scaling_has_what_its_model_gives():
    made = subprocess.run(
        [sys.executable, ROOT / "benchmarks" / "scaling.py"], capture_output=True, text=True, check=True
    ).stdout
    assert made in (DOCS / "scaling.md").read_text(encoding="utf-8")
