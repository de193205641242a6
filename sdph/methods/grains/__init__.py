"""Grains and droplets in a gas."""
