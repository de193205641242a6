"""`sdph run --watch`: a page in the run folder that shows the run while it goes on."""

from __future__ import annotations

import html
import os
import time
from pathlib import Path

from sdph.running import output

NAME, PICTURE = "watch.html", "watch.png"
SHARE = 0.05  # of the run's time that drawing may take; our choice
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
        if begun < self.due and not simulation.clock.over(simulation.time):
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
    from sdph.show import shot, timeline, view
    from sdph.show.look import Look

    meshes = simulation.meshes()
    clouds = [cloud for name, cloud in meshes.items() if name != "gas"]
    instant = timeline.Instant(simulation.time, timeline.together(clouds), meshes.get("gas"))
    taken = shot.of_state(instant, simulation.case, simulation.walls())
    drawn = view.sheet(taken, Look(), last=simulation.case.run.end_time, fine=1)
    drawn.figure.savefig(file, format="png", facecolor=drawn.theme.paper)
