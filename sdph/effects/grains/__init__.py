"""Effects of grains on each other."""
