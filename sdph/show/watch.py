"""`sdph run --watch`: a page in the run folder that shows the run while it goes on."""

from __future__ import annotations

import html
import os
import time
from pathlib import Path

from sdph.running import output

NAME, PICTURE = "watch.html", "watch.png"
SHARE = 0.05  # of the run's time that drawing may take; our choice
SHOWN = ("temperature", "pressure", "velocity")  # the first of these that the particles have colours them
PAGE = """<!doctype html>
<meta charset="utf-8"><meta http-equiv="refresh" content="2"><title>{title}</title>
<h3>{title}</h3><p>{line}</p><img src="{picture}?{stamp}" alt="the run now">
"""


class Page:
    """Draws a run's state into its folder, each file whole or not there, so often that it takes `SHARE` of the time."""

    def __init__(self, folder: Path):
        self.folder, self.due = folder, 0.0

    def show(self, simulation, line: str) -> None:
        """The state of now and `line`, if it is time; always at the end."""
        begun = time.perf_counter()
        if begun < self.due and simulation.time < simulation.case.run.end_time:
            return
        draft = self.folder / f".{PICTURE}"
        _draw(simulation, draft)
        os.replace(draft, self.folder / PICTURE)
        text = PAGE.format(
            title=html.escape(simulation.case.title), line=html.escape(line), picture=PICTURE, stamp=simulation.windows
        )
        output.write_text(self.folder / NAME, text)
        now = time.perf_counter()
        self.due = now + (now - begun) / SHARE


def _draw(simulation, file: Path) -> None:
    from sdph.show import view

    meshes = simulation.meshes()
    particles = meshes["particles"]
    field = next((name for name in SHOWN if name in particles.point_data), SHOWN[0])
    walls, up = simulation.walls(), view.upwards(simulation.case.domain.gravity)
    plotter = view.scene(
        particles, meshes.get("gas"), field, f"t = {simulation.time:g} s", off_screen=True, walls=walls, up=up
    )
    image = plotter.screenshot(return_img=True)
    plotter.close()
    import imageio.v3 as imageio

    imageio.imwrite(file, image, extension=".png")
