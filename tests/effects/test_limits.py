"""Every effect that is on is asked for its limit before every sub-step, obeyed and named; `explain` tells the same."""

import math
from dataclasses import replace

import numpy as np
import pytest
from builders import simulation
from char_boxes import char
from grain_boxes import Row
from test_break_up_effect import drops
from test_micro_explosion_effect import bursting_case
from test_radiation_effect import radiating

from coupling.embedded import EmbeddedGas
from sdph import effects, scenes
from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.grains.grains import Grains
from sdph.methods.grains.method import limits
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.mps.method import MpsStepper
from sdph.methods.solids.method import SolidStepper
from sdph.running.together import Together
from sdph.study.explain import tables

COARSE = {
    "disc_cluster": ("resolution.spacing_mm=20", "resolution.cell_mm=50"),
    "bubbling_bed": ("resolution.spacing_mm=20", "resolution.cell_mm=50"),
    "evaporating_jet": ("resolution.spacing_mm=50", "resolution.cell_mm=100"),
    "segregation": ("resolution.spacing_mm=15", "resolution.cell_mm=30"),
    "bubble_rise": ("resolution.spacing_mm=100",),
    "sloshing_sphere": ("resolution.spacing_mm=100",),
    "taylor_green": ("resolution.spacing_mm=100",),
    "thick_ring": (),
    "swirl_sheet": ("pools.drop={shape='sphere',centre_m=[0.01,0.01,0.01],radius_m=4e-4}",),
    "taylor_bar": ("resolution.spacing_mm=1.6",),
    "gel_droplet": ("resolution.spacing_mm=0.025",),
    "gel_spray": (),
    "burning_char": (),
}
# effect of no such scene -> one that can have it, what stands there in its place, and its keys
WITH = {
    "grain_shifting": ("bubbling_bed", "", ()),
    "lift": ("bubbling_bed", "", ("lift.law='saffman_mei'",)),
    "turbulent_dispersion": (
        "evaporating_jet", "",
        ("gas.turbulence.model='kEpsilon'", "gas.turbulence.k_m2_s2=1", "gas.turbulence.mixing_length_m=0.01"),
    ),
    "electric_field": (
        "bubbling_bed", "", ("electric_field.strength_V_m=[0.0,1e4]", "electric_field.surface_charge_C_m2=1e-6"),
    ),
    "wall_heat": (
        "bubbling_bed", "", ("boundaries.walls.temperature_K=400",),
    ),
    "radiation": (
        "bubbling_bed", "", ("radiation.emissivity=0.8", "radiation.surroundings_temperature_K=300"),
    ),
    "break_up": (
        "evaporating_jet", "",
        ("break_up.liquid_viscosity_Pa_s=1e-3", "break_up.products='equal'", "grains.surface_tension_N_m=0.02"),
    ),
    "perforation": ("swirl_sheet", "", ("perforation.thickness_um=100",)),
    "suction": ("swirl_sheet", "", ("suction.gas_density_kg_m3=1.2",)),
    "xsph": ("taylor_green", "", ()),
    "shear_thinning": (
        "taylor_green", "laminar_viscosity",
        ("shear_thinning.model='power_law'", "shear_thinning.index=0.5", "shear_thinning.least_viscosity_Pa_s=1e-3",
         "shear_thinning.most_viscosity_Pa_s=1.0"),
    ),
}  # fmt: skip
# effect that limits windows -> a case with it, and its gas
WINDOWS = {
    "radiation": (lambda: radiating(300.0, windows=1), EmbeddedGas),
    "micro_explosion": (bursting_case, EmbeddedGas),
    "break_up": (drops, Row),
    "reaction": (lambda: char(("reaction", "heat")), EmbeddedGas),
}
STEPPERS = {"liquid": LiquidStepper, "mps": MpsStepper, "solid": SolidStepper}
TINY = 1e-9  # s, far below all other limits


def load(scene, name=""):
    """A coarse scene, with an effect of WITH."""
    file, sets = scenes.HERE / scene / "case.toml", COARSE[scene]
    if name not in WITH:
        return cases.load(file, sets)
    _, instead, keys = WITH[name]
    on = [*(own for own in cases.parsed(file)["effects"] if own != instead), name]
    return cases.load(file, (*sets, f"effects={on}", *keys))


PAIRS = [(scene, name) for scene in COARSE for name in load(scene).effects]
PAIRS += [(scene, name) for name, (scene, *_) in WITH.items()]


def told(case, windows=False) -> dict[str, float]:
    """Limits [s] by cause as `explain` tells them: of sub-steps, of all matters, or of windows."""
    rows = [row for part, own in tables.explain(case).items() if part.startswith("limits") for row in own]
    return {row["cause"]: row["largest [s]"] for row in rows if (row.get("of") == "window") == windows}


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


def stepper_of(case, folder):
    """The stepper of a liquid or of solids; that of solids in a liquid is the liquid's."""
    if case.liquid and case.solid:
        return Together(case, folder / "ledger.csv").stepper
    return STEPPERS[case.moved_by(case.matters[0])](case)


def test_every_effect_is_among_those_asked():
    assert effects.REGISTRY.keys() == {name for _, name in PAIRS}
    assert {name for name, row in effects.REGISTRY.items() if row.window_limit} == WINDOWS.keys()


def test_processes_tell_of_the_same_limits():
    """One without a particle left has no field to bear, and tells of it all the same: they are reduced in order."""
    case = load("bubbling_bed", "electric_field")
    own = Grains(case)
    own.start()
    with_all, none = own.stepper.own, particles.take(own.stepper.own, np.zeros(len(own.stepper.own.x), bool))
    found = [limits(case, own.parameters, s, pace, {}) for s, pace in ((with_all, 1.0), (none, 0.0))]
    assert [*found[0]] == [*found[1]] and found[1]["electric_field"] == found[1]["sound"] == math.inf
    assert [*effects.finite(found[0])] != [*effects.finite(found[1])]


@pytest.mark.parametrize(("scene", "name"), PAIRS)
def test_a_limit_is_obeyed_and_named(monkeypatch, tmp_path, scene, name):
    case = load(scene, name)
    shorten(monkeypatch, name, lambda p, case, state: TINY)
    assert told(case)[name] == TINY == min(told(case).values())
    if case.liquid or case.solid:
        stepper = stepper_of(case, tmp_path)
        taken = stepper.next_step(5.5 * TINY)
    else:
        stepper = grains(case)
        advance(case, stepper, 5.5 * TINY)
        taken = 5.5 * TINY / stepper.steps
    assert stepper.limit == name and taken == pytest.approx(5.5 * TINY / 6)


@pytest.mark.parametrize("name", WINDOWS)
def test_a_limit_of_windows_is_obeyed_and_named(monkeypatch, tmp_path, name):
    """It is asked at the start and after every window, each time anew."""
    make, gas = WINDOWS[name]
    case = make()
    short = 1e-3 * case.run.end_time
    allowed = [short]
    row = replace(effects.REGISTRY[name], window_limit=lambda p, case, state: allowed[0])
    monkeypatch.setitem(effects.REGISTRY, name, row)
    assert told(case, True)[name] == short == min(told(case, True).values())
    run = simulation(case, tmp_path, gas=lambda case, cells: gas(case))
    for part in (1.0, 0.5, 0.25):
        allowed[0], begun = 0.5 * part * short, run.time
        run.window()
        assert run.clock.limit == name and run.time - begun == pytest.approx(part * short, rel=0.01)
    run.gas.close()


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


def test_grains_at_rest_ask_before_every_step(monkeypatch):
    """A third of the window, then what is left in parts of a sixth."""
    case, asked = load("disc_cluster"), []

    def limit(p, case, state):
        asked.append(None)
        return 1e-4 if len(asked) == 1 else 5e-5

    shorten(monkeypatch, "conduction", limit)
    stepper = grains(case)
    advance(case, stepper, 3e-4)
    assert stepper.steps == len(asked) == 5 and stepper.limit == "conduction"
