"""Particles that come in or leave are counted by the process whose own they are."""

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.liquids import openings
from sdph.methods.liquids.method import LiquidStepper


def test_copies_of_others_do_not_count():
    own = LiquidStepper(cases.load(scenes.HERE / "channel_bore" / "case.toml"))
    rows, copies = own.active[:40], own.active[10:40]
    whole = openings._amounts(own, rows)
    own.state = own.state._replace(copy=np.isin(np.arange(len(own.state.x)), copies).astype(np.int8))
    found = openings._amounts(own, rows)
    np.testing.assert_allclose(found, openings._amounts(own, rows[:10]), rtol=1e-14)
    assert 0.0 < found[0] < whole[0]
