"""The equations of the particles: loops over neighbours, one signed term per line.

Each term belongs to an effect (`sdph/effects/`) and takes that effect's parameters first; with `OFF` the compiler
drops it. Sums are local and written once. Outputs are arguments of their own.
"""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.around import walls
from sdph.effects.grains import (
    artificial_viscosity,
    conduction,
    friction,
    granular_pressure,
    granular_temperature,
    granular_viscosity,
)
from sdph.engine import arrays
from sdph.engine.arrays import IN_MEMORY
from sdph.engine.geometry import apart, faster, squared
from sdph.engine.rows import entry, length, place
from sdph.laws import granular, kernels
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import fast_inlined, fast_parallel, inlined, inner, parallel, parallel_largest
from sdph.methods.grains import mixture, stress
from sdph.methods.grains.mixture import Kernel, MixedKernel
from sdph.methods.grains.sound import swing


def kernel_of(case) -> Kernel | MixedKernel:
    """Kernel of a case. The correction by the lattice sum (+0.344 % at h = 1.5 dx in 2-D) is our choice."""
    lattice = kernels.lattice_factor("cubic_spline", case.dimensions, case.resolution.smoothing_ratio)
    sigma = kernels.normalisation("cubic_spline", case.dimensions, case.smoothing_length)
    smooth = case.smoothing_length, sigma / lattice
    return MixedKernel(*smooth, case.grains.density) if case.mixed else Kernel(*smooth)


@by_reference
class Scratch(NamedTuple):
    """Values that one loop of a sub-step leaves to the next, in one flat group.

    pull (E,) of `sum_density`; per particle, by `constitutive`: pressure [Pa], its parts by agitation and by lasting
    contacts over density squared [Pa m6/kg2] (of several materials over the square of rho_0 alpha_p), slope of the
    latter's pressure against alpha_p [Pa], shear and bulk viscosity
    of agitation [Pa s], conductivity of theta [kg/m/s], sound speed [m/s], g0 [-]; by `contacts.shear`:
    stress of contacts, elastic and viscous, over density squared (N, 6) [Pa m6/kg2], xx, yy, zz, xy, yz, zx, their
    viscosity (N,) [Pa s], both without length where there is no friction; bearing (N, 5) or (N, 10) of `stress.pair`,
    over density squared; works (2, N) [W/kg] of viscosity into theta, and of contacts and what rubs on walls into heat;
    strain (3, N): I2D = dev(D):dev(D)/2 [1/s2], div v [1/s], and 1 where neighbours enclose the particle
    (`stress.ENCLOSED`); packed (N,) of `pack`, without length where the law of conduction is none of packed beds.
    """

    pull: np.ndarray
    pressure: np.ndarray
    agitated: np.ndarray
    lasting: np.ndarray
    stiffness: np.ndarray
    shear: np.ndarray
    bulk: np.ndarray
    conductivity: np.ndarray
    sound: np.ndarray
    crowd: np.ndarray
    traction: np.ndarray
    rubbing: np.ndarray
    bearing: np.ndarray
    works: np.ndarray
    strain: np.ndarray
    packed: np.ndarray

    @property
    def stress(self) -> tuple[np.ndarray, ...]:
        """Arrays that `constitutive` writes."""
        return self[1:10]

    @property
    def shearing(self) -> tuple[np.ndarray, ...]:
        """Arrays that `contacts.shear` writes."""
        return self[10:15]


def scratch(count: int, entries: int, friction: bool, deep: bool = False, packed=False, like=IN_MEMORY) -> Scratch:
    """Room for `count` particles with so many `entries` in their rows, in 3-D where `deep`, for conduction of `packed`
    beds; beside the array `like`. Nothing is sheared."""
    zeros, rubbed = functools.partial(arrays.zeros, like=like), count if friction else 0
    constituted = [zeros(count) for _ in range(9)]
    sheared = zeros((count, 10 if deep else 5)), zeros((2, count)), zeros((3, count))
    arrays.fill(sheared[2][2], 1.0)  # no particle is held to lie open before one has been looked at
    rubs = zeros((rubbed, 6)), zeros(rubbed)
    return Scratch(arrays.empty(entries, like), *constituted, *rubs, *sheared, zeros(count if packed else 0))


@fast_parallel
def sum_density(kernel, s, rows, box, walls_p, wall, density, pull):
    """rho_i = sum m_j W_ij, i itself included (Eq. 25), over the share of the kernel that lies among grains; of several
    materials rho_pi sum V_j W_ij (sdph.methods.grains.mixture).

    pull (E,) [kg/m^(d+2)] is m_j (dW/dr)/r of every entry of the rows, for the other loops.
    """
    for i in prange(len(s.x)):
        entries = length(rows, i)
        rho = s.mass[i] * kernels.cubic_spline(0.0, kernel.h, kernel.sigma) * (1.0 + rows.number[i] - entries)
        for k in range(entries):
            j = entry(rows, i, k)
            r, m_j = math.sqrt(squared(*apart(s, box, i, j))), s.mass[j]
            rho += m_j * mixture.over(kernel, s, i, j) * kernels.cubic_spline(r, kernel.h, kernel.sigma)
            pull[place(rows, i, k)] = m_j * kernels.cubic_spline_gradient(r, kernel.h, kernel.sigma)
        share = walls.closure(walls_p, box, wall, s, i, kernel) if walls.listed(walls_p, wall, i) else 1.0
        density[i] = rho / share


@parallel_largest
def constitutive(
    s, waves, grains, pressure_p, friction_p, viscosity_p, temperature_p,
    pressure, agitated, lasting, stiffness, shear, bulk, conductivity, sound, crowd,
):  # fmt: skip
    """Stress and sound of every particle (see `Scratch`) from its density and theta; grains: their density [kg/m3] and
    packing limit [-], of several materials that of the first, and the largest density [kg/m3] and diameter [m].

    A material's own coefficients are those of the laws for rho_p = 1, times its own rho_p: all are linear in it. Limits
    of a mixture are of the lightest and finest grains pressed by the heaviest and largest.

    Returns what limits sub-steps, the largest of all: pace omega h + 2 v [m/s] (sdph.methods.grains.sound), and
    diffusivities [m2/s] of momentum, of sound, and of theta.
    """
    pace = momentum = agitation = 0.0
    for i in prange(len(s.x)):
        own = s.grain_density[i] if len(s.grain_density) else grains[0]
        alpha_p, heft = s.density[i] / own, own / grains[0]
        g0 = crowd[i] = granular.crowding(alpha_p, grains[1])
        theta = s.theta[i] if len(s.theta) else 0.0
        diameter = s.diameter[i] if len(s.diameter) else 0.0
        kinetic, (frictional, stiffness[i]) = (
            heft * granular_pressure.pressure(pressure_p, alpha_p, theta, g0),
            friction.pressure(friction_p, alpha_p),
        )
        pressure[i] = kinetic + frictional
        agitated[i] = heft * heft * kinetic / s.density[i] ** 2
        lasting[i] = heft * heft * frictional / s.density[i] ** 2
        most, wide = heaviest(grains, own, diameter)
        squared = (
            most * granular_pressure.sound_squared(pressure_p, alpha_p, theta, g0)
            + friction.sound_squared(friction_p, stiffness[i]) / heft
        )
        sound[i] = math.sqrt(squared)
        shear[i], bulk[i] = granular_viscosity.viscosities(viscosity_p, alpha_p, theta, diameter, g0)
        shear[i], bulk[i] = heft * shear[i], heft * bulk[i]
        conductivity[i] = heft * granular_temperature.conductivity(temperature_p, alpha_p, theta, diameter, g0)
        w = s.w[i] if len(s.w) else 0.0
        speed = math.sqrt(s.u[i] * s.u[i] + s.v[i] * s.v[i] + w * w)
        pace = max(pace, swing(waves, squared, most * pressure[i] / s.density[i]) + 2.0 * speed)
        if s.density[i] > 0.0:
            of_momentum = granular_viscosity.diffusivity(viscosity_p, shear[i], bulk[i], s.density[i])
            momentum = max(momentum, wide * of_momentum)
            agitation = max(agitation, granular_temperature.diffusivity(temperature_p, conductivity[i], s.density[i]))
    return pace, momentum, agitation


@inlined
def heaviest(grains, own, diameter):
    """Density [-] of the heaviest grains over that of this particle's own [kg/m3], and that times the largest diameter
    over its own [m]; 1 of one material."""
    if len(grains) == 2:
        return 1.0, 1.0
    most = grains[2] / own
    return most, most * grains[3] / diameter if diameter > 0.0 else most


@parallel
def pack(conduction_p, s, own):
    """own (N,) [W/m/K]: K of each particle by a law of packed beds, which is too dear for every pair; no entry of
    others."""
    for i in prange(len(own)):
        own[i] = conduction.packed(conduction_p, s, i)


@fast_inlined
def conducted(kernel, s, rows, box, pull, conduction_p, own, i):
    """Heat [W/kg] that particle i gets from its neighbours; own (N,) of `pack`."""
    warmth = 0.0
    for k in range(length(rows, i)):
        j = entry(rows, i, k)
        r2 = squared(*apart(s, box, i, j))
        warmth += conduction.pair(conduction_p, own, kernel.h, s, i, j, r2, pull[place(rows, i, k)])
    return warmth


@fast_parallel
def conduct(kernel, s, rows, box, pull, conduction_p, own, heating):
    """Conduction alone: heating (N,) [W/kg]; own (N,) of `pack`."""
    for i in prange(len(s.x)):
        heating[i] = conducted(kernel, s, rows, box, pull, conduction_p, own, i)


@inner
def heat_to(kernel, s, rows, box, pull, conduction_p, own, i):
    """Heat [W] that particle i gets from its neighbours; own (N,) of `pack`."""
    heat = 0.0
    for n in prange(1):
        heat += conducted(kernel, s, rows, box, pull, conduction_p, own, i + n) * s.mass[i + n]
    return heat


@inlined
def by_pair(
    kernel, s, box, scratch, viscous_p, friction_p, artificial_p, temperature_p, conduction_p, own, i, j, pull_ij
):  # fmt: skip
    """Terms of a particle i by another, j: acceleration (3 values) [m/s2], rate of theta, and heat by rubbing and by
    conduction [W/kg]; pull_ij = m_j (dW/dr)/r, own (N,) of `pack`."""
    rho_i, rho_j = s.density[i], s.density[j]
    dx, dy, dz = apart(s, box, i, j)
    du, dv, dw = faster(s, box, i, j)
    r2 = squared(dx, dy, dz)
    closing, scale = du * dx + dv * dy + dw * dz, pull_ij / (rho_i * rho_j)

    # section 2.1, corrected: -m_j (S_i/rho_i^2 + S_j/rho_j^2 + Pi_ij) grad W, S = p I - tau; S by volume
    pressed = pull_ij * mixture.by_volume(kernel, s, i, j)
    agitated = pressed * (scratch.agitated[i] + scratch.agitated[j])
    lasting = pressed * (scratch.lasting[i] + scratch.lasting[j])
    ringing = pull_ij * artificial_viscosity.pair(
        artificial_p, kernel.h, closing, r2, scratch.sound[i], scratch.sound[j], rho_i, rho_j
    )
    fx, fy, fz = stress.pair(viscous_p, friction_p, scratch.bearing, box, i, j, dx, dy, dz, du, dv, dw)
    push = -agitated - lasting - ringing

    work = granular_temperature.pair(temperature_p, scratch, s, i, j, agitated * closing, ringing * closing, scale)
    return (
        push * dx + pressed * fx,
        push * dy + pressed * fy,
        push * dz + pressed * fz,
        work,
        0.5 * (lasting * closing + granular_temperature.rest(temperature_p, ringing * closing)),
        conduction.pair(conduction_p, own, kernel.h, s, i, j, r2, pull_ij),
    )


@fast_parallel
def rates(
    kernel, s, rows, box, scratch, viscous_p, friction_p, artificial_p, temperature_p, conduction_p, walls_p, wall,
    acceleration, of_walls, agitation, heating,
):  # fmt: skip
    """Rates of grains that move: acceleration (N, 3) [m/s2] by each other; of_walls (N, 7) as `account.kick` takes it;
    agitation (N,) [W/kg] that feeds theta, heating (N,) [W/kg]."""
    for i in prange(len(s.x)):
        ax = ay = az = 0.0
        work, warmth = scratch.works[0, i], scratch.works[1, i]
        if len(walls_p) and walls.listed(walls_p, wall, i):
            wx, wy, wz, tx, ty, tz, slid, lost = walls.force(walls_p, kernel, box, wall, s, i, scratch, friction_p)
            of_walls[i, 0] = wx
            of_walls[i, 1] = wy
            of_walls[i, 2] = wz
            of_walls[i, 3] = tx
            of_walls[i, 4] = ty
            of_walls[i, 5] = tz
            of_walls[i, 6] = slid
            work += granular_temperature.fed(temperature_p, lost)
            warmth += lost - granular_temperature.fed(temperature_p, lost)
        for k in range(length(rows, i)):
            px, py, pz, made, rubbed, conducted = by_pair(
                kernel, s, box, scratch, viscous_p, friction_p, artificial_p, temperature_p, conduction_p,
                scratch.packed, i, entry(rows, i, k), scratch.pull[place(rows, i, k)],
            )  # fmt: skip
            ax += px
            ay += py
            az += pz
            work += made
            warmth += rubbed
            warmth += conducted
        acceleration[i, 0] = ax
        acceleration[i, 1] = ay
        acceleration[i, 2] = az
        agitation[i] = work
        heating[i] = warmth
