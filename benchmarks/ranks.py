"""Processes that share particles, against one and against threads, in turn, for any scene and spacing.

    python benchmarks/ranks.py [RANKS] [SCENE] [SPACING_MM ...]

The first steps of the 3-D dam break, or of a bed in 3-D (bubbling_bed_3d; the particles' side alone). Prints
particles, ms a step, efficiency (time of one process over that of N, over N), and the same of threads. Wants a machine
with nothing else on it. `sdph bench --ranks N` measures one spacing of each.
"""

import sys

from sdph.study.bench_ranks import step

TIMES = 3  # rounds, of which the best counts
SPACINGS = {"dam_break_3d": [6.0, 2.8575], "bubbling_bed_3d": [7.5, 5.0]}  # mm


def main(ranks: int, scene: str, spacings: list[float]) -> None:
    for spacing in spacings:
        best = {}
        for _ in range(TIMES):
            for who in ((1, 1), (ranks, 1), (1, ranks)):
                found = step(scene, spacing, *who)
                best[who] = min(best.get(who, found), found, key=lambda one: one[0])
        one, shared, threaded = (best[who][0] for who in ((1, 1), (ranks, 1), (1, ranks)))
        told = best[ranks, 1][1]
        of_ranks = f"{ranks} ranks {shared:.2f} ms, efficiency {one / shared / ranks:.2f}"
        of_threads = f"{ranks} threads {threaded:.2f} ms, {one / threaded / ranks:.2f}"
        halo = f"copies {told['halo_share']:.3f} of own, busiest {told['imbalance']:.3f} of the mean"
        print(f"{told['particles']} particles: one process {one:.2f} ms; {of_ranks}; {of_threads}; {halo}", flush=True)


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    chosen = given.get(2, "dam_break_3d")
    main(int(given.get(1, 2)), chosen, [float(one) for one in sys.argv[3:]] or SPACINGS[chosen])
