import math

import exact_solutions as exact
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_values import BED, GAS

from sdph.effects.gas.drag import LAWS as CHOSEN
from sdph.laws import drag

AIR = GAS["rho"], GAS["mu"]
LAWS = sorted((*CHOSEN, "wen_yu_paper"))
DILUTE = [name for name in LAWS if name != "ergun"]  # Ergun's viscous part vanishes with alpha_p
CROWDING = [name for name in LAWS if name not in ("stokes", "schiller_naumann", "putnam")]

fractions = st.floats(0.0, 0.63)
slips = st.floats(0.0, 30.0)
diameters = st.floats(5e-5, 5e-3)


@pytest.mark.parametrize("name", LAWS)
@given(alpha_p=fractions, slip=slips, d=diameters)
def test_finite_and_not_negative_everywhere(name, alpha_p, slip, d):
    value = getattr(drag, name)(alpha_p, slip, d, *AIR)
    assert math.isfinite(value) and value >= 0.0
    assert value > 0.0 or (name == "ergun" and alpha_p < 1e-9 and slip < 1e-9)


@pytest.mark.parametrize("name", [n for n in LAWS if not n.endswith("_paper")])
@given(alpha_p=fractions, slip=slips, d=diameters, more=st.floats(1e-3, 10.0))
def test_force_grows_with_slip(name, alpha_p, slip, d, more):
    law = getattr(drag, name)
    assert law(alpha_p, slip + more, d, *AIR) * (slip + more) > law(alpha_p, slip, d, *AIR) * slip


@pytest.mark.parametrize("name", CROWDING)
@given(alpha_p=st.floats(0.0, 0.55), slip=slips, d=diameters)
def test_crowding_hinders(name, alpha_p, slip, d):
    law = getattr(drag, name)
    if name == "gidaspow_switch" and alpha_p <= 0.2 < alpha_p + 0.05:
        return  # jumps there, tested below
    assert law(alpha_p + 0.05, slip, d, *AIR) > 0.97 * law(alpha_p, slip, d, *AIR)


@pytest.mark.parametrize("name", LAWS)
@given(alpha_p=fractions, slip=st.floats(1e-3, 30.0), scale=st.floats(0.1, 10.0))
def test_units(name, alpha_p, slip, scale):
    """law d^2/mu depends on alpha_p and Re_p alone."""
    law, d = getattr(drag, name), 1e-3
    same_reynolds = law(alpha_p, slip * scale, d * scale, AIR[0], AIR[1] * scale**2)
    assert same_reynolds == pytest.approx(law(alpha_p, slip, d, *AIR), rel=1e-9)


@pytest.mark.parametrize("name", DILUTE)
def test_slow_dilute_limit_is_stokes(name):
    # Dalla Valle's coefficient has 4.8^2 = 23.04 for 24; the arctan blend keeps 0.6 % of Ergun
    least = {"syamlal_obrien": 0.96, "di_felice": 0.96, "gidaspow": 0.9939, "gidaspow_paper": 0.9939}.get(name, 1.0)
    ratio = getattr(drag, name)(0.0, 0.0, 1e-4, *AIR) / drag.stokes(0.0, 0.0, 1e-4, *AIR)
    assert ratio == pytest.approx(least, rel=1e-4)
    assert getattr(drag, name)(1e-12, 1e-12, 1e-4, *AIR) == pytest.approx(
        getattr(drag, name)(0.0, 0.0, 1e-4, *AIR), rel=1e-3
    )


@pytest.mark.parametrize("name", ["gidaspow", "gidaspow_paper", "ergun", "wen_yu", "di_felice"])
@given(slip=slips)
def test_continuous_at_the_change_of_regime(name, slip):
    law = getattr(drag, name)
    assert law(0.2 - 1e-9, slip, 3e-4, *AIR) == pytest.approx(law(0.2 + 1e-9, slip, 3e-4, *AIR), rel=1e-6)


def test_jumps_are_as_large_as_documented():
    d, slip = BED["d"], 1.0
    at_switch = drag.gidaspow_switch(0.2, slip, d, *AIR), drag.gidaspow_switch(0.2 + 1e-12, slip, d, *AIR)
    assert at_switch == pytest.approx((drag.wen_yu(0.2, slip, d, *AIR), drag.ergun(0.2, slip, d, *AIR)), rel=1e-9)
    below, above = (drag.coefficient_times_reynolds(x) for x in (1000.0 - 1e-9, 1000.0 + 1e-9))
    assert above / below == pytest.approx(1.0039, abs=1e-4)
    below, above = (drag.coefficient_times_reynolds_paper(0.85 * x, x) for x in (1000.0 - 1e-9, 1000.0))
    assert below / above == pytest.approx(1.055, abs=5e-4)
    slightly = [drag.syamlal_obrien(a, slip, d, *AIR) for a in (0.15 - 1e-9, 0.15 + 1e-9)]
    assert slightly[0] == pytest.approx(slightly[1], rel=1.5e-3)


@given(alpha_p=fractions)
def test_blend_weight(alpha_p):
    phi = drag.dilute_weight(alpha_p)
    assert 0.0 < phi < 1.0
    assert (phi > 0.5) == (alpha_p < 0.2) or phi == pytest.approx(0.5, abs=1e-12)  # round-off of 1 - alpha_p at 0.2
    assert drag.dilute_weight(0.4 - alpha_p) == pytest.approx(1.0 - phi, rel=1e-9)


@given(alpha_p=st.floats(0.01, 0.6), slip=st.floats(0.01, 20.0))
def test_coefficient_and_law_of_wen_yu_agree(alpha_p, slip):
    alpha_g, d = 1.0 - alpha_p, BED["d"]
    reynolds = drag.particle_reynolds(slip, d, *AIR)
    x = alpha_g * reynolds
    lone = 24.0 / x * (1.0 + 0.15 * x**0.687)
    for law, slow in ((drag.wen_yu, x < 1000.0), (drag.wen_yu_paper, reynolds < 1000.0)):
        expected = 0.75 * (lone if slow else 0.44) * alpha_g * AIR[0] * slip / d * alpha_g**-2.65
        assert law(alpha_p, slip, d, *AIR) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("alpha_p", [0.05, 0.14, 0.3, 0.5])
@pytest.mark.parametrize("d", [1e-4, 1e-3])
def test_syamlal_obrien_settles_as_garside_and_al_dibouni_measured(alpha_p, d):
    """(v_r - A)/(B - v_r) = 0.06 Re, v_r the slip of the suspension over that of a lone sphere, Re of the latter."""
    slip, lone = (exact.settling_slip(drag.syamlal_obrien, a, 2500.0, 9.81, d, *AIR) for a in (alpha_p, 0.0))
    alpha_g = 1.0 - alpha_p
    a = alpha_g**4.14
    b = 0.8 * alpha_g**1.28 if alpha_g <= 0.85 else alpha_g**2.65
    ratio = slip / lone
    assert (ratio - a) / (b - ratio) == pytest.approx(0.06 * drag.particle_reynolds(lone, d, *AIR), rel=1e-9)


@pytest.mark.parametrize("x, chi", [(0.0, 3.7), (10.0**1.5, 3.05), (1e9, 3.7)])
def test_exponent_of_di_felice(x, chi):
    d, alpha_g = 1e-3, 0.6
    slip = x / alpha_g * AIR[1] / (AIR[0] * d)
    lone = drag.di_felice(0.0, slip * alpha_g, d, *AIR)  # the same superficial Reynolds number
    assert math.log(drag.di_felice(0.4, slip, d, *AIR) / lone, alpha_g) == pytest.approx(1.0 - chi, abs=1e-6)


# F of Beetstra et al. 2007 as they write it, alpha_p and alpha_g Re_p, in decimals of 40 digits
BEETSTRA = {
    (0.1, 0.0): 2.428784637, (0.1, 0.2): 2.438267483, (0.1, 20.0): 3.926041156, (0.1, 1000.0): 47.74502664,
    (0.3, 0.0): 7.015025059, (0.3, 0.2): 7.017478898, (0.3, 20.0): 9.763457068, (0.3, 1000.0): 106.5084699,
    (0.6, 0.0): 37.8459032, (0.6, 0.2): 37.84629638, (0.6, 20.0): 47.49861104, (0.6, 1000.0): 468.4558517,
}  # fmt: skip


@pytest.mark.parametrize(("alpha_p", "x"), BEETSTRA)
def test_beetstra_in_its_own_range(alpha_p, x):
    """The force on a grain is 3 pi mu d alpha_g s F, and there are 6 alpha_p/(pi d^3) of them."""
    d, alpha_g = 4e-4, 1.0 - alpha_p
    slip = x / alpha_g * AIR[1] / (AIR[0] * d)
    expected = 3.0 * math.pi * AIR[1] * d * alpha_g * BEETSTRA[alpha_p, x] * 6.0 / (math.pi * d**3)
    assert drag.beetstra(alpha_p, slip, d, *AIR) == pytest.approx(expected, rel=1e-9)


def test_slow_dense_limit_of_beetstra_is_carman_and_kozenys():
    alpha_p, d = 0.6, 4e-4
    carman_kozeny = 180.0 * alpha_p * AIR[1] / ((1.0 - alpha_p) * d**2)
    assert drag.beetstra(alpha_p, 0.0, d, *AIR) == pytest.approx(1.0092 * carman_kozeny, rel=1e-4)


def test_beetstra_is_too_large_for_lone_fast_spheres():
    """As its docstring says."""
    for reynolds, ratio in ((100.0, 1.16), (1000.0, 1.68)):
        slip = reynolds * AIR[1] / (AIR[0] * 1e-3)
        lone = drag.schiller_naumann(0.0, slip, 1e-3, *AIR)
        assert drag.beetstra(0.0, slip, 1e-3, *AIR) == pytest.approx(ratio * lone, rel=3e-3)


def test_terminal_velocity_of_the_grains_of_igci():
    """75 um, 1500 kg/m3 in air of 1.3 kg/m3 and 1.8e-5 Pa s fall at 0.2184 m/s (Igci et al. 2008, table 1)."""
    assert drag.terminal_velocity(75e-6, 1500.0 - 1.3, 1.3, 1.8e-5, 9.80665) == pytest.approx(0.2184, rel=1e-3)
    assert drag.terminal_velocity(1e-3, -1.0, 1.3, 1.8e-5, 9.81) == 0.0


@pytest.mark.parametrize(
    ("alpha_p", "share"), [(5e-4, 0.1818), (0.005, 0.5043), (0.1, 0.7912), (0.3, 0.7690), (0.5, 0.1687), (0.6, 0.0)]
)
def test_share_lost_to_clusters(alpha_p, share):
    """h g by hand from the printed pieces, one of each."""
    assert drag.igci_clusters(alpha_p) == pytest.approx(share, abs=1e-4)


@pytest.mark.parametrize("alpha_p", [0.0012, 0.014, 0.18, 0.25, 0.455, 0.59])
def test_pieces_of_the_share_meet(alpha_p):
    below, above = (drag.igci_clusters(alpha_p * (1.0 + side)) for side in (-1e-9, 1e-9))
    assert above == pytest.approx(below, abs=6e-3)


@given(alpha_p=st.floats(0.0, 0.65), width=st.floats(0.0, 1e4))
def test_filtered_drag_is_a_part_of_the_drag(alpha_p, width):
    assert 0.0 <= drag.igci_filter(width) * drag.igci_clusters(alpha_p) < 1.0


def test_wider_filters_take_more():
    assert drag.igci_filter(0.0) == 0.0
    assert drag.igci_filter(2.056) == pytest.approx(0.8880, abs=1e-4)
    assert drag.igci_filter(1e6) == pytest.approx(1.0, abs=1e-6)
