"""Moving particles with tension against closed forms, in two dimensions (swirl-sheet.md, section 5).

films    pull of a resting film on its half, and the speed at which its rim goes back
drops    period of a drop, and the pressure in drops of three sizes
"""

NAMES = ("films", "drops")
