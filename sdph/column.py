"""What a column of grains that gas blows through evenly is like: pressure drop, Ergun's, weight, motion."""

from __future__ import annotations

import numpy as np

from sdph import particles
from sdph.gas_cells import layers
from sdph.laws import exact

INSIDE = (0.15, 0.75)  # of the bed's height: away from floor and surface

def metrics(simulation) -> dict[str, float]:
    """pressure_drop_Pa from floor to top; ergun_Pa, what Ergun says of every row at the gas flux of now; weight_Pa of
    the grains in gas over the floor; gradient_Pa_m of the pressure inside the bed, and alpha_p there; speeds [m/s] of
    the grains; their fractions."""
    case, mesh, fields = simulation.case, simulation.gas.mesh, simulation.cell_fields()
    rows = Rows(mesh, case.domain.size[1])
    pressure, alpha_p = rows.mean(fields["pressure"]), rows.mean(fields["alpha_p"])
    floor, lid = rows.at_ends(pressure)
    flux = rows.mean((1.0 - fields["alpha_p"]) * fields["velocity"][:, 1])
    height = 2.0 * float((simulation.state.y * simulation.state.mass).sum() / simulation.state.mass.sum())
    inside = (rows.place > INSIDE[0] * height) & (rows.place < INSIDE[1] * height)
    speed = particles.lengths(particles.velocities(simulation.state))
    fraction = simulation.state.density / case.grains.density
    return {
        "superficial_velocity_m_s": float(flux[0]),
        "pressure_drop_Pa": floor - lid,
        "ergun_Pa": float((ergun(case, alpha_p, flux[0]) * rows.height).sum()),
        "weight_Pa": weight(case, float(simulation.state.mass.sum())),
        "gradient_Pa_m": float(-np.polyfit(rows.place[inside], pressure[inside], 1)[0]),
        "alpha_p_inside": float(alpha_p[inside].mean()),
        "speed_max_m_s": float(speed.max()),
        "speed_rms_m_s": float(np.sqrt((speed**2).mean())),
        "alpha_p_mean": float((fraction * simulation.state.mass).sum() / simulation.state.mass.sum()),
        "alpha_p_max": float(fraction.max()),
        "bed_height_m": height,
    }


class Rows:
    """Cells of a box of height `top` [m] sorted by height: place and height (R,) [m] of each row, which may differ."""

    def __init__(self, mesh, top: float):
        self.top, self.own = top, layers(mesh.centres[:, 1])
        self.count = np.bincount(self.own)
        self.place = np.bincount(self.own, mesh.centres[:, 1]) / self.count
        self.height = top * np.bincount(self.own, mesh.volumes) / mesh.volumes.sum()

    def at_ends(self, values) -> tuple[float, float]:
        """At the floor and at the top, straight on from the two rows next to them."""
        slopes = np.diff(values)[[0, -1]] / np.diff(self.place)[[0, -1]]
        return float(values[0] - slopes[0] * self.place[0]), float(values[-1] + slopes[1] * (self.top - self.place[-1]))

    def mean(self, values) -> np.ndarray:
        """Means of the rows, from the floor up."""
        return np.bincount(self.own, values) / self.count


def ergun(case, alpha_p, flux: float) -> np.ndarray:
    """dP/dy [Pa/m] at each alpha_p."""
    gas = case.gas
    return np.array([exact.ergun_gradient(a, flux, case.grains.diameter, gas.density, gas.viscosity) for a in alpha_p])


def weight(case, mass: float) -> float:
    """Of `mass` [kg] of grains in gas over the floor [Pa]."""
    floor = np.prod([length for a, length in enumerate(case.domain.size) if a != 1])
    return mass * (1.0 - case.gas.density / case.grains.density) * -case.domain.gravity[1] / float(floor)
