"""The sections of a case with solids: their material, and the bodies that there are at the start."""

from __future__ import annotations

from sdph.engine.kernels import NAMES
from sdph.schema import choice, quantity, record, vector, whole


@record
class Solid:
    """A solid: Hooke's law of the logarithmic strain; with a yield stress plastic (Johnson & Cook 1983), with
    `failure` damaged and cut (Johnson & Cook 1985)."""

    density: float = quantity("kg_m3", above=0.0)
    youngs_modulus: float = quantity("Pa", above=0.0)
    poisson_ratio: float = quantity("", least=0.0, most=0.499)
    yield_stress: float | None = quantity("Pa", None, above=0.0)  # A; None: elastic
    hardening: float = quantity("Pa", 0.0, least=0.0)  # B
    hardening_exponent: float = quantity("", 1.0, above=0.0, most=10.0)  # n; 1: linear
    rate_factor: float = quantity("", 0.0, least=0.0, most=10.0)  # C
    reference_rate: float = quantity("1_s", 1.0, above=0.0)  # eps_0
    temperature_share: float = quantity("", 0.0, least=0.0, most=0.999)  # T* = (T - T_0)/(T_m - T_0), held
    softening_exponent: float = quantity("", 1.0, above=0.0, most=10.0)  # m
    failure: tuple = vector("", ())  # D1 to D5; none: it does not fail
    critical_damage: float = quantity("", 1.0, above=0.0, most=1.0)  # D_c, at which links are cut
    damage_begins_at: float = quantity("", 0.0, least=0.0)  # p_d, plastic strain
    kernel: str = choice(*NAMES)
    courant: float = quantity("", 0.3, least=1e-6, most=0.6)  # of h/c: gel-droplet.md, section 4
    viscosity: float = quantity("", 0.1, least=0.0, most=1.0)  # of rho c h between neighbours: 0.1 to 0.2
    hourglass: float = quantity("", 0.05, least=0.0, most=0.05)  # of Young's modulus; more stiffens necks
    history_interval: float | None = quantity("s", None, above=0.0)  # None: a tenth of run.output_interval_s


@record
class Body:
    """A body at the start: box (lower, upper), disc (centre, radius), ring (centre, radius, inner_radius) or cylinder
    (centre, radius, length, along the last axis). What lies in the held box does not move.

    `motion`: uniform, or cantilever: a box held on its left begins with the first mode of a thin plate, whose free end
    moves up with `speed`. A ring may have a flaw: over an angle it is thinner, from outside. `disorder`: the particles
    stand off their lattice or circles by up to so many spacings along each axis, at random, undeformed as they stand.
    """

    shape: str = choice("box", "disc", "ring", "cylinder")
    lower: tuple | None = vector("m", None)
    upper: tuple | None = vector("m", None)
    centre: tuple | None = vector("m", None)
    radius: float | None = quantity("m", None, above=0.0)
    inner_radius: float | None = quantity("m", None, above=0.0)
    length: float | None = quantity("m", None, above=0.0)
    held_lower: tuple | None = vector("m", None)
    held_upper: tuple | None = vector("m", None)
    velocity: tuple | None = vector("m_s", None)
    motion: str = choice("uniform", "cantilever")
    speed: float = quantity("m_s", 0.0)
    flaw: float = quantity("", 0.0, least=0.0, most=0.99)  # of a ring: share of the thickness that is missing
    flaw_at: float = quantity("deg", 0.0, least=0.0, most=360.0)  # middle of the thin part, from the first axis
    flaw_half_width: float = quantity("deg", 6.0, above=0.0, most=180.0, tiny=True)
    disorder: float = quantity("", 0.0, least=0.0, most=0.25)  # as of regions of grains
    seed: int = whole(0, least=0)  # of that chance
