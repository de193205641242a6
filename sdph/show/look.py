"""The choices of who looks, and colours by a scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sdph.show import style
from sdph.show.style import Scale, Theme


@dataclass(frozen=True)
class Look:
    """Field (None: what the scene is about), theme, particles as a continuous field, outline of bubbles, arrows of
    velocity."""

    field: str | None = None
    theme: str = "light"
    smooth: bool = False
    outline: bool = False
    vectors: bool = False

    @property
    def colours(self) -> Theme:
        return style.THEMES[self.theme]


def rgb(colour: str) -> np.ndarray:
    """(3,) of a colour, 0 to 1."""
    from matplotlib import colors

    return np.array(colors.to_rgb(colour))


def coloured(values, scale: Scale, theme: Theme) -> np.ndarray:
    """(..., 3) colours, 0 to 1, of values; those that are none have the theme's `void`."""
    values = np.asarray(values, float)
    share = (scale.shown(np.where(np.isfinite(values), values, scale.origin)) - scale.low) / (scale.high - scale.low)
    found = style.map_of(scale.map)(np.clip(share, 0.0, 1.0))[..., :3]
    return np.where(np.isfinite(values)[..., None], found, rgb(theme.void))
