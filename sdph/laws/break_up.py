"""Break-up of a drop in gas by Taylor's analogy with a mass on a spring (TAB): O'Rourke & Amsden 1987, SAE 872089.

y is the shift of the drop's equator over half its radius. With the slip u past it, constant,

    y'' = C_F/C_b rho_g u^2/(rho r^2) - C_k sigma/(rho r^3) y - C_d mu/(rho r^2) y',

whose solution is closed: y - y_e = exp(-b t) (A cos w t + B sin w t), y_e = We/12, We = rho_g u^2 r/sigma. The drop
breaks at y = 1: from rest and without viscosity where We is above 6. Range: slip far below the gas's speed of sound,
drops that are denser than the gas by far.

OpenFOAM's TAB has the same y_e, w, b (its C_mu is a key, of 5 or 10) and products. It leaves b out between now and
y = 1, sets y to 0 where nothing swings, and draws the size of the products; here nothing is left out or drawn.
"""

import math

from sdph.laws.compiled import law
from sdph.laws.grain_sizes import of_moments

FORCE, SHIFT, SPRING, DAMPING = 1.0 / 3.0, 0.5, 8.0, 5.0  # C_F, C_b, C_k, C_d: O'Rourke & Amsden 1987
ENERGY = 10.0 / 3.0  # K: of the energy of all modes over that of the lowest one (the same)
CRITICAL_WEBER = SPRING * SHIFT / FORCE / 2.0  # 6, of the radius: 2 y_e = 1
BISECTIONS = 60  # of an interval: what is left of it is round-off
# of the products' Sauter mean diameter, with number by r exp(-r/mean): number mean and variance of the log-normal that
# has their number, surface and mass (chi-squared, O'Rourke & Amsden 1987); by Python, as an import compiles nothing
CHI_MEAN, CHI_VARIANCE = of_moments.py_func(2.0 / 9.0, 6.0 / 27.0)


@law
def weber(slip, radius, gas_density, surface_tension):
    """We [-] = rho_g u^2 r/sigma, of the radius."""
    return gas_density * slip * slip * radius / surface_tension


@law
def rest(number):
    """y_e [-] = C_F/(C_k C_b) We: where a drop in steady gas comes to rest."""
    return FORCE / (SPRING * SHIFT) * number


@law
def decay(radius, density, viscosity):
    """b [1/s] = C_d mu/(2 rho r^2)."""
    return 0.5 * DAMPING * viscosity / (density * radius * radius)


@law
def stiffness(radius, density, surface_tension):
    """C_k sigma/(rho r^3) [1/s2]: w^2 + b^2."""
    return SPRING * surface_tension / (density * radius**3)


@law
def after(y, rate, at_rest, b, spring, time):
    """y [-] and its rate [1/s] after a time [s]: the exact solution, also where viscosity lets nothing swing."""
    square = spring - b * b
    w = math.sqrt(abs(square))
    if square > 0.0:
        c, s = math.cos(w * time), math.sin(w * time) / w
        fade = math.exp(-b * time)
    elif w * time > 0.0:  # the faster decay is written down alone, or both would overflow
        late, soon = math.exp((w - b) * time), math.exp(-(w + b) * time)
        c, s, fade = 0.5 * (late + soon), 0.5 * (late - soon) / w, 1.0
    else:
        c, s, fade = 1.0, time, math.exp(-b * time)
    away = y - at_rest
    return at_rest + fade * (away * (c + b * s) + rate * s), fade * (rate * (c - b * s) - spring * away * s)


@law
def first_top(y, rate, at_rest, b, spring):
    """Time [s] of the first largest y from now on; infinite where y comes to rest without one."""
    square, away = spring - b * b, y - at_rest
    w = math.sqrt(abs(square))
    slope = spring * away + b * rate  # rate(t) is rate cos(w t) - slope sin(w t)/w, times exp(-b t)
    if square > 0.0:
        phase = math.atan2(rate * w, slope)
        return (phase if phase >= 0.0 else phase + 2.0 * math.pi) / w
    if rate < 0.0 or rate * w >= slope:
        return math.inf
    return math.atanh(rate * w / slope) / w if w > 0.0 else rate / slope


@law
def time_to_break(y, rate, at_rest, b, spring, limit):
    """Time [s] until y is 1, where that is within `limit` [s]; else infinite. y is below 1 now."""
    end = min(limit, first_top(y, rate, at_rest, b, spring))
    if after(y, rate, at_rest, b, spring, end)[0] < 1.0:
        return math.inf
    begin = 0.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (begin + end)
        if after(y, rate, at_rest, b, spring, middle)[0] < 1.0:
            begin = middle
        else:
            end = middle
    return end


@law
def product_radius(radius, rate, density, surface_tension):
    """Sauter mean radius [m] of the products of a drop at y = 1 and its rate [1/s]: r/(7/3 + rho r^3 rate^2/(8 sigma)).

    The energy of its swing is that of the surface gained and of the speed at which the products part.
    """
    swing = density * radius**3 / surface_tension * rate * rate
    return radius / (1.0 + 8.0 * ENERGY / 20.0 + swing * (6.0 * ENERGY - 5.0) / 120.0)


@law
def parting_speed(radius, rate):
    """Speed [m/s] across its path with which the products leave: that of the drop's equator, C_b r y'."""
    return SHIFT * radius * rate


@law
def sauter_diameter(mean, variance):
    """<d^3>/<d^2> [m] of a log-normal of number mean [m] and variance [m2]."""
    return mean * (1.0 + variance / (mean * mean)) ** 2
