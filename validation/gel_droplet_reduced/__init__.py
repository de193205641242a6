"""A gel droplet without particles (`sdph droplet`) against another reduced model and a paper's claims: a module each
with `checks(folder, overrides, reporter)`, which `sdph validate gel_droplet_reduced` calls.

course       base case: D/D_0 and pressure against time, mass, heat, work
rings        shells that are driven: pressure against D/D_0
changes      flaw, damage, flux, strength, bubble, heating, sphere
claims       Qiang et al. 2017: rupture, pressures
"""

NAMES = ("course", "rings", "changes", "claims")
