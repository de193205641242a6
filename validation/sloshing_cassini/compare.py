"""Cassini tank that drains for 300 s: mass against the command, energy that does not grow, loads from both sides."""

from __future__ import annotations

import numpy as np

from sdph.study.compare import check

AXES = ("x", "y", "z")
SMOOTHED = 5.0  # s: the walls' force is a sample of an instant in each row, the momentum's a mean since the last row
DRAINED = 1e-6  # particles: the outlet takes parts of them, as that of sloshing_sphere, whose bar this is
LAST = 20.0  # s, mean over the end of a part of the run: some sloshing periods (4.7 s)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    _, weight, apart, lever = (row["value"] for row in _loads(run))
    return {
        "mean force over the weight": (weight, 1.0, 1.0),
        "forces of both sides apart": (apart, 0.0, 1.0),
        "moment off r_c x F": (lever, 0.0, 1.0),
    }


def exact(run) -> list[dict]:
    return [*_loads(run), *_energy(run)]


def _loads(run) -> list[dict]:
    """Mass against the command, and loads from both sides."""
    h, own = run.history, run.case
    particle = own.liquid.density * own.resolution.spacing**3
    weight = h["mass_kg"] * np.linalg.norm(own.domain.gravity)
    walls, pipe, mean = (
        np.stack([h[f"{part}_force_{a}_N"] for a in AXES], axis=1) for part in ("wall", "pipe", "mean")
    )
    moment = np.stack([h[f"wall_moment_{a}_Nm"] - h[f"pipe_moment_{a}_Nm"] for a in AXES], axis=1)
    lever = np.cross(np.array(own.parameters["tank"].centre), walls - pipe)
    rows = max(1, round(SMOOTHED / np.diff(h["time_s"]).mean()))
    apart = (
        _rms(np.stack([np.convolve(c, np.ones(rows) / rows, mode="valid") for c in (mean - walls).T], axis=1))
        / weight.mean()
    )
    return [
        check(
            "drained less commanded, largest, over a particle",
            np.abs(h["drained_kg"] - h["commanded_kg"]).max() / particle,
            0.0,
            DRAINED,
        ),
        check("mean downward force over the weight", (-mean[:, 2] / weight)[1:].mean(), 1.0, 0.01),
        check("force by momentum less force by the walls, means over 5 s, rms over the weight", apart, 0.0, 0.02),
        check(
            "moment less r_c x F on the tank without its pipe, rms over rms",
            _rms(moment - lever) / _rms(lever),
            0.0,
            0.01,
        ),
    ]


def _energy(run) -> list[dict]:
    """Energy does not grow of itself: in no SMOOTHED seconds does it rise by more than the frame, gravity and the drain
    gave (ledger).

    Beside it the kinetic energy, of all and of the tank's own liquid, which falls once the motion has ceased; that of
    the outlet pipe is the drain's.
    """
    h, rows, ceases = run.history, run.ledger, run.case.parameters["frame"].end
    if not run.reached([ceases + 2.0 * LAST]):
        return []
    lost = np.cumsum(rows["dissipated_J"] - rows["numerical_work_J"])  # what was given less what energy rose by
    begin = np.arange(0.0, rows["time_s"][-1] - SMOOTHED, 0.1 * SMOOTHED)
    least = min(np.interp(begin + SMOOTHED, rows["time_s"], lost) - np.interp(begin, rows["time_s"], lost))
    of_all, of_tank = (
        _rise(h, kinetic / h["mass_kg"], ceases)
        for kinetic in (h["kinetic_energy_J"], h["kinetic_energy_J"] - h["pipe_kinetic_energy_J"])
    )
    return [
        _at_most_0(
            "energy made in 5 s, largest: its rise less the work of frame, gravity and drain [J]",
            -least,
        ),
        _at_most_0("kinetic energy per mass, last 20 s over the last of the motion, less 1", of_all),
        _at_most_0("the same in the tank alone, without its pipe", of_tank),
    ]


def _at_most_0(name: str, value: float) -> dict:
    return check(name, value, 0.0, 0.0) | {"ok": bool(value <= 0.0)}


def _rise(h, energy, ceases: float) -> float:
    """Mean of an energy in the last LAST seconds over that in the last of the motion, less 1."""
    end, before = (energy[(h["time_s"] > t - LAST) & (h["time_s"] <= t)].mean() for t in (h["time_s"][-1], ceases))
    return float(end / before - 1.0)


def _rms(vectors) -> float:
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))
