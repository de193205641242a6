"""Another's OpenFOAM case, read for what a case of sdph needs: nothing in it is run."""

from coupling.openfoam.foreign.found import Found, look

__all__ = ["Found", "look"]
