"""A band of spray that flies apart across a channel of hot gas: SDPH and OpenFOAM's droplet solver by cell size.

Droplets fill the middle of a channel, dry and hot gas both sides of it. Their speed across rises evenly from 0 in the
middle to EDGE: a fan, which is 2.8 times as wide at the end. Walls left and right, and outlets at the top and bottom
alike, let the gas not follow: the exact solution is that of `across`, in one dimension. Each code has equations of its
own there: OpenFOAM's diffusivity goes as T_film^1.75, and its vapour spreads with Sc = 1. Both codes have the same
cells and lattice of droplets, two to a cell; steps and windows go with the cell.

SDPH runs once more with a kernel that is one cell wide, so that a particle meets the gas as a parcel does: what that
changes is the kernel's share in the difference of the codes.
"""

from __future__ import annotations

import dataclasses
import math
from unittest import mock

import numpy as np
from scipy.spatial import cKDTree

from coupling.transfer import Transfer, Weights
from sdph.running import balances, driver, simulation
from sdph.study import compare
from sdph.study.compare import check

from . import across, plug

BAR = 0.01  # of the limit and of the width at every cell: that of the plug (issue 19); see README.md
CELLS = (25e-3, 12.5e-3, 6.25e-3, 3.125e-3)  # m: the band is 4, 8, 16, 32 cells wide, the jet's slot 10
WIDTH, HEIGHT, HALF = 0.05, 0.4, 0.05  # m, of the channel, its height, half of the band at the start
EDGE = 2.5  # m/s, of the outermost droplet
ALPHA_P = 10.0 * plug.ALPHA_P  # liquid of 20 times the gas's heat capacity: gas in the middle comes to it
WINDOW = 0.01  # s/m, of a window by the cell: 0.25 ms in the largest, the jet's
TIMES = (0.0125, 0.025, 0.0375, 0.05)  # s
ONSETS = {"always": plug.ONSET, "onset": 298.0}  # K: the middle of the band does not come to the second, as the jet
OWN, CELL, DROPS = "SDPH", "SDPH, kernel of one cell", "reactingParcelFoam"
MARKS = {OWN: "o", CELL: "x", DROPS: "s"}
SPREAD = {OWN: 0.0, CELL: 0.0, DROPS: 1.75}  # exponent of the diffusivity in the film


class OneCell(Transfer):
    """Weights of a particle in the cell alone that it is in."""

    def __init__(self, mesh, smoothing: float, box=(), corner=()):
        super().__init__(mesh, smoothing, box, corner)
        self.nearest = cKDTree(mesh.centres)  # of even cells

    def weights(self, positions) -> Weights:
        each, none = np.ones(len(positions), np.int64), np.zeros(0, np.int64)
        cells = self.nearest.query(positions)[1].reshape(-1, 1)
        return Weights(each, cells, np.ones(cells.shape), len(self.volumes), none)


def case(cell: float, onset: float = plug.ONSET):
    """The band as a case: a region for each row of the lattice, which has one speed."""
    spacing = 0.5 * cell
    own, middle = plug.case(True, "putnam", spacing), 0.5 * HEIGHT
    box = dataclasses.replace(own.particles["plug"], volume_fraction=ALPHA_P)
    rows = {}
    for k in range(round(2.0 * HALF / spacing)):
        low = middle - HALF + k * spacing
        speed = EDGE * (low + 0.5 * spacing - middle) / HALF
        rows[f"row{k}"] = dataclasses.replace(
            box, lower=(0.0, low), upper=(WIDTH, low + spacing), velocity=(0.0, speed)
        )
    outlet = own.boundaries["right"]
    sides = {side: dataclasses.replace(outlet, side=side) for side in ("top", "bottom")}
    return dataclasses.replace(
        own,
        particles=rows,
        boundaries={**sides, "walls": own.boundaries["walls"]},
        domain=dataclasses.replace(own.domain, size=(WIDTH, HEIGHT)),
        run=dataclasses.replace(own.run, output_interval=TIMES[0]),
        coupling=dataclasses.replace(own.coupling, window_largest=WINDOW * cell),
        parameters=own.parameters
        | {"evaporation": dataclasses.replace(own.parameters["evaporation"], onset_temperature=onset)},
    )


def traits(code: str, onset: float) -> across.Code:
    """Traits of a code in its equations: OpenFOAM's diffusivity is the case's in the film of a droplet at its start, or
    at the onset where that is hotter, and its vapour has Sc = 1 in the gas."""
    own = case(CELLS[0], onset)
    begins = max(onset, plug.TEMPERATURE)
    sc_one = own.gas.viscosity / own.gas.density
    return across.Code(
        SPREAD[code], (2.0 * begins + own.gas.temperature) / 3.0, sc_one if code == DROPS else own.vapour.diffusivity
    )


def exact(code: str, onset: float, fine: int = 1) -> list[across.Band]:
    """Bands of the equations of a code at TIMES."""
    return across.fly(case(CELLS[0], onset), traits(code, onset), HALF, EDGE, ALPHA_P, TIMES, fine)


def checks(folder, overrides, reporter) -> list[dict]:
    """Both codes, and SDPH with the narrow kernel, against the equations of each at every cell."""
    rows, drawn = [], {}
    for name, onset in ONSETS.items():
        bands = {code: exact(code, onset) for code in SPREAD}
        rows += of_equations(name, onset, bands)
        found = {}
        for code in SPREAD:
            for cell in CELLS:
                place = folder / f"{name}-{code}-{1e3 * cell:g}".replace(" ", "-").replace(",", "")
                found[code, cell], kept = run(code, cell, onset, place, reporter)
                rows += [row | {"name": f"{name}, {code}, {1e3 * cell:g} mm, balances: {row['name']}"} for row in kept]
            rows += against(f"{name}, {code}", onset, bands[code], [found[code, cell] for cell in CELLS])
        rows += between(name, found)
        drawn[name] = bands, found
    draw(drawn, folder / "spreading.png")
    return rows


def run(code: str, cell: float, onset: float, folder, reporter) -> tuple[list[dict], list[dict]]:
    """Values of `measured` at each of TIMES, and the balances of a run of ours."""
    own = case(cell, onset)
    if code == DROPS:
        from coupling.openfoam.comparators.run import run_droplets

        return told(run_droplets(own, folder, at_start(own)), own), []
    with mock.patch.object(simulation, "Transfer", OneCell if code == CELL else Transfer):
        driver.run(own, "evaporating_jet", folder, None, reporter)
    finished = compare.open_run(folder)
    return [ours(finished, time) for time in TIMES], closed(finished.summary, own)


def closed(summary: dict, own) -> list[dict]:
    """The balances; that of the momentum exchanged is not over its sum, which is 0 as the halves go apart, but over
    what one half has at the start."""
    rows, apart = balances.checks(summary), "exchange_momentum_mismatch"
    half = HALF * WIDTH * ALPHA_P * own.grains.density * 0.5 * EDGE
    for row in rows:
        if row["name"] == f"{apart}_rel":
            value = summary[f"{apart}_kg_m_s"] / half
            row |= {"value": value, "ok": abs(value) <= row["tolerance"]}
    return rows


def ours(finished, time: float) -> dict:
    """`measured` of a run of SDPH at `time` [s]."""
    _, particles, gas = finished.fields(time)
    return measured(
        np.asarray(particles.points)[:, 1], np.asarray(particles["mass"]),
        np.asarray(gas.cell_centers().points)[:, 1], np.asarray(gas.cell_data["vapour_mass_fraction"]), finished.case,
    )  # fmt: skip


def told(reference, own) -> list[dict]:
    """The same of the droplet solver at TIMES."""
    found = []
    for time in TIMES:
        drops = reference.parcels[min(reference.parcels, key=lambda t, time=time: abs(t - time))]
        mass = drops["count"] * drops["density"] * math.pi / 6.0 * drops["diameter"] ** 3
        fields = reference.fields[reference.nearest(time)]
        fraction = fields["vapour_mass_fraction"]
        found.append(measured(drops["position"][:, 1], mass, reference.centres[:, 1], fraction, own))
    return found


def at_start(own):
    """Droplets of the case at the start: its rows, on its lattice."""
    from coupling.openfoam.comparators.droplet_sources import Drops

    dx = own.resolution.spacing
    along = np.arange(0.5 * dx, WIDTH, dx)
    place = np.array([(x, row.lower[1] + 0.5 * dx) for row in own.particles.values() for x in along])
    velocity = np.array([row.velocity for row in own.particles.values() for _ in along])
    each = np.ones(len(place))
    mass = ALPHA_P * own.grains.density * dx**2 * each
    return Drops(place, velocity, plug.TEMPERATURE * each, mass, own.grains.diameter * each, 0.0 * each)


def measured(place, mass, centres, fraction, own) -> dict:
    """Share of the liquid that evaporated [-], width (root mean square of the place, by mass) over that of the lattice
    at the start, and mass fraction of vapour by the cell across (C,), both halves alike; of droplets (N,) and cells
    (C,)."""
    away = np.asarray(place) - 0.5 * HEIGHT
    lattice = np.arange(0.5 * own.resolution.spacing, HALF, own.resolution.spacing)
    begun = 2.0 * HALF * WIDTH * ALPHA_P * own.grains.density
    cells = np.floor(np.abs(centres - 0.5 * HEIGHT) / own.resolution.cell).astype(int)
    return {
        "evaporated": 1.0 - float(mass.sum()) / begun,
        "width": across.width(away, mass) / across.width(lattice, 1.0 + 0.0 * lattice),
        "vapour": np.bincount(cells, fraction) / np.bincount(cells),
    }


def grown(band: across.Band) -> float:
    """Width of a band of the equations over that at the start."""
    return across.width(band.place, band.square**1.5) / (HALF / math.sqrt(3.0))


def by_cells(band: across.Band, number: int) -> np.ndarray:
    """Mass fraction of vapour of the equations, (number,) means over as many cells of half the channel."""
    return band.fraction.reshape(number, -1).mean(axis=1)


def apart(found: dict, band: across.Band) -> float:
    """Mean distance of the profiles of vapour over the mean of the equations'."""
    known = by_cells(band, len(found["vapour"]))
    return float(np.abs(found["vapour"] - known).sum() / known.sum())


def of_equations(name: str, onset: float, bands: dict) -> list[dict]:
    """Half the cells and steps change the equations by a tenth of the bar at most; what their traits do is told."""
    fine, codes = across.evaporated, (OWN, DROPS)
    own = case(CELLS[0], onset)
    ends = {code: fine(own, bands[code][-1]) for code in codes}
    rows = [
        check(f"{name}, equations of {code}: evaporated with half the cells", fine(own, exact(code, onset, 2)[-1]),
              ends[code], 0.1 * BAR, True) for code in codes
    ]  # fmt: skip
    what = f"{name}: equations of reactingParcelFoam against SDPH's, evaporated, reported"
    return [*rows, check(what, ends[DROPS], ends[OWN], math.inf)]


def against(name: str, onset: float, bands, found) -> list[dict]:
    """Checks of a code at CELLS: limit of what evaporated, width; by cell and by time what is off, reported."""
    rows, own = [], case(CELLS[0], onset)
    known = across.evaporated(own, bands[-1])
    ends = [each[-1] for each in found]
    for cell, end in zip(CELLS, ends):
        what = f"{name}, {1e3 * cell:g} mm"
        rows.append(check(f"{what}: width over that at the start", end["width"], grown(bands[-1]), BAR, True))
        rows.append(check(f"{what}: evaporated, reported", end["evaporated"], known, math.inf))
        rows.append(check(f"{what}: vapour across, mean distance, reported", apart(end, bands[-1]), 0.0, math.inf))
    for time, band, now in zip(TIMES[:-1], bands, found[-1]):
        what = f"{name}, {1e3 * CELLS[-1]:g} mm, {1e3 * time:g} ms: evaporated, reported"
        rows.append(check(what, now["evaporated"], across.evaporated(own, band), math.inf))
    order, limit = towards([end["evaporated"] for end in ends])
    rows.append(check(f"{name}: order of what evaporated, reported", order, 1.0, math.inf))
    return [*rows, check(f"{name}: evaporated, limit of the cells", limit, known, BAR, True)]


def towards(values) -> tuple[float, float]:
    """Order and limit of the last three values at cells of which each is half the one before; nan where they do not
    close in."""
    coarse, middle, fine = values[-3:]
    ratio = (coarse - middle) / (middle - fine) if middle != fine else 0.0
    if ratio <= 1.0:
        return math.nan, math.nan
    return math.log2(ratio), fine + (fine - middle) / (ratio - 1.0)


def between(name: str, found: dict) -> list[dict]:
    """Evaporated share of one code against another, and of SDPH against itself with the narrow kernel: reported."""
    pairs = ((OWN, DROPS), (OWN, CELL), (CELL, DROPS))
    return [
        check(f"{name}, {1e3 * cell:g} mm: {one} against {other}, reported",
              found[one, cell][-1]["evaporated"], found[other, cell][-1]["evaporated"], math.inf)
        for cell in CELLS for one, other in pairs
    ]  # fmt: skip


def draw(drawn: dict, file) -> None:
    """Profiles of vapour at the end with the finest cells, and by how much what evaporated is off by cell."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, len(drawn), figsize=(5.5 * len(drawn), 7.0), constrained_layout=True)
    for (name, (bands, found)), (above, below) in zip(drawn.items(), axes.T):
        own = case(CELLS[0])
        for code, mark in MARKS.items():
            fraction = found[code, CELLS[-1]][-1]["vapour"]
            across_m = (np.arange(len(fraction)) + 0.5) * CELLS[-1]
            above.plot(across_m, fraction, mark, label=code)
            known = across.evaporated(own, bands[code][-1])
            off = [100.0 * abs(found[code, cell][-1]["evaporated"] / known - 1.0) for cell in CELLS]
            below.loglog([1e3 * cell for cell in CELLS], off, f"{mark}-", label=code)
        for code, line in ((OWN, "k-"), (DROPS, "k:")):
            fine = bands[code][-1].fraction
            above.plot((np.arange(len(fine)) + 0.5) * across.CELL, fine, line, label=f"equations of {code}")
        above.set(title=name, xlabel="from the middle [m]", ylabel="mass fraction of vapour")
        below.set(xlabel="cell [mm]", ylabel="evaporated, off its equations [%]")
        above.legend(fontsize=7)
    figure.savefig(file, dpi=80)
    pyplot.close(figure)
