"""A plug of spray: droplets of one size and speed fill the height of a channel of hot gas, evenly.

The channel is closed on the left: the gas cannot follow, a pressure gradient bears the drag. What is far from both ends
of the plug is uniform and knows of nothing else: five ordinary differential equations, solved to 1e-10. Vapour alone
moves the gas, with the distance from the plug's rear.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from sdph.case import read as cases
from sdph.laws import drag, evaporation, heat
from sdph.running import balances, driver
from sdph.study import compare
from sdph.study.compare import check

BAR = 0.01  # of each change since the start (issue 19)
BODY, MIDDLE = (0.25, 0.75), 0.5  # m, of the plug at the start, and the droplet that is followed
SAMPLE = 0.05  # m, on each side of it: what is averaged, four cells
HEIGHT, LENGTH = 0.2, 1.0  # m, of the channel
SPEED, TEMPERATURE = 5.0, 294.0  # m/s, K, of the droplets: Re = 100, and the jet's temperature
END = 0.05  # s: the time in which drag stops them, and in which the middle stays in the plug's first place
# Of liquid: two times the heat capacity of the gas, so that what a droplet warms by cools its gas by twice that and the
# temperature of its film, (2 T_p + T_g)/3, stays: the diffusivity, which OpenFOAM takes there, is that of the case.
ALPHA_P = 2.0 * 1.225 * 1006.43 / (700.0 * 2470.0)
ONSET = 293.9  # K, below the start: evaporation is on all the time


def case(film: bool, law: str, spacing: float = 12.5e-3):
    """The plug as a case: closures of droplets that know of no other, `law` of drag."""
    effects = ["drag", "heat", "evaporation"]
    table = {
        "title": "plug of spray", "scene": "evaporating_jet", "dimensions": 2, "effects": effects,
        "run": {"end_time_s": END, "output_interval_s": END},
        "domain": {"size_m": [LENGTH, HEIGHT], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": 1e3 * spacing, "cell_mm": 2e3 * spacing},
        "coupling": {"gas": "embedded", "voidage": False, "film": film, "window_largest_s": 2.5e-4},
        "gas": {"density_kg_m3": 1.225, "viscosity_Pa_s": 1.7895e-5, "conductivity_W_m_K": 0.0242,
                "heat_capacity_J_kg_K": 1006.43, "temperature_K": 350.0},
        "grains": {"density_kg_m3": 700.0, "diameter_mm": 0.3, "heat_capacity_J_kg_K": 2470.0,
                   "conductivity_W_m_K": 500.0},
        "vapour": {"molar_mass_kg_kmol": 142.284, "diffusivity_m2_s": 3.79e-6, "heat_capacity_J_kg_K": 2470.0,
                   "conductivity_W_m_K": 0.0178, "viscosity_Pa_s": 7e-6},
        "particles": {"plug": {"shape": "box", "lower_m": [BODY[0], 0.0], "upper_m": [BODY[1], HEIGHT],
                               "volume_fraction": ALPHA_P, "temperature_K": TEMPERATURE, "velocity_m_s": [SPEED, 0.0]}},
        "boundaries": {"right": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0,
                                 "temperature_K": 350.0}, "walls": {"kind": "wall"}},
        "drag": {"law": law}, "heat": {"law": "ranz_marshall"},
        "evaporation": {"law": "linear", "onset": "paper", "onset_temperature_K": ONSET, "saturation": "constant",
                        "saturation_pressure_Pa": 1329.0, "latent_heat_J_kg": 277000.0},
    }  # fmt: skip
    return cases.from_table(table)


def exact(case, time: float) -> dict[str, float]:
    """Speed, temperatures [K], mass of vapour per gas [-] and mass evaporated over all liquid, at `time` [s]."""
    start = [SPEED, TEMPERATURE, case.gas.temperature, 0.0, case.grains.diameter**2]
    end = solve_ivp(partial(change, case), (0.0, time), start, rtol=1e-10, atol=1e-12).y[:, -1]
    return {
        "speed": end[0],
        "droplets": end[1],
        "gas": end[2],
        "vapour": end[3],
        "evaporated": 1.0 - (end[4] / case.grains.diameter**2) ** 1.5,
    }


def change(case, _, y) -> list[float]:
    """Rates of speed, temperatures, mass fraction of vapour and d^2; the gas's from its enthalpy with constant
    density."""
    speed, warm, hot, fraction, _ = y
    gas, vapour, liquid, d = case.gas, case.vapour, case.grains, math.sqrt(y[4])
    film = (2.0 * warm + hot) / 3.0 if case.coupling.film else hot
    ratio = hot / film
    around, mu, k = gas.density * ratio, gas.viscosity / ratio, gas.conductivity / ratio
    count = ALPHA_P * 6.0 / (math.pi * liquid.diameter**3)  # droplets per m3
    molar = evaporation.vapour_mole_fraction(fraction, vapour.molar_mass, gas.molar_mass) * gas.operating_pressure
    surface = case.parameters["evaporation"].saturation_pressure
    if case.coupling.film:
        force = evaporation.vapour_concentration(surface - molar, film)
    else:
        force = evaporation.vapour_concentration(surface, warm) - evaporation.vapour_concentration(molar, hot)
    flow = count * math.pi * d * vapour.diffusivity * vapour.molar_mass * force  # kg/(m3 s) for Sh = 1
    reynolds = around * abs(speed) * d / mu
    for _ in range(3):  # the slip, less what the vapour itself moves the gas
        made = flow * evaporation.sherwood_ranz_marshall(
            reynolds, evaporation.schmidt_number(around, mu, vapour.diffusivity)
        )
        slip = speed - made / gas.density * (MIDDLE - BODY[0])
        reynolds = around * abs(slip) * d / mu
    prandtl = heat.prandtl_number(mu, gas.heat_capacity, k)
    volume = count * math.pi / 6.0 * d**3
    taken = volume * heat.exchange_geometric(1.0, heat.ranz_marshall(1.0, reynolds, prandtl), k, d) * (hot - warm)
    mixture = gas.heat_capacity + fraction * (vapour.heat_capacity - gas.heat_capacity)
    return [
        -getattr(drag, case.parameters["drag"].law)(0.0, abs(slip), d, around, mu) * slip / liquid.density,
        (taken - made * case.parameters["evaporation"].latent_heat) / (volume * liquid.density * liquid.heat_capacity),
        (-taken + made * vapour.heat_capacity * (warm - hot)) / (gas.density * mixture),
        made * (1.0 - fraction) / gas.density,
        -made * 4.0 / (math.pi * count * d * liquid.density),
    ]


def checks(folder, overrides, reporter) -> list[dict]:
    """Both codes against the equations, with the film's properties and, SDPH alone, without."""
    rows = []
    for name, film, law in (("gas as it is", False, "schiller_naumann"), ("film", True, "putnam")):
        own = case(film, law)
        driver.run(own, "evaporating_jet", folder / name.replace(" ", "-"), None, reporter)
        run = compare.open_run(folder / name.replace(" ", "-"))
        rows += [row | {"name": f"{name}, balances: {row['name']}"} for row in balances.checks(run.summary)]
        rows += against(f"{name}, SDPH", ours(run), own)
    return rows + against("film, reactingParcelFoam", droplets(own, folder / "dpm"), own)


def against(name: str, values: dict, case) -> list[dict]:
    """A check for each change since the start."""
    start = {"speed": SPEED, "droplets": TEMPERATURE, "gas": case.gas.temperature}
    return [
        check(f"{name}: change of {key}", values[key] - start.get(key, 0.0), end - start.get(key, 0.0), BAR, True)
        for key, end in exact(case, END).items()
    ]


def ours(run) -> dict[str, float]:
    """Means of the middle of a run of SDPH."""
    _, particles, gas = run.fields(END)
    drops = {name: np.asarray(particles[name]) for name in ("velocity", "temperature", "diameter")}
    cells = {name: np.asarray(gas.cell_data[name]) for name in ("temperature", "vapour_mass_fraction")}
    return means(
        np.asarray(particles.points), drops["velocity"][:, 0], drops["temperature"], drops["diameter"],
        np.asarray(gas.cell_centers().points), cells["temperature"], cells["vapour_mass_fraction"], run.case,
    )  # fmt: skip


def droplets(case, folder) -> dict[str, float]:
    """The same of the droplet solver."""
    from coupling.openfoam.comparators.run import run_droplets

    reference = run_droplets(case, folder, at_start(case))
    drops, fields = reference.parcels[max(reference.parcels)], reference.fields[max(reference.fields)]
    return means(
        drops["position"], drops["velocity"][:, 0], drops["temperature"], drops["diameter"],
        reference.centres, fields["gas_temperature"], fields["vapour_mass_fraction"], case,
    )  # fmt: skip


def at_start(case):
    """The plug as droplets that the droplet solver starts with: a lattice of the case's spacing."""
    from coupling.openfoam.comparators.droplet_sources import Drops

    dx, (begin, end) = case.resolution.spacing, BODY
    x, y = np.meshgrid(np.arange(begin + 0.5 * dx, end, dx), np.arange(0.5 * dx, HEIGHT, dx))
    place, each = np.stack([x.ravel(), y.ravel()], axis=1), np.ones(x.size)
    mass = ALPHA_P * case.grains.density * dx**2 * each
    velocity = np.stack([SPEED * each, 0.0 * each], axis=1)
    return Drops(place, velocity, TEMPERATURE * each, mass, case.grains.diameter * each, 0.0 * each)


def means(places, speed, temperature, diameter, centres, gas, vapour, case) -> dict[str, float]:
    """Means over the droplets and cells within SAMPLE of where the middle of the plug has come to."""
    middle = float(np.mean(places[:, 0]))
    drops = np.abs(places[:, 0] - middle) < SAMPLE
    cells = np.abs(centres[:, 0] - middle) < SAMPLE
    return {
        "speed": float(speed[drops].mean()),
        "droplets": float(temperature[drops].mean()),
        "gas": float(gas[cells].mean()),
        "vapour": float(vapour[cells].mean()),
        "evaporated": float(1.0 - ((diameter[drops] / case.grains.diameter) ** 3).mean()),
    }
