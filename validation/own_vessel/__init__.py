"""Vessels of any mesh: what the gas does on cells that are no boxes, and walls of any triangles.

flows      gas alone on each mesh: a uniform flux, a packed bed, rest, uniform sources, conservation
orders     a manufactured solution on each mesh, coarse and fine
dummies    points on walls of triangles of 0.2 to 50 spacings, and of slivers
leaks      grains in a cylinder and a cone that are shaken
"""

NAMES = ("flows", "orders", "dummies", "leaks")
