"""Particles on a CUDA device: the loops of the methods as kernels, and what a device alone needs."""
