"""A plug of spray in uniform gas: SDPH and OpenFOAM's droplet solver against the equations of one droplet and its gas.

plug       droplets of one size and speed that fill the middle of a channel: speed, temperatures, vapour, mass
spreading  a band of them that flies apart across the channel, by cell size: mass, width, vapour across

`across` has the equations of the band.
"""

NAMES = ("plug", "spreading")
