"""Grains that leave where no outflow is: the line that a run ends with names the way, and what to do."""

from types import SimpleNamespace

import numpy as np
import pytest

from sdph.case.boundary import Boundary
from sdph.effects.around import outflow
from sdph.schema import CaseError


def told(monkeypatch, number, source):
    """The line for `number` grains that left through the top of a mesh whose outlet is `lid`."""
    monkeypatch.setattr(outflow, "through", lambda case, state: np.full(number, outflow.exits(case).index("top_side")))
    case = SimpleNamespace(
        boundaries={"lid": Boundary(kind="pressure_outlet")},
        parameters={"walls": SimpleNamespace(mesh="case", source=source)},
        effects=("walls",),
        dimensions=2,
        domain=SimpleNamespace(size=(0.2, 0.6)),
    )
    state = SimpleNamespace(ident=np.arange(1, number + 1), x=np.zeros(number), y=np.ones(number), z=np.zeros(0))
    monkeypatch.setattr(outflow.particles, "axes", lambda state: (state.x, state.y))
    with pytest.raises(CaseError) as caught:
        outflow.refuse_to_leave(case, state, np.ones(number, bool), 0.1)
    return str(caught.value)


def test_the_patch_and_the_cure_are_named(monkeypatch):
    own, box = told(monkeypatch, 1, "gas"), told(monkeypatch, 2, "file")
    assert "1 particle has left" in own and "2 particles have left" in box
    assert "through top_side (lid); begin anew and add outflow" in own
    assert "domain.size_m" in box and "domain.size_m" not in own
