"""Checks that runs of gel droplets share: the reduced model of the same droplet, the tear, and what closes.

Bars are of issue 20 and of gel-droplet.md, sections 5 and 6.
"""

from __future__ import annotations

import functools

import numpy as np

from sdph import schema
from sdph.effects.gas import gel
from sdph.schema import CaseError
from sdph.study.compare import check
from sdph.study.gel_droplet import sections
from sdph.study.gel_droplet.course import Course

WITHIN = 5.0  # s, for which a droplet is followed at least, and 1 ms its longest step: numerics of `sections`
STEPS = 5000  # in a run that is longer than that; as many as `WITHIN` has

TIME = 0.05
TEAR = 1.35, 1.47  # D/D0 of a flaw of 7 %
HEAT, MASS, ENERGY, INERTIA = 1e-10, 1e-12, 0.01, 0.02


def reduced(case) -> Course:
    """Course of the reduced model of a case with its largest bubble alone; its spot is as much thinner as the shell's
    flaw."""
    _refuse_other(case)
    own, shell, heat = case.solid, case.bodies["shell"], case.parameters["liquid_heat"]
    bubble = case.parameters["bubble"]
    radius = max(bubble.radii, default=case.pools["gel"].inner_radius)
    given = {
        "droplet.diameter_mm": 2e3 * shell.radius,
        "droplet.shell_thickness_um": 1e6 * (shell.radius - shell.inner_radius),
        "droplet.bubble_diameter_mm": 2e3 * radius, "droplet.ambient_pressure_Pa": bubble.around,
        "droplet.surface_tension_N_m": bubble.surface_tension, "heating.flux_W_m2": heat.flux,
        "shell.youngs_modulus_Pa": own.youngs_modulus, "shell.poisson_ratio": own.poisson_ratio,
        "shell.yield_stress_Pa": own.yield_stress, "shell.hardening_Pa": own.hardening,
        "shell.hardening_exponent": own.hardening_exponent, "shell.rate_factor": own.rate_factor,
        "shell.reference_rate_1_s": own.reference_rate, "shell.critical_damage": own.critical_damage,
        "shell.flaw": shell.flaw, "gel.density_kg_m3": case.liquid.density,
        "gel.heat_capacity_J_kg_K": heat.heat_capacity, "gel.conductivity_W_m_K": heat.conductivity,
    } | {f"vapour.{key}": getattr(bubble, at) for key, (at, _) in schema.fields(gel.Fuel).items()}  # fmt: skip
    given |= {"heating.place": heat.heated, "shell.failure": own.failure[:4]}
    if case.run.end_time > WITHIN:
        end = case.run.end_time
        given |= {"numerics.end_time_s": end, "numerics.longest_step_ms": 1e3 * end / STEPS}
    return _course(sections.load(None, tuple(f"{key}={_word(value)}" for key, value in given.items())))


@functools.lru_cache(maxsize=1)
def _course(own: sections.Droplet) -> Course:
    """The course of a droplet; kept, as many rows of `sdph explain` are of the same."""
    return Course(own)


def _word(value) -> str:
    """A value as an override has it."""
    return f'"{value}"' if isinstance(value, str) else repr(list(value) if isinstance(value, tuple) else value)


def _refuse_other(case) -> None:
    """CaseError where the reduced model has not what is in a case."""
    own, heat = case.solid, case.parameters["liquid_heat"]
    there = {
        "solid.density_kg_m3, another than the gel's": own.density != case.liquid.density,
        "liquid_heat.body_heat_capacity_J_kg_K": heat.body_heat_capacity not in (None, heat.heat_capacity),
        "liquid_heat.body_conductivity_W_m_K": heat.body_conductivity not in (None, heat.conductivity),
        "solid.damage_begins_at": own.damage_begins_at > 0.0, "solid.temperature_share": own.temperature_share > 0.0,
    }  # fmt: skip
    for key, found in there.items():
        if found:
            raise CaseError(f"the reduced model of gel droplets knows no {key}; it tells nothing of this run")


def grown(history) -> slice:
    """Rows before the tear."""
    return slice(0, int(np.searchsorted(history["solid_free_particles"] > 0, True)) or None)


def at_tear(run, column: str) -> float:
    """A column of the history in the last row before the first cut."""
    return float(run.history[column][grown(run.history)][-1])


def size(run) -> dict:
    """Check of D/D0 at the tear, for a flaw of 7 %."""
    middle = sum(TEAR) / 2.0
    found = run.summary["rupture_diameter_ratio"]
    return check(f"D/D0 at the tear, {TEAR[0]:g} to {TEAR[1]:g}", found, middle, TEAR[1] - middle)


def place(run) -> dict:
    """Check that the shell tears at its flaw: angle from the flaw's edge to the middle of what broke off first."""
    half_width = np.degrees(run.case.bodies["shell"].flaw_half_width)
    off = max(0.0, abs(run.summary["tear_angle_deg"]) - half_width)
    return check("angle of the tear from the flaw's edge [deg]", off, 0.0, 1.0)


def closure(run) -> list[dict]:
    """Checks of heat, mass, energy; inertia and viscosity by time scaling."""
    told, scaled = run.summary, (("inertia", "inertial"), ("viscosity", "viscous"))
    return [
        check("heat made, of what came in", told["heat_drift_rel"], 0.0, HEAT),
        check("mass of gel and vapour made", told["whole_mass_drift_rel"], 0.0, MASS),
        check("energy that nobody gave, of the bubble's work", told["energy_drift_rel"], 0.0, ENERGY),
        *(
            check(
                f"pressure of {name} over pressure, before the tear", told[f"{key}_pressure_largest_rel"], 0.0, INERTIA
            )
            for name, key in scaled
        ),
    ]
