"""Two fields in one picture: of a body its own, of what it holds another."""

import numpy as np
import pytest
from test_pictures import cloud, lattice, taken

from sdph.schema import CaseError
from sdph.show import canvas, shot, timeline, view
from sdph.show.look import Look, coloured


def filled():
    """A liquid of 16 particles at 1 kPa beside a body of 16 at 2 MPa, whose damage is 0.5."""
    liquid = cloud(lattice(4), pressure=np.full(16, 1e3))
    body = cloud(lattice(4) + np.array([0.4, 0.0]), pressure=np.full(16, 2e6), damage=np.full(16, 0.5))
    return taken(timeline.together([liquid, body]))


def test_a_body_has_the_second_field_and_the_rest_the_first():
    own, look = filled(), Look("pressure,damage")
    sheet = view.sheet(own, look)
    (first, second) = (axes.yaxis.label.get_text() or axes.xaxis.label.get_text() for axes in sheet.figure.axes[1:])
    assert first.startswith("pressure") and second == "damage"
    drawn = np.asarray(sheet.axes.images[0].get_array())
    scales = view._scales([own], look)
    assert scales["pressure"].high < 1.001 * scales["pressure"].shown(1e3) + 1.0  # the body's is not on its bar
    middle = drawn.shape[0] // 2
    for name, value, place in (("pressure", 1e3, 0.25), ("damage", 0.5, 0.75)):
        expected = coloured([value], scales[name], look.colours)[0]
        assert drawn[middle, int(place * drawn.shape[1])] == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize(("field", "told"), [
    ("pressure,damage,mass", "two fields at most"), ("damage,pressure", "all that has damage has pressure too"),
    ("pressure,harm", "--field harm: this run has"),
])  # fmt: skip
def test_other_fields_are_refused_in_one_line(field, told):
    with pytest.raises(CaseError, match=told):
        view.sheet(filled(), Look(field))


def test_in_space_one_field_is_shown():
    with pytest.raises(CaseError, match="two dimensions"):
        shot.all_chosen([taken(cloud(lattice(4, 3), pressure=np.ones(64), damage=np.ones(64)))], "pressure,damage")


def test_two_bars_have_their_room():
    """Below a picture that is wide, beside another."""
    own = filled()
    both, one = (view.sheet(own, Look(field)) for field in ("pressure,damage", "pressure"))
    assert both.size[1] == pytest.approx(one.size[1] + canvas.LOW, abs=2.0 / canvas.DPI)
    slender = [canvas.Sheet(1.0, 1.0, both.theme, bars=bars).size[0] for bars in (1, 2)]
    assert slender[1] == pytest.approx(slender[0] + canvas.RIGHT, abs=2.0 / canvas.DPI)
