"""Steps of the ladder of checks of gel-droplet.md (section 5, and issue 20) that no scene stands for.

beam    an elastic beam under its weight: Turek and Hron's CSM3
cavity  a cavity of gas in a disc of liquid: a small swing, and one from 1.2 of its radius
"""

NAMES = ("beam", "cavity")
