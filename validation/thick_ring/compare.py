"""A ring under pressure against Lame's stress and displacement, and against the pressure at which it flows."""

from __future__ import annotations

import numpy as np

from sdph.laws import solids
from sdph.study.compare import check

FOUR, EIGHT = 0.03, 0.02  # of hoop stress and displacement by layers: gel-droplet.md, section 5, check 2
FLOW = 0.02  # of the pressure at which it flows: check 4
BREATHING = 43324.2  # Hz, of the dry ring: gel_reference.json, ring_breathing_0.45_0.5
# D/D0 -> pressure [Pa] of a 1-D model of 24 layers with E = 20 MPa: gel_reference.json, plastic_ring_p_*
PLASTIC = {1.05: 53717.18713746801, 1.1: 48494.7126022281}
# a ring that flows; it grows at 0.5 m/s, so that rho v^2 is 0.8 % of its pressure; the liquid is half as stiff as it
FLOWING = (
    "solid.yield_stress_Pa=490000.0", "inflation.by=growth", "inflation.growth_1_s=1000.0",
    "inflation.bulk_modulus_Pa=1e7", "inflation.rise_time_s=5e-5", "run.end_time_s=1.4e-4",
)  # fmt: skip
VARIANTS = {
    "four layers": ((), ["exact"]),
    "eight layers": (("resolution.spacing_mm=0.00625",), ["exact"]),
    "flowing": (FLOWING, ["exact"]),
}


def circles(run) -> list[tuple]:
    """(radius at the start, radius, hoop stress) of each circle of particles at the end, means [m], [Pa]."""
    body, spacing = run.case.bodies["ring"], run.case.resolution.spacing
    _, cloud, _ = run.fields(run.case.run.end_time)
    layers = round((body.radius - body.inner_radius) / spacing)
    edges = np.linspace(body.inner_radius, body.radius, layers + 1)
    places = np.asarray(cloud.points)[:, :2] - np.array(body.centre)
    r = np.hypot(*places.T)
    n = places / r[:, None]
    hoop = cloud["stress_xx"] * n[:, 1] ** 2 + cloud["stress_yy"] * n[:, 0] ** 2
    hoop = hoop - 2.0 * cloud["stress_xy"] * n[:, 0] * n[:, 1]
    circle = np.asarray(cloud["ident"]) // (len(r) // layers)
    middle = 0.5 * (edges[1:] + edges[:-1])
    return [(middle[k], r[circle == k].mean(), hoop[circle == k].mean()) for k in range(layers)]


def lame(run) -> tuple[np.ndarray, np.ndarray]:
    """Hoop stress and displacement of each circle over Lame's, less 1. Stress is taken with the radii of now, which the
    pressure has moved by 0.4 %."""
    own, body = run.case.solid, run.case.bodies["ring"]
    pressure, material = run.case.parameters["inflation"].pressure, (own.youngs_modulus, own.poisson_ratio)
    inner, outer = (
        r + solids.lame_ring(r, pressure, body.inner_radius, body.radius, *material)[1]
        for r in (body.inner_radius, body.radius)
    )
    found = [
        (
            hoop / solids.lame_ring(r, pressure, inner, outer, *material)[0] - 1.0,
            (r - start) / solids.lame_ring(start, pressure, body.inner_radius, body.radius, *material)[1] - 1.0,
        )
        for start, r, hoop in circles(run)
    ]
    return tuple(np.array(found).T)


def flow(run) -> dict[float, float]:
    """D/D0 of PLASTIC -> pressure [Pa], the mean over one period of the ring's breathing around it."""
    ratio, pressure = run.history["diameter_ratio"], run.history["cavity_pressure_Pa"]
    half = 0.5 * run.case.parameters["inflation"].growth / BREATHING
    return {at: float(pressure[np.abs(ratio - at) < half].mean()) for at in PLASTIC}


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    hoop, moved = lame(run)
    return {"hoop stress": (np.abs(hoop).max(), 0.0, 1.0), "displacement": (np.abs(moved).max(), 0.0, 1.0)}


def exact(run) -> list[dict]:
    if run.case.parameters["inflation"].by == "growth":
        return [check(f"pressure at D/D0 = {at:g} [Pa]", own, PLASTIC[at], FLOW, True) for at, own in flow(run).items()]
    hoop, moved = lame(run)
    bar = EIGHT if len(hoop) >= 8 else FOUR
    return [
        check("hoop stress over Lame's, worst circle", np.abs(hoop).max(), 0.0, bar),
        check("displacement over Lame's, worst circle", np.abs(moved).max(), 0.0, bar),
    ]
