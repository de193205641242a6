"""The front of the column in a channel against the measurements of the scene dam_break; water against a box in its way
(`box.py`)."""

from __future__ import annotations

from sdph.study.compare import scene_module

from . import box

VARIANTS = {
    "dam_break_3d": ((), ["exact"]),
    "no slip": (("tank.slip='no_slip'",), ["exact"]),
    "against a box": (box.OVERRIDES, ["spheric"]),
}


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return scene_module("dam_break").metrics(run)


def exact(run) -> list[dict]:
    return scene_module("dam_break").exact(run)


def spheric(run) -> list[dict]:
    return box.checks(run)
