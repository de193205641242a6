"""Exchange of heat, momentum and mass between particles and a gas."""
