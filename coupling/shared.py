"""A gas that several processes of particles share: the first of them has the solver, all have what it hands back."""

from __future__ import annotations

from coupling.gas import Unfinished


class SharedGas:
    """The door (`coupling.gas.Gas`) to a solver that only the chief of a world has; `gas` is None elsewhere."""

    def __init__(self, gas, world):
        self.gas, self.world = gas, world
        self.mesh = world.told(gas.mesh if gas else None)

    def __getattr__(self, name: str):
        return getattr(self.gas, name)  # what a solver has beside the door is of the chief

    def start(self, *given):
        return self._told("start", *given)

    def advance(self, *given):
        return self._told("advance", *given)

    def retreat(self):
        return self._told("retreat")

    def restore(self, *given):
        return self._told("restore", *given)

    def checkpoint(self, folder) -> None:
        self.gas.checkpoint(folder)

    def close(self) -> None:
        if self.gas:
            self.gas.close()

    def _told(self, step: str, *given):
        """Hand out what the chief's solver gives after a step; a window that it could not finish is so everywhere."""
        found = None
        if self.world.chief:
            try:
                found = getattr(self.gas, step)(*given)
            except Unfinished as failure:
                found = failure
        found = self.world.told(found)
        if isinstance(found, Unfinished):
            raise found
        return found
