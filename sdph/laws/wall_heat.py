"""Heat from a wall to grains: through the gas in the wedge between both, and from there into a packet of the bed.

The bed is k [W/(m K)], stores C [J/(m3 K)] and begins at one temperature: the flux into it is that of a half-space
behind a contact resistance, Carslaw & Jaeger 1959, Conduction of Heat in Solids, section 2.7. Packets that come, stay
for a while and go are Mickley & Fairbanks 1955, AIChE J. 1, 374; with the contact in series they are the penetration
model of Schluender 1984, Chem. Eng. Process. 18, 31, of VDI Heat Atlas, 2nd ed. (2010), part M.
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT

SERIES = 6.0  # from which on three terms of erfcx's series are as good as 1e-6; e^x^2 overflows at 26


@law
def accommodation_of_air(temperature):
    """Share gamma [-] of a molecule's heat that it leaves on a wall: lg(1/gamma - 1) = 0.6 - (1000/T + 1)/2.8, T [K].

    Martin 2010, VDI Heat Atlas, 2nd ed., p. 1301, for air (2.8); grains and walls as technical surfaces are.
    """
    return 1.0 / (1.0 + 10.0 ** (0.6 - (1000.0 / temperature + 1.0) / 2.8))


@law
def temperature_jump(conductivity, heat_capacity, molar_mass, temperature, pressure, accommodation):
    """l [m] = 2 (2/gamma - 1) sqrt(2 pi R T/M) k_g/(p (2 c_p - R/M)): by so much the gap to a wall seems wider.

    Gas of k_g [W/(m K)], c_p [J/(kg K)], M [kg/kmol], T [K], p [Pa]. Martin 2010, VDI Heat Atlas, 2nd ed., p. 1301.
    """
    specific = GAS_CONSTANT / molar_mass
    path = math.sqrt(2.0 * math.pi * specific * temperature) * conductivity
    return 2.0 * (2.0 / accommodation - 1.0) * path / (pressure * (2.0 * heat_capacity - specific))


@law
def schluender(diameter, conductivity, gap):
    """alpha_WP [W/(m2 K)] = 4 k_g/d [(1 + 2 g/d) ln(1 + d/(2 g)) - 1] of a sphere's shadow on a wall that it touches.

    d [m], k_g [W/(m K)], gap g [m]: temperature jump and roughness. Schluender 1971, Chem.-Ing.-Tech. 43, 651; Martin
    2010, VDI Heat Atlas, 2nd ed., p. 1301. The sphere is of one temperature.
    """
    ratio = 2.0 * gap / diameter
    return 4.0 * conductivity / diameter * ((1.0 + ratio) * math.log(1.0 + 1.0 / ratio) - 1.0)


@law
def erfcx(x):
    """e^(x^2) erfc(x) [-] of x >= 0, to 1e-6 beyond SERIES; Abramowitz & Stegun 1964, 7.1.23."""
    if x < SERIES:
        return math.exp(x * x) * math.erfc(x)
    y = 0.5 / (x * x)
    return (1.0 - y * (1.0 - y * (3.0 - 15.0 * y))) / (x * math.sqrt(math.pi))


@law
def passed(contact, conductivity, stored, way, age):
    """Heat [W/(m2 K)] that a wall passes to a packet of the bed per kelvin between them, after `age` [s] at the wall.

    That of a half-space, h erfcx(h sqrt(age/(k C))), until the warm layer has grown to the packet's middle, `way` [m]
    from the wall, whose temperature then drives the flux through 1/h + way/k. h: contact [W/(m2 K)], k [W/(m K)],
    C: stored [J/(m3 K)].
    """
    through = conductivity * contact / (conductivity + contact * way)
    return max(through, contact * erfcx(contact * math.sqrt(age / (conductivity * stored))))
