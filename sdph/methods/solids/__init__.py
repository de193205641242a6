"""Elastic and plastic solids that damage, total Lagrangian: neighbours are those of the undeformed body."""
