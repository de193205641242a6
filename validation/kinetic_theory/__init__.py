"""Kinetic theory of grains that move freely, without a gas, against its own closures: a module each with
`checks(folder, overrides, reporter)`, which `sdph validate kinetic_theory` calls.

cooling      Haff's law
diffusion    a wave of theta that decays
shear        uniform shear between sliding rough walls; what makes theta, and what takes it
flows        Couette and Poiseuille flow, against profiles.py
slopes       a layer on a rough slope: rest, and sliding
"""

NAMES = ("cooling", "diffusion", "shear", "flows", "slopes")
