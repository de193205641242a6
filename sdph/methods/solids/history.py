"""Columns of history.csv of solids, fields for pictures, and their part of the summary."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles

ROUND = ("ring", "cylinder")  # shapes of bodies that have a hoop stress
AXES = ("xx", "yy", "zz", "xy", "yz", "zx")


def row(stepper) -> dict[str, float]:
    """Columns of now: sums over the bodies, extremes, and middle and extents of each body, places that are tracked."""
    case, s = stepper.case, stepper.state
    told = fields(stepper)
    values = {
        "time_s": stepper.time,
        "kinetic_energy_J": particles.energy_of_motion(s),
        "elastic_energy_J": stepper.elastic_energy,
        "fastest_m_s": float(particles.lengths(particles.velocities(s)).max()),
        "equivalent_stress_largest_Pa": float(told["equivalent_stress"].max()),
        "plastic_strain_largest": float(stepper.strained.max()),
        "damage_largest": float(stepper.harm.max()),
        "free_particles": int(stepper.free.sum()),
    }
    for number, name in enumerate(case.bodies):
        values |= _of_body(stepper, name, stepper.body == number)
    for number in case.track:
        own = int(np.flatnonzero(s.ident == number - 1)[0])
        values |= {f"particle_{number}_{axis}_m": float(at[own]) for axis, at in zip("xyz", particles.axes(s))}
    if stepper.cavity:
        ratio = stepper.cavity.diameter_ratio(s, stepper.reference)
        values |= stepper.cavity.row() | {"diameter_ratio": ratio}
    return values


def _of_body(stepper, name: str, own) -> dict[str, float]:
    """Middle, velocity (by mass) and extents along each axis of a body's particles, `own` (N,) bool."""
    s, values = stepper.state, {}
    mass, places, velocities = s.mass[own], particles.positions(s)[own], particles.velocities(s)[own]
    for a, axis in enumerate("xyz"[: stepper.case.dimensions]):
        values[f"{name}_centre_{axis}_m"] = float(mass @ places[:, a] / mass.sum())
        values[f"{name}_velocity_{axis}_m_s"] = float(mass @ velocities[:, a] / mass.sum())
        values[f"{name}_lowest_{axis}_m"] = float(places[:, a].min())
        values[f"{name}_highest_{axis}_m"] = float(places[:, a].max())
    return values


def fields(stepper) -> dict[str, np.ndarray]:
    """Name -> values (N,) of the particles: Cauchy's stress, pressure, equivalent stress [Pa], density [kg/m3]; where a
    body is a ring or a cylinder the hoop stress too."""
    jacobian = np.linalg.det(stepper.gradient.reshape(-1, 3, 3))
    stress = stepper.kirchhoff / jacobian[:, None]
    mean = stress[:, :3].mean(axis=1)
    spread = ((stress[:, :3] - mean[:, None]) ** 2).sum(axis=1) + 2.0 * (stress[:, 3:] ** 2).sum(axis=1)
    hoop = any(body.shape in ROUND for body in stepper.case.bodies.values())
    return ({"hoop_stress": hoop_stress(stepper, stress)} if hoop else {}) | {
        "pressure": -mean, "equivalent_stress": np.sqrt(1.5 * spread), "density": stepper.state.density / jacobian,
        "plastic_strain": stepper.strained, "damage": stepper.harm, "body": stepper.body, "free": stepper.free,
    } | {f"stress_{ab}": stress[:, k] for k, ab in enumerate(AXES)}  # fmt: skip


def hoop_stress(stepper, stress) -> np.ndarray:
    """Stress [Pa] (N,) around the middle of each ring or cylinder as it lies now, across the line from there to the
    particle in the plane of the first two axes, of stresses (N, 6); 0 in other bodies and in what has broken off."""
    found, places, mass = np.zeros(len(stress)), particles.positions(stepper.state)[:, :2], stepper.state.mass
    for number, body in enumerate(stepper.case.bodies.values()):
        own = (stepper.body == number) & (stepper.free == 0)
        if body.shape not in ROUND or not own.any():
            continue
        away = places[own] - mass[own] @ places[own] / mass[own].sum()
        r = np.hypot(*away.T)[:, None]
        x, y = np.divide(away, r, out=np.zeros_like(away), where=r > 0.0).T
        xx, yy, _, xy = stress[own, :4].T
        found[own] = xx * y**2 + yy * x**2 - 2.0 * xy * x * y
    return found


def outside(stepper) -> list[str]:
    """A line where particles are outside of the domain: how many, of which bodies, and how many have broken off."""
    case, d = stepper.case, stepper.case.dimensions
    here = particles.positions(stepper.state)[:, :d]
    gone = ((here < case.domain.corner) | (here > case.domain.upper)).any(axis=1)
    if not gone.any():
        return []
    whose = ", ".join(f"bodies.{name}" for number, name in enumerate(case.bodies) if gone[stepper.body == number].any())
    loose = int((gone & (stepper.free != 0)).sum())
    return [
        f"{int(gone.sum())} of {len(gone)} solid particles ({whose}) end outside of the domain, {loose} of them broken "
        "off: nothing held them; enlarge domain.size_m, or name the sides that hold bodies in rigid_sides.sides"
    ]


def summary(stepper) -> dict[str, float]:
    """Part of summary.json."""
    return {
        "solid_particles": len(stepper.state.x),
        "kinetic_energy_J": particles.energy_of_motion(stepper.state),
        "elastic_energy_J": stepper.elastic_energy,
        "plastic_strain_largest": float(stepper.strained.max()),
        "damage_largest": float(stepper.harm.max()),
        "free_particles": int(stepper.free.sum()),
        "inverted_particles": stepper.inverted,
    }
