"""Eddies of WALE in a channel with cyclic ends and sides, by both solvers, beside direct simulation at Re_tau = 178.

The flow rate is that of the direct simulation. Seen from a frame that goes along with the gas: both solvers step by
Euler, which smears by U^2 dt/2 along the flow, more than the gas's own viscosity where U is that of a channel at rest.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from coupling.openfoam import fields
from coupling.openfoam.start_fields import CYCLIC
from sdph.study.compare import check

from . import stock

DNS = Path(__file__).with_name("moser_1999.csv")  # in u_tau and h, Re_tau = 178.12
REYNOLDS, BULK = 178.12, 15.68  # u_tau HALF/nu there, and bulk velocity over u_tau (its profile, trapezoidal)
HALF, FRICTION = 1.0, 1.0  # m: half height; m/s: u_tau of the direct simulation
LONG, WIDE = np.pi * HALF, 0.5 * np.pi * HALF  # m
CELLS, GROWTH = (16, 32, 24), 6.0  # along x, y and z; the widest cell over the one at a wall
VISCOSITY = stock.DENSITY * FRICTION * HALF / REYNOLDS  # Pa s
FRAME = 12.0 * FRICTION  # m/s: about as fast as eddies go between walls and middle; our choice
STEP = 0.002  # s: FRAME's U^2 dt/2 is below the gas's viscosity where eddies are made; Courant number 0.2
SETTLED, UNTIL = 4.0, 12.0  # s, HALF/FRICTION: start's waves are gone after 2 to 3; then 8 turnovers, in two halves
WAVES = 2.5 * FRICTION  # m/s, rms of the start's
SAME, RUBBED, STIRRED = 0.05, 0.15, 0.2  # of the largest velocity, of friction, of the largest rms: our choice
ROUND = {"left": "right", "right": "left", "front": "back", "back": "front"}
BOUNDARIES = {
    name: {"kind": "wall", "side": side, "velocity_m_s": [-FRAME, 0.0, 0.0]}
    for name, side in (("floor", "bottom"), ("lid", "top"))
}
FACES = {
    "left": "0 4 6 2", "right": "1 3 7 5", "floor": "0 1 5 4", "lid": "2 6 7 3", "front": "0 2 3 1", "back": "4 5 7 6",
}  # fmt: skip
CENTRAL = "Gauss linear"
SOLUTION = "PIMPLE { nCorrectors 2; momentumPredictor yes; pRefCell 0; pRefValue 0; }\n"
HELD = """held { type meanVelocityForce; active yes; selectionMode all; fields (U); Ubar (%r 0 0); relaxation 1; }
"""
AVERAGES = """functions { means { type fieldAverage; libs ("libfieldFunctionObjects.so"); writeControl writeTime;
periodicRestart true; restartPeriod %r; fields ( U { mean on; prime2Mean on; base time; } ); } }
"""


class Moments(NamedTuple):
    """Means over time and planes: height (N,) [m] over a wall, velocity along (S, N) [m/s] and, about means, products
    (S, N, 4) [m2/s2] uu, vv, ww and uv, of S samples: two halves of the time at each of two walls."""

    height: np.ndarray
    velocity: np.ndarray
    products: np.ndarray

    @property
    def mean(self) -> np.ndarray:
        """(N,) [m/s]."""
        return self.velocity.mean(axis=0)

    @property
    def rms(self) -> np.ndarray:
        """(N, 3) [m/s], and the shear -uv (N,) [m2/s2] as a last column."""
        found = self.products.mean(axis=0)
        return np.column_stack([np.sqrt(found[:, :3]), -found[:, 3]])

    @property
    def scatter(self) -> np.ndarray:
        """(N,) [m/s] standard error of `mean`, as samples scatter."""
        return self.velocity.std(axis=0, ddof=1) / np.sqrt(len(self.velocity))

    @property
    def friction(self) -> np.ndarray:
        """(S,) u_tau^2 [m2/s2] of samples, by the velocity nearest to the wall."""
        return VISCOSITY / stock.DENSITY * self.velocity[:, 0] / self.height[0]


def blocks(cells=CELLS) -> str:
    """blockMeshDict of the channel, less its head."""
    corners = [(x, y, z) for z in (0.0, WIDE) for y in (0.0, 2.0 * HALF) for x in (0.0, LONG)]
    vertices = " ".join(f"({x!r} {y!r} {z!r})" for x, y, z in corners)
    kinds = {name: f"cyclic; neighbourPatch {ROUND[name]}" if name in ROUND else "wall" for name in FACES}
    sides = "".join(f"{name} {{ type {kinds[name]}; faces (({face})); }}\n" for name, face in FACES.items())
    growth = f"(1 ((0.5 0.5 {GROWTH!r}) (0.5 0.5 {1.0 / GROWTH!r})) 1)"
    block = f"hex (0 1 3 2 4 5 7 6) ({' '.join(map(str, cells))}) simpleGrading {growth}"
    return f"scale 1;\nvertices ({vertices});\nblocks ({block});\nedges ();\nboundary\n(\n{sides});\n"


def centres(cells=CELLS) -> np.ndarray:
    """Centres (C, 3) [m] of the cells, x running fastest, then y."""
    long, high, wide = cells
    half = np.cumsum(GROWTH ** (np.arange(high // 2) / (high // 2 - 1)))
    edges = np.concatenate(([0.0], half / half[-1]))
    low = 0.5 * HALF * (edges[1:] + edges[:-1])
    z, y, x = np.meshgrid(
        (np.arange(wide) + 0.5) * WIDE / wide, np.concatenate((low, 2.0 * HALF - low[::-1])),
        (np.arange(long) + 0.5) * LONG / long, indexing="ij",
    )  # fmt: skip
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)


def start(places: np.ndarray) -> np.ndarray:
    """Velocity (C, 3) [m/s], seen from the frame: Reichardt's mean (1951), and the curl of random waves that have no
    speed on the walls."""
    eta, near = places[:, 1] / HALF - 1.0, REYNOLDS * (1.0 - np.abs(places[:, 1] / HALF - 1.0))
    mean = 2.5 * np.log1p(0.4 * near) + 7.8 * (1.0 - np.exp(-near / 11.0) - near / 11.0 * np.exp(-0.33 * near))
    chance, found = np.random.default_rng(0), np.zeros((3, len(places)))
    for k, m, n in [(k, m, n) for k in range(3) for n in range(4) for m in range(3) if k or n]:
        a, b, turn = 2.0 * np.pi * k / LONG, 2.0 * np.pi * n / WIDE, 0.5 * np.pi * m
        across, steep = (1.0 - eta**2) ** 2, -4.0 * eta * (1.0 - eta**2)
        c, s = np.cos(turn * eta + 1.0), np.sin(turn * eta + 1.0)
        across, steep = across * c, (steep * c - across * turn * s) / HALF
        phase = a * places[:, 0] + b * places[:, 2] + chance.uniform(0.0, 2.0 * np.pi)
        x, y, z = chance.normal(size=3)  # of a vector potential (x, y, z) across cos(phase)
        c, s = np.cos(phase), np.sin(phase)
        found += [z * steep * c + y * b * across * s, (z * a - x * b) * across * s, -y * a * across * s - x * steep * c]
    found *= WAVES / np.sqrt((found**2).mean())
    found[0] += FRICTION * mean - FRAME
    return found.T.copy()


def moments(places: np.ndarray, means: list[tuple[np.ndarray, np.ndarray]]) -> Moments:
    """Moments of halves of the time: mean (C, 3) [m/s], seen from the frame, and mean products (C, 4) [m2/s2]."""
    heights, number = np.unique(np.round(places[:, 1], 6), return_inverse=True)
    velocity, products, half = [], [], len(heights) // 2
    for own in means:
        mean, square = (np.stack([np.bincount(number, of) for of in one.T], 1) for one in own)
        mean, square = (one / np.bincount(number)[:, None] for one in (mean, square))
        square -= product(mean)
        velocity += [mean[:half, 0] + FRAME, mean[: half - 1 : -1, 0] + FRAME]
        products += [square[:half], square[: half - 1 : -1] * [1.0, 1.0, 1.0, -1.0]]
    return Moments(heights[:half], np.array(velocity), np.array(products))


def product(velocity: np.ndarray) -> np.ndarray:
    """(C, 4) [m2/s2] uu, vv, ww and uv of a velocity (C, 3) [m/s]."""
    return np.column_stack([velocity**2, velocity[:, 0] * velocity[:, 1]])


def case(cells=CELLS):
    """The channel as a case, and its mesh."""
    own = stock.case((LONG, 2.0 * HALF, WIDE), LONG / cells[0], BOUNDARIES, {"model": "WALE"}, VISCOSITY)
    return own, stock.Mesh(blocks(cells), dict.fromkeys(ROUND, CYCLIC), CENTRAL)


def ours(gas, settled: float, until: float, told=lambda line: None) -> Moments:
    """Moments of a gas that begins, pulled so that its flow rate stays."""
    gas.start(None, ("momentum",))
    pull, share, bulk = np.zeros_like(gas.mesh.centres), gas.mesh.volumes / gas.mesh.volumes.sum(), None
    first, last = round(settled / STEP), round(until / STEP)
    sums = [[np.zeros_like(pull), np.zeros((len(pull), 4))] for _ in range(2)]
    pull[:, 0], half = stock.DENSITY * FRICTION**2 / HALF, (last - first) // 2
    for step in range(last):
        velocity = gas.advance(STEP, {"momentum": pull}).fields["velocity"]
        before, bulk = bulk, float(share @ velocity[:, 0]) + FRAME
        lost = 0.0 if before is None else (before - bulk) / STEP  # m/s2, that it was pulled too little by
        pull[:, 0] += stock.DENSITY * (lost + (BULK * FRICTION - bulk) / STEP)
        if step >= first:
            own = sums[min((step - first) // half, 1)]
            own[0] += velocity / half
            own[1] += product(velocity) / half
        if step % 500 == 499:
            told(f"{(step + 1) * STEP:.1f} s, pulled by {pull[0, 0] / stock.DENSITY:.2f} m/s2")
    return moments(gas.mesh.centres, sums)


def theirs(gas, own, folder: Path, settled: float, until: float) -> Moments:
    """Moments of pimpleFoam's. `settled` is some halves of the rest of the time, over each of which means are taken:
    they begin anew a quarter of a step behind what is written, as round-off would let them begin before."""
    steps, period = round(until / STEP), 0.5 * (until - settled)
    control = stock.CONTROL.format(end=until, dt=STEP, steps=round(period / STEP)) + AVERAGES % (period + 0.25 * STEP)
    stock.pimple(gas, own, folder, STEP, steps, more={
        "system/controlDict": control, "constant/fvOptions": HELD % (BULK * FRICTION - FRAME),
        "system/fvSchemes": stock.convecting(stock.SCHEMES, CENTRAL),
        "system/fvSolution": stock.SOLVERS.replace("1e-15", "1e-9") + SOLUTION,
    })  # fmt: skip
    count, found = len(gas.mesh.volumes), []
    for _, place in fields.times(folder)[-2:]:
        mean, spread = fields.read(place / "UMean", count), fields.read(place / "UPrime2Mean", count)
        xx, xy, _, yy, _, zz = spread.T
        both = np.stack([xx, yy, zz, xy], axis=1)
        found.append((mean, both + product(mean)))
    return moments(gas.mesh.centres, found)


def both(folder: Path, cells=CELLS, settled=SETTLED, until=UNTIL, told=lambda line: None) -> tuple[Moments, Moments]:
    """Moments of ours and of pimpleFoam's."""
    own, mesh = case(cells)
    with stock.started(own, folder, {"U": start(centres(cells))}, mesh=mesh) as gas:
        assert np.abs(gas.mesh.centres - centres(cells)).max() < 1e-6 * HALF
        found = ours(gas, settled, until, told)
        return found, theirs(gas, own, folder / "stock", settled, until)


def checks(folder: Path, _=(), reporter=None) -> list[dict]:
    """Checks of our means against pimpleFoam's."""
    found, stocks = both(folder / "eddies")
    _figure(folder / "eddies.png", found, stocks)
    off = stock.furthest(found.mean, stocks.mean)
    rubbed = found.friction.mean() / stocks.friction.mean()
    stirred = found.rms[:, 0].max() / stocks.rms[:, 0].max()
    return [
        check("WALE, mean velocity of eddies off pimpleFoam's, furthest over the largest", off, 0.0, SAME),
        check("WALE, friction of eddies over pimpleFoam's", rubbed, 1.0, RUBBED),
        check("WALE, largest rms along of eddies over pimpleFoam's", stirred, 1.0, STIRRED),
    ]


def _figure(path: Path, found: Moments, stocks: Moments) -> None:
    """Mean velocity, rms and shear against height, beside direct simulation."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    dns = np.genfromtxt(DNS, delimiter=",", names=True, skip_header=3)  # behind where it is from
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    for own, style, name in ((found, "o-", "sdphGasFoam"), (stocks, "x--", "pimpleFoam")):
        left.errorbar(own.height * REYNOLDS, own.mean, own.scatter, fmt=style, ms=4, label=name)
        for column, colour in enumerate(("C0", "C1", "C2", "C3")):
            right.plot(own.height, own.rms[:, column], style, color=colour, ms=3)
    left.plot(dns["y"] * REYNOLDS, dns["velocity"], "k.", label="direct simulation")
    squares = [np.sqrt(dns["uu"]), np.sqrt(dns["vv"]), np.sqrt(dns["ww"]), -dns["uv"]]
    for values, colour, name in zip(squares, ("C0", "C1", "C2", "C3"), ("u rms", "v rms", "w rms", "-uv")):
        right.plot(dns["y"], values, "s", color=colour, mfc="none", ms=5, label=f"{name}, direct simulation")
    left.set(xscale="log", xlabel="height [nu/u_tau of the direct simulation]", ylabel="mean velocity [u_tau, of it]")
    right.set(xlabel="height [h]", ylabel="rms [u_tau], shear [u_tau^2]")
    for axis in (left, right):
        axis.legend()
    figure.savefig(path, dpi=80)
    pyplot.close(figure)
