"""Scenes of pools by `--set method.name=mps`, against what each scene is checked against, beside the same scene by the
weakly compressible method; the table goes to `two_methods.md` in the folder of the study."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import LIQUID
from sdph.running import driver
from sdph.study import compare
from sdph.study.compare import check

# coarser or shorter than the scenes are, so that the study takes minutes; both methods alike
SCENES = {
    "hydrostatic_tank": ("run.end_time_s=3.0",),
    "dam_break": ("resolution.spacing_mm=2.8575",),
    "square_patch": ("resolution.spacing_mm=20.0",),
    "oscillating_droplet": ("resolution.spacing_mm=0.1",),
}
METHODS = {"weakly compressible": (), "mps": ("method.name=mps",)}
TWICE = 2.0  # of a scene's own bars: swirl-sheet.md, section 5
# water at rest as the ladder has it: viscosity, time; bars: swirl-sheet.md, section 5
LADDER = (
    'effects=["gravity","tank","laminar_viscosity"]', "liquid.viscosity_Pa_s=1.0", "run.end_time_s=0.7",
    "run.output_interval_s=0.1",
)  # fmt: skip
PRESSURE, SPEED = 0.015, 0.02
WARM = "run.end_time_s=1e-3"
AROUND = 9  # rows of history.csv whose mean is taken off the pressure for its noise; our choice
COLUMNS = ("scene", "method", "check", "value", "reference", "noise", "CPU us a particle and step", "steps", "CPU [s]")


def checks(folder: Path, _, reporter, chosen=tuple(SCENES)) -> list[dict]:
    found, rows = _ladder(folder, reporter), []
    for scene in chosen:
        for method, overrides in METHODS.items():
            given, place = (*SCENES[scene], *overrides), folder / f"{scene}-{method.replace(' ', '_')}"
            _run(scene, (*given, WARM), folder / f"warm-{place.name}", reporter)  # kernels compiled or loaded
            run, spent = _run(scene, given, place, reporter)
            own = _of(scene, run)
            rows += _rows(scene, method, run, spent, own)
            found += _judged(scene, own) if overrides else []
    lines = [" | ".join(COLUMNS), " | ".join("--" for _ in COLUMNS), *(" | ".join(row) for row in rows)]
    (folder / "two_methods.md").write_text("".join(f"| {line} |\n" for line in lines), encoding="utf-8")
    return found


def _run(scene: str, overrides, folder: Path, reporter):
    """A run, and the CPU time [s] that it took, its start and its output too."""
    begun = time.process_time()
    driver.run(cases.load(scenes.HERE / scene / "case.toml", overrides), scene, folder, None, reporter)
    return compare.open_run(folder), time.process_time() - begun


def _ladder(folder: Path, reporter) -> list[dict]:
    run, _ = _run("hydrostatic_tank", (*METHODS["mps"], *LADDER), folder / "ladder", reporter)
    off, fastest = compare.scene_module("hydrostatic_tank").exact(run)[:2]
    name = "hydrostatic_tank, nu = 1e-3 m2/s, 0.7 s"
    return [
        check(f"{name}: {off['name']}", off["value"], 0.0, PRESSURE),
        check(f"{name}: {fastest['name']}", fastest["value"], 0.0, SPEED),
    ]


def _of(scene: str, run) -> list[dict]:
    """The scene's own checks; those of the droplet with the columns of its liquid alone."""
    if scene == "oscillating_droplet" and run.case.gas_phase is None:
        return [check("period [s]", _period(run), _lamb(run), 0.05, True)]
    return compare.scene_module(scene).exact(run)


def _lamb(run) -> float:
    from sdph.laws import liquids

    pool, sigma = run.case.pools["drop"], run.case.parameters["free_energy_tension"].coefficient
    return 2.0 * math.pi / liquids.disc_frequency(2, pool.radius, sigma, run.case.liquid.density)


def _period(run) -> float:
    """Twice the time between zeros of the difference of the variances [s]; nan of less than two."""
    t, stretch = run.history["time_s"], run.history["liquid_spread_x_m2"] - run.history["liquid_spread_y_m2"]
    turned = np.flatnonzero((stretch[1:-1] > 0.0) != (stretch[2:] > 0.0)) + 1
    zeros = [t[k] - stretch[k] * (t[k + 1] - t[k]) / (stretch[k + 1] - stretch[k]) for k in turned]
    return 2.0 * (zeros[1] - zeros[0]) if len(zeros) > 1 else math.nan


def _judged(scene: str, own: list[dict]) -> list[dict]:
    """Checks of moving particles: a scene's own with bars twice as wide, and of water at rest at the scene's end
    those of the ladder."""
    wide = {"pressure, L2 over rho g H": PRESSURE, "fastest particle over sqrt(g H)": SPEED}
    return [
        check(
            f"{scene} by mps: {one['name']}", one["value"], one["reference"],
            wide.get(one["name"], one["tolerance"] * (1.0 if scene == "oscillating_droplet" else TWICE)),
        )
        for one in own
    ]  # fmt: skip


def noise(run) -> float:
    """Root mean square of the pressure in the middle less its mean over AROUND rows, over that of the pressure."""
    pressure = run.history["centre_pressure_Pa"][1:]
    pressure = pressure[np.isfinite(pressure)]
    smooth = np.convolve(pressure, np.full(AROUND, 1.0 / AROUND), mode="valid")
    cut = AROUND // 2
    return float(np.sqrt(np.mean((pressure[cut:-cut] - smooth) ** 2) / np.mean(pressure**2)))


def _rows(scene: str, method: str, run, spent: float, own: list[dict]) -> list[tuple[str, ...]]:
    cloud = run.fields(run.summary["time_s"])[1]
    number, steps = int((np.asarray(cloud["kind"]) == LIQUID).sum()), run.summary["sub_steps"]
    cost = 1e6 * spent / number / steps
    rest = (f"{noise(run):.2g}", f"{cost:.2f}", str(steps), f"{spent:.0f}")
    return [
        (scene, method, one["name"], f"{one['value']:.5g}", f"{one['reference']:.5g}", *(rest if n == 0 else [""] * 4))
        for n, one in enumerate(own)
    ]


__all__ = ["checks"]
