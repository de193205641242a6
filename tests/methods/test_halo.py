"""A loop takes from neighbours what its stepper declares, HALO, and nothing else; each name has its reason."""

import numpy as np
import pytest
from grain_boxes import box, several, started

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.engine.state import GAS, LIQUID
from sdph.methods.grains.method import Stepper
from sdph.methods.liquids.method import LiquidStepper

BED = ["granular_pressure", "granular_viscosity", "granular_temperature", "friction", "artificial_viscosity",
       "conduction"]  # fmt: skip
WHOLE = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.1, 0.1], "volume_fraction": 0.61, "temperature_K": 300.0}
THIN = ["effects=['gravity', 'density_diffusion', 'shear_thinning', 'tank']", "shear_thinning.model='power_law'",
        "shear_thinning.index=0.5", "shear_thinning.least_viscosity_Pa_s=1e-3",
        "shear_thinning.most_viscosity_Pa_s=1.0", "liquid.viscosity_Pa_s=0.1"]  # fmt: skip
LIQUIDS = {
    "diffusion": ("dam_break", "resolution.spacing_mm=5.715"),
    "thinning": ("dam_break", "resolution.spacing_mm=5.715", *THIN),
    "shifting": ("square_patch", "resolution.spacing_mm=50"),
    "corrected": ("square_patch", "resolution.spacing_mm=50", "liquid.pressure_gradient='corrected'"),
    "two phases": ("oscillating_droplet", "resolution.spacing_mm=0.1"),
}


def strewn(state, seed=0):
    """Give particles uneven velocities; True (N,) for the own ones, left of the middle."""
    rng = np.random.default_rng(seed)
    for velocity in (state.u, state.v):
        velocity += 0.01 * rng.standard_normal(len(velocity))
    return state.x < np.median(state.x)


def poisoned(array, rows):
    """Nothing in these rows can be used: no number, another kind, a particle that is not there."""
    if array.dtype == np.int8:
        array[rows] = np.where(array[rows] == LIQUID, GAS, LIQUID)
    else:
        array[rows] = np.nan if array.dtype == np.float64 else 10**6


def poison(stepper, names, far):
    """Poison fields of the state and arrays of rows, of particles that are `far` (N,)."""
    for name in names:
        rows = getattr(stepper, name, None)  # a stepper may call a number so
        arrays = all(isinstance(own, np.ndarray) for own in (rows if isinstance(rows, tuple) else (rows,)))
        own = rows if arrays else getattr(stepper.state, name)
        for array in own if isinstance(own, tuple) else (own,):
            if len(array):
                poisoned(array, far)


def liquid_answer(name, extra=()):
    """Rates of density and accelerations (.., 4) of the own particles, with what no HALO names poisoned beyond them."""
    scene, *sets = LIQUIDS[name]
    own = LiquidStepper(cases.load(scenes.HERE / scene / "case.toml", sets))
    inside, count = strewn(own.state), len(own.state.x)
    own.forces()
    if extra is not None:
        left = [field for field in (*particles.FIELDS, *own.ROWS) if field not in own.HALO]
        poison(own, (*left, *extra), ~inside)
    own._densify(1e-6)
    rate = own.rate.copy()
    own.forces()
    assert len(own.state.x) == count
    return np.column_stack((rate, own.acceleration))[inside & (own.volume > 0.0)]


def of_two(own):
    """Sand and char, particle by particle."""
    s = own.state
    s.material[:] = s.ident % 2
    for name, char in (("grain_density", 1000.0), ("grain_capacity", 500.0), ("grain_conductivity", 3.0)):
        getattr(s, name)[s.material == 1] = char
    s.mass[s.material == 1] *= 1000.0 / 3060.0
    own.prepare()


def grain_answer(folder, extra=(), mixed=False):
    """Density, then velocities, theta, temperature and stress of contacts of the own grains after a sub-step."""
    if mixed:
        parts = {"bed": WHOLE | {"material": "sand"}}
        case = several(BED, parts, {"sand": {}, "char": {"density_kg_m3": 1000.0}}, size=(0.1, 0.1))
    else:
        case = box(BED, size=(0.1, 0.1), alpha_p=0.61)
    own = started(case, folder).stepper
    if mixed:
        of_two(own)
    halo = (*own.HALO, *own.OF_SEVERAL) if mixed else own.HALO
    s, zeros = own.state, np.zeros(len(own.state.x))
    own.force(zeros, np.zeros((len(zeros), 3)), zeros)
    s, inside, rng = own.state, strewn(own.state), np.random.default_rng(1)
    for name in ("contact_xx", "contact_yy", "contact_xy"):
        getattr(s, name)[:] = rng.standard_normal(len(zeros))
    s.temperature[:] += rng.random(len(zeros))
    s.theta[:] *= 1.0 + rng.random(len(zeros))
    if extra is not None:
        poison(own, (*(name for name in s._fields if name not in halo), *extra), ~inside)
    density = np.empty(len(zeros))
    own._sum(density)
    own._constitute()
    own._advance(1e-6, 1e-6)
    told = [getattr(s, name) for name in ("u", "v", "theta", "temperature", "contact_xx", "contact_xy")]
    return np.column_stack((density, *told))[inside]


@pytest.mark.parametrize("name", LIQUIDS)
def test_liquids_take_what_they_declare_and_nothing_else(name):
    whole = liquid_answer(name, None)
    assert np.isfinite(whole).all()
    np.testing.assert_array_equal(liquid_answer(name), whole)


def test_grains_take_what_they_declare_and_nothing_else(tmp_path):
    (tmp_path / "poisoned").mkdir()
    whole = grain_answer(tmp_path, None)
    assert np.isfinite(whole).all()
    np.testing.assert_array_equal(grain_answer(tmp_path / "poisoned"), whole)


def test_grains_of_several_materials_take_these_besides(tmp_path):
    (tmp_path / "poisoned").mkdir()
    whole = grain_answer(tmp_path, None, mixed=True)
    assert np.isfinite(whole).all()
    np.testing.assert_array_equal(grain_answer(tmp_path / "poisoned", mixed=True), whole)
    for field in Stepper.OF_SEVERAL:
        (tmp_path / field).mkdir()
        assert not np.array_equal(grain_answer(tmp_path / field, (field,), mixed=True), whole), field


def test_liquids_declare_nothing_for_nothing():
    """Each name matters in one case at least; z and w in space alone."""
    wholes = {name: liquid_answer(name) for name in LIQUIDS}
    idle = [
        field
        for field in LiquidStepper.HALO
        if field not in "zw"
        and all(np.array_equal(liquid_answer(name, (field,)), whole) for name, whole in wholes.items())
    ]
    assert not idle


def test_grains_declare_nothing_for_nothing(tmp_path):
    whole, idle = grain_answer(tmp_path), []
    for field in Stepper.HALO:
        (tmp_path / field).mkdir()
        if np.array_equal(grain_answer(tmp_path / field, (field,)), whole):
            idle.append(field)
    assert set(idle) <= {"z", "w", "contact_yz", "contact_zx"}  # in space alone
