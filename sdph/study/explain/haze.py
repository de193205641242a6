"""Grains that hide each other from the surroundings that they radiate to."""

from __future__ import annotations

from sdph.effects.gas.radiation import HIDDEN, THICK
from sdph.laws.radiation import extinction


def depth(s) -> float:
    """Optical depth [-] across the narrowest side of the grains, or of the domain where that is narrower, at the start
    or of what is fed: the largest of all, of scales `s`."""
    own, narrow = s.grains.sauter_diameter, min(s.case.domain.size)
    widths = [min(narrow, *(b - a for a, b in zip(patch.lower, patch.upper))) for patch in s.patches]
    found = (extinction(patch.alpha_p, patch.diameter or own) * width for patch, width in zip(s.patches, widths))
    return max(found, default=0.0)


def warnings(case, s) -> list[str]:
    """Note where radiation is on and grains are no haze that it goes through; `s` are the scales of the case."""
    found = depth(s) if "radiation" in case.effects else 0.0
    if found <= THICK:
        return []
    return [f"the optical depth 1.5 alpha_p/d x width of the grains is {found:.2g}: {HIDDEN}"]
