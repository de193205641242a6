"""Course of a gel droplet: growth until the shell tears, then the vent; its history, summary and picture."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.laws import real_gas, strength
from sdph.running import output
from sdph.schema import CaseError
from sdph.study.gel_droplet.model import Model
from sdph.study.gel_droplet.sections import Droplet

EAGER = 1.5  # a step over the one before it, at most; our choice
SHORTEST = 1e-9  # of numerics.longest_step: a spot that runs away in less has torn
FIRST_STEP = 0.1  # of numerics.longest_step, at the start: heat comes from the rim; our choice
VENT_STEP = 0.02  # of the vent's time constant at the tear, then of the time since; by convergence


class Course:
    """Columns of the history, the row of the tear (None: none), and the summary."""

    def __init__(self, own: Droplet):
        self.model = Model(own)
        rows = [self.model.row()]
        grow(self.model, rows)
        _refuse_above_critical(own, rows)
        self.tear = len(rows) - 1 if self.model.torn else None
        if self.model.torn:
            vent(self.model, rows)
        self.history = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        self.summary = summary(self)


def _refuse_above_critical(own: Droplet, rows: list) -> None:
    """CaseError where a bubble gets hotter than a liquid can be."""
    hottest, critical = max(row["bubble_K"] for row in rows), own.vapour.critical_temperature
    if hottest >= critical:
        raise CaseError(
            f"the bubble gets to {hottest:.4g} K before the shell tears, and the fuel's critical temperature is "
            f"{critical:g} K: give a lower droplet.ambient_pressure_Pa, or a weaker shell"
        )


def grow(model: Model, rows: list) -> None:
    """Grow until the shell tears or time is up, a row a step."""
    own = model.own.numerics
    dt = FIRST_STEP * own.longest_step
    while not model.torn and model.time < own.end_time:
        before = rows[-1]["diameter_ratio"], model.hoop
        if not model.step(min(dt, own.end_time - model.time)):
            dt *= 0.5
            if dt < SHORTEST * own.longest_step:
                model.torn = "the spot ran away"
            continue
        rows.append(model.row())
        share = abs(rows[-1]["diameter_ratio"] - before[0]) / own.growth_step
        dt = min(own.longest_step, dt * min(EAGER, 1.0 / share if share else EAGER))


def vent(model: Model, rows: list) -> None:
    """Vent for `vent.time`, in steps that grow with the time since the tear."""
    model.open()
    start, first = model.time, VENT_STEP * model.emptying()
    end = model.own.vent.time
    while model.time - start < end * (1.0 - 1e-12):
        since = model.time - start
        model.vent(min(max(first, VENT_STEP * since), end - since))
        rows.append(model.row())


def told_of_pressures(course: Course) -> str:
    """The level of the pressures in summary and history."""
    around = course.model.own.droplet.ambient_pressure
    return f"pressures are gauge, of the gel over that around: add ambient_pressure_Pa = {around:.9g} for absolute ones"


def summary(course: Course) -> dict:
    """Result, what closes to round-off, and what the model leaves out, each as a share; pressures are those over
    `ambient_pressure_Pa`."""
    model, h, tear = course.model, course.history, course.tear
    grown = slice(0, tear + 1 if tear is not None else None)
    speed = np.diff(h["diameter_ratio"][grown]) / np.diff(h["time_s"][grown])
    around, own = model.around, model.own
    wall = float(speed.max()) * 0.5 * own.droplet.diameter
    sound = strength.sound_speed(around.bulk, around.shear, own.gel.density)
    energy = h["elastic_J"][grown][-1] + h["plastic_J"][grown][-1]
    work = h["work_J"][grown][-1]
    at = tear if tear is not None else -1
    return {
        "torn": model.torn or "not torn",
        "rupture_time_s": float(h["time_s"][tear]) if tear is not None else math.nan,
        "rupture_diameter_ratio": float(h["diameter_ratio"][tear]) if tear is not None else math.nan,
        "rupture_pressure_Pa": float(h["pressure_Pa"][tear]) if tear is not None else math.nan,
        "diameter_ratio_max": float(h["diameter_ratio"].max()),
        "pressure_max_Pa": float(h["pressure_Pa"].max()),
        "pressure_end_Pa": float(h["pressure_Pa"][-1]),
        "vented_kg": float(h["vented_kg"][-1]),
        "boiled_share": 1.0 - own.gel.density * model.measure * model.gel_volume / model.start_mass,
        "mass_drift_rel": float(np.abs(h["mass_drift_rel"]).max()),
        "heat_drift_rel": float(np.abs(h["heat_drift_rel"]).max()),
        "work_drift_rel": float(energy / work - 1.0) if work else 0.0,
        "wall_speed_over_sound": wall / sound,
        "inertia_over_pressure": own.gel.density * wall**2 / max(float(h["pressure_Pa"].max()), 1.0),
        "latent_heat_of_curve_J_kg": float(
            real_gas.latent_heat_of_curve(model.vapour, float(h["bubble_K"][at]), own.gel.density)
        ),
        "ambient_pressure_Pa": own.droplet.ambient_pressure,
        "steps": len(h["time_s"]) - 1,
    }


def write(course: Course, folder: Path) -> None:
    """Write droplet.csv, summary.json and droplet.png into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    names = list(course.history)
    columns = np.column_stack(list(course.history.values()))
    np.savetxt(folder / "droplet.csv", columns, fmt="%.12g", delimiter=",", header=",".join(names), comments="")
    output.write_json(folder / "summary.json", course.summary)
    draw({"": course}, folder / "droplet.png")


def draw(courses: dict[str, Course], file: Path) -> None:
    """Draw D/D_0 and pressure against time of several courses."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    for label, course in courses.items():
        h = course.history
        last = None if course.tear is None else course.tear + 1
        left.plot(h["time_s"][:last], h["diameter_ratio"][:last], label=label)
        right.plot(h["time_s"], 1e-3 * h["pressure_Pa"], label=label)
    left.set(xlabel="time [s]", ylabel="D/D$_0$")
    right.set(xlabel="time [s]", ylabel="gauge pressure of the gel [kPa]")
    if len(courses) > 1:
        left.legend()
    figure.savefig(file, dpi=100)
    pyplot.close(figure)
