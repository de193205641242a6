"""Holes of a swirling sheet on its unrolled surface, and its measures over instants."""

import contextlib
import json
import math
import types

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import kept
from sdph.laws import sheets
from sdph.methods.mps import instants, sheet

FILE = scenes.HERE / "swirl_sheet" / "case.toml"
SHORT = (
    "domain.size_m=[0.02,0.02,0.003]", "nozzles.mouth.centre_m=[0.01,0.01,0.0]", "run.end_time_s=3e-4",
    "resolution.spacing_mm=0.1",
)  # fmt: skip


def sheet_of(*overrides):
    return cases.load(FILE, (*SHORT, *overrides))


def drawn(nozzle, count: int, length: float) -> np.ndarray:
    """(count, 3) places [m] about the axis of particles that fly straight from anywhere in the middle of the gap."""
    rng = np.random.default_rng(3)
    left, z = rng.uniform(0.0, 2.0 * math.pi, count), rng.uniform(0.0, length, count)
    middle, alpha = 0.5 * (nozzle.inner_radius + nozzle.radius), nozzle.swirl
    x = middle * np.cos(left) - alpha * z * np.sin(left)
    return np.stack([x, middle * np.sin(left) + alpha * z * np.cos(left), z], axis=1)


@pytest.mark.parametrize("swirl", [-1.0, 0.0, 1.0, 3.0])
def test_the_empty_share_of_particles_that_stand_at_random_is_that_of_poisson(swirl):
    """exp(-4 h/l0) of cells of (2 l0)^2 where a sheet is h thick, as its law of thinning has it."""
    nozzle, length, spacing = sheet_of(f"nozzles.mouth.swirl={swirl}").nozzles["mouth"], 0.02, 1e-4
    rate = 0.2 * 2.0 * math.pi * 1.4 / 0.1**3  # particles a mm of length: the gap is 0.2 mm
    places = drawn(nozzle, round(rate * length * 1e3 / 20.0), length)  # a twentieth of them: it is full of holes
    ways, share, area = sheet.empty(places, spacing, nozzle, length)
    z = ways / math.hypot(1.0, swirl)
    exact = np.exp(-4.0 * sheets.thickness(z, 1.4e-3, 2e-4 / 20.0, swirl) / spacing)
    assert share @ area / area.sum() == pytest.approx(exact @ area / area.sum(), rel=0.02)
    for half in (slice(None, len(z) // 2), slice(len(z) // 2, None)):
        assert share[half].mean() == pytest.approx(exact[half].mean(), rel=0.03)


def test_a_hole_of_a_full_sheet_has_its_area_and_goes_with_the_swirl():
    """1 mm along the paths and 2 across cut out at 5 mm, where the sheet has turned by 74 degrees."""
    nozzle, length, spacing = sheet_of().nozzles["mouth"], 0.01, 1e-4
    places = drawn(nozzle, 400_000, length)
    middle, z = 1.4e-3, places[:, 2]
    whole = sheet.empty(places, spacing, nozzle, length)
    assert whole[1].max() == 0.0
    turned = np.arctan2(places[:, 1], places[:, 0]) - np.arctan(z / middle)
    radius = math.hypot(middle, 5e-3)
    wide = 2e-3 / (radius * math.hypot(1.0, 5e-3 / radius) / math.sqrt(2.0))  # rad: 2 mm across the paths
    cut = (np.abs(math.sqrt(2.0) * z - 7.1e-3) < 5e-4) & (np.abs((turned + math.pi) % (2 * math.pi) - 1.0) < wide / 2)
    ways, share, area = sheet.empty(places[~cut], spacing, nozzle, length)
    assert 1.6e-6 < share @ area <= 2e-6  # each row of ten cells loses less than one at each end
    assert set(np.flatnonzero(share)) <= set(np.flatnonzero(np.abs(ways - 7.1e-3) < 6.1e-4))
    told = sheet.holes(places[~cut], spacing, nozzle, length)
    assert told["empty_area_m2"] == pytest.approx(share @ area) and math.isnan(told["half_empty_way_m"])


def test_a_slit_along_the_paths_stays_open_where_the_sheet_turns_fast():
    """Two cells wide, it holds one cell of each row; near the mouth paths turn by half a cell in a row."""
    nozzle, spacing = sheet_of().nozzles["mouth"], 1e-4
    places = drawn(nozzle, 60_000, 1e-3)
    left = np.arctan2(places[:, 1], places[:, 0]) - np.arctan(places[:, 2] / 1.4e-3)
    cell = 2.0 * math.pi / 31  # rad: rows of the mouth have 31 of them, and more further on
    share = sheet.empty(places[np.abs((left + math.pi) % (2 * math.pi) - 1.0) > 1.02 * cell], spacing, nozzle, 1e-3)[1]
    assert len(share) == 7 and (share > 0.0).all()


def test_the_surface_has_the_area_of_straight_flight():
    """Of the hyperboloid r^2 = r_0^2 + z^2: twice the integral of pi sqrt(r_0^2 + 2 z^2)."""
    nozzle, length = sheet_of().nozzles["mouth"], 0.02
    z = np.linspace(0.0, length, 20001)
    exact = np.trapezoid(2.0 * math.pi * np.sqrt(1.4e-3**2 + 2.0 * z**2), z)
    assert sheet.empty(np.zeros((0, 3)), 2e-5, nozzle, length)[2].sum() == pytest.approx(exact, rel=5e-3)


def test_where_it_is_past_a_share_is_told_of_three_rows():
    z, light = np.arange(6.0), np.array([0.0, 0.9, 0.0, 0.3, 0.6, 0.9])
    assert sheet.first_past(z, light, 0.5) == 4.0 and math.isnan(sheet.first_past(z, light, 0.7))
    assert [sheet.named(name, "mean") for name in ("a_deg", "b_m2", "c_m", "share")] == [
        "a_mean_deg", "b_mean_m2", "c_mean_m", "share_mean",
    ]  # fmt: skip


def test_an_instant_is_due_once_the_sheet_is_there_and_each_tenth_of_its_way_after():
    own = instants.Instants(sheet_of())  # 3 mm at 20 m/s: 0.15 ms; and never of a nozzle that has closed
    assert not own.due(2.2e-4) and own.due(2.25e-4) and own.due(2.5e-4)
    own.rows.append({"time_s": 2.25e-4})
    assert not own.due(2.3e-4) and own.due(2.4e-4)
    assert not instants.Instants(sheet_of("nozzles.mouth.end_s=2.3e-4")).due(2.4e-4)
    assert instants.Instants(sheet_of("nozzles.mouth.start_s=1e-4")).begin == pytest.approx(3.25e-4)
    assert not instants.Instants(cases.load(scenes.HERE / "dam_break" / "case.toml", ())).due(1.0)


def row(time: float, value: float) -> dict:
    return {"time_s": time} | dict.fromkeys(instants.NAMES, value)


def test_means_and_deviations_are_those_of_the_instants():
    own, run = instants.Instants(sheet_of()), types.SimpleNamespace(time=0.0)
    told = own.told(run)
    assert told.pop("instants") == 0 and all(map(math.isnan, told.values()))
    own.rows, own.light = [row(2.25e-4, 2.0), row(2.4e-4, 4.0)], np.r_[np.zeros(8), np.full(7, 1.2)]
    told = own.told(run)
    assert told["instants"] == 2 and told["half_angle_mean_deg"] == 3.0
    assert told["half_angle_deviation_deg"] == pytest.approx(math.sqrt(2.0))
    # half the light is past in the second of the rows of 0.2 mm that have 0.6, by three of them
    assert told["break_up_length_of_mean_light_m"] == pytest.approx(math.sqrt(2.0) * 9.5 * 2e-4)
    own.rows.append(row(2.6e-4, math.nan))
    assert math.isnan(own.told(run)["break_up_length_mean_m"])


@pytest.mark.parametrize("harm", [lambda row: row.pop("empty_share"), lambda row: row.update(empty_share="1")])
def test_instants_that_are_no_instants_are_refused(harm):
    own = instants.Instants(sheet_of())
    own.rows = [row(2.25e-4, math.nan)]
    arrays: dict = {}
    packed = json.loads(json.dumps(kept.pack(own, arrays)))
    kept.check(own, kept.unpack(packed, dict(arrays)), "instants")
    harm(packed["rows"][0])
    with pytest.raises(kept.Unfit):
        kept.check(own, kept.unpack(packed, dict(arrays)), "instants")


def test_every_process_keeps_what_the_chief_saw():
    """The chief sees the sheet of all; the others, who have none of it, are told."""
    case = sheet_of()
    own = instants.Instants(case)
    seen = row(2.25e-4, 1.0), np.ones(len(own.light))
    world = types.SimpleNamespace(told=lambda value: seen if value is None else value)
    stepper = types.SimpleNamespace(world=world)
    own.look(types.SimpleNamespace(time=2.25e-4, stepper=stepper, whole=lambda: contextlib.nullcontext(False)))
    assert own.rows == [seen[0]] and own.light.sum() == len(own.light)
