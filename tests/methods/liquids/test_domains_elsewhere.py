"""A domain of a liquid that does not begin at the origin: the same run, moved by a vector."""

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import LIQUID
from sdph.running.alone import Alone
from sdph.schema import CaseError

BY = np.array([-1.0, 1.0])  # m
DAM = ("resolution.spacing_mm=5.715", "run.end_time_s=0.05")
# 1.5 has walls at the very edge of the kernel of liquid, and round-off says whether they see it
OVERFALL = ("resolution.spacing_mm=20", "run.end_time_s=0.4", "resolution.smoothing_ratio=1.4")
PLACES = ("lower_m", "upper_m", "centre_m", "at_m")


def moved(table, by):
    """The table of a case with all places in it moved; of a domain and a tank that name no corner, by their domain."""
    if not isinstance(table, dict):
        return table
    return {
        key: (np.array(value) + by).tolist() if key in PLACES and value is not None else moved(value, by)
        for key, value in table.items()
    }


def gone(table) -> Alone:
    run = Alone(cases.from_table(table), None)
    run.start()
    while run.time < run.case.run.end_time:
        run.window()
    return run


@pytest.mark.parametrize(("scene", "given"), [("dam_break", DAM), ("free_overfall", OVERFALL)])
def test_a_scene_elsewhere_is_the_same_scene(scene, given):
    table = cases.to_table(cases.load(scenes.find(scene)[1], given))
    table["domain"].pop("lower_m", None)
    there = moved(table, BY)
    there["domain"]["lower_m"] = BY.tolist()
    one, other = gone(table), gone(there)
    s, t = (run.state for run in (one, other))
    a, b = (np.argsort(state.ident) for state in (s, t))
    assert len(s.x) == len(t.x) and np.array_equal(s.kind[a], t.kind[b])
    size, speed = max(one.case.domain.size), np.hypot(s.u, s.v)[s.kind == LIQUID].max()
    off = max(np.abs(t.x[b] - BY[0] - s.x[a]).max(), np.abs(t.y[b] - BY[1] - s.y[a]).max()) / size
    faster = max(np.abs(t.u[b] - s.u[a]).max(), np.abs(t.v[b] - s.v[a]).max()) / speed
    print(scene, "places are off by", off, "speeds by", faster)
    assert off < 1e-9 and faster < 1e-7
    told, again = one.ledger.summary(), other.ledger.summary()
    for name in ("work_of_gravity_J", "damping_J", "injected_kg", "left_kg"):
        assert again[name] == pytest.approx(told[name], rel=1e-7, abs=1e-12)
    assert scene == "dam_break" or told["left_kg"] > 0.0


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"liquid.periodic": [1.0, 0.0]}, "along x, which is periodic, give 0"),
        ({"pools.column.lower_m": [-2.0, 1.0]}, "pools.column"),
        ({"method": {"name": "mps"}}, "a liquid that sound travels in"),
    ],
)
def test_what_lies_elsewhere_than_its_domain_is_refused(change, word):
    table = moved(cases.to_table(cases.load(scenes.find("dam_break")[1], DAM)), BY)
    table["domain"]["lower_m"] = BY.tolist()
    for key, value in change.items():
        *path, last = key.split(".")
        own = table
        for name in path:
            own = own[name]
        own[last] = value
    with pytest.raises(CaseError, match=word):
        Alone(cases.from_table(table), None)
