"""Films of runs that end with nothing in them."""

import json
import re
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista
from imageio import v3 as imageio
from test_pictures import cloud, lattice

from sdph.running.fields import Fields
from sdph.schema import CaseError
from sdph.show import frames, shot, view


@pytest.mark.parametrize("field", [None, "pressure"])
def test_a_film_goes_on_where_nothing_is_left(field, tmp_path):
    """Frames with nothing in them, last of all, are frames; a picture of that alone refuses a field in words."""
    fields = Fields(tmp_path)
    (tmp_path / "fields").mkdir()
    for time, there in enumerate((True, False)):
        own = cloud(lattice(4), ident=np.arange(16), pressure=np.linspace(0.0, 5.0, 16), velocity=np.ones((16, 3)))
        fields.write(float(time), {"particles": own if there else pyvista.PolyData()})
    shots = shot.all_of_folder(tmp_path)
    assert shot.chosen(shots, None) == shot.chosen(shots[:1], None) == "velocity"  # the subject of what was there
    view.movie(tmp_path, tmp_path / "a.gif", field)
    assert len(imageio.imread(tmp_path / "a.gif", index=None)) == 2
    with pytest.raises(CaseError, match="--field pressure: nothing is there to show then; leave it out"):
        view.show(tmp_path, tmp_path / "a.png", field="pressure")


def test_a_film_tells_how_far_it_is_and_is_there_when_it_is_whole(tmp_path, monkeypatch):
    (tmp_path / "fields").mkdir()
    fields, heard = Fields(tmp_path), []
    for time in range(3):
        own = cloud(lattice(4), ident=np.arange(16), velocity=np.full((16, 3), 1.0 + time))
        fields.write(float(time), {"particles": own})
    monkeypatch.setattr(view, "TELL_DRAWN", 0.0)
    view.movie(tmp_path, tmp_path / "a.gif", tell=heard.append)
    assert [re.sub(r"\d+ s left", "", line) for line in heard] == [f"picture {n} of 3, " for n in (1, 2)]

    drawn, sheet = [], view.sheet

    def fails(*given, **more):
        drawn.append(sheet(*given, **more))
        if len(drawn) == 3:
            assert not (tmp_path / "b.gif").exists()
            raise OSError("the disk is full")
        return drawn[-1]

    monkeypatch.setattr(view, "sheet", fails)
    with pytest.raises(CaseError, match="b.gif cannot be written: the disk is full"):
        view.movie(tmp_path, tmp_path / "b.gif")
    assert sorted(path.name for path in tmp_path.glob("*.gif")) == ["a.gif"] and not list(tmp_path.glob(".*"))


def test_the_window_of_the_viewer_holds_all_instants(tmp_path):
    """Also those at which all was elsewhere than in the end: it goes ten widths to the right."""
    (tmp_path / "fields").mkdir()
    fields = Fields(tmp_path)
    for time in (0.0, 1.0):
        own = cloud(lattice(4) + np.array([40.0 * time, 0.0]), ident=np.arange(16), velocity=np.ones((16, 3)))
        fields.write(time, {"particles": own})
    boxes = [own.box.reshape(3, 2) for own in shot.all_of_folder(tmp_path)]
    page = frames.viewer(tmp_path, SimpleNamespace(resolution=SimpleNamespace(cell=1.0, spacing=1.0)))
    told = json.loads(re.search(r'\{"dimensions".*\}', page)[0].replace("<\\/", "</"))
    assert told["lower"][0] == pytest.approx(min(box[0, 0] for box in boxes))
    assert told["upper"][0] == pytest.approx(max(box[0, 1] for box in boxes))
