"""Boxes of char that burns: one-way in gas of 10 % of oxygen, and closed ones whose oxidant runs low."""

import math

from builders import simulation
from grain_boxes import table

from coupling.embedded import EmbeddedGas
from sdph.case import read as cases

DENSITY, DIAMETER, RATIO, RATE, GAS, OXIDANT, D = 1200.0, 1e-4, 32.0 / 12.0, 0.3, 0.32, 0.1, 2e-4
HEAT, CHAR, CARRIER, OXYGEN = 32.8e6, 1500.0, 1150.0, 1050.0  # J/kg, J/(kg K)
END, LEFT = 2.0, 0.4  # s, of the oxidant, in `boxed`
BOTH = ("reaction", "heat")
SPECIES = {
    "molar_mass_kg_kmol": 32.0, "diffusivity_m2_s": D, "heat_capacity_J_kg_K": OXYGEN, "conductivity_W_m_K": 0.07,
    "viscosity_Pa_s": 4.5e-5, "mass_fraction": OXIDANT,
}  # fmt: skip


def char(effects=("reaction",), end=1.0, windows=20, alpha_p=1e-6, **more):
    """A box of char, one cell of gas of 1100 K with 10 % of oxygen, that feels nothing unless it is told."""
    base = {
        "size": (0.02, 0.02), "periodic": (), "alpha_p": alpha_p,
        "resolution": {"spacing_mm": 5.0, "cell_mm": 20.0},
        "run": {"end_time_s": end, "output_interval_s": end},
        "coupling": {"window_largest_s": end / windows, "window_tolerance": 1e30, "courant": 1e30, "one_way": True},
        "gas": {"density_kg_m3": GAS, "viscosity_Pa_s": 4.5e-5, "conductivity_W_m_K": 0.07,
                "heat_capacity_J_kg_K": CARRIER, "temperature_K": 1100.0},
        "grains": {"density_kg_m3": DENSITY, "diameter_mm": DIAMETER * 1e3, "heat_capacity_J_kg_K": CHAR},
        "particles": {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.02, 0.02],
                              "volume_fraction": alpha_p, "temperature_K": 1100.0}},
        "vapour": SPECIES, "boundaries": {"walls": {"kind": "wall"}},
    }  # fmt: skip
    if "reaction" in effects:
        base["reaction"] = {"oxidant_ratio": RATIO, "rate_m_s": RATE, "heat_J_kg": 0.0}
    if "heat" in effects:
        base["heat"] = {"law": "ranz_marshall", "closure": "geometric"}
    for name, section in more.items():
        base[name] = base.get(name, {}) | section if isinstance(section, dict) else section
    return cases.from_table(table(list(effects), **base))


def started(case, folder):
    return simulation(case, folder, gas=lambda case, cells: EmbeddedGas(case))


def finished(case, folder):
    run = started(case, folder)
    while run.time < case.run.end_time * (1.0 - 1e-12):
        run.window()
    return run


def boxed(count=40, **more):
    """A closed box in which the oxidant falls to LEFT of what it was within END, if grains stayed as they are."""
    strip = -math.log(LEFT) / END  # 6 alpha_p k/(d (1 - alpha_p)) [1/s]
    alpha_p = 1.0 / (1.0 + 6.0 / ((1.0 / RATE + DIAMETER / (2.0 * D)) * DIAMETER * strip))
    more = {"coupling": {"one_way": False, "window_largest_s": END / count, "window_tolerance": 1e30}} | more
    return char(end=END, alpha_p=alpha_p, **more)
