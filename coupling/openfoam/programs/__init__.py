"""OpenFOAM's programs: where they are, how they are installed, compiled and run."""
