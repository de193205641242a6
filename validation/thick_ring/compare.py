"""A ring under pressure against Lame's stress and displacement, and against the pressure at which it flows, without
hardening and as the shell of a gel droplet does."""

from __future__ import annotations

import numpy as np

from sdph.laws import solids, strength
from sdph.methods.solids import start
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
# of damage: s* is 1/sqrt(3) within 0.1 across the ring, and D3 that small, which is half a per cent; our choice
HARMED = 0.02
DAMAGED = 0.01  # of the pressure with Johnson and Cook's hardening, rate and damage: check 5
# D/D0 -> pressure [Pa] of the same model at d(D/D0)/dt = 5 1/s: jcd_ring_p_*
JOHNSON_COOK = {
    1.1: 147341.54783044264, 1.15: 147638.57113147862, 1.2: 145043.78046659453, 1.25: 141129.5379352201,
    1.3: 136570.38158919726,
}  # fmt: skip
# the gel droplet's shell; a hundred times as fast at a hundred times its rate eps_0, so that stress is the same, and
# rho v^2 0.1 % of its pressure
HASTE, SLOW, RATE = 100.0, 5.0, 5e-4  # -, 1/s, 1/s
BREAKING = (
    "solid.yield_stress_Pa=490000.0", "solid.hardening_Pa=807000.0", "solid.hardening_exponent=0.73",
    "solid.rate_factor=0.1739", f"solid.reference_rate_1_s={HASTE * RATE!r}",
    "solid.failure=[0.00705, 1.732, -0.054, -0.0123, 0.0]", "solid.critical_damage=0.012",
    "inflation.by=growth", f"inflation.growth_1_s={HASTE * SLOW!r}", "inflation.bulk_modulus_Pa=1e7",
    "inflation.rise_time_s=1e-4", "run.end_time_s=7.1e-4", "run.output_interval_s=1e-4",
)  # fmt: skip
VARIANTS = {
    "four layers": ((), ["exact"]),
    "eight layers": (("resolution.spacing_mm=0.00625",), ["exact"]),
    "flowing": (FLOWING, ["exact"]),
    "with damage": (BREAKING, ["exact"]),
    "with damage, 10 % disorder": ((*BREAKING, "bodies.ring.disorder=0.1"), ["exact"]),
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


def outer(run) -> np.ndarray:
    """D/D0 of the ring's outer face, which stands half a layer beyond the outermost particles, whose mean radius
    `diameter_ratio` is of; the area between the two stays, as the ring gives by 1 % of it at most."""
    body = run.case.bodies["ring"]
    layers = round((body.radius - body.inner_radius) / run.case.resolution.spacing)
    middle = body.radius - 0.5 * (body.radius - body.inner_radius) / layers
    return np.sqrt(1.0 + (run.history["diameter_ratio"] ** 2 - 1.0) * (middle / body.radius) ** 2)


def flow(run, ratios) -> dict[float, float]:
    """D/D0 of `ratios` -> pressure [Pa], the mean over one period of the ring's breathing around it."""
    ratio, pressure = outer(run), run.history["cavity_pressure_Pa"]
    half = 0.5 * run.case.parameters["inflation"].growth / BREATHING
    return {at: float(pressure[np.abs(ratio - at) < half].mean()) for at in ratios}


def damaged(run) -> float:
    """Largest damage over D_c p/p_f of the largest plastic strain p, with the p_f of a thin ring: mean over equivalent
    stress 1/sqrt(3), plastic strain at 2/sqrt(3) of the rate at which the ring grows halfway to the end."""
    own = run.case.solid
    halfway = 0.5 * (1.0 + outer(run)[-1])
    rate = 2.0 / np.sqrt(3.0) * run.case.parameters["inflation"].growth / halfway
    failure = strength.failure_strain(start.damage(run.case), 1.0 / np.sqrt(3.0), rate, own.reference_rate)
    worst = run.history["damage_largest"][-1], run.history["plastic_strain_largest"][-1]
    return worst[0] / (own.critical_damage * worst[1] / failure)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    hoop, moved = lame(run)
    return {"hoop stress": (np.abs(hoop).max(), 0.0, 1.0), "displacement": (np.abs(moved).max(), 0.0, 1.0)}


def exact(run) -> list[dict]:
    if run.case.parameters["inflation"].by == "growth":
        known, bar = (JOHNSON_COOK, DAMAGED) if run.case.solid.failure else (PLASTIC, FLOW)
        found = flow(run, known)
        rows = [check(f"pressure at D/D0 = {at:g} [Pa]", found[at], known[at], bar, True) for at in known]
        harmed = run.case.solid.failure
        return rows + ([check("damage over D_c p/p_f of a thin ring", damaged(run), 1.0, HARMED)] if harmed else [])
    hoop, moved = lame(run)
    bar = EIGHT if len(hoop) >= 8 else FOUR
    return [
        check("hoop stress over Lame's, worst circle", np.abs(hoop).max(), 0.0, bar),
        check("displacement over Lame's, worst circle", np.abs(moved).max(), 0.0, bar),
    ]
