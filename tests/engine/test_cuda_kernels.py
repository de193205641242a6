"""Kernels of scenes compile for a device that is not there, in registers and without spills; effects that are off
vanish from them."""

import itertools
import re

import numpy as np
import pytest
from numba import typeof
from scripts import script

pytest.importorskip("numba_cuda", reason="needs numba-cuda and nvidia-cuda-nvcc: pip install 'sdph[cuda]'")

from sdph.engine.gpu import assembled, operators, products, sorting, toolkit, translation
from sdph.methods.liquids import equations, shift
from sdph.methods.mps import annulus

if assembled.assembler() is None:
    pytest.skip("needs ptxas: pip install nvidia-cuda-nvcc", allow_module_level=True)

kernels = script("cuda_kernels", "benchmarks")

MOST_OF_GRAINS = 168  # of a thread: 384 threads of a multiprocessor; `rates` in space takes 160
MOST = 128  # registers of a thread: 512 threads of a multiprocessor; the bar for `push`
COARSE = {
    "dam_break": ("resolution.spacing_mm=5.715",),
    "dam_break_3d": ("resolution.spacing_mm=5.715",),
    "dam_break_gas": ("resolution.spacing_mm=5.715",),
}
ARRAY, WHOLE = typeof(np.zeros(3)), typeof(np.zeros(3, np.int64))
TABLE = typeof(np.zeros((3, 2)))


@pytest.mark.parametrize("scene", kernels.LIQUIDS)
def test_every_kernel_of_a_scene_compiles_without_spills(scene):
    """The cosine of an eigenvalue keeps a few bytes aside, for angles larger than any here."""
    loops = kernels.loops_of(scene, *COARSE.get(scene, ()))
    names = {assembled.name_of(loop) for loop, _ in loops}
    expected = {"push", "compress", "state_of", "losses", "reaction", "fastest", "kick", "drift", "count", "fill"}
    assert expected <= {name.split(".")[-1] for name in names}
    for loop, taken in loops:
        found = assembled.assembled(loop, taken)
        assert found.spills == 0 and found.registers <= MOST, assembled.name_of(loop)
        assert found.stack == 0 or loop is shift.surround, assembled.name_of(loop)


@pytest.mark.parametrize(
    "scene, keys",
    [
        ("bubbling_bed", ()),
        ("bubbling_bed_3d", ("resolution.spacing_mm=10", "resolution.cell_mm=20", "walls.specularity=0.1")),
        ("granular_jet", ()),
        ("segregation", ()),
    ],
)
def test_every_kernel_of_grains_compiles_without_spills(scene, keys):
    loops = kernels.loops_of(scene, *keys)
    names = {assembled.name_of(loop) for loop, _ in loops}
    expected = "rates shear constitutive sum_density kick warm contact _gather deposit shares"
    assert set(expected.split()) <= {name.split(".")[-1] for name in names}
    for loop, taken in loops:
        found = assembled.assembled(loop, taken)
        assert found.spills == found.stack == 0, assembled.name_of(loop)
        assert found.registers <= MOST_OF_GRAINS, assembled.name_of(loop)


@pytest.mark.parametrize("scene", kernels.MOVING)
def test_every_kernel_of_moving_particles_compiles_without_spills(scene):
    """The sine of a helix keeps a few bytes aside, for angles larger than any here."""
    loops = kernels.moving(scene)
    names = {assembled.name_of(loop) for loop, _ in loops}
    expected = {"look", "equations_of", "multiply", "go", "press", "meet", "drift", "count", "fill"}
    if scene == "swirl_sheet":
        expected |= {"rub", "pull", "collide", "turn", "let_go", "leave", "hook", "jump"}
    assert expected <= {name.split(".")[-1] for name in names}
    for loop, taken in loops:
        found = assembled.assembled(loop, taken)
        assert found.spills == 0 and found.registers <= MOST, assembled.name_of(loop)
        assert found.stack == 0 or loop is annulus.turn, assembled.name_of(loop)


def text_of(scene: str, name: str, *keys: str) -> str:
    """PTX of a loop of a scene."""
    found = [own for own in kernels.loops_of(scene, *keys) if own[0].__name__ == name]
    assert len(found) == 1
    return assembled.assembled(*found[0]).text


def test_an_effect_that_is_off_leaves_nothing_in_a_kernel():
    """`push` of gravity and a tank alone divides three times, the force by the density; each effect adds to it."""

    def push(*more: str) -> str:
        named = ", ".join(f'"{name}"' for name in ("gravity", "tank", *more))
        return text_of("dam_break", "push", "resolution.spacing_mm=5.715", f"effects=[{named}]")

    bare, doubles = push(), r"\.f64"
    assert bare.count("div.rn.f64") == 3 and "rcp" not in bare
    damped, rubbed, diffused = map(push, ("liquid_damping", "laminar_viscosity", "density_diffusion"))
    assert damped.count("div.rn.f64") > 3 and "rcp" in diffused
    assert all(len(re.findall(doubles, text)) > len(re.findall(doubles, bare)) for text in (damped, rubbed, diffused))


def test_flags_of_fast_arithmetic_stay_on_the_processor():
    """numba-cuda takes any set of them for all, those that drop nan among them."""
    assert equations.by_pair.targetoptions["fastmath"]
    assert not translation.of_device(equations.by_pair).targetoptions.get("fastmath")


@pytest.mark.parametrize(
    "name, taken",
    [
        ("fill", (ARRAY, typeof(0.0))),
        ("times", (typeof(0.0), ARRAY, ARRAY)),
        ("sum_parts", (TABLE, TABLE)),
        ("sum_parts", (typeof(np.zeros((3, 1), bool)), TABLE)),
        ("cut_parts", (ARRAY, typeof(0.0), typeof(1), typeof(np.zeros((3, 3), np.int64)))),
        ("most_parts", (TABLE, TABLE)),
        ("find_ends", (ARRAY, TABLE)),
        ("find_ends", (WHOLE, TABLE)),
        ("sum_runs", (WHOLE, WHOLE)),
        ("begin_few", (WHOLE, WHOLE)),
        ("begin_few", (typeof(np.zeros(3, bool)), WHOLE)),
        ("widest", (WHOLE, typeof(0), WHOLE)),
        ("spread", (WHOLE, typeof(0), WHOLE)),
        ("begin_all", (WHOLE, WHOLE, WHOLE)),
        ("sum_runs", (typeof(np.zeros(3, bool)), WHOLE)),
        ("begin_all", (typeof(np.zeros(3, bool)), WHOLE, WHOLE)),
        ("choose", (typeof(np.zeros(3, bool)), WHOLE, typeof(np.zeros(3, np.int32)))),
        ("count", (WHOLE, WHOLE)),
        ("scatter", (WHOLE, WHOLE, WHOLE)),
        ("tidy", (WHOLE, WHOLE)),
        ("multiply", (ARRAY, typeof((np.zeros(3),)), TABLE)),
        ("multiply", (ARRAY, typeof((np.zeros(3),) * 2), TABLE)),
        ("put", (TABLE, ARRAY, typeof((0, 1)))),
    ],
)
def test_kernels_of_sorting_and_products_compile(name, taken):
    own = getattr(sorting, name, None) or getattr(products, name)
    text = toolkit.assembly(own.py_func, taken, assembled.CAPABILITY, parts=False)
    found = assembled.read(text)
    assert found.spills == 0 and found.registers <= 64


NUMBERS, TABLES = (typeof((0.0, 2)), typeof((0.0, 2.5))), (typeof((np.zeros((3, 1)),)), typeof((np.zeros((1, 3)),)))
MASKS = typeof(()), typeof((np.zeros((3, 1), bool),))
BOOLEAN = np.invert, np.bitwise_and, np.bitwise_or


@pytest.mark.parametrize("ufunc", operators.FORMS, ids=lambda own: own.__name__)
def test_operators_on_arrays_of_a_device_compile(ufunc):
    """Of tables and numbers, of truth values where they are of those."""
    own = operators._kernel_of(ufunc).py_func
    given = (TABLES[0], *NUMBERS, TABLES[1]) if ufunc not in BOOLEAN else MASKS[1:]
    for second, mask in itertools.product(given, MASKS):
        taken = given[0], second, mask, typeof(np.zeros((3, 3), bool if ufunc in BOOLEAN else float))
        text = toolkit.assembly(own, taken, assembled.CAPABILITY, parts=False)
        assert assembled.read(text).spills == 0


@pytest.mark.parametrize(
    "name, taken",
    [
        ("sum_rows", (TABLE, ARRAY)),
        ("put_column", (ARRAY, typeof(1), TABLE)),
        ("take_column", (TABLE, typeof(1), ARRAY)),
        ("put_rows", (TABLE, WHOLE, TABLE)),
        ("count_up", (WHOLE,)),
    ],
)
def test_kernels_of_expressions_compile(name, taken):
    text = toolkit.assembly(getattr(operators, name).py_func, taken, assembled.CAPABILITY, parts=False)
    assert assembled.read(text).spills == 0


def test_occupancy_is_that_of_nvidias_calculator():
    """65536 registers, 2048 threads of a multiprocessor: 32 registers let all in, 128 a quarter, 111 as many as 112."""
    assert [assembled.occupancy(own, 128) for own in (32, 64, 128, 111, 255)] == [1.0, 0.5, 0.25, 0.25, 0.125]


def test_no_two_kernels_are_one_on_disk():
    """Two loops of one name, and of one signature, are in two files: else one would be loaded for the other."""
    from sdph.engine import motion
    from sdph.methods.liquids import totals

    one, other = (translation.kernel_of(loop)._cache._impl.filename_base for loop in (motion.fastest, totals.fastest))
    assert one != other
