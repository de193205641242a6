"""The page of a run: served on this machine alone, it follows time, field and cut; without trame one line says so."""

import subprocess
import sys
import urllib.request
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista

from sdph import cli
from sdph.running.fields import Fields
from sdph.show import space, web, window
from sdph.show.look import Look

SERVE = "import sys; from pathlib import Path; from sdph.show import web; from sdph.show.look import Look; \
web.serve(Path(sys.argv[1]), None, Look(), open_browser=False)"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Fields of a liquid at two times."""
    made = tmp_path_factory.mktemp("run")
    (made / "fields").mkdir()
    cloud = pyvista.PolyData(np.random.default_rng(1).random((200, 3)))
    for name, values in (("mass", 1e-3), ("density", 1.0), ("kind", 2), ("ident", 1), ("pressure", cloud.points[:, 0])):
        cloud[name] = np.broadcast_to(values, 200)
    cloud["velocity"] = cloud.points.copy()
    fields = Fields(made)
    for time in (0.0, 1.0):
        fields.write(time, {"particles": cloud})
    return made


def test_without_trame_one_line_says_what_to_install(folder, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "trame.app", None)
    assert cli.main(["view", str(folder), "--web"]) == 2
    assert (
        capsys.readouterr().err.strip()
        == "sdph: --web needs the package trame, which is missing: pip install 'sdph[web]'"
    )


def test_a_file_is_not_asked_for_with_it(folder, capsys):
    assert cli.main(["view", str(folder), "--web", "--png", "a.png"]) == 2
    assert "--png a.png: --web serves a page" in capsys.readouterr().err


def test_time_field_and_cut_are_followed(folder):
    """The page's state is taken to the stage, as trame hands it over."""
    handlers, drawn = [], []
    state = SimpleNamespace(change=lambda *_: lambda function: handlers.append(function))
    server = SimpleNamespace(state=state, controller=SimpleNamespace(view_update=lambda: drawn.append(1)))
    stage = window.Stage(folder, None, Look())
    stage.set_up(space.plotter((60, 40), Look()))
    web._state(server, stage)
    assert (state.instant, state.field, state.share) == (1, "velocity", 1.0)
    state.instant, state.field, state.axis, state.share = 0, "pressure", 2, 0.5
    handlers[0]()
    assert (stage.shot.time, stage.field, stage.clip, state.told) == (0.0, "pressure", (2, 0.5), "0 s")
    state.share = 1.0
    handlers[0]()
    assert stage.clip is None and len(drawn) == 2
    stage.plotter.close()


def test_the_page_is_served(folder):
    pytest.importorskip("trame")
    with subprocess.Popen([sys.executable, "-c", SERVE, str(folder)], stdout=subprocess.PIPE, text=True) as process:
        try:
            address = next(line.split()[-1] for line in process.stdout if "http://" in line)
            assert address.startswith("http://127.0.0.1:")
            page = urllib.request.urlopen(address, timeout=30).read().decode()
        finally:
            process.kill()
    assert "<html" in page.lower()
