"""Every name that a case can choose computes the law of that name: a chain of laws without a branch for one takes the
last."""

import pytest

from coupling.openfoam.foreign import properties
from sdph.effects.gas import drag, heat, lift
from sdph.laws import drag as drag_laws
from sdph.laws import heat as heat_laws
from sdph.laws import lift as lift_laws


@pytest.mark.parametrize("name", drag.LAWS)
def test_drag(name):
    p = drag.DragP(drag.LAWS.index(name), 1.8e-5, 2500.0)
    assert drag.coefficient(p, 0.3, 0.7, 4e-4, 1.2) == getattr(drag_laws, name)(0.3, 0.7, 4e-4, 1.2, 1.8e-5)


@pytest.mark.parametrize("name", heat.LAWS)
def test_heat(name):
    p = heat.HeatP(heat.LAWS.index(name), 0, 0.025, 1.8e-5, 0.7, 2500.0)
    assert heat.nusselt(p, 0.7, 20.0) == getattr(heat_laws, name)(0.7, 20.0, 0.7)


@pytest.mark.parametrize("name", lift.LAWS)
def test_lift(name):
    p = lift.LiftP(lift.LAWS.index(name), 1.8e-5, 2500.0)
    assert lift.coefficient(p, 0.3, 200.0, 4e-4, 1.2) == getattr(lift_laws, name)(0.3, 200.0, 4e-4, 1.2, 1.8e-5)


def test_laws_of_openfoam_are_those_of_a_case():
    assert set(properties.DRAG.values()) < set(drag.LAWS) and properties.DRAG["Beetstra"] == "beetstra"
