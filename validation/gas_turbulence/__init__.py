"""Turbulence of the gas: sdphGasFoam against OpenFOAM's own pimpleFoam, on the same mesh with the same fields.

frozen     the same eddy viscosity of the same velocity, which stands still
channel    a channel that turbulent gas flows through, at Re_tau = 395
eddies     means of a channel with cyclic ends and the eddies of WALE, beside direct simulation at Re_tau = 178
"""

NAMES = ("frozen", "channel", "eddies")
