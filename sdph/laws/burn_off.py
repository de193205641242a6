"""Burn-off of a sphere by a reaction of first order in a species of the gas, with the film around it in series.

Per area the sphere takes k rho Y of the oxidant [kg/(m2 s)], with 1/k = 1/k_s + d/(Sh D): the surface's own velocity
k_s [m/s] and that of the film, Sh = 2 (1 + c sqrt(d)), c the `ventilation` of grain_loss.py. Of the solid it loses 1/nu
of that, nu [kg/kg] being the oxidant that burns a kilogram of solid, so that at a constant density rho_p

    d(S)/dt = -a,    S(d) = 4 l d + G(d^2, c),    l = D/k_s,    a = 8 D rho Y/(nu rho_p),

G being the d^2 law's scale of grain_loss.py: where the surface is slow (l >> d) the diameter falls evenly, where it is
fast its square does. Without a film G is left out. Both limits, and shrinking spheres with both resistances: Levenspiel
1999, Chemical Reaction Engineering, 3rd ed., ch. 25. The flow of the products off the sphere (Stefan's), which is
Y/nu of the diffusion at most, is left out.
"""

import math

from sdph.laws import grain_loss
from sdph.laws.compiled import law
from sdph.laws.constants import CONVERGED

STEPS = 60  # of Newton's iteration, which ends long before: it is monotone, its error squares


@law
def surface_velocity(factor, activation_temperature, temperature):
    """k_s [m/s] = k_0 exp(-T_a/T) of the grain's temperature [K]. Arrhenius 1889, Z. Phys. Chem. 4, 226."""
    return factor * math.exp(-activation_temperature / temperature)


@law
def gas_stripped(volume, diameter, kinetic, ventilation, diffusivity, film):
    """k A [m3/s] of spheres of `diameter` [m] and together of `volume` [m3]: 6 V/d k, k = D/(l + film d/Sh).

    kinetic l = D/k_s [m]; ventilation c [m^-1/2]; film 1, or 0 without one. Levenspiel 1999, eq. 25.29.
    """
    sherwood = 2.0 * (1.0 + ventilation * math.sqrt(diameter))
    return 6.0 * volume / diameter * diffusivity / (kinetic + film * diameter / sherwood)


@law
def scale(diameter, kinetic, ventilation, film):
    """S [m2] of d [m]; the rest as in `gas_stripped`."""
    return 4.0 * kinetic * diameter + film * grain_loss.loss_scale(diameter * diameter, ventilation)


@law
def diameter_of_scale(of, kinetic, ventilation, film):
    """d [m] of S [m2], `scale` turned round: Newton's iteration from above, where S is convex and it cannot overshoot;
    0 for S <= 0. kinetic above 0."""
    if of <= 0.0:
        return 0.0
    slowest = of / (4.0 * kinetic)
    d = slowest if film == 0.0 else min(slowest, math.sqrt(grain_loss.square_of_scale(of, ventilation)))
    for _ in range(STEPS):
        slope = 4.0 * kinetic + film * 2.0 * d / (1.0 + ventilation * math.sqrt(d))
        step = (scale(d, kinetic, ventilation, film) - of) / slope
        d -= step
        if step <= CONVERGED * d:
            break
    return d


@law
def diameter_after(diameter, loss, kinetic, ventilation, film):
    """d [m] after a loss of integral a dt [m2]; exactly 0 once it is gone."""
    return diameter_of_scale(scale(diameter, kinetic, ventilation, film) - loss, kinetic, ventilation, film)


@law
def mean_content(taken):
    """Mean of exp(-x t) for t from 0 to 1: what a cell holds of the oxidant over a window, over what it held at first,
    where grains strip x = `taken` times its gas in the window; x >= 0 [-]."""
    return -math.expm1(-taken) / taken if taken > 0.0 else 1.0
