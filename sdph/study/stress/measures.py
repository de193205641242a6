"""Measures by which a hard case is judged: extremes over the run, and what the ledger closes to."""

from __future__ import annotations

import math

import numpy as np

from sdph.engine import state as particles
from sdph.engine.geometry import PAIRS


class Extremes:
    """Gathers figures window by window; `values` gives them by name."""

    def __init__(self, case):
        self.case = case
        self.high: dict[str, float] = {}
        self.low: dict[str, float] = {}
        self.last: dict[str, float] = {}
        self.lost = 0
        self.regions: dict[str, np.ndarray] = {}

    def finish(self, simulation) -> None:
        """Take the figures of the ledger at the end of a stage, the worst over all stages."""
        for name, value in (simulation.ledger.summary() if simulation.ledger.last else {}).items():
            self._take(name, np.array([value]))
        self.last |= {"sub_steps": simulation.stepper.steps, "warnings": len(simulation.warnings())}

    def values(self) -> dict[str, float]:
        """Name -> figure: `X_max` and `X_min` over the run, and the last of what has no extremes."""
        whole = {
            name: value for name, value in self.high.items() if name.endswith(("_rel", "_J")) and "kinetic" not in name
        }
        extremes = {f"{name}_max": value for name, value in self.high.items()} | {
            f"{name}_min": value for name, value in self.low.items()
        }
        return extremes | whole | self.last | {"lost_through_walls": float(self.lost)}

    def _take(self, name: str, values) -> None:
        if len(values):  # what is no number stays none, and meets no bound
            self.high[name] = float(np.maximum(self.high.get(name, -math.inf), np.max(values)))
            self.low[name] = float(np.minimum(self.low.get(name, math.inf), np.min(values)))


class Measures(Extremes):
    """Measures of grains and their gas."""

    def window(self, simulation) -> None:
        """Take the figures after a window. The box around the grains that each region began with is kept as NAME_x_m
        and so on."""
        s, fields = simulation.grains.inside, simulation.gas_state.fields
        density = particles.by_material(s.grain_density, self.case.grains.density)
        speed = np.sqrt((particles.velocities(s) ** 2).sum(axis=1))
        self._take("speed_m_s", speed)
        self._take("alpha_p", s.density / density)
        self._take("temperature_K", s.temperature)
        self._take("theta_m2_s2", s.theta)
        self._take("gas_speed_m_s", np.sqrt((fields["velocity"] ** 2).sum(axis=1)))
        self._take("gas_temperature_K", fields["temperature"])
        self._take("cell_alpha_p", simulation.cell_fields()["alpha_p"])
        energy = float(0.5 * (s.mass * speed**2).sum())
        self._take("kinetic_energy_J", np.array([energy]))
        self._take(
            "momentum_kg_m_s", np.linalg.norm((s.mass[:, None] * particles.velocities(s)).sum(axis=0), keepdims=True)
        )
        self.last = {
            "particles": len(s.x),
            "kinetic_energy_end_J": energy,
            "speed_end_m_s": float(speed.max(initial=0.0)),
            "windows": simulation.windows,
        }
        self.last |= {"particle_mass_kg": float(s.mass.sum())}
        self.lost = max(self.lost, self._outside(s))
        self.regions = self.regions or self._regions(s)
        for name, idents in self.regions.items() if len(self.regions) > 1 else ():
            for letter, axis in zip("xyz", particles.axes(s)):
                self._take(f"{name}_{letter}_m", axis[np.isin(s.ident, idents)])

    def _regions(self, s) -> dict[str, np.ndarray]:
        """Name of each box of grains -> identities of those in it now."""
        places = np.stack(particles.axes(s), axis=1)
        boxes = {name: region for name, region in self.case.particles.items() if region.shape == "box"}
        return {
            name: s.ident[((places >= box.lower) & (places <= box.upper)).all(axis=1)] for name, box in boxes.items()
        }

    def _outside(self, s) -> int:
        """Particles out of the box where walls hold the grains."""
        if "walls" not in self.case.effects:
            return 0
        out = np.zeros(len(s.x), bool)
        own = self.case.domain
        for axis, ends, low, high, period in zip(particles.axes(s), PAIRS, own.corner, own.upper, own.period):
            for side, beyond in zip(ends, (axis < low, axis > high) if not period else ()):
                if not any(b.side == side and b.lets_out for b in self.case.boundaries.values()):
                    out |= beyond
        return int(out.sum())
