"""Checks of periodic axes: long enough for the neighbours, and no particle on its own image."""

from __future__ import annotations

from sdph.case.sections import Case
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError


def of_domain(case: Case) -> None:
    """Periodic axes are axes of the case, begin at 0, and are two reaches of the kernel long."""
    axes, least = "xyz"[: case.dimensions], 4.0 * case.smoothing_length  # two reaches, or an image would be missed
    of_liquid = case.liquid.periodic if case.liquid else ()
    around = set(case.domain.periodic) | {axis for axis, on in zip(axes, of_liquid) if on}
    for axis, low in zip(axes, case.domain.corner):
        if low and axis in around:
            raise CaseError(f"domain.lower_m = {list(case.domain.lower)}; along {axis}, which is periodic, give 0")
    for axis in case.domain.periodic:
        if axis not in axes:
            raise CaseError(f"domain.periodic holds {axis!r}; allowed: {', '.join(axes)}")
        if case.domain.period[axes.index(axis)] < least:
            raise CaseError(
                f"domain.size_m is below {least:g} m along {axis}, which is periodic; lengthen it or take finer grains"
            )
    if case.liquid:
        _of_liquid(case)


def _of_liquid(case: Case) -> None:
    reach = case.method.sees(case) * case.resolution.spacing if case.incompressible else 2.0 * case.smoothing_length
    least = 2.05 * reach  # two reaches of the neighbour rows
    given = case.liquid.periodic
    if given and (len(given) != case.dimensions or any(on not in (0.0, 1.0) for on in given)):
        raise CaseError(
            f"liquid.periodic = {list(given)}; it must be {case.dimensions} numbers, 1 along periodic axes and 0 "
            "along the others"
        )
    for axis, length, on in zip("xyz", case.domain.size, given):
        if on and length < least:
            raise CaseError(
                f"domain.size_m is below {least:g} m along {axis}, which is periodic; lengthen it or take a finer "
                "spacing"
            )


def of_pool(case: Case, where: str, pool) -> None:
    """A pool lies within the domain along periodic axes: beyond it particles would lie on their own images."""
    box, slack = pool.shape == "box", ROUND_OFF * max(case.domain.size)
    lower = pool.lower if box else [c - pool.radius for c in pool.centre]
    upper = pool.upper if box else [c + pool.radius for c in pool.centre]
    for axis, low, high, length, on in zip("xyz", lower, upper, case.domain.size, case.liquid.periodic or ()):
        if on and (low < -slack or high > length + slack):
            raise CaseError(
                f"{where} reaches from {low:g} to {high:g} m along {axis}, which is periodic; keep it within 0 and "
                f"{length:g} m, or its particles lie on each other"
            )
