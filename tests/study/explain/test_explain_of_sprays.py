"""Sprays are told neither of walls that they do not reach nor of shocks where droplets pass through each other."""

import dataclasses
from pathlib import Path

import pytest

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.schema import CaseError
from sdph.study.explain import droplets, estimate, feed, pace, tables


def case_of(scene, *more):
    return cases.load(scenes.HERE / scene / "case.toml", more)


def test_air_through_a_whole_side_blows_no_droplets_sideways():
    """Air comes down through the whole top of the spray's box; through a part of it, it may turn anywhere."""
    case = case_of("gel_spray")
    walls = judge.judgements(case)["walls"]
    stop, gap = judge.scales_of(case).drag_time, 0.032  # drag time [s]; from the mouth's rim to a side [m]
    assert walls.number == pytest.approx(12.0 * 0.2079 * stop / gap, rel=0.02) and walls.number < 0.6
    assert not [text for text in judge.missing(case) if "walls" in text]
    part = case_of("gel_spray", "boundaries.top.span_m=[[0.03,0.05],[0.03,0.05]]")
    assert judge.judgements(part)["walls"].number > 5.0


def test_a_thin_spray_has_no_shocks_and_a_dense_jet_has():
    rate = case_of("spray_cone").nozzles
    (name, nozzle), *_ = rate.items()
    thin = case_of("spray_cone", f"nozzles.{name}.rate_kg_s={4.0 * nozzle.rate}")
    scales = judge.scales_of(thin)
    assert scales.collides and scales.free_path > 0.1 * thin.smoothing_length  # told of shocks by its volume fraction
    assert not [text for text in judge.missing(thin) if "artificial_viscosity" in text]
    assert judge.judgements(case_of("evaporating_jet"))["artificial_viscosity"].error_if_off > 0.05


def test_classes_of_sizes_are_particles_each():
    """Five at each place of the mouth: five times as many in the end, and as many more that wait upstream."""
    (name,) = case_of("spray_cone").nozzles
    wide = f"nozzles.{name}.diameter_std_mm=0.01"
    one, five = (case_of("spray_cone", wide, f"nozzles.{name}.size_classes={number}") for number in (1, 5))
    counts = [estimate.expected(case, judge.scales_of(case))[0]["value"] for case in (one, five)]
    assert counts[1] == pytest.approx(5.0 * counts[0], rel=0.01)
    given = case_of("spray_cone", f"nozzles.{name}.sizes=given", f"nozzles.{name}.diameters_mm=[0.05,0.06,0.07]")
    assert estimate.expected(given, judge.scales_of(given))[0]["value"] == pytest.approx(3.0 * counts[0], rel=0.01)


def test_droplets_that_have_gone_through_are_not_there_any_more():
    """A spray that goes on falls out of its box: so many are there at once, however long it runs."""
    counts = [
        feed.incoming(case_of("spray_cone", "grains.diameter_std_mm=0", f"run.end_time_s={end}"))
        for end in (0.01, 3.0, 30.0)
    ]
    (most, mean), (later, there), (latest, always) = counts
    assert mean == pytest.approx(0.5 * most, rel=0.01)  # none has gone through yet
    assert later < 300 * most and latest == pytest.approx(later, rel=0.2) and there < later
    assert always == pytest.approx(latest, rel=0.05)


def test_nozzles_are_asked_apart_for_what_evaporation_bears():
    """Fine droplets ask for shorter windows than coarse ones that fly denser: the shortest of all nozzles."""
    fine = case_of("spray_cone", "grains.diameter_mm=0.03", "grains.diameter_std_mm=0")
    (name,) = fine.nozzles
    second = dataclasses.replace(fine.nozzles[name], rate=0.1, diameter=3e-4, diameter_std=0.0)
    both = dataclasses.replace(fine, nozzles=fine.nozzles | {"coarse": second})
    limits = [pace.thickening(case).limit(1.0) for case in (fine, both)]
    assert limits[1] == limits[0]


def test_drops_of_a_nozzle_count_with_the_size_that_it_gives():
    """As if [grains] had it: for break-up, drag and heat; of several sizes their Sauter mean."""
    (name,) = case_of("spray_cone").nozzles
    own = f"nozzles.{name}.sizes=given"
    coarse = judge.scales_of(case_of("spray_cone", own, f"nozzles.{name}.diameters_mm=[0.4]"))
    plain = judge.scales_of(case_of("spray_cone", "grains.diameter_mm=0.4", "grains.diameter_std_mm=0"))
    assert (coarse.drag_time, coarse.heat_time, coarse.falling) == (plain.drag_time, plain.heat_time, plain.falling)
    two = case_of("spray_cone", own, f"nozzles.{name}.diameters_mm=[0.2,0.8]", f"nozzles.{name}.shares=[1.0,3.0]")
    assert judge.scales_of(two).grains.diameter == pytest.approx(1.0 / (0.25 / 2e-4 + 0.75 / 8e-4))


def test_a_filter_of_drag_refuses_sizes_of_a_nozzle(tmp_path):
    (name,) = case_of("spray_cone").nozzles
    with pytest.raises(CaseError, match=f"nozzles.{name} has its own .diameter.: leave one of the two out"):
        case_of("spray_cone", "drag.filter=igci", f"nozzles.{name}.diameter_mm=0.4")


def test_a_belt_is_no_gas_that_is_let_in():
    """A floor that slides under a packed bed: it does not rest, shears, and nothing is blown."""
    floor = ("boundaries.jet", "boundaries.distributor")
    still, belt = (
        judge.scales_of(case_of(
            "bubbling_bed", *(f"{name}.kind=wall" for name in floor),
            *(f"{name}.velocity_m_s=[{speed},0]" for name in floor), "particles.bed.volume_fraction=0.6",
        ))
        for speed in (0, 5)
    )  # fmt: skip
    assert belt.jet == 0.0 == still.speed and belt.speed == 5.0 and still.resting and not belt.resting


def test_droplets_that_would_boil_and_windows_without_a_bar_are_told():
    """Water boils at 373 K; gel in a shell is meant to boil."""
    (name,) = case_of("spray_cone").nozzles
    found = {}
    for temperature in (370, 420):
        told = tables.warnings(case_of("spray_cone", f"nozzles.{name}.temperature_K={temperature}"))
        found[temperature] = [text for text in told if "droplets boil from" in text]
    assert not found[370] and len(found[420]) == 1 and "boil from 373" in found[420][0]
    assert any(
        "window_tolerance = 2" in text for text in tables.warnings(case_of("spray_cone", "coupling.window_tolerance=2"))
    )


def test_a_rate_that_is_told_from_before_its_nozzle_opens_counts_from_there():
    plain = case_of("spray_cone")
    ((name, nozzle),) = plain.nozzles.items()
    late = dataclasses.replace(nozzle, rate=None, rates=((0.0, 0.01), (1.0, 0.01)), start=0.01)
    case = dataclasses.replace(plain, nozzles={name: late})
    own = feed.of(case, judge.scales_of(case))
    assert own.stake(0.005) == own.stake(0.01) == 0.0 and own.stake(0.03) == pytest.approx(0.02, abs=3e-4)


def test_particles_are_judged_by_the_largest_drops_that_any_nozzle_gives():
    (name,) = case_of("spray_cone").nozzles
    case = case_of("spray_cone", f"nozzles.{name}.diameter_mm=40", f"nozzles.{name}.diameter_std_mm=0")
    assert any(text.startswith("spacing / grain = 0.2") for text in estimate.warnings(case))


FLUID = 'effects=["inflow","outflow","gravity","drag","heat","evaporation","friction","granular_pressure"]'


def test_effects_of_a_fluid_are_told_where_droplets_hardly_meet():
    """In the cone path/h is 1.3; at twice the rate it is below 1. Friction alone is of grains that touch."""
    (told,) = [text for text in tables.warnings(case_of("spray_cone", FLUID)) if "are no fluid" in text]
    assert "granular_pressure make" in told and "friction" not in told and "1.3 smoothing lengths" in told
    (name, nozzle), *_ = case_of("spray_cone").nozzles.items()
    for fewer in (
        (FLUID, f"nozzles.{name}.rate_kg_s={2.0 * nozzle.rate}"),
        (),
        (FLUID.replace("granular_p", "gas_p"),),
    ):
        assert not [text for text in tables.warnings(case_of("spray_cone", *fewer)) if "are no fluid" in text]


@pytest.mark.parametrize("times, finer, called", [(1.0, 1.0, False), (20.0, 40.0, False), (20.0, 1.0, True)])
def test_no_effect_of_a_fluid_is_called_for_where_droplets_hardly_meet(times, finer, called):
    """What a run would warn of when it is on, `explain` does not call for; a run of a minute leaves time to collide."""
    (name, nozzle), *_ = case_of("spray_cone").nozzles.items()
    rate = f"nozzles.{name}.rate_kg_s={times * nozzle.rate}"
    spacing = f"resolution.spacing_mm={1e3 * case_of('spray_cone').resolution.spacing / finer}"
    case = case_of("spray_cone", FLUID, rate, spacing, "run.end_time_s=60", "grains.restitution=0.9")
    found = set(judge.called_for(case)) & set(droplets.OF_A_FLUID)
    assert bool(found) == called
    assert bool(droplets.flying(judge.scales_of(case), case.effects)) != called


def test_droplets_are_priced_by_whether_their_sizes_differ():
    """And nothing of the exchange where nothing evaporates."""

    def told(*more):
        case = case_of("spray_cone", *more)
        (row,) = [row for row in estimate.expected(case, judge.scales_of(case)) if row["what"] == "wall time"]
        return row["how"].partition("exchange ")[2].partition(" s")[0]

    several, alike = float(told()), float(told("grains.diameter_std_mm=0"))
    assert several == pytest.approx(50.0 / 15.0 * alike, rel=0.1)
    table = cases.parsed(scenes.HERE / "spray_cone" / "case.toml")
    table = {key: own for key, own in table.items() if key not in ("evaporation", "vapour")}
    case = cases.from_table(table | {"effects": [name for name in table["effects"] if name != "evaporation"]})
    (row,) = [row for row in estimate.expected(case, judge.scales_of(case)) if row["what"] == "wall time"]
    assert "exchange" not in row["how"]


def test_windows_of_a_feed_that_a_stream_carries_off_are_foretold(tmp_path):
    """Sand of a riser comes to the gas's temperature, drawn apart six times, and leaves: docs/howto/riser.md had 1448
    windows to 0.6 s (30 November 2026, embedded gas)."""
    page = (Path(__file__).parents[3] / "docs" / "howto" / "riser.md").read_text()
    (tmp_path / "riser.toml").write_text(page.partition("```toml\n")[2].partition("```")[0])
    case = cases.load(tmp_path / "riser.toml", ("coupling.gas='embedded'",))
    rows = {row["what"]: row["value"] for row in estimate.expected(case, judge.scales_of(case))}
    assert rows["windows"] == pytest.approx(1448, rel=0.3)
    fed = feed.of(case, judge.scales_of(case))
    assert fed.stake(10.0) == fed.stake(20.0) < 0.2  # no more than is there at once


def test_how_many_there_are_if_none_leaves_is_told():
    """A swirl keeps what a straight way would take out: every layer of the nozzle is there in the end."""
    case = case_of("spray_cone", "grains.diameter_std_mm=0", "run.end_time_s=30.0")
    (row,) = [row for row in estimate.expected(case, judge.scales_of(case)) if row["what"] == "particles"]
    every, most = feed.brought_in(case), feed.incoming(case)[0]
    assert every > 5 * most and f"{every} at the end if none has left" in row["how"]
    short = case_of("spray_cone", "grains.diameter_std_mm=0", "run.end_time_s=0.01")
    assert feed.brought_in(short) == feed.incoming(short)[0]
