"""Moving particles with tension against closed forms, (swirl-sheet.md, section 5): films and drops in two
dimensions, threads and holes in three.

films    pull of a resting film on its half, and the speed at which its rim goes back
drops    period of a drop, and the pressure in drops of three sizes
threads  growth of the gravest wave of a thread
holes    speed of the rim of a hole in a film
"""

NAMES = ("films", "drops", "threads", "holes")
