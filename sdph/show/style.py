"""One look for all pictures: the map, label and unit of each quantity, its range and its digits, light and dark."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np


class Quantity(NamedTuple):
    """A field as pictures name it: label, SI unit, and the colour map of matplotlib (all are perceptually even)."""

    label: str
    unit: str
    map: str = "viridis"


QUANTITIES = {
    "temperature": Quantity("temperature", "K", "warm"),
    "velocity": Quantity("speed", "m/s"),
    "alpha_p": Quantity("volume fraction", "1", "pale"),  # a void is pale and a packed bed dark, as in print
    "pressure": Quantity("pressure", "Pa", "plasma"),
    "density": Quantity("density", "kg/m3", "cividis"),
    "vapour_mass_fraction": Quantity("mass fraction of vapour", "1", "pale"),
    "vorticity": Quantity("vorticity", "1/s", "RdBu_r"),
    "theta": Quantity("granular temperature", "m2/s2"),
    "diameter": Quantity("diameter", "m", "cividis"),
    "mass": Quantity("mass", "kg", "cividis"),
    "ident": Quantity("number", "1"),
    "kind": Quantity("kind", "1"),
    "sealed": Quantity("sealed", "1"),
    "material": Quantity("material", "1"),
    "piece": Quantity("piece", "1"),
    "body": Quantity("body", "1"),
    "free": Quantity("torn off", "1"),
    "equivalent_stress": Quantity("equivalent stress", "Pa", "plasma"),
    "hoop_stress": Quantity("hoop stress", "Pa", "RdBu_r"),
    "plastic_strain": Quantity("plastic strain", "1"),
    "damage": Quantity("damage", "1", "warm"),
    **{f"stress_{ab}": Quantity(f"stress {ab}", "Pa", "RdBu_r") for ab in ("xx", "yy", "zz", "xy", "yz", "zx")},
}
PARTS = {"pale": ("magma_r", 0.0, 0.82), "warm": ("inferno", 0.08, 1.0)}  # maps of matplotlib without their black end
SIGNED = "RdBu_r"  # the map of quantities whose sign matters: white is 0
SECOND = "viridis"  # of a second quantity in a picture, like no other map here
AWAY = 0.5  # of the largest: values that are all above it are shown in their own range, others from 0; our choice
FROM_ZERO = ("velocity", "alpha_p", "vapour_mass_fraction", "theta", "equivalent_stress", "plastic_strain", "damage")
PREFIXES = {  # unit -> (factor, unit) from large to small: the first that the largest value reaches is taken
    "m": ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")),
    "s": ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")),
    "kg": ((1.0, "kg"), (1e-3, "g"), (1e-6, "mg"), (1e-9, "µg")),
}
EXPONENTS = {"m2": "m²", "m3": "m³", "s2": "s²"}
PREFIX_FROM = {"m": 0.1, "s": 0.1}  # of a unit that the largest value must reach, else 1: 0.3 m stays m; our choice
SHARE = 0.005  # of the values that may lie beyond each end of a range, which its bar then tells; our choice
LONE = 2.0  # times longer must the whole range be than that of the others, or nothing is left beyond; our choice
PLAIN = 1e5  # below this large numbers are written without an exponent
STILL = 1e-9  # m/s: what is slower is round-off, and shown as at rest; our choice
NARROW = 0.01  # of its values: a range so narrow is told from a round value on, its digits would not show; our choice


class Theme(NamedTuple):
    """Colours of paper, ink, what is less important, walls and what has no value."""

    paper: str
    ink: str
    faint: str
    wall: str
    void: str


THEMES = {
    "light": Theme("#ffffff", "#1a1a1a", "#6b6b6b", "#7d8794", "#c9ced6"),
    "dark": Theme("#14171c", "#e8e8e8", "#9aa0a8", "#8a95a3", "#4a505a"),
}


def map_of(name: str):
    """Map of matplotlib, or a part of one."""
    from matplotlib import colormaps, colors

    if name not in PARTS:
        return colormaps[name]
    whole, start, end = PARTS[name]
    return colors.ListedColormap(colormaps[whole](np.linspace(start, end, 256)), name)


class Scale(NamedTuple):
    """A quantity on a bar: shown value = (value - origin)/factor, from `low` to `high`; `extend` as matplotlib has it
    where values lie beyond."""

    title: str
    map: str
    low: float
    high: float
    origin: float
    factor: float
    extend: str

    def shown(self, values) -> np.ndarray:
        return (np.asarray(values) - self.origin) / self.factor


def unit_of(field: str) -> str:
    """SI unit of a field; 1 of one that is not known."""
    return QUANTITIES[field].unit if field in QUANTITIES else "1"


def prefixed(unit: str, largest: float) -> tuple[float, str]:
    """(factor, unit) in which values up to `largest` have few digits."""
    known, least = PREFIXES.get(unit, ((1.0, unit),)), PREFIX_FROM.get(unit, 1.0)
    return next((row for row in known if largest >= least * row[0]), known[-1] if largest else known[0])


def written(unit: str) -> str:
    """A unit as print has it: m/s2 as m/s²."""
    for plain, own in EXPONENTS.items():
        unit = unit.replace(plain, own)
    return unit


def scale(field: str, arrays: list) -> Scale:
    """The one scale of a field over `arrays`, numbers of particles and cells, of all the pictures that belong
    together."""
    quantity = QUANTITIES.get(field, Quantity(field.replace("_", " "), "1"))
    low, high, extend = _range(quantity, field, arrays)
    largest, origin = max(abs(low), abs(high)), 0.0
    if 0.0 < high - low < NARROW * largest:
        origin = float(f"{low:.3g}")
        largest = max(abs(low - origin), abs(high - origin))
    factor, unit = prefixed(quantity.unit, largest)
    below, whole = prefixed(quantity.unit, abs(origin))
    above = f" above {digits(origin / below)} {written(whole)}" if origin else ""
    title = quantity.label + above + ("" if unit == "1" else f" [{written(unit)}]")
    return Scale(title, quantity.map, (low - origin) / factor, (high - origin) / factor, origin, factor, extend)


def _range(quantity: Quantity, field: str, arrays: list) -> tuple[float, float, str]:
    """(low, high, extend) of the values: all of them, but for a few lone ones far out, which `extend` tells of."""
    parts = [np.ravel(own) for own in arrays]
    values = np.concatenate([own[np.isfinite(own)] for own in parts] or [np.zeros(0)])
    if not len(values):
        return 0.0, 1.0, "neither"
    least, most = float(values.min()), float(values.max())
    if quantity.unit == "m/s" and max(abs(least), abs(most)) < STILL:
        return 0.0, 1.0, "neither"
    low, high = (float(q) for q in np.quantile(values, (SHARE, 1.0 - SHARE)))
    if most - least <= LONE * (high - low) or high == low:
        low, high = least, most
    if quantity.map == SIGNED:
        low, high = -max(abs(low), abs(high)), max(abs(low), abs(high))
    elif field in FROM_ZERO and 0.0 <= least <= AWAY * high:
        low, high = 0.0, high or 1.0
    if not high > low:
        low, high = low - 0.5 * max(abs(low), 1e-3), high + 0.5 * max(abs(high), 1e-3)
    return low, high, _EXTEND[least < low - 1e-9 * abs(low), most > high + 1e-9 * abs(high)]


_EXTEND = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}


def digits(value: float, _=None) -> str:
    """A number as labels have it: three digits, no more."""
    text = f"{0.0 if abs(value) < 1e-12 else value:.3g}"
    if "e+0" in text and abs(value) < PLAIN:
        text = f"{float(text):.0f}"
    return text if math.isfinite(value) else ""
