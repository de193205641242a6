"""Every effect that is on is asked for its limit before every sub-step, obeyed and named; `explain` tells the same."""

from dataclasses import replace

import numpy as np
import pytest

from sdph import effects, scenes
from sdph.case import read as cases
from sdph.methods.grains.grains import Grains
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.mps.method import MpsStepper
from sdph.methods.solids.method import SolidStepper
from sdph.study.explain import tables

COARSE = {
    "disc_cluster": ("resolution.spacing_mm=20", "resolution.cell_mm=50"),
    "bubbling_bed": ("resolution.spacing_mm=20", "resolution.cell_mm=50"),
    "evaporating_jet": ("resolution.spacing_mm=50", "resolution.cell_mm=100"),
    "bubble_rise": ("resolution.spacing_mm=100",),
    "sloshing_sphere": ("resolution.spacing_mm=100",),
    "taylor_green": ("resolution.spacing_mm=100",),
    "thick_ring": (),
    "swirl_sheet": ("pools.drop={shape='sphere',centre_m=[0.01,0.01,0.01],radius_m=4e-4}",),
    "taylor_bar": ("resolution.spacing_mm=1.6",),
}
STEPPERS = {"liquid": LiquidStepper, "mps": MpsStepper, "solid": SolidStepper}
TINY = 1e-9  # s, far below all other limits


def load(scene):
    return cases.load(scenes.HERE / scene / "case.toml", COARSE[scene])


PAIRS = [(scene, name) for scene in COARSE for name in load(scene).effects]


def explained(case) -> dict[str, float]:
    return {row["cause"]: row["largest [s]"] for row in tables.explain(case)["limits"] if row.get("of") != "window"}


def grains(case):
    """Grains of a case, and what its nozzles let in within a window."""
    own = Grains(case)
    own.start()
    return own.stepper


def advance(case, stepper, dt):
    """Grains that fall through a window in which the gas does nothing."""
    count = len(stepper.state.x)
    stepper.force(np.zeros(count), np.full((count, 3), -9.81), np.zeros(count))
    (stepper.move if effects.moving(case) else stepper.conduct)(dt)


def shorten(monkeypatch, name, limit):
    monkeypatch.setitem(effects.REGISTRY, name, replace(effects.REGISTRY[name], dt_limit=limit))


def test_every_effect_is_among_those_asked():
    known = {name for _, name in PAIRS}
    assert effects.REGISTRY.keys() - known <= {
        "grain_shifting",
        "bubble",
        "liquid_heat",
        "time_scaling",
        "xsph",
        "artificial_viscosity",
        "lift",
        "electric_field",
        "micro_explosion",
        "radiation",
        "break_up",
        "shear_thinning",
    }


@pytest.mark.parametrize(("scene", "name"), PAIRS)
def test_a_limit_is_obeyed_and_named(monkeypatch, scene, name):
    case = load(scene)
    shorten(monkeypatch, name, lambda p, case, state: TINY)
    assert explained(case)[name] == TINY == min(explained(case).values())
    if case.liquid or case.solid:
        stepper = STEPPERS[case.moved_by(case.matters[0])](case)
        taken = stepper.next_step(5.5 * TINY)
    else:
        stepper = grains(case)
        advance(case, stepper, 5.5 * TINY)
        taken = 5.5 * TINY / stepper.steps
    assert stepper.limit == name and taken == pytest.approx(5.5 * TINY / 6)


@pytest.mark.parametrize(
    ("scene", "name"), [("bubbling_bed", "granular_viscosity"), ("taylor_green", "laminar_viscosity")]
)
def test_a_limit_is_that_of_the_state_as_it_is(monkeypatch, scene, name):
    case, seen = load(scene), []

    def limit(p, case, state):
        seen.append(float((state.v**2).sum()))
        return 1e-4

    shorten(monkeypatch, name, limit)
    if case.liquid:
        stepper = LiquidStepper(case)
        for _ in range(3):
            stepper.step(1e-3)
        assert len(set(seen)) == 3
    else:
        advance(case, grains(case), 3e-4)
        assert len(set(seen)) == 3
