"""Incompressible liquid by moving particles: pressure from a Poisson equation on the rows."""
