"""The head of the report: picture, three numbers and verdicts of each run, as its reader wants them first."""

from __future__ import annotations

import html
import io
import math

import numpy as np

from sdph.running import balances
from sdph.study.report.shown import Shown, measured, picture, section, spoken

NUMBERS = 3
PIXELS = 100  # an inch, of the picture: 800 on its longer side
TOLD = (  # keys of summaries in the order in which they are worth telling; others follow in theirs
    "rupture_diameter_ratio", "rupture_time_s", "pressure_max_Pa",
    "detachment_time_s", "bubble_diameter_m", "bed_height_m", "pressure_drop_Pa", "front_m", "D32_m", "outflow_D32_m",
    "sauter_diameter_m", "torn_droplets", "evaporated_kg", "vapour_mass_fraction_max", "half_angle_deg", "droplets",
    "plastic_strain_largest", "damage_largest", "free_particles", "heat_exchanged_J", "speed_max_m_s",
    "drained_kg", "left_kg", "kinetic_energy_J", "elastic_energy_J", "particles",
)  # fmt: skip
LARGEST = (("force on walls, largest", "wall_force_{}_N", "N"), ("pressure, largest", "pressure_largest_Pa", "Pa"),
           ("speed, largest", "fastest_m_s", "m/s"))  # fmt: skip


def shown(runs: list[Shown]) -> str:
    return section("At a glance", "".join(_one(run, len(runs) > 1) for run in runs))


def _one(run: Shown, named: bool) -> str:
    cards = "".join(
        f'<div class="card"><b>{html.escape(value)}</b><span>{html.escape(name)}</span></div>'
        for name, value in numbers(run)
    )
    told = "".join(f"<li>{line}</li>" for line in [state(run), *verdicts(run)])
    words = f'<div class="told"><div class="cards">{cards}</div><ul>{told}</ul></div>'
    head = f"<h3>{html.escape(run.name)}</h3>" if named else ""
    return f'{head}<div class="glance">{_picture(run)}{words}</div>'


def _picture(run: Shown) -> str:
    """The last instant as `sdph view` draws it; nothing where a run has no fields."""
    if not (run.folder / "run.pvd").is_file():
        return ""
    from sdph.show import shot, view
    from sdph.show.look import Look

    drawn, file = view.sheet(shot.of_folder(run.folder), Look()), io.BytesIO()
    drawn.figure.savefig(file, format="png", dpi=PIXELS)
    return picture(file.getvalue(), f"{run.name}: its last instant", mark="first")


def state(run: Shown) -> str:
    """The way it ended."""
    if run.failure:
        what, when = html.escape(run.failure["what"]), run.failure["time_s"]
        how = "ended" if run.failure.get("kind") == "Stopped" else "failed"  # who asked it to stop stands in `what`
        return f'<span class="failed">{how} at t = {when:.6g} s: {what}</span>'
    if run.summary:
        return f"finished at t = {run.summary['time_s']:.6g} s, after {run.summary.get('wall_s', math.nan):.3g} s"
    return (
        '<span class="failed">not finished: it is still going on, or was killed; sdph run --resume goes on with '
        "it</span>"
    )


def numbers(run: Shown) -> list[tuple[str, str]]:
    """(name, value) of the numbers that tell most: of probes, of metrics, the largest loads, then of the rest."""
    probes = [f"{name}_{told}_K" for name in run.case.probes for told in ("temperature", "rise")]
    found = [(key, run.summary[key]) for key in (*probes, *TOLD) if _tells(run.summary.get(key))]
    told = [(spoken(key)[0], measured(value, spoken(key)[1])) for key, value in found]
    loads = [] if "grains" in run.case.matters else _loads(run)
    return [*loads, *told][:NUMBERS]


def _tells(value) -> bool:
    return isinstance(value, (int, float)) and math.isfinite(value) and value != 0.0


def _loads(run: Shown) -> list[tuple[str, str]]:
    """The largest over time of what the history has: of a force its length."""
    found = []
    for name, column, unit in LARGEST:
        parts = [run.history[own] for own in (column.format(a) for a in "xyz") if own in run.history]
        length = np.sqrt(sum(np.square(part) for part in parts)) if parts else np.zeros(0)
        if len(length) and np.isfinite(length).any() and np.nanmax(length) > 0.0:
            found.append((name, measured(float(np.nanmax(length)), unit)))
    return found


def verdicts(run: Shown) -> list[str]:
    """Lines: balances, comparisons, and what would compare it."""
    lines = [_verdict("balances", balances.checks({k: v for k, v in run.summary.items() if v is not None}))]
    lines += [_verdict(f"against {html.escape(name)}", checks) for name, checks in run.comparisons.items()]
    if run.summary and not run.comparisons and run.case.scene:
        lines.append("not compared with references yet (sdph compare)")
    return [line for line in lines if line]


def _verdict(name: str, checks: list[dict]) -> str:
    if not checks:
        return ""
    missed = [html.escape(str(check.get("name"))) for check in checks if not check.get("ok")]
    if not missed:
        return f'<span class="ok">{name}: all {len(checks)} hold</span>'
    more = f" and {len(missed) - 2} more" if len(missed) > 2 else ""
    return f'<span class="failed">{name}: {len(missed)} of {len(checks)} missed ({"; ".join(missed[:2])}{more})</span>'
