"""A gel droplet that inflates and tears, against the reduced model of the same droplet (gel-droplet.md, point 13), and
what closes."""

from __future__ import annotations

import numpy as np

from sdph.study import validate
from sdph.study.compare import check
from sdph.study.gel_droplet.checks import TIME, at_tear, closure, grown, place, reduced, size

RATIO, PRESSURE, MEAN_PRESSURE = 0.01, 0.05, 0.02  # issue 20
AT = (0.3, 0.4, 0.5, 0.6, 0.65, 0.7, 0.73, 0.741)  # s of the base case: the specification's table
REACHED = (1.02, 1.1, 1.2, 1.3)
PAPER_RATIO, PAPER_TIME, PAPER_PRESSURE, PAPER = 1.4, 0.75, 1.5e5, 0.05  # Qiang et al. 2017, and our bar


# gel-droplet.md, section 6: share of the time that is elastic, up to ELASTIC; shell of 42 um, most pressure [Pa]; even
# shell, D/D0 of the tear
STEADY, ELASTIC, THIN, EVEN = 0.89, 1.05, 126e3, 4.0


def exact(run) -> list[dict]:
    return [*course(run), *tear(run), *(claims(run) if _of_paper(run) else []), *closure(run)]


def _of_paper(run) -> bool:
    """True of the droplet that flux and flaw were set for."""
    return run.case.parameters["liquid_heat"].flux == 1.42e5 and run.case.bodies["shell"].flaw == 0.07


def claims(run) -> list[dict]:
    """Checks of claims of the paper (gel-droplet.md, section 6): other shells by the droplet without particles, whose
    own claims `gel_droplet_reduced` has, and the pace of the run."""
    of = validate.part("gel_droplet_reduced", "runs").course
    thin, even = of("droplet.shell_thickness_um=42", "shell.flaw=0"), of("shell.flaw=0")
    told = [
        ("shell of 42 um: largest pressure [Pa]", thin.summary["pressure_max_Pa"], THIN),
        ("no flaw: D/D0 at the tear", even.summary["rupture_diameter_ratio"], EVEN),
    ]
    found = [check(f"claim, without particles: {name}", *values, PAPER, True) for name, *values in told]
    if not run.summary["torn"]:
        return found
    rows = grown(run.history)
    ratios, times = run.history["diameter_ratio"][rows], run.history["time_s"][rows]
    share = np.interp(ELASTIC, np.maximum.accumulate(ratios), times) / run.summary["rupture_time_s"]
    return [
        *found,
        check(f"claim, grows steadily: time to D/D0 = {ELASTIC:g} of that to the tear", share, STEADY, PAPER),
    ]


def course(run) -> list[dict]:
    """D/D0 and pressure in time, and when D/D0 is reached, up to the tear of the model; nan behind that of the run. A
    run that does not tear, which `tear` tells, is held to as far as it goes."""
    model, rows = reduced(run.case).history, grown(run.history)
    time, ratio = run.history["time_s"][rows], run.history["diameter_ratio"][rows]
    own, torn = {"diameter_ratio": ratio, "pressure_Pa": run.history["bubble_pressure_Pa"][rows]}, run.summary["torn"]
    end, largest = model["time_s"][np.argmax(model["diameter_ratio"])], model["diameter_ratio"].max()
    last = min(time[-1], end)
    other = run.case.parameters["liquid_heat"].flux != 1.42e5  # another droplet: as shares
    found = []
    for t in (min(t * last / AT[-1], last) if other else t for t in AT):
        if t <= (end if torn else last):
            of_model = {name: np.interp(t, model["time_s"], model[name]) for name in own}
            of_run = {name: np.interp(t, time, values, right=np.nan) for name, values in own.items()}
            found += [
                check(f"D/D0 at {t:.4g} s", *(of["diameter_ratio"] for of in (of_run, of_model)), RATIO, True),
                check(f"pressure at {t:.4g} s [Pa]", *(of["pressure_Pa"] for of in (of_run, of_model)), PRESSURE, True),
            ]
    for r in (r for r in REACHED if r < (largest if torn else min(ratio.max(), largest))):
        ours, theirs = (float(np.interp(r, np.maximum.accumulate(a), b, right=np.nan)) for a, b in (
            (ratio, time), (model["diameter_ratio"], model["time_s"])))  # fmt: skip
        found.append(check(f"time of D/D0 = {r:g} [s]", ours, theirs, TIME, True))
    means = (_mean(t, p, last) for t, p in ((time, own["pressure_Pa"]), (model["time_s"], model["pressure_Pa"])))
    return [*found, check("pressure, mean over the growth [Pa]", *means, MEAN_PRESSURE, True)]


def _mean(time, values, end: float) -> float:
    """Mean over time of `values` (N,) at `time` (N,) [s] from the first to `end` [s]."""
    within = np.unique([*time[time < end], end])
    return float(np.trapezoid(np.interp(within, time, values), within) / (end - within[0]))


def tear(run) -> list[dict]:
    """Time and size at the tear, that it is at the flaw, and what the paper claims."""
    told, model = run.summary, reduced(run.case).summary
    if not told["torn"]:
        return [check("torn", 0, 1, 0)]
    found = [
        check("largest pressure [Pa]", told["pressure_max_Pa"], model["pressure_max_Pa"], PRESSURE, True),
        check("time of the tear [s]", told["rupture_time_s"], model["rupture_time_s"], TIME, True),
        place(run),
    ]
    if _of_paper(run):
        found += [
            size(run),
            check("paper: D/D0 at the tear", told["rupture_diameter_ratio"], PAPER_RATIO, PAPER, True),
            check("paper: time of the tear [s]", told["rupture_time_s"], PAPER_TIME, PAPER, True),
            check("paper: pressure at the tear [Pa]", at_tear(run, "bubble_pressure_Pa"), PAPER_PRESSURE, PAPER, True),
        ]
    return found
