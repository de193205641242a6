"""One gel droplet in a hot surrounding, without particles: growth, neck, tear, vent (`sdph droplet`).

It is the reduced model that a droplet of particles is judged by; its laws are `sdph.laws.gel_droplet`.
"""
