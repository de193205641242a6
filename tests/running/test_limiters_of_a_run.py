"""What limiters hold comes to history.csv, to summary.json and into checkpoints; docs/limiters.md names the columns."""

import json
import re

import pytest
from test_limiters_of_gas import EMBEDDED, OPENFOAM
from test_restart import COARSE, Reporter, load

from sdph import effects, scenes
from sdph.case import read as cases
from sdph.engine.ledger import NOTHING
from sdph.methods.liquids.totals import AMOUNTS
from sdph.running import driver, output
from sdph.running.alone import Alone
from sdph.running.limiters import BESIDE, Limiters
from sdph.scenes import paths
from sdph.study.explain.effect_costs import prepared

PAGE = paths.PACKAGE.parent / "docs" / "limiters.md"
PARTS = [f"Repairs of the numerics: {part}" for part in ("grains", "exchange of grains and gas", "gas")]
# `prepared` has a gas that holds nothing; a model of turbulence tells of one more (test_turbulence.py)
OF_GAS = {*EMBEDDED, *OPENFOAM, "gas_turbulence_bounded_rel"} - set(BESIDE)
LIQUIDS = ("Repairs of the numerics: liquids",)
MOVING = ("Repairs of the numerics: moving particles",)
# scenes that have all limiters between them, with what no scene has
EVERY = {
    "bubbling_bed": ("walls.specularity=0.1",),
    "evaporating_jet": ("effects=['inflow', 'granular_pressure', 'grain_shifting', 'drag', 'heat', 'evaporation']",),
}


@pytest.mark.parametrize(
    "name, acts", [("bubbling_bed", "contact_viscosity_share"), ("evaporating_jet", "flat_rate_share")]
)
def test_history_has_them_and_the_summary_the_largest(tmp_path, name, acts):
    driver.run(load(name, "embedded", *COARSE[name]), name, tmp_path / "run", None, Reporter())
    history = output.read_table(tmp_path / "run" / "history.csv")
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    told = {key.removeprefix("largest_"): value for key, value in summary.items() if key.startswith("largest_")}
    assert told.keys() >= {"theta_at_least_share", "knudsen_viscosity_share", "outside_mesh_particles"} | EMBEDDED
    assert told == {column: pytest.approx(history[column].max(), rel=1e-12) for column in told}
    assert told[acts] > 0.0
    for column in ("contact_way_m", "contact_lift_J") if name == "bubbling_bed" else ("finished_kg",):
        ledger = output.read_table(tmp_path / "run" / "ledger.csv")
        assert summary[column] == pytest.approx(ledger[column].sum(), rel=1e-12, abs=0.0)


def test_the_largest_of_all_windows_is_told():
    own = Limiters()
    for value in (0.1, 0.3, 0.2):
        own.hear({"a_share": value})
    assert (own.now, own.summary()) == ({"a_share": 0.2}, {"largest_a_share": 0.3})


def counted(letter, parts=PARTS):
    """Names that the page gives for rows of grains, gas and their exchange, or of other parts, in a file by its
    `letter`."""
    found, part = set(), ""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        part = line.removeprefix("## ") if line.startswith("## ") else part
        if part in parts and re.match(r"\| \d", line):
            for told in line.rstrip(" |").rpartition(" | ")[2].split(";"):
                names, letters = re.findall(r"`(\w+)`", told), re.search(r"`((?: [LSH])+)", told)
                found |= set(names) if letters and letter in letters[1] else set()
    return found


def test_the_page_names_all_columns_of_the_history():
    told = [set(prepared(load(name, "embedded", *more)).limiters.now) - set(BESIDE) for name, more in EVERY.items()]
    assert counted("H") == set.union(OF_GAS, *told)


def test_the_page_names_all_columns_of_liquids(tmp_path):
    told = {
        "at_least_viscosity",
        "at_most_viscosity",
        "no_shear_rate_share",
    }  # as shear_thinning tells
    spacings = {"dam_break": 8, "square_patch": 50, "bubble_rise": 50, "drop_on_plate": 0.2}
    for name, spacing in spacings.items():
        case = cases.load(scenes.HERE / name / "case.toml", (f"resolution.spacing_mm={spacing}",))
        told |= set(Alone(case, tmp_path / "ledger.csv").limiters.now)
    assert counted("H", LIQUIDS) == told
    assert counted("L", LIQUIDS) < set(AMOUNTS) | {f"impulse_of_shifting_{a}_kg_m_s" for a in "xyz"}


def test_the_page_names_all_columns_of_moving_particles(tmp_path):
    keys = ("resolution.spacing_mm=15", 'method.name="mps"')
    case = cases.load(scenes.HERE / "dam_break" / "case.toml", keys)
    assert counted("H", MOVING) == Alone(case, tmp_path / "ledger.csv").limiters.now.keys()


def test_the_page_names_columns_of_the_ledger():
    of_effects = {column.name for row in effects.REGISTRY.values() for column in row.columns}
    assert {"contact_lift_J", "finished_kg", "impulse_of_gone_kg_m_s"} < counted("L") <= of_effects | set(NOTHING)
