"""Walls as particles: shapes, surface meshes, sides of the domain."""
