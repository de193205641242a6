"""sdph: flows of grains, droplets and liquids by SPH particles, coupled to a finite-volume gas."""

__version__ = "0.1.0"
