"""Bars of the balances of every run, whatever its scene: `sdph validate` and `sdph stress` hold it to them, and a run
tells which it missed."""

from __future__ import annotations

from sdph.methods.liquids.totals import AT_HAND

ROUND_OFF = 1e-10  # of what is there, moved or exchanged; with nothing to relate to, kg, J or kg m/s
NUMERICAL = 0.02  # of the physical dissipation: work of explicit steps; bar of our choice
BARS = {
    "mass_drift_rel": ROUND_OFF,
    "whole_mass_drift_rel": ROUND_OFF,  # of a liquid and the vapour of its bubbles
    "particle_mass_drift_rel": ROUND_OFF,
    "species_drift_rel": ROUND_OFF,
    "energy_drift_rel": 1e-8,  # of the heat exchanged: round-off of the enthalpy of all the gas, up to 1e7 times that
    "heat_drift_rel": ROUND_OFF,  # of a liquid and bodies in it
    "motion_drift_rel": ROUND_OFF,
    "momentum_drift_rel": ROUND_OFF,
    "momentum_made_rel": NUMERICAL,  # of liquids: control of tension, corrected differences of moving particles
    # of all that bubbles push: 1e-5 to 4e-4 in gel droplets, also while two merge, 0.009 where the face is that of a
    # lattice without a shell, 0.085 where a part of the face was missed and a droplet flew off; our choice
    "bubble_impulse_rel": 0.01,
    "exchange_mass_mismatch_rel": ROUND_OFF,
    "exchange_energy_mismatch_rel": ROUND_OFF,
    "exchange_momentum_mismatch_rel": ROUND_OFF,
    "energy_made_rel": 0.05,  # of liquids: shifting takes the field anew at other places, which makes some; our choice
    "numerical_work_rel": NUMERICAL,
    "energy_missing_rel": 0.01,  # of solids: gel-droplet.md, section 5, energy
}
STILL = 1e-3  # of the energy at hand: less than that dissipated, a liquid hardly moves; our choice, as of motion_drift
# of the impulses of the gas: faces balance its momentum and cells hold it, which is the same in boxes alone, and to
# first order in a window where mass of cells changes (docs/theory/gas.md). A run tells it, no scene is held to it; our
# choice
DRIFT_OF_GAS = "gas_momentum_drift_rel", 0.01
REMEDIES = {
    "gas_momentum_drift_rel": (
        "the gas gained or lost that share of its impulses by numerics: as an inlet sets it off at once (most is "
        "in the first rows of ledger.csv then), in cells that are no boxes, or whose mass changes in a window; "
        "smaller cells (resolution.cell_mm) or shorter windows (coupling.window_largest_s) lower it"
    ),
    "bubble_impulse_rel": (
        "that share of what bubbles push was left over around them, and was taken back: one touches the shell, or its "
        "face is a few particles long; a smaller resolution.spacing_mm lowers it"
    ),
}


def work_of_gas(summary: dict) -> list[dict]:
    """The check that what is numerical in the motion of the gas is little of its physical dissipation; none where the
    gas feels nothing of the grains, whose ledger has no motion of it."""
    name = "gas_numerical_work_rel"
    return [_check(name, summary, NUMERICAL)] if name in summary else []


def at_rest(summary: dict) -> bool:
    """True of a liquid that dissipated less than STILL of its energy at hand: it hardly moves, and what is numerical
    has no physical dissipation to be related to. False where a summary does not tell."""
    return AT_HAND in summary and abs(summary["dissipated_J"]) < STILL * summary[AT_HAND]


def checks(summary: dict) -> list[dict]:
    """The balances that `summary` tells, as `sdph compare` has checks: the bar is the tolerance about 0."""
    # of a droplet in a shell it is of the motion, by explicit steps: gel-droplet.md, section 5
    own = {"energy_drift_rel": BARS["energy_missing_rel"]} if "heat_to_bubble_J" in summary else {}
    bars = BARS | own | {f"solid_{name}": bar for name, bar in BARS.items()}  # of bodies in a liquid
    return [_check(name, summary, bar) for name, bar in bars.items() if name in summary]


def _check(name: str, summary: dict, bar: float) -> dict:
    value = summary[name]
    return {"name": name, "value": value, "reference": 0.0, "tolerance": bar, "ok": abs(value) <= bar}


def missed(summary: dict) -> list[str]:
    """A line for each balance of a run that is not within its bar, and for a drift of the gas's momentum."""
    found = [(row["name"], row["value"], row["tolerance"]) for row in checks(summary) if not row["ok"]]
    name, bar = DRIFT_OF_GAS
    if summary.get(name, 0.0) > bar:
        found.append((name, summary[name], bar))
    return [
        f"{name} = {value:.2g}, a balance is good to {bar:g}: {_remedy(name, summary)}" for name, value, bar in found
    ]


def _remedy(name: str, summary: dict) -> str:
    if name == "numerical_work_rel" and at_rest(summary):
        return _little(summary["dissipated_J"], summary[AT_HAND])
    if name.endswith("numerical_work_rel"):
        return "shorter steps (run.step_factor below 1) lower what explicit steps do"
    return REMEDIES.get(name, "something was made or lost; docs/results.md says what the column counts")


def _little(lost: float, there: float) -> str:
    return (
        f"that is of {lost:.2g} J, all that was dissipated, and next to nothing of the {there:.2g} J that could "
        "fall or did work: the liquid is nearly at rest, and there is little to relate it to; it counts where motion "
        "that small is what you look for"
    )
