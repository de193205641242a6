"""The box of the domain: names of its sides."""

SIDES = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1), "back": (2, 0), "front": (2, 1)}  # axis, end
PAIRS = tuple(zip(list(SIDES)[::2], list(SIDES)[1::2]))  # of opposite sides, by axis
