"""A gel droplet with three bubbles against one with the large bubble alone, heated inside and on the rim: when it
tears, which bubble grows, what closes (gel-droplet.md, section 6)."""

from __future__ import annotations

from sdph.study.compare import check
from sdph.study.gel_droplet.checks import TIME, at_tear, closure, place, reduced, size

VARIANTS = {"gel_droplet_three": ((), ["exact"]), "on the rim": (("liquid_heat.heated='rim'",), ["exact"])}
SOONER = {"inside": 0.89, "rim": 0.83}  # time of the tear over that of one bubble, frozen places
WIDE, WIDTH = (0.68e-3, 0.60e-3, 0.56e-3), 0.05  # m, at the tear, heated inside; our bar
APART = 100.0  # Pa between bubbles; our bar: within a factor of two


def exact(run) -> list[dict]:
    return [*(tear(run) if run.summary["torn"] else [check("torn", 0, 1, 0)]), *bubbles(run), *closure(run)]


def tear(run) -> list[dict]:
    """Checks of time, size and place of the tear."""
    alone = reduced(run.case).summary["rupture_time_s"]
    sooner = SOONER[run.case.parameters["liquid_heat"].heated]
    ratio = run.summary["rupture_time_s"] / alone
    return [check("time of the tear over that of one bubble", ratio, sooner, TIME, True), size(run), place(run)]


def bubbles(run) -> list[dict]:
    """Checks of which bubbles grow: all of them, the large one most, or one while the others vanish."""
    if run.case.parameters["liquid_heat"].heated == "rim":
        return [check("bubbles left", run.summary["bubbles_left"], 1, 0)]
    numbers = range(1, len(run.case.parameters["bubble"].radii) + 1)
    wide = [at_tear(run, f"bubble_{k}_diameter_m") for k in numbers]
    pressures = [at_tear(run, f"bubble_{k}_pressure_Pa") for k in numbers]
    found = [check("largest bubble, by number", 1 + wide.index(max(wide)), 1, 0)]
    if run.summary["torn"]:
        found += [check(f"diameter of bubble {k} [m]", *own, WIDTH, True) for k, own in zip(numbers, zip(wide, WIDE))]
    return [*found, check("pressures of the bubbles apart [Pa]", max(pressures) - min(pressures), APART, APART)]
