"""Changes of the base case against the other reduced model: when and at what pressure, and the D/D_0 of the tear."""

from __future__ import annotations

from pathlib import Path

from sdph.study.compare import check
from sdph.study.gel_droplet.course import draw

from . import runs

BAR, NECK = 0.05, 0.06  # of gel_reference.json; particles with a flaw of finite width tear 3-10 % later
# name -> overrides, time of D/D_0 = 1.4 [s], largest pressure [Pa]
CHANGES = {
    "flux x2": (("heating.flux_W_m2=2.84e5",), 0.4996156034, 155713.168),
    "flux x0.5": (("heating.flux_W_m2=7.1e4",), 1.223565724, 145091.752),
    "C 0": (("shell.rate_factor=0",), 0.5201125452, 62069.9948),
    "A, B x2": (("shell.yield_stress_Pa=9.8e5", "shell.hardening_Pa=1.614e6"), 0.949360366, 256754.18),
    "bubble 0.4 mm": (("droplet.bubble_diameter_mm=0.4",), 0.6600569947, 150828.523),
    "heat inside": (("heating.place=inside",), 0.5258813064, 147053.072),
    "sphere": (
        ("droplet.dimensions=3", "droplet.shell_thickness_um=33.6", "heating.flux_W_m2=1e5"), 0.757, 184e3,
    ),
}  # fmt: skip
FLAWS = {0.05: 1.4707236843, 0.07: 1.3891676979, 0.1: 1.3065911455, 0.15: 1.2186588909}  # share -> D/D_0 of the tear
BRITTLE = 0.357325442851211  # D2 with which an even ring tears at 1.4


def checks(folder: Path, overrides=(), reporter=None) -> list[dict]:
    """All changes; draws them."""
    found = {name: runs.course(runs.EVEN, *own) for name, (own, _, _) in CHANGES.items()}
    flawed = {flaw: runs.course(f"shell.flaw={flaw}") for flaw in FLAWS}
    brittle = runs.course(runs.EVEN, f"shell.failure=[0.00705, {BRITTLE}, -0.054, -0.0123]")
    pictured = {f"flaw {flaw:g}": one for flaw, one in flawed.items()}
    draw(pictured | {name: runs.course(*own) for name, (own, _, _) in CHANGES.items()}, folder / "changes.png")
    compared = []
    for name, (_, time, most) in CHANGES.items():
        compared.append(check(f"{name}: time of D/D_0 = 1.4 [s]", runs.time_at(found[name], 1.4), time, BAR, True))
        compared.append(
            check(f"{name}: largest pressure [Pa]", found[name].summary["pressure_max_Pa"], most, BAR, True)
        )
    compared += [
        check(f"flaw of {flaw:g}: D/D_0 of the tear", flawed[flaw].summary["rupture_diameter_ratio"], ratio, NECK, True)
        for flaw, ratio in FLAWS.items()
    ]
    own = brittle.summary["rupture_diameter_ratio"]
    return [*compared, check(f"D2 = {BRITTLE:.4f}, even: D/D_0 of the tear", own, 1.4, BAR, True)]
