"""Uniform shear between rough walls that slide apart: what holds them back and pushes on them, and theta, against the
closures at the shear rate in the core and averaged over the particles' own alpha_p there.

The cell is 30 diameters high, eight times the length over which conduction evens theta out (1.8 to 2 diameters); its
core, the middle half, is four such lengths from the walls. It starts as the closures have it and is sheared by SETTLED
before SHEARED is measured: neighbours have passed each other often by then. In a steady state the stress is the same at
all heights: that of the walls is that of the core, with what particles carry by moving. Theta, rate and alpha_p are of
the core. Below a mean alpha_p of 0.60 friction takes part by particles that are packed more than that.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph.laws import constants, friction, granular
from sdph.study.compare import check

from . import boxes

RATE = 20.0  # 1/s; below the onset of friction theory scales with it: our choice
HEIGHT, LENGTH = 30.0 * boxes.DIAMETER, 15.0 * boxes.DIAMETER  # m
SETTLED, SHEARED, SAMPLE = 10.0, 10.0, 0.02  # strains; our choice
BARS = {0.30: 0.02, 0.45: 0.02, 0.55: 0.02, 0.58: 0.05, 0.60: 0.05}  # issue 18
# the same: no bar; at one spacing, for friction's sound makes ten times as many steps there
REPORTED = {0.62: math.inf}
# spacings that places are off their lattice at the start, at most: shear keeps the rows of a lattice whole. Reported
OFF, DISORDERED = 0.2, (0.30, 0.45)
ONSET, SINE = 0.60, math.sin(math.radians(28.5))  # of friction, as a case has it that gives none


class Steady(NamedTuple):
    """Means over the time that is measured: of the walls, of the core, of the closures there; powers of the cell."""

    pressure: float  # [Pa] on the walls
    stress: float  # [Pa] along the walls
    theta: float  # [m2/s2]
    rate: float  # [1/s]
    law_pressure: float
    law_stress: float
    law_theta: float
    friction: float  # [Pa], part of law_pressure
    made: float  # [J] of theta by the motion
    lost: float  # [J] of theta by collisions
    grown: float  # [J] of theta
    worked: float  # [J] by the walls, less what the motion has gained
    rubbed: float  # [J] of the motion by friction
    numerical: float  # [J] of the motion by the order of the steps
    held: float  # largest share of particles that a limiter of the theory held


def checks(folder: Path, *_, spacings=boxes.SPACINGS, bars=BARS | REPORTED, disordered=DISORDERED) -> list[dict]:
    cells = [(s, dx, bar, 0.0) for s, bar in bars.items() for dx in (spacings[:1] if s in REPORTED else spacings)]
    cells += [(s, dx, math.inf, OFF) for s in disordered for dx in spacings]
    return [row for cell in cells for row in of_cell(*cell)]


def of_cell(share: float, spacing: float, bar: float, off: float = 0.0) -> list[dict]:
    """Checks of one cell: stress and theta; what shear makes and collisions take."""
    name = f"shear{', disordered' if off else ''}, alpha_p {share:g}, {1e3 * spacing:g} mm"
    own = steady(share, spacing, off)
    volume = HEIGHT * LENGTH
    shear_work = own.stress * own.rate * volume * SHEARED / RATE
    rows = [
        check(f"{name}: {what} over the closure [-]", ours / law, 1.0, bar)
        for what, ours, law in (
            ("pressure", own.pressure, own.law_pressure),
            ("shear stress", own.stress, own.law_stress),
            ("theta", own.theta, own.law_theta),
        )
    ]
    rows.append(
        check(
            f"{name}: friction's share of the closure's pressure, reported [-]",
            own.friction / own.law_pressure,
            0.0,
            math.inf,
        )
    )
    made = own.made + own.rubbed
    rows += [
        check(f"{name}: lost by the motion over tau rate V [-]", own.worked / shear_work, 1.0, bar),
        check(f"{name}: made of it over lost by the motion [-]", made / own.worked, 1.0, 0.01),
        check(f"{name}: theta made over lost and grown [-]", own.made / (own.lost + own.grown), 1.0, 1e-9),
        check(f"{name}: particles that a limiter held [-]", own.held, 0.0, 0.0 if bar < 0.05 else math.inf),
    ]
    return rows


def started(share: float, spacing: float, off: float = 0.0):
    """A cell as the closures have it at RATE, its particles `off` [spacings] their lattice at most."""
    walls = {side: {"kind": "wall", "side": side, "velocity_m_s": [way * RATE * HEIGHT, 0.0]}
             for side, way in (("bottom", -0.5), ("top", 0.5))}  # fmt: skip
    theta = boxes.steady_theta(share, RATE)
    run = boxes.Alone(boxes.case((LENGTH, HEIGHT), share, spacing, theta, boundaries=walls))
    s, rng = run.state, np.random.default_rng(1)
    run.begin_with(**{a: getattr(s, a) + off * spacing * rng.uniform(-1.0, 1.0, len(s.x)) for a in "xy"})
    run.begin_with(u=RATE * (run.state.y - 0.5 * HEIGHT))
    return run


def steady(share: float, spacing: float, off: float = 0.0) -> Steady:
    """State of a cell once it is steady."""
    run, step = started(share, spacing, off), SAMPLE / RATE
    for _ in range(round(SETTLED / SAMPLE)):
        run.window(step)
    run.forget()
    before, accounts, samples = run.totals(), [], []
    for _ in range(round(SHEARED / SAMPLE)):
        accounts.append(run.window(step))
        samples.append(sample(run))
    sums = {name: sum(account[name] for account in accounts) for name in accounts[0]}
    after = run.totals()
    gained = {key: after[key] - before[key] for key in after}
    push = run.push / (LENGTH * SHEARED / RATE)
    return Steady(
        push[:, 0].mean(),
        0.5 * (push[1, 1] - push[0, 1]),
        *np.mean(samples, axis=0),
        made=sums["agitation_J"],
        lost=sums["collision_heat_J"] - sums["bounds_work_J"],
        grown=gained["particle_fluctuation_energy_J"],
        worked=sums["work_of_walls_J"] - gained["particle_kinetic_energy_J"],
        rubbed=sums["mechanical_heat_J"],
        numerical=sums["numerical_work_J"],
        held=max(value for name, value in run.largest.items() if name in LIMITERS),
    )


LIMITERS = (
    "theta_at_least_share",
    "theta_at_most_share",
    "knudsen_viscosity_share",
    "knudsen_conductivity_share",
    "alpha_p_capped_share",
)


def sample(run) -> tuple[float, ...]:
    """theta, rate and the closures of `Steady`, now."""
    s = run.state
    core = np.abs(s.y - 0.5 * HEIGHT) < 0.25 * HEIGHT
    rate = np.polyfit(s.y[core], s.u[core], 1)[0]
    laws = np.mean([closures(share, rate) for share in boxes.alpha_p(s)[core]], axis=0)
    return s.theta[core].mean(), rate, *laws


def closures(share: float, rate: float) -> tuple[float, float, float, float]:
    """Pressure, shear stress [Pa], theta [m2/s2] and friction's part of the pressure [Pa] of steady shear."""
    theta, a = boxes.steady_theta(share, rate), granular.capped_fraction(share, boxes.PACKING)
    own = (a, theta, boxes.RESTITUTION, boxes.g0(a), boxes.DENSITY)
    contacts = (ONSET, boxes.PACKING, constants.FRICTION_FR, constants.FRICTION_ETA, constants.FRICTION_P)
    rubbing = friction.johnson_jackson_pressure(a, *contacts)
    rubbing += (share - a) * friction.johnson_jackson_slope(a, *contacts)
    stress = granular.gidaspow_viscosity(*own, boxes.DIAMETER) * rate + rubbing * SINE
    pressure = granular.lun_pressure(share, theta, *own[2:]) + rubbing
    return pressure, stress, theta, rubbing
