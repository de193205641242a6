"""Metrics of a column of grains that gas blows through evenly: pressure drop, Ergun's, weight, motion.

Up is against gravity.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.case.gas_cells import CellRows, upwards
from sdph.engine import state as particles
from sdph.laws import exact
from sdph.laws.break_up import sauter_diameter

INSIDE = (0.15, 0.75)  # of the bed's height: away from floor and surface


def metrics(simulation) -> dict[str, float]:
    """superficial_velocity_m_s of the gas over the floor; pressure_drop_Pa from floor to top; ergun_Pa, what Ergun says
    of every row at the gas flux of now over the floor, by the Sauter diameter, which slows down as the vessel widens;
    weight_Pa of the grains in gas, each over the vessel's area where it stands, which is what the gas that carries all
    of them falls by; gradient_Pa_m of the pressure inside the bed, and alpha_p_inside, the fraction there (nan where
    fewer than two rows lie inside); speed_max_m_s and speed_rms_m_s of the grains, the second over particles;
    alpha_p_mean, by mass, and alpha_p_max of their fractions where they are; bed_height_m."""
    case, mesh, fields = simulation.case, simulation.gas.mesh, simulation.cell_fields()
    up = upwards(case, "column")
    rows, state = CellRows(mesh, up), simulation.grains.inside
    mass = state.mass
    pressure, alpha_p = rows.mean(fields["pressure"]), rows.mean(fields["alpha_p"])
    floor, lid = rows.at_ends(pressure)
    flux = rows.mean((1.0 - fields["alpha_p"]) * (fields["velocity"] @ up))
    through = flux[0] * rows.area[0] / rows.area
    whole = float(mass.sum()) or math.nan  # of a vessel without grains what is told of them is not a number
    place = particles.positions(state) @ up - rows.floor
    height = 2.0 * float(mass @ place) / whole
    around = np.interp(place, rows.place, rows.area) / mesh.depth
    inside = (rows.place > INSIDE[0] * height) & (rows.place < INSIDE[1] * height)
    seen = np.count_nonzero(inside) > 1
    speed = particles.lengths(particles.velocities(state))
    fraction = state.density / case.grains.density
    return {
        "superficial_velocity_m_s": float(flux[0]),
        "pressure_drop_Pa": floor - lid,
        "ergun_Pa": float((ergun(case, alpha_p, through, sauter(state)) * rows.height).sum()),
        "weight_Pa": weight(case, float((mass / around).sum())),
        "gradient_Pa_m": float(-np.polyfit(rows.place[inside], pressure[inside], 1)[0]) if seen else math.nan,
        "alpha_p_inside": float(alpha_p[inside].mean()) if seen else math.nan,
        "speed_max_m_s": float(speed.max(initial=0.0)),
        "speed_rms_m_s": math.sqrt(float(speed @ speed) / max(len(speed), 1)),
        "alpha_p_mean": float(fraction @ mass) / whole,
        "alpha_p_max": float(fraction.max(initial=0.0)),
        "bed_height_m": height,
    }


def sauter(state) -> float:
    """Sauter diameter [m] of all grains: their volume over that of each over its own; nan without grains."""
    if not len(state.mass):
        return math.nan
    own = sauter_diameter(state.diameter, state.diameter_variance)
    if own.min() == own.max():
        return float(own[0])
    volume = state.mass / particles.by_material(state.grain_density, 1.0)
    return float(volume.sum() / (volume / own).sum())


def ergun(case, alpha_p, flux, diameter: float = 0.0) -> np.ndarray:
    """dP/dy [Pa/m] at each alpha_p (R,), at one flux [m/s] or that of each, of grains of a diameter [m] or, of 0, that
    of the case."""
    gas, pairs, d = case.gas, np.broadcast_arrays(alpha_p, flux), diameter or case.grains.sauter_diameter
    own = zip(*(column.tolist() for column in pairs))
    return np.array([exact.ergun_gradient(a, u, d, gas.density, gas.viscosity) for a, u in own])


def weight(case, over: float) -> float:
    """Weight less buoyancy [Pa] of grains, `over` [kg/m2] the sum of mass over area, in two dimensions [m]."""
    return over * (1.0 - case.gas.density / case.grains.density) * math.hypot(*case.domain.gravity)
