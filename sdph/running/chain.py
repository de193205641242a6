"""Runs whose drops come in through a nozzle of another run: a sheet that breaks up, then its spray (swirl-sheet.md, 9).

RUN/record.mouth/                       the run that the nozzle [nozzles.mouth] records, with its droplets.csv
RUN/inputs/nozzles.mouth.table/drops.csv   the same drops about the nozzle's axis
RUN/handover.csv                        what the drops had, and what the particles have that they become
"""

from __future__ import annotations

import dataclasses
import math
import os
from pathlib import Path

import numpy as np

from sdph.effects.around import drops
from sdph.engine import table
from sdph.methods.mps import pieces, sheet
from sdph.running import inputs, output
from sdph.schema import CaseError

TABLE, HANDOVER = "drops.csv", "handover.csv"
DIAMETERS = "diameters_m"  # the sum of d, which no particles keep


def made(case, folder: Path, run, resume, reporter):
    """The case with a table for each nozzle that records a run, which is run first, or gone on with (`run` and `resume`
    as in `sdph.running.driver`)."""
    nozzles, rows = dict(case.nozzles), []
    for nth, (name, nozzle) in enumerate(case.nozzles.items()):
        if not nozzle.record or nozzle.table:
            continue
        recorded, done = inputs.recorded(f"nozzles.{name}", nozzle)
        if done is None:
            done = folder / f"record.{inputs.safe(name)}"
            reporter.status(f"first what nozzles.{name} records, into {done}")
            if (done / output.MARK).is_file():
                resume(done, (), reporter)
            else:
                run(recorded, recorded.scene, done, None, reporter)
        target = folder / inputs.place(f"nozzles.{inputs.safe(name)}.table", Path(TABLE))
        found = _drops(done / inputs.DROPS)
        played = found["time_s"] > nozzle.table_from
        for line in pieces.coarse(found["diameter_m"][played], found["particles"][played]):
            reporter.status(f"warning: drops that nozzles.{name} records: {line}")
        _write(recorded, found, target)
        nozzles[name] = dataclasses.replace(nozzle, table=os.path.abspath(target))
        within = math.fsum(found["inner_J"][played])
        tension = recorded.parameters.get("free_energy_tension")
        sigma = tension.coefficient if tension else 0.0
        rows += [{"nozzle": name} | row for row in handed_over(case, nozzles[name], within, sigma, nth)]
    if rows:
        output.write_rows(folder / HANDOVER, rows)
    return dataclasses.replace(case, nozzles=nozzles)


def _drops(told: Path) -> dict[str, np.ndarray]:
    """Columns of the drops that a run told of."""
    try:
        return table.numbers(told, (*drops.COLUMNS, "inner_J", "particles"))[1]
    except ValueError as error:
        raise CaseError(f"{told}: {error}; let the run go on until drops leave, by record_set run.end_time_s") from None


def _write(recorded, found: dict[str, np.ndarray], target: Path) -> None:
    """The drops that a run told of, about the axis of its nozzle."""
    (nozzle,) = recorded.nozzles.values()
    place = sheet.about_axis(nozzle, np.stack([found[name] for name in drops.PLACE], axis=1))
    middle = sheet.about_axis(nozzle, np.zeros((1, 3)))
    velocity = sheet.about_axis(nozzle, np.stack([found[name] for name in drops.VELOCITY], axis=1)) - middle
    turned = found | dict(zip(drops.PLACE, place.T)) | dict(zip(drops.VELOCITY, velocity.T))
    target.parent.mkdir(parents=True, exist_ok=True)
    output.write_rows(
        target, [dict(zip(drops.COLUMNS, row)) for row in zip(*(turned[n].tolist() for n in drops.COLUMNS))]
    )


def handed_over(case, nozzle, within: float, sigma: float = 0.0, nth: int = 0) -> list[dict]:
    """Rows of quantity, sum over the drops, sum over the particles that they become before they are scaled, what is
    lost by design, and the rest over the sum of sizes.

    Lost is motion within: `within` [J] the drops, and of drops within a particle against its mean; and all by which the
    sum of diameters differs: sizes whose number, surface and mass are right have another (swirl-sheet.md, 9). With a
    surface tension `sigma` [N/m] the energy of the surface of spheres is a row too.
    The nozzle is the `nth` of the case.
    """
    replay = drops.Replay(case, nozzle, nth)
    own, parcels = replay.drops, replay.parcels
    mass, q = parcels.mass / replay.scale, 1.0 + parcels.variance / parcels.diameter**2
    number = mass / (math.pi / 6.0 * case.grains.density * parcels.diameter**3 * q**3)
    rows = {"mass_kg": (own.mass, mass), "number": (np.ones(len(own.mass)), number)}
    surface = rows["surface_m2"] = (math.pi * own.diameter**2, math.pi * number * parcels.diameter**2 * q)
    diameters = rows[DIAMETERS] = (own.diameter, number * parcels.diameter)
    rows |= {
        f"momentum_{axis}_kg_m_s": (own.mass * before, mass * after)
        for axis, before, after in zip("xyz", own.velocity.T, parcels.velocity.T)
    }
    motion = [0.5 * m * (v**2).sum(axis=1) for m, v in ((own.mass, own.velocity), (mass, parcels.velocity))]
    rows["energy_of_motion_J"] = (np.append(motion[0], within), motion[1])
    if sigma:
        rows["energy_of_surface_J"] = tuple(sigma * part for part in surface)
    lost = {"energy_of_motion_J": math.fsum(1.5 * mass * parcels.theta) + within}
    lost[DIAMETERS] = math.fsum([*diameters[0], *(-diameters[1])])
    return [_row(name, *parts, lost.get(name, 0.0)) for name, parts in rows.items()]


def _row(name: str, before, after, lost: float) -> dict:
    left = math.fsum([*before, -lost, *(-after)])
    return {
        "quantity": name, "drops": math.fsum(before), "particles": math.fsum(after), "lost": lost,
        "difference_rel": left / math.fsum(abs(before)),  # of what closes by definition, of diameters, round-off
    }  # fmt: skip
