"""Model of many processes, from what was counted and measured on few: `python benchmarks/scaling.py`.

A rank of n particles in a cube has (s + 2 R)^3 - s^3 copies, s = n^(1/3) spacings, R the reach of its rows. A step
takes

    n t (1 + COPY copies/n) + neighbours LATENCY + bytes/BANDWIDTH + sums 2 log2(P) LATENCY + rows/EVERY,

t the time of a particle's step on one core; rows made anew cost a gather of all boxes and a message to everybody. With
a gas all ranks add up their cells (one allreduce each way a window); the first one has the solver, which is left out.
"""

import math

PARTICLE = {"liquid": 1.74e-6, "grains": 3.2e-6}  # s of a step on one core, 3-D (README.md: liquid 1e5, bed of 80 000)
COPY = 2.1  # work of a copy over that of a particle: fitted to two ranks (README.md), waits and messages there in it
REACH = {"liquid": 3.3, "grains": 6.6}  # spacings within which copies are made, skin in it; of grains twice, for walls
NEIGHBOURS, REFRESHES, BYTES = (
    26,
    4,
    189,
)  # ranks beside one in a cube; a step: messages to each, bytes a copy (counted)
REDUCTIONS, EVERY = 6, 25  # over all ranks a step; steps that rows last (counted in the 3-D dam break)
LATENCY, BANDWIDTH = 1.5e-6, 12.5e9  # s, B/s: InfiniBand EDR, as assumed; nothing was run on a cluster
BOX, PACKED, UNPACKED = 48, 600, 8e-6  # B of a box, B of the state of a copy, s to read what one rank says (measured)
CELL, SUB_STEPS = 12 * 8, 4  # B of a cell's fields each way; sub-steps of a window of the bed
PARTICLES_A_CELL = 8  # in 3-D, cells of two spacings


def step(kind: str, n: float, ranks: int) -> float:
    """Time [s] of a step of a rank of n particles among so many."""
    spacings = n ** (1.0 / 3.0)
    copies = (spacings + 2.0 * REACH[kind]) ** 3 - n if ranks > 1 else 0.0
    halo = NEIGHBOURS * REFRESHES * LATENCY + copies * BYTES / BANDWIDTH
    sums = REDUCTIONS * 2.0 * math.log2(ranks) * LATENCY
    rows = ranks * (BOX / BANDWIDTH + UNPACKED + LATENCY) + copies * PACKED / BANDWIDTH
    return n * PARTICLE[kind] + PARTICLE[kind] * COPY * copies + (ranks > 1) * (halo + sums + rows / EVERY)


def cells(n: float, ranks: int) -> float:
    """Time [s] a sub-step of the sums over all cells of a gas, both ways."""
    return (ranks > 1) * 2.0 * CELL * n * ranks / PARTICLES_A_CELL / BANDWIDTH / SUB_STEPS


def main() -> None:
    heads = "particles a rank", "ranks", "particles", "liquid, over one rank", "over 64 ranks", "grains, over one rank"
    print(f"| {' | '.join(heads)} |")
    print("|--|--|--|--|--|--|")
    for n in (1e5, 1e6, 1e7):
        for ranks in (64, 256, 1024, 4096, 16384):
            alone, liquid, grains = step("liquid", n, 1), step("liquid", n, ranks), step("grains", n, ranks)
            shares = alone / liquid, step("liquid", n, 64) / liquid, step("grains", n, 1) / (grains + cells(n, ranks))
            print(f"| {n:.0e} | {ranks} | {n * ranks:.1e} | " + " | ".join(f"{share:.2f}" for share in shares) + " |")


if __name__ == "__main__":
    main()
