"""Short forms of `sdph validate experiments`: checks that hold where ours is as measured and fail where it is not, and
runs that have what was asked for."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from sdph import cli
from sdph.laws import drag, evaporation, heat
from sdph.running.progress import Reporter
from sdph.schema import CaseError
from sdph.study import validate

QUIET = Reporter(quiet=True)


def verdicts(checks) -> list[bool]:
    return [check["ok"] for check in checks]


def test_friction_of_runs_is_that_of_the_markers(tmp_path):
    """Ergun's friction is linear in Re: two runs span the markers."""
    bed = validate.part(validate.EXPERIMENTS, "packed_bed")
    places = bed.PLACES[0], bed.PLACES[-1]
    assert verdicts(bed.checks(tmp_path, (), QUIET, places)) == [True] * 4
    assert (tmp_path / "packed_bed.png").is_file()


@pytest.mark.parametrize("factor", [1.2, 1.0 / 1.2])
def test_friction_off_by_a_fifth_is_told(tmp_path, monkeypatch, factor):
    bed = validate.part(validate.EXPERIMENTS, "packed_bed")
    monkeypatch.setattr(bed, "friction", lambda x, *_: (x, factor * (150.0 + 1.75 * x)))
    assert verdicts(bed.checks(tmp_path)) == [False] * 6


@pytest.mark.parametrize(("factor", "ok"), [(1.0, True), (1.2, True), (1.3, False), (0.7, False)])
def test_minimum_fluidisation_off_by_more_than_the_bar_is_told(tmp_path, monkeypatch, factor, ok):
    powders = validate.part(validate.EXPERIMENTS, "minimum_fluidisation")
    found = powders.measured.table("geldart_1973")["U0_m_s"]
    ours = iter(factor * found[np.isfinite(found)])
    monkeypatch.setattr(powders, "LAWS", {"as measured": lambda density, diameter: next(ours)})
    assert verdicts(powders.checks(tmp_path)) == [ok] * 6


def test_velocities_that_lift_a_powder_are_those_of_the_laws(tmp_path):
    """Fine grains: U_mf is a hundredth of (rho_p - rho_g) g d^2/mu, by Wen & Yu 0.0408/(2 33.7) of it; and all run."""
    powders = validate.part(validate.EXPERIMENTS, "minimum_fluidisation")
    weight = (2500.0 - powders.AIR[0]) * powders.measured.GRAVITY * (20e-6) ** 2 / powders.AIR[1]
    assert powders.wen_yu(2500.0, 20e-6) == pytest.approx(0.0408 / 67.4 * weight, rel=1e-3)
    voidage = 1.0 - 0.6  # at the default onset of friction
    assert powders.ergun_at_onset(2500.0, 20e-6) == pytest.approx(voidage**3 / (150.0 * 0.6) * weight, rel=1e-3)
    assert len(powders.checks(tmp_path)) == 12


def test_index_of_laws_that_are_known():
    """Stokes without crowding: U = eps s, s as the weight of the suspension, eps. Wen & Yu at rest: eps^(2 + 2.65)."""
    liquid = validate.part(validate.EXPERIMENTS, "liquid_fluidisation")
    assert liquid.index(drag.stokes, 1e-3) == pytest.approx(2.0, abs=1e-6)
    assert liquid.index(drag.wen_yu, 1e-6) == pytest.approx(2.0 - drag.WEN_YU_EXPONENT, abs=1e-3)


@pytest.mark.parametrize(("off", "ok"), [(0.0, True), (0.14, True), (0.16, False), (-0.16, False)])
def test_an_index_outside_its_bar_is_told(tmp_path, monkeypatch, off, ok):
    liquid = validate.part(validate.EXPERIMENTS, "liquid_fluidisation")
    known = {row["Re"]: row["n0"] for row in liquid.measured.table("richardson_zaki_1954")}
    monkeypatch.setattr(liquid, "index", lambda law, Re: known.get(Re, 0.0) + off)
    assert verdicts(liquid._without_walls(tmp_path)) == [ok] * 8


@pytest.mark.parametrize(("off", "ok"), [(0.0, True), (0.14, True), (0.16, False), (-0.16, False)])
def test_an_index_of_a_bed_outside_its_bar_is_told(monkeypatch, off, ok):
    """Beds of one sphere in tubes of two widths have one Reynolds number: here each has one of its own."""
    liquid = validate.part(validate.EXPERIMENTS, "liquid_fluidisation")
    rows = liquid.measured.table("richardson_zaki_beds_1954")
    assert len(rows) == 29
    numbers = iter(np.tile(rows["n"] + off, 4))
    monkeypatch.setattr(liquid, "index", lambda law, Re: next(numbers))
    assert verdicts(liquid._of_beds()) == [ok] * 8


def balance(row, water) -> tuple[float, float]:
    """Rate [1e-11 m3/s] and temperature [C] at which a drop's heat evaporates it, slow evaporation (linear)."""
    hot, d = row["T_air_C"] + water.ICE, row["d_m"]
    film = 0.5 * (hot + water.wet_bulb(hot, row["p_Pa"]))
    cold = 2.0 * film - hot
    gas, D = water.air(film, row["p_Pa"]), water.diffusivity(film, row["p_Pa"])
    rho, mu, k = gas["density_kg_m3"], gas["viscosity_Pa_s"], gas["conductivity_W_m_K"]
    Re = rho * row["U_m_s"] * d / mu
    Nu = heat.ranz_marshall(1.0, Re, heat.prandtl_number(mu, water.AIR_HEAT_CAPACITY, k))
    Sh = evaporation.sherwood_ranz_marshall(Re, evaporation.schmidt_number(rho, mu, D))

    def flux(T):
        saturation = evaporation.saturation_antoine(T, water.antoine(cold))
        return Sh * D / d * water.MOLAR_MASS * evaporation.vapour_concentration(saturation, T)

    T = brentq(lambda T: Nu * k / d * (hot - T) - water.latent_heat(cold) * flux(T), water.ICE, hot)
    return 1e11 * math.pi * d**2 * flux(T) / water.DENSITY, T - water.ICE


@pytest.mark.parametrize("place", [0, 13, 18, 26, 33])
def test_a_run_has_the_balance_of_the_drop_that_was_measured(tmp_path, place):
    """0.2 % and 0.02 K: the drop shrinks by as much in a run."""
    drops = validate.part(validate.EXPERIMENTS, "water_drops")
    row = drops.measured.table("ranz_marshall_1952")[place]
    rate, temperature = drops.drop(row, "linear", tmp_path, (), QUIET)
    expected = balance(row, drops.water)
    assert rate == pytest.approx(expected[0], rel=2e-3)
    assert temperature == pytest.approx(expected[1], abs=0.02)


@pytest.mark.parametrize(("factor", "ok"), [(1.0, True), (1.2, False), (1.0 / 1.2, False)])
def test_drops_off_by_a_fifth_are_told(tmp_path, monkeypatch, factor, ok):
    drops = validate.part(validate.EXPERIMENTS, "water_drops")
    monkeypatch.setattr(
        drops, "drop", lambda row, *_: (factor * row["evaporation_1e-11_m3_s"], factor * row["T_drop_C"])
    )
    checks = drops.checks(tmp_path)
    assert verdicts(checks) == [ok] * 20


@pytest.mark.parametrize(("factor", "ok"), [(1.0, True), (1.1, True), (1.5, False), (0.5, False)])
def test_transfer_in_a_bed_out_of_the_scatter_is_told(tmp_path, factor, ok):
    """The law that the markers were brought together by, and it by a factor: the mean of each set and range."""
    beds = validate.part(validate.EXPERIMENTS, "bed_transfer")
    law = lambda eps, Re, Sc: 2.0 + factor * beds.wakao(eps * Re) * Sc ** (1.0 / 3.0)  # noqa: E731
    checks = beds.checks(tmp_path, laws={"theirs": law})
    assert verdicts(checks)[::2] == [ok] * 6
    if factor == 1.0:
        assert verdicts(checks) == [True] * 12
    assert (tmp_path / "bed_transfer.png").is_file()


def slab(depth: float, diffusivity: float, time: float, height: float) -> float:
    """Share of the way to its hot side of a slab that is insulated on the other. Carslaw & Jaeger 1959, 3.4."""
    k = (np.arange(500) + 0.5) * math.pi / height
    return 1.0 - float(np.sum(2.0 / (height * k) * np.sin(k * depth) * np.exp(-diffusivity * k**2 * time)))


def test_a_heated_bed_runs_as_the_slab_that_it_is(tmp_path):
    """0.2 K of 33 K, at 5 mm; the law of beds worked out by hand, 15.4 times the air's, less what gas conducts."""
    beds = validate.part(validate.EXPERIMENTS, "heated_bed")
    stored = (1.0 - beds.VOIDAGE) * beds.DENSITY * beds.CAPACITY
    law = (15.4 - beds.VOIDAGE) * beds.AIR / stored
    for name, diffusivity in (("from the record's end", beds.OWN), ("Zehner & Schluender", law)):
        times, found = beds.course(beds.conductors()[name], tmp_path / name[:4], (), QUIET)
        for time in (1000.0, 2000.0, 4000.0):
            expected = beds.COLD + (beds.TOP - beds.COLD) * slab(beds.DEPTH, diffusivity, time, beds.HEIGHT)
            assert np.interp(time, times, found) == pytest.approx(expected, abs=0.2)


@pytest.mark.parametrize(("off", "ok"), [(0.0, True), (0.4, True), (0.6, False), (-0.6, False)])
def test_a_heated_bed_half_a_kelvin_off_is_told(tmp_path, monkeypatch, off, ok):
    beds = validate.part(validate.EXPERIMENTS, "heated_bed")
    rows = beds.measured.table("beaulieu_2020")
    monkeypatch.setattr(beds, "course", lambda *_: np.array([rows["t_s"], rows["T_C"] + off]))
    assert verdicts(beds.checks(tmp_path)) == [ok] * 6


def test_what_was_measured_is_not_overridden(tmp_path, capsys):
    assert cli.main(["validate", "experiments", "--set", "gas.density_kg_m3=2.0", "--out", str(tmp_path / "new")]) == 2
    assert "gas.density_kg_m3=2.0" in capsys.readouterr().err


def test_one_part_of_a_study_is_run_alone(tmp_path):
    """Laws alone, its figure; what is run by its name only is known too."""
    checks = validate.validate("experiments.liquid_fluidisation", (), QUIET, tmp_path)
    assert {check["name"].partition(",")[0] for check in checks} == {"index n", "index n of beds"}
    assert [path.name for path in tmp_path.iterdir()] == ["liquid_fluidisation.png"]
    with pytest.raises(CaseError, match=r"experiments.nothing: experiments has no such part; it has: .*drop_spread"):
        validate.validate("experiments.nothing", (), QUIET, tmp_path)


def test_what_takes_an_hour_is_run_by_name_alone(tmp_path, monkeypatch):
    package, run = validate.part(validate.EXPERIMENTS), []
    for name in (*package.NAMES, *package.LONG):
        monkeypatch.setattr(
            validate.part(validate.EXPERIMENTS, name), "checks", lambda *_, name=name: run.append(name) or []
        )
    validate.validate("experiments", (), QUIET, tmp_path)
    assert run == list(package.NAMES) and package.LONG


def test_a_fluidised_bed_of_beads_is_carried(tmp_path, monkeypatch):
    """The coarsest beads at their lowest velocity, for a moment: 2 % of the weight, which is the pressure measured."""
    beds = validate.part(validate.EXPERIMENTS, "bed_pressure")
    row = beds.picked(beds.measured.table("toomey_johnstone_1952"), 1)[0]
    monkeypatch.setattr(beds, "STAGE", 0.6)
    mean = beds.run(row, ())
    assert mean["superficial_velocity_m_s"] == pytest.approx(row["U_m_s"], rel=0.01)
    assert mean["pressure_drop_Pa"] == pytest.approx(mean["weight_Pa"], rel=0.02)
    assert mean["weight_Pa"] == pytest.approx(row["dP_mf_Pa"], rel=0.005)


@pytest.mark.parametrize(("factor", "ok"), [(1.0, True), (1.015, True), (1.03, False), (0.97, False)])
def test_a_bed_that_is_not_carried_is_told(tmp_path, monkeypatch, factor, ok):
    beds = validate.part(validate.EXPERIMENTS, "bed_pressure")
    found = lambda row, _: {"pressure_drop_Pa": factor * row["dP_mf_Pa"], "weight_Pa": row["dP_mf_Pa"]}  # noqa: E731
    monkeypatch.setattr(beds, "run", found)
    assert verdicts(beds.checks(tmp_path)) == [ok] * 12
    assert (tmp_path / "bed_pressure.png").is_file()
