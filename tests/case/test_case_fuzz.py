"""Cases harmed at random: each can be run, or is refused with one line that a user can act on."""

import copy
import json
import os
import time
import tomllib
import warnings
from unittest import mock

import pytest
from conftest import LONG
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_output import snapshot

from sdph import cli, scenes
from sdph.case import read as cases
from sdph.effects import REGISTRY
from sdph.running import driver
from sdph.schema import CaseError
from sdph.study import memory as room
from sdph.study import rehearsal
from sdph.study.explain import tables

TABLES = {
    name: tomllib.loads((scenes.HERE / name / "case.toml").read_text(encoding="utf-8")) for name in scenes.names()
}
WORDS = sorted({key for table in TABLES.values() for key in json.dumps(table).split('"')[1::2]})
ODD = [
    0, 1, -1, 2, 3, 10**9, 10**400, 0.0, -0.0, 1e-308, 1e308, 5e-324, float("inf"), float("-inf"), float("nan"), True,
    False, "", "x",
    "../../etc/passwd", "/tmp/out", "#codeStream { }", "$HOME", "a\nb", "\0", "ä" * 300, [], [[]], [1.0], [1.0, 2.0],
    [1.0, 2.0, 3.0], [-1.0, 1e9], [["x"]], [None], {}, {"a": 1}, {"shape": "box"}, "1e400",
]  # fmt: skip
VALUES = st.one_of(
    st.sampled_from(ODD), st.floats(allow_nan=True), st.integers(-(2**70), 2**70), st.text(max_size=8),
    st.sampled_from(WORDS), st.lists(st.floats(-1e3, 1e3), max_size=4),
)  # fmt: skip
SMALL = {  # of what a case that passes is really run with: seconds, not hours
    "disc_cluster": (
        "resolution.spacing_mm=25",
        "resolution.cell_mm=100",
        "run.end_time_s=1e-5",
        "run.output_interval_s=1e-5",
    ),
    "bubbling_bed": (
        "resolution.spacing_mm=50",
        "resolution.cell_mm=20",
        "run.end_time_s=1e-5",
        "run.output_interval_s=1e-5",
    ),
}


def leaves(table, at=()):
    """Paths of all sections and values."""
    for key, value in table.items():
        yield (*at, key)
        if isinstance(value, dict):
            yield from leaves(value, (*at, key))


@st.composite
def harmed(draw, names=tuple(TABLES), most=3):
    """(scene, table) with one to three places changed, removed, or added."""
    name = draw(st.sampled_from(names))
    table = copy.deepcopy(TABLES[name])
    for _ in range(draw(st.integers(1, most))):
        path = draw(st.sampled_from(sorted(leaves(table))))
        section = table
        for key in path[:-1]:
            section = section[key]
        what = draw(st.sampled_from(("change", "change", "change", "remove", "add")))
        if what == "remove":
            del section[path[-1]]
        else:
            key = path[-1] if what == "change" else draw(st.sampled_from(WORDS))
            section[key] = copy.deepcopy(draw(VALUES))  # later changes may reach into it
        if not table:
            break
    return name, table


@settings(max_examples=2500)
@given(harmed())
def test_a_harmed_case_is_read_or_refused_in_one_line(pair):
    try:
        case = cases.from_table(pair[1])
    except CaseError as error:
        assert str(error).strip()
        assert len(str(error)) < 2000
        return
    assert cases.from_table(tomllib.loads(cases.dumps(case))) == case  # what a run writes down is the case it runs


@st.composite
def bent(draw):
    """(scene, table) with one to four of its numbers, words or effects replaced by others of their kind."""
    name = draw(st.sampled_from(tuple(TABLES)))
    table = copy.deepcopy(TABLES[name])
    for _ in range(draw(st.integers(1, 4))):
        path = draw(st.sampled_from(sorted(path for path in leaves(table) if path not in (("title",), ("scene",)))))
        section = table
        for key in path[:-1]:
            section = section[key]
        section[path[-1]] = draw(others(section[path[-1]]))
    return name, table


FACTORS = st.one_of(st.floats(-3.0, 3.0).map(lambda x: 10.0**x), st.sampled_from([-1.0, 0.0, 1e-9, 1e9]))
SPECIES = {
    matter: sorted(name for name, row in REGISTRY.items() if matter in row.matter)
    for matter in ("grains", "solid", "liquid")
}


def others(value):
    """Values of the kind of one that a case has."""
    if isinstance(value, bool):
        return st.just(not value)
    if isinstance(value, (int, float)):
        return FACTORS.map(lambda factor: type(value)(value * factor))
    if isinstance(value, list) and value and isinstance(value[0], str):
        matter = next((own for own in ("solid", "liquid") if set(value) <= set(SPECIES[own])), "grains")
        return st.lists(st.sampled_from(SPECIES[matter]), unique=True)
    if isinstance(value, list):
        return st.tuples(*map(others, value)).map(list)
    return st.sampled_from(WORDS) if isinstance(value, str) else st.just(value)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Laws and walls that estimates ask, on a machine that has none yet: to compile them is no part of what is
    timed."""
    for name in ("bubbling_bed", "bed_with_tube", "evaporating_jet", "burning_char", "dam_break", "tank_with_flap",
                 "swirl_sheet"):  # fmt: skip
        case = cases.from_table(TABLES[name])
        with rehearsal.rehearsed(case, driver.template_of(case, name), whole=True):
            tables.explain(case)


@settings(max_examples=100 * LONG)
@given(bent())
def test_a_bent_case_is_explained_or_refused_in_one_line(pair):
    """On a small machine, so that what is large is refused; no traceback, and no more than 10 s of the processor."""
    name, table = pair
    begun = time.process_time()
    with mock.patch.object(room, "available", lambda: 5e8), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            case = cases.from_table(table)
            with rehearsal.rehearsed(case, driver.template_of(case, name), whole=True):
                pass
        except CaseError as error:
            assert str(error).strip() and len(str(error)) < 2000
        else:
            tables.text(tables.explain(case))  # refuses nothing more
    assert time.process_time() - begun < 10.0


@settings(max_examples=300)
@given(
    st.sampled_from(sorted(TABLES)),
    st.text(st.characters(codec="utf-8"), max_size=30),
    st.integers(0, 3000),
    st.integers(0, 60),
)
def test_a_harmed_file_is_read_or_refused_in_one_line(tmp_path_factory, name, text, place, removed):
    file = tmp_path_factory.mktemp("case") / "case.toml"
    whole = (scenes.HERE / name / "case.toml").read_text(encoding="utf-8")
    file.write_text(whole[:place] + text + whole[place + removed :], encoding="utf-8")
    try:
        cases.load(file)
    except CaseError as error:
        assert str(error).strip()


@settings(max_examples=200)
@given(st.text(max_size=20), st.text(max_size=12))
def test_a_harmed_override_is_read_or_refused(key, value):
    try:
        cases.load(scenes.HERE / "disc_cluster" / "case.toml", (f"{key}={value}",))
    except CaseError as error:
        assert str(error).strip()


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(harmed(("disc_cluster", "bubbling_bed"), 1))
def test_a_case_that_passes_runs_or_ends_with_one_line(tmp_path_factory, capfd, pair):
    """The command as a user gives it; nothing outside the run folder is touched."""
    name, table = pair
    folder = tmp_path_factory.mktemp("run")
    try:
        text = cases.dumps(cases.from_table(table))
    except CaseError:
        return
    (folder / "case.toml").write_text(text, encoding="utf-8")
    before = snapshot(folder)
    os.chdir(folder)
    overrides = [word for override in SMALL[name] for word in ("--set", override)]
    explained = cli.main(["explain", "case.toml", "--set", "coupling.gas='embedded'", *overrides, "--json"])
    capfd.readouterr()
    code = cli.main(["run", "case.toml", "--gas", "embedded", *overrides, "--out", "out", "--json"])
    *before_it, said = capfd.readouterr().err.splitlines() or [""]
    assert code in (0, 2, 3), said
    assert (code == 2) == (explained == 2), said
    if code:
        assert said.startswith("sdph: ") and all(line.startswith("warning: ") for line in before_it)
    after = {path: content for path, content in snapshot(folder).items() if path.parts[0] != "out"}
    assert after == before


@pytest.fixture(autouse=True)
def _stay():
    here = os.getcwd()
    yield
    os.chdir(here)
