"""The sheet that a picture stands on: title and time, axes with round numbers, a bar with three digits beside it."""

from __future__ import annotations

import textwrap

import numpy as np

from sdph.show import style
from sdph.show.style import Scale, Theme

LONGEST, LEAST = 7.0, 0.35  # inches of the longer side of what is shown, and of the shorter one at least
NARROWEST = 4.2  # inches of the whole sheet: a slender column has a title all the same
LEFT, RIGHT, BELOW, ABOVE = 0.75, 1.25, 0.6, 0.62  # inches around it; RIGHT with one bar
LOW = 0.75  # inches of a bar below it
LETTER = 0.078  # inches that a letter of the title takes
DPI = 150
WIDE = 1.7  # width over height from which the bar lies below; our choice
TICKS = [1.0, 2.0, 2.5, 5.0, 10.0]  # round steps


class Sheet:
    """A figure with room for a picture `wide` by `high` [m, or pixels: only the ratio counts]."""

    def __init__(self, wide: float, high: float, theme: Theme, bars: int = 1):
        from matplotlib import figure
        from matplotlib.backends import backend_agg

        self.theme, self.flat = theme, wide > WIDE * high
        scale = LONGEST / max(wide, high)
        own = np.maximum([wide * scale, high * scale], LEAST)
        right = RIGHT * bars if bars and not self.flat else 0.3
        below = BELOW + (LOW * bars if self.flat else 0.0)
        size = np.array([max(NARROWEST, LEFT + own[0] + right), below + own[1] + ABOVE])
        size = np.round(size * DPI / 2.0) * 2.0 / DPI  # even numbers of pixels: movies want them
        self.size, self.own, self.corner = size, own, np.array([LEFT, below])
        self.figure = figure.Figure(figsize=tuple(size), dpi=DPI, facecolor=theme.paper)
        backend_agg.FigureCanvasAgg(self.figure)
        self.axes = self.figure.add_axes([*(self.corner / size), *(own / size)], facecolor=theme.paper)
        for side in self.axes.spines.values():
            side.set_color(theme.faint)
            side.set_linewidth(0.8)
        self.axes.tick_params(colors=theme.ink, labelsize=9, color=theme.faint)

    def head(self, title: str, time: float, last: float) -> None:
        """Title on the left, time on the right, over the picture; `last` [s] chooses the unit of time."""
        factor, unit = style.prefixed("s", abs(last))
        right = self.corner[0] + self.own[0] if self.size[0] > NARROWEST else self.size[0] - 0.2
        top = self.size[1] - 0.2
        said = f"t = {style.digits(time / factor)} {unit}"
        room = int((right - self.corner[0]) / LETTER) - len(said) - 3
        if title and room > 10:
            lines = textwrap.wrap(title, room, max_lines=2, placeholder=" …")
            self._text(self.corner[0], top, "\n".join(lines), self.theme.ink, ha="left")
        self._text(right, top, said, self.theme.faint, ha="right")

    def _text(self, x: float, y: float, text: str, colour: str, **more) -> None:
        self.figure.text(x / self.size[0], y / self.size[1], text, color=colour, va="top", fontsize=10, **more)

    def rule(self, low, high, names: tuple[str, str]) -> None:
        """Axes from `low` to `high` (2,) [m] with round numbers."""
        from matplotlib import ticker

        factor, unit = style.prefixed("m", float(np.max(np.abs([low, high]))))
        for axis, name, length in zip((self.axes.xaxis, self.axes.yaxis), names, self.own):
            axis.set_major_locator(_round_ticks(factor, max(1, round(length / 1.1))))
            axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: style.digits(value / factor)))
            axis.set_label_text(f"{name} [{unit}]", color=self.theme.ink, fontsize=10)
        self.axes.set_xlim(low[0], high[0])
        self.axes.set_ylim(low[1], high[1])

    def bar(self, scale: Scale, words: tuple[str, ...] = (), number: int = 0) -> None:
        """Bar of a scale: beside the picture, or below one that is wide, after `number` others; of numbers that stand
        for `words`, from 0 on, a field of its own each."""
        from matplotlib import cm, colors, ticker

        if self.flat:
            place = np.array([self.corner[0] + 0.15 * self.own[0], 0.42 + LOW * number, 0.7 * self.own[0], 0.14])
        else:
            right = self.corner[0] + self.own[0] + 0.18 + RIGHT * number
            place = np.array([right, self.corner[1], 0.17, self.own[1]])
        inset = self.figure.add_axes(place / np.tile(self.size, 2))
        shades, norm = style.map_of(scale.map), colors.Normalize(scale.low, scale.high)
        if words:
            shades = colors.ListedColormap([shades(norm(n)) for n in range(len(words))])
            norm = colors.Normalize(-0.5, len(words) - 0.5)
        mapped = cm.ScalarMappable(norm, shades)
        drawn = self.figure.colorbar(
            mapped, cax=inset, orientation="horizontal" if self.flat else "vertical", extend=scale.extend,
            extendfrac=0.03, ticks=ticker.MaxNLocator(6, steps=TICKS),
            format=ticker.FuncFormatter(style.digits),
        )  # fmt: skip
        if words:
            drawn.set_ticks(range(len(words)), labels=words)
            drawn.ax.tick_params(length=0.0)
        drawn.outline.set_edgecolor(self.theme.faint)
        drawn.ax.tick_params(colors=self.theme.ink, labelsize=9)
        drawn.set_label(scale.title, color=self.theme.ink, fontsize=10)

    def image(self) -> np.ndarray:
        """Pixels (rows, columns, 3)."""
        self.figure.canvas.draw()
        return np.asarray(self.figure.canvas.buffer_rgba())[..., :3].copy()


def _round_ticks(factor: float, count: int):
    """Locator of at most `count` steps that are round in units of `factor` [m]."""
    from matplotlib import ticker

    class Locator(ticker.MaxNLocator):
        def tick_values(self, low, high):
            ends = (float(f"{end / factor:.6g}") for end in (low, high))  # files hold them in single precision
            return super().tick_values(*ends) * factor

    return Locator(nbins=count, steps=TICKS)
