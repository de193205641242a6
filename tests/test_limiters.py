"""Every clip of the code stands in a function that docs/limiters.md names, or is one of the harmless uses below."""

import ast
import re
from collections import Counter
from fnmatch import fnmatchcase
from functools import cache

import pytest

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
PAGE = ROOT / "docs" / "limiters.md"
ROOMS = ("sdph/laws", "sdph/effects", "sdph/engine", "sdph/exchange", "sdph/methods", "coupling/embedded")
CLIPS = {"clip", "maximum", "minimum", "fmax", "fmin", "nan_to_num"}  # of numpy, or methods of arrays
ORDER = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
DEFINED = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
NAME = re.compile(r"(?P<file>[\w/]+\.py):(?P<function>[\w.]+)")

# pattern of file:function -> why nothing physical is held in it
HARMLESS = {
    "sdph/effects/*.py:call": "judges for `sdph explain`; no run takes anything from it",
    "sdph/methods/*/scales.py:*": "estimates for `sdph explain` and for the bounds past which a run is stopped",
    "sdph/methods/grains/ways.py:*": "the same",
    "sdph/*.admit": "refuses what cannot be",
    "sdph/methods/grains/bounds.py:Guard.__init__": "bounds past which a run is stopped",
    "sdph/engine/guard.py:outside": "looks for the worst value",
    "sdph/exchange/window.py:*": "length of windows",
    "sdph/exchange/pulls.py:_run_ahead": "a share: grains are free below where they touch",
    "sdph/laws/kernels.py:cubic_spline_curvature": "support of a kernel",
    "sdph/methods/grains/equations.py:constitutive": "the largest of all",
    "sdph/exchange/equations.py:temperature_span": "a scale for the length of windows",
    "sdph/exchange/exchange.py:Exchange.grip": "a limit of windows",
    "sdph/exchange/exchange.py:Exchange.settling": "a limit of windows",
    "sdph/effects/around/drain.py:filled": "a tank is full at most: what nozzles bring beyond it runs over",
    "sdph/effects/around/drain.py:_brought": "time until the drain opens",
    "sdph/effects/gas/radiation.py:window_limit": "a limit of windows",
    "sdph/effects/gas/reaction.py:richest": "the largest that the case gives",
    "sdph/effects/gas/reaction.py:rise": "a scale for the length of windows, and bounds past which a run is stopped",
    "sdph/effects/gas/micro_explosion.py:tear": "takes the ratio of the case where it gives one",
    "sdph/effects/gas/break_up.py:advance": "what is left of the window, or less of it",
    "sdph/laws/break_up.py:*": "times: the sooner of two, a phase within a turn",
    "sdph/engine/clock.py:count_of_parts": "number of steps",
    "sdph/engine/cells.py:*": "indices of cells",
    "sdph/engine/cuts.py:_quantile": "indices of bins",
    "sdph/engine/rows.py:*": "indices of entries",
    "sdph/engine/neighbours.py:*": "counts of cells",
    "sdph/engine/reading.py:*": "sizes of files",
    "sdph/engine/motion.py:*": "the largest of all",
    "sdph/engine/polyline.py:near": "geometry: the nearest place of a segment",
    "sdph/engine/polyline.py:foot": "the same",
    "sdph/effects/grains/*:largest": "the largest of all",
    "sdph/engine/ledger.py:Ledger.close_window": "the largest so far",
    "sdph/engine/ledger.py:Ledger._energy_drift": "what a drift is related to, for the summary alone",
    "sdph/methods/liquids/totals.py:LiquidLedger.*": "the largest so far",
    "sdph/methods/liquids/totals.py:fastest": "the largest of all",
    "sdph/methods/mps/totals.py:MpsLedger.close_window": "the largest so far",
    "sdph/methods/mps/totals.py:MpsLedger._write": "the largest so far",
    "sdph/methods/liquids/heat.py:Heat.summary": "what a drift is related to, the larger of two",
    "sdph/engine/walls/*": "geometry: distances, counts of points",
    "sdph/engine/polyline.py:*": "geometry: the nearest place of a segment",
    "sdph/engine/lattice.py:*": "counts of points",
    "sdph/methods/grains/expansion.py:*": "the farthest region of all, and how many times by the larger of two",
    "sdph/methods/grains/start.py:_look_for_overlap": "a count of points",
    "sdph/methods/grains/start.py:extents": "geometry: the level of a region or its end, for estimates",
    "sdph/engine/regions.py:*": "counts of points, extents",
    "sdph/effects/around/streams.py:_ticks": "counts of points",
    "sdph/effects/around/source.py:Source.fill": "counts of layers",
    "sdph/effects/around/drops.py:Replay.count": "until when a nozzle is open",
    "sdph/effects/around/rates.py:*": "a row of the table, and from when to when there must be rows",
    "sdph/effects/around/sizes.py:_check_rosin_rammler": "the larger of two bounds of what is refused",
    "sdph/laws/grain_sizes.py:of_moments": "round-off where all drops are alike",
    "sdph/effects/around/source.py:Source._wanted": "counts of layers",
    "sdph/effects/around/frame.py:_tabulated*": "a row of the table, and up to where there must be rows",
    "sdph/effects/liquids/shear_thinning.py:shear_rates": "chooses wall or liquid by the sign of the volume",
    "sdph/methods/liquids/filling.py:_shares": "share of a cell inside a shape",
    "sdph/methods/liquids/filling.py:Slab.beyond": "geometry: distances",
    "sdph/methods/liquids/filling.py:fill": "geometry: distances",
    "sdph/methods/liquids/filling.py:lattice": "geometry: extents",
    "sdph/methods/liquids/pressures.py:_top": "geometry: the higher corner",
    "sdph/methods/liquids/wetting.py:filled": "share of a cell inside a plane",
    "sdph/methods/liquids/wetting.py:opposite": "chooses walls by the sign of the volume",
    "sdph/methods/liquids/losses.py:losses": "the same as `compress`",
    "sdph/methods/liquids/equations.py:unreturned": "the same",
    "sdph/methods/liquids/*:compress": "takes the liquid among neighbours: volumes of walls are negative",
    "sdph/methods/liquids/interface.py:*": "the same",
    "sdph/methods/liquids/shift.py:surround": "the same",
    "sdph/methods/liquids/sparse.py:*": "the same",
    "sdph/methods/liquids/walls.py:wall_force": "the same",
    "sdph/methods/liquids/parts.py:Surface.*": "a patch of the surface without places has no area, and so no normal",
    "coupling/transfer.py:Transfer._even": "a cell that nothing reaches has nothing to share",
    "sdph/methods/liquids/faces.py:share_of": "how near to the void a particle is, from 0 to 1",
    "sdph/methods/liquids/surface.py:border": "volumes of wall particles carry a sign that marks them",
    "sdph/methods/liquids/pores.py:Grid.at": "what left the grid since it was made is in the air, as its edge is",
    "sdph/methods/liquids/bubbles.py:Bubbles._about": "the nearest where none is near",
    "sdph/methods/liquids/rooms.py:find": "how empty a cell is, from 0 to 1",
    "sdph/methods/liquids/rooms.py:fill": "indices of cells",
    "sdph/methods/liquids/heat.py:Heat.advance": "number of steps",
    "sdph/effects/liquids/time_scaling.py:pace": "the pace itself: numerics, told as `time_scale`",
    "sdph/laws/moving_particles.py:tension_coefficient": "takes the pairs above a plane",
    "sdph/effects/around/streams.py:_rings": "counts of points",
    "sdph/engine/arrays.py:positive": "the same, of whole arrays",
    "sdph/effects/grains/artificial_viscosity.py:dt_limit": "the larger of its two numbers",
    "sdph/effects/gas/reaction.py:window_limit": "no division by 0",
    "sdph/exchange/window.py:Window.obey": "the shorter of two limits",
    "sdph/effects/gas/micro_explosion.py:window_limit": "what is missing to boiling, none once it boils",
    "sdph/engine/gpu/sorting.py:*": "the largest of all, ends of runs, and the same",
    "sdph/engine/gpu/assembled.py:occupancy": "threads that there are",
    "sdph/engine/gpu/operators.py:*": "what operators of numpy mean, on a device",
    "sdph/engine/linear.py:_parts": "indices of a sum's parts",
    "sdph/methods/mps/equations.py:look": "the largest of all",
    "sdph/methods/mps/alone.py:add_*": "indices of a sum's parts",
    "sdph/methods/mps/alone.py:*est": "the largest of all",
    "sdph/methods/mps/pieces.py:hook": "the least number of a row",
    "sdph/methods/mps/sections.py:LiquidMethod.sees": "the widest reach",
    "sdph/methods/mps/mps.py:Mps._summary": "means of a run without a step",
    "sdph/methods/mps/holes.py:Holes._waves": "room for numbers of particles",
    "sdph/effects/liquids/perforation.py:way": "judges for `sdph explain`; no run takes anything from it",
    "sdph/methods/mps/sheet.py:*": "counts of pixels, and a length to draw a curve over",
    "sdph/methods/mps/instants.py:*": "counts of pixels and of instants",
    "sdph/methods/solids/start.py:*": "counts of points",
    "sdph/methods/solids/equations.py:least_stretch": "the largest of all",
    "sdph/methods/solids/totals.py:SolidLedger._write": "the largest so far",
    "sdph/laws/gel_droplet.py:vented": "the hotter of two encloses a root",
    "coupling/embedded/convection.py:substeps": "number of sub-steps",
    "coupling/embedded/linear.py:*": "the largest of all",
    "coupling/embedded/momentum.py:Momentum.predict": "the largest of all",
    "coupling/transfer.py:_bins": "indices of bins",
    "coupling/transfer.py:_around": "indices of bins",
    "coupling/transfer.py:_add": "indices of entries",
    "coupling/transfer.py:_weighed": "indices of entries",
}
# functions that the page names -> clips in them, where there is more than one
SEVERAL = {
    "sdph/methods/mps/equations.py:equations_of": 2,
    "coupling/embedded/convection.py:carried": 2,
    "coupling/transfer.py:_spline": 2,
    "sdph/effects/around/drain.py:command.fill": 2,
    "sdph/effects/around/walls.py:extrapolate": 2,
    "sdph/effects/gas/sizes.py:birth_of_burnt": 4,
    "sdph/effects/grains/granular_temperature.py:advance": 3,
    "sdph/effects/grains/granular_temperature.py:transported": 4,
    "sdph/effects/liquids/liquid_damping.py:pair": 2,
    "sdph/effects/liquids/shear_thinning.py:viscosity": 2,
    "sdph/engine/kernels.py:slope": 3,
    "sdph/engine/kernels.py:value": 3,
    "sdph/exchange/droplets.py:active_time": 2,
    "sdph/exchange/droplets.py:losses": 2,
    "sdph/exchange/droplets.py:force_by": 2,
    "sdph/laws/evaporation.py:boiling_force": 2,
    "sdph/laws/matrices.py:smallest": 2,
    "sdph/methods/liquids/wetting.py:beyond": 2,
    "sdph/methods/liquids/wetting.py:face": 2,
    "sdph/laws/radiation.py:cooled": 2,
    "sdph/laws/strength.py:failure_strain": 2,
}
CALL = re.compile(r"\b(?:min|max|clip|clamp|bound)\s*\(")
# `carry` and `vapourGiven`, which the page names; the largest of two correctors; sleep between two looks at a file
OPENFOAM = {"gasSolverStep.H": 4, "pEqn.H": 1, "channel.C": 1}


def files() -> list:
    return [file for room in ROOMS for file in sorted((ROOT / room).rglob("*.py"))] + [ROOT / "coupling/transfer.py"]


def parts(tree) -> dict[str, list]:
    """Name of everything that is defined in a module, `<module>` for the rest -> its nodes, less those of what is
    defined in it."""
    found, left = {"<module>": []}, [("", tree)]
    while left:
        name, node = left.pop()
        for child in ast.iter_child_nodes(node):
            own = name
            if isinstance(child, DEFINED):
                own = f"{name}.{child.name}" if name else child.name
                found.setdefault(own, [])
            else:
                found[own or "<module>"].append(child)
            left.append((own, child))
    return found


def ordered(test) -> bool:
    return isinstance(test, ast.Compare) and isinstance(test.ops[0], ORDER)


def compared(test) -> set[str]:
    """What an order compares, constants left out."""
    sides = (test.left, *test.comparators) if ordered(test) else ()
    return {ast.dump(side).replace("Store()", "Load()") for side in sides if not isinstance(side, ast.Constant)}


def is_clip(node) -> bool:
    """True for min and max of several values, numpy's clips, `a if a < b else b`, `if a > b: a = b` and `a[a > b] =
    b`."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("min", "max"):
        return len(node.args) > 1 or any(isinstance(value, ast.Starred) for value in node.args)
    if isinstance(node, ast.Call):
        return isinstance(node.func, ast.Attribute) and node.func.attr in CLIPS
    if isinstance(node, ast.IfExp):
        return bool({ast.dump(node.body), ast.dump(node.orelse)} & compared(node.test))
    if isinstance(node, ast.If) and len(node.body) == 1 and isinstance(node.body[0], ast.Assign):
        return ast.dump(node.body[0].targets[0]).replace("Store()", "Load()") in compared(node.test)
    return isinstance(node, ast.Assign) and any(
        isinstance(target, ast.Subscript) and ordered(target.slice) for target in node.targets
    )


def clips(text: str) -> Counter:
    """Function (`<module>` outside of any) -> clips in it, where there are any."""
    return +Counter({name: sum(map(is_clip, nodes)) for name, nodes in parts(ast.parse(text)).items()})


@cache
def defined(file: str) -> frozenset[str]:
    """Names of what a file defines; none where there is no such file."""
    path = ROOT / file
    return frozenset(parts(ast.parse(path.read_text(encoding="utf-8")))) if path.is_file() else frozenset()


@cache
def named() -> frozenset[str]:
    """file:function that the page names, which leaves sdph/ out; in a row a name alone is of the file before it."""
    found = set()
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        file = ""
        for word in re.findall(r"`([^`]+)`", line):
            match = NAME.fullmatch(word)
            if match:
                file = match["file"] if match["file"].startswith("coupling/") else f"sdph/{match['file']}"
            function = match["function"] if match else word
            if match or function in defined(file):
                found.add(f"{file}:{function}")
    return frozenset(found)


@pytest.fixture(scope="module")
def found() -> dict[str, int]:
    """file:function -> clips in it."""
    return {
        f"{file.relative_to(ROOT)}:{function}": number
        for file in files()
        for function, number in clips(file.read_text(encoding="utf-8")).items()
    }


def test_every_clip_is_on_the_page_or_harmless(found):
    page = named()
    unlisted = [name for name in found if name not in page and not any(fnmatchcase(name, one) for one in HARMLESS)]
    assert not unlisted, f"hold values in bounds and are not in docs/limiters.md: {unlisted}"


def test_functions_on_the_page_hold_what_they_held(found):
    """A clip more in a function that is listed anyway: does the page tell of it?"""
    several = {name: number for name, number in found.items() if number > 1 and name in named()}
    assert several == SEVERAL


def test_the_page_names_what_there_is():
    missing = [name for name in named() if name.partition(":")[2] not in defined(name.partition(":")[0])]
    assert not missing
    assert len(named()) > 80


def test_no_exception_is_left_over(found):
    idle = [pattern for pattern in HARMLESS if not any(fnmatchcase(name, pattern) for name in found)]
    assert not idle


def test_clips_of_the_openfoam_solver():
    folder = ROOT / "coupling" / "openfoam" / "sdphGasFoam"
    sources = {file.name: file.read_text(encoding="utf-8") for file in sorted(folder.glob("*.[CH]"))}
    assert len(sources) > 10
    assert {name: len(calls) for name, text in sources.items() if (calls := CALL.findall(text))} == OPENFOAM


def test_clips_are_found():
    text = """
def held(a, b):
    a = min(a, b) + np.clip(a, 0.0, 1.0) + (a if a < b else 0.0)
    if a > b:
        a = b
    a[a > b] = b
    return max(a), a.max(), 1.0 if a > 0.0 else 0.0
class Some:
    def own(self):
        return max(*self.rows)
"""
    assert clips(text) == {"held": 5, "Some.own": 1}
