"""sdph: flows of grains, droplets and liquids by SPH particles, coupled to a finite-volume gas."""

from sdph.engine import device as environment

__version__ = "0.1.0"

environment.prepare()
