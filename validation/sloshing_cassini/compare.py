"""Cassini tank that drains for 300 s: mass against the command, energy that does not grow, loads from both sides."""

from __future__ import annotations

import numpy as np

from sdph.compare import check

AXES = ("x", "y", "z")
SMOOTHED = 5.0  # s: the walls' force is a sample of an instant in each row, the momentum's a mean since the last row
LAST = 20.0  # s, mean over the end of a part of the run: some sloshing periods (4.7 s)


def metrics(run) -> dict:
    """What `sdph cost` takes: (value, reference, scale)."""
    _, weight, apart, lever, *_ = (row["value"] for row in exact(run))
    return {"mean force over the weight": (weight, 1.0, 1.0), "forces of both sides apart": (apart, 0.0, 1.0), "moment off r_c x F": (lever, 0.0, 1.0)}


def exact(run) -> list[dict]:
    h, own = run.history, run.case
    particle = own.liquid.density * own.resolution.spacing**3
    weight = h["mass_kg"] * np.linalg.norm(own.domain.gravity)
    walls, pipe, mean = (np.stack([h[f"{part}_force_{a}_N"] for a in AXES], axis=1) for part in ("wall", "pipe", "mean"))
    moment = np.stack([h[f"wall_moment_{a}_Nm"] - h[f"pipe_moment_{a}_Nm"] for a in AXES], axis=1)
    lever = np.cross(np.array(own.parameters["tank"].centre), walls - pipe)
    rows = max(1, round(SMOOTHED / np.diff(h["time_s"]).mean()))
    apart = _rms(np.stack([np.convolve(c, np.ones(rows) / rows, mode="valid") for c in (mean - walls).T], axis=1)) / weight.mean()
    checks = [
        check("drained less commanded, largest, over a particle", np.abs(h["drained_kg"] - h["commanded_kg"]).max() / particle, 0.0, 0.5),
        check("mean downward force over the weight", (-mean[:, 2] / weight)[1:].mean(), 1.0, 0.01),
        check("force by momentum less force by the walls, means over 5 s, rms over the weight", apart, 0.0, 0.02),
        check("moment less r_c x F on the tank without its pipe, rms over rms", _rms(moment - lever) / _rms(lever), 0.0, 0.01),
    ]
    return checks + _energy(run)


def _energy(run) -> list[dict]:
    """Kinetic energy per mass: no more in the second half of the motion than in the first, and less once it has ceased."""
    h, ceases = run.history, run.case.parameters["frame"].end
    time, energy = h["time_s"], h["kinetic_energy_J"] / h["mass_kg"]
    if time[-1] < ceases + 2.0 * LAST:
        return []
    halves = [energy[(time > a) & (time <= b)].mean() for a, b in ((0.0, 0.5 * ceases), (0.5 * ceases, ceases))]
    ends = [energy[(time > t - LAST) & (time <= t)].mean() for t in (ceases, time[-1])]
    return [
        check("kinetic energy per mass, second half of the motion over the first, less 1 if it grows", max(halves[1] / halves[0] - 1.0, 0.0), 0.0, 0.0),
        check("the same, end of the run over end of the motion", max(ends[1] / ends[0] - 1.0, 0.0), 0.0, 0.0),
    ]


def _rms(vectors) -> float:
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))
