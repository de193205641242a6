"""Effects of a gas on grains and droplets, and of these on it."""
