"""`sdph.Tank`: a tank of liquid whose motion a spacecraft's loop gives (sdph.running.tank)."""

from __future__ import annotations

import os

from sdph.api.case import Case
from sdph.running import tank


class Tank(tank.DrivenTank):
    """Liquid in a tank whose motion is given from outside: `force, moment = tank.advance(dt, acceleration, omega)`."""

    def __init__(self, case: Case | str | os.PathLike[str]) -> None:
        """`case` is one of a liquid with the effect tank, or the name of its scene, folder or file."""
        super().__init__(Case.of(case).resolved)
