"""What has failed is cut for good; bodies and rigid sides push apart and give the energy back."""

import numpy as np
import pytest
from blocks import moved, stepper

from sdph.engine import kept
from sdph.engine import state as particles
from sdph.engine.guard import Unstable
from sdph.methods.solids import history
from sdph.methods.solids.method import IMPULSES, WORKS, limits
from sdph.methods.solids.totals import SolidLedger, energy, totals

BRITTLE = {
    "yield_stress_Pa": 1e4, "failure": [0.02, 0.0, 0.0, 0.0, 0.0], "critical_damage": 1.0, "viscosity": 0.0,
}  # fmt: skip

FINE = {"end_time_s": 1.0, "output_interval_s": 0.5, "step_factor": 0.5}  # away from a side steps are twice as long


def pulled(**solid):
    """A block of 12 x 8 particles whose halves part at 1 m/s, a thirtieth of sound."""
    run = {"end_time_s": 1.0, "output_interval_s": 0.5, "step_factor": 0.25}
    own = stepper(solid=BRITTLE | solid, run=run)
    own.state.u[:] = np.where(own.state.x > 0.46, 0.5, -0.5)
    return own


def test_what_has_failed_has_no_links_and_no_stress():
    own = pulled()
    while not own.free.any() and own.steps < 1600:
        own.step(1.0)
    free = np.flatnonzero(own.free)
    assert len(free)
    assert not own.stress[free].any() and not own.kirchhoff[free].any()
    rows, slope = own.weights.rows, own.weights.slope
    for i in range(len(own.free)):
        for e in range(rows.start[i], rows.start[i] + rows.number[i]):
            cut = own.broken[i] or own.broken[rows.entries[e]]
            assert (slope[e] == 0.0) == bool(cut)
    assert (own.harm[own.free == 0] < 1.0).all()


def test_energy_and_momentum_close_through_a_tear(tmp_path):
    own = pulled()
    ledger = SolidLedger(tmp_path / "ledger.csv")
    ledger.open(own)
    first = totals(own)
    for _ in range(1600):
        own.step(1.0)
        ledger.close_window(own, 1e-4)
    assert own.free.sum() >= 8
    found = ledger.summary()
    assert found["damage_J"] != 0.0
    assert found["energy_missing_rel"] < 0.01
    assert found["momentum_drift_rel"] < 1e-12
    assert energy(totals(own)) < energy(first)


def test_a_particle_with_too_few_links_is_freed():
    """Cutting the neighbours of a corner leaves it loose; corners that nothing was cut from stay."""
    own = stepper(solid=BRITTLE)
    corner = int(np.argmin(own.state.x + own.state.y))
    r = particles.lengths(own.reference - own.reference[corner])
    own.weights.cut((r > 0.0) & (r < 0.026))
    assert own.weights.free[corner]
    assert not own.weights.free[int(np.argmax(own.state.x + own.state.y))]


def turned(own) -> None:
    """Turn the block inside out: a mirror image of itself."""
    moved(own, own.reference * np.array([-1.0, 1.0, 1.0]) + np.array([1.0, 0.0, 0.0]))


def test_what_is_turned_inside_out_fails_with_the_energy_that_it_had():
    """Flow in it gave no number: energies and checkpoints were nan from then on."""
    own = stepper(solid=BRITTLE)
    moved(own, own.reference * np.array([1.001, 1.0, 1.0]))
    before = own.elastic_energy
    turned(own)
    assert own.free.all() and own.inverted == len(own.free) == history.summary(own)["inverted_particles"]
    assert before > 0.0 and own.elastic_energy == 0.0
    assert own.works[WORKS.index("cut")] == pytest.approx(before, rel=1e-12)
    assert np.isfinite(own.amounts).all() and not own.stress.any()


def test_what_cannot_fail_stops_the_run_when_it_is_turned_inside_out():
    with pytest.raises(Unstable, match=r"bodies\.block .* is -1 -, .* turned inside out: lower run\.step_factor"):
        turned(stepper())


def test_in_space_an_edge_that_loses_a_neighbour_bears_on():
    """One of 30 links or so: only a corner is as badly off as that."""
    own = stepper(3, solid=BRITTLE)
    x, y, _ = (np.round((axis - axis.min()) / 0.01).astype(int) for axis in own.reference.T)
    edge = (x == 0) & (y == 0)
    failed = np.flatnonzero(edge)[np.argsort(own.reference[edge, 2])[2]]
    own.weights.cut(np.arange(len(x)) == failed)
    torn = (own.weights.torn != 0) & edge
    assert torn.sum() >= 4 and own.weights.free[failed]
    corners = np.abs(own.reference - own.reference.mean(axis=0)).sum(axis=1) > 0.0
    corners &= (x == 0) & (y == 0) & (np.abs(own.reference[:, 2] - own.reference[:, 2].mean()) > 0.0249)
    loose = np.flatnonzero(own.weights.free)
    assert set(loose) <= {failed, *np.flatnonzero(corners)}


def test_what_breaks_off_is_not_thrown_by_contact():
    """Neighbours that stand nearer than a spacing when they part do not push, but do so once they come nearer."""
    own = stepper(solid=BRITTLE)
    squeezed = own.reference * [1.0, 0.9, 1.0]
    for axis, column in zip(particles.axes(own.state), squeezed.T):
        axis[:] = column
    own.harm[40] = 1.0
    own.forces(1e-6)
    assert own.free[40] and own.springs == 0.0 and len(own.touching.rest)
    own.state.y[40] += 1e-3
    own.forces(1e-6)
    assert own.springs > 0.0


def two(speed):
    """Two blocks of 6 x 6 particles, a spacing apart, that near each other."""
    half = {"shape": "box", "velocity_m_s": [speed, 0.0]}
    bodies = {
        "left": half | {"lower_m": [0.4, 0.4], "upper_m": [0.46, 0.46]},
        "right": half | {"lower_m": [0.47, 0.41], "upper_m": [0.53, 0.47], "velocity_m_s": [-speed, 0.0]},
    }
    return stepper(bodies=bodies, solid={"viscosity": 0.0, "hourglass": 0.0})


def test_bodies_bounce_and_keep_momentum_and_energy():
    own, steps = two(0.5), 0
    first, touched = totals(own), False
    while steps < 2000 and not (touched and own.springs == 0.0 and steps > 200):
        own.step(1.0)
        touched |= own.springs > 0.0
        steps += 1
    last = totals(own)
    left = own.body == 0
    assert touched
    assert own.state.mass[left] @ own.state.u[left] < 0.0
    whole = float(own.state.mass @ np.abs(own.state.u))
    assert abs(last["momentum_x_kg_m_s"] - first["momentum_x_kg_m_s"]) < 1e-12 * whole
    assert energy(last) == pytest.approx(energy(first), rel=2e-3)


def test_no_links_between_bodies():
    own = two(0.5)
    rows = own.weights.rows
    for i in range(len(own.body)):
        for e in range(rows.start[i], rows.start[i] + rows.number[i]):
            assert (own.weights.slope[e] != 0.0) == (own.body[i] == own.body[rows.entries[e]])


def test_a_rigid_side_takes_the_momentum_and_gives_the_energy_back():
    block = {"shape": "box", "lower_m": [0.4, 0.0], "upper_m": [0.46, 0.06], "velocity_m_s": [0.0, -0.5]}
    own = stepper(
        bodies={"block": block}, effects=["rigid_sides"], rigid_sides={"sides": ["bottom"]},
        solid={"viscosity": 0.0, "hourglass": 0.0}, run=FINE,
    )  # fmt: skip
    first = totals(own)
    for _ in range(400):
        own.step(1.0)
    last = totals(own)
    assert last["momentum_y_kg_m_s"] > 0.0
    gained = last["momentum_y_kg_m_s"] - first["momentum_y_kg_m_s"]
    assert own.impulses[IMPULSES.index("sides"), 1] == pytest.approx(gained, rel=1e-12)
    assert energy(last) == pytest.approx(energy(first), rel=2e-3)


def test_what_is_held_stays_and_its_reaction_is_told():
    beam = {
        "shape": "box", "lower_m": [0.4, 0.4], "upper_m": [0.52, 0.48], "velocity_m_s": [0.0, 0.5],
        "held_lower_m": [0.0, 0.0], "held_upper_m": [0.43, 1.0],
    }  # fmt: skip
    own = stepper(bodies={"beam": beam}, effects=["gravity"], domain={"size_m": [1.0] * 2, "gravity_m_s2": [0.0, -9.8]})
    first = totals(own)
    for _ in range(50):
        own.step(1.0)
    held = own.held
    assert held.sum() == 24
    np.testing.assert_array_equal(particles.positions(own.state)[held], own.reference[held])
    gained = totals(own)["momentum_y_kg_m_s"] - first["momentum_y_kg_m_s"]
    assert own.impulses[:, 1].sum() == pytest.approx(gained, rel=1e-12)
    fallen = -9.8 * own.state.mass @ (own.state.y - own.reference[:, 1])
    assert own.works[WORKS.index("gravity")] == pytest.approx(fallen, rel=1e-9)


def test_a_cut_changes_no_stress_beside_it_and_makes_no_energy():
    """What stands beside a cut bears what it bore, though its other links tell another deformation of a bent body; the
    ledger has the elastic energy of what was cut, and nothing flows."""
    own = stepper(solid=BRITTLE | {"failure": [10.0, 0.0, 0.0, 0.0, 0.0]})
    x, y, _ = own.reference.T
    bent = own.reference + np.stack([0.5 * (x - 0.4) * (y - 0.4), 0.8 * (x - 0.4) ** 2, 0.0 * x], axis=1)
    for axis, column in zip(particles.axes(own.state), bent.T):
        axis[:] = column
    own.forces(1e-6)
    stress, energy_of, flown = own.kirchhoff.copy(), own.weights.volume * own.amounts[:, 0], own.works.copy()
    before, failed = own.gradient.copy(), np.arange(len(stress)) == 40
    own._break(failed)
    loose, left = own.free != 0, own.free == 0
    assert loose[40] and np.abs(own.gradient - before)[left].max() > 1e-4
    np.testing.assert_allclose(own.kirchhoff[left], stress[left], rtol=1e-9, atol=1e-9 * np.abs(stress).max())
    taken = (own.works - flown)[[WORKS.index("cut"), WORKS.index("plastic")]]
    assert taken == pytest.approx([energy_of[loose].sum(), 0.0], rel=1e-9)


def test_an_impact_that_breaks_a_body_makes_no_energy(tmp_path):
    """Steel at 600 m/s on a rigid side, Johnson and Cook's failure: cuts had made a sixth of the impact's energy, and
    damage had gone to three times D_c."""
    steel = {
        "density_kg_m3": 7850.0, "youngs_modulus_Pa": 2.1e11, "poisson_ratio": 0.3, "yield_stress_Pa": 7.92e8,
        "hardening_Pa": 5.1e8, "hardening_exponent": 0.26, "rate_factor": 0.014,
        "failure": [0.05, 3.44, -2.12, 0.002, 0.61], "critical_damage": 0.3,
    }  # fmt: skip
    disc = {"shape": "disc", "centre_m": [0.0052, 0.015], "radius_m": 0.005, "velocity_m_s": [-600.0, 0.0]}
    own = stepper(
        solid=steel, bodies={"disc": disc}, effects=["rigid_sides"], rigid_sides={"sides": ["left"]},
        domain={"size_m": [0.03] * 2, "gravity_m_s2": [0.0] * 2},
        resolution={"spacing_mm": 0.5, "smoothing_ratio": 1.3},
    )  # fmt: skip
    ledger = SolidLedger(tmp_path / "ledger.csv")
    ledger.open(own)
    first, cut = energy(totals(own)), []
    while own.time < 1e-5:
        own.step(1e-6)
        ledger.close_window(own, 0.0)
        cut.append(own.works[WORKS.index("cut")])
    assert own.free.sum() > 30
    assert np.diff(cut).min() > -1e-9 * first and cut[-1] > 0.0
    assert own.harm.max() < 2.0 * 0.3  # by the last step before a cut at most
    assert ledger.summary()["energy_missing_rel"] < 0.01
    assert energy(totals(own)) < 0.7 * first


def test_what_has_left_the_domain_is_told():
    own = stepper(solid=BRITTLE)
    assert history.outside(own) == []
    own.state.x[:3] -= 1.0
    own.free[:2] = 1
    (line,) = history.outside(own)
    assert line.startswith("3 of 96 solid particles (bodies.block) end outside of the domain, 2 of them broken off")


@pytest.mark.parametrize(("gap", "near"), [(0.004, True), (0.006, False)])
def test_contact_limits_steps_from_half_a_spacing_before_a_side(gap, near):
    block = {"shape": "box", "lower_m": [0.4, gap], "upper_m": [0.46, gap + 0.06]}
    own = stepper(bodies={"block": block}, effects=["rigid_sides"], rigid_sides={"sides": ["bottom"]})
    assert own.springs == 0.0 and ("contact" in limits(own)) == near


def test_a_body_taken_up_again_has_the_pairs_that_may_touch_that_it_had():
    """The limit of the first step asks for them before forces do; they are of the places of the last look."""
    own, again = pulled(), pulled()
    while not len(own.touching.pairs) and own.steps < 1600:
        own.step(1.0)
    saved = {}
    packed = kept.pack(own, saved)
    again.state, values = own.state, kept.unpack(packed, saved)
    kept.check(again, values, "body")
    kept.put(again, values)
    assert len(own.touching.pairs)
    np.testing.assert_array_equal(again.touching.pairs, own.touching.pairs)
    np.testing.assert_array_equal(again.touching.lengths, own.touching.lengths)
    assert limits(again) == limits(own)
