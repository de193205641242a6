"""Charged grains in a uniform field: closed forms of flight and drift, both sides, limits, what is refused and told."""

import math
from dataclasses import replace

import numpy as np
import pytest
from grain_boxes import DENSITY, VISCOSITY, Row, box, go, started, table, windows

from sdph import effects
from sdph.case import judge
from sdph.case import read as cases
from sdph.effects.around import electric_field
from sdph.effects.gas import sizes
from sdph.engine import state as particles
from sdph.schema import CaseError
from sdph.study.explain import tables

D, CHARGE, STRENGTH = 5e-5, -2e-5, (-1e5, 5e4)  # m, C/m2, V/m
PULL = np.array(STRENGTH) * CHARGE * math.pi * D**2 / (DENSITY * math.pi / 6.0 * D**3)  # m/s2
TAU = DENSITY * D**2 / (18.0 * VISCOSITY)  # s, of Stokes' drag
SECTION = {"strength_V_m": list(STRENGTH), "surface_charge_C_m2": CHARGE}


def charged(on=("electric_field",), end=1e-3, count=4, one_way=False, **more):
    """Grains at rest, few, in a field."""
    coupling = windows(end, count)
    coupling["coupling"]["one_way"] = one_way
    own = {"electric_field": SECTION} if "electric_field" in on else {}
    grains = {"diameter_mm": D * 1e3} | more.pop("grains", {})
    return box(list(on), alpha_p=1e-3, **{"grains": grains} | own | coupling | more)


def test_a_grain_flies_freely(tmp_path):
    """v = q E t/m; the work is the motion that the grains have."""
    done = go(started(case := charged(), tmp_path, Row(case)))
    np.testing.assert_allclose((done.state.u, done.state.v), np.tile(PULL[:, None] * 1e-3, len(done.state.u)), 1e-12)
    motion = 0.5 * done.state.mass.sum() * float(PULL @ PULL) * 1e-6
    assert done.ledger.sums["work_of_electric_field_J"] == pytest.approx(motion, rel=1e-12)
    assert done.ledger.summary()["motion_drift_rel"] < 1e-12


def test_a_grain_drifts_where_drag_holds_it(tmp_path):
    """v = q E tau/m (1 - exp(-t/tau)) in gas at rest."""
    case = charged(("drag", "electric_field"), end=2.0 * TAU, count=1, one_way=True, drag={"law": "stokes"})
    done = go(started(case, tmp_path, Row(case, alpha_g=1.0)))
    assert done.windows == 100 and done.clock.limit == "settling"
    expected = PULL * TAU * -math.expm1(-2.0)
    np.testing.assert_allclose((done.state.u.mean(), done.state.v.mean()), expected, rtol=1e-9)


def test_the_gas_gets_by_drag_what_the_field_gave(tmp_path):
    """The momentum of both grows by charge times field, and the ledger says so of both sides."""
    case = charged(("drag", "electric_field"), end=10e-3, count=20)
    simulated = started(case, tmp_path, gas := Row(case))
    go(simulated)
    both = gas.mass * gas.velocity[0, :2] + 1e-3 * DENSITY * np.array(
        [simulated.state.u.mean(), simulated.state.v.mean()]
    )
    np.testing.assert_allclose(both, 1e-3 * DENSITY * PULL * 10e-3, rtol=1e-12)
    assert np.abs(gas.velocity[0, :2]).min() > 1e-3
    summary = simulated.ledger.summary()
    assert summary["exchange_momentum_mismatch_rel"] < 1e-12 and summary["motion_drift_rel"] < 1e-12
    given = [simulated.ledger.sums[f"impulse_of_body_forces_{a}_kg_m_s"] for a in "xy"]
    np.testing.assert_allclose(given, simulated.state.mass.sum() * PULL * 10e-3, rtol=1e-12)


def test_grains_of_all_sizes_are_driven_by_their_surface():
    """Mass average of 6 sigma E/(rho d) over the classes of the log-normal law."""
    spread = charged(grains={"diameter_std_mm": 0.4 * D * 1e3})
    state = particles.empty(1, ("diameter", "diameter_variance"), 3)
    state.mass[:], state.diameter[:], state.diameter_variance[:] = 2.0, D, (0.4 * D) ** 2
    p = sizes.kernel(spread)
    own = sizes.birth(p, state, 0)
    classes = np.array([sizes.grain(p, state, 0, own, q) for q in range(sizes.classes(p))])
    inverse = np.average(1.0 / classes[:, 0], weights=classes[:, 1])
    found = electric_field.acceleration(electric_field.kernel(spread), state)[0]
    np.testing.assert_allclose(found, [*(PULL * D * inverse), 0.0], rtol=1e-3)
    assert D * inverse < 0.8


def test_off_leaves_no_trace(tmp_path):
    """No array, no limit, no column but that of the ledger, which is 0, and nothing pushed."""
    off = go(started(case := charged(("drag",)), tmp_path, Row(case)))
    assert not off.state.u.any() and off.ledger.sums["work_of_electric_field_J"] == 0.0
    assert "electric_field" not in effects.limits(off.parameters, case, off.state) | off.clock.limits
    assert not any("electric" in column for column in off.row())
    assert effects.arrays(charged(("gravity",))) == set()


def test_a_strong_field_rules_the_sub_steps():
    """sqrt(h/a)/4 of Monaghan, told by `explain` as by the run."""
    case = charged(electric_field=SECTION | {"strength_V_m": [3e6, 4e6]})
    strong = 5e6 * abs(CHARGE) * 6.0 / (DENSITY * D)
    parts = tables.explain(case)
    (row,) = [row for row in parts["limits"] if row["cause"] == "electric_field" and row["of"] == "sub-step"]
    assert row["largest [s]"] == pytest.approx(0.25 * math.sqrt(case.smoothing_length / strong), rel=1e-12)
    assert row["rules"] == "<-"


def test_explain_names_it_and_what_it_drives():
    """With it on, grains slip through gas at rest: drag is called for, and walls that they reach."""
    case = charged(periodic=(), end=0.1, fill=(0.06, 0.03))
    rows = {row["effect"]: row for row in tables.explain(case)["effects"]}
    assert rows["electric_field"]["in the case"] == "on" and rows["electric_field"]["called for"] == "yes"
    assert rows["drag"]["called for"] == rows["walls"]["called for"] == "yes"
    scales = judge.scales_of(case)
    assert scales.falling == pytest.approx(math.hypot(*PULL) / scales.damping(0.0, scales.falling), rel=1e-3)
    off = {row["effect"]: row for row in tables.explain(charged(("drag",)))["effects"]}["electric_field"]
    assert (off["in the case"], off["called for"]) == ("off", "not judged")


def test_a_field_that_lifts_a_bed_leaves_none_at_rest():
    """Grains packed on the floor: the field that is stronger than their weight takes them off it."""

    def resting(up):
        own = table(["gravity", "electric_field"], alpha_p=0.63, gravity=(0.0, -9.81), periodic=(), fill=(0.06, 0.03),
                    electric_field=SECTION | {"strength_V_m": [0.0, up]}, grains={"diameter_mm": D * 1e3})  # fmt: skip
        return judge.scales_of(cases.from_table(own)).resting

    balance = 9.81 * DENSITY * D / (6.0 * CHARGE)
    assert resting(0.9 * balance) and not resting(1.1 * balance)


def test_charges_that_drive_each_other_apart_are_told():
    """At the rim of grains 0.06 m wide: alpha_p 6 sigma/d w/(2 eps_0) over the field."""
    (told,) = [text for text in tables.warnings(charged()) if text.startswith("own field")]
    own = 1e-3 * 6.0 * abs(CHARGE) / D * 0.06 / (2.0 * 8.8541878128e-12)
    assert f"= {own / math.hypot(*STRENGTH):.3g}, safe from 0 to 0.1" in told
    few = charged(electric_field=SECTION | {"surface_charge_C_m2": 1e-9})
    assert not [text for text in tables.warnings(few) if text.startswith("own field")]


def test_what_is_not_known_is_refused():
    for name in ("evaporation", "break_up"):
        with pytest.raises(CaseError, match=f"leave {name} or electric_field out of effects"):
            electric_field.kernel(replace(charged(), effects=("electric_field", name)))
    with pytest.raises(CaseError, match="electric_field.strength_V_m has 3 components; dimensions = 2"):
        charged(electric_field=SECTION | {"strength_V_m": [1e5, 0.0, 0.0]})
    with pytest.raises(CaseError, match="electric_field.surface_charge_C_m2 = 20; what makes sense"):
        charged(electric_field=SECTION | {"surface_charge_C_m2": 20.0})
