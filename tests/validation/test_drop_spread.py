"""Short forms of the drop that hits a wall of `sdph validate experiments.drop_spread`: its case has the numbers of the
row, the table has both laws, the width of known clouds is right, a short run spreads and keeps its balances."""

import math
import types

import numpy as np
import pytest
import pyvista

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import GAS, LIQUID
from sdph.running import balances
from sdph.running.progress import Reporter
from sdph.study import compare, validate

QUIET = Reporter(quiet=True)


@pytest.fixture
def drops():
    return validate.part(validate.EXPERIMENTS, "drop_spread")


def test_the_table_has_both_laws(drops):
    """Pasandideh-Fard et al. 1996, and Roisman's with its second term over We; ours has it over the root of We."""
    rows = drops.measured.table("drop_spread_laws")
    We, Re, cosine = rows["We"], rows["Re"], np.cos(np.radians(rows["theta_adv_deg"]))
    first = np.sqrt((We + 12.0) / (3.0 * (1.0 - cosine) + 4.0 * We / np.sqrt(Re)))
    assert rows["beta_PasandidehFard"] == pytest.approx(first, rel=1e-5)
    assert rows["beta_Roisman"] == pytest.approx(0.87 * Re**0.2 - 0.40 * Re**0.4 / We, rel=1e-5)
    assert drops.roisman(20.0, 1000.0) == pytest.approx(3.463529 - 0.4 * 15.8489 / 4.47214, rel=1e-5)


@pytest.mark.parametrize("weber", [20.0, 50.0])
def test_the_case_has_the_numbers_of_its_row(drops, weber):
    row = drops.row(weber)
    case = cases.load(scenes.find("drop_on_plate")[1], tuple(drops.given(row, 16, 4.0)))
    drop, liquid, own = case.pools["drop"], case.liquid, case.parameters["surface_tension"]
    speed, diameter = -drop.velocity[2], 2.0 * drop.radius
    assert liquid.density * speed**2 * diameter / own.coefficient == pytest.approx(weber)
    assert liquid.density * speed * diameter / liquid.viscosity == pytest.approx(row["Re"])
    assert math.degrees(own.contact_angle) == pytest.approx(row["theta_adv_deg"])
    assert diameter / case.resolution.spacing == pytest.approx(16.0)
    width, _, height = case.domain.size
    assert drop.centre == pytest.approx((0.5 * width, 0.5 * width, drop.radius))
    assert width > drops.spans(row)["the table"][1] * diameter and height > diameter


def test_the_layer_at_the_wall_is_thinner_than_two_spacings(drops):
    """By which rule of docs/liquid-numerics.md walls slip."""
    for weber, fine in drops.RUNS:
        assert math.sqrt(drops.TIME / drops.row(weber)["Re"]) < 2.0 / fine


def test_the_width_is_that_of_the_outermost_liquid_of_each_sector(monkeypatch, drops):
    """A disc; a lone particle far out counts in its sector alone, gas not at all."""
    angles = (np.arange(drops.SECTORS) + 0.5) * 2.0 * math.pi / drops.SECTORS
    rim = np.column_stack([np.cos(angles), np.sin(angles), 0.0 * angles])
    places = np.concatenate([0.5 * rim, rim, [2.0 * rim[0]], 9.0 * rim])
    cloud = pyvista.PolyData(places + np.array([3.0, 3.0, 0.0]))
    cloud["kind"] = np.repeat([LIQUID, LIQUID, LIQUID, GAS], [len(rim), len(rim), 1, len(rim)])
    monkeypatch.setattr(drops.timeline, "read", lambda folder: None)
    monkeypatch.setattr(drops.timeline, "state_at", lambda *_: types.SimpleNamespace(particles=cloud))
    case = types.SimpleNamespace(
        resolution=types.SimpleNamespace(spacing=0.1), domain=types.SimpleNamespace(size=(6.0, 6.0, 1.0))
    )
    assert drops.width(None, 0.0, case) == pytest.approx(2.0 * (1.0 + 1.0 / drops.SECTORS + 0.05))


@pytest.mark.parametrize(
    ("value", "ok"),
    [
        (1.8, [False, False, True]),
        (1.88, [False, True, True]),
        (2.2, [True, True, False]),
        (2.7, [True, False, False]),
        (3.5, [False, False, False]),
    ],
)
def test_a_spread_outside_the_laws_is_told(tmp_path, monkeypatch, drops, value, ok):
    """We 20, 90 degrees: 2.406 and 3.147 or 2.046, less and more a tenth: 2.165 to 3.461 or 1.841 to 2.646. A film of
    less than three spacings, as 16 in the diameter leave of a drop wider than 1.89, is none."""
    monkeypatch.setattr(drops, "course", lambda *_: np.array([[0.0, 1.0, 2.0], [0.5, value, 1.0]]))
    checks = drops.checks(tmp_path, (), QUIET, ((20.0, 16),))
    assert [check["ok"] for check in checks] == ok and {check["value"] for check in checks[:2]} == {value}
    assert checks[2]["value"] == pytest.approx(2.0 / 3.0 * 16 / value**2) and checks[2]["name"].endswith(
        "D_0/dx = 16: film when widest [spacings]"
    )
    assert (tmp_path / "drop_spread.png").is_file()


def test_a_coarse_drop_spreads_and_keeps_its_balances(tmp_path, drops):
    """Eight spacings in the diameter, until 0.6 D_0/U: the foot is 15 % from Wagner's, 2 sqrt(3 t/2) D_0 across
    (Riboux & Gordillo 2014, Phys. Rev. Lett. 113, 024507), and nothing is in the walls."""
    times, widths = drops.course(20.0, 8, tmp_path / "drop", (), QUIET, 0.6)
    assert widths[0] == pytest.approx(1.0, abs=0.1)
    assert widths[-1] == pytest.approx(2.0 * math.sqrt(0.5 * 3.0 * times[-1]), rel=0.15)
    run = compare.open_run(tmp_path / "drop")
    cloud = drops.timeline.state_at(drops.timeline.read(tmp_path / "drop"), None).particles
    places = np.asarray(cloud.points)[np.asarray(cloud["kind"]) == LIQUID]
    assert np.all((places > 0.0) & (places < np.array(run.case.domain.size)))
    missed = {check["name"]: check["value"] for check in balances.checks(run.summary) if not check["ok"]}
    assert list(missed) == ["numerical_work_rel"] and missed["numerical_work_rel"] < 0.1  # 5 %
