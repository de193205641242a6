"""The first barrier against code in OpenFOAM cases: `refuse_code`. The second is in the programs: `barrier`."""

from coupling.openfoam.code.files import Findings, refuse_code

__all__ = ["Findings", "refuse_code"]
