"""Are the estimates of `sdph explain` right away from the cases that they were made on? Effects off, one at a time, in
variants.

    python validation/estimates.py [variant ...]

prints the measured change of each variant's metrics (those of `sdph cost`) beside the estimate; README of this:
estimates.md.
"""

from __future__ import annotations

import dataclasses
import sys

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.study.cost import climb, ladder, report, rows

VARIANTS = {  # name -> scene, what is changed
    "column, fluidised": ("fluidised_column", ("boundaries.distributor.velocity_m_s=[0.0,0.15]",)),
    "bed of coarse grains": (
        "bubbling_bed",
        (
            "grains.diameter_mm=0.6",
            "boundaries.jet.velocity_m_s=[0.0,15.0]",
            "boundaries.distributor.velocity_m_s=[0.0,0.3]",
        ),
    ),
    "dilute jet of fine droplets": (
        "evaporating_jet",
        (
            "nozzles.jet.volume_fraction=0.02",
            "nozzles.jet.speed_m_s=20.0",
            "grains.diameter_mm=0.3",
            "run.end_time_s=0.08",
        ),
    ),
    "spray ten times as dense": (
        "spray_cone",
        ("nozzles.cone.rate_kg_s=0.1", "grains.diameter_mm=0.12", "run.end_time_s=0.03"),
    ),
    "disc for 2 ms": (
        "disc_cluster",
        ("run.end_time_s=0.002", "run.output_interval_s=0.001", "run.report_at_s=[]", "grains.conductivity_W_m_K=5e4"),
    ),
}
ON_SHORT_RUNS = {"disc_cluster": ["centre_rise_K", "heat_exchanged_J"]}  # in place of metrics at fixed times


def compared(scene: str, changes: tuple) -> list[tuple[str, float, float]]:
    """(effect, measured change, estimate) of a variant."""
    own = ladder.declared(scene)
    own = dataclasses.replace(own, excerpt=[*own.excerpt, *changes], metrics=ON_SHORT_RUNS.get(scene, own.metrics))
    judged = judge.judgements(cases.load(scenes.find(scene)[1], (*own.settings, *own.excerpt)))
    whole = climb.measure(scene, own, own.middle, 1)
    left_out = [(name, climb.measure(scene, own, own.middle | {"without": name}, 1)) for name in own.drop]
    return [(name, rows.distance(whole, row), judged[name].error_if_off) for name, row in left_out]


def main() -> None:
    right = []
    for name in sys.argv[1:] or VARIANTS:
        for effect, change, estimate in compared(*VARIANTS[name]):
            right.append(report.near(change, estimate))
            print(
                f"{name:30s} {effect:22s} change {change:9.3g}  estimate {estimate:9.3g}  "
                f"{'' if right[-1] else 'MISS'}",
                flush=True,
            )
    print(f"{sum(right)} of {len(right)} in the right order of magnitude")


if __name__ == "__main__":
    main()
