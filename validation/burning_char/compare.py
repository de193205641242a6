"""Char that burns off in a stream: a lone grain against its own two equations, and a cloud against a column of its own
cells, both written out here apart from `sdph/laws`."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import solve_banded

from sdph.schema import CaseError
from sdph.study.compare import check

LONE = 0.005  # of what the grain's diameter loses, and of its rise in temperature; our choice
CLOUD = 0.03  # of mass burned and of the gas's rise behind the cloud: its edges are as wide as the kernel; our choice
SAME = 1e-10  # of the heat exchanged; our choice
HALF = 0.5  # of the run: the cloud's front grains burn then
STEP, CELLS = 2e-3, 400  # s and cells of the column: half of both change its numbers by 0.1 %


def flux(case, d, hot, slip, oxidant):
    """Oxidant [kg/(m2 s)] on grains of d [m] and `hot` [K] in gas of slip [m/s] with Y, and their h [W/(m2 K)]:
    Arrhenius, Ranz & Marshall, both in series."""
    own, gas, vapour = case.parameters["reaction"], case.gas, case.vapour
    root = np.sqrt(gas.density * slip * d / gas.viscosity)
    schmidt = gas.viscosity / (gas.density * vapour.diffusivity)
    prandtl = gas.viscosity * gas.heat_capacity / gas.conductivity
    sherwood, nusselt = (2.0 + 0.6 * root * number ** (1.0 / 3.0) for number in (schmidt, prandtl))
    k_s = own.rate * np.exp(-own.activation_temperature / hot)
    k = 1.0 / (1.0 / k_s + d / (sherwood * vapour.diffusivity))
    return k * gas.density * oxidant, nusselt * gas.conductivity / d


def lone(case, end: float):
    """Diameter [m] and temperature [K] of a grain at the inlet's gas after `end` [s]."""
    own, grains, inlet = case.parameters["reaction"], case.grains, case.boundaries["inlet"]

    def change(t, y):
        d, hot = y
        taken, h = flux(case, d, hot, inlet.velocity[1], inlet.vapour_mass_fraction)
        heat = own.heat * taken / own.oxidant_ratio - h * (hot - inlet.temperature)
        return -2.0 * taken / (own.oxidant_ratio * grains.density), 6.0 * heat / (
            d * grains.density * grains.heat_capacity
        )

    start = grains.diameter, case.particles["lone"].temperature
    return solve_ivp(change, (0.0, end), start, method="LSODA", rtol=1e-9, atol=1e-13).y[:, -1]


def column(case, ends) -> tuple[np.ndarray, np.ndarray]:
    """Share of the cloud that has burned, and temperature [K] of the gas at the outlet, at each of `ends` [s].

    One dimension: oxidant and heat are carried, diffuse and are taken implicitly in each step, grains follow.
    """
    own, gas, vapour, grains = case.parameters["reaction"], case.gas, case.vapour, case.grains
    inlet, cloud = case.boundaries["inlet"], case.particles["cloud"]
    dx = case.domain.size[1] / CELLS
    middle = (np.arange(CELLS) + 0.5) * dx
    there = (middle > cloud.lower[1]) & (middle < cloud.upper[1])
    number = there * cloud.volume_fraction / (math.pi / 6.0 * grains.diameter**3)
    d, hot = np.full(CELLS, grains.diameter), np.full(CELLS, cloud.temperature)
    oxidant, warm = np.full(CELLS, vapour.mass_fraction), np.full(CELLS, gas.temperature)
    through = np.full(CELLS + 1, gas.density * inlet.velocity[1])  # kg/(m2 s) through the faces
    found, first = [], number.sum() * grains.diameter**3
    for step in range(1, round(max(ends) / STEP) + 1):
        area = number * math.pi * d * d
        taken, h = flux(case, np.maximum(d, 1e-9), hot, through[1:] / gas.density, 1.0)
        burned = area * taken  # over Y [kg/(m3 s)]
        oxidant = _carried(gas.density * vapour.diffusivity, gas.density, through, dx, oxidant, burned, 0.0,
                           inlet.vapour_mass_fraction)  # fmt: skip
        solid = burned * oxidant / own.oxidant_ratio
        through[1:] = through[0] + np.cumsum(solid) * dx
        warm = _carried(gas.conductivity / gas.heat_capacity, gas.density, through, dx, warm,
                        area * h / gas.heat_capacity, (area * h / gas.heat_capacity + solid) * hot, inlet.temperature,
                        solid)  # fmt: skip
        d, hot = _grains(case, d, hot, warm, taken * oxidant, h)
        if any(math.isclose(step * STEP, end) for end in ends):
            found.append((1.0 - (number * d**3).sum() / first, warm[-1]))
    return tuple(np.array(found).T)


def _grains(case, d, hot, warm, taken, h):
    """Diameters and temperatures after a step: heat exactly, in gas that stays as it is."""
    own, grains = case.parameters["reaction"], case.grains
    balance = warm + own.heat * taken / own.oxidant_ratio / h
    rate = 6.0 * h / (np.maximum(d, 1e-9) * grains.density * grains.heat_capacity)
    return np.maximum(d - STEP * 2.0 * taken / (own.oxidant_ratio * grains.density), 0.0), balance + (
        hot - balance
    ) * np.exp(-STEP * rate)


def _carried(spread, density, through, dx, before, taken, given, inlet, grown=0.0):
    """One implicit step of rho Y or rho T: carried upwind, less what that smears of the spread [kg/(m s)]; taken
    [kg/(m3 s)] times the new value, and given; `grown` [kg/(m3 s)], the new mass of a value's own."""
    low, high = through[:-1], through[1:]
    spread = np.full(len(low) + 1, spread - 0.5 * low.mean() * dx)  # upwinding smears by u dx/2
    spread[-1] = 0.0
    diagonal = density / STEP + taken + (high + (spread[:-1] + spread[1:]) / dx) / dx
    below = -(low + spread[:-1] / dx) / dx
    above = -spread[1:] / dx / dx
    right = density / STEP * before + given
    diagonal[0] += spread[0] / dx / dx  # the inlet's value is half a cell away
    right[0] += (low[0] + 2.0 * spread[0] / dx) / dx * inlet
    diagonal = diagonal - (high - low) / dx + grown
    bands = np.vstack((np.append(0.0, above[:-1]), diagonal, np.append(below[1:], 0.0)))
    return solve_banded((1, 1), bands, right)


def exact(run) -> list[dict]:
    """The lone grain at half of the run, the cloud at half and at the end, and the energy that nobody gave."""
    case, h = run.case, run.history
    ends = HALF * case.run.end_time, case.run.end_time
    if any(not math.isclose(round(end / STEP) * STEP, end) for end in ends):
        raise CaseError(f"run.end_time_s = {ends[1]:g}: the column it is held to takes multiples of {STEP / HALF:g} s")
    time = h["time_s"]
    d, hot = (np.interp(ends[0], time, h[f"particle_1_{name}"]) for name in ("diameter_m", "temperature_K"))
    expected = lone(case, ends[0])
    share, warm = column(case, ends)
    rows = [
        check("lone grain, loss of its diameter [um]", 1e6 * (case.grains.diameter - d),
              1e6 * (case.grains.diameter - expected[0]), LONE, True),
        check("lone grain, warmer than the gas by [K]", hot - case.gas.temperature,
              expected[1] - case.gas.temperature, LONE, True),
    ]  # fmt: skip
    first = run.ledger["particle_mass_kg"][0]
    for end, part, behind in zip(ends, share, warm, strict=True):
        left = np.interp(end, run.ledger["time_s"], run.ledger["particle_mass_kg"])
        rows.append(check(f"cloud, share burned at {end:g} s", 1.0 - left / first, part, CLOUD, True))
        gas = run.fields(end)[2]
        top = np.asarray(gas.cell_centers().points)[:, 1]
        rise = np.asarray(gas.cell_data["temperature"])[top > top.max() - 1e-6].mean() - case.gas.temperature
        rows.append(
            check(f"gas behind the cloud, risen by [K] at {end:g} s", rise, behind - case.gas.temperature, CLOUD, True)
        )
    # of the other balances `validate` asks as much; of this one less
    return [*rows, check("energy that nobody gave, of the heat exchanged", run.summary["energy_drift_rel"], 0.0, SAME)]
