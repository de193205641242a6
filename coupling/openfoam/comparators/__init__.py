"""OpenFOAM's own solvers as references: two fluids, and droplets."""
