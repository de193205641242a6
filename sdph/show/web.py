"""`sdph view RUN --web`: a page on this machine with the run in it: time, field and a cut, drawn here and sent there.

By trame (Kitware). It listens on this machine alone; nothing of it is a part of the run.
"""

from __future__ import annotations

from pathlib import Path

from sdph.schema import CaseError
from sdph.show import space, style
from sdph.show.look import Look
from sdph.show.window import SIZE, Stage

HOST = "127.0.0.1"
AXES = [{"title": name, "value": number} for number, name in enumerate("xyz")]


def serve(folder: Path, time: float | None, look: Look, port: int = 0, open_browser: bool = True) -> None:
    """Serve the page until it is stopped by ctrl-c; port 0: one that is free."""
    trame = _trame()
    stage = Stage(folder, time, look)
    stage.set_up(space.plotter(SIZE, look))
    server = trame.get_server(client_type="vue3")
    _state(server, stage)
    _page(server, stage, folder.name or "run")
    server.start(port=port, host=HOST, open_browser=open_browser, show_connection_info=True)


def _trame():
    """The package trame; `CaseError` where it is missing."""
    try:
        import trame.app
        import trame.widgets.vtk
        import trame.widgets.vuetify3
    except ImportError:
        raise CaseError("--web needs the package trame, which is missing: pip install 'sdph[web]'") from None
    return trame.app


def _state(server, stage: Stage) -> None:
    """Values that the page changes, and what each change does."""
    state, control = server.state, server.controller
    state.instant, state.field = stage.times.index(stage.shot.time), stage.field
    state.axis, state.share = 0, 1.0
    state.told = f"{style.digits(stage.shot.time)} s"

    @state.change("instant", "field", "axis", "share")
    def show(**_):
        stage.clip = (int(state.axis), float(state.share)) if state.share < 1.0 else None
        stage.show(number=int(state.instant), field=state.field)
        state.told = f"{style.digits(stage.shot.time)} s"
        control.view_update()


def _page(server, stage: Stage, title: str) -> None:
    from trame.ui.vuetify3 import SinglePageLayout
    from trame.widgets import vtk as widgets
    from trame.widgets import vuetify3 as v

    fields = [{"title": style.QUANTITIES[name].label, "value": name} for name in stage.fields]
    with SinglePageLayout(server) as layout:
        layout.title.set_text(title)
        with layout.toolbar:
            tight = {"hide_details": True, "density": "compact"}
            v.VSpacer()
            slider = {"min": 0, "max": len(stage.times) - 1, "step": 1, "style": "max-width: 260px"}
            v.VSlider(v_model=("instant",), label="time", **slider, **tight)
            layout.toolbar.add_child("{{ told }}")
            v.VSelect(v_model=("field",), items=("fields", fields), style="max-width: 220px", classes="mx-3", **tight)
            v.VSelect(v_model=("axis",), items=("axes", AXES), label="cut", style="max-width: 90px", **tight)
            v.VSlider(v_model=("share",), min=0, max=1, step=0.01, style="max-width: 160px", **tight)
        with layout.content, v.VContainer(fluid=True, classes="pa-0 fill-height"):
            view = widgets.VtkRemoteView(stage.plotter.render_window, interactive_ratio=1)
            server.controller.view_update = view.update
