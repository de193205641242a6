"""Effects of what is around the particles: walls, tank, inflow, outflow, drain, frame, gravity."""
