"""Grains that heap up and flow out, without a gas, against what others measured: a module each with `checks(folder,
overrides, reporter)`, which `sdph validate granular_piles` calls.

columns      Lube et al. 2005: run-out of columns that collapse
slopes       a layer on a slope: rest, and acceleration by Schaeffer's friction
hopper       Beverloo et al. 1961: rate out of a slot
"""

NAMES = ("columns", "slopes", "hopper")
