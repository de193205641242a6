"""Drag between grains of different materials, Syamlal 1987, exact in time where two streams pass through each other.

Two particles of unlike materials brake each other by B_ij (v_i - v_j), B_ij = kappa V_i V_j W_ij with V = m/rho_p and
kappa = beta_ms/(alpha_m alpha_s) of the law at their own |v_i - v_j|: the kernel sum over the other material is alpha_s
there times its mean velocity, so that i feels V_i kappa alpha_s (v_i - <v_s>), which is beta_ms over alpha_m by volume.
B_ij is symmetric, and no momentum is made. Over a sub-step a pair exchanges

    dt B_ij/(1 + x_i + x_j) (v_j - v_i),    x_i = dt sum_j B_ij/m_i,

which is the solution of du/dt = -k u^2 for even streams, u/(1 + k u dt), and takes motion away however long dt is: it
asks for no limit. What the motion loses, summed over pairs less what the exchange leaves in it, to round-off, feeds
theta as viscosity does, or heats the grains where there is none: `grain_drag_J` of the ledger. Beside walls the sum
lacks the part of the kernel that lies behind them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import prange

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import drag
from sdph.engine.geometry import apart, faster, squared
from sdph.engine.ledger import Column
from sdph.engine.rows import entry
from sdph.engine.state import GRAIN
from sdph.laws import grain_drag as law
from sdph.laws import kernels
from sdph.laws.compiled import inlined, parallel
from sdph.schema import CaseError, quantity, record


@record
class GrainDrag:
    friction: float = quantity("", 0.0, least=0.0, most=1.0)  # of a collision, C_f: Fluent's default


class GrainDragP(NamedTuple):
    """Restitution and friction of a collision [-]."""

    restitution: float
    friction: float


def kernel(case) -> GrainDragP:
    if not case.mixed:
        raise CaseError(
            "effects holds grain_drag, which acts between materials, and the grains are of one: give a second, such as "
            "[grains.char], or leave it out"
        )
    return GrainDragP(case.grains.restitution, case.parameters["grain_drag"].friction)


@inlined
def braked(p, kernel, s, box, crowd, i, j):
    """B_ij [kg/s] of two particles and v_i - v_j (3 values) [m/s]; 0 of one material or upstream of a nozzle."""
    du, dv, dw = faster(s, box, i, j)
    if s.material[i] == s.material[j] or s.kind[i] != GRAIN or s.kind[j] != GRAIN:
        return 0.0, du, dv, dw
    r, slip = math.sqrt(squared(*apart(s, box, i, j))), math.sqrt(squared(du, dv, dw))
    rho_i, rho_j = s.grain_density[i], s.grain_density[j]
    kappa = law.syamlal(
        p.restitution, p.friction, rho_i, rho_j, s.diameter[i], s.diameter[j], 0.5 * (crowd[i] + crowd[j]), slip
    )
    volumes = s.mass[i] / rho_i * (s.mass[j] / rho_j)
    return kappa * volumes * kernels.cubic_spline(r, kernel.h, kernel.sigma), du, dv, dw


@parallel
def stiffen(p, kernel, s, rows, box, crowd, dt, stiff):
    """x (N,) [-] of every particle over dt [s]; crowd (N,) is its g0."""
    for i in prange(len(s.x)):
        total = 0.0
        for k in range(rows.number[i]):
            total += braked(p, kernel, s, box, crowd, i, entry(rows, i, k))[0]
        stiff[i] = dt * total / s.mass[i]


@parallel
def exchange(p, kernel, s, rows, box, crowd, dt, stiff, moved, lost):
    """moved (N, 3) [m/s], by which velocities change over dt [s], and lost (N,) [J/kg], what the motion of each
    loses."""
    for i in prange(len(s.x)):
        x = y = z = rubbed = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            b, du, dv, dw = braked(p, kernel, s, box, crowd, i, j)
            share = dt * b / (1.0 + stiff[i] + stiff[j]) / s.mass[i]
            x -= share * du
            y -= share * dv
            z -= share * dw
            rubbed += 0.5 * share * (du * du + dv * dv + dw * dw)
        moved[i, 0], moved[i, 1], moved[i, 2] = x, y, z
        lost[i] = rubbed - 0.5 * (x * x + y * y + z * z)


def call(scales) -> Judgement:
    """Slip that gas makes between the materials: drag would stop it, over what stops it without: always, where they
    fall at different speeds."""
    source = "Syamlal 1987: grains of two materials meet as soon as they move apart"
    if not scales.case.mixed or not scales.collides:
        return Judgement("difference of terminal velocities", 0.0, 0.01, source, 0.0)
    falls = [drag.terminal(type(scales)(scales.case.of_one(name))) for name in scales.case.materials]
    apart_ = (max(falls) - min(falls)) / max(falls) if max(falls) else 0.0
    return Judgement("difference of terminal velocities", apart_, 0.01, source, apart_)


EFFECT = Effect(
    name="grain_drag",
    summary="drag between grains of different materials (Syamlal)",
    parameters=GrainDrag,
    kernel=kernel,
    arrays=("theta", "diameter"),
    moves=True,
    columns=(Column("grain_drag_J"),),
    sums=("grain_drag_J",),
    call=call,
)
