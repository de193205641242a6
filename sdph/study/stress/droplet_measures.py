"""Measures by which a hard case of a droplet that a bubble inflates is judged."""

from __future__ import annotations

from sdph.study.stress.liquid_measures import LiquidMeasures

# of the summary, where it has them
TOLD = (
    "torn", "tear_angle_deg", "rupture_diameter_ratio", "diameter_ratio_max", "bubbles_left", "bubbles_merged",
    "bubbles_closed", "mass_drift_rel", "heat_drift_rel", "energy_drift_rel", "whole_mass_drift_rel",
)  # fmt: skip


class DropletMeasures(LiquidMeasures):
    """Measures of gel, bubbles and shell."""

    def window(self, simulation) -> None:
        """Take the figures after a window."""
        super().window(simulation)
        row = simulation.bodies.solids.row()
        for name in ("equivalent_stress_largest_Pa", "damage_largest"):
            self._take(f"shell_{name}", [row[name]])
        self._take("bubble_pressure_Pa", [simulation.stepper.void.pressure])

    def finish(self, simulation) -> None:
        """Take what the summary tells, and what the ledger of the shell closes to."""
        super().finish(simulation)
        told = simulation.summary(None)
        self.last |= {name: float(told[name]) for name in TOLD if name in told}
        self.last |= {f"shell_{key}": told[f"solid_{key}"] for key in ("momentum_drift_rel", "energy_missing_rel")}
