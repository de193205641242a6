"""Heat from a tube to a fluidised bed: Nusselt numbers of the scene bed_with_tube with a hot tube, from runs with the
effect `wall_heat`.

What the walls of the gas give it is not in them: the flow beside the tube is not resolved. So they are the part of the
grains, most of the whole for beads of 0.5 mm. Two velocities were settled before any was run: that of minimum
fluidisation, and that of the scene.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from coupling.openfoam.programs import installation
from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import wall_heat
from sdph.laws import exact
from sdph.laws import wall_heat as law
from sdph.running import driver
from sdph.study import beds, compare

from . import measured

BAR = 0.25  # of Nu: proposed with the data of Zhang et al.; that of Grewal & Saxena about their data too
SCENE, TUBE, BRIDGED = "bed_with_tube", 0.04, 2.6  # name; m, diameter; C_K of Martin's law
RISE, END = 50.0, 2.0  # K of the tube over the bed; s, twice the scene's: means over the last 1.2 s. Our choices


def checks(folder: Path, overrides=(), reporter=None, end: float = END) -> list[dict]:
    """Nusselt numbers of both velocities against what is known of them; none without OpenFOAM, which is told."""
    if installation.find() is None:
        if reporter:
            reporter.status("the hot tube is left out: it needs OpenFOAM; get it with: sdph openfoam setup --install")
        return []
    onset = run(None, folder / "hot-tube-onset", overrides, reporter, end)
    blown = run(0.45, folder / "hot-tube-blown", overrides, reporter, end)
    rows = measured.table("zhang_2014")
    _figure(folder / "hot_tube.png", rows, onset, blown)
    ours = {"minimum fluidisation": onset, "2.1 times that": blown}
    at = {name: number(own) for name, own in ours.items()}
    known = {
        ("minimum fluidisation", "Zhang et al."): known_at_onset(rows, onset.case),
        ("2.1 times that", "a single tube, Grewal & Saxena"): grewal_saxena(blown.case, 0.45, inside(blown)),
        ("2.1 times that", "part of the grains, Martin"): martin(blown.case, inside(blown)),
    }
    return [
        compare.check(f"hot tube at {name}, {whose}: Nu [-]", at[name], reference, BAR, True)
        for (name, whose), reference in known.items()
    ]


def run(speed: float | None, folder: Path, overrides, reporter, end: float, gas_folder: Path | None = None):
    """The scene with a hot tube and gas of a superficial velocity [m/s]; None: that of minimum fluidisation. Its gas
    case is that of the scene, or another one of a folder."""
    case = cases.load(scenes.find(SCENE)[1])
    speed = speed or at_onset(case)
    own = [*case.effects, "conduction", "wall_heat"]
    hot = case.gas.temperature + RISE
    given = (
        f"effects={own!r}", "conduction.law='zehner_schluender'", f"boundaries.tube.temperature_K={hot!r}",
        f"boundaries.inlet.velocity_m_s=[0.0,{speed!r}]", f"run.end_time_s={end!r}", "coupling.gas='openfoam'",
    )  # fmt: skip
    driver.run(cases.load(scenes.find(SCENE)[1], (*overrides, *given)), SCENE, folder, gas_folder, reporter)
    return compare.open_run(folder)


def at_onset(case) -> float:
    """U_mf [m/s] by Ergun, at the alpha_p at which friction lets a bed lie."""
    grains, gas = case.grains, case.gas
    return exact.minimum_fluidisation(
        beds.AT_ONSET, grains.density, math.hypot(*case.domain.gravity), grains.diameter, gas.density, gas.viscosity
    )


def number(run) -> float:
    """Nu [-] = h d/k_g of the tube, h the mean heat per area and kelvin; over the last three fifths, as for beds."""
    return coefficient(run) * run.case.grains.diameter / run.case.gas.conductivity


def coefficient(run) -> float:
    """h [W/(m2 K)] of the tube."""
    time, heat = run.ledger["time_s"], run.ledger["heat_of_walls_J"]
    begun = beds.LATE * run.case.run.end_time
    late = time > begun
    return float(heat[late].sum()) / (time[-1] - time[~late][-1]) / run.summary["tube_area_m2"] / RISE


def inside(run) -> float:
    """Mean alpha_p of the bed."""
    return float(beds.late(run, "alpha_p_inside").mean())


def archimedes(case) -> float:
    grains, gas = case.grains, case.gas
    return 9.81 * gas.density * (grains.density - gas.density) * grains.diameter**3 / gas.viscosity**2


def known_at_onset(rows, case) -> float:
    """Nu of Zhang et al. 2014 at the Archimedes number of a case: a power, straight between their logarithms."""
    return math.exp(np.interp(math.log(archimedes(case)), np.log(rows["Ar"]), np.log(rows["Nu_mf"])))


def grewal_saxena(case, speed: float, alpha_p: float) -> float:
    """Nu of beads by Nu_D = 47 alpha_p (U D mu/(d^3 rho_p g))^0.325 Pr^0.3 (rho_p c_p D^1.5 g^0.5/k_g)^0.23.

    Grewal & Saxena 1980, Int. J. Heat Mass Transfer 23, 1505, a horizontal tube; of a staggered array Grewal 1981,
    Powder Technol. 30, 145, has 1 - 0.21 (pitch/D)^-1.75 of it.
    """
    grains, gas, g = case.grains, case.gas, 9.81
    flow = speed * TUBE * gas.viscosity / (grains.diameter**3 * grains.density * g)
    prandtl = gas.viscosity * gas.heat_capacity / gas.conductivity
    stored = grains.density * grains.heat_capacity * TUBE**1.5 * math.sqrt(g) / gas.conductivity
    return 47.0 * alpha_p * flow**0.325 * prandtl**0.3 * stored**0.23 * grains.diameter / TUBE


def martin(case, alpha_p: float) -> float:
    """Nu of what grains carry: alpha_p Z (1 - exp(-N)), N = Nu_wp/(2.6 Z), Martin 2010, VDI Heat Atlas, p. 1301.

    Z = rho_p c_p/(6 k_g) sqrt(g d^3 (eps - eps_mf)/(5 (1 - eps_mf) alpha_p)), eps_mf that of the onset of contacts.
    """
    grains, gas = case.grains, case.gas
    room = (beds.AT_ONSET - alpha_p) / (5.0 * beds.AT_ONSET * alpha_p)
    carried = grains.density * grains.heat_capacity / (6.0 * gas.conductivity)
    carried *= math.sqrt(9.81 * grains.diameter**3 * room)
    wedge = law.schluender(grains.diameter, gas.conductivity, wall_heat.kernel(case).gap)
    wedge *= grains.diameter / gas.conductivity
    behind = gas.conductivity / grains.conductivity
    held = behind / (4.0 * (1.0 + math.sqrt(1.5 * BRIDGED * behind * carried / math.pi)))
    return alpha_p * carried * -math.expm1(-1.0 / (1.0 / wedge + held) / (BRIDGED * carried))


def _figure(file: Path, rows, onset, blown) -> None:
    ar = archimedes(onset.case)
    with measured.figure(file, "time [s]", "Nu of the tube, grains' part [-]") as axes:
        for name, own, colour in (("minimum fluidisation", onset, "C0"), ("0.45 m/s", blown, "C1")):
            axes.plot(*course(own), "-", c=colour, lw=1, label=f"SDPH, {name}")
            axes.axhline(number(own), c=colour, ls="--", lw=1)
        axes.axhline(known_at_onset(rows, onset.case), c="k", ls=":", label=f"Zhang et al. at the onset, Ar = {ar:.0f}")
        gathered = inside(blown)
        axes.axhline(grewal_saxena(blown.case, 0.45, gathered), c="k", ls="--", label="Grewal & Saxena, 0.45 m/s")
        axes.axhline(martin(blown.case, gathered), c="k", ls="-.", label="Martin, grains' part, 0.45 m/s")
        axes.set_ylim(0.0, None)


def course(run, step: float = 0.05) -> np.ndarray:
    """Times [s] and Nu, means of `step` [s]."""
    time, heat = run.ledger["time_s"], np.cumsum(run.ledger["heat_of_walls_J"])
    ends = np.arange(step, run.case.run.end_time + 0.5 * step, step)
    mean = np.diff(np.interp(np.append(0.0, ends), time, heat)) / step / run.summary["tube_area_m2"] / RISE
    return np.array([ends - 0.5 * step, mean * run.case.grains.diameter / run.case.gas.conductivity])
