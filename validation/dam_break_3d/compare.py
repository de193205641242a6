"""The front of the column in a channel against the measurements of the scene dam_break."""

from __future__ import annotations

from sdph.study.compare import scene_module


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return scene_module("dam_break").metrics(run)


def exact(run) -> list[dict]:
    return scene_module("dam_break").exact(run)
