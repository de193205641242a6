"""All that `sdph explain` shows: each part is a list of rows."""

from __future__ import annotations

import math

from sdph import effects
from sdph.case import bodies, judge, probed
from sdph.effects.grains import conduction
from sdph.laws.sound import FAST
from sdph.methods.grains import expansion, start, ways
from sdph.methods.grains.scales import THIN
from sdph.study.explain import (
    droplets,
    eddies,
    edges,
    estimate,
    factor,
    haze,
    liquids,
    lockstep,
    mach,
    materials,
    mps,
    pressed,
    solids,
    stages,
)

OF = {
    "liquid": liquids,
    "mps": mps,
    "solid": solids,
}  # method -> module with `explain` and `warnings`; grains have their own
OF_HEAT = (
    "Biot",
    "heat loading",
    "Peclet of conduction",
    "run / heat time",
    "run / gas's heat time",
    materials.PACKED,
    materials.SPREAD,
)

ALIKE = (
    "effect heat is on and all temperatures are alike: only heat that motion makes is left to exchange, and windows "
    "may follow the gas's temperature as it swings with its pressure, many more of them than counted here"
)


def explain(case, priced=None) -> dict[str, list[dict]]:
    """All parts, each a list of rows (name -> value) of one table; of a case with several matters those of each.
    `priced` (`prices.Priced`) is the gas, where it is not the embedded one's."""
    case = start.assumed(case)
    if len(case.matters) == 1:
        return _explain(case, priced)
    shared = lockstep.of(case)
    found = {matter: _explain(case.only(matter), priced, shared) for matter in case.matters}
    for row in lockstep.contact_of(case):
        found["grains"]["limits"].append(row)
    told = {f"{part} ({matter})": rows for matter, parts in found.items() for part, rows in parts.items()}
    told |= {"probes": _probes(case)} if case.solid and case.probes else {}
    return told | ({"stages": stages.rows(case)} if "time_scaling" in case.effects else {})


def _probes(case) -> list[dict]:
    """A row for each probe of a case of a liquid and bodies: what it follows, and its columns of history.csv."""
    rows = []
    for name, probe in case.probes.items():
        number = bodies.around(case, probe.at)
        own = "" if number is None else f"the particle of bodies.{list(case.bodies)[number]} that is nearest to it"
        row = {"probe": name, "follows": own or "the liquid at its place"}
        rows.append(row | {"columns": ", ".join(f"{name}_{key}" for key in probed.columns(case, probe))})
    return rows


def _explain(case, priced, shared=None) -> dict[str, list[dict]]:
    scales = judge.scales_of(case)
    own = OF.get(case.moved_by(judge.matter(case)))
    found = own.explain(scales, *([shared] if shared else [])) if own else _of_grains(case, scales, priced)
    found["limits"] = factor.applied(case, found["limits"])
    return {
        "numbers": [
            dict(zip(("number", "value", "threshold", "meaning", "source"), row)) for row in found.pop("numbers")
        ],
        "effects": effect_rows(case, scales),
        **found,
        "warnings": [{"warning": text} for text in warnings(case, scales, priced)],
    }


def _of_grains(case, scales, priced) -> dict[str, list]:
    limits = estimate.limits(case, scales, priced.crossed if priced else 0.0)
    expected = estimate.expected(case, scales, priced)
    return {
        "numbers": numbers(scales, case.warm, "heat" in case.effects, priced.fastest if priced else 0.0),
        "materials": materials.rows(case),
        "ratios": estimate.ratios(case, priced and priced.edges),
        "limits": limits,
        "expected": expected,
    }


def warnings(case, scales=None, priced=None) -> list[str]:
    """Notes of `run` before it starts: effects that are missing, ratios that are not safe; `scales` of the case,
    `priced` as of `explain`."""
    if len(case.matters) > 1:
        return [text for matter in case.matters for text in warnings(case.only(matter), None, priced)]
    scales = scales or judge.scales_of(case)
    own = OF.get(case.moved_by(judge.matter(case)))
    told = own.warnings(scales) if own else _of_gas(case, scales, priced)
    alike = [ALIKE] if not own and {"heat", "drag"} <= set(case.effects) and not scales.span else []
    return [*judge.missing(case, scales), *told, *alike]


def _of_gas(case, scales, priced) -> list[str]:
    """Notes on grains in a gas."""
    edges, fastest = (priced.edges, priced.fastest) if priced else (None, 0.0)
    of_droplets = *droplets.boiling(case), *droplets.flying(scales, case.effects)
    own = (
        *eddies.warnings(scales),
        *mach.warnings(case, fastest),
        *haze.warnings(case, scales),
        *expansion.warnings(case, scales),
    )
    return [*estimate.warnings(case, edges), *own, *of_droplets, *pressed.warnings(case)]


def numbers(s, warm: bool = True, heated: bool = True, fastest: float = 0.0) -> list[tuple]:
    """(name, value, threshold, what lies above the threshold, source) of the numbers that decide; those of heat only
    where the case is `warm`, that of the gas where it is `heated`; `fastest` as of `mach.number`."""
    grains, gas, end = s.grains, s.gas, s.end
    biot = s.nusselt * gas.conductivity / (6.0 * grains.conductivity) if grains.conductivity else math.inf
    archimedes = gas.density * (grains.density - gas.density) * s.gravity * grains.diameter**3 / gas.viscosity**2
    diffusivity = conduction.conductivity(s.case, s.alpha_p) / (grains.density * grains.heat_capacity)
    peclet = s.speed * s.length / diffusivity if diffusivity else math.inf
    fed, slowest = (speed / s.minimum_fluidisation if speed else 0.0 for speed in (s.jet, ways.slowest(s.case)))
    rows = [
        ("particle Re", s.reynolds, 1.0, "drag is no longer Stokes'", "Clift, Grace & Weber 1978"),
        ("Stokes", s.drag_time * s.slip / s.length, 0.1, "grains leave the gas's path", "Crowe et al. 1998, ch. 2"),
        ("Archimedes", archimedes, 88.5, "grains of Geldart's group B: bubbles from the onset on", "Goossens 1998"),
        (
            "U/U_mf",
            fed,
            1.0,
            f"the fastest gas lifts grains at alpha_p = {s.capped:.3g}",
            "Ergun 1952",
        ),
        ("U/U_mf of the slowest inlet", slowest, 1.0, "gas lifts packed grains beside a jet too", "Ergun 1952"),
        ("Biot", biot, 0.1, "grains are not of one temperature inside", "Incropera, ch. 5.1"),
        ("Mach of the gas", mach.number(s, fastest), FAST, "gas is compressed by its own motion", "Anderson 2003"),
        ("1/Froude, g t/U", s.gravity * end / s.slip if s.slip else 0.0, 0.01, "gravity matters", "by its definition"),
        (
            "Knudsen of the grains, path/h",
            s.free_path / s.case.smoothing_length,
            THIN,
            "grains fly further than h between collisions",
            "Bird 1994, ch. 1",
        ),
        ("alpha_p", s.alpha_p, 1e-3, "grains collide", "Elghobashi 1994"),
        ("mass loading", s.loading, 0.1, "grains move the gas", "Elghobashi 1994; Crowe et al. 1998"),
        ("heat loading", s.heat_loading, 0.1, "grains heat or cool the gas", "Crowe et al. 1998"),
        ("Peclet of conduction", peclet, 1.0, "heat is carried rather than conducted by grains", "by its definition"),
        ("run / drag time", end / s.drag_time, 1.0, "grains follow the gas", "sdph-notes, section 3"),
        ("run / gas's drag time", end / s.gas_drag_time, 1.0, "gas follows the grains", "sdph-notes, section 3"),
        ("run / heat time", end / s.heat_time, 1.0, "grains take the gas's temperature", "sdph-notes, section 3"),
        (
            "run / gas's heat time",
            end / s.gas_heat_time,
            1.0,
            "gas takes the grains' temperature",
            "sdph-notes, section 3",
        ),
        ("run / collision time", end / s.collision_time, 1.0, "every grain has collided", "Gidaspow 1994"),
    ]
    rows += materials.touching(s)
    return [row for row in rows if warm or row[0] not in OF_HEAT] + droplets.numbers(s, heated)


def effect_rows(case, scales=None) -> list[dict]:
    """Every effect: on or off, called for or not, why, and the error without it; `scales` of the case, if known."""
    scales = scales or judge.scales_of(case)
    judged, called = judge.judgements(case, scales), judge.called_for(case, scales)
    rows, matter = [], judge.matter(case)
    for name, row in ((name, row) for name, row in effects.REGISTRY.items() if matter in row.matter):
        own = judged.get(name)
        rows.append({
            "effect": name,
            "in the case": "on" if name in case.effects else "off",
            "called for": ("yes" if name in called else "no") if own else "not judged",
            "why": _why(row, own),
            "error if off": own.error_if_off if own else math.nan,
            "source": own.source if own else "",
        })  # fmt: skip
    return rows


def _why(row, own) -> str:
    """Number and threshold of an effect's judgement, or why it has none."""
    if own:
        return f"{own.name} = {own.number:.3g} (matters from {own.threshold:.3g})"
    return f"needs [{row.name}] to be judged" if row.call else row.summary


def text(parts: dict[str, list[dict]]) -> str:
    """All parts as tables."""
    return "\n\n".join(f"{title.upper()}\n{table(rows)}" for title, rows in parts.items() if rows)


def table(rows: list[dict]) -> str:
    """Rows of equal keys in columns; numbers to three digits, and to more where those hide a side."""
    cells = [[key for key in rows[0]], *([_shown(value) for value in edges.shown(row).values()] for row in rows)]
    widths = [max(len(row[c]) for row in cells) for c in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in cells)


def _shown(value) -> str:
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.3g}"
    return str(value)
