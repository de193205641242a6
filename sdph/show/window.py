"""`sdph view RUN`: a window on a run, with a slider of time; key f shows the next field, key r fits the view."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from sdph.schema import CaseError
from sdph.show import eye, shot, space, style, timeline
from sdph.show.look import Look

SIZE = (1200, 900)  # pixels
LABELS = 5  # along the bar
THOUSAND = 1e3  # from here on numbers of the bar are whole: three digits would take an exponent


def open_window(folder: Path, time: float | None, look: Look) -> None:
    """Show the window until it is closed; `CaseError` where there is no display."""
    stage = Stage(folder, time, look)
    if sys.platform == "linux" and not {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys():
        raise CaseError(
            "there is no display to open a window on; write a picture with --png FILE, or a movie with --movie FILE"
        )
    stage.set_up(space.plotter(SIZE, look, off_screen=False))
    if len(stage.times) > 1:
        first = stage.times.index(stage.shot.time)
        stage.plotter.add_slider_widget(
            lambda value: stage.show(number=round(value)), [0, len(stage.times) - 1], first, title="instant",
            color=look.colours.ink, style="modern", event_type="end", fmt="%.0f",
        )  # fmt: skip
    stage.plotter.add_key_event("f", stage.next_field)
    stage.plotter.show(title=f"sdph view {folder}")


class Stage:
    """A run on a plotter: which instant and which field are shown."""

    def __init__(self, folder: Path, time: float | None, look: Look):
        self.folder, self.look = folder, look
        self.shot = shot.of_folder(folder, time)
        self.times = timeline.read(folder).time_values
        self.field = shot.chosen([self.shot], look.field)
        self.fields = sorted(set(self.shot.named()) & style.QUANTITIES.keys())
        self.clip = None

    def set_up(self, plotter) -> None:
        """Put the first instant on a plotter and look at it."""
        self.plotter = plotter
        self.show()
        own, view = self.shot, eye.on(self.shot)
        towards, up = (np.eye(3)[own.across], np.eye(3)[own.axes[1]]) if own.axes else (view.towards, view.up)
        plotter.view_vector(towards, viewup=up)
        plotter.enable_parallel_projection()
        plotter.reset_camera(bounds=own.box)

    def show(self, number: int | None = None, field: str | None = None) -> None:
        """Show the instant `number` and the field; None: as they are."""
        if number is not None and self.times[number] != self.shot.time:
            self.shot = shot.of_folder(self.folder, self.times[number])
        self.field = field or self.field
        scale = style.scale(self.field, self.shot.values(self.field))
        self.plotter.clear_actors()
        space.fill(self.plotter, _clipped(self.shot, self.clip), self.look, scale, self.field, None)
        self._bar(scale)
        said = f"t = {style.digits(self.shot.time)} s"
        self.plotter.add_text(said, position="upper_left", font_size=11, color=self.look.colours.ink, name="time")
        self.plotter.render()

    def next_field(self) -> None:
        self.show(field=self.fields[(self.fields.index(self.field) + 1) % len(self.fields)])

    def _bar(self, scale: style.Scale) -> None:
        import pyvista

        mapper = pyvista.DataSetMapper()
        mapper.lookup_table = pyvista.LookupTable(style.map_of(scale.map), scalar_range=(scale.low, scale.high))
        for name in list(self.plotter.scalar_bars.keys()):
            self.plotter.remove_scalar_bar(name)
        form = "%.0f" if scale.high >= THOUSAND else "%.3g"
        self.plotter.add_scalar_bar(
            scale.title, mapper=mapper, vertical=True, position_x=0.88, position_y=0.2, height=0.6, width=0.06,
            n_labels=LABELS, fmt=form, color=self.look.colours.ink, title_font_size=16, label_font_size=14,
        )  # fmt: skip


def _clipped(own: shot.Shot, clip: tuple[int, float] | None) -> shot.Shot:
    """A shot without what lies beyond `clip`, (axis, share of the box along it)."""
    if clip is None or not own.particles.n_points:
        return own
    axis, share = clip
    place = own.box[2 * axis] + share * (own.box[2 * axis + 1] - own.box[2 * axis])
    inside = np.flatnonzero(np.asarray(own.particles.points)[:, axis] <= place)
    return replace(own, particles=own.particles.extract_points(inside, include_cells=False))
