"""Radiation of grey bodies whose surroundings see them whole (optically thin): they absorb as they emit."""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import STEFAN_BOLTZMANN

SMALL = 0.2  # of a temperature ratio, below which a difference of two near functions is summed as a series; our choice
COLD = 1e-15  # of a temperature, below which surroundings give nothing back, (T_s/T)^4, to round-off; our choice
ITERATIONS = 60  # of Newton's method, which takes about 6; our choice


@law
def exchange_coefficient(temperature, other):
    """sigma (T + T_o)(T^2 + T_o^2) [W/(m2 K)]: times T - T_o it is sigma (T^4 - T_o^4). Stefan 1879, Boltzmann 1884."""
    return STEFAN_BOLTZMANN * (temperature + other) * (temperature * temperature + other * other)


@law
def extinction(alpha_p, diameter):
    """K [1/m] = 3 alpha_p/(2 d), part of the radiation that grains stop on a metre of its way: opaque spheres, large
    beside its wavelength, by their shadows. d: Sauter mean [m]. Modest 2013, Radiative Heat Transfer, ch. 12."""
    return 1.5 * alpha_p / diameter


@law
def _half_difference(u):
    """(u - arctan tanh u)/2 for u >= 0; of small z = tanh u the series z^3/3 + z^7/7 + ..., to round-off."""
    z = math.tanh(u)
    if z > SMALL:
        return 0.5 * (u - math.atan(z))
    q = z * z * z * z
    return z * z * z * (1.0 / 3.0 + q * (1.0 / 7.0 + q * (1.0 / 11.0 + q * (1.0 / 15.0 + q * (1.0 / 19.0 + q / 23.0)))))


@law
def cooled(temperature, surroundings, rate, time):
    """T [K] of a body after `time` [s] under dT/dt = -k (T^4 - T_s^4), `rate` k [1/(K3 s)] = epsilon sigma A/(m c).
    T_s >= 0, exact.

    With z = T_s/T = tanh u, (u - arctan tanh u)/2 grows by k T_s^3 t; a colder body has z = T/T_s and the plus sign.
    T_s = 0: T (1 + 3 k T^3 t)^(-1/3). E.g. Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, section 5.3.
    Newton's method from below: both functions are convex or nearly straight, so that it converges.
    """
    if temperature == surroundings or rate * time == 0.0:
        return temperature
    if surroundings <= COLD * temperature:
        growth = rate * temperature * temperature * temperature * time
        return max(surroundings, temperature * (1.0 + 3.0 * growth) ** (-1.0 / 3.0))
    hot, growth = temperature > surroundings, rate * surroundings * surroundings * surroundings * time
    ratio = surroundings / temperature if hot else temperature / surroundings
    if ratio >= 1.0:  # alike to round-off
        return temperature
    u = math.atanh(ratio)
    if hot:
        end = _half_difference(u) + growth
        u = max((u * u * u + 3.0 * growth) ** (1.0 / 3.0), u + 2.0 * growth)
    else:
        end = 0.5 * (u + math.atan(ratio)) + growth
        u += growth
    for _ in range(ITERATIONS):
        z = math.tanh(u)
        if hot:
            change = (end - _half_difference(u)) * (1.0 + z * z) / (z * z)
        else:
            change = (end - 0.5 * (u + math.atan(z))) * (1.0 + z * z)
        u += change
        if abs(change) <= 1e-15 * u:
            break
    return surroundings / math.tanh(u) if hot else surroundings * math.tanh(u)
