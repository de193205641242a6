"""Short forms of the beds in water and of the hot packed bed of `sdph validate experiments`."""

import math

import numpy as np
import pytest

from sdph.running.progress import Reporter
from sdph.study import validate

QUIET = Reporter(quiet=True)


@pytest.fixture
def beds():
    return validate.part(validate.EXPERIMENTS, "liquid_beds")


@pytest.fixture
def hot():
    return validate.part(validate.EXPERIMENTS, "bed_heat")


def verdicts(checks) -> list[bool]:
    return [check["ok"] for check in checks]


def test_the_law_alone_is_that_of_laws_of_settling(beds):
    """U = eps times the slip of spheres that settle, by `liquid_fluidisation`, with the spheres of that."""
    other = validate.part(validate.EXPERIMENTS, "liquid_fluidisation")
    own = {"d_m": other.SPHERE, "rho_s": 2500.0, "rho_l": other.WATER[0], "mu_Pas": other.WATER[1]}
    slip = other.settling_slip(getattr(beds.drag, beds.LAW), 0.4, 2500.0)
    assert beds.law_alone(own, 0.6) == pytest.approx(0.6 * slip, rel=1e-9)


@pytest.mark.parametrize(
    ("apart", "shift", "missed"),
    [(0.0, 0.0, ()), (0.05, 0.0, ("halves",)), (0.0, 0.14, ()), (0.0, 0.16, ("n [-], Richardson",))],
)
def test_beds_as_measured_pass_and_others_are_told(tmp_path, monkeypatch, beds, apart, shift, missed):
    """Voidages by U = U_i eps^n with n of the table, at 0.5 to 0.65 of it; halves of the time apart; n larger
    than the table's."""

    def run(own, laid, *_):
        eps = laid ** (own["n"] / (own["n"] + shift))
        return eps, eps * (1.0 + apart * (laid - 0.4))

    monkeypatch.setattr(beds, "run", run)
    checks = beds.checks(tmp_path, (), QUIET, ("Lead shot",))
    failed = {check["name"].partition(": ")[2] for check in checks if not check["ok"]}
    for name in ("n [-], Richardson", "halves"):
        assert any(name in text for text in failed) == (name in missed), name
    measured = [check for check in checks if "over the measured" in check["name"]]
    assert len(checks) == 9 and len(measured) == 3
    if not apart and not shift:
        assert [check["value"] for check in measured] == pytest.approx([1.0] * 3)
    assert (tmp_path / "liquid_beds.png").is_file()


def test_a_short_bed_in_water_grows_towards_its_own_law(tmp_path, monkeypatch, beds):
    """Lead shot laid in with 0.5 for half a passage: mass as given, and it grows, for the law has 0.6 there."""
    monkeypatch.setattr(beds, "PASSAGES", 0.5)
    monkeypatch.setattr(beds, "OUTPUTS", 8)
    own = beds.row("Lead shot")
    first, second = beds.run(own, 0.5, tmp_path, (), QUIET)
    assert 0.5 < first < second < 0.6
    assert beds.law_alone(own, 0.6) == pytest.approx(beds.speed(own, 0.5), rel=0.05)


def test_balance_of_a_bed_by_hand(hot):
    """Nu put into the closed form comes out again: root of D m^2 + U m = U s, what is left exp(-m L)."""
    case = hot.at_rest(10.0, 0.001)
    gas, U = case.gas, case.boundaries["distributor"].velocity[1]
    carried = gas.density * gas.heat_capacity * U
    s = 6.0 * 0.6 * 9.0 * gas.conductivity / (hot.GRAIN**2 * carried)
    D = 0.4 * gas.conductivity / (gas.density * gas.heat_capacity)
    fall = (math.sqrt(U * U + 4.0 * D * U * s) - U) / (2.0 * D)
    assert hot.by_balance(case, math.exp(-fall * 0.004), 0.004) == pytest.approx(9.0, rel=1e-9)
    assert gas.density * U * hot.GRAIN / gas.viscosity == pytest.approx(10.0)


@pytest.mark.parametrize(("factor", "ok"), [(1.0, True), (1.38, True), (1.4, False), (0.6, False)])
def test_heat_of_a_bed_out_of_the_band_is_told(tmp_path, monkeypatch, hot, factor, ok):
    """Wakao & Funazkri's law times a factor; at Re 100 it is 2 + 0.9 x 1.1 x 15.8."""
    assert hot.wakao(100.0, 0.729) == pytest.approx(2.0 + 0.9 * 1.1 * 15.849, rel=1e-4)
    known = lambda Re, *_: (factor * hot.wakao(Re, 0.74), 1.0, hot.wakao(Re, 0.74))  # noqa: E731
    monkeypatch.setattr(hot, "nusselt", known)
    checks = hot.checks(tmp_path, (), QUIET)
    assert verdicts(checks)[::2] == [ok] * 4 and not any(verdicts(checks)[1::2])
    assert (tmp_path / "bed_heat.png").is_file()


def test_a_hot_bed_has_its_own_law_where_cells_are_fine(tmp_path, hot):
    """Re 100 in cells of a third of a grain: within 15 % of the law, rims of the bed and all; the law by hand."""
    ours, law, theirs = hot.nusselt(100.0, 0.001, tmp_path, (), QUIET)
    root = 0.744218 ** (1.0 / 3.0)
    assert law == pytest.approx(3.8 * (1.0 + 0.7 * 100.0**0.2 * root) + 0.562 * 100.0**0.7 * root, rel=1e-4)
    assert 0.85 * law < ours < law and theirs == pytest.approx(hot.wakao(100.0, 0.744218), rel=1e-5)
    assert np.isfinite(ours)
