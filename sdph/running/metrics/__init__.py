"""Metrics of a scene at every output, by the names in `run.metrics`: rows of metrics.csv."""

from __future__ import annotations

import math

from sdph.case.gas_cells import upwards
from sdph.engine.state import by_material
from sdph.methods.grains import start
from sdph.running import sizing
from sdph.running.metrics import agitation, bubble, bursts, column, jet, segregation
from sdph.schema import CaseError


def fractions(case, state):
    """alpha_p (N,) [-] of all grains where the particles are."""
    return state.density / by_material(state.grain_density, case.grains.density)


def bed(simulation) -> dict[str, float]:
    """The bubble (sdph.running.metrics.bubble), and the densest particle."""
    mesh, fields, up = simulation.gas.mesh, simulation.cell_fields(), upwards(simulation.case, "bubble")
    cells = (mesh.centres, mesh.volumes / mesh.depth, fields["alpha_p"], fields["temperature"], fields["pressure"])
    cells += (start.within_walls(simulation.case, mesh.centres[:, : simulation.case.dimensions]).astype(float),)
    if mesh.dimensions == 3:
        cells = bubble.through_depth(simulation.case.domain.size[2], *cells, up=up)
    row = bubble.metrics(*cells[:-1], up, cells[-1])
    return row | {"alpha_p_max": float(fractions(simulation.case, simulation.grains.inside).max(initial=0.0))}


def bed_in_the_end(rows: list[dict]) -> dict[str, float]:
    return {"detachment_time_s": bubble.detachment([row["time_s"] for row in rows], rows)}


AT_OUTPUTS = {
    "agitation": agitation.of_run,
    "bubble": bed,
    "bursts": bursts.metrics,
    "column": column.metrics,
    "jet": jet.metrics,
    "segregation": segregation.metrics,
    "sizes": sizing.metrics,
}
IN_THE_END = {"bubble": bed_in_the_end}
SAME_TIME = 1e-12  # of a time
OF_PRESSURE = ("pressure_drop_Pa", "gradient_Pa_m")  # the gas has none before its first window


def row(simulation) -> dict[str, float]:
    """All metrics of the case now."""
    refuse_unknown(simulation.case)
    columns = {"time_s": simulation.time}
    if own := names(simulation.case):
        with simulation.whole():
            for name in own:
                columns |= AT_OUTPUTS[name](simulation)
    return columns | {name: math.nan for name in OF_PRESSURE if name in columns and not simulation.windows}


def names(case) -> list[str]:
    """Metrics that the case asks for, and sizes where they differ or change."""
    own = list(case.run.metrics)
    always = ["sizes"] if "grains" in case.matters and sizing.told(case) else []
    return own + [name for name in always if name not in own]


def refuse_unknown(case) -> None:
    """CaseError where a case asks for metrics that it cannot have."""
    for name in case.run.metrics:
        if name not in AT_OUTPUTS or "grains" not in case.matters:
            none = "for liquids: none, for solids: none"
            raise CaseError(f"run.metrics = {name!r}; known for grains: {', '.join(AT_OUTPUTS)}, {none}")
    if "bursts" in case.run.metrics and "micro_explosion" not in case.effects:
        raise CaseError("run.metrics holds bursts, which tells of droplets that burst; add micro_explosion to effects")
    if "segregation" in case.run.metrics:
        segregation.refuse(case)
    if "jet" in case.run.metrics and not case.nozzles:
        mend = "leave it out, or give one in [nozzles.some_name]"
        raise CaseError(f"run.metrics holds jet, but the case has no nozzle; {mend}")


def summary(case, rows: list[dict]) -> dict[str, float]:
    """The last row, what only all of them tell, and means over those since `run.average_from` where that is not 0."""
    if not names(case):
        return {}
    in_the_end = [IN_THE_END[name](rows) for name in names(case) if name in IN_THE_END]
    told = {key: value for part in (rows[-1], *in_the_end) for key, value in part.items() if key != "time_s"}
    return told | means(rows, case.run.average_from)


def means(rows: list[dict], since: float) -> dict[str, float]:
    """mean_NAME of each number over the outputs from `since` [s] on; none where that is 0 or after the last output."""
    own = [row for row in rows if row["time_s"] >= since * (1.0 - SAME_TIME)] if since > 0.0 else []
    columns = [key for key in own[0] if key != "time_s"] if own else []
    return {f"mean_{key}": sum(row[key] for row in own) / len(own) for key in columns}
