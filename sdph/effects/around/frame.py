"""A frame that moves with the tank: the liquid feels its acceleration, its rotation and Coriolis' force.

Paper T, Eq. 15: f = -[dV0/dt + beta x r + omega x (omega x r) + 2 omega x v], r from the origin of the frame. Gravity
that stays as it is in space turns in the frame: what it differs by from that of the start is felt as the frame's.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph.effects.effect import Effect, Judgement
from sdph.engine import table
from sdph.engine.attitude import Attitude
from sdph.laws.compiled import serial
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError, choice, file, quantity, record, refuse_implausible, vector

LOOKS = 400  # instants of a run at which its motion is looked at: our choice
INSTANT = 0.02  # rad, of the fastest turning: a step of the attitude, which errs by its fifth power; our choice
COLUMNS = ("time_s", "ax_m_s2", "ay_m_s2", "az_m_s2", "wx_rad_s", "wy_rad_s", "wz_rad_s")


@record
class Frame:
    """Sums of harmonics, or a table; the caller of `sdph.running.tank.DrivenTank` gives its own in place of both.

    The origin's displacement along axis a is sum A sin(w t + phase) of the rows [axis, A, w, phase] of `shake`
    (m, rad/s, rad); the angular velocity the same of `turn` (rad/s, rad/s, rad). Both begin at `start` and cease at
    `end`.
    """

    shake: tuple = vector("", ())
    turn: tuple = vector("", ())
    spin: tuple = vector("rad_s", (0.0, 0.0, 0.0), components=3)  # constant angular velocity
    # CSV file: time_s after `start`, ax_m_s2 ... of the origin, wx_rad_s ...; linear between rows, at rest before them
    table: str = file()
    start: float = quantity("s", 0.0, least=0.0)  # at rest before: time for the liquid to settle
    end: float | None = quantity("s", None, above=0.0)  # neither accelerated nor turning after
    gravity: str = choice("space", "tank")  # keeps its direction there; "tank": as the thrust of what the tank is in


class FrameP(NamedTuple):
    """Acceleration of the origin less gravity [m/s2], angular velocity [rad/s], its rate [rad/s2]."""

    ax: float
    ay: float
    az: float
    wx: float
    wy: float
    wz: float
    bx: float
    by: float
    bz: float


def felt(case):
    """t -> (acceleration (3,), omega (3,), omega_dot (3,)) of the frame of a case, the acceleration less what gravity
    has changed by in the frame since it was upright."""
    own = case.parameters["frame"]
    move, gravity = motion(own, case.run.end_time), np.array((*case.domain.gravity, 0.0)[:3])
    _refuse_out_of_plane(case, move)
    _refuse_periodic(case, move)
    step = _instant(own)
    if own.gravity == "tank" or "gravity" not in case.effects or not gravity.any() or not math.isfinite(step):
        return move
    attitude = Attitude(lambda time: move(time)[1], step)

    def at(time: float):
        acceleration, omega, rate = move(time)
        return acceleration - (attitude.at(time).T @ gravity - gravity), omega, rate

    return at


def _instant(own: Frame) -> float:
    """Step [s] of the attitude, by the motion alone and not by how long a run looks at it; inf where nothing turns."""
    if own.table:
        _, columns = table.numbers(Path(own.table), COLUMNS)
        fastest = float(np.linalg.norm([columns[name] for name in COLUMNS[4:]], axis=0).max())
        return min([INSTANT / fastest, float(np.diff(columns["time_s"]).min())]) if fastest else math.inf
    turning = [abs(rate) for _, rate, _, _ in own.turn]
    fastest = max([math.hypot(*own.spin) + sum(turning), *(abs(w) for _, rate, w, _ in own.turn if rate)])
    return INSTANT / fastest if fastest else math.inf


def _refuse_out_of_plane(case, move) -> None:
    """CaseError where what has two dimensions is moved along the third, or turned about another axis than it."""
    if case.dimensions == 3:
        return
    for time in np.linspace(0.0, case.run.end_time, LOOKS):
        acceleration, omega, rate = move(time)
        if acceleration[2] or omega[:2].any() or rate[:2].any():
            raise CaseError(
                f"frame: at {time:.3g} s the tank is moved along axis 2 or turned about axis 0 or 1; in two dimensions "
                "it moves along axes 0 and 1 and turns about axis 2"
            )


def _refuse_periodic(case, move) -> None:
    """CaseError where a domain is turned across an axis that is periodic: what is far out is pulled otherwise there
    than at the side that it goes on at."""
    around = np.array([*case.liquid_period, 0.0][:3]) > 0.0
    for time in np.linspace(0.0, case.run.end_time, LOOKS) if around.any() else ():
        _, *turns = move(time)
        if any(np.delete(turn, axis).any() for axis in np.flatnonzero(around) for turn in turns):
            raise CaseError("frame turns the domain across an axis that is periodic: leave liquid.periodic out there")


def motion(own: Frame, until: float):
    """t -> (acceleration (3,), omega (3,), omega_dot (3,)) of the frame, gravity left out; t goes to `until` [s]."""
    if own.end is not None and own.end <= own.start:
        raise CaseError(f"frame.end_s = {own.end:g} must come after frame.start_s = {own.start:g}")
    if own.table:
        if own.shake or own.turn or any(own.spin):
            raise CaseError("frame.table is the whole motion: leave shake, turn and spin_rad_s out, or the table")
        return _tabulated(own, until)
    for row in (*own.shake, *own.turn):
        flat = isinstance(row, tuple) and not any(isinstance(value, tuple) for value in row)
        if not flat or len(row) != 4 or row[0] not in (0, 1, 2):
            raise CaseError(
                f"frame.shake or frame.turn holds {row}; a row is [axis 0 (x), 1 (y) or 2 (z), amplitude, rad/s, phase]"
            )

    def at(time: float):
        acceleration, omega, rate = np.zeros(3), np.array(own.spin, float), np.zeros(3)
        t = time - own.start
        if t < 0.0 or (own.end is not None and time > own.end):
            return acceleration, np.zeros(3), rate
        for axis, amplitude, w, phase in own.shake:
            acceleration[int(axis)] -= amplitude * w**2 * np.sin(w * t + phase)
        for axis, amplitude, w, phase in own.turn:
            omega[int(axis)] += amplitude * np.sin(w * t + phase)
            rate[int(axis)] += amplitude * w * np.cos(w * t + phase)
        return acceleration, omega, rate

    return at


def _tabulated(own: Frame, until: float):
    try:
        lines, columns = table.numbers(Path(own.table), COLUMNS)
        _check_rows(lines, columns)
    except ValueError as error:
        needed = f"give a CSV file with the columns {', '.join(COLUMNS)}"
        raise CaseError(f"frame.table = {own.table!r}: {error}; {needed}") from None
    times, values = columns["time_s"], np.array([columns[name] for name in COLUMNS[1:]])
    slopes = np.diff(values, axis=1) / np.diff(times)
    last, needed = own.start + times[-1], until if own.end is None else min(until, own.end)
    if last < needed * (1.0 - ROUND_OFF):
        ends = f"frame.table = {own.table!r} ends at {last:g} s and the run at {until:g} s"
        raise CaseError(
            f"{ends}; add rows, lower run.end_time_s, or set frame.end_s, from which on the frame is at rest"
        )

    def at(time: float):
        t = time - own.start
        if t < times[0] or (own.end is not None and time > own.end):
            return np.zeros(3), np.zeros(3), np.zeros(3)
        now = np.array([np.interp(t, times, row) for row in values])
        k = int(np.clip(np.searchsorted(times, t) - 1, 0, len(times) - 2))
        return now[:3], now[3:], slopes[3:, k]

    return at


def _check_rows(lines, columns) -> None:
    """ValueError where times do not rise, or a number is of no plausible size."""
    for name, values in columns.items():
        for line, value in zip(lines, values):
            refuse_implausible(value, name.partition("_")[2], f"line {line}: {name}")
    times = columns["time_s"]
    for line, before, now in zip(lines[1:], times, times[1:]):
        if now <= before:
            raise ValueError(f"line {line}: time_s = {now:g} is not after {before:g}, as times must be")
    if len(times) < 2:
        raise ValueError("there must be two rows at least")


@serial
def acceleration(p, x, y, z, u, v, w):
    """Acceleration [m/s2] felt at a place (3) by what moves with a velocity (3) in the frame: Eq. 15."""
    if len(p) == 0:
        return 0.0, 0.0, 0.0
    cx, cy, cz = p.wy * z - p.wz * y, p.wz * x - p.wx * z, p.wx * y - p.wy * x  # omega x r
    ax = -p.ax - (p.by * z - p.bz * y) - (p.wy * cz - p.wz * cy) - 2.0 * (p.wy * w - p.wz * v)
    ay = -p.ay - (p.bz * x - p.bx * z) - (p.wz * cx - p.wx * cz) - 2.0 * (p.wz * u - p.wx * w)
    az = -p.az - (p.bx * y - p.by * x) - (p.wx * cy - p.wy * cx) - 2.0 * (p.wx * v - p.wy * u)
    return ax, ay, az


def kernel(case) -> FrameP:
    return FrameP(*[0.0] * 9)


def call(scales) -> Judgement:
    """Change of the liquid's speed by the frame's motion within the run, over that speed."""
    ratio = scales.shaken * scales.end / scales.speed if scales.speed else 0.0
    return Judgement("a_frame t/U", ratio, 0.01, "Froude number of the frame", min(1.0, ratio))


EFFECT = Effect(
    name="frame",
    summary="a tank that moves: acceleration, rotation, Coriolis",
    parameters=Frame,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    call=call,
)
