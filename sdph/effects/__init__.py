"""The effects that a case can switch on, one file each, and the registry of them."""

from sdph.effects import conduction, heat
from sdph.effects.effect import OFF, Effect, kernel_of

REGISTRY: dict[str, Effect] = {row.EFFECT.name: row.EFFECT for row in (heat, conduction)}

__all__ = ["OFF", "REGISTRY", "Effect", "kernel_of"]
