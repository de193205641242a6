"""Checks of scenes that see what they are there for: each is given a run in which just that has gone wrong."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from told_runs import Cloud, told, with_outputs

from sdph import scenes
from sdph.engine.state import GAS
from sdph.running import balances
from sdph.schema import CaseError
from sdph.study import compare, validate


def verdict(checks, begins: str) -> dict:
    """The one check whose name begins so."""
    (found,) = [check for check in checks if check["name"].startswith(begins)]
    return found


def columns(head: str, **values) -> dict:
    return {head + name: np.asarray(column, float) for name, column in values.items()}


@pytest.mark.parametrize("rows", [4, 0])
def test_gel_spray_without_a_tear_has_missed(rows):
    """A droplet that keeps its size, and one that never came in."""
    ones = np.where(np.arange(4) < rows, 1.0, np.nan)
    own = columns("particle_1_", convective_heat_W=ones, temperature_K=ones, diameter_m=ones, mass_kg=ones, sealed=ones)
    run = told("gel_spray", 0.04, history=own | {"time_s": np.arange(4.0)})
    run = SimpleNamespace(case=SimpleNamespace(track=[1]), history=run.history)
    (found,) = compare.scene_module("gel_spray").exact(run)
    assert not found["ok"] and "tears" in found["name"]


def test_a_front_that_is_not_reached_is_told():
    """T = 2.5 and 3 of a run that ends before, 0.06 s being T = 1.29."""
    dam = compare.scene_module("dam_break")
    time = np.linspace(0.0, 0.06, 20)
    run = told("dam_break", 0.06, history={"time_s": time, "largest_x_m": 0.05 + time})
    assert list(dam.fronts(run)) == [1.25]
    (notice,) = run.notices
    assert notice.startswith("run ends at 0.06 s: no check at ") and notice.count(",") == 3
    assert list(dam.fronts(told("dam_break", 0.3, history=run.history))) == list(dam.TIMES)


@pytest.mark.parametrize(("scene", "reference", "solver"), [
    ("granular_jet", "tfm", "run_two_fluid"), ("bubbling_bed", "tfm", "run_two_fluid"),
    ("evaporating_jet", "dpm", "run_droplets"), ("evaporating_jet", "exact", ""), ("poiseuille", "exact", ""),
])  # fmt: skip
def test_a_time_between_outputs_is_refused_before_openfoam_runs(monkeypatch, scene, reference, solver):
    """Outputs every 0.3 s, where all are compared at other times too."""
    from coupling.openfoam.comparators import run as comparators

    if solver:
        monkeypatch.setattr(comparators, solver, lambda *given, **more: pytest.fail("a reference is run"))
    with_outputs(monkeypatch, 0.3 * np.arange(50))
    with pytest.raises(CaseError, match=r"run has no output at 0\.\d+ s, where it is compared"):
        getattr(compare.scene_module(scene), reference)(told(scene, 14.7, ["run.output_interval_s=0.3"]))


def test_the_jet_is_held_to_at_the_first_time_too(monkeypatch):
    """Which was left out where the two-fluid run has no folder of the start."""
    jet, times = compare.scene_module("granular_jet"), [0.05, 0.1, 0.15, 0.2]
    from coupling.openfoam.comparators import run as comparators

    with_outputs(monkeypatch, [0.0, *times])
    reference = SimpleNamespace(fields=dict.fromkeys(times))
    monkeypatch.setattr(comparators, "run_two_fluid", lambda *given, **more: reference)
    row = {"centre_y_m": 0.11, "motion_J": 1.0, "agitation_J": 1.0, "spread_x_m": 1.0}
    monkeypatch.setattr(jet, "of_cells", lambda *given: row)
    monkeypatch.setattr(jet.figures, "histories", lambda *given: None)
    monkeypatch.setattr(jet.figures, "fields", lambda *given: None)
    metrics = {name: np.full(5, value) for name, value in row.items()} | {"time_s": np.array([0.0, *times])}
    summary = {"gas_numerical_work_rel": 0.01}
    *checks, work = jet.tfm(told("granular_jet", 0.2, ["run.output_interval_s=0.05"], summary=summary, metrics=metrics))
    assert work["ok"] and work["tolerance"] == 0.02
    assert [check["name"][-6:] for check in checks] == 3 * ["0.05 s", "0.10 s", "0.15 s", "0.20 s"]
    assert all(check["ok"] for check in checks)


@pytest.mark.parametrize(("largest", "torn", "rows", "missed"), [
    (1.35, 1.0, 21, 0), (1.25, 1.0, 21, 1), (1.25, 0.0, 20, 0),
])  # fmt: skip
def test_a_gel_droplet_that_tears_too_small_has_missed(monkeypatch, largest, torn, rows, missed):
    """D/D0 = 1.3 of the model is never reached, and that is a check; of a run that has not torn `tear` tells."""
    gel = compare.scene_module("gel_droplet")

    def course(largest):
        time = np.linspace(0.0, 0.75, 751)
        return {"time_s": time, "diameter_ratio": 1.0 + (largest - 1.0) * time / 0.75, "pressure_Pa": 1e5 * time / 0.75}

    monkeypatch.setattr(gel, "reduced", lambda case: SimpleNamespace(history=course(1.35)))
    own = course(largest)
    own |= {"bubble_pressure_Pa": own["pressure_Pa"], "solid_free_particles": np.zeros(751)}
    found = gel.course(told("gel_droplet", 0.75, summary={"torn": torn}, history=own))
    unreached = [check for check in found if math.isnan(check["value"])]
    assert len(found) == rows and len(unreached) == missed and not any(check["ok"] for check in unreached)


def test_a_gel_droplet_that_tears_too_soon_has_missed(monkeypatch):
    """At 0.72 s of 0.75 s: D/D0 and pressure at 0.73 and 0.741 s, and the two largest sizes."""
    gel = compare.scene_module("gel_droplet")
    time = np.linspace(0.0, 0.75, 751)
    model = {"time_s": time, "diameter_ratio": 1.0 + 0.35 * (time / 0.75) ** 20, "pressure_Pa": 1e5 * time}
    own = model | {"bubble_pressure_Pa": model["pressure_Pa"], "solid_free_particles": 1.0 * (time > 0.7205)}
    monkeypatch.setattr(gel, "reduced", lambda case: SimpleNamespace(history=model))
    found = gel.course(told("gel_droplet", 0.9, summary={"torn": 1.0}, history=own))
    missed = [check["name"] for check in found if not check["ok"]]
    assert len(found) == 21 and missed == [
        "D/D0 at 0.73 s", "pressure at 0.73 s [Pa]", "D/D0 at 0.741 s", "pressure at 0.741 s [Pa]",
        "time of D/D0 = 1.2 [s]", "time of D/D0 = 1.3 [s]",
    ]  # fmt: skip


@pytest.mark.parametrize(("power", "ok"), [(20, True), (2, False)])
def test_a_gel_droplet_that_grows_at_another_pace_has_missed(power, ok):
    """0.35 (t/0.75 s)^20 has D/D0 = 1.05 after 0.91 of the time (0.89 within 5 %), the square after 0.38; other shells
    by the droplet without particles."""
    gel, time = compare.scene_module("gel_droplet"), np.linspace(0.0, 0.75, 751)
    own = {"time_s": time, "diameter_ratio": 1.0 + 0.35 * (time / 0.75) ** power, "solid_free_particles": 0.0 * time}
    summary = {"torn": 1.0, "rupture_time_s": 0.75}
    *shells, pace = gel.claims(told("gel_droplet", 0.75, summary=summary, history=own))
    assert pace["ok"] == ok and len(shells) == 2 and all(check["ok"] for check in shells)


def test_char_is_held_to_a_column_of_its_own_ends():
    char = compare.scene_module("burning_char")
    run = told("burning_char", 16.002, ["run.end_time_s=16.002"], history={"time_s": np.array([0.0, 16.0])})
    with pytest.raises(CaseError, match=r"run.end_time_s = 16.002: the column .* takes multiples of 0.004 s"):
        char.exact(run)


@pytest.mark.parametrize(("rate", "ok"), [(1.0, True), (1.19, True), (1.21, False), (0.79, False), (-0.1, False)])
def test_a_droplet_that_is_damped_otherwise_than_by_viscosity_has_missed(rate, ok):
    """Viscosity: 4 nu/R^2 = 4 /s of 1 mm of water; one that is fed has less than nothing."""
    drop, time = compare.scene_module("oscillating_droplet"), np.arange(0.0, 0.02, 1e-4)
    half, omega = 0.25e-6, math.sqrt(6.0 * 0.072 / (1001.0 * 1e-9))  # m2; rad/s
    off = 0.04e-6 * np.exp(-4.0 * rate * time) * np.sin(omega * time)
    axes = {"liquid_spread_x_m2": half + off, "liquid_spread_y_m2": half - off}
    still = {"liquid_centre_x_m": 0.0 * time, "liquid_centre_y_m": 0.0 * time}
    found = drop.period(told("oscillating_droplet", 0.02, history={"time_s": time} | axes | still))
    assert verdict(found, "damping")["ok"] == ok and verdict(found, "period")["ok"]
    assert verdict(found, "damping")["reference"] == pytest.approx(0.0061, abs=5e-5)


@pytest.mark.parametrize(("gap", "when", "ok"), [(0.4, 1, True), (0.6, 1, False), (0.6, 2, False), (1.6, 2, False)])
def test_a_crack_across_or_along_a_ring_is_told(monkeypatch, gap, when, ok):
    """A square of 6 x 6 that opens by `gap` spacings [mm] between two rows, whose numbers are not next to each other,
    at an output on the way (1) or in the end (2)."""
    rings = compare.scene_module("colliding_rings")
    y, x = np.divmod(np.arange(36), 6)
    clouds = {}
    for k in range(3):
        places = 1e-3 * np.stack([x, y + gap * (y > 2) * (k == when), 0.0 * x], axis=1)
        order = np.random.default_rng(k).permutation(36)
        clouds[float(k)] = Cloud(places[order], ident=order)
    with_outputs(monkeypatch, clouds)
    run = told("colliding_rings", 2.0, clouds=clouds)
    stretch = rings.furthest(run)
    assert stretch == pytest.approx(1.0 + gap, rel=1e-9)
    assert (abs(stretch - 1.0) <= rings.APART - 1.0) == ok
    assert 2.0 * run.case.resolution.smoothing_ratio > rings.APART  # the kernel's reach


@pytest.mark.parametrize(("axis", "row", "share", "ok"), [
    ("x", 0, 0.9e-3, True), ("x", 1, 1.1e-3, False), ("y", 0, 1.1e-3, False), ("y", 2, 1.1e-3, False),
])  # fmt: skip
def test_momentum_of_the_vortices_is_told_at_any_time_and_in_any_direction(axis, row, share, ok):
    """As a share of sum m |v| = 0.08 kg m/s in the end."""
    green, time = compare.scene_module("taylor_green"), np.array([0.0, 1.0, 2.0])
    moved = {"x": np.zeros(3), "y": np.zeros(3)}
    moved[axis][row] = -0.08 * share
    history = {f"momentum_{a}_kg_m_s": values for a, values in moved.items()}
    clouds = {2.0: Cloud(np.zeros((2, 3)), mass=[0.1, 0.3], velocity=[[0.2, 0.0, 0.0], [0.0, -0.2, 0.0]])}
    energy = np.exp(-4.0 * 0.01 * (2.0 * math.pi) ** 2 * time)
    run = told("taylor_green", 2.0, history=history | {"time_s": time, "kinetic_energy_J": energy}, clouds=clouds)
    found = verdict(green.exact(run), "momentum")
    assert found["value"] == pytest.approx(share) and found["ok"] == ok


def lone_droplet(single, evaporated: float) -> list[dict]:
    """Checks of a droplet by the d2 law, gone before 60 s, of which the ledger has so much evaporated."""
    run = told("single_droplet", 60.0)
    wet, constant = single.closed_form(run.case)
    time = np.arange(0.0, 60.5, 0.5)
    square = 1e-6 - constant * time
    d = np.sqrt(np.where(square > 0.0, square, np.nan))
    mass = run.case.grains.density * math.pi / 6.0 * d**3
    warm = np.where(np.isfinite(d), wet, np.nan)
    warm[0] = 294.0
    own = columns("particle_1_", diameter_m=d, temperature_K=warm, mass_kg=mass) | {"time_s": time}
    told_run = told("single_droplet", 60.0, summary={"evaporated_kg": evaporated * mass[0]}, history=own)
    return single.exact(told_run)


@pytest.mark.parametrize(("evaporated", "ok"), [(1.0, True), (0.995, True), (0.98, False), (0.0, False)])
def test_a_droplet_that_is_lost_has_not_evaporated(monkeypatch, evaporated, ok):
    single = compare.scene_module("single_droplet")
    monkeypatch.setattr(single, "_figure", lambda *given: None)
    found = verdict(lone_droplet(single, evaporated), "share of the mass")
    assert found["ok"] == ok and found["value"] == pytest.approx(1.0 - evaporated, abs=1e-12)


@pytest.mark.parametrize(("ratio", "parted", "ok"), [
    (1.4, 0.2, [True, True]), (1.02, 0.2, [False, True]), (1.4, 0.015, [True, False]),
])  # fmt: skip
def test_beads_that_part_by_less_than_chance_have_not_parted(ratio, parted, ok):
    """At the start heights differ by 3 % and the index is -0.02, as beads lie at random."""
    time, ones = np.array([0.0, 1.0, 9.0]), np.ones(3)
    table = {"time_s": time, "mixing_index": 0.8 * ones, "segregation": np.array([-0.02, 0.0, parted])}
    table |= {"height_large_m": ones, "height_small_m": np.array([0.97, 1.0, ratio])}
    history = {f"material_{name}_kg": ones for name in ("small", "large")}
    run = told("segregation", 10.0, history=history, metrics=table)
    rows = compare.scene_module("segregation").paper(run)
    assert [row["ok"] for row in rows[:2]] == ok and all(row["ok"] for row in rows[2:])


@pytest.mark.parametrize(("missing", "ok"), [(0, True), (1, False)])
def test_a_place_for_one_more_particle_is_a_void(missing, ok):
    """A lattice of 100 x 60, complete, and without the particle 3050 and by 2 % wider there; air 2 % less dense."""
    own, spacing = compare.scene_module("dam_break_gas"), 2.8575e-3
    x, y = np.meshgrid((np.arange(100) + 0.5) * spacing, (np.arange(60) + 0.5) * spacing)
    places = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    kept = np.arange(6000) != (3050 if missing else -1)
    if missing:
        near = np.linalg.norm(places - places[3050], axis=1) < 1.1 * spacing
        places[near] += 0.02 * (places[near] - places[3050])
    density = np.where(np.arange(6000) == 7, 0.98, 1.0)[kept]
    cloud = Cloud(places[kept], kind=np.full(kept.sum(), GAS), density=density)
    time = np.linspace(0.0, 0.3, 50)
    run = told("dam_break_gas", 0.3, history={"time_s": time, "liquid_largest_x_m": time}, clouds={0.3: cloud})
    found = own.exact(run)
    assert verdict(found, "voids")["ok"] == ok and not verdict(found, "density of the air")["ok"]


def test_the_order_of_a_mesh_is_told_as_it_is(monkeypatch, tmp_path):
    """Three, of which none is missed, and a half."""
    orders = validate.part("own_vessel", "orders")
    monkeypatch.setattr(orders, "errors", lambda name, n, folder: {"velocity": n**-3.0, "pressure": n**-0.5})
    rows = orders.checks(tmp_path, chosen=("box",), cells=(8, 16))
    assert [(row["value"], row["ok"]) for row in rows] == [
        (pytest.approx(3.0), True), (16**-3.0, True), (pytest.approx(0.5), False), (16**-0.5, True)
    ]  # fmt: skip


def references(module):
    """Pairs of overrides and references that `validate` runs."""
    whole = [((), [name for name in validate.REFERENCES if hasattr(module, name)])]
    return getattr(module, "VARIANTS", dict(enumerate(whole))).values()


@pytest.mark.parametrize(("sag", "evaporated", "missed"), [
    (0.05, 1e-6, []), (0.0, 1e-6, ["sag [m] at 0.05 s, more than none"]),
    (0.05, 0.0, ["share of the liquid that evaporated, more than none"]),
])  # fmt: skip
def test_a_jet_that_does_not_fall_or_evaporate_has_missed(monkeypatch, sag, evaporated, missed):
    """At the last time; before, the head may be where it was."""
    with_outputs(monkeypatch, [0.0, 0.05])
    told_of = {"front_m": 0.48, "sag_m": 0.2 * sag, "core_temperature_K": 294.0, "vapour_mass_fraction_max": 0.01}
    metrics = {name: np.full(2, value) for name, value in told_of.items()} | {"time_s": np.array([0.0, 0.05])}
    summary = {"evaporated_kg": evaporated, "injected_kg": 1.0, "gas_numerical_work_rel": 0.0}
    run = told("evaporating_jet", 0.05, summary=summary, metrics=metrics)
    checks = compare.scene_module("evaporating_jet").exact(run)
    assert [check["name"] for check in checks if not check["ok"]] == missed and len(checks) == 8


def test_no_check_of_the_jet_stands_in_the_record_twice():
    """`dpm` ends with the checks of `exact`."""
    assert all({"exact", "dpm"} - set(own) for _, own in references(compare.scene_module("evaporating_jet")))


@pytest.mark.parametrize("scene", [name for name in scenes.names() if compare.scene_module(name)])
def test_no_check_of_a_scene_is_a_balance_that_stands_before_it(scene):
    """With the same bar: `validate` puts the balances in front of all."""
    source = Path(compare.scene_module(scene).__file__).read_text(encoding="utf-8")
    named = {key for key in balances.BARS if f'"{key}"' in source}
    tighter = {"burning_char": {"energy_drift_rel"}, "tank_with_flap": {"momentum_drift_rel"}}
    assert named == tighter.get(scene, set())
