"""Moving particles: operators on the lattice, conservation of free bodies, pressure that keeps the density."""

import dataclasses
import math
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest
from moving import SPACING, case, started

from sdph.engine import state as particles
from sdph.laws import moving_particles
from sdph.methods.mps import compressible, equations
from sdph.methods.mps.bounds import MpsGuard
from sdph.methods.mps.method import MpsStepper, limits
from sdph.methods.mps.scales import MpsScales
from sdph.schema import CaseError


class Cohesion(NamedTuple):
    """Of a tension's parameters what its sound asks for [Pa]."""

    cohesion: float


PRESSURES = ("poisson", "weakly_compressible")


def block(velocity, dimensions=3):
    """A stepper of a block of lattice whose velocities (N, 3) [m/s] are a function of places; mask of its inside."""
    corners = {"lower_m": [2e-3] * dimensions, "upper_m": [4e-3] * dimensions}
    coarse = {"resolution": {"spacing_mm": 0.2}, "pools": {"drop": {"shape": "box", "centre_m": None} | corners}}
    stepper = MpsStepper(case(("laminar_viscosity",), coarse, dimensions))
    s = stepper.state
    places = particles.positions(s)
    for array, column in zip((s.u, s.v, s.w), velocity(places - 3e-3).T):
        array[:] = column[: len(array)]
    return stepper, np.all((places > 2.5e-3) & (places < 3.5e-3), axis=1, where=np.arange(3) < dimensions)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_divergence_is_exact_for_linear_fields(dimensions):
    gradient = np.array([[1.0, 2.0, -1.0], [0.5, 3.0, 2.0], [1.0, -2.0, -7.0]])
    stepper, inside = block(lambda r: r @ gradient.T, dimensions)
    found = np.empty(len(inside))
    equations.diverge(*stepper.around, found)
    assert inside.sum() > 10
    np.testing.assert_allclose(found[inside], np.trace(gradient[:dimensions, :dimensions]), rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_viscosity_is_exact_for_quadratic_fields(dimensions):
    """nu lap u of u_x = y^2, u_y = 3 x^2."""
    stepper, inside = block(lambda r: np.stack([r[:, 1] ** 2, 3.0 * r[:, 0] ** 2, 0.0 * r[:, 0]], axis=1), dimensions)
    found = np.empty((len(inside), 3))
    equations.rub(*stepper.around, 0.5, found)
    np.testing.assert_allclose(found[inside], [[1.0, 3.0, 0.0]] * int(inside.sum()), rtol=1e-9, atol=1e-9)


def test_the_matrix_is_symmetric_and_outweighed_by_its_diagonal():
    stepper, _ = block(lambda r: 0.0 * r)
    matrix = equations.matrix(*stepper.within, stepper.number, stepper.surface)
    whole, links = np.diag(matrix.diagonal), matrix.links
    for i, (first, many) in enumerate(zip(links.start, links.number)):
        whole[i, links.entries[first : first + many]] = -matrix.value[first : first + many]
    np.testing.assert_allclose(whole, whole.T, rtol=1e-12)
    others = np.abs(whole).sum(axis=1) - matrix.diagonal
    assert np.all(matrix.diagonal > others * (1.0 - 1e-12))
    assert np.all((matrix.diagonal - others)[stepper.surface == 1] > 0.0)


def test_a_lattice_has_its_numbers():
    stepper, inside = block(lambda r: 0.0 * r)
    np.testing.assert_allclose(stepper.number[inside], moving_particles.lattice(2.1, 3).number, rtol=1e-12)
    assert not stepper.surface[inside].any() and stepper.surface[~inside].any()


@pytest.mark.parametrize("pressure", PRESSURES)
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_free_drop_keeps_mass_momentum_and_energy(tmp_path, dimensions, pressure):
    """It rings, is stretched and turned; what tension does is told."""
    run = started(tmp_path, case(sections={"method": {"pressure": pressure}}, dimensions=dimensions))
    s = run.state
    s.u[:] += 300.0 * (s.x - 4e-3) - 200.0 * (s.y - 4e-3) + 0.3
    s.v[:] += 200.0 * (s.x - 4e-3) - 300.0 * (s.y - 4e-3)
    before = s.mass @ particles.velocities(s), particles.energy_of_motion(s)
    steps = run.stepper.steps
    for _ in range(100):
        run.stepper.step(1e-5)
    s = run.state
    scale = float(s.mass.sum()) * 0.3
    assert run.stepper.steps == steps + 100
    np.testing.assert_allclose(s.mass @ particles.velocities(s), before[0], rtol=0.0, atol=1e-12 * scale)
    change = particles.energy_of_motion(s) - before[1]
    assert change == pytest.approx(run.stepper.works.sum(), rel=1e-9)


def test_a_squeezed_drop_does_not_give_way(tmp_path):
    """Velocities that squeeze it are turned into ones without divergence: it becomes wide, n stays."""
    run = started(tmp_path, case(()))
    s = run.state
    s.w[:] = -500.0 * (s.z - 4e-3)
    for _ in range(60):
        run.stepper.step(5e-6)
    s = run.state
    assert np.ptp(s.x) > 7.3e-4 > 6.7e-4 > np.ptp(s.z) and run.stepper.number.max() < 1.1 * run.stepper.cloud.number


@pytest.mark.parametrize("pressure", PRESSURES)
def test_tension_holds_a_drop_together_and_the_gauge_leaves_cohesion_out(tmp_path, pressure):
    run = started(tmp_path, case(sections={"method": {"pressure": pressure}}))
    for _ in range(200):
        run.stepper.step(5e-6)
    inside = run.stepper.surface == 0
    assert inside.sum() > 20
    laplace, cohesion = 2.0 * 0.024 / 4e-4, -run.stepper.p["free_energy_tension"].cohesion
    mean = float(run.stepper.gauge[inside].mean())
    print(f"gauge {mean:.0f} Pa, Laplace {laplace:.0f} Pa, cohesion {cohesion:.0f} Pa")
    assert abs(mean - laplace) < 0.5 * cohesion < run.stepper.state.pressure[inside].mean()


def test_two_that_meet_lose_what_they_approach_by(tmp_path):
    own = case((), {"pools": {"other": {"shape": "sphere", "centre_m": [5.2e-3, 4e-3, 4e-3], "radius_m": 4e-4,
                                         "velocity_m_s": [-2.0, 0.0, 0.0]}}})  # fmt: skip
    run = started(tmp_path, own)
    momentum = run.state.mass @ particles.velocities(run.state)
    for _ in range(60):
        run.stepper.step(5e-6)
    s = run.state
    np.testing.assert_allclose(s.mass @ particles.velocities(s), momentum, atol=1e-12 * abs(momentum[0]))
    assert run.stepper.works[-1] <= 0.0 and run.stepper.works.sum() < 0.0


@pytest.mark.parametrize(("effects", "sections", "told"), [
    (("frame",), {}, 'effects holds frame; with method.name = "mps" there are gravity'),
    ((), {"method": {"name": "weakly_compressible"}}, "liquid.sound_speed_m_s is missing"),
    ((), {"method": {"reach": 9.0}}, "method.reach"),
    (("free_energy_tension",), {"free_energy_tension": {"reach": 2.1}}, "free_energy_tension.reach = 2.1; it must be"),
    ((), {"method": {"pressure": "weakly_compressible"}}, "of sheets and drops that free_energy_tension holds"),
])  # fmt: skip
def test_what_does_not_fit_is_told_in_one_line(effects, sections, told):
    with pytest.raises(CaseError, match=told.replace("(", r"\(")):
        case(effects, sections)


@pytest.mark.parametrize("ratio", [1.0, 3.0])
def test_the_step_of_viscosity_is_of_spacings(ratio):
    """0.125 l0^2/nu; no kernel smooths."""
    stepper = MpsStepper(case(("laminar_viscosity",), {"resolution": {"smoothing_ratio": ratio}}))
    found = limits(stepper.case, stepper.p, stepper.state, 0.0)["laminar_viscosity"]
    assert found == pytest.approx(0.125 * SPACING**2 * 780.0 / 2.4e-3, rel=1e-12)


@pytest.mark.parametrize(("wide", "reach", "fits"), [(6.1, 3.1, False), (6.4, 3.1, True), (6.4, 4.1, False)])
def test_a_periodic_box_is_two_reaches_of_tension_wide(wide, reach, fits):
    sections = {
        "domain": {"size_m": [wide * SPACING, 8e-3, 8e-3]}, "liquid": {"periodic": [1.0, 0.0, 0.0]},
        "free_energy_tension": {"reach": reach},
        "pools": {"drop": {"centre_m": [0.5 * wide * SPACING, 4e-3, 4e-3], "radius_m": 2e-4}},
    }  # fmt: skip
    if fits:
        MpsStepper(case(("free_energy_tension",), sections))
        return
    with pytest.raises(CaseError, match=r"domain.size_m is below .* along x, which is periodic"):
        case(("free_energy_tension",), sections)


def test_steps_follow_the_motion_between_neighbours(tmp_path):
    run = started(tmp_path, case((), {"method": {"gradient": "pairs"}}))
    run.state.u[:] = 1e3 * (run.state.x - 4e-3)  # neighbours in reach, 2 spacings apart at most along x
    run.stepper._look()
    assert run.stepper.next_step(1.0) == pytest.approx(0.2 * SPACING / (1e3 * 2.0 * SPACING), rel=1e-3)
    assert run.stepper.limit == "relative motion"
    assert math.isclose(run.stepper.speed.max(), 0.2, rel_tol=1e-9)


def test_density_follows_the_velocities_and_evens_out():
    """Weakly compressible: a rise of rho by -rho div u dt, exact on the lattice, and c^2 of it as pressure; a wave of
    density fades by delta l0 c k^2."""
    stepper, inside = block(lambda r: 0.0 * r)
    s, rest, dt = stepper.state, stepper.cloud.density, 1e-6
    stepper.p["free_energy_tension"], stepper.own = Cohesion(-800.0), dataclasses.replace(stepper.own, suction="full")
    c = 10.0 * math.sqrt(800.0 / rest)
    s.u[:], s.v[:], s.w[:] = -30.0 * s.x, -10.0 * s.y, -20.0 * s.z
    assert compressible.pressed(stepper, dt) == 0.0
    np.testing.assert_allclose(s.density[inside], rest * (1.0 + 60.0 * dt), rtol=1e-12)
    np.testing.assert_allclose(s.pressure[inside], c * c * rest * 60.0 * dt, rtol=1e-8)
    s.u[:] = s.v[:] = s.w[:] = 0.0
    k = 2.0 * math.pi / (20.0 * 2e-4)
    s.density[:] = rest * (1.0 + 1e-3 * np.sin(k * s.x))
    before = s.density - rest
    compressible.pressed(stepper, dt)
    faded = np.sum((s.density - rest - before)[inside] * before[inside]) / np.sum(before[inside] ** 2) / dt
    assert faded == pytest.approx(-0.1 * 2e-4 * c * k * k, rel=0.02)


def test_what_is_drawn_apart_has_no_pressure_and_is_counted():
    stepper, _ = block(lambda r: 0.0 * r)
    s, rest = stepper.state, stepper.cloud.density
    stepper.p["free_energy_tension"] = Cohesion(-800.0)
    stepper.own = dataclasses.replace(stepper.own, suction="none")
    s.u[:] = 30.0 * s.x
    assert compressible.pressed(stepper, 1e-6) > 0.0
    assert (s.pressure == 0.0).all() and (s.density == rest).all()


def test_steps_hold_sound(tmp_path):
    run = started(tmp_path, case(sections={"method": {"pressure": "weakly_compressible"}}))
    sound = compressible.sound_speed(run.case, run.stepper.p["free_energy_tension"])
    assert run.stepper.next_step(1.0) == pytest.approx(0.5 * SPACING / sound, rel=1e-3)
    assert run.stepper.limit == "sound"


def test_numbers_of_a_case_know_no_gravity_that_is_off_and_a_jet_by_its_diameter():
    own = case(sections={"domain": {"gravity_m_s2": [0.0, 0.0, -9.81]}})
    assert MpsScales(own).speed == 0.0 and MpsScales(dataclasses.replace(own, effects=("gravity",))).speed > 0.0
    jet = SimpleNamespace(radius=1e-4, inner_radius=None, width=None)
    ring = SimpleNamespace(radius=1e-4, inner_radius=8e-5, width=None)
    lengths = [MpsScales(dataclasses.replace(own, nozzles={"mouth": nozzle})).length for nozzle in (jet, ring)]
    assert lengths == pytest.approx([2e-4, 2e-5])


def test_what_nothing_drives_is_not_stopped_by_round_off():
    still = case(("laminar_viscosity",))
    assert MpsGuard(still).fast == math.inf
    assert MpsGuard(case()).fast < math.inf


def test_the_furthest_place_may_be_below_0(tmp_path):
    run = started(tmp_path, case())
    run.state.x[:] -= 1.0
    assert run.row()["largest_x_m"] == pytest.approx(float(run.state.x.max()))
    assert run.row()["largest_x_m"] < 0.0
