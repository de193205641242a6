"""How a case is resolved, what limits its steps, and what it will cost: from the case alone, good to about a factor of
two."""

from __future__ import annotations

import json
import math
from typing import NamedTuple

import numpy as np

from sdph import effects
from sdph.case import gas_cells
from sdph.case.judge import scales_of
from sdph.effects.grains import friction, granular_pressure
from sdph.engine import device as environment
from sdph.engine import state as particles
from sdph.exchange.window import opening, smallest_cell
from sdph.laws import kernels
from sdph.methods.grains import start
from sdph.methods.grains.method import ACOUSTIC
from sdph.methods.grains.method import limits as limits_of_step

# Windows of a relaxation that is resolved to the tolerance e: integral of dt/sqrt(2 e) over rate = 2/sqrt(2 e), and
# half as many again for the safety of the controller and its way back (measured: 504 for e = 2e-5, where 2/sqrt(2 e) =
# 316).
RELAXATION = 1.5
ROW = 8  # bytes of a number and of an entry of a neighbour row
SCRATCH = 30  # arrays of the length of the particles that a step makes
GAS_ARRAYS = 120  # arrays of the length of the cells that the gas solver and the exchange hold
BASE = 180e6  # bytes of the program itself, kernels included
CELLS_WHY = (
    "what grains do to the gas is spread over 2 h, so that smaller cells do not sharpen the answer, but shrink the "
    "windows and cost "
    "(h/cell)^(dimensions + 1); in larger ones a particle that crosses a face makes alpha_p jump"
)
GRAINS_WHY = (
    "drag and heat laws are means over many grains; in smaller cells a grain meets gas that it has slowed or "
    "cooled itself, and both come out too small"
)
MEASURED = environment.CACHE / "speed.json"  # of this machine, by `sdph explain --measure`


class Speed(NamedTuple):
    """Time of one particle and sub-step, moving or at rest or of a liquid, and of one cell and window of the embedded
    gas [us]."""

    moving: float
    resting: float
    liquid: float
    cell: float
    measured: str


# One core of the machine the shipped numbers were made on; `sdph explain --measure` replaces them by yours.
SHIPPED = Speed(2.5, 0.4, 1.0, 2.0, "another machine; `sdph explain SCENE --measure` measures this one")


def speed() -> Speed:
    """What was last measured on this machine, else the shipped numbers."""
    return Speed(**json.loads(MEASURED.read_text())) if MEASURED.is_file() else SHIPPED


def ratios(case) -> list[dict]:
    """Cells, kernels, spacings and grains against each other, with the range that is safe and why; none for a
    liquid."""
    if case.grains is None:
        return []
    h, spacing, cell, d = case.smoothing_length, case.resolution.spacing, case.resolution.cell, case.grains.diameter
    extent = _extent(case)
    rows = [
        ("cell / h", cell / h, 0.25, 4.0, CELLS_WHY),
        ("cell / grain", cell / d, 3.0, math.inf, GRAINS_WHY),
        ("h / spacing", h / spacing, 1.2, 2.0, "fewer neighbours make noise, more blur"),
        ("spacing / grain", spacing / d, 1.0, math.inf, "an SPH particle stands for one grain or more"),
        ("grains' width / h", extent / h, 6.0, math.inf, "less than three kernels across is all rim"),
        ("domain / cell", min(case.domain.size) / cell, 10.0, math.inf, "coarser gas shows no flow"),
    ]
    return [
        {"ratio": n, "value": v, "least": low, "most": high, "safe": "yes" if low <= v <= high else "NO", "why": w}
        for n, v, low, high, w in rows
    ]


def _extent(case) -> float:
    return scales_of(case).length


def warnings(case) -> list[str]:
    """Cells far smaller than the particles, and the other ratios that are not safe; what it does to the answer."""
    return [
        f"{r['ratio']} = {r['value']:.3g}, safe from {r['least']:g} to {r['most']:g}: {r['why']}"
        for r in ratios(case)
        if r["safe"] == "NO"
    ]


def limits(case, scales) -> list[dict]:
    """Largest window and sub-step by cause [s]; the least of each kind rules."""
    rows = [*_windows(case, scales), *_sub_steps(case, scales)]
    least = {kind: min(value for k, _, value, _ in rows if k == kind) for kind in ("window", "sub-step")}
    return [
        {"of": kind, "cause": cause, "largest [s]": value, "rules": "<-" if value == least[kind] else "", "how": how}
        for kind, cause, value, how in rows
    ]


def _windows(case, s) -> list[tuple]:
    own = case.coupling
    rows = [
        ("window", "largest", own.window_largest, "coupling.window_largest_s"),
        ("window", "output", case.run.output_interval, "run.output_interval_s"),
    ]
    start = opening(case)
    rows += [
        ("window", cause, value, "coupling.courant cell/U of what enters or is thrown: the first window obeys it")
        for cause, value in start.items()
    ]
    later = own.courant * smallest_cell(case) / s.slip if s.slip else math.inf
    if later < min(start.values(), default=math.inf):
        rows.append(("window", "motion", later, "coupling.courant cell/U of what falls or rushes later: an estimate"))
    parameters = {name: effects.kernel_of(effects.REGISTRY[name], case) for name in case.effects}
    asked = effects.window_limits(parameters, case, _state(case))
    rows += [
        ("window", name, limit, "the effect's own window_limit") for name, limit in asked.items() if limit < math.inf
    ]
    if "heat" in case.effects and s.span and not own.one_way:
        rate = 1.0 / s.heat_time + 1.0 / s.gas_heat_time
        rows.append(
            (
                "window",
                "heat exchange",
                math.sqrt(2.0 * own.window_tolerance) / rate,
                "sqrt(2 tolerance)/rate: the first one, it grows with the rest to exchange",
            )
        )
    return rows


def _sub_steps(case, s) -> list[tuple]:
    sound = _sound(case, s) if effects.moving(case) else 0.0
    fastest = sound + s.speed if effects.moving(case) else 0.0
    parameters = {name: effects.kernel_of(effects.REGISTRY[name], case) for name in case.effects}
    how = {"sound": f"{ACOUSTIC:g} h/(c + v), c = {sound:.3g} m/s"}
    found = limits_of_step(case, parameters, _state(case), fastest)
    rows = [("sub-step", name, limit, how.get(name, "the effect's own dt_limit")) for name, limit in found.items()]
    return rows or [("sub-step", "window", case.coupling.window_largest, "nothing else limits it")]


def _sound(case, s) -> float:
    """c [m/s] of agitation and friction where grains lie closest at the start."""
    agitated = (
        granular_pressure.sound_squared(granular_pressure.kernel(case), s.alpha_p, s.theta)
        if "granular_pressure" in case.effects
        else 0.0
    )
    lasting = (
        friction.sound_squared(p := friction.kernel(case), friction.pressure(p, s.alpha_p)[1])
        if "friction" in case.effects
        else 0.0
    )
    return math.sqrt(agitated + lasting)


def _state(case):
    rows = [effects.REGISTRY[name] for name in case.effects]
    return start.fill(case, {name for row in rows for name in row.arrays})


def expected(case, s) -> list[dict]:
    """Particles, cells, windows, sub-steps, memory and wall time."""
    start, cells = len(_state(case).x), int(np.prod(gas_cells.cells(case)))
    end = start + _incoming(case)
    count = (start + end) // 2
    windows, steps = steps_of(case, s)
    pace = speed()
    particle = 1e-6 * count * steps * (pace.moving if effects.moving(case) else pace.resting)
    gas = 1e-6 * cells * windows * pace.cell
    how = f"one core, embedded gas, warm; particles {particle:.2g} s, gas {gas:.2g} s; measured on {pace.measured}"
    return [
        {"what": "particles", "value": end, "unit": "",
        "how": f"{start} at the start" if end > start else "all the time"},
        {"what": "gas cells", "value": cells, "unit": "", "how": ""},
        {"what": "windows", "value": windows, "unit": "", "how": "from the limits above"},
        {"what": "sub-steps", "value": steps, "unit": "", "how": "the same"},
        {"what": "memory", "value": memory(case, end, cells) / 1e6, "unit": "MB",
        "how": "state, neighbours, gas fields, program"},
        {"what": "wall time", "value": particle + gas, "unit": "s",
        "how": how},
    ]  # fmt: skip


def _incoming(case) -> int:
    """Particles that the nozzles bring until the end."""
    coming = 0.0
    for nozzle in case.nozzles.values():
        lasting = max(0.0, min(nozzle.end or case.run.end_time, case.run.end_time) - nozzle.start)
        coming += mouth(case, nozzle) * nozzle.speed * lasting / case.resolution.spacing**case.dimensions
    return math.ceil(coming)


def mouth(case, nozzle) -> float:
    """[m] or [m2] that a nozzle is wide."""
    radius = nozzle.radius or 0.0
    if nozzle.shape == "slot":
        return math.prod((nozzle.width or 0.0, nozzle.length or 0.0)[: case.dimensions - 1])
    return 2.0 * radius if case.dimensions == 2 else math.pi * radius**2


def steps_of(case, s) -> tuple[int, int]:
    """Windows and sub-steps to be expected."""
    rows = _windows(case, s)
    apart = {cause: value for _, cause, value, _ in rows if cause != "heat exchange"}
    windows = case.run.end_time / min(apart.values())
    if len(apart) < len(rows):
        windows += min(
            case.run.end_time / rows[-1][2], RELAXATION * 2.0 / math.sqrt(2.0 * case.coupling.window_tolerance)
        )
    least = min(value for *_, value, _ in _sub_steps(case, s))
    return math.ceil(windows), math.ceil(max(windows, case.run.end_time / least))


def memory(case, count: int, cells: int) -> float:
    """Bytes."""
    near = kernels.SUPPORT * case.resolution.smoothing_ratio
    neighbours = math.pi * near**2 if case.dimensions == 2 else 4.0 / 3.0 * math.pi * near**3
    return BASE + ROW * (count * (len(particles.FIELDS) + SCRATCH + 1.5 * neighbours) + cells * GAS_ARRAYS)
