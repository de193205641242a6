"""A plug of spray in uniform gas: SDPH and OpenFOAM's droplet solver against the equations of one droplet and its gas.

plug     droplets of one size and speed that fill the middle of a channel: speed, temperatures, vapour, mass
"""

NAMES = ("plug",)
