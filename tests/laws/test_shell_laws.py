"""Shells against closed forms: Lame, Hencky, the plastic limit, the front between, Considere."""

import math

import numpy as np
import pytest
from gel_values import VALUES

from sdph.effects.gas import gel
from sdph.laws import shells

INNER, OUTER, A = 4.5e-4, 5e-4, 4.9e5
STIFF = 1e14  # Pa: a volume that stays, a strain that is plastic
ELASTIC = gel.Shell(yield_stress=1e15, hardening=0.0, rate_factor=0.0)
PLAIN = gel.Shell(hardening=0.0, rate_factor=0.0)


def inflated(shell, ratios, dims=2, layers=40, bulk=None, shear=None):
    """Pressures [Pa] at D/D_0 of ratios, in steps from one to the next, and the rows of the layers at the end."""
    edges, rows = shells.layers(INNER, OUTER, layers)
    after, found, moduli = rows.copy(), [], gel.moduli(shell)
    moduli = bulk or moduli[0], shear or moduli[1]
    for ratio in ratios:
        growth = (ratio**dims - 1.0) * OUTER**dims - shells.outer_growth(dims, edges, 0.0, rows)
        found.append(
            shells.loaded(dims, edges, growth, gel.plastic(shell), gel.damage(shell), *moduli, 1e-3, rows, after)
        )
        rows, after = after, rows.copy()
    return np.array(found), rows


def test_lame_ring():
    """Displacement of the outer face, and the hoop stresses of faces from those of their layers; at a thousandth of 10
    kPa, as Lame's strains are small. sigma_z half way (law) is 0.3 % off there."""
    small, ratio = 1e-3, 1.0 + 1e-3 * VALUES["ring_u_outer_0.45_0.5"] / OUTER
    found, rows = inflated(ELASTIC, np.full(40, ratio))
    assert found[-1] == pytest.approx(small * 1e4, rel=0.004)
    edges, stress = shells.layers(INNER, OUTER, 40)[0], np.empty(40)
    growth = (ratio**2 - 1.0) * OUTER**2 - shells.outer_growth(2, edges, 0.0, rows)
    shells.stresses(2, edges, growth, gel.moduli(ELASTIC)[1], rows, stress)
    inner, outer = (VALUES[f"ring_hoop_{face}_0.45_0.5"] for face in ("inner", "outer"))
    assert shells.hoop_stress(-small * 1e4, stress[0], 2) == pytest.approx(small * inner, rel=0.01)
    assert shells.hoop_stress(0.0, stress[-1], 2) == pytest.approx(small * outer, rel=0.01)


def test_hoop_stress_of_a_sphere():
    """q = sigma_theta - sigma_r, and of an elastic sphere q ~ 1/r^3: the layers' pressures give Lame's at the face."""
    edges = np.linspace(INNER, OUTER, 2001)
    middles = 0.5 * (edges[1:] + edges[:-1])
    whole = sum(shells.layer_pressure((INNER / m) ** 3, a, b, 3) for m, a, b in zip(middles, edges, edges[1:]))
    found = shells.hoop_stress(-1e4, 1e4 / whole, 3)
    assert found == pytest.approx(VALUES["sphere_hoop_inner_0.45_0.5"], rel=1e-6)


def test_hencky_ring():
    """Large strain, logarithmic, at a volume that stays."""
    found, _ = inflated(ELASTIC, [1.2], layers=400, bulk=STIFF, shear=2e7 / 3.0)
    assert found[0] == pytest.approx(VALUES["ring_hencky_1.2"], rel=1e-5)


@pytest.mark.parametrize(("dims", "name"), [(2, "ring"), (3, "sphere")])
def test_plastic_limit(dims, name):
    found = shells.layer_pressure(A, INNER, OUTER, dims)
    assert found == pytest.approx(VALUES[f"{name}_limit_0.45_0.5"], rel=1e-8)


@pytest.mark.parametrize(("dims", "ratio", "name"), [(2, 1.1, "ring_limit_at_1.1"), (3, 1.2, "sphere_limit_at_1.2")])
def test_plastic_limit_of_a_shell_that_has_grown(dims, ratio, name):
    found, _ = inflated(PLAIN, [ratio], dims, bulk=STIFF, shear=1e11)
    assert found[0] == pytest.approx(VALUES[name], rel=1e-5)


def test_the_plastic_front_goes_from_the_inner_face_out():
    """Pressures when the first layer yields and when half of them have; volume stays."""
    ratios, layers = np.linspace(1.0, 1.0008, 401)[1:], 200
    edges, rows = shells.layers(INNER, OUTER, layers)
    found, front, after = [], [], rows.copy()
    for ratio in ratios:
        growth = (ratio**2 - 1.0) * OUTER**2
        constants = gel.plastic(PLAIN), gel.damage(PLAIN), STIFF, 2e8
        found.append(shells.loaded(2, edges, growth, *constants, 1e-3, rows, after))
        rows, after = after, rows.copy()
        front.append(np.count_nonzero(rows[shells.FLOW]))
    first, half = np.interp([1, 100], front, found)
    assert first == pytest.approx(VALUES["ring_first_yield_0.45_0.5"], rel=0.01)
    assert half == pytest.approx(VALUES["ring_half_plastic_0.45_0.5"], rel=0.003)


def test_johnson_cook_ring():
    ratios = np.arange(1.0, 1.4001, 1e-3)
    shell = gel.Shell(rate_factor=0.1739)
    edges, rows = shells.layers(INNER, OUTER, 4)
    after = rows.copy()
    for ratio in ratios[1:]:
        growth = (ratio**2 - 1.0) * OUTER**2 - shells.outer_growth(2, edges, 0.0, rows)
        constants = gel.plastic(shell), gel.damage(shell), *gel.moduli(shell)
        found = shells.loaded(2, edges, growth, *constants, 1e-3 / 5.0, rows, after)
        rows, after = after, rows.copy()
    assert found == pytest.approx(VALUES["jcd_ring_p_1.4"], rel=1e-3)
    assert 0.0 < rows[shells.HARM].max() < 0.012


def spot_pull(shell, hoop):
    """Tension over the thickness unloaded of a rigid-plastic spot that has been drawn to a hoop strain [Pa]."""
    stress, _ = shells.yielded(gel.plastic(shell), STIFF, shells.sheared(hoop, 0.0, 2), 0.0, 0.0, 0.0, 0.0, 1.0)
    return shells.spot_tension(stress, math.exp(-hoop), 0.0, 2)


def test_necking_begins_where_considere_says():
    shell = gel.Shell(rate_factor=0.0)
    stretches = np.arange(1.2, 1.6, 1e-4)
    best = stretches[np.argmax([spot_pull(shell, math.log(stretch)) for stretch in stretches])]
    assert best == pytest.approx(VALUES["considere_ring_lam"], abs=2e-4)


def necked(pull, spot, hoop=0.0, shell=PLAIN):
    constants = gel.plastic(shell), gel.damage(shell), *gel.moduli(shell)
    return shells.necked(2, 4.65e-5, 1e4, pull, *constants, 1e-3, hoop, spot)


def test_a_spot_takes_the_strain_that_bears_the_pull():
    spot = np.zeros(4)
    hoop = necked(4.0, spot)
    shear = gel.moduli(PLAIN)[1]
    stress = 3.0 * shear * (shells.sheared(hoop, 0.0, 2) - spot[shells.FLOW])
    assert shells.spot_tension(stress, 4.65e-5 * math.exp(-hoop), 1e4, 2) == pytest.approx(4.0, rel=1e-9)
    assert spot[shells.FLOW] == spot[shells.HARM] == 0.0 < spot[shells.SWELL]
    back = necked(2.0, spot, hoop)
    assert 0.0 < back < hoop


def test_a_spot_that_bears_no_more_runs_away_unchanged():
    spot = np.zeros(4)
    assert necked(100.0, spot) == math.inf
    assert not spot.any()


@pytest.mark.parametrize("dims", [2, 3])
def test_balance_of_a_half(dims):
    """p over the section of the inside is the hoop force of the shell around it."""
    force = shells.tension(1e4, INNER, OUTER, dims)
    section, around = (2.0 * INNER, 2.0) if dims == 2 else (math.pi * INNER**2, math.pi * (INNER + OUTER))
    assert force * around == pytest.approx(1e4 * section, rel=1e-14)
