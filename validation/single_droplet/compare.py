"""A droplet in still gas against the closed form: wet bulb, d^2 law, life (Godsave 1953, Spalding 1953); and by
Spalding's law in gas of 1000 K, where the flow of the vapour makes both of them three times slower. The saturation of
vapour is that of `sdph.laws.evaporation`, which the run has too."""

from __future__ import annotations

import math

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.laws import evaporation
from sdph.laws import exact as solution
from sdph.study.compare import check

CONSTANT = 1e-3  # of the d^2 constant and of the evaporation rate (issue 4)
WET_BULB = 0.1  # K (the same)
WARM = 1e-3  # of the droplet's temperature above the wet bulb at the start, below which it has warmed up
GONE = 0.01  # of the mass: the run has to reach it
NEAREST = 1e-6  # K that a wet bulb is off boiling
# Lewis number 1: D = k_g/(rho_g c_pv)
HOT = ("evaporation.law='spalding'", "gas.temperature_K=1000.0", "vapour.diffusivity_m2_s=7.998017e-6",
       "coupling.window_largest_s=0.05", "run.end_time_s=8.0", "run.output_interval_s=8.0")  # fmt: skip
VARIANTS = {"single_droplet": ((), ("exact",)), "Stefan flow": (HOT, ("exact",))}


def exact(run) -> list[dict]:
    """Wet-bulb temperature, d^2 constant, evaporation rate, and the mass that is left."""
    temperature, constant = closed_form(run.case)
    t, d, T, mass = _droplet(run)
    steady = np.abs(T - temperature) <= WARM * abs(T[0] - temperature)
    middle = np.flatnonzero(steady)[len(t[steady]) // 2]
    slope = -np.polyfit(t[steady], d[steady] ** 2, 1)[0]
    # dm/dt = pi/4 rho K d by droplet, at the middle of two windows
    count = mass[0] / (run.case.grains.density * math.pi / 6.0 * d[0] ** 3)
    rate = (mass[middle - 1] - mass[middle]) / (t[middle] - t[middle - 1])
    squares = d[middle - 1] ** 2, d[middle] ** 2
    mean = (squares[0] ** 1.5 - squares[1] ** 1.5) / (1.5 * (squares[0] - squares[1]))  # of d over the window
    expected = count * 0.25 * math.pi * run.case.grains.density * constant * mean
    evaporated = run.summary["evaporated_kg"] / mass[0]  # by the ledger: a droplet that is lost has not evaporated
    _figure(run, t, d, T, temperature, constant)
    return [
        check("wet-bulb temperature [K]", T[middle], temperature, WET_BULB),
        check("d^2 constant [m2/s]", slope, constant, CONSTANT, True),
        check("evaporation rate [kg/s]", rate, expected, CONSTANT, True),
        check("share of the mass that is left", 1.0 - evaporated, 0.0, GONE),
    ]


def _droplet(run):
    """Times, diameter, temperature and mass of the droplet as long as it is there."""
    h = run.history
    columns = [
        h[name] for name in ("time_s", "particle_1_diameter_m", "particle_1_temperature_K", "particle_1_mass_kg")
    ]
    return [column[np.isfinite(columns[1])] for column in columns]


def metrics(run) -> dict[str, tuple]:
    """Metrics of `sdph cost`: temperature when half of the surface is gone, against the wet bulb, of what it has to
    warm; the d^2 constant between 60 and 20 % of the surface, when it has long warmed up."""
    temperature, constant = closed_form(cases.load(scenes.find("single_droplet")[1]))  # all effects on
    t, d, T, _ = _droplet(run)
    share = (d / d[0]) ** 2
    part = (share <= 0.6) & (share >= 0.2)
    slope = -np.polyfit(t[part], d[part] ** 2, 1)[0] if part.sum() > 1 else 0.0
    half = T[np.argmin(np.abs(share - 0.5))]
    return {
        "wet bulb [K]": (float(half), temperature, abs(temperature - T[0])),
        "d2 constant [m2/s]": (float(slope), constant, None),
    }


def closed_form(case) -> tuple[float, float]:
    """Wet-bulb temperature [K] and d^2 constant [m2/s] for Nu = Sh = 2."""
    own, vapour, gas = case.parameters["evaporation"], case.vapour, case.gas
    numbers = own.saturation_pressure, own.saturation_temperature, own.latent_heat, vapour.molar_mass

    def saturation(T):
        return evaporation.saturation_clausius_clapeyron(T, numbers)

    if own.law == "spalding":
        return _with_stefan_flow(case, saturation, evaporation.boiling_temperature(gas.operating_pressure, numbers))
    T = solution.wet_bulb_temperature(
        gas.temperature, saturation, vapour.diffusivity, vapour.molar_mass, own.latent_heat, gas.conductivity
    )
    surface = vapour.molar_mass * evaporation.vapour_concentration(saturation(T), T)
    return T, 8.0 * vapour.diffusivity * surface / case.grains.density


def _with_stefan_flow(case, saturation, boiling: float) -> tuple[float, float]:
    """The same by Spalding's law; saturation(T) [Pa], boiling [K]."""
    vapour, gas = case.vapour, case.gas

    def mass_number(T):
        fraction = saturation(T) / gas.operating_pressure
        surface = evaporation.vapour_mass_fraction(fraction, vapour.molar_mass, gas.molar_mass)
        return evaporation.spalding_number(surface, 0.0)

    conducted = gas.conductivity / vapour.heat_capacity
    heat = case.parameters["evaporation"].latent_heat / vapour.heat_capacity
    hottest = min(gas.temperature, boiling - NEAREST)
    exponent = gas.density * vapour.diffusivity / conducted
    T = solution.spalding_wet_bulb(gas.temperature, hottest, mass_number, exponent, heat)
    return T, 8.0 * conducted * math.log1p((gas.temperature - T) / heat) / case.grains.density


def _figure(run, t, d, T, temperature, constant) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    left.plot(t, 1e6 * d**2, ".", label="SDPH")
    left.plot(t, 1e6 * (d[len(d) // 2] ** 2 - constant * (t - t[len(d) // 2])), "k-", lw=1, label="d$^2$ law, wet bulb")
    left.set(xlabel="time [s]", ylabel="d$^2$ [mm$^2$]")
    right.plot(t, T, ".", label="SDPH")
    right.axhline(temperature, color="k", lw=1, label="wet bulb")
    right.set(xlabel="time [s]", ylabel="droplet [K]")
    for axes in (left, right):
        axes.legend()
    figure.savefig(run.folder / "compare_exact.png", dpi=110)
    pyplot.close(figure)
