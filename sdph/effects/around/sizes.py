"""Sizes of what a nozzle gives: one log-normal, a distribution cut into classes of equal mass, or sizes one by one.

Of several sizes each is a particle of its own at each place of the mouth, with its share of the mass: so small drops
and large ones part in flight. Mass, surface and number of the drops are those of the distribution.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from sdph.laws import size_classes
from sdph.laws.break_up import sauter_diameter
from sdph.schema import CaseError

LAWS = ("log_normal", "rosin_rammler", "given")
MOST_SIZES = 64  # sizes at a place: each is a particle; our choice
OF_LAW = {  # key -> the law that has it
    "diameter": "log_normal", "diameter_std": "log_normal", "size_parameter": "rosin_rammler",
    "size_exponent": "rosin_rammler", "least_diameter": "rosin_rammler", "most_diameter": "rosin_rammler",
    "diameters": "given", "shares": "given",
}  # fmt: skip
UNITS = {"size_exponent": "", "shares": ""}  # of keys that are not in mm


class Sizes(NamedTuple):
    """K sizes at each place: share of the mass (K,), number mean [m] and variance [m2] of the diameters (K,)."""

    share: np.ndarray
    diameter: np.ndarray
    variance: np.ndarray


def of_nozzle(case, nozzle) -> Sizes:
    """The sizes of a nozzle; of liquid one that means nothing."""
    if case.grains is None:
        return Sizes(np.ones(1), np.zeros(1), np.zeros(1))
    if nozzle.sizes == "given":
        d = np.array(nozzle.diameters)
        shares = np.array(nozzle.shares or (1.0,) * len(d))
        return Sizes(shares / shares.sum(), d, np.zeros(len(d)))
    diameter, variance = np.array(_classes(case.of(nozzle.material), nozzle)).T
    return Sizes(np.full(len(diameter), 1.0 / len(diameter)), diameter, variance)


def own_diameter(case, nozzle) -> float | None:
    """Sauter mean [m] of what a nozzle with sizes of its own gives; a table of drops counts as its grains."""
    if nozzle.shape == "table" or not any(getattr(nozzle, key) for key in OF_LAW):
        return None
    own = of_nozzle(case, nozzle)
    return float(1.0 / (own.share / sauter_diameter(own.diameter, own.variance)).sum())


def largest(case, nozzle) -> float | None:
    """Sauter mean [m] of the particle with the largest drops that a nozzle gives; a table of drops counts as its
    grains."""
    if nozzle.shape == "table" or case.grains is None:
        return None
    own = of_nozzle(case, nozzle)
    return float(sauter_diameter(own.diameter, own.variance).max())


def of_densest(case, patches):
    """The case as if all its grains were of the diameter that the densest of the `patches` has of its own."""
    densest = max(patches, key=lambda patch: patch.alpha_p, default=None)
    if densest is None or densest.diameter is None or case.mixed:
        return case
    return replace(case, grains=replace(case.grains, diameter=densest.diameter, diameter_std=0.0))


def _classes(grains, nozzle) -> list[tuple[float, float]]:
    """Number mean [m] and variance [m2] of each class of equal mass."""
    if nozzle.sizes == "rosin_rammler":
        own = nozzle.size_parameter, nozzle.size_exponent, nozzle.least_diameter
        return size_classes.rosin_rammler(*own, nozzle.most_diameter or math.inf, nozzle.size_classes)
    return size_classes.log_normal(nozzle.diameter or grains.diameter, _std(grains, nozzle), nozzle.size_classes)


def _std(grains, nozzle) -> float:
    """Number standard deviation [m] of a log-normal."""
    return grains.diameter_std if nozzle.diameter_std is None else nozzle.diameter_std


def spread(nozzle) -> bool:
    """Tell whether the nozzle gives particles whose drops are not all alike."""
    return nozzle.shape == "table" or nozzle.sizes == "rosin_rammler" or bool(nozzle.diameter_std)


def check(case, where: str, nozzle) -> None:
    """CaseError where keys of sizes are missing, of another law, or make no distribution."""
    given = [key for key in OF_LAW if getattr(nozzle, key) not in (None, ())]
    if (nozzle.shape == "table" or case.grains is None) and (nozzle.sizes != LAWS[0] or nozzle.size_classes > 1):
        told = "a table of drops has its own" if case.grains else "liquid has none"
        raise CaseError(f"{where}.sizes are of grains that come in singly; {told}: leave sizes and size_classes out")
    for key in given:
        if OF_LAW[key] != nozzle.sizes:
            named = f"{where}.{_key(key)} is of sizes = {OF_LAW[key]!r}"
            raise CaseError(f"{named}; sizes = {nozzle.sizes!r}: leave it out, or change sizes")
    if nozzle.size_classes > MOST_SIZES or (nozzle.sizes == "given" and nozzle.size_classes > 1):
        allowed = (
            "1, as each size given is one" if nozzle.sizes == "given" else f"{MOST_SIZES} at most: each is a particle"
        )
        raise CaseError(f"{where}.size_classes = {nozzle.size_classes}; it must be {allowed}")
    if nozzle.sizes == "log_normal" and nozzle.size_classes > 1 and not _std(case.of(nozzle.material), nozzle):
        alike = "the grains are all alike: give diameter_std_mm"
        raise CaseError(f"{where}.size_classes = {nozzle.size_classes}, but {alike}, or leave it out")
    {"rosin_rammler": _check_rosin_rammler, "given": _check_given}.get(nozzle.sizes, lambda *_: None)(where, nozzle)


def _key(name: str) -> str:
    return name if name in UNITS else f"{name}_mm"


def _check_rosin_rammler(where: str, nozzle) -> None:
    for key in ("size_parameter", "size_exponent", "least_diameter"):
        if getattr(nozzle, key) is None:
            raise CaseError(f"{where}.{_key(key)} is missing; sizes = 'rosin_rammler' needs it")
    largest = math.inf if nozzle.most_diameter is None else nozzle.most_diameter
    end = nozzle.size_parameter * size_classes.NOTHING ** (1.0 / nozzle.size_exponent)
    if not nozzle.least_diameter < min(largest, end):
        bound = f"{1e3 * min(largest, end):.4g} mm, the largest drop"
        given = f"{where}.least_diameter_mm = {1e3 * nozzle.least_diameter:g}"
        raise CaseError(f"{given}; it must be below {bound}: give a smaller one")


def _check_given(where: str, nozzle) -> None:
    sizes, shares = nozzle.diameters, nozzle.shares
    if not sizes or any(isinstance(d, tuple) or not d > 0.0 for d in sizes) or len(sizes) > MOST_SIZES:
        raise CaseError(f"{where}.diameters_mm = {list(sizes or ())}; give 1 to {MOST_SIZES} diameters above 0")
    if shares and (len(shares) != len(sizes) or any(isinstance(s, tuple) or not s > 0.0 for s in shares)):
        told = f"give a share of the mass above 0 for each of the {len(sizes)} diameters, or none: equal shares"
        raise CaseError(f"{where}.shares = {list(shares)}; {told}")
